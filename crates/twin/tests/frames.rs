//! Tests of the twin. The frames of a gait, simulated one by one, move the robot as predicted for the gait.

use lizard_robot::{BodyPose, CheckedGait, Drive, DriveKind, GroundContact, Robot, Travel};
use lizard_twin::{ServoModel, Totals, Twin};

fn paper_robot() -> Robot {
    Robot::parse(include_str!("../../../robots/paper.toml")).expect("paper.toml is valid")
}

/// Computes a gait's pulse widths (us) at a phase from the firmware's table.
fn compute_pulse_widths(robot: &Robot, gait: &CheckedGait, phase: u16) -> [Option<f64>; 4] {
    let angles = gait.table_angles(phase);
    std::array::from_fn(|i| Some(robot.servos()[i].pulse(angles[i])))
}

/// Simulates four cycles of a gait, and returns the totals of the last cycle.
fn simulate_last_of_four_cycles(
    robot: &Robot,
    name: &str,
    model: ServoModel,
    ground: &GroundContact,
) -> Totals {
    let gait = robot.gait(name).expect("paper.toml has the gait");
    let mut twin = Twin::new(robot, model);
    twin.set_ground(*ground);
    let mut totals = Totals::new(BodyPose::START);
    for _ in 0..4 {
        let start = twin.simulate_pulses(compute_pulse_widths(robot, gait, 0));
        totals = Totals::new(start.body_pose);
        for (_, phase) in gait.frames().skip(1) {
            totals.add(&twin.simulate_pulses(compute_pulse_widths(robot, gait, phase)));
        }
    }
    totals
}

/// Asserts that two movements differ by less than `max_forward_difference` (mm) and 0.2 deg.
#[track_caller]
fn assert_close(a: Travel, b: Travel, max_forward_difference: f64, message: &str) {
    let forward_difference = (a.forward - b.forward).abs();
    assert!(forward_difference < max_forward_difference, "{message}");
    assert!((a.turn - b.turn).abs() < 0.2, "{message}");
}

#[test]
fn a_robot_with_ideal_servos_moves_as_predicted_for_the_gait() {
    let robot = paper_robot();
    let ground_with_springs = GroundContact {
        drive: Drive {
            kind: DriveKind::Strut(robot.strut_with_spring(0.5, 0.4)),
            play: 0.0,
        },
        ..*robot.ground()
    };
    for ground in [*robot.ground(), ground_with_springs] {
        for gait in robot.gaits().iter().filter(|gait| gait.name() != "look") {
            let totals =
                simulate_last_of_four_cycles(&robot, gait.name(), ServoModel::Ideal, &ground);
            let travel = totals.travel();
            let expected = gait.simulate_cycle(&ground).travel;
            let name = gait.name();
            let message = format!("{name}: expected {expected:?}, got {travel:?}");
            assert_close(travel, expected, 0.35, &message);
            let excess_s = totals.duration_s() - gait.period();
            assert!(excess_s.abs() < 0.011, "{name}");
        }
    }
}

#[test]
fn a_dead_band_shortens_the_walk_by_its_fraction_of_the_stroke() {
    let robot = paper_robot();
    let [ideal_forward, sg90_forward] = [ServoModel::Ideal, ServoModel::SG90].map(|model| {
        simulate_last_of_four_cycles(&robot, "walk", model, robot.ground())
            .travel()
            .forward
    });
    // At each reversal, the dead band takes 1 deg of the stroke of 40 deg.
    assert!(
        (sg90_forward / ideal_forward - 39.0 / 40.0).abs() < 0.01,
        "{sg90_forward} mm with SG-90 servos, {ideal_forward} mm with ideal servos"
    );
}

#[test]
fn servos_that_are_too_slow_for_a_gait_shorten_the_stride() {
    let robot = paper_robot();
    let slow_model = ServoModel::Unloaded {
        max_rate_deg_per_s: 120.0,
        dead_band_us: 0.0,
    };
    let totals = simulate_last_of_four_cycles(&robot, "walk", slow_model, robot.ground());
    assert!(
        totals.max_rate <= 120.0 + 1e-9 && totals.max_error > 5.0,
        "{totals:?}"
    );
    assert!(totals.travel().forward < 25.0, "{totals:?}");
}

