//! Tests of the simulated chip on a falling and rising supply, against the data sheet, sections 11.3 and 11.5.

use super::adc::compile;
use super::*;

#[test]
fn a_supply_below_the_brown_out_level_holds_the_chip_in_reset() {
    // "When VCC decreases to a value below the trigger level (VBOT-), the Brown-out
    // Reset is immediately activated. When VCC increases above the trigger level
    // (VBOT+), the delay counter starts the MCU"; "VBOT+ = VBOT + VHYST/2" (11.5),
    // with 2.7 V and 50 mV.
    let body = "int main(void) { DDRB = 2; PORTB = 2; for (;;) GPIOR0 = MCUSR; }";
    let mut uno = new_uno(compile(body));
    run_at_supply(&mut uno, 2676.0, 1);
    assert!(!uno.is_held_in_reset() && uno.is_high(Pin::d(9)));
    run_at_supply(&mut uno, 2674.0, 1);
    assert!(uno.is_held_in_reset() && !uno.is_high(Pin::d(9)));
    uno.set_supply_mv(2724.0);
    uno.take_marks();
    assert_eq!(*uno.run_ms(1), State::Alive);
    assert!(uno.is_held_in_reset() && uno.marks().is_empty());
    assert_eq!(uno.cycle(), 3 * CYCLES_PER_MS, "time passes in reset");
    assert_eq!(uno.sleep_cycles(), 0, "a chip in reset is not asleep");
    run_at_supply(&mut uno, 2726.0, 1);
    assert!(!uno.is_held_in_reset());
    assert_eq!(mark_values(&uno)[0], 0x05);
    assert_eq!(reset_causes(&uno), [PowerOn, BrownOut]);
}

#[test]
fn a_ramp_resets_and_restarts_the_chip_at_the_brown_out_levels() {
    // From 5000 mV to 2000 mV and back, 1 mV in 1000 cycles.
    let mut uno = new_uno(compile("int main(void) { for (;;) {} }"));
    uno.run_cycles(1000);
    uno.ramp_supply_mv(2000.0, 3_000_000);
    uno.run_cycles(2_325_000 - 100);
    assert!(!uno.is_held_in_reset());
    uno.run_cycles(200);
    assert!(uno.is_held_in_reset());
    uno.run_cycles(700_000);
    uno.ramp_supply_mv(5000.0, 3_000_000);
    let ramp_start = uno.cycle();
    uno.run_cycles(3_000_000);
    let restart = uno.reset_events()[1];
    assert_eq!(restart.cause, BrownOut);
    let is_on_time = (restart.cycle - ramp_start).abs_diff(725_000) < 100;
    assert!(is_on_time, "{restart:?}");
}

#[test]
fn the_sram_survives_a_brown_out_but_not_a_loss_of_power() {
    let body = "static volatile unsigned char kept __attribute__((section(\".noinit\")));
        int main(void) { GPIOR0 = kept == 0x5a; GPIOR0 = MCUSR; kept = 0x5a; for (;;) {} }";
    for (lowest_mv, is_kept, flags) in [(1400.0, 1, 0x05), (1200.0, 0, 0x01)] {
        let mut uno = uno_after_ms(1, compile(body));
        run_at_supply(&mut uno, lowest_mv, 1);
        run_at_supply(&mut uno, 5000.0, 1);
        assert_eq!(mark_values(&uno)[2..], [is_kept, flags], "{lowest_mv} mV");
        run_at_supply(&mut uno, 2000.0, 1);
        run_at_supply(&mut uno, 5000.0, 1);
        assert_eq!(
            mark_values(&uno)[4..],
            [1, flags | 0x04],
            "the SRAM survives the second brown-out"
        );
    }
}

#[test]
fn a_ramp_continues_while_the_chip_is_in_reset() {
    let mut uno = new_uno(compile("int main(void) { for (;;) GPIOR0 = MCUSR; }"));
    uno.ramp_supply_mv(1000.0, 10 * CYCLES_PER_MS);
    uno.run_ms(11);
    run_at_supply(&mut uno, 2000.0, 1);
    uno.ramp_supply_mv(5000.0, 10 * CYCLES_PER_MS);
    uno.run_ms(11);
    assert_eq!(reset_causes(&uno), [PowerOn; 2]);
}

