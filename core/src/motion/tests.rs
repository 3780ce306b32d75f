//! The transition table of the module, row by row, and what no frame may do.

use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::sample::{GAITS, Sample};
use crate::units::{CYCLE, Sweep};

/// Frames until all servos are awake.
const WAKING: u32 = 20;

/// Braking, the longest move of these tests, gathering pace.
const LONG_ENOUGH: u32 = 150;

impl Motion<Sample> {
    /// Awake, standing, for as long as it takes to have all its pace.
    fn standing() -> Self {
        Self::awake(Sample::odd())
    }

    fn awake(robot: Sample) -> Self {
        let mut motion = Self::new(robot);
        motion.run(WAKING + 7);
        motion
    }

    /// In a gait, some frames after it was asked for.
    fn in_gait(name: &str, frames: u32) -> Self {
        let mut motion = Self::standing();
        motion.start(name);
        motion.run(frames);
        motion
    }

    fn run(&mut self, frames: u32) {
        for _ in 0..frames {
            self.tick();
        }
    }

    fn start(&mut self, name: &str) {
        self.start_gait(self.robot.id(name));
    }

    fn head_for_pose(&mut self, sweeps: [i16; 4]) {
        let pose = Pose(sweeps.map(Sweep));
        self.go_to(&pose).expect("a safe pose");
    }

    fn is_moving(&self) -> bool {
        matches!(self.state, State::Moving { .. })
    }

    fn is_cycling(&self) -> bool {
        matches!(self.state, State::Cycling { .. })
    }

    fn gait(&self) -> Option<&'static str> {
        match self.activity() {
            Activity::Gait(id) => Some(GAITS[id.index()]),
            _ => None,
        }
    }

    fn pace(&self) -> u16 {
        match self.state {
            State::Moving { pace, .. } | State::Cycling { pace, .. } => pace,
            _ => 0,
        }
    }

    /// The pulses of the pose that is held.
    fn held(&self) -> Pulses {
        self.pose.pulses(&self.calibration)
    }
}

const THERE: [i16; 4] = [900, -700, 800, -1100];
const BACK: [i16; 4] = [-600, 500, -800, 700];

/// Two motions that have nothing to tell them apart for some frames.
fn assert_same(mut one: Motion<Sample>, mut other: Motion<Sample>) {
    for _ in 0..100 {
        assert_eq!(one.tick(), other.tick());
        assert_eq!(one.activity(), other.activity());
        assert_eq!(one.phase(), other.phase());
        assert_eq!(one.hazard(), other.hazard());
    }
}

// Resting.

fn resting() -> Motion<Sample> {
    let mut motion = Motion::in_gait("sway", 90);
    motion.rest();
    motion.run(10);
    motion
}

#[test]
fn while_it_rests_no_frame_has_a_pulse_and_the_pose_is_kept() {
    let mut motion = Motion::in_gait("sway", 90);
    let pose = *motion.pose();
    motion.rest();
    for _ in 0..50 {
        assert_eq!(motion.tick(), Pulses::default());
        assert_eq!(motion.activity(), Activity::Rest);
        assert_eq!(motion.pose(), &pose);
        assert_eq!(motion.phase(), 0);
    }
}

#[test]
fn stop_and_rest_change_nothing_while_it_rests() {
    for ask in [Motion::<Sample>::stop, Motion::<Sample>::rest] {
        let mut motion = resting();
        ask(&mut motion);
        assert_eq!(motion.activity(), Activity::Rest);
        assert_eq!(motion.tick(), Pulses::default());
    }
}

#[test]
fn a_gait_or_a_pose_wakes_the_servos_where_they_were_left_before_anything_moves() {
    for pose in [false, true] {
        let mut motion = resting();
        let left = *motion.pose();
        if pose {
            motion.head_for_pose(THERE);
            assert_eq!(motion.activity(), Activity::Pose);
        } else {
            motion.start("swing");
            assert_eq!(motion.gait(), Some("swing"));
        }
        for _ in 0..WAKING {
            motion.tick();
            assert_eq!(motion.pose(), &left);
        }
        assert_eq!(motion.tick(), motion.held());
        assert!(motion.is_moving());
        motion.run(LONG_ENOUGH);
        if pose {
            assert_eq!(motion.pose(), &Pose(THERE.map(Sweep)));
        } else {
            assert!(motion.is_cycling());
        }
    }
}

