//! Tests of the angles of `pose` in every notation.

use super::*;

/// Formats a `pose` line with `angle` for the servo at `index` and neutral angles for the other servos.
fn format_pose_line(index: usize, angle: &str) -> String {
    let mut words = ["138.59", "41.41", "318.59", "221.41"].map(ToString::to_string);
    words[index] = angle.to_string();
    format!("pose {}", words.join(" "))
}

/// Parses a `pose` line with `angle` for the servo at `index`; returns the angle in hundredths of a degree.
fn parse_angle(index: usize, angle: &str) -> Result<i32, LineError> {
    let line = format_pose_line(index, angle);
    match with_shared_robot(|robot| parse(line.as_bytes(), robot))? {
        Command::Order(Order::Pose(angles)) => Ok(angles[index].centideg().into()),
        command => panic!("{command:?}"),
    }
}

#[test]
fn angles_up_to_a_turn_are_parsed_to_the_hundredth_and_larger_ones_are_refused() {
    let values = (-36_100..36_100).step_by(3);
    for centideg in values.chain([-36_000, -1, 36_000, 36_001]) {
        let sign = if centideg < 0 { "-" } else { "" };
        let magnitude: i32 = i32::abs(centideg);
        let angle = format!("{sign}{}.{:02}", magnitude / 100, magnitude % 100);
        let index = magnitude as usize % 4;
        let expected = if magnitude > 36_000 {
            Err(LineError::AngleOutOfRange(Servo::at(index)))
        } else {
            Ok(centideg.rem_euclid(36_000))
        };
        assert_eq!(parse_angle(index, &angle), expected, "{angle}");
    }
}

#[test]
fn equal_angles_in_different_notations_are_parsed_alike() {
    for (notations, centideg) in [
        (["7.5", "7.50", "+7.5", "007.5", "-352.5"], 750),
        (["7", "7.", "7.0", "7.00", "+7"], 700),
        (["0", "-0", "360", "-360", "-0.00"], 0),
    ] {
        for notation in notations {
            assert_eq!(parse_angle(1, notation), Ok(centideg), "{notation}");
        }
    }
}

#[test]
fn an_invalid_or_missing_angle_is_refused() {
    for word in [
        "", "a", ".5", "-", "+", "--1", "+-1", "1e2", "138.5x", "138.591", "138,59", "1.x", "1.5.",
        "1.-5", ".", "0x10",
    ] {
        let usage_error = Err(LineError::WrongArguments(Text::PoseUsage));
        assert_eq!(parse_angle(2, word), usage_error, "{word}");
    }
}

#[test]
fn angles_are_assigned_in_servo_order_and_the_error_names_the_first_servo_out_of_range() {
    let Ok(Command::Order(Order::Pose(angles))) = parse_line("pose 138.59   41.42\t318.60 221.44")
    else {
        panic!("the line is not parsed as a pose");
    };
    assert_eq!(angles.map(Angle::centideg), [13_859, 4_142, 31_860, 22_144]);
    assert_each_refused("pose 1 361 3 -400", LineError::AngleOutOfRange(Servo::A2));
    assert_each_refused("pose 1 2 3 99999999", LineError::AngleOutOfRange(Servo::A4));
}
