//! Tests that a solution contains only finite numbers, whatever the lengths and angles.

use lizard_kinematics::{AssemblyMode, Fault, FiveBar, FiveBarPose, Pose, Slider, Vector};
use proptest::prelude::*;

use crate::reference::{any_lizard, any_pose, paper_lizard};

/// Ordinary lengths, lengths over the whole range of f64, and lengths near 1e77 and 1e154, whose
/// fourth and second powers, respectively, just overflow.
fn any_length() -> impl Strategy<Value = f64> {
    let scale = |(mantissa, exponent): (f64, i32)| mantissa * 10f64.powi(exponent);
    prop_oneof![
        5.0..200.0f64,
        (1.0..10.0f64, -320..308i32).prop_map(scale),
        (1.0..1.01f64, 74..79i32).prop_map(scale),
        (1.0..1.01f64, 150..156i32).prop_map(scale),
    ]
}

/// Five-bars with links of similar lengths, most of which close, and five-bars with links of unrelated lengths.
fn any_five_bar() -> impl Strategy<Value = FiveBar> {
    let optional_scale = || prop_oneof![Just(None), any_length().prop_map(Some)];
    (
        optional_scale(),
        proptest::array::uniform5(0.2..2.0f64),
        proptest::array::uniform5(any_length()),
    )
        .prop_map(|(scale, factors, lengths)| {
            FiveBar::new(match scale {
                Some(scale) => factors.map(|factor| factor * scale),
                None => lengths,
            })
        })
}

fn is_finite_pose(pose: &FiveBarPose) -> bool {
    let vectors = [
        pose.left_crank,
        pose.right_crank,
        pose.left_tip,
        pose.right_tip,
        pose.left_coupler,
        pose.right_coupler,
        pose.end_point,
        pose.gap,
    ];
    let margins = [pose.type2, pose.type1_left(), pose.type1_right()];
    vectors.iter().all(|v| v.is_finite()) && margins.iter().all(|margin| margin.is_finite())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn a_five_bar_of_any_size_has_a_finite_pose_or_a_fault(five_bar in any_five_bar(), left in any::<f64>(), right in -180.0..180.0f64) {
        for mode in [AssemblyMode::Ahead, AssemblyMode::Behind] {
            if let Ok(pose) = five_bar.forward_in_mode(mode, left, right) {
                prop_assert!(is_finite_pose(&pose), "{pose:?}");
            }
        }
    }

    #[test]
    fn the_inverse_of_a_five_bar_of_any_size_is_finite_and_correct_or_a_fault(
        five_bar in any_five_bar(), x in -1.0..1.0f64, y in 0.0..2.0f64, random_scale in any_length(),
    ) {
        for scale in [five_bar.left_crank_length, random_scale] {
            let point = Vector::new(x * scale, y * scale);
            if let Ok(solutions) = five_bar.inverse(point) {
                for solution in solutions {
                    prop_assert!(solution.theta_left.is_finite() && solution.theta_right.is_finite());
                    // The coupler has its length, so no intermediate result has underflowed.
                    let tip = five_bar.left_shaft() + Vector::from_angle(solution.theta_left) * five_bar.left_crank_length;
                    let coupler_length = (point - tip).length();
                    let error = (coupler_length - five_bar.left_coupler_length).abs();
                    let total_length = five_bar.left_crank_length + five_bar.left_coupler_length + five_bar.base;
                    prop_assert!(error < 1e-6 * total_length, "error {error} mm, total length {total_length} mm: {solution:?}");
                }
            }
            if let Ok(pose) = five_bar.pose_at_point(point) {
                prop_assert!(is_finite_pose(&pose));
            }
        }
    }

    #[test]
    fn a_slider_of_any_size_has_a_finite_pose_or_a_fault(
        lengths in proptest::array::uniform5(any_length()), rear in any::<f64>(), front in 0.0..360.0f64,
    ) {
        let [front_offset, base, front_arm, rear_arm, nominal_length] = lengths;
        let slider = Slider { front_offset, base, front_arm, rear_arm, nominal_length };
        if let Ok(pose) = slider.forward(rear, front) {
            prop_assert!(pose.d.is_finite() && pose.s.is_finite() && pose.span.is_finite());
            prop_assert!(pose.rear_tip.is_finite() && pose.front_tip.is_finite());
        }
    }

    #[test]
    fn an_angle_and_its_remainder_modulo_360_degrees_have_the_same_solution(
        robot in any_lizard(), pose in any_pose(), angle in any::<f64>(), servo in 0..4usize,
    ) {
        prop_assume!(angle.is_finite());
        let mut pose = pose;
        pose[servo] = angle;
        let solution = robot.solve(&Pose::from(pose));
        pose[servo] = angle % 360.0;
        let reduced_solution = robot.solve(&Pose::from(pose));
        prop_assert_eq!(solution.is_ok(), reduced_solution.is_ok());
        if let (Ok(solution), Ok(reduced_solution)) = (solution, reduced_solution) {
            prop_assert_eq!(solution.margins, reduced_solution.margins);
            prop_assert_eq!(solution.head_point(), reduced_solution.head_point());
            prop_assert_eq!(solution.legs[servo].follower_angle(), reduced_solution.legs[servo].follower_angle());
        }
    }
}

#[test]
fn a_length_that_is_not_finite_or_overflows_is_reported_with_its_mechanism() {
    for (index, length, mechanism) in [
        (0, 1e200, "head"),
        (1, f64::NAN, "head"),
        (2, f64::INFINITY, "head"),
        (8, f64::NAN, "tail"),
        (9, 1e308, "tail"),
        (13, f64::INFINITY, "left side"),
        (14, 1e308, "left side"),
        (16, 1e308, "right side"),
        (18, f64::NAN, "right side"),
    ] {
        let mut robot = paper_lizard();
        let mut lengths = robot.links.to_array();
        lengths[index] = length;
        robot.links = lengths.into();
        let neutral = [138.59, 41.41, 318.59, 221.41];
        let result = robot.solve(&neutral.into());
        let infeasible = result.expect_err("the robot has no finite pose");
        assert_eq!(infeasible.mechanism.to_string(), mechanism, "l{index}");
        assert_eq!(infeasible.fault, Fault::NotFinite, "l{index}");
    }
}
