//! Actions and measurements that several tests share: power, servo pins, LED and console.

use lizard_host_tests::{CYCLES_PER_US, FirmwareBench};
use simulated_uno::{CYCLES_PER_MS, Edge, Pin, Pulse, Uno};

use crate::robot;

/// The LED's pin, D13.
pub const LED_PIN: Pin = Pin::d(13);

/// Runs for `ms` milliseconds and returns the pulses of A1 to A4 during this time.
pub fn run_and_record_pulses(bench: &mut FirmwareBench, ms: u64) -> [Vec<Pulse>; 4] {
    bench.uno.take_edges();
    bench.uno.run_ms(ms);
    recorded_pulses(bench)
}

/// Returns the pulses of A1 to A4 in the edges recorded since the last `take_edges`.
pub fn recorded_pulses(bench: &FirmwareBench) -> [Vec<Pulse>; 4] {
    bench.pins().map(|pin| bench.uno.pulses(pin))
}

/// Runs for 50 ms and returns the last pulse width of each servo, cycles; 0 for a servo without a pulse.
pub fn measure_widths(bench: &mut FirmwareBench) -> [u64; 4] {
    run_and_record_pulses(bench, 50).map(|pulses| pulses.last().map_or(0, |pulse| pulse.width))
}

/// Checks that each servo has at least `min_count` pulses, all of its expected width.
#[track_caller]
pub fn assert_steady(pulses: &[Vec<Pulse>; 4], widths: [u64; 4], min_count: usize) {
    for (pulses, width) in pulses.iter().zip(widths) {
        assert!(pulses.len() >= min_count && pulses.iter().all(|pulse| pulse.width == width));
    }
}

/// Runs for `ms` milliseconds and checks that no servo has a pulse.
#[track_caller]
pub fn assert_no_pulse(bench: &mut FirmwareBench, ms: u64, case: &str) {
    let pulses = run_and_record_pulses(bench, ms);
    assert!(pulses.iter().all(Vec::is_empty), "{case}: {pulses:?}");
}

/// Switches the power off and on, discards the edges recorded so far, and waits for the banner.
pub fn power_cycle(bench: &mut FirmwareBench) {
    let lines_before = bench.lines().len();
    bench.uno.power_cycle();
    bench.uno.take_edges();
    for _ in 0..500 {
        bench.uno.run_ms(1);
        // The end of a line that the power cut interrupted may come first.
        let lines = &bench.lines()[lines_before..];
        if lines.iter().any(|line| line.text.contains("# lizard ")) {
            return;
        }
    }
    let lines = &bench.lines()[lines_before..];
    panic!("no banner after power-on: {lines:?}");
}

/// Returns the lines in which `cal` prints the settings.
pub fn read_calibration(bench: &mut FirmwareBench) -> Vec<String> {
    let (mut lines, answer) = bench.ask("cal");
    assert_eq!(answer, "ok cal");
    let starts = ["# A", "# boot ", "# deadman "];
    lines.retain(|line| starts.iter().any(|start| line.starts_with(start)));
    lines
}

/// Returns a servo's slew limit, which is the largest change in its pulse width from frame to frame, cycles.
pub fn servo_slew_limit(servo: usize) -> u64 {
    let us_per_degree = robot().servos()[servo].us_per_degree;
    compute_slew_limit(us_per_degree, robot().speed_limits().slew)
}

/// Returns the slew limit of a servo with this scale and speed limit, cycles per frame.
fn compute_slew_limit(us_per_degree: f64, slew_deg_per_s: f64) -> u64 {
    // The three cycles allow for rounding: one for each of the two widths, and one for the limit, whose rounding error
    // is half an angle step.
    (slew_deg_per_s / 50.0 * us_per_degree.abs() * CYCLES_PER_US) as u64 + 3
}

/// Asserts that no pulse width of a gait differs from the previous one by more than the slew limits allow.
pub fn assert_gait_within_slew_limits(pulses: &[Vec<Pulse>; 4]) {
    let limits = robot().speed_limits();
    assert_slew(pulses, servo_scales(), limits.slew.max(limits.gait_slew));
}

/// Asserts that no pulse width of servos with these scales (us per degree) differs from the previous one by more than
/// the slew limit allows.
pub fn assert_within_slew_limit(pulses: &[Vec<Pulse>; 4], scales: [f64; 4]) {
    assert_slew(pulses, scales, robot().speed_limits().slew);
}

fn assert_slew(pulses: &[Vec<Pulse>; 4], scales: [f64; 4], slew_deg_per_s: f64) {
    for (servo, (pulses, scale)) in pulses.iter().zip(scales).enumerate() {
        let max_step = compute_slew_limit(scale, slew_deg_per_s);
        assert!(pulses.len() > 1, "A{}: {pulses:?}", servo + 1);
        for pair in pulses.windows(2) {
            let step = pair[0].width.abs_diff(pair[1].width);
            assert!(
                step <= max_step,
                "A{}: a step of {step} cycles exceeds {max_step}: {pair:?}",
                servo + 1
            );
        }
    }
}

/// Returns the servos' scales, us per degree.
pub fn servo_scales() -> [f64; 4] {
    robot().servos().each_ref().map(|servo| servo.us_per_degree)
}

/// Returns the 16-bit value at a data address and the next one.
pub fn peek_word(uno: &Uno, address: u16) -> u16 {
    u16::from_le_bytes([address, address + 1].map(|address| uno.peek(address)))
}

/// Returns the recorded edges of the LED's pin.
pub fn led_edges(bench: &FirmwareBench) -> Vec<Edge> {
    let edges = bench.uno.edges().into_iter();
    edges.filter(|edge| edge.pin == LED_PIN).collect()
}

/// Runs for `seconds` seconds, and checks that the LED flashes `flash_count` times between any two consecutive pauses.
#[track_caller]
pub fn assert_flashes(bench: &mut FirmwareBench, seconds: u64, flash_count: usize) {
    bench.uno.take_edges();
    bench.uno.run_ms(1000 * seconds);
    // In a flash the LED is on for 160 ms and off for 160 ms; in a pause it stays off for another second.
    let mut flash_counts = Vec::new();
    let mut current_count = None;
    for pair in led_edges(bench).windows(2) {
        let ms = (pair[1].cycle - pair[0].cycle) / CYCLES_PER_MS;
        match (pair[0].is_rising, ms) {
            (true, 150..=170) => current_count = current_count.map(|n| n + 1),
            (false, 150..=170) => {}
            (false, 1100..=1140) => {
                flash_counts.extend(current_count);
                current_count = Some(0);
            }
            unexpected => panic!("unexpected LED interval (is on, duration in ms): {unexpected:?}"),
        }
    }
    let are_equal = flash_counts.iter().all(|count| *count == flash_count);
    assert!(
        flash_counts.len() >= 3 && are_equal,
        "expected {flash_count} flashes between pauses: {flash_counts:?}"
    );
}
