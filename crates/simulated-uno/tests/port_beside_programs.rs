//! Test of a simulated UNO behind a serial port, in a program that constantly starts other programs. Between `fork` and
//! `exec`, each new process has a copy of every open file; such a copy must not keep the port open.

use std::process::Command;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use lizard_time_limit::TIME_LIMIT;
use simulated_uno::avr_gcc;
use simulated_uno::{Fidelity, Port, Uno};

/// Program that sends `<r` at reset.
const HELLO_PROGRAM: &str = r#"
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
const READER_SCRIPT: &str = r#"exec 3<>"$0"; head -c 2 <&3"#;

/// Minimum number of openings, and minimum number of other programs that start during these openings.
const MIN_COUNT: usize = 150;

static STARTED_PROGRAM_COUNT: AtomicUsize = AtomicUsize::new(0);
static ARE_OPENINGS_DONE: AtomicBool = AtomicBool::new(false);

fn start_programs() {
    while !ARE_OPENINGS_DONE.load(Ordering::Relaxed) {
        let output = TIME_LIMIT.run_command(&mut Command::new("true"), b"");
        assert!(output.expect("`true` runs").status.success());
        STARTED_PROGRAM_COUNT.fetch_add(1, Ordering::Relaxed);
    }
}

#[test]
fn every_opening_resets_the_chip_once_while_programs_start() {
    let uno = Uno::with_image(avr_gcc::compile_c(HELLO_PROGRAM), Fidelity::DataSheet);
    let starters = [(); 3].map(|()| thread::spawn(start_programs));
    let port = Port::new().expect("a pseudo terminal is free");
    let board = port.in_background(uno, |_| {});
    let board = board.expect("a thread can be started");
    let mut opening_count = 0;
    while opening_count < MIN_COUNT || STARTED_PROGRAM_COUNT.load(Ordering::Relaxed) < MIN_COUNT {
        let are_all_running = starters.iter().all(|starter| !starter.is_finished());
        assert!(are_all_running, "a thread has stopped starting programs");
        opening_count += 1;
        let mut reader = Command::new("bash");
        reader.args(["-c", READER_SCRIPT]).arg(board.path());
        let output = TIME_LIMIT.run_command(&mut reader, b"");
        let output = output.expect("the script ends");
        let output_text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output_text, "<r", "opening {opening_count}");
    }
    ARE_OPENINGS_DONE.store(true, Ordering::Relaxed);
    for starter in starters {
        let result = TIME_LIMIT.run("the end of the other programs", || starter.join());
        result.expect("the thread does not panic");
    }
    let uno = TIME_LIMIT.run("the end of the port's thread", || board.stop());
    let reset_count = uno.expect("the port had no error").reset_events().len();
    let expected = 1 + opening_count;
    assert_eq!(reset_count, expected, "power-on and one for each opening");
}
