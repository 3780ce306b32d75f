//! Tests of disturbances of the simulated UNO: foreign interrupts, which have no source on the chip, a main program
//! that makes no progress, and registers written from outside.

use super::*;

/// Program in which the LED is on for 100 cycles with interrupts disabled, and off for about 99 with interrupts
/// enabled.
const PULSES_PROGRAM: &str = "
        ldi r16, 0x08 $ out SPH, r16
        ldi r16, 0xff $ out SPL, r16
        sbi DDRB, 5
    loop:
        cli
        sbi PORTB, 5
        ldi r20, 32
    up: dec r20 $ brne up
        nop
        cbi PORTB, 5
        sei
        ldi r20, 32
    low: dec r20 $ brne low
        rjmp loop";

/// Program in which Timer1 counts to 9999, its interrupt adds one to GPIOR0, and the main program toggles D13.
const COUNTING_PROGRAM: &str = "#include <avr/io.h>
    #include <avr/interrupt.h>
    ISR(TIMER1_COMPA_vect) { GPIOR0++; }
    int main(void) {
        DDRB = 0x20; OCR1A = 9999; TIMSK1 = 2; TCCR1B = 9;
        sei();
        for (;;) PINB = 0x20;
    }";

#[test]
fn a_foreign_interrupt_waits_until_interrupts_are_enabled_and_takes_its_cycles() {
    let image = assemble(PULSES_PROGRAM);
    for fidelity in FIDELITIES {
        for cycle in 300..600 {
            let mut uno = Uno::with_image(image.clone(), fidelity);
            uno.run_until_cycle(cycle);
            uno.block_interrupts(5000);
            uno.run_until_cycle(10_000);
            let widths = pulse_widths(&uno);
            let are_equal = widths.iter().all(|width| *width == widths[0]);
            assert!(are_equal, "blocked at cycle {cycle}: {widths:?}");
            let starts: Vec<u64> = uno.pulses(LED).iter().map(|pulse| pulse.start).collect();
            let mut periods = intervals(&starts);
            let period = periods[0];
            periods.retain(|other_period| *other_period != period);
            assert_eq!(periods, [period + 5000], "blocked at cycle {cycle}");
        }
    }
}

#[test]
fn a_foreign_interrupt_ends_a_sleep_and_precedes_interrupts_of_the_chip() {
    let image = compile_with_headers(
        "ISR(TIMER1_COMPA_vect) { GPIOR0 = TCNT1 >> 4; }
        int main(void) {
            SMCR = 1; OCR1A = 9999; TIMSK1 = 2; TCCR1B = 9;
            sei();
            for (;;) asm volatile (\"sleep\");
        }",
    );
    for mut uno in unos_after(9_000, &image) {
        uno.block_interrupts(3_000);
        uno.run_until_cycle(35_000);
        let marks = mark_values(&uno);
        // The first interrupt of Timer1 is about 2000 cycles late; the following interrupts are on time.
        assert!((120..135).contains(&marks[0]), "{marks:?}");
        assert!(marks[1..].iter().all(|mark| *mark < 4), "{marks:?}");
        assert_eq!(marks.len(), 3);
    }
}

#[test]
fn bytes_beyond_the_receive_buffer_are_lost_while_interrupts_are_blocked() {
    let mut uno = new_uno(compile_receiver("GPIOR0 = UDR0;"));
    uno.run_until_cycle(1000);
    uno.send(b"abcdefgh");
    // Three bytes have arrived. Of the next five bytes, the receive buffer keeps the first two and the shift register
    // the last.
    uno.run_until_cycle(1000 + 3 * 1389 + 100);
    uno.block_interrupts(5 * 1389);
    uno.run_until_cycle(30_000);
    assert_eq!(mark_values(&uno), b"abcdeh");
    assert_eq!(uno.overrun_count(), 2);
}

#[test]
fn interrupts_are_served_while_main_is_stalled() {
    for mut uno in unos_after(25_000, &compile_c(COUNTING_PROGRAM)) {
        uno.take_edges();
        uno.stall_main(100_000);
        uno.run_until_cycle(124_000);
        assert_eq!(uno.edges().len(), 0, "a stalled main toggles no pin");
        let cycles = mark_cycles(&uno);
        assert_eq!(cycles.len(), 12, "twelve interrupts are served");
        let mut intervals = intervals(&cycles).into_iter();
        assert!(intervals.all(|interval| interval.abs_diff(10_000) < 8));
        uno.run_until_cycle(126_000);
        assert!(uno.edges().len() > 100, "main continues after the stall");
    }
}

#[test]
fn a_poke_has_the_same_effect_as_a_store() {
    for mut uno in unos_after(1000, &assemble_loop("sbi DDRB, 5")) {
        uno.poke(0x25, 0x20);
        assert!(uno.is_high(LED));
        uno.poke(0x25, 0);
        assert!(!uno.is_high(LED));
        assert_eq!(pulse_widths(&uno).len(), 1);
        // This poke starts Timer1.
        uno.poke(0x81, 1);
        uno.run_until_cycle(2000);
        uno.poke(0x8ff, 0x5a);
        assert_eq!(uno.peek(0x8ff), 0x5a);
        uno.poke(0x900, 0x5a);
        assert_eq!(uno.peek(0x900), 0);
    }
}
