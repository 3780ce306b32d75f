//! Tests of the gaits at the servo pins: the pulses and the robot's travel agree with the gaits in floating point.

use std::sync::atomic::{AtomicUsize, Ordering};

use lizard_host::sim::analysis::servo_frames_of;
use lizard_host_tests::robot;
use lizard_robot::CheckedGait;
use simulated_uno::Fidelity;

use crate::{FRAMES_PER_SECOND, boot_standing, for_each};

/// Largest deviation of the gait tables from floating point that the project promises, deg.
const MAX_TABLE_ERROR: f64 = 0.50;
/// Returns the largest error from rounding to a cycle of 62.5 ns, deg: half a cycle each for the width and for the
/// neutral width.
fn max_rounding_error() -> f64 {
    let finest = robot().servos().map(|servo| servo.us_per_degree.abs());
    1.0 / 16.0 / finest.into_iter().fold(f64::INFINITY, f64::min)
}

/// Number of frames in which a gait accelerates at its start, and the share of the full pace that each of these
/// frames adds.
const ACCELERATION: (usize, f64) = (7, 147.0 / 1024.0);

/// Orders a gait one second after power-on and returns the servo angles of each frame from then on, deg.
fn decode_angles(gait: &CheckedGait, fidelity: Fidelity) -> Vec<[f64; 4]> {
    let mut bench = boot_standing(fidelity);
    let line = gait.name().replace('-', " ");
    assert_eq!(bench.say(&line), format!("ok {line}"));
    let frames = bench.run_for_frames(
        (3.5 * gait.period() * FRAMES_PER_SECOND as f64) as u64 + 3 * FRAMES_PER_SECOND,
    );
    let angles = |at: lizard_host::sim::analysis::ServoFrame| at.angles.expect("four pulses");
    servo_frames_of(robot(), &frames)
        .into_iter()
        .map(angles)
        .collect()
}

/// Returns the phase of a gait this many frames after its start.
fn phase(gait: &CheckedGait, frames: usize) -> f64 {
    let pace = |frame: usize| (frame as f64 * ACCELERATION.1).min(1.0);
    let full: f64 = (1..=frames).map(pace).sum();
    gait.phase(full / FRAMES_PER_SECOND as f64)
}

/// Returns the angles of a gait frame by frame from its start, in floating point, deg.
fn expected_angles(gait: &CheckedGait, frames: usize) -> Vec<[f64; 4]> {
    (0..frames).map(|n| gait.angles(phase(gait, n))).collect()
}

/// Returns the largest deviation of any servo angle from the gait if the gait starts at frame `start`, deg.
fn max_deviation(float: &[[f64; 4]], frames: &[[f64; 4]], start: usize) -> f64 {
    let pairs = frames[start..].iter().flatten().zip(float.iter().flatten());
    pairs.fold(0.0, |largest, (actual, expected)| {
        (actual - expected).abs().max(largest)
    })
}

/// Returns the frame at which the gait starts: the frame with the smallest deviation, since the start is the only
/// unknown of the comparison.
fn find_gait_start(gait: &CheckedGait, float: &[[f64; 4]], frames: &[[f64; 4]]) -> usize {
    let by_worst = |a: &usize, b: &usize| {
        max_deviation(float, frames, *a).total_cmp(&max_deviation(float, frames, *b))
    };
    // The move to the first pose precedes the start, and a whole cycle must follow it.
    let last = frames.len() - (gait.period() * FRAMES_PER_SECOND as f64) as usize - 10;
    let start = (0..last).min_by(by_worst);
    start.expect("a second has frames")
}

#[test]
fn the_pulses_of_every_gait_follow_it_frame_by_frame() {
    for_each(&[Fidelity::Stock, Fidelity::DataSheet], |fidelity| {
        for gait in robot().gaits() {
            let frames = decode_angles(gait, *fidelity);
            let float = expected_angles(gait, frames.len());
            let start = find_gait_start(gait, &float, &frames);
            let error = max_deviation(&float, &frames, start);
            println!(
                "{:<10} {} frames, max {error:.4} deg",
                gait.name(),
                frames.len() - start
            );
            assert!(
                error <= MAX_TABLE_ERROR + max_rounding_error(),
                "{}: {error} deg",
                gait.name()
            );
            // One frame earlier or later would exceed the bound, so the comparison can tell frames
            // apart.
            if gait.moves() {
                assert!(error > 0.0, "{}: tables are rounded", gait.name());
                // The first frame has no previous one.
                let others = [Some(start + 1), start.checked_sub(1)];
                for other in others.into_iter().flatten() {
                    assert!(
                        max_deviation(&float, &frames, other) > error,
                        "{}",
                        gait.name()
                    );
                }
            }
        }
    });
}

#[test]
fn the_pulses_of_every_gait_lead_where_the_contact_model_says() {
    let gaits: Vec<&str> = robot().gaits().iter().map(|gait| gait.name()).collect();
    let compared = AtomicUsize::new(0);
    for_each(&gaits, |&name| {
        let gait = robot().gait(name).expect("it is in robot.toml");
        let expected = gait.predict(&robot().ground().rigid());
        let (Some(forward), Some(turn)) = (expected.forward, expected.turn) else {
            println!("{name:<10} depends on a tie");
            return;
        };
        compared.fetch_add(usize::from(gait.moves()), Ordering::Relaxed);
        let frames = decode_angles(gait, Fidelity::DataSheet);
        let float = expected_angles(gait, frames.len());
        let start = find_gait_start(gait, &float, &frames);
        // Whole cycles, from the first frame at full pace that begins a cycle: two if a cycle is no whole number of
        // frames.
        let cycles = if (gait.period() * FRAMES_PER_SECOND as f64).fract() == 0.0 {
            1
        } else {
            2
        };
        // If two cycles are no whole number of frames either, the missing part of a frame is negligible.
        let length = (f64::from(cycles) * gait.period() * FRAMES_PER_SECOND as f64) as usize;
        let step = 1.0 / (gait.period() * FRAMES_PER_SECOND as f64);
        let from = (start + ACCELERATION.0..frames.len())
            .find(|frame| {
                let phase = phase(gait, frame - start);
                if gait.is_reversed() {
                    1.0 - phase <= step
                } else {
                    phase < step
                }
            })
            .expect("a cycle begins");
        let moved = robot().travel(frames[from..=from + length].iter().copied());
        let (ahead, turned) = (
            moved.forward / f64::from(cycles),
            moved.turn / f64::from(cycles),
        );
        println!("{name:<10} {ahead:7.2} mm {turned:7.2} deg");
        // The holding feet may depend on a tenth of a degree.
        let size = robot().lizard().links.l10 / 135.0;
        let max = (0.3 * size).max(forward.abs() * 0.02);
        assert!((ahead - forward).abs() <= max, "{name}: {moved:?}");
        assert!((turned - turn).abs() <= 0.2, "{name}: {moved:?}");
    });
    let compared = compared.into_inner();
    assert!(compared > 0, "every gait that moves depends on a tie");
}
