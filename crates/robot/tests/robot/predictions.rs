//! The predicted displacements of the paper's gaits match the values by which the gaits were chosen, and have the
//! symmetries of the contact model.

use lizard_robot::{Report, Robot, Travel};
use proptest::prelude::*;

use crate::{gait, paper, paper_with};

/// Displacement of each gait over one cycle: forward mm, turn deg. The values come from a separate implementation of
/// the same model, by which the gaits were chosen.
const EXPECTED_MOVEMENTS: [(&str, f64, f64); 9] = [
    ("stand", 0.0, 0.0),
    ("walk", 34.16, 0.0),
    ("trot", 26.66, 0.0),
    ("crawl", 30.78, 0.0),
    ("back", -34.16, 0.0),
    ("left", 0.0, 15.34),
    ("right", 0.0, -15.34),
    ("arc-left", 17.71, 5.27),
    ("arc-right", 17.71, -5.27),
];

/// Predicts the displacement over one cycle of a gait. Panics if a component is undetermined.
fn predict(robot: &Robot, name: &str) -> Travel {
    let movement = robot.predict(gait(robot, name));
    let require_determined = |component: Option<f64>| {
        component.unwrap_or_else(|| panic!("{name} is undetermined: {movement:?}"))
    };
    Travel {
        forward: require_determined(movement.forward),
        left: require_determined(movement.left),
        turn: require_determined(movement.turn),
    }
}

/// Asserts that a displacement equals the expected displacement within 1 % or 0.3 mm, and 0.2 deg.
fn assert_near(name: &str, travel: Travel, forward: f64, turn: f64) {
    assert!(
        (travel.forward - forward).abs() <= 0.3f64.max(forward.abs() * 0.01),
        "{name} {travel:?}"
    );
    assert!((travel.turn - turn).abs() <= 0.2, "{name} {travel:?}");
}

#[test]
fn every_gait_of_the_papers_robot_matches_a_separate_solver() {
    let robot = paper();
    for (name, forward, turn) in EXPECTED_MOVEMENTS {
        assert_near(name, predict(robot, name), forward, turn);
    }
}

#[test]
fn the_tables_at_fifty_frames_per_second_move_the_robot_as_far() {
    let robot = paper();
    for (name, forward, turn) in EXPECTED_MOVEMENTS {
        let gait = gait(robot, name);
        let angles = gait.frames().map(|(_, phase)| gait.table_angles(phase));
        assert_near(name, robot.predict_travel(angles), forward, turn);
    }
}

#[test]
fn the_displacement_of_a_head_gesture_is_undetermined() {
    let robot = paper();
    assert_eq!(robot.predict(gait(robot, "look")).forward, None);
    let report = Report::compute(robot).to_string();
    let look = report.lines().find(|line| line.starts_with("look"));
    let cells: Vec<&str> = look
        .expect("the report has the gait look")
        .split_whitespace()
        .collect();
    // The distance with ideal servos, and with the robot's own servos.
    let [ideal_cell, real_cell] = [6, 2].map(|from_end| cells[cells.len() - from_end]);
    assert_eq!((ideal_cell, real_cell), ("-", "-"), "{cells:?}");
    assert!(report.contains("\n- undecided: two feet pull against the other two"));
}

#[test]
fn a_reversed_gait_undoes_its_movement() {
    let robot = paper();
    let walk = predict(robot, "walk");
    let back = predict(robot, "back");
    assert!(
        (walk.forward + back.forward).abs() < 1e-6,
        "{walk:?} {back:?}"
    );
    // One cycle forward and the same cycle in reverse, for a gait that also turns.
    let arc = gait(robot, "arc-left");
    let cycle: Vec<[f64; 4]> = (0..=500).map(|i| arc.sweeps(i as f64 / 500.0)).collect();
    let travel = robot
        .ground()
        .travel(cycle.iter().chain(cycle.iter().rev()).copied());
    assert!(
        travel.forward.hypot(travel.left) < 1e-5 && travel.turn.abs() < 1e-6,
        "{travel:?}"
    );
}

