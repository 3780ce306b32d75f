//! A test with random orders to random robots, in any sequence and at any time.

use proptest::prelude::*;

use super::*;

/// An order to a robot; a pose is given as four sweeps in 1/65536 turn, a speed in percent.
#[derive(Clone, Copy, Debug)]
enum TestOrder {
    Gait(&'static str),
    Pose([i16; 4]),
    Stop,
    Rest,
    Speed(u8),
}

/// Yields random orders, each with the number of frames until the next order.
fn any_orders() -> impl Strategy<Value = Vec<(TestOrder, u32)>> {
    let any_order = prop_oneof![
        5 => prop::sample::select(GAIT_NAMES.to_vec()).prop_map(TestOrder::Gait),
        3 => prop::array::uniform4(-3000i16..3000).prop_map(TestOrder::Pose),
        1 => prop::array::uniform4(-7000i16..7000).prop_map(TestOrder::Pose),
        1 => Just(TestOrder::Stop),
        1 => Just(TestOrder::Rest),
        2 => (10u8..=100).prop_map(TestOrder::Speed),
    ];
    prop::collection::vec((any_order, 0u32..90), 1..12)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn no_frame_is_unsafe_and_no_move_exceeds_the_slew_limit(
        robot in Sample::random(),
        orders in any_orders(),
    ) {
        let mut motion = Motion::awake(robot);
        for (order, frames) in orders {
            match order {
                TestOrder::Gait(name) => motion.start(name),
                TestOrder::Pose(sweeps) => {
                    let pose = Pose(sweeps.map(Sweep));
                    let travel_hazard = pose.first_servo_beyond_travel(motion.calibration()).map(Hazard::Travel);
                    let guard_hazard = Clearance::measure(&motion.robot, &pose).first_hazard(&motion.robot);
                    prop_assert_eq!(motion.go_to(&pose).err(), travel_hazard.or(guard_hazard));
                }
                TestOrder::Stop => motion.stop(),
                TestOrder::Rest => motion.rest(),
                TestOrder::Speed(percent) => motion.set_speed(percent),
            }
            for _ in 0..frames {
                let (pose_before, was_cycling) = (*motion.pose(), motion.is_cycling());
                let pulses = motion.advance_frame();
                let clearance = Clearance::measure(&motion.robot, motion.pose());
                prop_assert_eq!(clearance.first_hazard(&motion.robot), None);
                for (sent_width, pose_width) in pulses.0.into_iter().zip(motion.pose_pulses().0) {
                    prop_assert!(sent_width == PulseWidth(0) || sent_width == pose_width);
                }
                if !was_cycling {
                    let max_turn = pose_before.max_turn_to(motion.pose());
                    prop_assert!(max_turn <= motion.robot.slew().per_frame, "{}", max_turn);
                }
            }
        }
    }
}