#[test]
fn servos_wake_one_by_one_a_tenth_of_a_second_apart_and_stay_awake() {
    let mut again = resting();
    again.start("stand");
    for mut motion in [Motion::new(Sample::odd()), again] {
        let held = motion.held();
        let mut since = [0; 4];
        for frame in 1..=WAKING {
            for (place, width) in motion.tick().0.into_iter().enumerate() {
                if width != Width(0) && since[place] == 0 {
                    since[place] = frame;
                }
                let expected = if since[place] > 0 {
                    held.0[place]
                } else {
                    Width(0)
                };
                assert_eq!(width, expected);
            }
        }
        assert_eq!(since, [5, 10, 15, 20]);
    }
}

#[test]
fn a_robot_that_is_told_to_rest_while_it_wakes_wakes_from_the_beginning_later() {
    let mut motion = Motion::new(Sample::odd());
    motion.run(12);
    motion.rest();
    assert_eq!(motion.tick(), Pulses::default());
    motion.start("stand");
    let awake = (0..WAKING).map(|_| motion.tick().0.map(|width| u8::from(width.0 > 0)));
    let awake: Vec<u8> = awake.map(|servos| servos.iter().sum()).collect();
    let expected: Vec<u8> = (1..=WAKING).map(|frame| (frame / 5) as u8).collect();
    assert_eq!(awake, expected);
}

#[test]
fn stop_while_it_wakes_lets_the_servos_wake_and_nothing_move() {
    let mut motion = resting();
    motion.start("sway");
    motion.run(7);
    motion.stop();
    let pose = *motion.pose();
    motion.run(LONG_ENOUGH);
    assert_eq!(motion.activity(), Activity::Stop);
    assert_eq!(motion.pose(), &pose);
    assert_eq!(motion.tick(), motion.held());
    assert!(motion.held().0.iter().all(|width| *width > Width(0)));
}

#[test]
fn what_is_asked_for_while_it_wakes_waits_until_all_are_awake() {
    let mut motion = Motion::new(Sample::odd());
    motion.run(3);
    motion.head_for_pose(THERE);
    motion.run(WAKING - 3);
    assert_eq!(motion.pose(), &Pose::NEUTRAL);
    motion.run(LONG_ENOUGH);
    assert_eq!(motion.pose(), &Pose(THERE.map(Sweep)));
}

// Holding.

#[test]
fn a_held_pose_stays_and_says_whether_it_was_asked_for() {
    let mut stopped = Motion::in_gait("sway", 90);
    stopped.stop();
    let mut posed = Motion::standing();
    posed.head_for_pose(THERE);
    posed.run(LONG_ENOUGH);
    for (mut motion, activity) in [(stopped, Activity::Stop), (posed, Activity::Pose)] {
        let held = motion.held();
        for _ in 0..50 {
            assert_eq!(motion.tick(), held);
            assert_eq!(motion.activity(), activity);
        }
    }
}

#[test]
fn from_a_held_pose_the_next_frame_begins_the_move_to_a_gait_or_a_pose() {
    for gait in [false, true] {
        let mut motion = Motion::in_gait("sway", 90);
        motion.stop();
        motion.run(5);
        let held = *motion.pose();
        if gait {
            motion.start("sway");
        } else {
            motion.head_for_pose(THERE);
        }
        motion.tick();
        assert!(motion.is_moving());
        assert_ne!(motion.pose(), &held);
    }
}

// Moving.

#[test]
fn a_move_that_arrives_at_a_pose_holds_it() {
    let mut motion = Motion::standing();
    motion.head_for_pose(THERE);
    motion.run(LONG_ENOUGH);
    assert_eq!(motion.pose(), &Pose(THERE.map(Sweep)));
    assert_eq!(motion.state, State::Holding { asked: true });
}

#[test]
fn a_move_that_arrives_at_a_gait_cycles_from_phase_0_and_gathers_pace() {
    for name in GAITS {
        let mut motion = Motion::in_gait("swing", 90);
        motion.stop();
        motion.start(name);
        let id = motion.robot.id(name);
        let gait = motion.robot.gait(id);
        motion.tick();
        while motion.is_moving() {
            assert_eq!(motion.phase(), 0);
            motion.tick();
        }
        assert_eq!(motion.state, State::cycling(&motion.robot, id));
        assert_eq!(motion.pose(), &gait.pose(motion.robot.waves(), 0));
        let mut phase = 0;
        for pace in [147, 294, 441, 588, 735, 882, 1024, 1024] {
            motion.tick();
            phase = gait.advance(phase, pace);
            assert_eq!((motion.pace(), motion.phase()), (pace, phase));
            assert_eq!(motion.pose(), &gait.pose(motion.robot.waves(), phase));
        }
    }
}

