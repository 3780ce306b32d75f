//! Tests of the parser for command words, gaits, number formats and errors.

use std::format;
use std::string::{String, ToString};

mod angles;

use super::*;
use crate::sample::{GAIT_NAMES, Sample};

/// Parses a line for the asymmetric sample robot.
fn parse_line(line: &str) -> Result<Command, LineError> {
    parse(line.as_bytes(), &Sample::asymmetric())
}

/// Checks that each line is refused with this error; `lines` separates them by bars.
#[track_caller]
fn assert_each_refused(lines: &str, line_error: LineError) {
    for line in lines.split('|') {
        assert_eq!(parse_line(line), Err(line_error), "{line:?}");
    }
}

/// Checks that a word is refused with this error after each of these arguments; `arguments` separates them by bars. An
/// empty argument stands for the word alone.
#[track_caller]
fn assert_arguments_refused(word: &str, arguments: &str, line_error: LineError) {
    for argument in arguments.split('|') {
        assert_each_refused(format!("{word} {argument}").trim_end(), line_error);
    }
}

/// Returns the command that starts a gait for an unlimited number of cycles.
fn gait_command(gait: GaitId) -> Command {
    Command::Order(Order::Gait(gait, 0))
}

#[test]
fn every_word_is_parsed_as_its_command() {
    for (line, command) in [
        ("help", Command::Help),
        ("?", Command::Help),
        ("status", Command::Status),
        ("cal", Command::Cal),
        ("watch 0", Command::Watch(0)),
        ("watch 10000", Command::Watch(10_000)),
    ] {
        assert_eq!(parse_line(line), Ok(command), "{line}");
    }
    let sway_left = Sample::asymmetric().gait_id("sway left");
    for (line, order) in [
        ("stop", Order::Stop),
        ("rest", Order::Rest),
        ("speed 10", Order::Speed(10)),
        ("speed 100", Order::Speed(100)),
        ("speed 0042", Order::Speed(42)),
        ("save", Order::Save),
        ("load", Order::Load),
        ("factory", Order::Factory),
        ("boot rest", Order::Boot(Boot::Rest)),
        ("boot stand", Order::Boot(Boot::Gait(GaitId::STAND))),
        ("boot sway  left", Order::Boot(Boot::Gait(sway_left))),
        ("deadman 0", Order::Deadman(0)),
        ("deadman 60000", Order::Deadman(60_000)),
    ] {
        assert_eq!(parse_line(line), Ok(Command::Order(order)), "{line}");
    }
}

/// Parses a line three times: gaits have priority over every word the first time, over the words from `cal` on the
/// second time, and over no word the third time.
fn parse_with_three_priorities(line: &str, robot: &Robot) -> [Result<Command, LineError>; 3] {
    const CAL_INDEX: usize = Word::Cal as usize;
    const WORD_COUNT: usize = Word::ALL.len();
    let line = line.as_bytes();
    [
        parse_with_priority::<0>(line, robot),
        parse_with_priority::<CAL_INDEX>(line, robot),
        parse_with_priority::<WORD_COUNT>(line, robot),
    ]
}

#[test]
fn a_yielding_word_is_a_command_unless_a_gait_has_the_same_name() {
    let robot = Sample::paper();
    for (word_index, word) in Word::ALL.iter().enumerate() {
        let (text, example) = (word.spelling(), word.example());
        let command = parse(example.as_bytes(), &robot);
        assert!(command.is_ok(), "{example}");
        let longer_name = format!("{text} on");
        let robot_with_longer_name = Sample::paper().with_gait(&longer_name);
        for robot in [&robot, &robot_with_longer_name] {
            let commands = parse_with_three_priorities(example, robot);
            assert_eq!(commands, [command; 3], "{example}");
        }

        let robot_with_both = Sample::paper().with_gait(text).with_gait(&longer_name);
        let first_yielding_indices = [0, Word::Cal as usize, Word::ALL.len()];
        let start_gait = |name: &str| Ok(gait_command(robot_with_both.gait_id(name)));
        let line_with_counts = format!("{text} 1 2");
        let count_error = Err(LineError::WrongArguments(Text::CountUsage));
        for (line, gait_result) in [
            (text, start_gait(text)),
            (&*longer_name, start_gait(&longer_name)),
            (&*line_with_counts, count_error),
        ] {
            let word_result = parse(line.as_bytes(), &robot);
            let expected_results = first_yielding_indices.map(|first_yielding_index| {
                match word_index < first_yielding_index {
                    true => word_result,
                    false => gait_result,
                }
            });
            let results = parse_with_three_priorities(line, &robot_with_both);
            assert_eq!(results, expected_results, "{line}");
        }
    }
}

