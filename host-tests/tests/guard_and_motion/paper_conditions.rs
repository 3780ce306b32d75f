//! Tests of the singularity conditions printed in the paper, which the guard does not use: sin(theta2 + theta3) = 0 for
//! the head, sin(theta6 + theta7) = 0 for the tail, and sin(2 theta11) = 0 for the left side.

use lizard_core::guard::clearance::Clearance;
use lizard_core::guard::hazard::{Hazard, Margin};
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::part::End;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::{Angle, Sweep};
use lizard_host_tests::paper_robot;

use crate::reference::{chassis_angles_deg, is_safe};

/// The head's crank angles at which the two crank tips coincide. At this real singularity, the couplers overlap, and
/// the head can swing freely.
const SINGULAR_CRANK_ANGLES_DEG: [f64; 2] = [70.52878, 109.47122];

/// The values of the conditions printed in the paper, for one pose.
struct PrintedConditions {
    /// |sin(theta2 + theta3)|.
    head: f64,
    /// |sin(theta6 + theta7)|.
    tail: f64,
    /// |sin(2 theta11)|, left.
    left: f64,
}

impl PrintedConditions {
    fn compute(pose: &Pose) -> Self {
        let angles = chassis_angles_deg(paper_robot().firmware(), pose);
        let solution = paper_robot().lizard().solve(&angles.into());
        let solution = solution.expect("the loops close");
        let abs_sine = |degrees: f64| degrees.to_radians().sin().abs();
        Self {
            head: abs_sine(solution.theta2() + solution.theta3()),
            tail: abs_sine(solution.theta6() + solution.theta7()),
            left: abs_sine(2.0 * (solution.left.phi() + 180.0)),
        }
    }

    /// True if a guard with these conditions would refuse the pose.
    fn are_violated(&self) -> bool {
        let limit = paper_robot().limits().type2;
        self.head < limit || self.tail < limit || self.left < limit
    }
}

fn build_head_pose(theta1_deg: f64, theta4_deg: f64) -> Pose {
    let mut pose = Pose::NEUTRAL;
    for (servo, degrees) in [theta1_deg, theta4_deg].into_iter().enumerate() {
        let centideg = (100.0 * degrees).round() as i32;
        let neutral = paper_robot().firmware().neutral_angles()[servo];
        pose.0[servo] = neutral.sweep_to(Angle::from_centideg(centideg));
    }
    pose
}

#[test]
fn the_conditions_printed_in_the_paper_would_refuse_the_neutral_pose() {
    let conditions = PrintedConditions::compute(&Pose::NEUTRAL);
    assert!(conditions.head < 1e-3 && conditions.tail < 1e-3 && conditions.left < 1e-3);
    assert!(conditions.are_violated());
    assert!(is_safe(paper_robot().firmware(), &Pose::NEUTRAL));
}

#[test]
fn the_condition_printed_in_the_paper_refuses_every_symmetric_pose_of_the_head() {
    let mut safe_count = 0;
    for sweep in -4000..4000 {
        let pose = Pose([sweep, -sweep, 0, 0].map(Sweep));
        if is_safe(paper_robot().firmware(), &pose) {
            // Neutral angles are rounded to the core's step of 0.0055 deg.
            assert!(PrintedConditions::compute(&pose).head < 1e-3, "{sweep}");
            safe_count += 1;
        }
    }
    assert!(safe_count > 5000, "{safe_count} symmetric poses are safe");
}

#[test]
fn the_conditions_printed_in_the_paper_would_stop_every_gait() {
    let firmware = paper_robot().firmware();
    for id in GaitId::all(firmware.gait_count()) {
        let gait = firmware.gait(id);
        let poses = (0..256).map(|n| gait.pose(firmware.waves(), n << 16));
        let is_stopped = |pose: &Pose| PrintedConditions::compute(pose).are_violated();
        let stopped_count = poses.filter(is_stopped).count();
        assert!(stopped_count > 64, "{id:?}: {stopped_count} of 256");
    }
}

#[test]
fn only_the_guard_and_not_the_papers_condition_refuses_the_real_singularity() {
    let mut largest_sine = 0.0f64;
    for direction_deg in 0..360 {
        let (theta4_change_deg, theta1_change_deg) =
            f64::from(direction_deg).to_radians().sin_cos();
        let pose = build_head_pose(
            SINGULAR_CRANK_ANGLES_DEG[0] + theta1_change_deg,
            SINGULAR_CRANK_ANGLES_DEG[1] + theta4_change_deg,
        );
        largest_sine = largest_sine.max(PrintedConditions::compute(&pose).head);
        assert_eq!(
            refused_margin(&pose),
            Some(Margin::Type2(End::Head)),
            "the refused margin one degree from the singularity"
        );
    }
    println!(
        "one degree from the singularity, |sin(theta2 + theta3)| is at most {largest_sine:.3}"
    );
    assert!(largest_sine > 0.95);
    // The guard also refuses the singularity itself, and the tail's singularity.
    let head_pose = build_head_pose(SINGULAR_CRANK_ANGLES_DEG[0], SINGULAR_CRANK_ANGLES_DEG[1]);
    assert_eq!(refused_margin(&head_pose), Some(Margin::Type2(End::Head)));
    let Pose([a1, a2, ..]) = head_pose;
    let tail_pose = Pose([Sweep(0), Sweep(0), Sweep(-a2.0), Sweep(-a1.0)]);
    assert_eq!(refused_margin(&tail_pose), Some(Margin::Type2(End::Tail)));
}

/// Returns the margin that makes the guard refuse a pose; `None` if the guard accepts every margin.
fn refused_margin(pose: &Pose) -> Option<Margin> {
    let firmware = paper_robot().firmware();
    match Clearance::measure(firmware, pose).first_hazard(firmware) {
        Some(Hazard::Margin { margin, .. }) => Some(margin),
        _ => None,
    }
}
