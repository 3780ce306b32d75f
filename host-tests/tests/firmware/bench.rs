//! Tests of the test bench, [`FirmwareBench`], with a small program that, like the firmware, answers lines and drives
//! four servos.

use lizard_host_tests::{FRAME_CYCLES, FirmwareBench, avr_gcc::compile_c};
use simulated_uno::{Fidelity, Uno};

/// A program that times slots of 4 ms in a busy loop, without interrupts. The pulses of A1 to A4 are 1000, 1200, 1400
/// and 1600 us wide in the first frame, and lengthen by one microsecond per frame. The byte `r` stops the pulses, and
/// `?` prints two notes and an answer.
const SERVO_PROGRAM: &str = r##"
    #include <avr/io.h>
    static void write(const char *text) {
        while (*text) { while (!(UCSR0A & 0x20)) {} UDR0 = *text++; }
    }
    static void wait_until(unsigned ticks) { while (TCNT1 < ticks) {} }
    static volatile unsigned char is_resting;
    static void answer_byte(void) {
        if (!(UCSR0A & 0x80)) return;
        unsigned char byte = UDR0;
        if (byte == '?') write("# one\r\n# two\r\nok asked\r\n");
        if (byte == 'r') { is_resting = 1; write("ok resting\r\n"); }
    }
    int main(void) {
        UCSR0A = 2; UBRR0 = 16; UCSR0B = 0x18;
        DDRB = 0x0e; DDRD = 0x08;
        OCR1A = 7999; TCCR1B = 0x0a;            /* CTC, 0.5 us, 4 ms */
        write("# lizard test\r\n");
        for (unsigned frame = 0;; frame++) {
            for (unsigned char slot = 0; slot < 5; slot++) {
                while (!(TIFR1 & 2)) {}
                TIFR1 = 2;
                if (!is_resting) {
                    if (slot < 3) PORTB = 2 << slot;
                    if (slot == 3) PORTD = 8;
                }
                wait_until(2000 + 400 * slot + 2 * frame);
                PORTB = 0;
                PORTD = 0;
                answer_byte();
            }
        }
    }"##;

fn load_program(program: &str) -> FirmwareBench {
    let uno = Uno::with_image(compile_c(program), Fidelity::DataSheet);
    FirmwareBench::with_uno(uno)
}

#[test]
fn the_answer_to_a_line_is_distinguished_from_the_notes_before_it() {
    let mut bench = load_program(SERVO_PROGRAM);
    assert_eq!(bench.next_line(500).as_deref(), Some("# lizard test"));
    let (notes, answer) = bench.ask("?");
    assert_eq!(notes, ["# one", "# two"]);
    assert_eq!(answer, "ok asked");
    assert_eq!(bench.say("r"), "ok resting");
    assert_eq!(bench.lines().len(), 5);
}

#[test]
#[should_panic(expected = "no answer to \"x\"")]
fn a_line_without_an_answer_panics() {
    load_program(SERVO_PROGRAM).say("x");
}

#[test]
fn each_frame_has_one_pulse_of_each_servo() {
    let mut bench = load_program(SERVO_PROGRAM);
    bench.run_ms(100);
    let mut frames = bench.run_for_frames(10);
    frames.extend(bench.run_for_frames(5));
    assert_eq!(frames.len(), 15);
    let first_widths = frames[0].expect_all_widths();
    for (n, frame) in frames.iter().enumerate() {
        for (servo, width) in frame.expect_all_widths().into_iter().enumerate() {
            // One microsecond per frame, 200 us per servo; the loops react within 40 cycles.
            let expected = first_widths[0] + 16 * n as u64 + 3200 * servo as u64;
            let error = width.abs_diff(expected);
            assert!(error <= 40, "frame {n}, A{}: {width} cycles", servo + 1);
        }
    }
    for pair in frames.windows(2) {
        assert_eq!(pair[1].start - pair[0].start, FRAME_CYCLES);
    }
}

#[test]
fn the_calls_of_a_named_function_are_timed() {
    let mut bench = load_program(
        "#include <avr/io.h>
         __attribute__((noinline)) void work(void) { __builtin_avr_delay_cycles(1000); }
         int main(void) { for (;;) work(); }",
    );
    let calls = bench.time_calls("work", 10);
    assert!(calls.len() > 100);
    for call in calls {
        // 1000 cycles of delay and 4 of `ret`.
        assert_eq!(call.cycles(), 1004, "{call:?}");
    }
}

#[test]
#[should_panic(expected = "exactly one function walk")]
fn timing_a_function_that_does_not_exist_panics() {
    load_program(SERVO_PROGRAM).time_calls("walk", 1);
}

#[test]
fn a_resting_robot_has_silent_frames() {
    let mut bench = load_program(SERVO_PROGRAM);
    bench.run_ms(100);
    bench.say("r");
    let frames = bench.run_for_frames(3);
    assert!(frames.iter().all(|frame| frame.is_silent()), "{frames:?}");
}
