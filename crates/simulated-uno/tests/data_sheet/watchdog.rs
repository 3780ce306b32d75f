//! Tests of the simulated watchdog against the data sheet, sections 11.8 and 11.9.2.

use super::*;

/// The shortest time-out, 2 048 cycles of the 128 kHz oscillator, in CPU cycles.
const MIN_TIMEOUT_CYCLES: u64 = 16 * CYCLES_PER_MS;

/// Returns the cycles at which the watchdog has reset the chip.
fn watchdog_reset_cycles(uno: &Uno) -> Vec<u64> {
    let resets = uno.reset_events().into_iter();
    let watchdog_events = resets.filter(|reset| reset.cause == Watchdog);
    watchdog_events.map(|reset| reset.cycle).collect()
}

/// Compiles a program in which the macro `set(value)` runs the timed sequence of 11.8.2 and writes `value` to WDTCSR.
fn compile(body: &str) -> Image {
    compile_with_headers(&format!(
        "#define wdr() asm volatile (\"wdr\")
        #define set(value) do {{ unsigned char v = (value); asm volatile ( \
            \"sts %1, %2\\n sts %1, %0\" :: \"r\"(v), \"n\"(_SFR_MEM_ADDR(WDTCSR)), \
            \"r\"((unsigned char)0x18)); }} while (0)
        {body}"
    ))
}

/// Returns a UNO that has run this program, with the macros of [`compile`], for a number of milliseconds.
fn run(body: &str, ms: u64) -> Uno {
    uno_after_ms(ms, compile(body))
}

/// Runs a main program that clears MCUSR and then runs these statements once. Returns the UNO after `ms` milliseconds.
fn run_once(body: &str, ms: u64) -> Uno {
    let program = format!("int main(void) {{ MCUSR = 0; {body} for (;;) {{}} }}");
    run(&program, ms)
}

/// Returns the number of cycles from the mark with this index to the first reset by the watchdog.
fn cycles_to_reset(uno: &Uno, mark_index: usize) -> u64 {
    watchdog_reset_cycles(uno)[0] - uno.marks()[mark_index].cycle
}

