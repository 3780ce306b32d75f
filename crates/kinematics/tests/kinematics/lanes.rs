//! Several poses in step have the bits of each alone.

use lizard_kinematics::{End, Lanes, Lizard, Pose, Side, Solution, Vector};
use proptest::prelude::*;

use crate::reference::any_lizard;

const N: usize = 8;

/// All numbers of a solution that a pose alone and a lane have in common.
macro_rules! numbers {
    ($s:expr) => {{
        let (s, p) = ($s, $s.passive());
        let (head, tail) = (s.head_point(), s.tail_point());
        let (m, tips) = (&s.margins, s.crank_tips());
        let mut all = vec![
            p.theta2,
            p.theta3,
            p.theta6,
            p.theta7,
            p.phi_left,
            p.phi_right,
            p.s_left,
            p.s_right,
            head.x,
            head.y,
            tail.x,
            tail.y,
            s.head.gap.x,
            s.tail.gap.x,
        ];
        all.extend(m.type2);
        all.extend(m.type1);
        all.extend(m.leg);
        all.extend(tips.map(|tip| tip.x));
        all.extend(tips.map(|tip| tip.y));
        all
    }};
}

fn lanes(poses: &[[f64; 4]]) -> Pose<Lanes<N>> {
    Pose::from(std::array::from_fn(|servo| {
        Lanes(std::array::from_fn(|i| poses[i][servo]))
    }))
}

fn poses() -> impl Strategy<Value = Vec<[f64; 4]>> {
    let angle = || prop_oneof![0.0..360.0f64, Just(f64::NAN), -1e300..1e300];
    proptest::collection::vec([angle(), angle(), angle(), angle()], N)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1024, ..ProptestConfig::default() })]

    #[test]
    fn a_pose_in_a_lane_has_the_bits_of_the_pose_alone(robot in any_lizard(), poses in poses()) {
        let all = robot.solve_lanes(&lanes(&poses));
        let (closes, lanes) = (robot.closes(&all), numbers!(&all));
        for (i, pose) in poses.iter().enumerate() {
            let alone = robot.solve(&Pose::from(*pose));
            prop_assert_eq!(closes[i], alone.is_ok());
            let Ok(alone) = alone else { continue };
            let alone: Vec<f64> = numbers!(&alone);
            for (lane, one) in lanes.iter().zip(alone) {
                prop_assert_eq!(lane.0[i].to_bits(), one.to_bits());
            }
        }
    }

    #[test]
    fn an_end_or_a_side_by_itself_has_the_bits_that_it_has_in_the_robot(
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
                let alone = alone(&robot, side, poses[i]);
                prop_assert_eq!(closes[i], alone.is_some());
                let Some(alone) = alone else { continue };
                prop_assert_eq!(pose.s.0[i].to_bits(), alone.to_bits());
            }
        }
    }
}

/// The travel of a side, by way of its arms' angles.
fn alone(robot: &Lizard, side: Side, pose: [f64; 4]) -> Option<f64> {
    let [front, rear] = side.pick(pose).map(Vector::direction);
    let closed = robot
        .side(side)
        .close(side.rear_arm(rear), side.front_arm(front));
    closed.ok().map(|pose| pose.s)
}

#[test]
fn lanes_do_not_mix() {
    // One lane that does not close leaves the others as they are.
    let robot = crate::reference::lizard();
    let neutral = [138.59, 41.41, 318.59, 221.41];
    let mut poses = [neutral; N];
    poses[3] = [f64::NAN; 4];
    let all = robot.solve_lanes(&lanes(&poses));
    let closes = robot.closes(&all);
    assert_eq!(closes.iter().filter(|closes| **closes).count(), N - 1);
    assert!(!closes[3]);
    let one: Solution = robot.solve(&neutral.into()).unwrap();
    assert_eq!(all.margins.type2[1].0[7], one.margins.type2[1]);
}

#[test]
fn no_lane_closes_if_any_one_loop_does_not() {
    // A link of each loop that no other loop has: head, tail, left, right.
    let neutral = [[138.59, 41.41, 318.59, 221.41]; N];
    for link in [3, 8, 13, 18] {
        let paper = crate::reference::lizard();
        let mut l = paper.links.to_array();
        l[link] = f64::NAN;
        let robot = Lizard {
            links: l.into(),
            ..paper
        };
        let all = robot.solve_lanes(&lanes(&neutral));
        assert_eq!(robot.closes(&all), [false; N], "l{link}");
    }
}
