//! Tests of the gaits at the servo pins: the pulses and the robot's displacement match the gaits in floating point.

use std::sync::atomic::{AtomicUsize, Ordering};

use lizard_host_tests::{CYCLES_PER_US, gait_commands, robot};
use lizard_robot::CheckedGait;
use simulated_uno::Fidelity;

use crate::measurements::servo_scales;
use crate::{
    FRAMES_PER_SECOND, assert_near, boot_to_stand, for_each_in_parallel, frame_angles,
    run_in_both_simulations,
};

/// Documented maximum error of the gait tables relative to floating point, deg.
const MAX_TABLE_ERROR_DEG: f64 = 0.50;

/// Returns the largest angle error due to rounding to cycles of 62.5 ns, deg: half a cycle each for the width and the
/// neutral width.
fn max_rounding_error_deg() -> f64 {
    let scales = servo_scales().map(f64::abs);
    1.0 / CYCLES_PER_US / scales.into_iter().fold(f64::INFINITY, f64::min)
}

/// Number of frames in which a gait accelerates to full pace.
const ACCELERATION_FRAMES: usize = 7;

/// The fraction of the full pace that a gait gains in each frame of its acceleration.
const PACE_STEP: f64 = 147.0 / 1024.0;

/// Starts a gait one second after power-on and returns the servo angles of each frame from then on, deg.
fn record_angles(gait: &CheckedGait, fidelity: Fidelity) -> Vec<[f64; 4]> {
    let mut bench = boot_to_stand(fidelity);
    bench.expect_ok(&gait.command());
    let gait_frames = (3.5 * gait.period() * FRAMES_PER_SECOND as f64) as u64;
    let frames = bench.run_for_frames(gait_frames + 3 * FRAMES_PER_SECOND);
    frame_angles(robot(), &frames)
}

/// Returns the phase of a gait `frame_count` frames after its start.
fn compute_phase(gait: &CheckedGait, frame_count: usize) -> f64 {
    let pace = |frame: usize| (frame as f64 * PACE_STEP).min(1.0);
    let frames_at_full_pace: f64 = (1..=frame_count).map(pace).sum();
    gait.phase_at(frames_at_full_pace / FRAMES_PER_SECOND as f64)
}

/// Returns the angles of a gait in each frame from its start, computed in floating point, deg.
fn compute_expected_angles(gait: &CheckedGait, frame_count: usize) -> Vec<[f64; 4]> {
    let angles = |frame: usize| gait.angles(compute_phase(gait, frame));
    (0..frame_count).map(angles).collect()
}

/// Returns the largest deviation of a servo angle from the gait in deg, if the gait starts at frame `start`.
fn max_deviation(float_angles: &[[f64; 4]], sent_angles: &[[f64; 4]], start: usize) -> f64 {
    let sent_angles = sent_angles[start..].iter().flatten();
    let pairs = sent_angles.zip(float_angles.iter().flatten());
    pairs.fold(0.0, |largest, (actual, expected)| {
        (actual - expected).abs().max(largest)
    })
}

/// Returns the frame at which the gait starts. This is the frame with the smallest deviation, because the start is the
/// only unknown in the comparison.
fn find_gait_start(
    gait: &CheckedGait,
    float_angles: &[[f64; 4]],
    sent_angles: &[[f64; 4]],
) -> usize {
    let deviation = |start: &usize| max_deviation(float_angles, sent_angles, *start);
    // The start comes after the move to the first pose, and at least a whole cycle before the end.
    let end = sent_angles.len() - (gait.period() * FRAMES_PER_SECOND as f64) as usize - 10;
    let start = (0..end).min_by(|a, b| deviation(a).total_cmp(&deviation(b)));
    start.expect("the recording is longer than a cycle")
}

#[test]
fn the_pulses_of_every_gait_follow_the_gait_frame_by_frame() {
    run_in_both_simulations(|fidelity| {
        for gait in robot().gaits() {
            let sent_angles = record_angles(gait, fidelity);
            let float_angles = compute_expected_angles(gait, sent_angles.len());
            let start = find_gait_start(gait, &float_angles, &sent_angles);
            let error = max_deviation(&float_angles, &sent_angles, start);
            let (name, frame_count) = (gait.name(), sent_angles.len() - start);
            println!("{name:<10} {frame_count} frames, max {error:.4} deg");
            let max_error = MAX_TABLE_ERROR_DEG + max_rounding_error_deg();
            assert!(error <= max_error, "{name}: {error} deg");
            // One frame earlier or later, the deviation is larger, so the comparison can distinguish frames.
            if gait.has_movement() {
                assert!(error > 0.0, "{name}: no rounding error");
                // The first frame has no previous frame.
                let neighbours = [Some(start + 1), start.checked_sub(1)];
                for neighbour in neighbours.into_iter().flatten() {
                    let deviation = max_deviation(&float_angles, &sent_angles, neighbour);
                    assert!(deviation > error, "{name}");
                }
            }
        }
    });
}

#[test]
fn the_pulses_of_every_gait_move_the_robot_as_the_contact_model_predicts() {
    let compared_count = AtomicUsize::new(0);
    for_each_in_parallel(&gait_commands(), |name| {
        let gait = robot().gait(name).expect("the gait is in robot.toml");
        let expected = gait.predict(&robot().ground().with_rigid_drive());
        let (Some(forward), Some(turn)) = (expected.forward, expected.turn) else {
            println!("{name:<10} not compared: the prediction depends on a tie between feet");
            return;
        };
        compared_count.fetch_add(usize::from(gait.has_movement()), Ordering::Relaxed);
        let sent_angles = record_angles(gait, Fidelity::DataSheet);
        let float_angles = compute_expected_angles(gait, sent_angles.len());
        let start = find_gait_start(gait, &float_angles, &sent_angles);
        // Compares whole gait cycles, from the first frame at full pace that begins a cycle: two cycles if one cycle is
        // not a whole number of frames.
        let frames_per_cycle = gait.period() * FRAMES_PER_SECOND as f64;
        let has_whole_frames = frames_per_cycle.fract() == 0.0;
        let gait_cycles = if has_whole_frames { 1.0 } else { 2.0 };
        // If two cycles are not a whole number of frames either, the missing fraction of a frame is negligible.
        let frame_count = (gait_cycles * frames_per_cycle) as usize;
        let phase_step = 1.0 / frames_per_cycle;
        let begins_cycle = |frame: &usize| {
            let phase = compute_phase(gait, frame - start);
            match gait.is_reversed() {
                true => 1.0 - phase <= phase_step,
                false => phase < phase_step,
            }
        };
        let mut frames = start + ACCELERATION_FRAMES..sent_angles.len();
        let first_frame = frames.find(begins_cycle).expect("a cycle begins");
        let cycle_angles = sent_angles[first_frame..=first_frame + frame_count].iter();
        let travel = robot().predict_travel(cycle_angles.copied());
        let [measured_forward, measured_turn] =
            [travel.forward, travel.turn].map(|value| value / gait_cycles);
        println!("{name:<10} {measured_forward:7.2} mm {measured_turn:7.2} deg");
        // An error of a tenth of a degree may change which feet stick.
        let scale = robot().lizard().links.l10 / 135.0;
        let max_error = (0.3 * scale).max(forward.abs() * 0.02);
        let case = |component: &str| format!("{name}, {component}, {travel:?}");
        assert_near(measured_forward, forward, max_error, &case("forward"));
        assert_near(measured_turn, turn, 0.2, &case("turn"));
    });
    // The prediction of at least one moving gait does not depend on a tie between feet.
    assert!(compared_count.into_inner() > 0, "no gait was compared");
}