/// Converts degrees to an angle as the parser does.
fn to_angle(degrees: f64) -> Angle {
    Angle::from_centideg((degrees * 100.0).round() as i32)
}

#[test]
fn every_setting_is_parsed_with_its_servo() {
    use Servo::{A1, A2, A3, A4};
    let trim = |degrees| Setting::Trim(Sweep(to_angle(degrees).0 as i16));
    let limit = |from, to| Setting::Limit(to_angle(from), to_angle(to));
    for (line, servo, setting) in [
        ("trim 1 0", A1, trim(0.0)),
        ("trim 2 -3.5", A2, trim(-3.5)),
        ("trim 3 +20", A3, trim(20.0)),
        ("trim 4 -20.00", A4, trim(-20.0)),
        ("limit 2 311.41 131.41", A2, limit(311.41, 131.41)),
        ("limit 1 -48.6 360", A1, limit(-48.6, 0.0)),
        ("dir 3 +", A3, Setting::Direction(true)),
        ("dir 3 -", A3, Setting::Direction(false)),
        ("scale 4 5", A4, Setting::Scale(500)),
        ("scale 4 20.00", A4, Setting::Scale(2000)),
        ("scale 1 10.2", A1, Setting::Scale(1020)),
    ] {
        let order = Order::Set(servo, setting);
        assert_eq!(parse_line(line), Ok(Command::Order(order)), "{line}");
    }
}

#[test]
fn a_missing_malformed_or_surplus_argument_yields_the_usage() {
    for (word, usage, arguments) in [
        ("trim", Text::TrimUsage, "|1|0 1|5 1|11 1|a 1"),
        ("trim", Text::TrimUsage, "1 x|1 1.234|1 2 3"),
        ("limit", Text::LimitUsage, "|1|1 2|1 2 3 4|9 2 3|1 a 3"),
        ("dir", Text::DirUsage, "|1|1 1|1 ++|+ 1|1 + +"),
        ("scale", Text::ScaleUsage, "|1|1 ten|1 10 10|0 10|1 10.001"),
        ("boot", Text::BootUsage, "|3|sway 1|dance|sway lef"),
        ("boot", Text::BootUsage, "rest now|stop"),
        ("deadman", Text::DeadmanUsage, "|-1|1.5|1 2"),
        ("speed", Text::SpeedUsage, "|fast|5o|50%|50.5|-50|+50"),
        ("speed", Text::SpeedUsage, "50 60|0x20|5 0"),
        ("watch", Text::WatchUsage, "|fast|5o|50%|50.5|-50|+50"),
        ("watch", Text::WatchUsage, "50 60|0x20|5 0"),
        ("pose", Text::PoseUsage, "|1|1 2 3|1 2 3 4 5|1 2 3 4 x"),
        ("pose", Text::PoseUsage, "1 999 3 4 5"),
    ] {
        assert_arguments_refused(word, arguments, LineError::WrongArguments(usage));
    }
}

#[test]
fn a_setting_or_a_speed_out_of_range_yields_the_range() {
    for (word, range, arguments) in [
        ("trim", Text::TrimRange, "1 20.01|2 -20.01|3 360|4 655.36"),
        ("trim", Text::TrimRange, "1 99999"),
        ("limit", Text::LimitRange, "1 -360.01 0|1 0 361|1 0 99999"),
        ("scale", Text::ScaleRange, "1 4.99|1 20.01|1 0|1 -10"),
        ("scale", Text::ScaleRange, "1 999999"),
        ("deadman", Text::DeadmanRange, "60001|65535|999999"),
        ("speed", Text::SpeedRange, "99999999999999999999"),
    ] {
        assert_arguments_refused(word, arguments, LineError::OutOfRange(range));
    }
}

#[test]
fn any_blanks_may_separate_the_words_of_a_gait() {
    let robot = Sample::asymmetric();
    for name in GAIT_NAMES {
        let command = Ok(gait_command(robot.gait_id(name)));
        for blank in [" ", "   ", "\t", " \t "] {
            let line = name.replace(' ', blank);
            assert_eq!(parse(line.as_bytes(), &robot), command, "{line:?}");
        }
    }
}

#[test]
fn a_line_that_only_resembles_the_name_of_a_gait_is_an_error() {
    // `sway` is a gait, and so is `sway left`.
    let count_error = LineError::WrongArguments(Text::CountUsage);
    let lines = "sway lef|sway leftt|sway left now|sway sway|stand up";
    assert_each_refused(lines, count_error);
    let lines = "swayleft|sway-left|sways|swa|left|s";
    assert_each_refused(lines, LineError::UnknownCommand);
}

