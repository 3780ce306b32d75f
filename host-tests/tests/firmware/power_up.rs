//! Whatever the boot loader or a crash has left in the registers, the pulses are
//! those of a cold start.

use lizard_host_tests::FirmwareBench;
use simulated_uno::{CYCLES_PER_MS, Edge, Fidelity};

use crate::in_both;
use crate::pulses::servo_edges;

/// Registers, by data address: data sheet, 30.
const TCCR1A: u16 = 0x80;
const TCCR1B: u16 = 0x81;
const PORTS: [u16; 3] = [0x25, 0x28, 0x2b];

/// The servos' edges in the first second after registers were left so; the robot is
/// told to stand.
fn edges_after(left: &[(u16, u8)], fidelity: Fidelity) -> Vec<Edge> {
    let mut bench = FirmwareBench::power_on(fidelity);
    for (register, value) in left {
        bench.uno.poke(*register, *value);
    }
    bench.run_ms(200);
    bench.send("stand");
    bench.run_ms(800);
    servo_edges(&bench.uno)
}

#[test]
fn a_timer_that_was_left_running_changes_no_edge() {
    in_both(|fidelity| {
        let cold = edges_after(&[], fidelity);
        assert!(cold.len() > 100);
        for clock in 1..=5 {
            let running = edges_after(&[(TCCR1B, clock)], fidelity);
            assert_eq!(running, cold, "TCCR1B = {clock}");
        }
        // As an 8-bit fast PWM, which takes a new OCR1A at its top only.
        let pwm = edges_after(&[(TCCR1A, 1), (TCCR1B, 0x0a)], fidelity);
        assert_eq!(pwm, cold);
    });
}

#[test]
fn pins_that_were_left_high_go_low_and_make_no_pulse() {
    in_both(|fidelity| {
        let cold = edges_after(&[], fidelity);
        let ports = PORTS.map(|port| (port, 0xff));
        let left = edges_after(&ports, fidelity);
        // What the pull-ups lift before main has begun ends long before a servo sees
        // a pulse of it.
        let first = cold[0].cycle;
        let mut early = left.iter().take_while(|edge| edge.cycle < first);
        assert!(early.all(|edge| edge.cycle < CYCLES_PER_MS));
        let rest: Vec<Edge> = left
            .iter()
            .copied()
            .filter(|edge| edge.cycle >= first)
            .collect();
        assert_eq!(rest, cold);
    });
}
