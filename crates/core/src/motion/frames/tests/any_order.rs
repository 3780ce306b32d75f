//! Random commands in any order and at any time, to random robots.

use std::vec::Vec;

use proptest::prelude::*;

use super::*;

/// An order to a robot.
#[derive(Clone, Copy, Debug)]
enum Ask {
    Gait(&'static str),
    Pose([i16; 4]),
    Stop,
    Rest,
    Speed(u8),
}

/// Random orders, each with the number of frames that follow it.
fn any_orders() -> impl Strategy<Value = Vec<(Ask, u32)>> {
    let any_order = prop_oneof![
        5 => prop::sample::select(GAITS.to_vec()).prop_map(Ask::Gait),
        3 => prop::array::uniform4(-3000i16..3000).prop_map(Ask::Pose),
        1 => prop::array::uniform4(-7000i16..7000).prop_map(Ask::Pose),
        1 => Just(Ask::Stop),
        1 => Just(Ask::Rest),
        2 => (10u8..=100).prop_map(Ask::Speed),
    ];
    prop::collection::vec((any_order, 0u32..90), 1..12)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn no_frame_is_unsafe_or_faster_than_a_move_or_the_gait_may_be(
        robot in Sample::random(),
        orders in any_orders(),
    ) {
        let mut motion = Motion::awake(robot);
        for (order, frames) in orders {
            match order {
                Ask::Gait(name) => motion.start(name),
                Ask::Pose(sweeps) => {
                    let pose = Pose(sweeps.map(Sweep));
                    let travel_hazard = pose.first_beyond_travel(motion.calibration()).map(Hazard::Travel);
                    let hazard = Clearance::of(&motion.robot, &pose).first_hazard(&motion.robot);
                    let hazard = travel_hazard.or(hazard);
                    prop_assert_eq!(motion.go_to(&pose).err(), hazard);
                }
                Ask::Stop => motion.stop(),
                Ask::Rest => motion.rest(),
                Ask::Speed(percent) => motion.set_speed(percent),
            }
            for _ in 0..frames {
                let (pose_before, was_cycling) = (*motion.pose(), motion.is_cycling());
                let pulses = motion.tick();
                let clearance = Clearance::of(&motion.robot, motion.pose());
                prop_assert_eq!(clearance.first_hazard(&motion.robot), None);
                for (actual, held_width) in pulses.0.into_iter().zip(motion.held().0) {
                    prop_assert!(actual == Width(0) || actual == held_width);
                }
                if !was_cycling {
                    let distance = pose_before.largest_turn_to(motion.pose());
                    prop_assert!(distance <= motion.robot.slew().per_frame, "{}", distance);
                }
            }
        }
    }
}
