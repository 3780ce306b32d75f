//! The tables against the gaits in floating point, over every phase there is.

use lizard_kinematics::Vector;
use lizard_robot::{Robot, STEPS_PER_DEGREE, Waveform};

use crate::{gait, robot, with};

#[test]
fn every_table_is_within_a_tenth_of_a_degree_at_every_phase() {
    let report = robot().report();
    println!("{report}");
    for row in &report.rows {
        assert!(row.error.max <= 0.10, "{}: {} deg", row.name, row.error.max);
        assert!(row.error.rms <= row.error.max);
    }
}

#[test]
fn the_neutral_pose_is_exact() {
    let robot = robot();
    for phase in 0..=u16::MAX {
        assert_eq!(robot.tables.sweeps(0, phase), [0; 4]);
    }
}

#[test]
fn opposite_gaits_mirror_each_other_to_the_last_step() {
    let robot = robot();
    let index = |name| robot.gait(name).expect(name).0;
    for (a, b) in [("left", "right"), ("arc-left", "arc-right")] {
        for phase in 0..=u16::MAX {
            let [a1, a2, a3, a4] = robot.tables.sweeps(index(a), phase);
            let mirrored = [-a2, -a1, -a4, -a3];
            let there = robot.tables.sweeps(index(b), phase);
            // Halves are rounded up on either side of zero.
            assert!(
                mirrored.iter().zip(there).all(|(m, t)| m.abs_diff(t) <= 1),
                "{a} at {phase}"
            );
        }
    }
}

#[test]
fn the_legs_of_walk_are_one_leg_at_four_times() {
    let robot = robot();
    let (walk, _) = robot.gait("walk").expect("walk");
    for phase in 0..=u16::MAX {
        let [a1, a2, a3, a4] = robot.tables.sweeps(walk, phase);
        let back_left = |ahead: u16| robot.tables.sweeps(walk, phase.wrapping_sub(ahead))[3];
        assert_eq!((a1, a4), (back_left(0x4000), back_left(0)));
        assert_eq!((-a3, -a2), (back_left(0x8000), back_left(0xc000)));
    }
}

#[test]
fn back_is_walk_with_the_phase_turned_round() {
    let robot = robot();
    let (walk, back) = (&robot.tables.gaits[1], &robot.tables.gaits[4]);
    assert_eq!((walk.name.as_str(), back.name.as_str()), ("walk", "back"));
    assert_eq!(
        (walk.channels, walk.increment),
        (back.channels, -back.increment)
    );
    assert_eq!(gait(robot, "back").phase(0.3), 0.7);
}

#[test]
fn a_foot_goes_forward_as_theta1_and_theta5_fall_and_theta4_and_theta8_rise() {
    let robot = robot();
    let crawl = gait(robot, "crawl");
    let (ahead, behind) = (crawl.angles(0.0), crawl.angles(0.2));
    for (servo, sign) in [-40.0, 40.0, 40.0, -40.0].into_iter().enumerate() {
        assert!(
            (ahead[servo] - behind[servo] - sign).abs() < 1e-9,
            "servo {servo}"
        );
    }
}

#[test]
fn waves_are_shared() {
    let robot = robot();
    // Two waves, two held shapes for four turns, one path for two servos.
    assert_eq!(robot.tables.waves.len(), 5);
    let robot = with("amplitude = 15.0", "amplitude = 14.0").expect("a smaller trot");
    assert_eq!(robot.tables.waves.len(), 5);
}

#[test]
fn a_robot_that_only_stands_has_a_table_of_zeros() {
    let text = crate::text();
    let cut = text.find("[gait.walk]").expect("walk");
    let robot = Robot::parse(&text[..cut]).expect("a standing robot");
    assert_eq!(robot.tables.waves, [[0; 128]]);
    assert_eq!(robot.tables.sweeps(0, 12345), [0; 4]);
}

#[test]
fn looking_moves_the_head_along_its_path_and_nothing_else() {
    let robot = robot();
    let (index, look) = robot.gait("look").expect("look");
    for phase in (0..=u16::MAX).step_by(64) {
        let u = f64::from(phase) / 65536.0;
        let angles = robot.tables.angles(look, index, phase);
        let head = robot
            .lizard
            .solve(&angles.into())
            .expect("a safe pose")
            .head
            .end_point;
        let turn = std::f64::consts::TAU * u;
        let wanted = Vector::new(10.0 * turn.sin(), 54.0 + 5.0 * (2.0 * turn).sin());
        assert!((head - wanted).length() < 0.05, "at {u}: {head:?}");
        // Inside the circle where the local conditioning index is at least .7:
        // 15.45 mm around the centre of the largest inscribed circle.
        assert!((head - Vector::new(0.0, 48.990)).length() < 15.45);
        assert_eq!(angles[2..], look.neutral[2..], "the tail stays");
    }
}

#[test]
fn gains_up_to_the_largest_share_one_table() {
    let robot = with(
        "like = \"walk\"\ngain = { LF = 0.25, LH = 0.25 }",
        "like = \"walk\"\ngain = { LF = 1.1 }",
    )
    .expect("a longer step");
    let (index, long) = robot.gait("arc-left").expect("arc-left");
    assert!(matches!(long.strides[0].waveform, Waveform::Wave { .. }));
    let channels = robot.tables.gaits[index].channels;
    assert_eq!(
        channels[0].gain, -16384,
        "the largest stride is stored as it is"
    );
    let peak = f64::from(*robot.tables.waves[0].iter().max().expect("samples")) / STEPS_PER_DEGREE;
    // The peak lies between two samples.
    assert!((peak - 22.0).abs() < 0.05, "{peak}");
}