#[test]
fn time_outs_of_all_prescalers_match_table_11_2() {
    // "WDP3:0 0 to 9: 2K to 1024K cycles, 16 ms to 8.0 s" at 128 kHz.
    for wdp in 0..10u8 {
        let value = 0x08 | (wdp & 7) | (wdp & 8) << 2;
        // The program switches the watchdog off after one reset, so that no second reset follows.
        let body = format!(
            "int main(void) {{
                if (MCUSR & 8) {{ MCUSR = 0; set(0); for (;;) {{}} }}
                GPIOR0 = 1; set({value}); SMCR = 1; asm volatile (\"sleep\"); for (;;) {{}} }}"
        );
        let expected = MIN_TIMEOUT_CYCLES << wdp;
        let uno = uno_after(expected + CYCLES_PER_MS, compile(&body));
        assert_eq!(watchdog_reset_cycles(&uno).len(), 1, "WDP = {wdp}");
        let elapsed_cycles = cycles_to_reset(&uno, 0);
        assert_within(expected..expected + 12, elapsed_cycles);
    }
}

#[test]
fn the_time_out_starts_at_the_last_wdr_or_when_the_watchdog_is_switched_on() {
    for (message, body, ms, mark_index, expected) in [
        (
            "wdr restarts the time-out",
            "set(8); for (unsigned char i = 0; i < 10; i++) { _delay_ms(15); GPIOR0 = i; wdr(); }",
            175,
            9,
            MIN_TIMEOUT_CYCLES..MIN_TIMEOUT_CYCLES + 5,
        ),
        (
            "a watchdog that was off starts with the full time-out",
            "_delay_ms(40); GPIOR0 = 1; set(8);",
            57,
            0,
            MIN_TIMEOUT_CYCLES..MIN_TIMEOUT_CYCLES + 12,
        ),
        (
            // "The Watchdog Timer should be reset before any change of the WDP bits, since
            // a change in the WDP bits can result in a time-out when switching to a shorter
            // time-out period" (11.8.2).
            "a shorter prescaler does not restart the time-out",
            "set(0x0e); _delay_ms(20); GPIOR0 = 1; set(8);",
            21,
            0,
            0..20,
        ),
    ] {
        let elapsed_cycles = cycles_to_reset(&run_once(body, ms), mark_index);
        let is_expected = expected.contains(&elapsed_cycles);
        assert!(is_expected, "{message}: {elapsed_cycles}");
    }
}

/// Returns a UNO after 17 ms of a program that starts the watchdog with a time-out of 16 ms, sets WDCE and WDE, and
/// writes 0 to WDTCSR after `nop_count` nops.
fn switch_off_after_nops(nop_count: usize) -> Uno {
    let source = format!(
        "ldi r16, 0 $ out MCUSR, r16
         ldi r17, 0x18 $ ldi r18, 0
         ldi r16, 0x08 $ sts WDTCSR, r16
         sts WDTCSR, r17
         {}
         sts WDTCSR, r18",
        "nop\n".repeat(nop_count)
    );
    uno_after_ms(17, assemble_loop(&source))
}

#[test]
fn wde_is_cleared_only_within_four_cycles_after_wdce() {
    // "Within the next four clock cycles, write the WDE and Watchdog prescaler bits
    // (WDP) as desired, but with the WDCE bit cleared" (11.8.2).
    for (nops, is_off) in [(0, true), (2, true), (3, false), (8, false)] {
        let resets = watchdog_reset_cycles(&switch_off_after_nops(nops));
        assert_eq!(resets.is_empty(), is_off, "{nops} nops");
    }
}

#[test]
fn wdtcsr_values_match_the_data_sheet() {
    for (message, body, ms, expected) in [
        (
            "without the timed sequence, WDE is not cleared and the prescaler is not changed",
            "WDTCSR = 8; WDTCSR = 0; WDTCSR = 0x27; GPIOR0 = WDTCSR;",
            1,
            &[0x08][..],
        ),
        (
            // "but with the WDCE bit cleared" (11.8.2).
            "the second write must have WDCE cleared",
            "WDTCSR = 0x18; WDTCSR = 0x1e; GPIOR0 = WDTCSR & 0x27;",
            1,
            &[0],
        ),
        (
            // "A logic one must be written to WDE regardless of the previous value of the
            // WDE bit" (11.8.2).
            "WDCE without WDE does not allow a change",
            "WDTCSR = 0x10; WDTCSR = 7; GPIOR0 = WDTCSR;",
            1,
            &[0],
        ),
        (
            // "This bit is set when a time-out occurs in the Watchdog Timer and the Watchdog
            // Timer is configured for interrupt... WDIF is cleared by writing a logic one to
            // the flag" (11.9.2).
            "in interrupt mode, an interrupt that is not served keeps its flag and causes no reset",
            "set(0x40); _delay_ms(40); GPIOR0 = WDTCSR;
            WDTCSR = 0x40; GPIOR0 = WDTCSR;
            WDTCSR = 0xc0; GPIOR0 = WDTCSR;",
            45,
            &[0xc0, 0xc0, 0x40],
        ),
    ] {
        assert_eq!(mark_values(&run_once(body, ms)), expected, "{message}");
    }
    let uncleared_uno = run_once("WDTCSR = 8; WDTCSR = 0; WDTCSR = 0x27;", 17);
    assert_eq!(watchdog_reset_cycles(&uncleared_uno).len(), 1);
}

#[test]
fn hardware_clears_wdce_after_four_cycles() {
    // "hardware will clear WDCE after four clock cycles" (11.9.2).
    let source = "ldi r17, 0x18 $ sts WDTCSR, r17
         lds r18, WDTCSR $ lds r19, WDTCSR $ lds r20, WDTCSR
         out GPIOR0, r18 $ out GPIOR0, r19 $ out GPIOR0, r20";
    let uno = uno_after(50, assemble_loop(source));
    assert_eq!(mark_values(&uno), [0x18, 0x18, 0x08]);
}

#[test]
fn interrupt_mode_stays_on_and_does_not_reset() {
    // Table 11-1: WDE 0, WDIE 1: "Interrupt Mode", action on time-out "Interrupt".
    let body = "ISR(WDT_vect) { GPIOR0 = WDTCSR; }
        int main(void) { SMCR = 1; MCUSR = 0; set(0x40); sei(); for (;;) asm volatile (\"sleep\"); }";
    let uno = run(body, 100);
    assert_eq!(mark_values(&uno), [0x40; 6], "WDIE still set, WDIF cleared");
    assert_eq!(intervals(&mark_cycles(&uno)), [MIN_TIMEOUT_CYCLES; 5]);
    assert!(watchdog_reset_cycles(&uno).is_empty());
}

#[test]
fn interrupt_and_reset_mode_interrupts_first_and_then_resets() {
    // "The first time-out in the Watchdog Timer will set WDIF. Executing the
    // corresponding interrupt vector will clear WDIE and WDIF automatically by
    // hardware (the Watchdog goes to System Reset Mode)" (11.9.2).
    let body = "ISR(WDT_vect) { GPIOR0 = WDTCSR; }
        int main(void) {
            if (MCUSR & 8) { MCUSR = 0; set(0); for (;;) {} }
            set(0x48); sei(); for (;;) {} }";
    let uno = run(body, 40);
    assert_eq!(mark_values(&uno), [0x08]);
    let expected = MIN_TIMEOUT_CYCLES - 100..MIN_TIMEOUT_CYCLES;
    assert_within(expected, cycles_to_reset(&uno, 0));
}

#[test]
fn an_interrupt_that_is_not_served_before_the_next_time_out_causes_a_reset() {
    // "If the interrupt is not executed before the next time-out, a System Reset
    // will be applied" (11.9.2).
    let body = "int main(void) {
        if (MCUSR & 8) { MCUSR = 0; set(0); for (;;) {} }
        GPIOR0 = 1; set(0x48); for (;;) {} }";
    let uno = run(body, 40);
    let expected = 2 * MIN_TIMEOUT_CYCLES..2 * MIN_TIMEOUT_CYCLES + 12;
    assert_within(expected, cycles_to_reset(&uno, 0));
}

#[test]
fn after_its_reset_the_watchdog_runs_at_16_ms_until_wdrf_is_cleared() {
    // "WDE is overridden by WDRF in MCUSR. This means that WDE is always set when
    // WDRF is set. To clear WDE, WDRF must be cleared first" (11.9.2).
    let body = "int main(void) {
        if (!(MCUSR & 8)) { set(0x0b); for (;;) {} }
        GPIOR0 = WDTCSR & 0x2f;
        set(0); GPIOR0 = WDTCSR & 0x2f;
        for (;;) {} }";
    let uno = run(body, 128 + 40);
    assert_eq!(mark_values(&uno), [8, 8, 8, 8, 8, 8]);
    // The reset occurs at the end of the instruction in which the time-out occurs.
    for interval in &intervals(&watchdog_reset_cycles(&uno))[..2] {
        assert_within(MIN_TIMEOUT_CYCLES - 2..MIN_TIMEOUT_CYCLES + 3, *interval);
    }

    let cleared_uno = run(
        "int main(void) {
            if (!(MCUSR & 8)) { set(8); for (;;) {} }
            MCUSR = 0; GPIOR0 = WDTCSR & 0x2f; set(0); GPIOR0 = WDTCSR & 0x2f; for (;;) {} }",
        100,
    );
    assert_eq!(mark_values(&cleared_uno), [8, 0]);
    assert_eq!(cleared_uno.watchdog_reset_count(), 1);
}

