//! Tests of the serial line's settings, read from the chip and measured on the wire.

use lizard_host_tests::FirmwareBench;
use simulated_uno::Fidelity;

use crate::start_in_both_simulations;

/// Data address of a register of the USART, data sheet 20.11.
const UCSR0C: u16 = 0xc2;

#[test]
fn the_line_has_eight_data_bits_no_parity_and_one_stop_bit() {
    start_in_both_simulations(FirmwareBench::boot, |bench| {
        // The fields are: asynchronous 00, no parity 00, one stop bit 0, eight data bits 11.
        assert_eq!(bench.uno.peek(UCSR0C), 0b0000_0110);
    });
}

#[test]
fn a_byte_on_the_wire_takes_ten_bits_of_136_cycles() {
    let mut bench = FirmwareBench::boot(Fidelity::DataSheet);
    bench.say("help");
    let cycles: Vec<u64> = bench.bytes().iter().map(|byte| byte.cycle).collect();
    let intervals: Vec<u64> = cycles.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert_eq!(intervals.iter().min(), Some(&1360));
    let is_back_to_back = |interval: &&u64| **interval == 1360;
    let back_to_back_count = intervals.iter().filter(is_back_to_back).count();
    assert!(
        back_to_back_count > intervals.len() * 9 / 10,
        "{back_to_back_count} of {} bytes follow without a gap",
        intervals.len()
    );
}
