//! The guard's word on whole poses, anywhere in the servos' travel.

use lizard::clearance::Clearance;
use lizard::hazard::{Check, Kind};
use lizard::pose::Pose;
use lizard::robot::LIMITS;
use lizard_host_tests::robot;
use lizard_kinematics::Check as What;
use proptest::prelude::*;

use crate::truth::{Conditions, MARGIN_BAND, Numbers, STROKE_BAND, Verdict, angles, mm, sine};

/// Poses to look at.
const POSES: u32 = 1_500_000;

#[test]
fn a_pose_passes_the_guard_where_floating_point_finds_it_safe_and_nowhere_else() {
    let mut numbers = Numbers::new(1);
    let (mut seen, mut between) = ([0; 2], 0);
    for n in 0..POSES {
        let mut pose = numbers.pose();
        if n % 2 == 0 {
            // Half the way to neutral: nearer to where safe turns to unsafe.
            pose = Pose(pose.0.map(|sweep| sweep / 2));
        }
        let safe = Clearance::of(&pose).hazard().is_none();
        match Verdict::of(angles(&pose)) {
            Verdict::Between => between += 1,
            verdict => {
                assert_eq!(safe, verdict == Verdict::Safe, "{pose:?}");
                seen[usize::from(safe)] += 1;
            }
        }
    }
    println!(
        "{} safe, {} unsafe, {between} within the band",
        seen[1], seen[0]
    );
    assert!(seen.iter().all(|seen| *seen > POSES / 20) && between < POSES / 20);
}

#[test]
fn the_guard_and_kinematics_mean_the_same_by_safe_outside_the_band() {
    let robot = robot();
    let mut numbers = Numbers::new(2);
    let mut seen = [0; 2];
    for _ in 0..POSES / 3 {
        let pose = numbers.pose();
        let angles = angles(&pose);
        if Verdict::of(angles) == Verdict::Between {
            continue;
        }
        let solution = robot.lizard.solve(&angles.into());
        let allowed = solution.is_ok_and(|solution| robot.limits.allow(&solution));
        let hazard = Clearance::of(&pose).hazard();
        assert_eq!(hazard.is_none(), allowed, "{pose:?}");
        seen[usize::from(allowed)] += 1;
    }
    assert!(seen.iter().all(|seen| *seen > 0), "{seen:?}");
}

#[test]
fn the_reason_is_the_first_condition_that_is_broken_with_its_value() {
    let robot = robot();
    let mut numbers = Numbers::new(3);
    let mut named = [0u32; 12];
    for _ in 0..POSES / 3 {
        let pose = numbers.pose();
        let Some(hazard) = Clearance::of(&pose).hazard() else {
            continue;
        };
        let truth = Conditions::of(&robot.lizard, angles(&pose)).expect("tips never meet");
        let place = (0..12)
            .find(|place| Check::at(*place) == hazard.check)
            .expect("one of twelve");
        let by = truth.clear_by();
        let place = usize::from(place);
        for (before, by) in by.iter().enumerate().take(place) {
            let band = if before < 10 {
                MARGIN_BAND
            } else {
                STROKE_BAND
            };
            assert!(*by >= -band, "{pose:?} {hazard:?}");
        }
        named[place] += 1;
        if place >= 10 {
            let off = mm(hazard.value) - truth.travels[place - 10];
            assert!(off.abs() <= STROKE_BAND, "{pose:?} {hazard:?}");
            assert!(by[place] <= STROKE_BAND);
        } else if place >= 2 || truth.across[place] > 0.0 {
            assert!(by[place] <= MARGIN_BAND, "{pose:?} {hazard:?}");
            assert!(hazard.value < LIMITS.least(hazard.check.kind()));
        }
    }
    println!("reasons, in the order of the conditions: {named:?}");
    assert!(named.iter().all(|count| *count > 0), "{named:?}");
}

#[test]
fn each_condition_is_called_what_it_is() {
    let kinds = [
        (Kind::Type2, 2),
        (Kind::Type1, 4),
        (Kind::Leg, 4),
        (Kind::Stroke, 2),
    ];
    let mut place = 0;
    for (kind, count) in kinds {
        for which in 0..count {
            assert_eq!(Check::at(place).kind(), kind);
            assert_eq!(Check::at(place).which(), which);
            place += 1;
        }
    }
}

#[test]
fn the_limits_are_those_of_the_file_rounded_to_the_safe_side() {
    let limits = &robot().limits;
    for (core, file) in [
        (LIMITS.type2, limits.type2),
        (LIMITS.type1, limits.type1),
        (LIMITS.leg, limits.leg),
    ] {
        assert!(sine(core) >= file && sine(core - 1) < file);
    }
    for slider in [lizard::robot::LEFT, lizard::robot::RIGHT] {
        let [least, most] = slider.stroke().map(mm);
        assert!((least - limits.stroke_min).abs() <= 1.0 / 256.0);
        assert!((most - limits.stroke_max).abs() <= 1.0 / 256.0);
    }
}

#[test]
fn the_smallest_margin_is_the_one_of_kinematics() {
    let robot = robot();
    let mut numbers = Numbers::new(4);
    for _ in 0..POSES / 10 {
        let pose = numbers.safe_pose();
        let (what, least) = robot
            .lizard
            .margins(&angles(&pose).into())
            .expect("a safe pose")
            .min();
        let core = Clearance::of(&pose).smallest();
        assert!((sine(core) - least).abs() <= MARGIN_BAND, "{pose:?} {what}");
        assert!(!matches!(what, What::StrokeLeft | What::StrokeRight));
    }
}

proptest! {
    // Also poses that no servo reaches: the console's `status` asks for the
    // margin of any pose, and arithmetic must not overflow in any.
    #[test]
    fn no_pose_whatever_is_too_much_for_the_guard(sweeps in prop::array::uniform4(any::<i16>())) {
        let pose = Pose(sweeps);
        let safe = Clearance::of(&pose).hazard().is_none();
        match Verdict::of(angles(&pose)) {
            Verdict::Between => {}
            verdict => prop_assert_eq!(safe, verdict == Verdict::Safe),
        }
    }
}