#[test]
fn left_and_right_are_mirror_images() {
    let robot = paper();
    for (a, b) in [("left", "right"), ("arc left", "arc right")] {
        let (a, b) = (predict(robot, a), predict(robot, b));
        assert!((a.forward - b.forward).abs() < 1e-6);
        assert!((a.left + b.left).abs() < 1e-6 && (a.turn + b.turn).abs() < 1e-6);
    }
}

#[test]
fn a_sinusoidal_trot_does_not_move_the_robot() {
    let robot = paper();
    let sweeps_at = |i: i32| {
        let sweep = 20.0 * (f64::from(i) * std::f64::consts::TAU / 400.0).sin();
        [sweep, -sweep, sweep, -sweep]
    };
    let travel = robot.ground().travel((0..=400).map(sweeps_at));
    assert!(
        travel.forward.abs() < 1e-5 && travel.left.abs() < 1e-5 && travel.turn.abs() < 1e-5,
        "{travel:?}"
    );
}

#[test]
fn doubling_the_samples_changes_predictions_by_less_than_0_01() {
    let robot = paper();
    for gait in robot.gaits() {
        let sweeps_at = |i| gait.sweeps(gait.phase_at(gait.period() * f64::from(i) / 1000.0));
        let coarse_travel = robot.ground().travel((0..=1000).map(sweeps_at));
        let sweeps_at = |i| gait.sweeps(gait.phase_at(gait.period() * f64::from(i) / 2000.0));
        let fine_travel = robot.ground().travel((0..=2000).map(sweeps_at));
        let error = (coarse_travel.forward - fine_travel.forward)
            .hypot(coarse_travel.left - fine_travel.left);
        assert!(
            error < 0.01 && (coarse_travel.turn - fine_travel.turn).abs() < 0.01,
            "{}: the error is {error} mm",
            gait.name()
        );
    }
}

/// Predicts the forward distance over one cycle of a gait, mm.
fn predict_forward(robot: &Robot, name: &str) -> f64 {
    let forward = robot.predict(gait(robot, name)).forward;
    forward.unwrap_or_else(|| panic!("{name} is undetermined"))
}

#[test]
fn legs_mounted_outward_shorten_walk_far_more_than_crawl() {
    for mount in ["41.0", "49.0"] {
        let robot =
            paper_with("mount = 0.0", &format!("mount = {mount}")).expect("the robot is valid");
        assert!((4.0..=6.5).contains(&predict_forward(&robot, "walk")));
        assert!((21.0..=25.0).contains(&predict_forward(&robot, "crawl")));
    }
}

#[test]
fn pads_that_grip_backward_lengthen_walk_and_shorten_back() {
    let paper_robot = paper();
    let robot_with_ratio = |ratio: &str| {
        paper_with("_forward = 1.0", &format!("_forward = {ratio}")).expect("the robot is valid")
    };
    for ratio in ["1.1", "1.25", "1.5"] {
        let robot = robot_with_ratio(ratio);
        assert!(predict_forward(&robot, "walk") > predict_forward(paper_robot, "walk"));
        assert!(
            predict_forward(&robot, "back") > predict_forward(paper_robot, "back"),
            "the grip shortens the distance backward"
        );
        assert!(
            predict_forward(&robot, "back") < -30.0,
            "the robot still walks backward"
        );
    }
    assert!(
        predict_forward(&robot_with_ratio("2.0"), "back") > 0.0,
        "with too much grip, back moves forward"
    );
}

proptest! {
    #[test]
    fn a_retraced_path_ends_at_its_start(
        path in prop::collection::vec(prop::array::uniform4(-20.0f64..20.0), 2..6),
    ) {
        let robot = paper();
        let travel = robot.ground().travel(path.iter().chain(path.iter().rev()).copied());
        prop_assert!(travel.forward.abs() < 1e-4 && travel.left.abs() < 1e-4 && travel.turn.abs() < 1e-4, "{:?}", travel);
    }
}
