//! The conditions of a safe pose for robots without any symmetry, compared with formulas that name each link and each
//! angle by its number in the paper.

use std::collections::{BTreeMap, BTreeSet};

use lizard_kinematics::{Check, End, Limits, Lizard, Side, Vector};
use proptest::prelude::*;

use crate::reference::{
    any_lizard, any_pose, any_solved_lizard, circle_intersection, cis, config_with_cases,
};

/// The sine of the angle from `a` to `b`.
fn sine_between(a: Vector, b: Vector) -> f64 {
    (a.x * b.y - a.y * b.x) / (a.x.hypot(a.y) * b.x.hypot(b.y))
}

/// Computes the values of all conditions by name, in the chassis frame; `None` if a loop does not close.
fn compute_expected_values(
    robot: &Lizard,
    [t1, t4, t8, t5]: [f64; 4],
) -> Option<BTreeMap<&'static str, f64>> {
    let l = &robot.links;
    let y = l.l10 / 2.0;
    let a1 = Vector::new(-l.l0 / 2.0, y);
    let a2 = Vector::new(l.l0 / 2.0, y);
    let a3 = Vector::new(l.l5 / 2.0, -y);
    let a4 = Vector::new(-l.l5 / 2.0, -y);
    // Crank tips.
    let (p1, p4) = (a1 + cis(t1) * l.l1, a2 + cis(t4) * l.l4);
    let (p8, p5) = (a3 + cis(t8) * l.l9, a4 + cis(t5) * l.l6);
    // The head point is to the left of the line from p1 to p4, the tail point to the left of the line from p8 to p5.
    let head = circle_intersection(p1, l.l2, p4, l.l3)?;
    let tail = circle_intersection(p8, l.l8, p5, l.l7)?;
    // Vectors along the sliders.
    let left_span = a1 + cis(t1 + 90.0) * l.l14 - (a4 + cis(t5 - 90.0) * l.l11);
    let right_span = a2 + cis(t4 - 90.0) * l.l19 - (a3 + cis(t8 + 90.0) * l.l16);
    let length = |span: Vector| span.x.hypot(span.y);
    Some(BTreeMap::from([
        ("type2_head", sine_between(head - p1, head - p4)),
        ("type2_tail", sine_between(tail - p8, tail - p5)),
        ("type1_a1", sine_between(head - p1, cis(t1))),
        ("type1_a2", sine_between(cis(t4), head - p4)),
        ("type1_a3", sine_between(tail - p8, cis(t8))),
        ("type1_a4", sine_between(cis(t5), tail - p5)),
        ("leg_lf", t1.to_radians().sin()),
        ("leg_rf", t4.to_radians().sin()),
        ("leg_rh", -t8.to_radians().sin()),
        ("leg_lh", -t5.to_radians().sin()),
        ("stroke_left", length(left_span) - l.l12 - l.l13),
        ("stroke_right", length(right_span) - l.l17 - l.l18),
        ("uncrossed_head", p4.x - p1.x),
        ("uncrossed_tail", p8.x - p5.x),
    ]))
}

/// Random limits, with a different one for each kind of condition.
fn any_limits() -> impl Strategy<Value = Limits> {
    let ranges = [0.05..0.9, 0.05..0.9, 0.05..0.9, -40.0..0.0, 0.0..60.0f64];
    ranges.prop_map(|values| Limits {
        type2: values[0],
        type1: values[1],
        leg: values[2],
        stroke_min: values[3],
        stroke_max: values[4],
    })
}

/// The smallest and the largest safe value of a condition, found by the first word of its name.
fn find_safe_range(limits: &Limits, name: &str) -> (f64, f64) {
    match name.split('_').next().unwrap() {
        "type2" => (limits.type2, f64::INFINITY),
        "type1" => (limits.type1, f64::INFINITY),
        "leg" => (limits.leg, f64::INFINITY),
        "stroke" => (limits.stroke_min, limits.stroke_max),
        _ => (f64::MIN_POSITIVE, f64::INFINITY),
    }
}

