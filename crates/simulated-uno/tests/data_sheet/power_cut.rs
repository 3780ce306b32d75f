//! Tests of power cuts during an EEPROM write.

use super::eeprom::{ATOMIC_CYCLES, compile};
use super::*;

/// Program that writes 0x35 over 0xa6 at address 0, then 0x5c at address 1. If address 0 does not contain 0xa6, as
/// after a power cut, the program only marks the byte that it contains.
const TWO_BYTES_PROGRAM: &str = "int main(void) {
    if (get(0) != 0xa6) { GPIOR0 = get(0); for (;;) {} }
    set(0, 0x35, 0); set(1, 0x5c, 0); while (busy()) {}
    for (;;) {} }";

/// Returns a UNO with [`TWO_BYTES_PROGRAM`] at power-on, and 0xa6 at address 0 of its EEPROM.
fn uno_writing_two_bytes() -> Uno {
    let mut uno = new_uno(compile(TWO_BYTES_PROGRAM));
    let mut contents = [0xff; EEPROM_SIZE];
    contents[0] = 0xa6;
    uno.set_eeprom(&contents);
    uno
}

/// Returns the UNO of [`uno_writing_two_bytes`] after this power cut; for `ones`, see [`Uno::cut_power`].
#[track_caller]
fn uno_after_cut(cut: PowerCut, ones: u8) -> Uno {
    let mut uno = uno_writing_two_bytes();
    uno.cut_power(cut, ones);
    assert_eq!(*uno.run_ms(20), State::Off);
    uno
}

#[test]
fn a_power_cut_in_the_erase_phase_leaves_the_old_byte_with_the_chosen_bits_set() {
    for ones in [0, 0x01, 0x58, 0x0f, 0xff] {
        let uno = uno_after_cut(PowerCut::InErase(0), ones);
        assert_eq!(uno.eeprom()[..2], [0xa6 | ones, 0xff]);
        let operations = uno.eeprom_operations();
        assert_eq!(operations.len(), 1);
        assert!(operations[0].is_torn);
        assert_eq!(operations[0].new_value, 0xa6 | ones);
        let elapsed_cycles = uno.cycle() - operations[0].cycle;
        let is_on_time = elapsed_cycles.abs_diff(ATOMIC_CYCLES / 4) < 10;
        assert!(is_on_time, "{elapsed_cycles}");
    }
}

#[test]
fn a_power_cut_in_the_write_phase_leaves_the_new_byte_with_the_chosen_bits_set() {
    for ones in [0, 0x80, 0x4a, 0xff] {
        let uno = uno_after_cut(PowerCut::InWrite(1), ones);
        assert_eq!(uno.eeprom()[..2], [0x35, 0x5c | ones]);
        let operations = uno.eeprom_operations();
        assert!(!operations[0].is_torn && operations[1].is_torn);
        let elapsed_cycles = uno.cycle() - operations[1].cycle;
        let is_on_time = elapsed_cycles.abs_diff(ATOMIC_CYCLES / 4 * 3) < 10;
        assert!(is_on_time, "{elapsed_cycles}");
    }
}

#[test]
fn a_power_cut_at_a_cycle_tears_the_byte_according_to_its_phase() {
    let mut unbroken_uno = uno_writing_two_bytes();
    unbroken_uno.run_ms(20);
    let start = unbroken_uno.eeprom_operations()[1].cycle;
    for (delay_cycles, expected) in [
        (100, 0xff),
        (ATOMIC_CYCLES / 2 - 100, 0xff),
        (ATOMIC_CYCLES / 2 + 100, 0x5e),
        (ATOMIC_CYCLES - 100, 0x5e),
        (ATOMIC_CYCLES + 100, 0x5c),
    ] {
        let uno = uno_after_cut(PowerCut::AtCycle(start + delay_cycles), 0x02);
        assert!(uno.cycle() - (start + delay_cycles) < 5);
        let bytes = uno.eeprom();
        assert_eq!(bytes[..2], [0x35, expected], "after {delay_cycles} cycles");
    }
}

#[test]
fn erase_only_operations_set_torn_bits_and_write_only_operations_keep_them() {
    let tear_byte = |mode: u8, cut: PowerCut, ones: u8| {
        let body = format!("int main(void) {{ set(0, 0x35, {mode}); for (;;) {{}} }}");
        let mut uno = new_uno(compile(&body));
        uno.set_eeprom(&[0xa6; EEPROM_SIZE]);
        uno.cut_power(cut, ones);
        assert_eq!(*uno.run_ms(5), State::Off);
        uno.eeprom()[0]
    };
    // EEPM mode 1 only erases, mode 2 only writes.
    for cut in [PowerCut::InErase(0), PowerCut::InWrite(0)] {
        assert_eq!(tear_byte(1, cut, 0x11), 0xa6 | 0x11);
        assert_eq!(tear_byte(2, cut, 0x82), 0xa6 & (0x35 | 0x82));
        assert_eq!(tear_byte(2, cut, 0x00), 0xa6 & 0x35);
    }
}

#[test]
fn a_board_restarts_after_a_power_cut_with_the_same_eeprom() {
    let mut uno = uno_after_cut(PowerCut::InWrite(0), 0x08);
    let cut_cycle = uno.cycle();
    let state = uno.run_ms(20);
    assert_eq!(*state, State::Off, "the chip does not run without power");
    assert_eq!(uno.cycle(), cut_cycle);
    uno.power_cycle();
    assert_eq!(*uno.run_ms(20), State::Alive);
    assert_eq!(mark_values(&uno), [0x35 | 0x08]);
    assert_eq!(reset_causes(&uno), [PowerOn; 2]);
}

#[test]
fn a_power_cut_happens_once() {
    let body = "int main(void) { set(0, get(0) - 1, 0); for (;;) {} }";
    for cut in [PowerCut::AtCycle(30_000), PowerCut::InErase(0)] {
        let mut uno = new_uno(compile(body));
        uno.cut_power(cut, 0xff);
        assert_eq!(*uno.run_ms(5), State::Off);
        uno.power_cycle();
        assert_eq!(*uno.run_ms(5), State::Alive);
        assert_eq!(uno.eeprom()[0], 0xfe);
    }
}

#[test]
fn a_reset_before_a_power_cut_does_not_prevent_it() {
    for cut in [PowerCut::AtCycle(40_000), PowerCut::InWrite(0)] {
        let mut uno = uno_writing_two_bytes();
        uno.cut_power(cut, 0x02);
        uno.run_ms(1);
        uno.reset();
        assert_eq!(*uno.run_ms(20), State::Off);
        assert_eq!(uno.eeprom()[0], 0x37);
        assert!(uno.cycle().abs_diff(40_900) < 1_000, "{}", uno.cycle());
    }
}

#[test]
fn a_cancelled_power_cut_does_not_happen() {
    let mut uno = uno_writing_two_bytes();
    uno.cut_power(PowerCut::AtCycle(60_000), 0);
    uno.cut_power(PowerCut::InErase(1), 0);
    uno.cancel_power_cut();
    assert_eq!(*uno.run_ms(20), State::Alive);
    assert_eq!(uno.eeprom()[..2], [0x35, 0x5c]);
}

#[test]
fn a_power_cycle_during_a_write_tears_the_byte() {
    let mut uno = uno_writing_two_bytes();
    uno.set_torn_bits(0x40);
    uno.run_ms(1);
    uno.power_cycle();
    assert_eq!(uno.eeprom()[0], 0xe6);
}
