//! Why the guard is not built on the conditions that the paper prints,
//! sin(theta2 + theta3) = 0 (and its kin of the tail) and sin(2 theta11) = 0.

use lizard::clearance::Clearance;
use lizard::hazard::Kind;
use lizard::pose::Pose;
use lizard::robot::SERVOS;
use lizard::units::angle_from_centideg;
use lizard_host_tests::robot;

use crate::truth::angles;

/// The head's crank angles where the crank tips meet, deg: the one place where
/// the couplers fold and the head swings free.
const MEET: [f64; 2] = [70.52878, 109.47122];

/// A guard on the printed conditions.
struct Printed {
    /// |sin(theta2 + theta3)|.
    head: f64,
    /// |sin(theta6 + theta7)|.
    tail: f64,
    /// |sin(2 theta11)|, left.
    left: f64,
}

impl Printed {
    fn of(pose: &Pose) -> Self {
        let solution = robot()
            .lizard
            .solve(&angles(pose).into())
            .expect("the loops close");
        let size = |degrees: f64| degrees.to_radians().sin().abs();
        Self {
            head: size(solution.theta2() + solution.theta3()),
            tail: size(solution.theta6() + solution.theta7()),
            left: size(2.0 * (solution.left.phi() + 180.0)),
        }
    }

    fn stops(&self) -> bool {
        let limit = robot().limits.type2;
        self.head < limit || self.tail < limit || self.left < limit
    }
}

fn head_at(theta1: f64, theta4: f64) -> Pose {
    let mut pose = Pose::NEUTRAL;
    for (servo, degrees) in [theta1, theta4].into_iter().enumerate() {
        let centideg = (100.0 * degrees).round() as i32;
        pose.0[servo] = SERVOS[servo].sweep_to(angle_from_centideg(centideg));
    }
    pose
}

#[test]
fn the_printed_conditions_would_stop_the_robot_at_home() {
    let home = Printed::of(&Pose::NEUTRAL);
    assert!(home.head < 1e-3 && home.tail < 1e-3 && home.left < 1e-3);
    assert!(home.stops());
    assert!(Clearance::of(&Pose::NEUTRAL).hazard().is_none());
}

#[test]
fn the_printed_condition_calls_every_symmetric_head_singular() {
    let mut stopped = 0;
    for sweep in -4000..4000 {
        let pose = Pose([sweep, -sweep, 0, 0]);
        if Clearance::of(&pose).hazard().is_none() {
            // Neutral angles are rounded to the core's step of 0.0055 deg.
            assert!(Printed::of(&pose).head < 1e-3, "{sweep}");
            stopped += 1;
        }
    }
    assert!(stopped > 5000, "{stopped} symmetric poses are safe");
}

#[test]
fn the_printed_conditions_would_stop_every_gait() {
    for id in lizard::gait::GaitId::all() {
        let gait = id.load();
        let stopped = (0..256u32)
            .filter(|n| Printed::of(&gait.pose(n << 16)).stops())
            .count();
        assert!(stopped > 64, "{:?}: {stopped} of 256", gait.name);
    }
}

#[test]
fn the_printed_condition_is_blind_to_the_real_singularity_and_the_guard_is_not() {
    let mut best = 0.0f64;
    for around in 0..360 {
        let (dy, dx) = f64::from(around).to_radians().sin_cos();
        let pose = head_at(MEET[0] + dx, MEET[1] + dy);
        best = best.max(Printed::of(&pose).head);
        let hazard = Clearance::of(&pose).hazard().expect("a degree beside it");
        assert_eq!(
            (hazard.check.kind(), hazard.check.which()),
            (Kind::Type2, 0)
        );
    }
    println!("a degree beside the singularity, |sin(theta2 + theta3)| is up to {best:.3}");
    assert!(best > 0.95);
    // On the spot, too, and at its mirror image in the tail.
    for pose in [head_at(MEET[0], MEET[1]), {
        let head = head_at(MEET[0], MEET[1]).0;
        Pose([0, 0, -head[1], -head[0]])
    }] {
        let hazard = Clearance::of(&pose).hazard().expect("couplers fold");
        assert_eq!(hazard.check.kind(), Kind::Type2);
    }
}
