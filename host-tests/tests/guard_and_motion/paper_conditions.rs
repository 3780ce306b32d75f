//! Tests that show why the guard does not use the singularity conditions printed in the paper:
//! sin(theta2 + theta3) = 0, sin(theta6 + theta7) = 0 for the tail, and sin(2 theta11) = 0.

use lizard_core::guard::clearance::Clearance;
use lizard_core::guard::hazard::{Hazard, Margin};
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::part::End;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::{Angle, Sweep};
use lizard_host_tests::paper;

use crate::truth::{angles, is_safe};

/// The head's crank angles where the two crank tips coincide, deg. Only there do the
/// couplers fold onto each other, and the head swings freely.
const CRANK_TIPS_COINCIDE: [f64; 2] = [70.52878, 109.47122];

/// A guard built on the printed conditions.
struct PrintedConditions {
    /// |sin(theta2 + theta3)|.
    head: f64,
    /// |sin(theta6 + theta7)|.
    tail: f64,
    /// |sin(2 theta11)|, left.
    left: f64,
}

impl PrintedConditions {
    fn of(pose: &Pose) -> Self {
        let solution = paper()
            .lizard()
            .solve(&angles(paper().firmware(), pose).into())
            .expect("the loops close");
        let abs_sine = |degrees: f64| degrees.to_radians().sin().abs();
        Self {
            head: abs_sine(solution.theta2() + solution.theta3()),
            tail: abs_sine(solution.theta6() + solution.theta7()),
            left: abs_sine(2.0 * (solution.left.phi() + 180.0)),
        }
    }

    fn stops_robot(&self) -> bool {
        let limit = paper().limits().type2;
        self.head < limit || self.tail < limit || self.left < limit
    }
}

fn pose_with_head_at(theta1: f64, theta4: f64) -> Pose {
    let mut pose = Pose::NEUTRAL;
    for (servo, degrees) in [theta1, theta4].into_iter().enumerate() {
        let centideg = (100.0 * degrees).round() as i32;
        let neutral = paper().firmware().neutral_angles()[servo];
        pose.0[servo] = neutral.sweep_to(Angle::from_centideg(centideg));
    }
    pose
}

#[test]
fn the_conditions_printed_in_the_paper_would_stop_the_robot_at_home() {
    let home = PrintedConditions::of(&Pose::NEUTRAL);
    assert!(home.head < 1e-3 && home.tail < 1e-3 && home.left < 1e-3);
    assert!(home.stops_robot());
    assert!(is_safe(paper().firmware(), &Pose::NEUTRAL));
}

#[test]
fn the_condition_printed_in_the_paper_calls_every_symmetric_head_singular() {
    let mut stopped_count = 0;
    for sweep in -4000..4000 {
        let pose = Pose([sweep, -sweep, 0, 0].map(Sweep));
        if is_safe(paper().firmware(), &pose) {
            // Neutral angles are rounded to the core's step of 0.0055 deg.
            assert!(PrintedConditions::of(&pose).head < 1e-3, "{sweep}");
            stopped_count += 1;
        }
    }
    assert!(
        stopped_count > 5000,
        "{stopped_count} symmetric poses are safe"
    );
}

#[test]
fn the_conditions_printed_in_the_paper_would_stop_every_gait() {
    let firmware = paper().firmware();
    for id in GaitId::all(firmware.gait_count()) {
        let gait = firmware.gait(id);
        let stopped_count = (0..256u32)
            .filter(|n| PrintedConditions::of(&gait.pose(firmware.waves(), n << 16)).stops_robot())
            .count();
        assert!(stopped_count > 64, "{id:?}: {stopped_count} of 256");
    }
}

#[test]
fn the_papers_condition_misses_the_real_singularity_and_the_guard_does_not() {
    let mut largest_sine = 0.0f64;
    for direction_deg in 0..360 {
        let (dy, dx) = f64::from(direction_deg).to_radians().sin_cos();
        let pose = pose_with_head_at(CRANK_TIPS_COINCIDE[0] + dx, CRANK_TIPS_COINCIDE[1] + dy);
        largest_sine = largest_sine.max(PrintedConditions::of(&pose).head);
        assert_eq!(
            refused_margin(&pose),
            Some(Margin::Type2(End::Head)),
            "a degree beside it"
        );
    }
    println!("a degree beside the singularity, |sin(theta2 + theta3)| is up to {largest_sine:.3}");
    assert!(largest_sine > 0.95);
    // The guard also refuses the pose exactly at the singularity, and its mirror image in the tail.
    let head = pose_with_head_at(CRANK_TIPS_COINCIDE[0], CRANK_TIPS_COINCIDE[1]);
    assert_eq!(refused_margin(&head), Some(Margin::Type2(End::Head)));
    let Pose([a1, a2, ..]) = head;
    let tail = Pose([Sweep(0), Sweep(0), Sweep(-a2.0), Sweep(-a1.0)]);
    assert_eq!(refused_margin(&tail), Some(Margin::Type2(End::Tail)));
}

/// Returns the margin that the guard finds too small; `None` if it finds none.
fn refused_margin(pose: &Pose) -> Option<Margin> {
    let firmware = paper().firmware();
    match Clearance::of(firmware, pose).first_hazard(firmware) {
        Some(Hazard::Margin { margin, .. }) => Some(margin),
        _ => None,
    }
}
