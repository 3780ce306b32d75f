//! Tests of the firmware's ELF file on a simulated UNO: its answers, its pulses, its contents and its costs.
//!
//! Every claim about pulses and the serial line is tested twice, on stock simavr and on simavr corrected to follow the
//! data sheet. The two simulations differ in interrupt latency and in the serial receiver, so a claim that holds in
//! both depends on neither.
//!
//! `make firmware` builds the ELF file. If the file is older than the sources, it differs from the core in these tests,
//! and the tests fail.

use std::thread;

use lizard_host::sim::analysis::compute_servo_frames;
use lizard_host::sim::gait_choice;
use lizard_host_tests::{CYCLES_PER_US, FirmwareBench, Frame, robot};
use lizard_kinematics::{Limits, wrap};
use lizard_robot::{Robot, to_command};
use simulated_uno::Fidelity;

mod bad_input;
mod baud_rate;
mod bench;
mod blocked_interrupts;
mod budgets;
mod calibration;
mod console;
mod core_run;
mod counters;
mod damaged_robot;
mod every_cycle;
mod faults;
mod gaits;
mod guard;
mod image;
mod inputs;
mod led;
mod measurements;
mod no_pulse;
mod other_robots;
mod power_cut;
mod power_up;
mod pulses;
mod random_lines;
mod reference_run;
mod same_pulses;
mod serial;
mod serial_settings;
mod slow_main;
mod stock_simavr;
mod stopping;
mod supply;
mod watchdog;

const FRAMES_PER_SECOND: u64 = 50;

/// Removes the values that the core on the host cannot compute from a line. The firmware writes a status in three
/// parts, each once the serial buffer has room, so the values of a moving robot depend on timing. Stock simavr measures
/// voltages against a reference of 1.1 V, even if the robot's reference differs.
fn to_comparable_line(line: &str, fidelity: Fidelity) -> String {
    let mut excluded_keys = vec!["phase=", "pose=", "margin=", "frames="];
    if fidelity == Fidelity::Stock {
        excluded_keys.extend(["vcc=", "rail="]);
    }
    let is_status = line.starts_with("ok gait=");
    let is_comparable =
        |pair: &&str| !is_status || !excluded_keys.iter().any(|key| pair.starts_with(key));
    let comparable_pairs: Vec<&str> = line.split(' ').filter(is_comparable).collect();
    comparable_pairs.join(" ")
}

/// Runs a test on stock and on corrected simavr, in parallel.
fn run_in_both_simulations(test: impl Fn(Fidelity) + Sync) {
    let fidelities = [Fidelity::Stock, Fidelity::DataSheet];
    for_each_in_parallel(&fidelities, |fidelity| test(*fidelity));
}

/// Runs a test on stock and on corrected simavr, in parallel, each with the robot that `start` returns.
fn start_in_both_simulations<T>(start: impl Fn(Fidelity) -> T + Sync, test: impl Fn(T) + Sync) {
    run_in_both_simulations(|fidelity| test(start(fidelity)));
}

/// Runs a test for every case, each on its own thread.
fn for_each_in_parallel<T: Sync + std::fmt::Debug>(cases: &[T], test: impl Fn(&T) + Sync) {
    thread::scope(|scope| {
        let handles: Vec<_> = cases
            .iter()
            .map(|case| (case, scope.spawn(|| test(case))))
            .collect();
        for (case, handle) in handles {
            assert!(handle.join().is_ok(), "the test fails for {case:?}");
        }
    });
}

/// Boots the board, sends the command `line` and returns the board one second later.
fn boot_and_command(line: &str, fidelity: Fidelity) -> FirmwareBench {
    let mut bench = boot_to_stand(fidelity);
    bench.expect_ok(line);
    bench.run_ms(1000);
    bench
}

/// Boots the board, starts the robot's first gait that moves and returns the board one second later.
fn boot_to_walk(fidelity: Fidelity) -> FirmwareBench {
    boot_and_command(&first_moving_gait(), fidelity)
}

/// Boots the board and returns it one second later, when the robot stands.
fn boot_to_stand(fidelity: Fidelity) -> FirmwareBench {
    let mut bench = FirmwareBench::boot(fidelity);
    bench.run_ms(1000);
    bench
}

/// Returns the command for the robot's first gait that moves. Every robot under test needs such a gait; otherwise most
/// of these tests would run on a robot that only stands.
fn first_moving_gait() -> String {
    let moving_gaits = gait_choice::list_moving_gaits(robot());
    let first_gait = moving_gaits.first();
    to_command(first_gait.expect("a robot under test has a gait that moves"))
}

