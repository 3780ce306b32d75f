//! Compares the guard's integers with floating point, for random robots in random poses, and checks the reported hazard
//! at each limit.

use std::vec::Vec;

use lizard_kinematics as kinematics;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use super::*;
use crate::guard::bounds::{self, MAX_DIRECTION_ERROR, MarginErrors, Q15_UNIT};
use crate::numbers::limits::Limits;
use crate::numbers::units::Sweep;
use crate::sample::{Measurements, Sample, steps_per_mm, to_f64};

/// Yields random robots, each with several poses, because building a robot takes longer than testing a pose.
fn robots_with_poses() -> impl Strategy<Value = (Sample, [Pose; 8])> {
    Sample::random().prop_flat_map(|robot| {
        let poses = [(); 8].map(|()| robot.any_pose());
        (Just(robot), poses)
    })
}

/// Upper bounds of the guard's errors at a pose.
struct Bounds {
    ends: [MarginErrors; 2],
    /// The errors of the slider lengths, mm.
    sliders: [f64; 2],
}

impl Bounds {
    fn compute(robot: &Sample, pose: &Pose) -> Self {
        let lizard = robot.measurements.lizard;
        let ends = kinematics::End::ALL.map(|end| {
            // In the end's own frame.
            let angles = end.pick(robot.degrees(pose));
            let angles = angles.map(|angle| end.sign() * angle);
            let lengths = &robot.content.ends[end as usize];
            MarginErrors::at_angles(&lizard.end(end), lengths, angles)
        });
        let sliders = kinematics::Side::ALL.map(|side| {
            bounds::slider_error(&lizard.side(side), &robot.content.sliders[side as usize])
        });
        Self { ends, sliders }
    }

    fn max_end_error(&self, error: impl Fn(&MarginErrors) -> f64) -> f64 {
        error(&self.ends[0]).max(error(&self.ends[1]))
    }
}

/// Decides in floating point whether a pose is safe. Returns `Some(true)` if the pose satisfies all limits by more than
/// the errors, `Some(false)` if it violates a limit by more than the errors, and `None` if the errors may change the
/// decision.
fn decide_safety(robot: &Sample, pose: &Pose) -> Option<bool> {
    let bounds = Bounds::compute(robot, pose);
    let Some(solution) = robot.solve(pose) else {
        // If a loop only just fails to close, the guard may compute a margin, but one no larger than its error bound.
        return (bounds.max_end_error(|end| end.type2) < robot.measurements.limits.type2)
            .then_some(false);
    };
    let exact_poses = [&solution.head, &solution.tail];
    let may_have_crossed_tips =
        |(exact_pose, bound): (&&kinematics::FiveBarPose, &MarginErrors)| {
            exact_pose.gap.x.abs() <= bound.gap_x
        };
    if exact_poses
        .iter()
        .zip(&bounds.ends)
        .any(may_have_crossed_tips)
    {
        return None;
    }
    // Limits are rounded up to a step, and strokes are rounded inwards.
    let scales = robot.content.sliders.map(|slider| slider.scale);
    let [left, right] = scales.map(steps_per_mm);
    let coarser_step_mm = 1.0 / left.min(right);
    let limits = robot.measurements.limits;
    let type2_error = bounds.max_end_error(|end| end.type2) + Q15_UNIT;
    let type1_error = bounds.max_end_error(MarginErrors::type1) + Q15_UNIT;
    let stroke_error = bounds.sliders[0].max(bounds.sliders[1]) + coarser_step_mm;
    let shifted_limits = |sign: f64| kinematics::Limits {
        type2: limits.type2 + sign * type2_error,
        type1: limits.type1 + sign * type1_error,
        leg: limits.leg + sign * (MAX_DIRECTION_ERROR + Q15_UNIT),
        stroke_min: limits.stroke_min + sign * stroke_error,
        stroke_max: limits.stroke_max - sign * stroke_error,
    };
    if shifted_limits(1.0).is_safe(&solution) {
        Some(true)
    } else if !shifted_limits(-1.0).is_safe(&solution) {
        Some(false)
    } else {
        None
    }
}

