//! The complete robot: loops, conventions, neutral pose, limits.

use crate::reference::{any_solved_lizard, cis, config_with_cases, loop_residuals, paper_lizard};
use lizard_kinematics::{Check, End, Limits, Vector, wrap};
use proptest::prelude::*;

/// The neutral servo angles, degrees, in servo order.
const NEUTRAL_POSE: [f64; 4] = [138.590378, 41.409622, 318.590378, 221.409622];

/// The limits of a safe pose of the paper's robot.
const LIMITS: Limits = Limits {
    type2: 0.3,
    type1: 0.3,
    leg: 0.3,
    stroke_min: -15.0,
    stroke_max: 45.0,
};

/// The messages for the limits that the paper's robot violates in a pose.
fn violation_messages(pose: [f64; 4]) -> Vec<String> {
    let solution = paper_lizard().solve(&pose.into()).unwrap();
    let violations = LIMITS.violations(&solution);
    violations.map(|violation| violation.to_string()).collect()
}

#[test]
fn the_neutral_pose_is_safe_and_symmetrical_with_nominal_sliders() {
    let solution = paper_lizard().solve(&NEUTRAL_POSE.into()).unwrap();
    assert!(solution.left.s.abs() < 1e-6 && solution.right.s.abs() < 1e-6);
    assert!((solution.head.gap.length() - 65.0).abs() < 1e-6);
    assert!((solution.head.end_point - Vector::new(0.0, 57.840)).length() < 1e-3);
    assert!((solution.head_point() - Vector::new(0.0, 125.340)).length() < 1e-3);
    assert!((solution.tail_point() - Vector::new(0.0, -125.340)).length() < 1e-3);
    assert!((solution.margins.type2[0] - 0.98791).abs() < 1e-5);
    assert!((solution.left.phi() - 90.0).abs() < 1e-9);
    assert!(LIMITS.is_safe(&solution));
}

proptest! {
    #![proptest_config(config_with_cases(4096))]

    #[test]
    fn all_four_loops_close_in_the_chassis_frame((robot, pose, solution) in any_solved_lizard()) {
        let [t1, t4, t8, t5] = pose;
        // With angles in the chassis frame, one equation holds for both ends, although their own frames are mirrored.
        let head = loop_residuals(&robot.end(End::Head), [t1, solution.theta2(), solution.theta3(), t4]);
        let tail = loop_residuals(&robot.end(End::Tail), [t5, solution.theta6(), solution.theta7(), t8]);
        prop_assert!(head[0].hypot(head[1]) < 1e-9);
        prop_assert!(tail[0].hypot(tail[1]) < 1e-9);
        // The paper's R10 + R14 = R11 + R12 + R13 on the left, as a difference, and the same loop on the right.
        let ([a1, a2, a3, a4], l) = (robot.shafts(), &robot.links);
        let left = a1 + cis(t1 + 90.0) * l.l14
            - a4 - cis(t5 - 90.0) * l.l11 - cis(solution.left.phi()) * (l.l12 + l.l13 + solution.left.s);
        let right = a2 + cis(t4 - 90.0) * l.l19
            - a3 - cis(t8 + 90.0) * l.l16 - cis(solution.right.phi()) * (l.l17 + l.l18 + solution.right.s);
        prop_assert!(left.length() < 1e-9, "{left:?}");
        prop_assert!(right.length() < 1e-9, "{right:?}");
        // The end points, from a shaft along crank and coupler.
        let head = a1 + cis(t1) * l.l1 + cis(solution.theta2()) * l.l2;
        let tail = a3 + cis(t8) * l.l9 + cis(solution.theta7()) * l.l8;
        prop_assert!((solution.head_point() - head).length() < 1e-9);
        prop_assert!((solution.tail_point() - tail).length() < 1e-9);
        for (leg, theta) in solution.legs.iter().zip(pose) {
            prop_assert!(wrap(leg.follower_angle() - theta).abs() < 1e-9);
        }
    }

    #[test]
    fn swapping_left_and_right_mirrors_the_robot(
        t1 in 80.0..170.0f64, t4 in 10.0..100.0f64, t8 in 260.0..350.0f64, t5 in 190.0..280.0f64,
    ) {
        let robot = paper_lizard();
        let original = robot.solve(&[t1, t4, t8, t5].into());
        let mirrored = robot.solve(&[180.0 - t4, 180.0 - t1, 540.0 - t5, 540.0 - t8].into());
        prop_assume!(original.is_ok());
        let (original, mirrored) = (original.unwrap(), mirrored.unwrap());
        prop_assert!((original.head_point().x + mirrored.head_point().x).abs() < 1e-9);
        prop_assert!((original.left.s - mirrored.right.s).abs() < 1e-9);
        prop_assert!((original.margins.type1[0] - mirrored.margins.type1[1]).abs() < 1e-9);
        prop_assert!((original.margins.type1[2] - mirrored.margins.type1[3]).abs() < 1e-9);
    }

    // The ranges of A2, A3 and A4 are the mirror images of A1's.
    #[test]
    fn every_pose_with_a1_between_94_and_162_degrees_is_safe(
        t1 in 94.0..162.0f64, t4 in 18.0..86.0f64, t8 in 18.0..86.0f64, t5 in 94.0..162.0f64,
    ) {
        let solution = paper_lizard().solve(&[t1, t4, -t8, -t5].into()).unwrap();
        let messages = violation_messages([t1, t4, -t8, -t5]);
        prop_assert!(messages.is_empty(), "{messages:?}");
        prop_assert!(solution.margins.min().1 >= 0.3);
    }
}

