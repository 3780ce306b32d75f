//! Angles typed at the console: every hundredth of a degree, in every way that
//! one may write it.

use lizard::command::{Command, Misread, parse};
use lizard::robot::SERVOS;

use crate::person::Person;
use crate::truth::degrees;

/// The neutral pose, as the issue writes it.
const HOME: [&str; 4] = ["138.59", "41.41", "318.59", "221.41"];

/// `pose` with one angle of the neutral pose replaced.
fn pose_with(servo: usize, angle: &str) -> String {
    let mut words = HOME;
    words[servo] = angle;
    format!("pose {}", words.join(" "))
}

/// Hundredths of a degree from one angle to another, the long way not taken.
fn off(a: f64, b: f64) -> f64 {
    let off = (a - b).rem_euclid(360.0);
    100.0 * off.min(360.0 - off)
}

#[test]
fn every_hundredth_of_a_degree_is_read_and_told_again() {
    for (servo, limits) in SERVOS.iter().enumerate() {
        let (least, most) = (
            degrees(limits.angle_at(limits.min_sweep)),
            degrees(limits.angle_at(limits.max_sweep)),
        );
        for centideg in 0..36_000i32 {
            let angle = f64::from(centideg) / 100.0;
            let within = (angle - least).rem_euclid(360.0) < (most - least).rem_euclid(360.0);
            let at_an_end = off(angle, least) < 0.5 || off(angle, most) < 0.5;
            let line = pose_with(servo, &format!("{angle:.2}"));
            match parse(line.as_bytes()) {
                Ok(Command::Pose(pose)) => {
                    assert!(within || at_an_end, "{line}");
                    assert_eq!(i32::from(pose.centideg(servo)), centideg, "{line}");
                }
                Err(Misread::PoseRange(n)) => {
                    assert!(!within || at_an_end, "{line}");
                    assert_eq!(usize::from(n), servo, "{line}");
                }
                other => panic!("{line}: {other:?}"),
            }
        }
    }
}

#[test]
fn an_angle_may_be_written_in_several_ways() {
    let plain = |line: &str| parse(line.as_bytes());
    for centideg in (0..36_000i32).step_by(7) {
        let (whole, rest) = (centideg / 100, centideg % 100);
        let meant = plain(&pose_with(1, &format!("{whole}.{rest:02}")));
        let turned = centideg - 36_000;
        let mut ways = vec![
            format!("+{whole}.{rest:02}"),
            format!("00{whole}.{rest:02}"),
            format!("-{}.{:02}", -turned / 100, -turned % 100),
        ];
        if rest % 10 == 0 {
            ways.push(format!("{whole}.{}", rest / 10));
        }
        if rest == 0 {
            ways.push(format!("{whole}"));
            ways.push(format!("{whole}."));
        }
        for way in ways {
            assert_eq!(plain(&pose_with(1, &way)), meant, "{way}");
        }
    }
}

#[test]
fn four_angles_go_to_the_servos_in_their_order() {
    let Ok(Command::Pose(pose)) = parse(b"pose 138.59 41.42 318.60 221.44") else {
        panic!("a pose");
    };
    let angles = [0, 1, 2, 3].map(|servo| pose.centideg(servo));
    assert_eq!(angles, [13_859, 4_142, 31_860, 22_144]);
}

#[test]
fn a_pose_that_is_accepted_is_reached_and_told_to_the_hundredth() {
    let mut person = Person::standing();
    for pose in [
        ["120.00", "60.00", "300.00", "240.00"],
        ["95.01", "18.99", "340.50", "250.25"],
        ["161.37", "85.63", "275.04", "199.96"],
        HOME,
    ] {
        let line = format!("pose {}", pose.join(" "));
        assert_eq!(person.say(&line), format!("ok {line}"));
        person.run(80);
        assert_eq!(person.status("pose"), pose.join(","));
    }
}
