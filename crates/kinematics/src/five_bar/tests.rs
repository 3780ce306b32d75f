//! Tests of the five-bar: comparisons with Newton's method and with the law of cosines, margins, the inverse, and
//! faults.

use crate::reference::{PAPER_HEAD, end_point_by_cosines, loop_residuals, solve_by_newton};
use lizard_kinematics::{AssemblyMode, Elbow, Fault, FiveBar, Vector, wrap};
use proptest::prelude::*;

/// Any five-bar, symmetrical or not, with links of 5 to 200 mm.
fn any_five_bar() -> impl Strategy<Value = FiveBar> {
    proptest::array::uniform5(5.0..200.0f64).prop_map(FiveBar::new)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4096, ..ProptestConfig::default() })]

    #[test]
    fn closed_loops_close_within_a_billionth_of_a_millimetre(
        five_bar in any_five_bar(), left in -720.0..720.0f64, right in -720.0..720.0f64,
    ) {
        for mode in [AssemblyMode::Ahead, AssemblyMode::Behind] {
            if let Ok(pose) = five_bar.forward_in_mode(mode, left, right) {
                let [x, y] = loop_residuals(
                    &five_bar,
                    [left, pose.theta_left_coupler(), pose.theta_right_coupler(), right],
                );
                prop_assert!(x.hypot(y) < 1e-9, "{mode:?}: the loop is open by {x} {y} mm");
                let coupler_length = (pose.end_point - pose.right_tip).length();
                prop_assert!((coupler_length - five_bar.right_coupler_length).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_solver_agrees_with_the_law_of_cosines(
        five_bar in any_five_bar(), left in -180.0..180.0f64, right in -180.0..180.0f64,
    ) {
        match (five_bar.forward(left, right), end_point_by_cosines(&five_bar, left, right)) {
            (Ok(pose), Some(expected_point)) => {
                // acos loses half the digits when the triangle is flat.
                let tolerance = 1e-9 / pose.type2.max(1e-9);
                prop_assert!((pose.end_point - expected_point).length() < tolerance);
            }
            (Err(Fault::TooFarApart { .. } | Fault::TooClose { .. }), None) => {}
            (computed, expected) => prop_assert!(false, "{computed:?}, expected {expected:?}"),
        }
    }

    #[test]
    fn newtons_method_converges_to_the_closed_form_from_a_perturbed_start(
        five_bar in any_five_bar(), left in -180.0..180.0f64, right in -180.0..180.0f64,
        perturbation in [-2.0..2.0, -2.0..2.0f64],
    ) {
        if let Ok(pose) = five_bar.forward(left, right) && pose.type2 > 0.3 {
            let expected = [pose.theta_left_coupler(), pose.theta_right_coupler()];
            let start = [expected[0] + perturbation[0], expected[1] + perturbation[1]];
            let angles = solve_by_newton(&five_bar, [left, right], start).expect("Newton's method converges");
            for (a, b) in expected.iter().zip(angles) {
                prop_assert!(wrap(a - b).abs() < 1e-9, "{angles:?}, expected {expected:?}");
            }
        }
    }

    #[test]
    fn margins_are_the_sines_of_the_angles_between_their_links(
        five_bar in any_five_bar(), left in -180.0..180.0f64, right in -180.0..180.0f64,
    ) {
        if let Ok(pose) = five_bar.forward(left, right) {
            let (t2, t3) = (pose.theta_left_coupler(), pose.theta_right_coupler());
            let sine = |degrees: f64| degrees.to_radians().sin();
            prop_assert!((pose.type2 - sine(t3 - t2)).abs() < 1e-7);
            prop_assert!((pose.type1_left() - sine(left - t2)).abs() < 1e-9);
            prop_assert!((pose.type1_right() - sine(t3 - right)).abs() < 1e-9);
        }
    }

    #[test]
    fn forward_after_inverse_returns_to_the_point_for_all_four_solutions(
        five_bar in any_five_bar(), x in -300.0..300.0f64, y in -300.0..300.0f64,
    ) {
        let point = Vector::new(x, y);
        if let Ok(solutions) = five_bar.inverse(point) {
            for solution in solutions {
                let pose = five_bar.forward_in_mode(solution.assembly_mode, solution.theta_left, solution.theta_right).unwrap();
                // The end point is badly determined if the crank tips nearly coincide, and if the
                // couplers nearly line up.
                let conditioning = (pose.gap.length() / 1e3).min(pose.type2.abs());
                let tolerance = 1e-9_f64.max(1e-12 / conditioning);
                prop_assert!((pose.end_point - point).length() < tolerance, "{solution:?} {pose:?}");
            }
        }
    }

    #[test]
    fn inverse_after_forward_returns_to_the_angles(
        five_bar in any_five_bar(), left in -180.0..180.0f64, right in -180.0..180.0f64,
    ) {
        if let Ok(pose) = five_bar.forward(left, right) {
            let (left_margin, right_margin) = (pose.type1_left(), pose.type1_right());
            // Near a type-1 singularity, the angles change in proportion to the square root of the
            // point's displacement.
            prop_assume!(left_margin.abs() > 1e-2 && right_margin.abs() > 1e-2 && pose.type2 > 1e-3);
            // If the end point lies on a shaft, the angle of that shaft's crank is free.
            prop_assume!((pose.end_point - five_bar.left_shaft()).length() > 1.0);
            prop_assume!((pose.end_point - five_bar.right_shaft()).length() > 1.0);
            let elbow_for = |margin: f64| if margin > 0.0 { Elbow::Outward } else { Elbow::Inward };
            let solution = five_bar.inverse(pose.end_point).unwrap().into_iter()
                .find(|s| s.working_mode.left == elbow_for(left_margin) && s.working_mode.right == elbow_for(right_margin)).unwrap();
            prop_assert_eq!(solution.assembly_mode, AssemblyMode::Ahead);
            prop_assert!(wrap(solution.theta_left - left).abs() < 1e-9, "{:?}", solution);
            prop_assert!(wrap(solution.theta_right - right).abs() < 1e-9, "{:?}", solution);
        }
    }
}

#[test]
fn forward_after_inverse_returns_to_every_reachable_point_of_the_papers_head() {
    let (mut max_error, mut reachable_count) = (0.0_f64, 0);
    for i in -90..=90 {
        for j in 0..=90 {
            let point = Vector::new(f64::from(i), f64::from(j));
            let Ok([solution, ..]) = PAPER_HEAD.inverse(point) else {
                continue;
            };
            let (left, right) = (solution.theta_left, solution.theta_right);
            let pose = PAPER_HEAD.forward_in_mode(solution.assembly_mode, left, right);
            max_error = max_error.max((pose.unwrap().end_point - point).length());
            reachable_count += 1;
        }
    }
    assert!(max_error < 1e-9, "{max_error} mm");
    // Half a disc with a radius of 80 mm has 10 000 such points, of which some are too close to a shaft.
    assert!(reachable_count > 5_000, "{reachable_count} points");
}

#[test]
fn coinciding_crank_tips_give_a_fault_or_a_finite_singular_pose() {
    // With cos theta = 1/3 the tips meet at (0, 20 sqrt 2).
    let theta = (1.0f64 / 3.0).acos().to_degrees();
    match PAPER_HEAD.forward(theta, 180.0 - theta) {
        Err(Fault::Coincident) => {}
        Ok(pose) => assert!(pose.type2.abs() < 1e-12 && pose.end_point.is_finite()),
        Err(fault) => panic!("{fault}"),
    }
    let five_bar_without_base = FiveBar::new([0.0, 30.0, 50.0, 50.0, 30.0]);
    let result = five_bar_without_base.forward(50.0, 50.0);
    assert_eq!(result, Err(Fault::Coincident));
}

#[test]
fn the_loop_closes_near_the_poses_at_which_the_papers_a_vanishes() {
    // A = (d^2 - 2 K2 l3) / 2 = 0 where the right coupler points along -x.
    let mut min_double_a = f64::INFINITY;
    for step in 0..=1800 {
        let theta4 = f64::from(step) / 10.0;
        for theta1 in [100.0, 120.0, 138.59, 150.0] {
            let Ok(pose) = PAPER_HEAD.forward(theta1, theta4) else {
                continue;
            };
            min_double_a = min_double_a.min((pose.gap.length_squared() - 100.0 * pose.gap.x).abs());
            let (theta2, theta3) = (pose.theta_left_coupler(), pose.theta_right_coupler());
            let [x, y] = loop_residuals(&PAPER_HEAD, [theta1, theta2, theta3, theta4]);
            assert!(x.hypot(y) < 1e-12);
        }
    }
    assert!(
        min_double_a < 10.0,
        "no pose is near A = 0: the smallest |2A| is {min_double_a}"
    );
}

#[test]
fn fault_messages_state_the_distances_and_limits() {
    let range = "between 20.000 and 80.000 mm away";
    for (x, y, distance) in [
        (0.0, 90.0, "90.554 mm from the left shaft"),
        (10.0, 5.0, "5.000 mm from the right shaft"),
    ] {
        let fault = PAPER_HEAD.inverse(Vector::new(x, y)).unwrap_err();
        let message = format!("the point is {distance}, but must be {range}");
        assert_eq!(fault.to_string(), message);
    }
    let fault = PAPER_HEAD.inverse(Vector::new(f64::NAN, 5.0)).unwrap_err();
    assert_eq!(fault.to_string(), "a value is not a finite number");
    for (couplers, cranks, distance, limit) in [
        ([10.0, 15.0], [180.0, 0.0], "80.000", "reach only 25.000"),
        ([80.0, 50.0], [90.0, 90.0], "20.000", "need at least 30.000"),
    ] {
        let five_bar = FiveBar::new([20.0, 30.0, couplers[0], couplers[1], 30.0]);
        let fault = five_bar.forward(cranks[0], cranks[1]).unwrap_err();
        let message =
            format!("the crank tips are {distance} mm apart, but the couplers {limit} mm");
        assert_eq!(fault.to_string(), message);
    }
    let fault = PAPER_HEAD.forward(f64::INFINITY, 0.0).unwrap_err();
    assert_eq!(fault, Fault::NotFinite);
}

#[test]
fn a_distance_or_reach_that_overflows_is_reported_as_not_finite() {
    let far_point = Vector::new(1e200, 0.0);
    let fault = PAPER_HEAD.pose_at_point(far_point).unwrap_err();
    assert_eq!(fault, Fault::NotFinite);
    let infinite_five_bar = FiveBar::new([20.0, 30.0, 50.0, 50.0, f64::INFINITY]);
    let near_point = Vector::new(0.0, 50.0);
    for (five_bar, point) in [(PAPER_HEAD, far_point), (infinite_five_bar, near_point)] {
        assert_eq!(five_bar.inverse(point).unwrap_err(), Fault::NotFinite);
    }
}