proptest! {
    #![proptest_config(config_with_cases(4096))]

    #[test]
    fn conditions_of_asymmetrical_robots_match_their_formulas(
        robot in any_lizard(), pose in any_pose(), turns in -2..=2i32,
    ) {
        let pose = pose.map(|angle| angle + 360.0 * f64::from(turns));
        let solution = robot.solve(&pose.into()).ok();
        let Some(expected_values) = compute_expected_values(&robot, pose) else {
            prop_assert!(solution.is_none_or(|s| s.head.type2.min(s.tail.type2) < 1e-6));
            return Ok(());
        };
        let Some(solution) = solution else {
            prop_assert!(expected_values["type2_head"].min(expected_values["type2_tail"]) < 1e-6);
            return Ok(());
        };
        // For nearly flat triangles the law of cosines loses half of the digits.
        prop_assume!(expected_values["type2_head"].min(expected_values["type2_tail"]) > 1e-4);
        let conditions: BTreeMap<_, _> = solution.conditions().map(|(check, v)| (check.name(), v)).collect();
        prop_assert_eq!(conditions.len(), 14);
        for (name, expected) in &expected_values {
            let actual = conditions[name];
            prop_assert!((actual - expected).abs() < 1e-7, "{name} is {actual}, expected {expected}");
        }
        // The margins and the conditions of each end give the same values.
        for (check, value) in solution.margins.iter() {
            prop_assert_eq!(value, conditions[check.name()]);
        }
        for end in End::ALL {
            for (check, value) in solution.end(end).conditions(end) {
                prop_assert_eq!(value, conditions[check.name()], "{} {}", end, check);
            }
        }
        let smallest = solution.margins.iter().map(|(_, value)| value).fold(1.0, f64::min);
        prop_assert_eq!(solution.margins.min().1, smallest);
    }

    #[test]
    fn violations_are_exactly_the_conditions_out_of_range(
        (_, _, solution) in any_solved_lizard(), limits in any_limits(),
    ) {
        let mut expected = Vec::new();
        for (check, value) in solution.conditions() {
            let (min, max) = find_safe_range(&limits, check.name());
            if value < min {
                let is_crossing = Check::UNCROSSED.contains(&check);
                expected.push((check, value, if is_crossing { 0.0 } else { min }));
            } else if value > max {
                expected.push((check, value, max));
            }
        }
        let violations: Vec<_> = limits.violations(&solution).map(|v| (v.check, v.value, v.limit)).collect();
        prop_assert_eq!(limits.is_safe(&solution), violations.is_empty());
        prop_assert_eq!(&violations, &expected);
        // Each end alone reports the same violations, except those of the sliders.
        let violations_of_end = |end: End| limits.end_violations(end, solution.end(end));
        let names_of_ends = End::ALL.into_iter().flat_map(violations_of_end).map(|v| v.check.name());
        let expected_names = expected.iter().map(|(check, ..)| check);
        let expected_names = expected_names.filter(|check| !Check::STROKE.contains(check)).map(|check| check.name());
        prop_assert_eq!(BTreeSet::from_iter(names_of_ends), BTreeSet::from_iter(expected_names));
    }

    #[test]
    fn a_value_at_its_limit_is_safe_and_the_next_one_is_not_but_tips_0_mm_apart_are_crossed(limits in any_limits()) {
        let limits_of_kinds: [(&[Check], f64); 4] = [
            (&Check::TYPE2, limits.type2),
            (&Check::TYPE1, limits.type1),
            (&Check::LEG, limits.leg),
            (&Check::STROKE, limits.stroke_min),
        ];
        for (checks, min) in limits_of_kinds {
            for &check in checks {
                prop_assert_eq!(limits.violation(check, min), None);
                let violation = limits.violation(check, min.next_down()).unwrap();
                prop_assert_eq!((violation.check, violation.limit), (check, min));
            }
        }
        for check in Check::STROKE {
            prop_assert_eq!(limits.violation(check, limits.stroke_max), None);
            let violation = limits.violation(check, limits.stroke_max.next_up()).unwrap();
            prop_assert_eq!(violation.limit, limits.stroke_max);
        }
        for check in Check::UNCROSSED {
            prop_assert!(limits.violation(check, 0.0).is_some());
            prop_assert_eq!(limits.violation(check, f64::MIN_POSITIVE), None);
        }
    }

    #[test]
    fn crank_tips_end_points_and_arm_tips_lie_at_the_ends_of_their_links(
        (robot, pose, solution) in any_solved_lizard(),
    ) {
        prop_assume!(solution.head.type2.min(solution.tail.type2) > 1e-3);
        let l = &robot.links;
        let distance = |a: Vector, b: Vector| (a - b).length();
        let ([p1, p4, p8, p5], [a1, a2, a3, a4]) = (solution.crank_tips(), robot.shafts());
        for (tip, shaft, theta, length) in [
            (p1, a1, pose[0], l.l1), (p4, a2, pose[1], l.l4),
            (p8, a3, pose[2], l.l9), (p5, a4, pose[3], l.l6),
        ] {
            prop_assert!(distance(tip, shaft + cis(theta) * length) < 1e-9);
        }
        for (end, tips, couplers) in [
            (End::Head, [p1, p4], [l.l2, l.l3]), (End::Tail, [p5, p8], [l.l7, l.l8]),
        ] {
            let point = solution.point(end);
            for i in 0..2 {
                prop_assert!(distance(tips[i] + solution.coupler_directions(end)[i] * couplers[i], point) < 1e-9);
            }
            prop_assert!(distance(robot.to_end(end, point), solution.end(end).end_point) < 1e-9);
        }
        // The arm tips are relative to the rear shafts.
        let [left, right] = Side::ALL.map(|side| solution.side(side));
        prop_assert!(distance(a4 + left.rear_tip, a4 + cis(pose[3] - 90.0) * l.l11) < 1e-9);
        prop_assert!(distance(a4 + left.front_tip, a1 + cis(pose[0] + 90.0) * l.l14) < 1e-9);
        prop_assert!(distance(a3 + right.rear_tip, a3 + cis(pose[2] + 90.0) * l.l16) < 1e-9);
        prop_assert!(distance(a3 + right.front_tip, a2 + cis(pose[1] - 90.0) * l.l19) < 1e-9);
    }

    #[test]
    fn point_angles_put_the_end_point_at_the_point(
        (robot, pose, solution) in any_solved_lizard(),
    ) {
        // `point_angles` returns only outward elbows, and loses digits near a singularity.
        prop_assume!(solution.margins.type1.iter().chain(&solution.margins.type2).all(|m| *m > 1e-2));
        let mut angles = Vec::new();
        for end in End::ALL {
            angles.extend(robot.point_angles(end, solution.end(end).end_point).unwrap());
        }
        for (angle, expected) in angles.into_iter().zip(pose) {
            prop_assert!(angle > -180.0 && angle <= 180.0);
            prop_assert!(lizard_kinematics::wrap(angle - expected).abs() < 1e-9);
        }
    }
}