#[test]
fn without_brown_out_detection_the_chip_runs_down_to_the_power_on_level() {
    let mut uno = new_uno(compile("int main(void) { for (;;) GPIOR0 = 1; }"));
    uno.set_brown_out_mv(None);
    for (mv, is_held) in [(1310.0, false), (1290.0, true), (1390.0, true)] {
        run_at_supply(&mut uno, mv, 1);
        assert_eq!(uno.is_held_in_reset(), is_held, "{mv} mV");
    }
    run_at_supply(&mut uno, 1410.0, 1);
    assert_eq!(reset_causes(&uno), [PowerOn; 2]);
    uno.set_brown_out_mv(Some(4300.0));
    uno.run_cycles(10);
    assert!(uno.is_held_in_reset());
}

#[test]
fn an_eeprom_write_survives_a_brown_out_but_is_torn_below_1_8_v() {
    let body = "int main(void) {
        if (MCUSR & 4) for (;;) {}
        EEAR = 0; EEDR = 0x0f; EECR = 4; EECR |= 2;
        for (;;) {} }";
    for (lowest_mv, expected) in [(1810.0, 0x0f), (1790.0, 0x4f)] {
        let mut uno = new_uno(compile(body));
        uno.set_torn_bits(0x40);
        uno.run_ms(3);
        run_at_supply(&mut uno, lowest_mv, 1);
        run_at_supply(&mut uno, 5000.0, 2);
        assert_eq!(uno.eeprom()[0], expected, "{lowest_mv} mV");
    }
}

#[test]
fn the_watchdog_is_stopped_during_a_brown_out() {
    let body = "#include <avr/wdt.h>
        int main(void) { GPIOR0 = MCUSR; MCUSR = 0; wdt_enable(WDTO_15MS); for (;;) {} }";
    let mut uno = uno_after_ms(20, compile(body));
    run_at_supply(&mut uno, 2000.0, 100);
    run_at_supply(&mut uno, 5000.0, 10);
    assert_eq!(mark_values(&uno), [1, 8, 4]);
    uno.run_ms(10);
    assert_eq!(mark_values(&uno), [1, 8, 4, 8]);

    // A WDRF that is still set switches the watchdog on at each reset, but not during a brown-out.
    let body = "#include <avr/wdt.h>
        int main(void) { if (!(MCUSR & 8)) wdt_enable(WDTO_15MS); for (;;) {} }";
    let mut uno = uno_after_ms(20, compile(body));
    run_at_supply(&mut uno, 2000.0, 100);
    assert_eq!(uno.watchdog_reset_count(), 1);
}

#[test]
fn after_power_on_the_chip_starts_only_when_the_supply_is_high_enough() {
    let mut uno = new_uno(compile("int main(void) { for (;;) GPIOR0 = MCUSR; }"));
    uno.set_supply_mv(2000.0);
    uno.power_cycle();
    uno.take_marks();
    uno.run_ms(1);
    assert!(uno.is_held_in_reset() && uno.marks().is_empty());
    uno.reset();
    uno.run_ms(1);
    let has_no_mark = uno.marks().is_empty();
    assert!(has_no_mark, "the RESET pin does not start the chip either");
    uno.ramp_supply_mv(5000.0, CYCLES_PER_MS);
    uno.run_ms(2);
    assert_eq!(mark_values(&uno)[0], 1);
    assert_eq!(reset_causes(&uno), [PowerOn; 2]);
}

#[test]
fn ramps_and_power_cuts_affect_firmware_that_sleeps_forever() {
    let mut uno = new_uno(compile(
        "int main(void) { GPIOR0 = MCUSR; SMCR = 1; asm volatile (\"sleep\"); for (;;) {} }",
    ));
    uno.ramp_supply_mv(2000.0, CYCLES_PER_MS);
    assert_eq!(*uno.run_ms(2), State::Alive);
    assert!(uno.is_held_in_reset());
    let body = "int main(void) { SMCR = 1; asm volatile (\"sleep\"); for (;;) {} }";
    let mut sleeping_uno = new_uno(compile(body));
    sleeping_uno.cut_power(PowerCut::AtCycle(1000 * CYCLES_PER_US), 0);
    assert_eq!(*sleeping_uno.run_ms(2), State::Off);
}
