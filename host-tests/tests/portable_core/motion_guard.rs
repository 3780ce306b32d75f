//! What happens when the way leads through a pose that is not safe: between two
//! safe poses there may be one that is not.

use lizard::clearance::Clearance;
use lizard::gait::GaitId;
use lizard::motion::Activity;
use lizard::pose::Pose;
use lizard_kinematics::Violation;

use crate::frames::{Robot, Wish};
use crate::person::Person;
use crate::truth::{Numbers, TRIES, Verdict, angles, sine};

/// Longer than the longest stroke.
const LONG_ENOUGH: u32 = 60;

/// Pairs of safe poses whose straight connection is unsafe, by floating point.
/// They are rare: the safe poses of a pair of cranks are nearly a convex set,
/// hollow only where an elbow is almost stretched. So that is where to look.
fn crossings(count: usize) -> Vec<[Pose; 2]> {
    let mut numbers = Numbers::new(7);
    let mut found = Vec::new();
    for n in 0..100 * count {
        if found.len() == count {
            break;
        }
        let cranks = [[0, 1], [2, 3]][n % 2];
        let [from, to] = [(); 2].map(|()| stretched(&mut numbers, cranks));
        let between = |share: f64| -> [f64; 4] {
            let (from, to) = (angles(&from), angles(&to));
            std::array::from_fn(|n| from[n] + share * (to[n] - from[n]))
        };
        if (1..50).any(|n| Verdict::of(between(f64::from(n) / 50.0)) == Verdict::Unsafe) {
            found.push([from, to]);
        }
    }
    assert_eq!(found.len(), count, "so few hollows");
    found
}

/// A safe pose with an elbow almost stretched and the other two cranks at rest.
fn stretched(numbers: &mut Numbers, cranks: [usize; 2]) -> Pose {
    for _ in 0..TRIES {
        let mut pose = Pose::NEUTRAL;
        let any = numbers.pose();
        for servo in cranks {
            pose.0[servo] = any.0[servo];
        }
        // An angle that wraps would make the straight way another one.
        let within = angles(&pose)[1] < 180.0;
        let core = Clearance::of(&pose);
        let elbow = core.margins[2..6].iter().min().expect("four");
        if within && core.hazard().is_none() && sine(*elbow) < 0.32 {
            return pose;
        }
    }
    panic!("no elbow is ever almost stretched");
}

/// A robot at the first pose of a pair, if the way there is clear.
fn robot_at(pose: Pose) -> Option<Robot> {
    let mut robot = Robot::standing();
    robot.wish(Wish::Pose(pose)).expect("a safe pose");
    robot.run(LONG_ENOUGH);
    (robot.pose() == pose).then_some(robot)
}

#[test]
fn the_last_safe_pose_is_held_where_the_straight_way_is_unsafe() {
    let mut trips = 0;
    for [from, to] in crossings(300) {
        let Some(mut robot) = robot_at(from) else {
            continue;
        };
        robot.wish(Wish::Pose(to)).expect("a safe pose");
        let mut last = robot.pose();
        for _ in 0..LONG_ENOUGH {
            robot.run(1); // which checks that every frame is safe
            let pose = robot.pose();
            // Nothing is clamped: the pose is on the straight way, all servos
            // having gone the same share of it.
            assert_on_the_way(from, to, pose);
            if robot.motion.hazard().is_some() {
                assert_eq!(pose, last);
            }
            last = pose;
        }
        // A step of a fast stroke may leap over a narrow hazard.
        let Some(hazard) = robot.motion.hazard() else {
            assert_eq!(robot.pose(), to);
            continue;
        };
        trips += 1;
        assert_eq!(robot.motion.activity(), Activity::Stop);
        // The reason is that of the pose that would have been next.
        assert!(hazard_ahead(from, to, robot.pose(), hazard.check));
        // There it stays, and from there it can be told to go on.
        robot.run(20);
        assert_eq!(robot.pose(), last);
        robot.wish(Wish::Pose(last)).expect("a safe pose");
        robot.run(2);
        assert!(robot.motion.hazard().is_none(), "a new motion begins");
    }
    println!("{trips} strokes were stopped on their way");
    assert!(trips >= 100);
}