/// Returns the command for the pose at these angles from neutral, deg.
fn pose_command(sweeps_deg: [f64; 4]) -> String {
    let angles: [f64; 4] = std::array::from_fn(|i| robot().servos()[i].neutral + sweeps_deg[i]);
    format_pose(angles.map(|angle| angle.rem_euclid(360.0)))
}

/// Returns the command for the pose at these angles in the chassis frame, deg.
fn format_pose([a1, a2, a3, a4]: [f64; 4]) -> String {
    format!("pose {a1:.2} {a2:.2} {a3:.2} {a4:.2}")
}

/// True if each of these angles (deg, chassis frame) is in its servo's travel and at least `margin_deg` from its ends.
fn is_within_travel(angles: [f64; 4], margin_deg: f64) -> bool {
    robot().servos().iter().zip(angles).all(|(servo, angle)| {
        let (min, max) = servo.travel();
        let sweep = wrap(angle - servo.neutral);
        min + margin_deg < sweep && sweep < max - margin_deg
    })
}

/// Returns the robot's limits, stricter by these differences: sines of the margins, and mm of the strokes.
fn stricter_limits(margin: f64, stroke: f64) -> Limits {
    let limits = robot().limits();
    Limits {
        type2: limits.type2 + margin,
        type1: limits.type1 + margin,
        leg: limits.leg + margin,
        stroke_min: limits.stroke_min + stroke,
        stroke_max: limits.stroke_max - stroke,
    }
}

/// Returns the pulse widths of the neutral pose, cycles.
fn neutral_widths() -> [u64; 4] {
    let servos = robot().servos();
    servos.map(|servo| (servo.neutral_us * CYCLES_PER_US).round() as u64)
}

/// Ends a flood of serial input and waits until the robot has answered the lines in its buffer.
fn end_flood(bench: &mut FirmwareBench) {
    bench.uno.flood(b"");
    // The buffer may hold 32 `?` lines, and each answer is a kilobyte long.
    bench.run_ms(5000);
    bench.uno.send(b"\n");
    bench.run_ms(200);
}

/// Returns the pulse widths of each frame, cycles.
fn frame_widths(frames: &[Frame]) -> Vec<[u64; 4]> {
    frames.iter().map(Frame::expect_all_widths).collect()
}

/// Returns a robot's servo angles in each frame, deg.
fn frame_angles(robot: &Robot, frames: &[Frame]) -> Vec<[f64; 4]> {
    let servo_frames = compute_servo_frames(robot, frames).into_iter();
    let angles = servo_frames.map(|frame| frame.angles.expect("each servo has a pulse"));
    angles.collect()
}

/// Checks that a value differs from the expected value by at most `tolerance`.
#[track_caller]
fn assert_near(value: f64, expected: f64, tolerance: f64, case: &str) {
    let error = (value - expected).abs();
    assert!(error <= tolerance, "{case}: {value}, expected {expected}");
}

/// Sends a line, checks that the answer has this start, and returns the answer.
#[track_caller]
fn expect_answer(bench: &mut FirmwareBench, line: &str, start: &str) -> String {
    let answer = bench.say(line);
    assert!(answer.starts_with(start), "{line}: {answer}");
    answer
}

/// An answer to `status`, which is a list of pairs such as `gait=stop`.
#[derive(Debug, PartialEq)]
struct Status(String);

impl Status {
    /// Asks the robot for its status.
    fn read(bench: &mut FirmwareBench) -> Self {
        Self(expect_answer(bench, "status", "ok gait="))
    }

    /// Checks that the status has each of these pairs, which are separated by spaces.
    #[track_caller]
    fn assert_has(&self, pairs: &str) {
        for pair in pairs.split(' ') {
            let has_pair = self.0.split(' ').any(|own_pair| own_pair == pair);
            assert!(has_pair, "no {pair} in {}", self.0);
        }
    }

    /// Returns the value of a key as text.
    fn text(&self, key: &str) -> &str {
        let mut pairs = self.0.split(' ').filter_map(|pair| pair.split_once('='));
        let pair = pairs.find(|(own_key, _)| *own_key == key);
        pair.unwrap_or_else(|| panic!("status has no {key}")).1
    }

    /// Returns the value of a key as a number.
    fn number(&self, key: &str) -> f64 {
        let text = self.text(key);
        text.parse().unwrap_or_else(|_| panic!("{key}={text}"))
    }

    /// Returns the servo angles, deg.
    fn pose(&self) -> [f64; 4] {
        parse_angles(self.text("pose"))
    }
}

/// Parses four comma-separated angles, deg, as the console writes them.
fn parse_angles(list: &str) -> [f64; 4] {
    let parse_angle = |angle: &str| angle.parse().expect("an angle is a number");
    let angles: Vec<f64> = list.split(',').map(parse_angle).collect();
    angles.try_into().expect("a pose has four angles")
}