#[test]
fn another_pose_or_gait_lets_a_move_brake_on_its_line_before_it_turns_aside() {
    // Stand brakes for seven frames; the move takes 24, and braking at most seven.
    const FAR: [i16; 4] = [2900, -2400, 2600, -3300];
    for frames in 8..24 {
        let mut motion = Motion::standing();
        motion.head_for_pose(FAR);
        motion.run(frames);
        motion.head_for_pose(BACK);
        assert_eq!(motion.activity(), Activity::Pose);
        let mut pace = motion.pace();
        while pace > 0 {
            motion.tick();
            pace = pace.saturating_sub(147);
            assert!(motion.is_moving() && motion.next.is_some());
            assert_eq!(motion.pace(), pace);
            // Still on the line: every servo has the same share behind it.
            let share = |n: usize| f64::from(motion.pose.0[n].0) / f64::from(FAR[n]);
            assert!((share(0) - share(3)).abs() < 0.002);
        }
        motion.tick();
        assert!(motion.next.is_none());
        motion.run(LONG_ENOUGH);
        assert_eq!(motion.pose(), &Pose(BACK.map(Sweep)));
    }
}

#[test]
fn the_gait_that_a_move_leads_to_just_goes_on_when_it_is_asked_for_again() {
    let build = || {
        let mut motion = Motion::standing();
        motion.head_for_pose(THERE);
        motion.run(LONG_ENOUGH);
        motion.start("sway");
        motion.run(4);
        assert!(motion.is_moving());
        motion
    };
    let mut asked = build();
    asked.start("sway");
    assert_same(asked, build());
}

// Cycling.

#[test]
fn the_same_gait_asked_for_again_goes_on_in_the_middle_of_its_cycle() {
    for name in GAITS.into_iter().filter(|name| *name != "stray") {
        let build = || Motion::in_gait(name, 60);
        let mut asked = build();
        asked.start(name);
        assert_same(asked, build());
    }
}

#[test]
fn another_gait_lets_the_old_one_brake_along_its_cycle_first() {
    let mut motion = Motion::in_gait("sway", 90);
    let gait = motion.robot.gait(motion.robot.id("sway"));
    motion.start("swing");
    let mut phase = motion.phase();
    for pace in [877, 730, 583, 436, 289, 142, 0] {
        motion.tick();
        phase = gait.advance(phase, pace);
        assert_eq!((motion.pace(), motion.phase()), (pace, phase));
        assert_eq!(motion.pose(), &gait.pose(motion.robot.waves(), phase));
        assert_eq!(motion.gait(), Some("swing"), "where it is heading");
    }
    motion.tick();
    assert!(motion.is_moving());
    motion.run(LONG_ENOUGH);
    assert!(motion.is_cycling());
    assert_eq!(motion.gait(), Some("swing"));
}

#[test]
fn gathering_and_losing_pace_take_whole_frames_of_a_gait() {
    for (from, to) in [(0, FULL), (FULL, 0)] {
        let (mut pace, mut sum) = (from, 0);
        while pace != to {
            pace = toward(pace, to);
            sum += pace;
        }
        let frames = f64::from(sum) / f64::from(FULL);
        assert!((frames - frames.round()).abs() < 0.02, "{frames}");
    }
}

#[test]
fn the_last_of_several_commands_counts() {
    let mut motion = Motion::in_gait("sway", 90);
    motion.start("swing");
    motion.run(2);
    motion.head_for_pose(THERE);
    motion.run(2);
    motion.start("back");
    motion.run(LONG_ENOUGH);
    assert_eq!(motion.gait(), Some("back"));
    assert!(motion.is_cycling());
}

#[test]
fn a_gait_that_is_left_and_asked_for_again_before_it_stands_still_begins_anew() {
    let mut motion = Motion::in_gait("sway", 90);
    motion.head_for_pose(THERE);
    motion.run(2);
    motion.start("sway");
    motion.run(6);
    assert!(motion.is_moving());
    motion.run(LONG_ENOUGH);
    assert_eq!(motion.gait(), Some("sway"));
}