#[test]
fn three_feet_do_not_slip_while_the_fourth_swings() {
    let robot = paper_robot();
    let crawl = robot.gait("crawl").expect("paper.toml has the gait");
    let mut twin = Twin::new(&robot, ServoModel::Ideal);
    for (seconds, phase) in crawl.frames() {
        let state = twin.simulate_pulses(compute_pulse_widths(&robot, crawl, phase));
        // In the middle of the second fifth of the cycle, only the left hind leg swings.
        if (0.24..0.36).contains(&seconds) {
            let is_still = state.slips.map(|distance| distance < 0.01);
            assert_eq!(is_still, [true, true, true, false], "at {seconds} s");
        }
    }
}

#[test]
fn a_robot_without_pulses_does_not_move() {
    let robot = paper_robot();
    let walk = robot.gait("walk").expect("paper.toml has the gait");
    let mut twin = Twin::new(&robot, ServoModel::SG90);
    for (_, phase) in walk.frames().take(20) {
        twin.simulate_pulses(compute_pulse_widths(&robot, walk, phase));
    }
    let angles_before = twin.angles();
    let body_pose_before = twin.simulate_pulses([None; 4]).body_pose;
    let state_after = twin.simulate_pulses([None; 4]);
    assert_eq!(state_after.angles, angles_before);
    assert_eq!(state_after.body_pose, body_pose_before);
    assert_eq!(state_after.has_pulse, [false; 4]);
    assert_eq!(state_after.slips, [0.0; 4]);
    assert_eq!(state_after.frame, 22);
}

#[test]
fn simulate_angles_moves_the_robot_like_the_equivalent_pulses() {
    let robot =
        Robot::parse(include_str!("../../../robots/unequal.toml")).expect("unequal.toml is valid");
    let walk = robot.gait("walk").expect("unequal.toml has the gait");
    let mut twins = [0, 1].map(|_| Twin::new(&robot, ServoModel::SG90));
    for (_, phase) in walk.frames() {
        let pulse_state = twins[0].simulate_pulses(compute_pulse_widths(&robot, walk, phase));
        let angle_state = twins[1].simulate_angles(walk.table_angles(phase));
        for i in 0..4 {
            assert!((pulse_state.angles[i] - angle_state.angles[i]).abs() < 1e-9);
        }
        let forward_positions =
            [pulse_state.body_pose, angle_state.body_pose].map(|body_pose| body_pose.forward);
        assert!(
            (forward_positions[0] - forward_positions[1]).abs() < 1e-6,
            "forward positions {forward_positions:?} mm"
        );
    }
}

#[test]
fn simulate_cycle_matches_the_sum_of_its_frames() {
    let robot = paper_robot();
    for name in ["walk", "trot", "left"] {
        let gait = robot.gait(name).expect("paper.toml has the gait");
        let frame_travel =
            simulate_last_of_four_cycles(&robot, name, ServoModel::SG90, robot.ground()).travel();
        let twin = Twin::new(&robot, ServoModel::SG90);
        let cycle_travel = twin.simulate_cycle(gait).travel();
        let message = format!("{name}: frames {frame_travel:?}, cycle {cycle_travel:?}");
        assert_close(cycle_travel, frame_travel, 0.3, &message);
        assert_eq!(
            twin.angles(),
            <[f64; 4]>::from(robot.neutral_pose()),
            "the twin itself does not move"
        );
    }
}

#[test]
fn a_pulse_beyond_a_servos_travel_moves_the_servo_to_the_end_of_the_travel() {
    let robot = paper_robot();
    let mut twin = Twin::new(&robot, ServoModel::Ideal);
    let state = twin.simulate_pulses([Some(9000.0), None, None, None]);
    assert_eq!(state.angles[0], robot.servos()[0].neutral + 90.0);
}
