//! Gaits in motion: the wrap of the phase, tables read backwards and in the
//! mirror, and pace.

use lizard::gait::{Gait, GaitId};
use lizard::pose::Pose;
use lizard_host_tests::robot;
use lizard_robot::STEPS_PER_DEGREE;
use lizard_robot::servo::OPPOSITE;

use crate::frames::{Robot, Wish};

/// A cycle in the core's phase.
const CYCLE: u32 = 1 << 24;
/// What the tables see of it: 65536 phases.
const STEP: u32 = 1 << 8;
/// Frames from a standing start to full pace.
const GATHERED: u32 = 80;

fn named(name: &str) -> Gait {
    let (index, _) = robot().gait(name).expect(name);
    GaitId::all().nth(index).expect(name).load()
}

fn phases() -> impl Iterator<Item = u32> {
    (0..CYCLE).step_by(STEP as usize)
}

/// The pose in the mirror: left and right exchanged, turns the other way.
fn mirrored(pose: Pose) -> Pose {
    Pose(OPPOSITE.map(|servo| -pose.0[servo]))
}

#[test]
fn the_wrap_of_the_phase_is_as_smooth_as_the_rest_of_the_cycle() {
    for (float, id) in robot().gaits.iter().zip(GaitId::all()) {
        let gait = id.load();
        // From each phase to the next, the last one to the first included.
        for phase in phases() {
            let next = (phase + STEP) % CYCLE;
            let way = gait.pose(phase).farthest(&gait.pose(next));
            // A table's 512 steps at most from one sample to the next, in 256 parts.
            assert!(way <= 3, "{} at {phase}: {way} steps", float.name);
        }
        // Speed, over one frame before the wrap and one after.
        let frame = gait.increment.unsigned_abs();
        let [before, at, after] = [CYCLE - frame, 0, frame].map(|phase| gait.pose(phase).0);
        for servo in 0..4 {
            let h = f64::from(frame) / f64::from(CYCLE);
            let [a, b, c] = [-h, 0.0, h].map(|phase| float.angles(phase)[servo]);
            let [x, y, z] = [before, at, after].map(|sweeps| f64::from(sweeps[servo]));
            let off = ((z - 2.0 * y + x) / STEPS_PER_DEGREE - (c - 2.0 * b + a)).abs();
            // Each of the three may be .1 deg off.
            assert!(off <= 0.4, "{} A{}: {off} deg", float.name, servo + 1);
        }
    }
}

#[test]
fn back_is_walk_read_backwards_to_the_bit() {
    let (walk, back) = (named("walk"), named("back"));
    assert_eq!(back.increment, -walk.increment);
    for phase in phases() {
        assert_eq!(walk.pose(phase), back.pose(phase));
    }
    // Frame by frame, what comes is what walk sends in the opposite order.
    let (mut forth, mut back_again) = (0, 0);
    let mut sent = vec![walk.pose(0)];
    for _ in 0..500 {
        forth = walk.advance(forth, 1024);
        back_again = back.advance(back_again, 1024);
        assert_eq!(forth, (CYCLE - back_again) % CYCLE);
        sent.push(back.pose(back_again));
    }
    let mut phase = back_again;
    for pose in sent.iter().rev() {
        assert_eq!(walk.pose(phase), *pose);
        phase = walk.advance(phase, 1024);
    }
}

#[test]
fn left_and_right_are_mirror_images_to_the_bit() {
    let (left, right) = (named("left"), named("right"));
    assert_eq!(left.increment, right.increment);
    for phase in phases() {
        assert_eq!(mirrored(left.pose(phase)), right.pose(phase));
    }
}

#[test]
fn the_arcs_are_mirror_images_to_the_rounding_of_a_gain() {
    let (left, right) = (named("arc-left"), named("arc-right"));
    assert_eq!(left.increment, right.increment);
    for phase in phases() {
        // Halves are rounded up on either side.
        assert!(mirrored(left.pose(phase)).farthest(&right.pose(phase)) <= 1);
    }
}

