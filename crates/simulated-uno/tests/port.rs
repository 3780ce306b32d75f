//! Tests of a simulated UNO behind a serial port, as another program uses it.
//!
//! This is a separate test binary: a process that a test of another module forks would have a copy of the open port
//! until its `exec`. Then closing the port here would not close the last copy, and reopening it would not reset the
//! board.

use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::path::Path;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use lizard_time_limit::TIME_LIMIT;
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use simulated_uno::avr_gcc;
use simulated_uno::{BackgroundPort, CYCLES_PER_MS, FREQUENCY, Fidelity, Image, Port, Uno};

/// Program that sends `<r` at reset, then answers every byte with that byte plus one. At each start, it marks
/// the number of starts since power-on, which it counts in a variable that a reset does not clear.
const ECHO_PROGRAM: &str = r#"
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
        UCSR0A = 1 << U2X0; UBRR0 = 16;
        UCSR0B = 1 << RXEN0 | 1 << TXEN0;
        put('<'); put('r');
        for (;;) {
            while (!(UCSR0A & 1 << RXC0)) {}
            put(UDR0 + 1);
        }
    }"#;

/// The compiled [`ECHO_PROGRAM`]. The first use, in [`echo_uno`], compiles it, before the test opens its port.
static IMAGE: LazyLock<Image> = LazyLock::new(|| avr_gcc::compile_c(ECHO_PROGRAM));

fn echo_uno() -> Uno {
    Uno::with_image(IMAGE.clone(), Fidelity::DataSheet)
}

fn serve_board() -> BackgroundPort {
    let mut uno = echo_uno();
    uno.run_ms(1);
    let port = Port::new().expect("a pseudo terminal is free");
    port.in_background(uno, |_| {})
        .expect("a thread can be started")
}

fn stop_board(board: BackgroundPort) -> Uno {
    let uno = TIME_LIMIT.run("the end of the port's thread", || board.stop());
    uno.expect("the port had no error")
}

fn open(path: &Path) -> File {
    let port = OpenOptions::new().read(true).write(true).open(path);
    port.expect("the port can be opened")
}

fn write(port: &mut File, bytes: &[u8]) {
    port.write_all(bytes).expect("the port accepts bytes");
}

fn set_baud(port: &File, baud: u32) {
    let mut settings = tcgetattr(port).expect("the port has settings");
    settings.set_speed(baud).expect("the speed is valid");
    tcsetattr(port, OptionalActions::Now, &settings).expect("the port accepts settings");
}

fn read_text(port: &File, count: usize) -> String {
    String::from_utf8_lossy(&read_bytes(port, count)).into_owned()
}

fn read_bytes(port: &File, count: usize) -> Vec<u8> {
    let mut port = port.try_clone().expect("the handle can be cloned");
    let description = format!("{count} bytes from the chip");
    TIME_LIMIT.run(&description, move || {
        let mut bytes = vec![0; count];
        port.read_exact(&mut bytes).expect("the port can be read");
        bytes
    })
}

/// Serves the port until the chip has run for `ms`.
fn serve(port: &mut Port, uno: &mut Uno, ms: u64) {
    let end_cycle = uno.cycle() + ms * CYCLES_PER_MS;
    TIME_LIMIT.wait_for("the chip's time to pass", || {
        let step = Duration::from_millis(5);
        port.serve(uno, step).expect("the port has no error");
        uno.cycle() >= end_cycle
    });
}

fn mark_values(uno: &Uno) -> Vec<u8> {
    uno.marks().iter().map(|mark| mark.value).collect()
}

#[test]
fn bytes_pass_unchanged_in_both_directions() {
    let board = serve_board();
    let mut port = open(board.path());
    assert_eq!(read_text(&port, 2), "<r");
    // Bytes that a terminal would remove or change: CR, LF, interrupt, end of file, delete.
    write(&mut port, b"\r\n\x03\x04\x7f");
    assert_eq!(read_text(&port, 5), "\x0e\x0b\x04\x05\u{fffd}");
    drop(port);
    stop_board(board);
}

