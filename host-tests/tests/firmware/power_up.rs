//! Tests of the start: whatever values a boot loader or a crash left in the registers, the pulses match those of a cold
//! start.

use lizard_host_tests::FirmwareBench;
use simulated_uno::{CYCLES_PER_MS, Edge, Fidelity, Uno};

use crate::measurements::peek_word;
use crate::pulses::servo_edges;
use crate::run_in_both_simulations;

/// Data addresses of registers (data sheet, register summary).
const TCCR1A: u16 = 0x80;
const TCCR1B: u16 = 0x81;
const TCNT1: u16 = 0x84;
const OCR1A: u16 = 0x88;
const SMCR: u16 = 0x53;
const PORTS: [u16; 3] = [0x25, 0x28, 0x2b];
/// Value of OCR1A: the last count of a servo's slot of 4 ms.
const TOP: u16 = 63_999;

/// Powers on the board and sets these registers.
fn power_on_with(register_values: &[(u16, u8)], fidelity: Fidelity) -> FirmwareBench {
    let mut bench = FirmwareBench::power_on(fidelity);
    for (register, value) in register_values {
        bench.uno.poke(*register, *value);
    }
    bench
}

/// Starts the board with these register values, sends `stand`, and returns the servos' edges in the first second.
fn record_edges_with(register_values: &[(u16, u8)], fidelity: Fidelity) -> Vec<Edge> {
    let mut bench = power_on_with(register_values, fidelity);
    bench.run_ms(200);
    bench.send("stand");
    bench.run_ms(800);
    servo_edges(&bench)
}

#[test]
fn a_timer_that_was_left_running_changes_no_edge() {
    run_in_both_simulations(|fidelity| {
        let cold_edges = record_edges_with(&[], fidelity);
        assert!(cold_edges.len() > 100);
        for clock_select in 1..=5 {
            let running_edges = record_edges_with(&[(TCCR1B, clock_select)], fidelity);
            assert_eq!(running_edges, cold_edges, "TCCR1B = {clock_select}");
        }
        // 8-bit fast PWM, in which the timer uses a new value of OCR1A only after the end of its cycle.
        let pwm_edges = record_edges_with(&[(TCCR1A, 1), (TCCR1B, 0x0a)], fidelity);
        assert_eq!(pwm_edges, cold_edges);
    });
}

#[test]
fn the_timer_is_stopped_during_its_setup_and_starts_at_zero() {
    // The simulated timer restarts at every change of its mode, while the chip's timer continues to count. The test
    // therefore reads the registers.
    run_in_both_simulations(|fidelity| {
        let register_values = [(TCCR1B, 1), (TCNT1 + 1, 0x12), (TCNT1, 0x34)];
        let mut bench = power_on_with(&register_values, fidelity);
        let is_top_set = |uno: &Uno| peek_word(uno, OCR1A) == TOP;
        assert!(bench.uno.run_until(100_000, 1, is_top_set));
        let clock_select = bench.uno.peek(TCCR1B) & 7;
        assert_eq!(clock_select, 0, "the timer counts during its setup");
        assert!(bench.uno.run_until(1_000, 1, |uno| uno.peek(TCCR1B) != 0));
        assert_eq!(peek_word(&bench.uno, TCNT1), 0);
        // The mode is clear on compare match with OCR1A, without a prescaler.
        assert_eq!((bench.uno.peek(TCCR1A), bench.uno.peek(TCCR1B)), (0, 0x09));
    });
}

#[test]
fn main_sleeps_in_idle_mode() {
    // The simulation has only one sleep mode, so the test reads the register. Idle mode is 000 (data sheet, 10.3); the
    // last bit enables sleep.
    let bench = FirmwareBench::boot(Fidelity::DataSheet);
    assert_eq!(bench.uno.peek(SMCR), 0b0001);
}

#[test]
fn pins_left_high_go_low_without_a_pulse() {
    run_in_both_simulations(|fidelity| {
        let cold_edges = record_edges_with(&[], fidelity);
        let ports = PORTS.map(|port| (port, 0xff));
        let high_pin_edges = record_edges_with(&ports, fidelity);
        // The pull-ups may raise pins before main begins, for much less than a servo's pulse. Afterwards nothing drives
        // the pins until the robot is loaded; the simulation keeps a pin's last level.
        let first_cycle = cold_edges[0].cycle;
        let is_early = |edge: &Edge| edge.cycle < first_cycle;
        let (early_edges, later_edges): (Vec<Edge>, Vec<Edge>) =
            high_pin_edges.into_iter().partition(is_early);
        let is_late_rise = |edge: &&Edge| edge.is_rising && edge.cycle >= CYCLES_PER_MS;
        assert_eq!(early_edges.iter().find(is_late_rise), None);
        assert_eq!(later_edges, cold_edges);
        let mut bench = power_on_with(&ports, fidelity);
        bench.run_ms(1);
        let [port_b, port_c, port_d] = PORTS.map(|port| bench.uno.peek(port));
        // D0 and D1 belong to the serial line.
        assert_eq!([port_b, port_c, port_d & !0x03], [0; 3]);
    });
}
