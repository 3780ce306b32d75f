//! The simulated UNO behind a serial port, as another program meets it.
//!
//! A program of its own: a compiler that another test starts holds a copy of every open
//! port for a moment, and a port that is not quite closed is not opened anew.

use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use lizard_host_tests::avr_gcc;
use simulated_uno::{Background, FREQUENCY, Fidelity, Pin, Port, Uno};

/// Says `<r` at reset, then sends every byte back, plus one. D9 is high from
/// reset on. GPIOR0 counts resets through a variable that reset does not clear.
const ECHO: &str = r#"
    #include <avr/io.h>
    static volatile unsigned char starts __attribute__((section(".noinit")));
    static void put(unsigned char byte) {
        while (!(UCSR0A & 1 << UDRE0)) {}
        UDR0 = byte;
    }
    int main(void) {
        if (MCUSR & 1 << PORF) starts = 0;
        MCUSR = 0;
        GPIOR0 = ++starts;
        DDRB |= 1 << 1; PORTB |= 1 << 1;
        UCSR0A = 1 << U2X0; UBRR0 = 16;
        UCSR0B = 1 << RXEN0 | 1 << TXEN0;
        put('<'); put('r');
        for (;;) {
            while (!(UCSR0A & 1 << RXC0)) {}
            put(UDR0 + 1);
        }
    }"#;

fn echo() -> Uno {
    Uno::with_image(avr_gcc::c(ECHO), Fidelity::DataSheet)
}

fn served() -> Background {
    let port = Port::new().expect("a pseudo terminal");
    let mut uno = echo();
    uno.run_ms(1);
    port.in_background(uno, |_| {}).expect("a thread")
}

fn open(path: &Path) -> File {
    let mut options = OpenOptions::new();
    options.read(true).write(true).open(path).expect("it opens")
}

fn read(port: &mut File, count: usize) -> String {
    let mut bytes = vec![0; count];
    port.read_exact(&mut bytes).expect("bytes come");
    String::from_utf8_lossy(&bytes).into_owned()
}

fn marks(uno: &Uno) -> Vec<u8> {
    uno.marks().iter().map(|mark| mark.value).collect()
}

#[test]
fn bytes_pass_both_ways_as_they_are() {
    let board = served();
    let mut port = open(board.path());
    assert_eq!(read(&mut port, 2), "<r");
    // What a terminal would swallow or change: CR, LF, interrupt, end of file.
    port.write_all(b"\r\n\x03\x04\x7f").expect("it takes bytes");
    assert_eq!(read(&mut port, 5), "\x0e\x0b\x04\x05\u{fffd}");
    drop(port);
    board.stop().expect("the port was well");
}

#[test]
fn every_opening_resets_the_chip_however_short_the_pause_before() {
    let board = served();
    for _ in 0..5 {
        let mut port = open(board.path());
        assert_eq!(read(&mut port, 2), "<r");
        drop(port);
    }
    let uno = board.stop().expect("the port was well");
    assert_eq!(marks(&uno), [1, 2, 3, 4, 5, 6], "power-on and five resets");
}

#[test]
fn a_second_program_does_not_reset_the_chip() {
    let board = served();
    let mut port = open(board.path());
    assert_eq!(read(&mut port, 2), "<r");
    let second = open(board.path());
    std::thread::sleep(Duration::from_millis(10));
    drop(second);
    port.write_all(b"a").expect("it takes bytes");
    assert_eq!(read(&mut port, 1), "b");
    let uno = board.stop().expect("the port was well");
    assert_eq!(marks(&uno), [1, 2]);
}

#[test]
fn what_the_chip_says_while_the_port_is_closed_is_lost() {
    let mut uno = echo();
    let mut port = Port::new().expect("a pseudo terminal");
    let time = Duration::from_millis(20);
    port.serve(&mut uno, time).expect("it is served");
    let mut other = open(port.path());
    port.serve(&mut uno, time).expect("it is served");
    assert!(port.is_open());
    assert_eq!(read(&mut other, 2), "<r", "of the reset alone");
    other.write_all(b"a").expect("it takes bytes");
    port.serve(&mut uno, time).expect("it is served");
    assert_eq!(read(&mut other, 1), "b", "and nothing before it");
    drop(other);
    port.serve(&mut uno, time).expect("it is served");
    assert!(!port.is_open());
}

#[test]
fn what_a_program_leaves_unread_is_not_there_for_the_next() {
    let board = served();
    let mut first = open(board.path());
    assert_eq!(read(&mut first, 2), "<r");
    first.write_all(b"abc").expect("it takes bytes");
    std::thread::sleep(Duration::from_millis(50));
    drop(first);
    std::thread::sleep(Duration::from_millis(50));
    let mut second = open(board.path());
    assert_eq!(read(&mut second, 2), "<r", "not bcd, the echo of abc");
    drop(second);
    board.stop().expect("the port was well");
}

#[test]
fn the_chip_keeps_time_with_the_wall_clock() {
    let mut uno = echo();
    let mut port = Port::new().expect("a pseudo terminal");
    let begin = Instant::now();
    port.serve(&mut uno, Duration::from_millis(200))
        .expect("it is served");
    let wall = begin.elapsed().as_secs_f64();
    let chip = uno.cycle() as f64 / FREQUENCY as f64;
    // Never ahead by more than the slice under way; behind only where this test was
    // held up.
    assert!(chip <= wall + 0.01, "{chip} s in {wall} s");
    assert!(chip > 0.05, "{chip} s in {wall} s");
}

#[test]
fn a_reset_lets_go_of_the_pins_and_keeps_time_and_memory() {
    let mut uno = echo();
    uno.run_ms(1);
    assert!(uno.is_high(Pin::d(9)));
    uno.reset();
    assert!(!uno.is_high(Pin::d(9)));
    assert_eq!(uno.ms().floor(), 1.0);
    uno.run_ms(1);
    assert!(uno.is_high(Pin::d(9)));
    assert_eq!(marks(&uno), [1, 2]);
}

#[test]
fn a_reset_wakes_a_chip_that_sleeps_for_ever() {
    let halted = "int main(void) { asm(\"cli\\n sleep\"); for (;;) {} }";
    let mut uno = Uno::with_image(avr_gcc::c(halted), Fidelity::DataSheet);
    uno.run_ms(1);
    assert_eq!(*uno.state(), simulated_uno::State::Halted);
    uno.reset();
    assert_eq!(*uno.state(), simulated_uno::State::Alive);
}

#[test]
fn after_a_reset_a_board_as_sold_starts_in_its_boot_loader() {
    let loader = avr_gcc::assembler_at(0x7e00, "ldi r16, 7\n out GPIOR0, r16\n loop: rjmp loop");
    let mut uno = Uno::with_boot_loader(loader, Fidelity::DataSheet);
    uno.run_ms(1);
    uno.reset();
    uno.run_ms(1);
    assert_eq!(marks(&uno), [7, 7]);
    assert_eq!(uno.flash()[0], 0xff);
    assert_eq!(uno.flash()[0x7e00..0x7e02], [0x07, 0xe0]);
}
