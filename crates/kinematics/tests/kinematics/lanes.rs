//! Five-bars and sliders computed together in lanes have the same bits as those computed alone, and lanes that do not
//! close do not affect the others.

use lizard_kinematics::{End, Lanes, Side, Vector};
use proptest::prelude::*;

use crate::reference::any_lizard;

/// Number of poses that are computed together.
const LANE_COUNT: usize = 8;

fn any_poses() -> impl Strategy<Value = Vec<[f64; 4]>> {
    let any_angle = || prop_oneof![0.0..360.0f64, Just(f64::NAN), -1e300..1e300];
    proptest::collection::vec(
        [any_angle(), any_angle(), any_angle(), any_angle()],
        LANE_COUNT,
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1024, ..ProptestConfig::default() })]

    #[test]
    fn a_mechanism_in_a_lane_has_the_same_bits_as_the_mechanism_alone(
        robot in any_lizard(), poses in any_poses(),
    ) {
        let cranks: [Vector<Lanes<LANE_COUNT>>; 4] = std::array::from_fn(|servo| {
            let directions: [Vector; LANE_COUNT] = std::array::from_fn(|i| Vector::from_angle(poses[i][servo]));
            Vector::new(Lanes(directions.map(|v| v.x)), Lanes(directions.map(|v| v.y)))
        });
        for end in End::ALL {
            let pose = robot.end_pose_unchecked(end, cranks);
            let is_closed = robot.end(end).are_loops_closed(&pose);
            for i in 0..LANE_COUNT {
                let [left, right] = end.pick(poses[i]).map(|angle| end.sign() * angle);
                let single_pose = robot.end(end).forward(left, right);
                prop_assert_eq!(is_closed[i], single_pose.is_ok());
                let Ok(single_pose) = single_pose else { continue };
                let [.., (_, crossing)] = single_pose.conditions(end);
                let pairs = [
                    (pose.type2, single_pose.type2), (pose.type1_left(), single_pose.type1_left()),
                    (pose.type1_right(), single_pose.type1_right()), (pose.gap.x, crossing),
                ];
                for (lanes, single) in pairs {
                    prop_assert_eq!(lanes.0[i].to_bits(), single.to_bits());
                }
            }
        }
        for side in Side::ALL {
            let pose = robot.side_pose_unchecked(side, cranks);
            let is_closed = robot.side(side).are_loops_closed(&pose);
            for i in 0..LANE_COUNT {
                let [front, rear] = side.pick(poses[i]).map(Vector::from_angle);
                let single_pose = robot.side(side).close(side.rear_arm(rear), side.front_arm(front));
                prop_assert_eq!(is_closed[i], single_pose.is_ok());
                let Ok(single_pose) = single_pose else { continue };
                prop_assert_eq!(pose.s.0[i].to_bits(), single_pose.s.to_bits());
            }
        }
    }
}