#[test]
fn a_wrong_baud_rate_changes_the_bytes_in_both_directions() {
    let board = serve_board();
    let mut port = open(board.path());
    assert_eq!(read_text(&port, 2), "<r");
    set_baud(&port, 57_600);
    write(&mut port, b"0");
    // The chip reads 0, as tests/data_sheet/serial.rs explains, and sends 1. The host samples that byte at half the
    // chip's baud rate: at 3.1, 5.1 and 7.1 of the chip's bits, which are 0, then in the stop bit and on the idle
    // line.
    assert_eq!(read_bytes(&port, 1), [0b1111_1000]);
    drop(port);
    stop_board(board);
}

#[test]
fn a_baud_rate_above_the_simulators_limit_does_not_end_the_simulation() {
    let board = serve_board();
    let mut port = open(board.path());
    assert_eq!(read_text(&port, 2), "<r");
    set_baud(&port, 20_000_000);
    std::thread::sleep(Duration::from_millis(10));
    set_baud(&port, 115_200);
    std::thread::sleep(Duration::from_millis(10));
    write(&mut port, b"a");
    assert_eq!(read_text(&port, 1), "b");
    drop(port);
    stop_board(board);
}

#[test]
fn every_opening_resets_the_chip_even_after_a_short_pause() {
    let board = serve_board();
    for _ in 0..5 {
        let port = open(board.path());
        assert_eq!(read_text(&port, 2), "<r");
        drop(port);
    }
    let uno = stop_board(board);
    let marks = mark_values(&uno);
    assert_eq!(marks, [1, 2, 3, 4, 5, 6], "power-on and five resets");
}

#[test]
fn opening_an_open_port_does_not_reset_the_chip() {
    let board = serve_board();
    let mut port = open(board.path());
    assert_eq!(read_text(&port, 2), "<r");
    let second_port = open(board.path());
    std::thread::sleep(Duration::from_millis(10));
    drop(second_port);
    write(&mut port, b"a");
    assert_eq!(read_text(&port, 1), "b");
    let uno = stop_board(board);
    assert_eq!(mark_values(&uno), [1, 2]);
}

#[test]
fn output_while_the_port_is_closed_is_lost() {
    let mut uno = echo_uno();
    let mut port = Port::new().expect("a pseudo terminal is free");
    serve(&mut port, &mut uno, 20);
    let mut program_port = open(port.path());
    serve(&mut port, &mut uno, 20);
    assert!(port.is_open());
    let output = read_text(&program_port, 2);
    assert_eq!(output, "<r", "only the output after the reset is read");
    write(&mut program_port, b"a");
    serve(&mut port, &mut uno, 20);
    let answer = read_text(&program_port, 1);
    assert_eq!(answer, "b", "no earlier output precedes the answer");
    drop(program_port);
    serve(&mut port, &mut uno, 20);
    assert!(!port.is_open());
}

#[test]
fn unread_output_is_dropped_before_the_next_program_opens_the_port() {
    let mut uno = echo_uno();
    let mut port = Port::new().expect("a pseudo terminal is free");
    serve(&mut port, &mut uno, 20);
    let mut first_port = open(port.path());
    serve(&mut port, &mut uno, 20);
    assert_eq!(read_text(&first_port, 2), "<r");
    write(&mut first_port, b"abc");
    serve(&mut port, &mut uno, 20);
    drop(first_port);
    serve(&mut port, &mut uno, 20);
    let second_port = open(port.path());
    serve(&mut port, &mut uno, 20);
    let output = read_text(&second_port, 2);
    assert_eq!(output, "<r", "the echo bcd of abc is dropped");
}

#[test]
fn the_chip_is_at_most_10_ms_ahead_of_the_wall_clock() {
    let mut uno = echo_uno();
    let mut port = Port::new().expect("a pseudo terminal is free");
    let start = Instant::now();
    serve(&mut port, &mut uno, 100);
    let wall_seconds = start.elapsed().as_secs_f64();
    let chip_seconds = uno.cycle() as f64 / FREQUENCY as f64;
    // On a busy computer, the chip may lag by any amount.
    assert!(
        chip_seconds <= wall_seconds + 0.01,
        "chip {chip_seconds} s, wall clock {wall_seconds} s"
    );
}