/// Checks that the error of every margin and slider length of a pose is within its bound.
fn check_errors(robot: &Sample, pose: &Pose) -> Result<(), TestCaseError> {
    let clearance = Clearance::measure(robot, pose);
    let Some(solution) = robot.solve(pose) else {
        return Ok(());
    };
    let bounds = Bounds::compute(robot, pose);
    for (index, (name, exact)) in solution.margins.iter().enumerate() {
        let end = match index {
            0 | 1 => index,
            index => kinematics::End::from_servo((index - 2) % 4) as usize,
        };
        let five_bar_pose = [&solution.head, &solution.tail][end];
        let bound = &bounds.ends[end];
        let is_leg = index >= 6;
        let is_unknown = !is_leg && !bound.do_bounds_hold;
        let may_have_crossed_tips = index < 2 && five_bar_pose.gap.x.abs() <= bound.gap_x;
        if is_unknown || may_have_crossed_tips {
            continue;
        }
        let has_crossed_tips = index < 2 && five_bar_pose.gap.x < 0.0;
        let exact = if has_crossed_tips { -exact } else { exact };
        let max_error = match index {
            0..2 => bound.type2,
            2 | 5 => bound.type1_left,
            3 | 4 => bound.type1_right,
            _ => MAX_DIRECTION_ERROR,
        };
        let error = to_f64(clearance.margins[index]) - exact;
        prop_assert!(
            error.abs() <= max_error,
            "{name}: error {error}, at most {max_error} allowed"
        );
    }
    for (index, exact) in [solution.left.d, solution.right.d].into_iter().enumerate() {
        let length = f64::from(clearance.slider_lengths_sq[index]).sqrt();
        let error = length / steps_per_mm(robot.content.sliders[index].scale) - exact;
        let max_error = bounds.sliders[index];
        prop_assert!(
            error.abs() <= max_error,
            "slider {index}: error {error} mm, at most {max_error} mm allowed"
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5_000))]

    #[test]
    fn every_margin_and_slider_length_is_within_its_error_bound(
        (robot, poses) in robots_with_poses(),
    ) {
        for pose in &poses {
            check_errors(&robot, pose)?;
        }
    }

    #[test]
    fn the_decision_matches_floating_point_unless_the_errors_may_change_it(
        (robot, poses) in robots_with_poses(),
    ) {
        for pose in &poses {
            if let Some(is_safe) = decide_safety(&robot, pose) {
                let hazard = Clearance::measure(&robot, pose).first_hazard(&robot);
                prop_assert_eq!(hazard.is_none(), is_safe, "{:?}", hazard);
            }
        }
    }
}

#[test]
fn the_bounds_decide_nearly_every_pose_and_are_narrow_at_neutral() {
    let mut runner = TestRunner::deterministic();
    let mut decided_count = 0;
    for _ in 0..250 {
        let (robot, poses) = robots_with_poses()
            .new_tree(&mut runner)
            .expect("the strategy yields a robot with poses")
            .current();
        let is_decided = |pose: &&Pose| decide_safety(&robot, pose).is_some();
        decided_count += poses.iter().filter(is_decided).count();
        let neutral_bounds = Bounds::compute(&robot, &Pose::NEUTRAL);
        let type2 = neutral_bounds.max_end_error(|end| end.type2);
        let type1 = neutral_bounds.max_end_error(MarginErrors::type1);
        assert!(type2 < 0.01, "type-2 {type2}, type-1 {type1}");
        assert!(type1 < 0.02, "type-2 {type2}, type-1 {type1}");
        let sliders = neutral_bounds.sliders;
        assert!(sliders.iter().all(|mm| *mm < 0.05), "{sliders:?}");
    }
    assert!(decided_count > 1900, "{decided_count} of 2000");
}

/// The sample is safe in floating point but not in integers: its stroke ends just beyond the slider's length at
/// neutral, and the ends of a stroke are rounded inwards.
#[test]
fn a_sample_that_is_safe_only_in_floating_point_does_not_stand_safely() {
    let mut measurements = Measurements::paper();
    let robot = Sample::new(measurements);
    assert!(robot.stands_safely());
    let solution = robot.solve(&Pose::NEUTRAL);
    let solution = solution.expect("the sample has a neutral pose");
    measurements.limits.stroke_max = solution.left.s.max(solution.right.s) + 1e-9;
    assert!(measurements.limits.is_safe(&solution));
    assert!(!Sample::new(measurements).stands_safely());
}

