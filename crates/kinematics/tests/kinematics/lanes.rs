//! Several five-bars or sliders computed at once give the same bits as each computed alone. Lanes that do not close
//! do not affect the others.

use lizard_kinematics::{End, Lanes, Lizard, Side, Vector};
use proptest::prelude::*;

use crate::reference::any_lizard;

const N: usize = 8;

fn poses() -> impl Strategy<Value = Vec<[f64; 4]>> {
    let angle = || prop_oneof![0.0..360.0f64, Just(f64::NAN), -1e300..1e300];
    proptest::collection::vec([angle(), angle(), angle(), angle()], N)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1024, ..ProptestConfig::default() })]

    #[test]
    fn a_mechanism_in_a_lane_has_the_bits_of_the_mechanism_alone(
        robot in any_lizard(), poses in poses(),
    ) {
        let cranks: [Vector<Lanes<N>>; 4] = std::array::from_fn(|servo| {
            let all: [Vector; N] = std::array::from_fn(|i| Vector::direction(poses[i][servo]));
            Vector::new(Lanes(all.map(|v| v.x)), Lanes(all.map(|v| v.y)))
        });
        for end in End::ALL {
            let pose = robot.shape_end(end, cranks);
            let closes = robot.end(end).closes(&pose);
            for i in 0..N {
                let [left, right] = end.pick(poses[i]).map(|angle| end.sign() * angle);
                let alone = robot.end(end).forward(left, right);
                prop_assert_eq!(closes[i], alone.is_ok());
                let Ok(alone) = alone else { continue };
                let [.., (_, across)] = alone.conditions(end);
                let pairs = [
                    (pose.type2, alone.type2), (pose.type1_left(), alone.type1_left()),
                    (pose.type1_right(), alone.type1_right()), (pose.gap.x, across),
                ];
                for (lane, one) in pairs {
                    prop_assert_eq!(lane.0[i].to_bits(), one.to_bits());
                }
            }
        }
        for side in Side::ALL {
            let pose = robot.shape_side(side, cranks);
            let closes = robot.side(side).closes(&pose);
            for i in 0..N {
                let alone = travel_by_arms(&robot, side, poses[i]);
                prop_assert_eq!(closes[i], alone.is_some());
                let Some(alone) = alone else { continue };
                prop_assert_eq!(pose.s.0[i].to_bits(), alone.to_bits());
            }
        }
    }
}

/// The travel of a side's slider, computed from the directions of its arms.
fn travel_by_arms(robot: &Lizard, side: Side, pose: [f64; 4]) -> Option<f64> {
    let [front, rear] = side.pick(pose).map(Vector::direction);
    let closed = robot
        .side(side)
        .close(side.rear_arm(rear), side.front_arm(front));
    closed.ok().map(|pose| pose.s)
}