#[test]
fn a_speed_is_gathered_and_lost_as_pace_and_rounds_to_the_nearest() {
    for percent in 10..=100u8 {
        let exact = f64::from(percent) * 1024.0 / 100.0;
        // 2622/256 is 0.02 % more than that, and then to nearest.
        let off = f64::from(pace_of(percent)) - exact * 1.000_214;
        assert!(off.abs() <= 0.501, "{percent}: {off}");
    }
    let mut motion = Motion::in_gait("sway", 90);
    motion.set_speed(50);
    assert_eq!(motion.speed(), 50);
    let mut paces = Vec::new();
    for _ in 0..5 {
        motion.tick();
        paces.push(motion.pace());
    }
    assert_eq!(paces, [877, 730, 583, 512, 512]);
    motion.set_speed(100);
    motion.run(10);
    assert_eq!(motion.pace(), FULL);
}

// stop, rest and the guard, from anywhere.

#[test]
fn stop_freezes_the_pose_in_the_next_frame_of_every_gait_and_every_move() {
    for name in GAITS {
        let mut moving = Motion::standing();
        moving.start(name);
        for frames in 0..140 {
            let mut motion = Motion::in_gait(name, frames);
            let pose = *motion.pose();
            motion.stop();
            assert_eq!(motion.phase(), 0, "a frozen robot is in no cycle");
            motion.run(20);
            assert_eq!(motion.activity(), Activity::Stop);
            assert_eq!(motion.pose(), &pose, "{name}, frame {frames}");
            assert_eq!(motion.tick(), motion.held());
        }
    }
}

#[test]
fn rest_ends_the_pulses_in_the_next_frame_of_every_gait() {
    for name in GAITS {
        for frames in 0..140 {
            let mut motion = Motion::in_gait(name, frames);
            let pose = *motion.pose();
            motion.rest();
            assert_eq!(motion.tick(), Pulses::default());
            assert_eq!((motion.pose(), motion.phase()), (&pose, 0));
        }
    }
}

#[test]
fn stop_and_rest_forget_what_was_to_come_next() {
    for ask in [Motion::<Sample>::stop, Motion::<Sample>::rest] {
        let mut motion = Motion::in_gait("sway", 90);
        motion.head_for_pose(THERE);
        motion.run(3);
        let pose = *motion.pose();
        ask(&mut motion);
        motion.run(LONG_ENOUGH);
        assert_eq!(motion.pose(), &pose);
    }
}

#[test]
fn a_stopped_gait_begins_anew_at_its_first_pose() {
    let mut motion = Motion::in_gait("sway", 90);
    motion.stop();
    motion.run(5);
    motion.start("sway");
    motion.tick();
    assert!(motion.is_moving());
    while motion.is_moving() {
        motion.tick();
    }
    let first = motion
        .robot
        .gait(motion.robot.id("sway"))
        .pose(motion.robot.waves(), 0);
    assert_eq!((motion.pose(), motion.phase()), (&first, 0));
}

/// A robot that the guard has just stopped.
fn guarded() -> Motion<Sample> {
    let mut motion = Motion::standing();
    motion.start("stray");
    for _ in 0..200 {
        motion.tick();
        if motion.hazard().is_some() {
            return motion;
        }
    }
    panic!("stray is safe");
}

#[test]
fn an_unsafe_frame_is_never_sent_and_the_last_safe_pose_is_held_with_the_reason() {
    let mut motion = Motion::standing();
    motion.start("stray");
    let mut last = *motion.pose();
    while motion.hazard().is_none() {
        last = *motion.pose();
        motion.tick();
    }
    let hazard = motion.hazard();
    assert_eq!(motion.pose(), &last);
    assert_eq!(motion.activity(), Activity::Stop);
    assert_eq!(motion.phase(), 0);
    for _ in 0..100 {
        assert_eq!(motion.tick(), last.pulses(&motion.calibration));
        assert_eq!(motion.hazard(), hazard);
    }
    // The reason is that of the frame that was not sent.
    let id = motion.robot.id("stray");
    let gait = motion.robot.gait(id);
    let reasons: Vec<Hazard> = (0..CYCLE)
        .step_by(1000)
        .filter_map(|phase| {
            let pose = gait.pose(motion.robot.waves(), phase);
            Clearance::of(&motion.robot, &pose).hazard(&motion.robot)
        })
        .collect();
    let same = |reason: &Hazard| match (reason, hazard) {
        (Hazard::Margin { margin: a, .. }, Some(Hazard::Margin { margin: b, .. })) => *a == b,
        (Hazard::Stroke { side: a, .. }, Some(Hazard::Stroke { side: b, .. })) => *a == b,
        _ => false,
    };
    assert!(reasons.iter().any(same), "{hazard:?}");
}

