//! Measurements at the servo pins, at the LED and on the console that several tests share.

use lizard_host_tests::{CYCLES_PER_US, FirmwareBench};
use simulated_uno::{CYCLES_PER_MS, Pin, Pulse};

use crate::robot;

/// The pin of the LED.
pub const LED: Pin = Pin::d(13);

/// Runs for `ms` milliseconds and returns the pulses of A1 to A4 in that time.
pub fn run_for_pulses(bench: &mut FirmwareBench, ms: u64) -> [Vec<Pulse>; 4] {
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
    run_for_pulses(bench, 50).map(|pulses| pulses.last().map_or(0, |pulse| pulse.width))
}

/// Switches the power off and on, discards the edges recorded so far, and waits for the banner.
pub fn power_cycle(bench: &mut FirmwareBench) {
    let lines_before = bench.lines().len();
    bench.uno.power_cycle();
    bench.uno.take_edges();
    for _ in 0..500 {
        bench.uno.run_ms(1);
        // The remainder of a line that the power cut interrupted may come first.
        let lines = &bench.lines()[lines_before..];
        if lines.iter().any(|line| line.text.contains("# lizard ")) {
            return;
        }
    }
    panic!(
        "no banner after power-on: {:?}",
        &bench.lines()[lines_before..]
    );
}

/// Returns the lines in which `cal` prints the settings.
pub fn read_calibration(bench: &mut FirmwareBench) -> Vec<String> {
    let (lines, answer) = bench.ask("cal");
    assert_eq!(answer, "ok cal");
    let is_setting = |line: &String| {
        ["# A", "# boot ", "# deadman "]
            .iter()
            .any(|start| line.starts_with(start))
    };
    lines.into_iter().filter(is_setting).collect()
}

/// Returns a servo's slew limit: the largest change of its pulse width from frame to frame, cycles.
pub fn slew_limit(servo: usize) -> u64 {
    slew_limit_at(
        robot().servos()[servo].us_per_degree,
        robot().speed_limits().slew,
    )
}

/// Returns the slew limit of a servo with `gain` us per degree at `slew` deg/s, cycles per frame.
fn slew_limit_at(gain: f64, slew: f64) -> u64 {
    // The three cycles allow for rounding: one for each of the two widths, and one for the limit, whose rounding error
    // is half a step of an angle.
    (slew / 50.0 * gain.abs() * CYCLES_PER_US) as u64 + 3
}

/// Asserts that no pulse width of a gait differs from the previous one by more than the slew limits allow.
pub fn assert_no_leap_in_gait(pulses: &[Vec<Pulse>; 4]) {
    let speed_limits = robot().speed_limits();
    for (servo, pulses) in robot().servos().iter().zip(pulses) {
        let max_leap = slew_limit_at(
            servo.us_per_degree,
            speed_limits.slew.max(speed_limits.gait_slew),
        );
        assert!(pulses.len() > 1, "{pulses:?}");
        for pair in pulses.windows(2) {
            let leap = pair[0].width.abs_diff(pair[1].width);
            assert!(leap <= max_leap, "{leap} cycles of {max_leap}: {pair:?}");
        }
    }
}

/// Asserts that no pulse width differs from the previous one by more than the slew limit allows.
pub fn assert_no_leap(pulses: &[Vec<Pulse>; 4]) {
    let gains = robot().servos().each_ref().map(|servo| servo.us_per_degree);
    assert_no_leap_at(pulses, gains);
}

/// Asserts that no pulse width of servos with these gains (us per degree) differs from the previous one by more than
/// the slew limit allows.
pub fn assert_no_leap_at(pulses: &[Vec<Pulse>; 4], gains: [f64; 4]) {
    for (servo, (pulses, gain)) in pulses.iter().zip(gains).enumerate() {
        assert!(pulses.len() > 1, "A{}: {pulses:?}", servo + 1);
        for pair in pulses.windows(2) {
            let leap = pair[0].width.abs_diff(pair[1].width);
            assert!(
                leap <= slew_limit_at(gain, robot().speed_limits().slew),
                "A{}: {pair:?}",
                servo + 1
            );
        }
    }
}

/// Runs for `seconds` seconds and returns the number of LED flashes between each pause and the next.
pub fn count_flashes(bench: &mut FirmwareBench, seconds: u64) -> Vec<usize> {
    bench.uno.take_edges();
    bench.uno.run_ms(1000 * seconds);
    let edges = bench.uno.edges();
    let edges: Vec<_> = edges.iter().filter(|edge| edge.pin == LED).collect();
    // In a flash the LED is on for 160 ms and off for 160 ms; in a pause it stays off for one second more.
    let mut flash_counts = Vec::new();
    let mut current_count = None;
    for pair in edges.windows(2) {
        let ms = (pair[1].cycle - pair[0].cycle) / CYCLES_PER_MS;
        match (pair[0].is_rising, ms) {
            (true, 150..=170) => current_count = current_count.map(|n| n + 1),
            (false, 150..=170) => {}
            (false, 1100..=1140) => {
                flash_counts.extend(current_count);
                current_count = Some(0);
            }
            unexpected => panic!("unexpected LED phase, lit and ms: {unexpected:?}"),
        }
    }
    flash_counts
}