#[test]
fn the_watchdog_resets_a_chip_that_sleeps_with_interrupts_disabled() {
    let image = compile(
        "int main(void) { SMCR = 1; MCUSR = 0; set(8); asm volatile (\"sleep\"); GPIOR0 = 1; for (;;) {} }",
    );
    let mut uno = new_uno(image.clone());
    assert_eq!(*uno.run_ms(40), State::Alive);
    assert_eq!(uno.watchdog_reset_count(), 2);
    assert!(uno.marks().is_empty());
    let mut stock_uno = Uno::with_image(image, Fidelity::Stock);
    assert_eq!(*stock_uno.run_ms(40), State::Halted);
}

#[test]
fn a_timer_interrupt_does_not_end_a_sleep_with_interrupts_disabled() {
    let uno = run_once(
        "SMCR = 1; OCR1A = 999; TIMSK1 = 2; TCCR1B = 9; set(8);
        asm volatile (\"sleep\"); GPIOR0 = 1;",
        40,
    );
    assert!(uno.marks().is_empty());
    assert_eq!(uno.watchdog_reset_count(), 2);
}

#[test]
fn an_interrupt_in_the_cycle_of_the_sleep_instruction_does_not_end_the_sleep() {
    // OCR1A is 20: with one of these offsets, the interrupt occurs in the cycle of `sleep`.
    for nops in 0..30 {
        let source = format!(
            "ldi r16, 0 $ out MCUSR, r16 $ ldi r16, 8 $ sts WDTCSR, r16
             ldi r16, 1 $ out SMCR, r16 $ ldi r16, 2 $ sts TIMSK1, r16
             ldi r16, 20 $ sts OCR1AL, r16 $ ldi r16, 9 $ sts TCCR1B, r16
             {}
             sleep
             out GPIOR0, r16",
            "nop\n".repeat(nops)
        );
        let uno = uno_after_ms(10, assemble_loop(&source));
        assert!(uno.marks().is_empty(), "{nops} nops");
    }
}

#[test]
fn the_division_of_a_run_does_not_change_the_cycle_of_a_watchdog_reset() {
    let image = compile("int main(void) { set(8); for (;;) GPIOR0++; }");
    let mut unbroken_uno = new_uno(image.clone());
    unbroken_uno.run_until_cycle(50 * CYCLES_PER_MS);
    let mut stepped_uno = new_uno(image.clone());
    while stepped_uno.cycle() < 50 * CYCLES_PER_MS {
        stepped_uno.run_until_cycle((stepped_uno.cycle() + 997).min(50 * CYCLES_PER_MS));
    }
    assert_eq!(stepped_uno.reset_events(), unbroken_uno.reset_events());
    let mut exact_uno = new_uno(image);
    exact_uno.run_until_cycle(watchdog_reset_cycles(&unbroken_uno)[0]);
    assert_eq!(
        exact_uno.watchdog_reset_count(),
        1,
        "a reset in the last cycle of a run is part of the run"
    );
    assert_eq!(stepped_uno.marks(), unbroken_uno.marks());
}

#[test]
fn stock_simavr_does_not_reset_in_interrupt_and_reset_mode() {
    let image = compile("int main(void) { set(0x48); for (;;) {} }");
    let mut uno = Uno::with_image(image, Fidelity::Stock);
    uno.run_ms(100);
    assert_eq!(uno.watchdog_reset_count(), 0, "{CORRECTION_IS_OBSOLETE}");
}
