//! Tests of the start: whatever values a boot loader or a crash left in the registers, the pulses match those of a cold
//! start.

use lizard_host_tests::FirmwareBench;
use simulated_uno::{CYCLES_PER_MS, Edge, Fidelity, Uno};

use crate::pulses::servo_edges;
use crate::run_in_both_simulations;

/// Data addresses of registers, data sheet, section 30.
const TCCR1A: u16 = 0x80;
const TCCR1B: u16 = 0x81;
const TCNT1: u16 = 0x84;
const OCR1A: u16 = 0x88;
const SMCR: u16 = 0x53;
const PORTS: [u16; 3] = [0x25, 0x28, 0x2b];

/// Starts the board with these register values, sends `stand`, and returns the servos' edges in the first second.
fn record_edges_with(register_values: &[(u16, u8)], fidelity: Fidelity) -> Vec<Edge> {
    let mut bench = FirmwareBench::power_on(fidelity);
    for (register, value) in register_values {
        bench.uno.poke(*register, *value);
    }
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
        for clock in 1..=5 {
            let running_edges = record_edges_with(&[(TCCR1B, clock)], fidelity);
            assert_eq!(running_edges, cold_edges, "TCCR1B = {clock}");
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
        let mut bench = FirmwareBench::power_on(fidelity);
        for (register, value) in [(TCCR1B, 1), (TCNT1 + 1, 0x12), (TCNT1, 0x34)] {
            bench.uno.poke(register, value);
        }
        let read_word =
            |uno: &Uno, address| u16::from_le_bytes([uno.peek(address), uno.peek(address + 1)]);
        let is_top_set = |uno: &Uno| read_word(uno, OCR1A) == 63_999;
        assert!(bench.uno.run_until(100_000, 1, is_top_set));
        let clock = bench.uno.peek(TCCR1B) & 7;
        assert_eq!(clock, 0, "the timer counts during its setup");
        assert!(bench.uno.run_until(1_000, 1, |uno| uno.peek(TCCR1B) != 0));
        assert_eq!(read_word(&bench.uno, TCNT1), 0);
        // The mode is clear on compare match with OCR1A, without a prescaler.
        assert_eq!((bench.uno.peek(TCCR1A), bench.uno.peek(TCCR1B)), (0, 0x09));
    });
}

#[test]
fn main_sleeps_in_idle_mode() {
    // The simulation has only one sleep mode, so the test reads the register. Idle mode is 000 (data sheet, 10.2); the
    // last bit enables sleep.
    let bench = FirmwareBench::boot_with(Fidelity::DataSheet);
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
        let mut early_edges = high_pin_edges
            .iter()
            .take_while(|edge| edge.cycle < first_cycle);
        let late_rise = early_edges.find(|edge| edge.is_rising && edge.cycle >= CYCLES_PER_MS);
        assert_eq!(late_rise, None);
        let mut bench = FirmwareBench::power_on(fidelity);
        for (port, bits) in ports {
            bench.uno.poke(port, bits);
        }
        bench.run_ms(1);
        let [port_b, port_c, port_d] = PORTS.map(|port| bench.uno.peek(port));
        // D0 and D1 belong to the serial line.
        assert_eq!([port_b, port_c, port_d & !0x03], [0; 3]);
        let mut later_edges = high_pin_edges.clone();
        later_edges.retain(|edge| edge.cycle >= first_cycle);
        assert_eq!(later_edges, cold_edges);
    });
}