fn assert_on_the_way(from: Pose, to: Pose, pose: Pose) {
    let way = |n: usize| f64::from(to.0[n]) - f64::from(from.0[n]);
    let gone = |n: usize| f64::from(pose.0[n]) - f64::from(from.0[n]);
    let farthest = (0..4)
        .max_by(|a, b| way(*a).abs().total_cmp(&way(*b).abs()))
        .expect("four");
    let share = gone(farthest) / way(farthest);
    for n in 0..4 {
        assert!(
            (gone(n) - share * way(n)).abs() <= 4.0,
            "{from:?} {to:?} {pose:?}"
        );
    }
}

/// True if the condition is broken somewhere on the way that is left.
fn hazard_ahead(from: Pose, to: Pose, held: Pose, check: lizard::hazard::Check) -> bool {
    (0..=2000).any(|n| {
        let share = f64::from(n) / 2000.0;
        let pose = Pose(std::array::from_fn(|n| {
            let (from, to) = (f64::from(from.0[n]), f64::from(to.0[n]));
            (from + share * (to - from)).round() as i16
        }));
        let beyond = held.farthest(&from) <= pose.farthest(&from) + 1;
        beyond
            && Clearance::of(&pose)
                .hazard()
                .is_some_and(|h| h.check == check)
    })
}

#[test]
fn the_console_reports_a_hold_once_and_status_keeps_saying_so() {
    let mut reported = 0;
    for [from, to] in crossings(60) {
        if robot_at(from).is_none() {
            continue;
        }
        let mut person = Person::standing();
        let pose = |pose: Pose| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|n| f64::from(pose.centideg(n)) / 100.0);
            format!("pose {a:.2} {b:.2} {c:.2} {d:.2}")
        };
        if !person.say(&pose(from)).starts_with("ok") {
            continue; // a hundredth of a degree beyond the limit
        }
        person.run(LONG_ENOUGH);
        if !person.say(&pose(to)).starts_with("ok") {
            continue;
        }
        let news = person.run(LONG_ENOUGH);
        if person.status("guard") == "clear" {
            continue;
        }
        reported += 1;
        assert_eq!(news.len(), 1, "{news:?}");
        let reason = news[0]
            .strip_prefix("# held in the last safe pose: ")
            .expect("the reason");
        assert!(
            reason.contains("margin of") || reason.contains("slider is at"),
            "{reason}"
        );
        assert_eq!(person.status("guard"), "held");
        assert_eq!(person.status("gait"), "stop");
        assert!(person.run(100).is_empty(), "said once");
        // Until the next motion begins.
        assert!(person.say("stand").starts_with("ok"));
        assert_eq!(person.status("guard"), "held");
        person.run(1);
        if person.status("gait") == "stand" {
            assert_eq!(person.status("guard"), "clear");
        }
    }
    println!("{reported} holds were reported");
    assert!(reported >= 10);
}

#[test]
fn no_gait_from_any_other_at_any_time_meets_the_guard() {
    // They all lie in a convex box of safe poses.
    for from in GaitId::all() {
        for to in GaitId::all() {
            for frames in (60..112).step_by(3) {
                let mut robot = Robot::standing();
                for gait in [from, to] {
                    robot.wish(Wish::Gait(gait)).expect("a gait is no pose");
                    robot.run(frames);
                }
                let hazard = robot.motion.hazard();
                assert!(hazard.is_none(), "{from:?} to {to:?}: {hazard:?}");
                assert_eq!(robot.motion.activity(), Activity::Gait(to));
            }
        }
    }
}

#[test]
fn the_box_that_is_safe_by_construction_is_safe_everywhere() {
    // theta1 and the tail's mirror of theta5 in 94..162, theta4 and theta8's in
    // 18..86: every margin is at least .3 there.
    let robot = lizard_host_tests::robot();
    for a in (94..=162).step_by(4) {
        for b in (18..=86).step_by(4) {
            for c in (18..=86).step_by(4) {
                for d in (94..=162).step_by(4) {
                    let degrees = [a, b, 360 - c, 360 - d];
                    let pose = Pose::at_centideg(&degrees.map(|degrees| 100 * degrees))
                        .expect("within the travel");
                    let solution = robot
                        .lizard
                        .solve(&degrees.map(f64::from).into())
                        .expect("closes");
                    let all: Vec<Violation> = robot.limits.violations(&solution).collect();
                    assert!(all.is_empty(), "{degrees:?}: {}", all[0]);
                    let hazard = Clearance::of(&pose).hazard();
                    assert!(hazard.is_none(), "{degrees:?}: {hazard:?}");
                }
            }
        }
    }
}