#[test]
fn gaits_that_look_the_same_from_both_sides_half_a_cycle_apart_are_so() {
    for name in ["walk", "trot"] {
        let gait = named(name);
        for phase in phases() {
            let across = gait.pose((phase + CYCLE / 2) % CYCLE);
            assert_eq!(mirrored(gait.pose(phase)), across, "{name}");
        }
    }
}

#[test]
fn every_speed_gives_its_share_of_every_gaits_pace() {
    const FRAMES: u32 = 2000;
    let mut worst = 0.0f64;
    for (float, gait) in robot().gaits.iter().zip(GaitId::all()) {
        for percent in 10..=100u8 {
            let mut robot = Robot::standing();
            for wish in [Wish::Speed(percent), Wish::Gait(gait)] {
                robot.wish(wish).expect("a gait is no pose");
            }
            robot.run(GATHERED);
            let mut gone = 0i64;
            for _ in 0..FRAMES {
                let before = robot.motion.phase();
                let _ = robot.motion.tick();
                // The short way round: less than half a cycle in a frame.
                let step = robot.motion.phase().wrapping_sub(before) << 8;
                gone += i64::from((step as i32) >> 8);
            }
            let cycles = gone as f64 / f64::from(CYCLE);
            let sign = if float.reversed { -1.0 } else { 1.0 };
            let meant = sign * f64::from(percent) / 100.0 * f64::from(FRAMES) / 50.0 / float.period;
            let off = (cycles / meant - 1.0).abs();
            worst = worst.max(off);
            assert!(off <= 0.005, "{} at {percent} %: {off}", float.name);
        }
    }
    println!("pace is off by at most {:.2} %", 100.0 * worst);
}

#[test]
fn speed_changes_smoothly_while_a_gait_goes_on() {
    // Robot::frame bounds each change of speed; here, the pace's own course.
    for gait in GaitId::all().skip(1) {
        let mut robot = Robot::standing();
        robot.wish(Wish::Gait(gait)).expect("a gait is no pose");
        robot.run(GATHERED);
        let full = f64::from(gait.load().increment).abs();
        let mut last = 1.0;
        for percent in [10, 100, 55, 10] {
            robot.wish(Wish::Speed(percent)).expect("always");
            for _ in 0..12 {
                let before = robot.motion.phase();
                robot.run(1);
                let step = robot.motion.phase().wrapping_sub(before) << 8;
                let pace = f64::from((step as i32) >> 8).abs() / full;
                assert!((pace - last).abs() <= 0.1437, "{last} and then {pace}");
                last = pace;
            }
            assert!((last - f64::from(percent) / 100.0).abs() < 0.005);
        }
    }
}

#[test]
fn a_gait_asked_for_again_just_goes_on() {
    for gait in GaitId::all() {
        let (mut asked, mut spared) = (Robot::standing(), Robot::standing());
        for frame in 0..200 {
            if frame == 0 || frame % 7 == 0 {
                asked.wish(Wish::Gait(gait)).expect("a gait is no pose");
            }
            if frame == 0 {
                spared.wish(Wish::Gait(gait)).expect("a gait is no pose");
            }
            assert_eq!(asked.frame(), spared.frame());
        }
    }
}

#[test]
fn a_gait_gathers_and_loses_its_pace_along_its_own_path() {
    // Every frame that is not part of a stroke is a pose of the gait.
    for gait in GaitId::all().skip(1) {
        let mut robot = Robot::standing();
        robot.wish(Wish::Gait(gait)).expect("a gait is no pose");
        for frame in 0..150 {
            if frame == 100 {
                robot.wish(Wish::Gait(GaitId::STAND)).expect("always");
            }
            robot.run(1);
            let phase = robot.motion.phase();
            if (70..107).contains(&frame) {
                assert_eq!(robot.pose(), gait.load().pose(phase));
            }
        }
        assert_eq!(robot.pose(), Pose::NEUTRAL);
    }
}