#[test]
fn the_first_words_of_a_gaits_name_yield_an_incomplete_name() {
    let robot = Sample::asymmetric().with_gait("arc to left");
    let parse_for_robot = |line: &str| parse(line.as_bytes(), &robot);
    assert_eq!(parse_for_robot("arc"), Err(LineError::IncompleteName));
    assert_eq!(parse_for_robot("arc to"), Err(LineError::IncompleteName));
    let command = Ok(gait_command(robot.gait_id("arc to left")));
    assert_eq!(parse_for_robot("arc  to\tleft"), command);
    assert_eq!(parse_for_robot("arc t"), Err(LineError::UnknownCommand));
    assert_eq!(parse_for_robot("arc left"), Err(LineError::UnknownCommand));
    let count_error = Err(LineError::WrongArguments(Text::CountUsage));
    assert_eq!(parse_for_robot("arc to left too"), count_error);
}

#[test]
fn every_gait_accepts_exactly_the_counts_from_1_to_999() {
    let robot = Sample::asymmetric();
    for name in GAIT_NAMES {
        let parse_count = |count: &str| parse(format!("{name} {count}").as_bytes(), &robot);
        for count in (0..=70_000u32).chain([655_360, 655_361, 99_999_999]) {
            let order = Order::Gait(robot.gait_id(name), count as u16);
            let expected = match count {
                1..=999 => Ok(Command::Order(order)),
                _ => Err(LineError::WrongArguments(Text::CountUsage)),
            };
            assert_eq!(parse_count(&count.to_string()), expected, "{name} {count}");
        }
        for count in ["-1", "+1", "1.0", "1,", "x", "1 1", "0x1", "1s"] {
            let count_error = Err(LineError::WrongArguments(Text::CountUsage));
            assert_eq!(parse_count(count), count_error, "{name} {count}");
        }
    }
}

#[test]
fn a_gait_named_step_2_has_priority_over_two_cycles_of_a_gait_named_step() {
    let robot = Sample::paper().with_gait("step 2").with_gait("step");
    let parse_for_robot = |line: &str| parse(line.as_bytes(), &robot);
    let counted_gait = |name, cycles| Ok(Command::Order(Order::Gait(robot.gait_id(name), cycles)));
    assert_eq!(parse_for_robot("step  2"), counted_gait("step 2", 0));
    assert_eq!(parse_for_robot("step 02"), counted_gait("step", 2));
    assert_eq!(parse_for_robot("step 3"), counted_gait("step", 3));
    assert_eq!(parse_for_robot("step 2 3"), counted_gait("step 2", 3));
}

#[test]
fn a_line_that_begins_with_no_word_and_no_gait_is_an_unknown_command() {
    let lines = "dance|halt|??|-|speed10|watch0|pose1|stop.|\0|\u{e9}|12|helpp|hel|statu";
    assert_each_refused(lines, LineError::UnknownCommand);
}

#[test]
fn a_command_without_arguments_refuses_an_argument() {
    let lines = "stop now|rest 5|help me|? ?|status all|cal 1|save it|load 1|factory reset";
    assert_each_refused(lines, LineError::UnexpectedArgument);
}

#[test]
fn speed_and_watch_accept_exactly_the_numbers_in_their_range() {
    for number in (0..=70_000).chain([655_350, 99_999_999]) {
        let expected_speed = match number {
            10..=100 => Ok(Command::Order(Order::Speed(number as u8))),
            _ => Err(LineError::OutOfRange(Text::SpeedRange)),
        };
        assert_eq!(parse_with_number("speed", number), expected_speed);
        let expected_watch = match number {
            0..=10_000 => Ok(Command::Watch(number as u16)),
            _ => Err(LineError::OutOfRange(Text::WatchRange)),
        };
        assert_eq!(parse_with_number("watch", number), expected_watch);
    }
}

fn parse_with_number(word: &str, number: u32) -> Result<Command, LineError> {
    with_shared_robot(|robot| parse(format!("{word} {number}").as_bytes(), robot))
}

/// Calls a function with a shared robot, because building a robot takes longer than parsing a line.
fn with_shared_robot<T>(call: impl FnOnce(&Sample) -> T) -> T {
    std::thread_local!(static ROBOT: Sample = Sample::asymmetric());
    ROBOT.with(call)
}

#[test]
fn numbers_from_65530_saturate_instead_of_wrapping() {
    for (digits, value) in [
        ("65519", 65_519),
        ("65529", 65_529),
        ("65530", u16::MAX),
        ("65536", u16::MAX),
        ("70000", u16::MAX),
        ("655360", u16::MAX),
    ] {
        let parsed = parse_number(digits.as_bytes(), Syntax::Whole);
        assert_eq!(parsed, Some((value, false)));
    }
    assert_eq!(parse_number(b"12x", Syntax::Whole), None);
    let parsed = parse_number(b"655.36", Syntax::Hundredths);
    assert_eq!(parsed, Some((u16::MAX, false)));
}
