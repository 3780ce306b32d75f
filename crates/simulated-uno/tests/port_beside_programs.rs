//! Test of a simulated UNO behind a serial port, in a program that constantly starts other programs. Each new
//! process has a copy of every open file between `fork` and `exec`, but such a copy must not keep the port open.

use std::process::Command;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use lizard_time_limit::LIMIT;
use simulated_uno::avr_gcc;
use simulated_uno::{Fidelity, Port, Uno};

/// Program that sends `<r` at reset.
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

/// Shell script that opens the port in its argument, reads two bytes and closes it.
const READER: &str = r#"exec 3<>"$0"; head -c 2 <&3"#;

/// The smallest number of openings, and the smallest number of other programs started during them.
const MIN_OPENINGS: usize = 150;

static STARTED: AtomicUsize = AtomicUsize::new(0);
static OVER: AtomicBool = AtomicBool::new(false);

fn start_others() {
    while !OVER.load(Ordering::Relaxed) {
        let ended = LIMIT.output(&mut Command::new("true"), b"");
        assert!(ended.expect("it ends").status.success());
        STARTED.fetch_add(1, Ordering::Relaxed);
    }
}

#[test]
fn every_opening_by_another_program_resets_the_chip_once() {
    let uno = Uno::with_image(avr_gcc::c(HELLO), Fidelity::DataSheet);
    let others = [(); 3].map(|()| thread::spawn(start_others));
    let port = Port::new().expect("a pseudo terminal");
    let board = port.in_background(uno, |_| {}).expect("a thread");
    let mut openings = 0;
    while openings < MIN_OPENINGS || STARTED.load(Ordering::Relaxed) < MIN_OPENINGS {
        let at_work = others.iter().all(|other| !other.is_finished());
        assert!(at_work, "no more programs are started");
        openings += 1;
        let mut reader = Command::new("bash");
        reader.args(["-c", READER]).arg(board.path());
        let printed = LIMIT.output(&mut reader, b"").expect("the chip answers");
        let printed = String::from_utf8_lossy(&printed.stdout);
        assert_eq!(printed, "<r", "opening {openings}");
    }
    OVER.store(true, Ordering::Relaxed);
    for other in others {
        let ended = LIMIT.within("the end of the other programs", || other.join());
        ended.expect("they are well");
    }
    let uno = LIMIT.within("the end of the port's thread", || board.stop());
    let resets = uno.expect("the port was well").reset_events().len();
    assert_eq!(resets, 1 + openings, "power-on and one for each opening");
}