#[test]
fn the_reason_goes_when_the_next_motion_begins_and_not_before() {
    let mut stays = guarded();
    stays.stop();
    stays.run(20);
    assert!(stays.hazard().is_some(), "stop begins no motion");
    let mut refused = guarded();
    assert!(refused.go_to(&Pose([Sweep(13_000); 4])).is_err());
    refused.run(20);
    assert!(
        refused.hazard().is_some(),
        "nor does a pose that is refused"
    );
    let mut motion = guarded();
    motion.start("sway");
    assert!(motion.hazard().is_some());
    motion.tick();
    assert_eq!(motion.hazard(), None);
    motion.run(LONG_ENOUGH);
    assert_eq!(motion.gait(), Some("sway"));
}

#[test]
fn a_pose_that_is_refused_changes_nothing_and_says_why() {
    for name in GAITS {
        for frames in [0, 3, 20, 70] {
            let mut asked = Motion::in_gait(name, frames);
            let pose = Pose([Sweep(12_000), Sweep(0), Sweep(0), Sweep(0)]);
            let reason = Clearance::of(&asked.robot, &pose).hazard(&asked.robot);
            assert_eq!(asked.go_to(&pose).err(), reason);
            assert!(reason.is_some());
            assert_same(asked, Motion::in_gait(name, frames));
        }
    }
}

#[test]
fn frames_are_counted_from_power_on_also_while_it_rests() {
    let mut motion = Motion::new(Sample::odd());
    motion.run(30);
    motion.rest();
    motion.run(12);
    assert_eq!(motion.frames(), 42);
}

/// Something to ask of a robot.
#[derive(Clone, Copy, Debug)]
enum Ask {
    Gait(&'static str),
    Pose([i16; 4]),
    Stop,
    Rest,
    Speed(u8),
}

/// Anything, and for how many frames the robot is left with it.
fn asks() -> impl Strategy<Value = Vec<(Ask, u32)>> {
    let ask = prop_oneof![
        5 => prop::sample::select(GAITS.to_vec()).prop_map(Ask::Gait),
        3 => prop::array::uniform4(-3000i16..3000).prop_map(Ask::Pose),
        1 => prop::array::uniform4(-7000i16..7000).prop_map(Ask::Pose),
        1 => Just(Ask::Stop),
        1 => Just(Ask::Rest),
        2 => (10u8..=100).prop_map(Ask::Speed),
    ];
    prop::collection::vec((ask, 0u32..90), 1..12)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn no_frame_is_unsafe_or_faster_than_a_move_or_the_gait_may_be(
        robot in Sample::random(),
        asks in asks(),
    ) {
        let mut motion = Motion::awake(robot);
        for (ask, frames) in asks {
            match ask {
                Ask::Gait(name) => motion.start(name),
                Ask::Pose(sweeps) => {
                    let pose = Pose(sweeps.map(Sweep));
                    let hazard = Clearance::of(&motion.robot, &pose).hazard(&motion.robot);
                    prop_assert_eq!(motion.go_to(&pose).err(), hazard);
                }
                Ask::Stop => motion.stop(),
                Ask::Rest => motion.rest(),
                Ask::Speed(percent) => motion.set_speed(percent),
            }
            for _ in 0..frames {
                let (before, cycling) = (*motion.pose(), motion.is_cycling());
                let pulses = motion.tick();
                let clearance = Clearance::of(&motion.robot, motion.pose());
                prop_assert_eq!(clearance.hazard(&motion.robot), None);
                for (got, held) in pulses.0.into_iter().zip(motion.held().0) {
                    prop_assert!(got == Width(0) || got == held);
                }
                if !cycling {
                    let way = before.farthest(motion.pose());
                    prop_assert!(way <= motion.robot.slew.per_frame, "{}", way);
                }
            }
        }
    }
}
