//! Tests of the robot's displacement due to the core's pulses. The pulses are converted back to angles for the contact
//! model, and must move the robot like the gait in floating point.

use lizard_core::numbers::pose::Pulses;
use lizard_core::numbers::units::CYCLE;
use lizard_host_tests::{CYCLES_PER_US, NamedRobot, paper_robot, robots};
use lizard_robot::{CheckedGait, Prediction, Robot, Travel};

use crate::checked_robot::CheckedRobot;

/// Converts pulse widths in cycles of 62.5 ns to servo angles in the chassis frame, deg.
fn pulses_to_angles(robot: &Robot, pulses: Pulses) -> [f64; 4] {
    std::array::from_fn(|n| {
        let servo = &robot.servos()[n];
        servo.neutral + servo.sweep(f64::from(pulses.0[n].0) / CYCLES_PER_US)
    })
}

/// Simulates one cycle of a gait at a speed in percent, and returns the robot's displacement due to the core's pulses;
/// `None` if the guard stops the robot on its path to the gait's first pose. The cycle begins at the frame whose phase
/// is nearest to 0.
fn simulate_cycle(
    named_robot: &NamedRobot,
    gait: &CheckedGait,
    speed_percent: f64,
) -> Option<Travel> {
    let robot = &named_robot.robot;
    let mut checked_robot = CheckedRobot::power_on_and_stand(named_robot);
    checked_robot.expect_ok(&format!("speed {speed_percent}"));
    checked_robot.expect_ok(&gait.command());
    if !checked_robot.settle() {
        return None;
    }
    let frames_per_cycle = gait.period() * 50.0 * 100.0 / speed_percent;
    // The phase of a reversed gait decreases, so the distance from 0 counts in both directions.
    let phase_distance = |checked_robot: &CheckedRobot| {
        let phase = i64::from(checked_robot.motion().phase());
        phase.min(i64::from(CYCLE) - phase)
    };
    let phase_per_frame = (f64::from(CYCLE) / frames_per_cycle) as i64;
    while phase_distance(&checked_robot) > phase_per_frame / 2 + 1 {
        checked_robot.run_frames(1);
    }
    let calibration = checked_robot.motion().calibration();
    let pulses = checked_robot.pose().pulses(calibration);
    let mut path = vec![pulses_to_angles(robot, pulses)];
    for _ in 0..frames_per_cycle.ceil() as usize {
        path.push(pulses_to_angles(robot, checked_robot.run_frame()));
    }
    // A cycle may end between two frames, so only a fraction of the last frame counts.
    let last_index = path.len() - 1;
    let last_frame_fraction = frames_per_cycle - frames_per_cycle.ceil() + 1.0;
    let (previous, last) = (path[last_index - 1], path[last_index]);
    path[last_index] =
        std::array::from_fn(|n| previous[n] + last_frame_fraction * (last[n] - previous[n]));
    Some(robot.predict_travel(path))
}

/// Asserts that a displacement matches the prediction: forward within the larger of `tolerance_mm` and 1 %,
/// the turn within 0.2 deg. A predicted value of `None` is not compared.
fn assert_displacement(name: &str, travel: Travel, tolerance_mm: f64, expected: &Prediction) {
    println!(
        "{name}: {:+.2} mm, {:+.2} deg, expected {:?} {:?}",
        travel.forward, travel.turn, expected.forward, expected.turn
    );
    if let Some(forward_mm) = expected.forward {
        let tolerance_mm = tolerance_mm.max(0.01 * forward_mm.abs());
        assert!(
            (travel.forward - forward_mm).abs() <= tolerance_mm,
            "{name}: expected {forward_mm} mm forward, got {travel:?}"
        );
    }
    if let Some(turn_deg) = expected.turn {
        assert!(
            (travel.turn - turn_deg).abs() <= 0.2,
            "{name}: expected a turn of {turn_deg} deg, got {travel:?}"
        );
    }
}

#[test]
fn the_pulses_of_every_gait_move_the_robot_like_the_gait_in_floating_point() {
    let mut travel_count = 0;
    // The contact model is slow, so the last five random robots are left out.
    for named_robot in &robots()[..robots().len() - 5] {
        for gait in named_robot.robot.gaits() {
            for speed_percent in [100.0, 20.0] {
                // Random robots are tested only at full speed.
                if speed_percent < 100.0 && named_robot.name.starts_with("random") {
                    continue;
                }
                let Some(travel) = simulate_cycle(named_robot, gait, speed_percent) else {
                    continue;
                };
                travel_count += 1;
                let expected = gait.predict(&named_robot.robot.ground().with_rigid_drive());
                let name = format!("{}: {} at {speed_percent} %", named_robot.name, gait.name());
                // In a robot without symmetry, a tenth of a degree may determine which foot sticks and which slips.
                let tolerance_mm = 0.01 * named_robot.robot.lizard().links.l10;
                assert_displacement(&name, travel, tolerance_mm, &expected);
            }
        }
    }
    assert!(travel_count > 100);
}

// The tests in crates/robot/ compare the predictions in floating point with independent values.
#[test]
fn the_pulses_of_the_papers_gaits_move_the_robot_as_predicted_within_0_3_mm() {
    let named_robot = NamedRobot {
        name: "paper.toml".into(),
        robot: paper_robot().clone(),
    };
    let mut predicted_count = 0;
    for gait in paper_robot().gaits() {
        let expected = gait.predict(&paper_robot().ground().with_rigid_drive());
        predicted_count += usize::from(expected.forward.is_some() && expected.turn.is_some());
        for speed_percent in [100.0, 80.0, 50.0, 20.0] {
            let travel = simulate_cycle(&named_robot, gait, speed_percent)
                .expect("the guard does not stop the robot");
            assert_displacement(gait.name(), travel, 0.3, &expected);
        }
    }
    assert!(predicted_count >= 9, "only {predicted_count} predictions");
}
