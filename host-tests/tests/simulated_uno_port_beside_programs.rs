//! The simulated UNO behind a serial port of a program that starts others all the time:
//! each has a copy of every open file between `fork` and `exec`, and keeps nothing open.

use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use lizard_host_tests::avr_gcc;
use lizard_time_limit::LIMIT;
use simulated_uno::{Fidelity, Port, Uno};

/// Says `<r` at reset.
const HELLO: &str = r#"
    #include <avr/io.h>
    static void put(unsigned char byte) {
        while (!(UCSR0A & 1 << UDRE0)) {}
        UDR0 = byte;
    }
    int main(void) {
        UCSR0A = 1 << U2X0; UBRR0 = 16; UCSR0B = 1 << TXEN0;
        put('<'); put('r');
        for (;;) {}
    }"#;

/// Opens the port that is its argument, reads two bytes, closes it.
const READER: &str = r#"exec 3<>"$0"; head -c 2 <&3"#;

#[test]
fn every_opening_by_another_program_resets_the_chip_once() {
    const OPENINGS: usize = 60;
    let uno = Uno::with_image(avr_gcc::c(HELLO), Fidelity::DataSheet);
    let over = Arc::new(AtomicBool::new(false));
    let others = {
        let over = Arc::clone(&over);
        move || {
            let mut started = 0;
            while !over.load(Ordering::Relaxed) {
                let ended = LIMIT.output(&mut Command::new("true"), b"");
                assert!(ended.expect("it ends").status.success());
                started += 1;
            }
            started
        }
    };
    let others = thread::spawn(others);
    let port = Port::new().expect("a pseudo terminal");
    let board = port.in_background(uno, |_| {}).expect("a thread");
    for n in 1..=OPENINGS {
        let mut reader = Command::new("bash");
        reader.args(["-c", READER]).arg(board.path());
        let said = LIMIT.output(&mut reader, b"").expect("the chip answers");
        assert_eq!(String::from_utf8_lossy(&said.stdout), "<r", "opening {n}");
    }
    over.store(true, Ordering::Relaxed);
    let started = LIMIT.within("the end of the other programs", || others.join());
    assert!(
        started.expect("they are well") > OPENINGS,
        "not enough to disturb"
    );
    let uno = LIMIT.within("the end of the port's thread", || board.stop());
    let resets = uno.expect("the port was well").reset_events().len();
    assert_eq!(resets, 1 + OPENINGS, "power-on and one for each opening");
}
