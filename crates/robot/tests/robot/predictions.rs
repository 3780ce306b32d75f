//! The predicted displacements of the paper's gaits match the values by which the gaits were chosen, and have the
//! symmetries of the contact model.

use lizard_robot::{Report, Robot, Travel};
use proptest::prelude::*;

use crate::{assert_near, gait, paper, paper_with};

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
fn assert_travel_near(name: &str, travel: Travel, forward: f64, turn: f64) {
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
        assert_travel_near(name, predict(robot, name), forward, turn);
    }
}

#[test]
fn the_tables_at_fifty_frames_per_second_move_the_robot_as_far() {
    let robot = paper();
    for (name, forward, turn) in EXPECTED_MOVEMENTS {
        let gait = gait(robot, name);
        let angles = gait.frames().map(|(_, phase)| gait.table_angles(phase));
        assert_travel_near(name, robot.predict_travel(angles), forward, turn);
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
    assert!(report.contains("\n- undetermined: two feet pull against the other two"));
}

#[test]
fn a_reversed_gait_undoes_its_movement() {
    let robot = paper();
    let [walk, back] = ["walk", "back"].map(|name| predict(robot, name));
    assert_near("back", back.forward, -walk.forward, 1e-6);
    // One cycle forward and the same cycle in reverse, for a gait that also turns.
    let arc = gait(robot, "arc-left");
    let cycle: Vec<[f64; 4]> = (0..=500).map(|i| arc.sweeps(i as f64 / 500.0)).collect();
    let retraced_cycle = cycle.iter().chain(cycle.iter().rev()).copied();
    let travel = robot.ground().compute_travel(retraced_cycle);
    assert_near("arc-left", travel.forward.hypot(travel.left), 0.0, 1e-5);
    assert_near("arc-left", travel.turn, 0.0, 1e-6);
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
    let travel = robot.ground().compute_travel((0..=400).map(sweeps_at));
    for component in [travel.forward, travel.left, travel.turn] {
        assert!(component.abs() < 1e-5, "{travel:?}");
    }
}

#[test]
fn doubling_the_samples_changes_predictions_by_less_than_0_01() {
    let robot = paper();
    for gait in robot.gaits() {
        let [coarse, fine] = [1000, 2000].map(|count: i32| {
            let seconds_at = |i: i32| gait.period() * f64::from(i) / f64::from(count);
            let sweeps_at = |i| gait.sweeps(gait.phase_at(seconds_at(i)));
            robot.ground().compute_travel((0..=count).map(sweeps_at))
        });
        let error = (coarse.forward - fine.forward).hypot(coarse.left - fine.left);
        assert_near(gait.name(), error, 0.0, 0.01);
        assert_near(gait.name(), coarse.turn, fine.turn, 0.01);
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
        let robot = paper_with("mount = 0.0", &format!("mount = {mount}")).expect(mount);
        assert!((4.0..=6.5).contains(&predict_forward(&robot, "walk")));
        assert!((21.0..=25.0).contains(&predict_forward(&robot, "crawl")));
    }
}

#[test]
fn pads_that_grip_backward_lengthen_walk_and_shorten_back() {
    let predict_both = |robot: &Robot| ["walk", "back"].map(|name| predict_forward(robot, name));
    let [paper_walk, paper_back] = predict_both(paper());
    let predict_with_ratio = |ratio: &str| {
        let robot = paper_with("_forward = 1.0", &format!("_forward = {ratio}"));
        predict_both(&robot.expect(ratio))
    };
    for ratio in ["1.1", "1.25", "1.5"] {
        let [walk, back] = predict_with_ratio(ratio);
        assert!(walk > paper_walk, "{ratio}");
        assert!(back > paper_back, "the grip shortens the distance backward");
        assert!(back < -30.0, "the robot still walks backward");
    }
    let [_, back] = predict_with_ratio("2.0");
    assert!(back > 0.0, "with too much grip, back moves forward");
}

proptest! {
    #[test]
    fn a_retraced_path_ends_at_its_start(
        path in prop::collection::vec(prop::array::uniform4(-20.0f64..20.0), 2..6),
    ) {
        let robot = paper();
        let travel = robot.ground().compute_travel(path.iter().chain(path.iter().rev()).copied());
        prop_assert!(travel.forward.abs() < 1e-4 && travel.left.abs() < 1e-4 && travel.turn.abs() < 1e-4, "{:?}", travel);
    }
}