#[test]
fn point_angles_put_head_and_tail_at_their_points() {
    let robot = paper_lizard();
    let point_angles =
        |end: End, x: f64, y: f64| robot.point_angles(end, Vector::new(x, y)).unwrap();
    let [a1, a2] = point_angles(End::Head, 8.0, 52.0);
    let [a3, a4] = point_angles(End::Tail, -5.0, 60.0);
    let solution = robot.solve(&[a1, a2, a3, a4].into()).unwrap();
    assert!((solution.head_point() - Vector::new(8.0, 119.5)).length() < 1e-9);
    assert!((solution.tail_point() - Vector::new(-5.0, -127.5)).length() < 1e-9);
    assert!(LIMITS.is_safe(&solution));
}

#[test]
fn each_violated_limit_has_its_message() {
    let [_, a2, a3, a4] = NEUTRAL_POSE;
    let leg_message = "margin leg_lf 0.070 is below 0.300";
    let arm_message = "margin type1_a1 -0.317 is below 0.300";
    let slider_message = "left slider travel +47.09 mm is above +45.00 mm";
    let crossed_message = "head crank tips are crossed: -18.57 mm from left to right";
    // The leg is beyond its change point: its margin is large enough in magnitude, but negative.
    let change_point_message = "margin leg_rf -0.319 is below 0.300";
    for (pose, message) in [
        ([176.0, a2, a3, a4], leg_message),
        ([60.0, 60.0, a3, a4], arm_message),
        ([88.0, a2, a3, 272.0], slider_message),
        ([50.0, 130.0, a3, a4], crossed_message),
        ([138.59, 341.41, 318.59, 221.41], change_point_message),
    ] {
        assert_eq!(violation_messages(pose), [message]);
    }
}

#[test]
fn a_pose_with_nan_is_infeasible_and_the_error_names_the_mechanism() {
    let result = paper_lizard().solve(&[f64::NAN, 41.0, 318.0, 221.0].into());
    let message = result.unwrap_err().to_string();
    assert_eq!(message, "head: a value is not a finite number");
}

#[test]
fn a_leg_has_the_smallest_of_the_ten_neutral_margins() {
    let margins = paper_lizard().margins(&NEUTRAL_POSE.into()).unwrap();
    let names: Vec<_> = margins.iter().map(|(check, _)| check.name()).collect();
    assert_eq!(
        names.join(" "),
        "type2_head type2_tail type1_a1 type1_a2 type1_a3 type1_a4 leg_lf leg_rf leg_rh leg_lh"
    );
    let (smallest_check, value) = margins.min();
    assert!(Check::LEG.contains(&smallest_check));
    assert!((value - 41.409622f64.to_radians().sin()).abs() < 1e-12);
}