/// Returns a robot and the clearance of its neutral pose, which is far from every limit.
fn measure_safe_robot() -> (Sample, Clearance) {
    let robot = Sample::asymmetric();
    let clearance = Clearance::measure(&robot, &Pose::NEUTRAL);
    assert_eq!(clearance.first_hazard(&robot), None);
    (robot, clearance)
}

/// Returns the ten margins with their limits, in the order in which they are checked.
fn margins_with_limits(limits: &Limits) -> Vec<(Margin, Sine)> {
    let type2 = End::ALL.map(|end| (Margin::Type2(end), limits.type2));
    let type1 = Servo::ALL.map(|servo| (Margin::Type1(servo), limits.type1));
    let leg = Servo::ALL.map(|servo| (Margin::Leg(servo), limits.leg));
    [&type2[..], &type1, &leg].concat()
}

#[test]
fn a_margin_at_its_limit_is_safe_and_one_step_below_it_is_not() {
    let (robot, safe_clearance) = measure_safe_robot();
    for (index, (margin, limit)) in margins_with_limits(&robot.limits()).into_iter().enumerate() {
        let mut limit_clearance = safe_clearance;
        limit_clearance.margins[index] = limit;
        assert_eq!(limit_clearance.first_hazard(&robot), None, "{margin:?}");
        let value = Sine(limit.0 - 1);
        limit_clearance.margins[index] = value;
        let hazard = limit_clearance.first_hazard(&robot);
        assert_eq!(hazard, Some(Hazard::Margin { margin, value }));
    }
}

#[test]
fn a_slider_at_either_end_of_its_stroke_is_safe_and_one_step_beyond_it_is_not() {
    let (robot, safe_clearance) = measure_safe_robot();
    for (index, side) in Side::ALL.into_iter().enumerate() {
        let slider = robot.content.sliders[index];
        let (min, max) = (slider.stroke_min, slider.stroke_max);
        for (length, is_allowed) in [(min, true), (min - 1, false), (max, true), (max + 1, false)] {
            let mut end_clearance = safe_clearance;
            end_clearance.slider_lengths_sq[index] = u32::from(length) * u32::from(length);
            let expected_hazard = (!is_allowed).then_some(Hazard::Stroke { side, length });
            assert_eq!(end_clearance.first_hazard(&robot), expected_hazard);
        }
    }
}

#[test]
fn of_several_hazards_the_first_is_reported_and_margins_precede_strokes() {
    let (robot, mut clearance) = measure_safe_robot();
    for (index, side) in Side::ALL.into_iter().enumerate().rev() {
        clearance.slider_lengths_sq[index] = 100;
        let expected_hazard = Some(Hazard::Stroke { side, length: 10 });
        assert_eq!(clearance.first_hazard(&robot), expected_hazard);
    }
    let margins = margins_with_limits(&robot.limits());
    for (index, (margin, _)) in margins.into_iter().enumerate().rev() {
        let value = Sine(-1);
        clearance.margins[index] = value;
        let expected_hazard = Some(Hazard::Margin { margin, value });
        assert_eq!(clearance.first_hazard(&robot), expected_hazard);
    }
}

#[test]
fn the_smallest_margin_is_found_at_every_index() {
    let (_, safe_clearance) = measure_safe_robot();
    for index in 0..10 {
        let mut clearance = safe_clearance;
        clearance.margins[index] = Sine(-20_000);
        assert_eq!(clearance.min_margin(), Sine(-20_000), "{index}");
    }
}

#[test]
fn a_leg_beyond_a_change_point_has_a_negative_margin_at_either_end() {
    let robot = Sample::asymmetric();
    for servo in 0..4 {
        // The change point is on the x axis of the chassis. Beyond this point, the crank's y is negative in the frame
        // of the leg's five-bar.
        let neutral_deg = f64::from(robot.neutral_angles()[servo].0) * 360.0 / 65536.0;
        let axis_deg = 180.0 * (neutral_deg / 180.0).round();
        for (offset_deg, is_positive) in [(-2.0f64, false), (2.0, true)] {
            let direction = (neutral_deg - axis_deg).signum();
            let turn_deg = axis_deg + offset_deg * direction - neutral_deg;
            let mut pose = Pose::NEUTRAL;
            pose.0[servo] = Sweep((turn_deg * 65536.0 / 360.0) as i16);
            let margin = Clearance::measure(&robot, &pose).margins[6 + servo];
            assert_eq!(margin > Sine(0), is_positive, "A{} {margin:?}", servo + 1);
        }
    }
}
