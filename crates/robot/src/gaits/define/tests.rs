//! Tests of valid and invalid gait definitions in robot.toml.

use crate::robot::STAND;
use crate::testing::{assert_contains, assert_starts_with, robot, text_before_gaits};
use crate::{Error, Robot};
use lizard_core::console::word::Word;
use lizard_core::numbers::section::REGION_BYTES;
use lizard_kinematics::{End, Vector};

/// Parses the paper's robot with these gaits instead of its own.
fn paper_with_gaits(gaits: &str) -> Result<Robot, Error> {
    Robot::parse(&(text_before_gaits("paper") + gaits))
}

/// Returns the error message for the paper's robot with these gaits.
fn error_with_gaits(gaits: &str) -> String {
    paper_with_gaits(gaits).expect_err(gaits).to_string()
}

/// A gait with its own waveform.
const WALK: &str = "[gait.walk]\nperiod = 1.0\nwaveform = \"wave\"\nduty = 0.75\namplitude = 10.0\nstart = { LH = 0.0, LF = 0.25, RH = 0.5, RF = 0.75 }\n";

#[test]
fn a_gait_reversed_twice_runs_forward() {
    let robot = robot("own-gaits");
    let is_reversed = |name| robot.gait(name).expect(name).is_reversed();
    for name in ["stroll", "stroll-on", "veer-right"] {
        assert!(!is_reversed(name), "{name}");
    }
    for name in ["stroll-back", "veer-right-back", "veer-left-back"] {
        assert!(is_reversed(name), "{name}");
    }
    for (name, seconds, phase, period) in [
        ("stroll-on", 0.32, 0.25, 1.28),
        ("stroll-back", 0.3, 0.75, 1.2),
    ] {
        let gait = robot.gait(name).expect(name);
        assert_eq!((gait.phase_at(seconds), gait.period()), (phase, period));
    }
}

#[test]
fn a_mirrored_gait_swaps_left_and_right_before_the_gains_apply() {
    let robot = robot("own-gaits");
    let (starts, mirrored_starts) = ([0.0, 0.5, 0.25, 0.75], [0.5, 0.0, 0.75, 0.25]);
    for (name, amplitudes, starts) in [
        ("stroll", [16.0; 4], starts),
        ("veer-left", [8.0, 16.0, 16.0, 8.0], starts),
        ("veer-right", [16.0, 8.0, 8.0, 16.0], mirrored_starts),
        ("veer-left-back", [8.0, 19.2, 16.0, 8.0], starts),
    ] {
        let strides = robot.gait(name).expect(name).strides().each_ref();
        assert_eq!(strides.map(|stride| stride.amplitude), amplitudes, "{name}");
        assert_eq!(strides.map(|stride| stride.start), starts, "{name}");
    }
}

#[test]
fn each_leg_swings_at_its_position_in_the_order() {
    let robot = robot("own-gaits");
    let creep = robot.gait("creep").expect("the robot has the gait creep");
    // All legs move back in the first fifth; then RF, LH, LF and RH swing forward, each in one of the next fifths.
    for (leg, fifth) in [(1, 1), (3, 2), (0, 3), (2, 4)] {
        let sweep_at = |phase: f64| creep.sweeps(phase)[leg];
        assert!((sweep_at(0.2 * f64::from(fifth)) + 17.5).abs() < 1e-9);
        assert!((sweep_at(0.2 * f64::from(fifth + 1)) - 17.5).abs() < 1e-9);
    }
}

#[test]
fn a_path_moves_only_the_end_that_it_names() {
    let robot = robot("own-gaits");
    let neutral: [f64; 4] = robot.neutral_pose().into();
    let wag = robot.gait("wag").expect("the robot has the gait wag");
    let nod = robot.gait("nod").expect("the robot has the gait nod");
    for i in 0..64 {
        let phase = f64::from(i) / 64.0;
        let cycle_angle = std::f64::consts::TAU * phase;
        let tail_point = Vector::new(
            9.0 * cycle_angle.sin(),
            54.0 + 3.0 * (2.0 * cycle_angle + 0.5 * std::f64::consts::PI).sin(),
        );
        let head_point = Vector::new(
            4.0 + 2.0 * cycle_angle.sin(),
            56.0 + 5.0 * cycle_angle.sin(),
        );
        for (gait, end, expected, still_servos) in [
            (wag, End::Tail, tail_point, 0..2),
            (nod, End::Head, head_point, 2..4),
        ] {
            let solution = robot.lizard().solve(&gait.pose(phase));
            let solution = solution.expect("a checked gait closes its loops");
            let point = solution.end(end).end_point;
            assert!((point - expected).length() < 1e-9, "{end}: {point:?}");
            let angles = &gait.angles(phase)[still_servos.clone()];
            assert_eq!(angles, &neutral[still_servos]);
        }
    }
}

#[test]
fn a_path_out_of_reach_is_rejected_at_either_end_and_on_either_side() {
    for end in ["head", "tail"] {
        for [x, y] in [[45.0, 60.0], [-45.0, 60.0], [0.0, 82.0]] {
            let gait =
                format!("[gait.point]\nperiod = 4.0\n[gait.point.{end}]\ncentre = [{x:?}, {y:?}]");
            let message = error_with_gaits(&format!("{STAND}{gait}\n"));
            let expected = format!(
                "in \"point\" the {end} would not reach its path: the point ({x:.2}, {y:.2}) mm at phase 0.0000 is out of reach of the {end} ("
            );
            assert_starts_with(&message, &expected);
        }
    }
}

#[test]
fn a_gait_name_may_begin_with_a_console_word_unless_it_is_reserved() {
    for word in Word::ALL.iter().filter(|word| **word != Word::QuestionMark) {
        for name in [
            word.spelling().to_owned(),
            format!("{}-on", word.spelling()),
        ] {
            let gaits = format!("{STAND}{}", WALK.replace("walk", &name));
            let is_accepted = paper_with_gaits(&gaits).is_ok();
            assert_eq!(is_accepted, !word.is_reserved(), "{name}");
        }
    }
}

#[test]
fn a_name_may_have_48_characters_but_not_49() {
    let gaits_with_name_length =
        |length: usize| format!("{STAND}{}", WALK.replace("walk", &"w".repeat(length)));
    let robot = paper_with_gaits(&gaits_with_name_length(48)).expect("48 characters are allowed");
    assert_eq!(robot.gaits()[1].name().len(), 48);
    let message = error_with_gaits(&gaits_with_name_length(49));
    assert_contains(&message, "it has 49 characters; at most 48 are allowed");
}

/// The end of the message about a robot whose gaits do not fit into the flash section.
const NO_ROOM_ADVICE: &str = "remove gaits, starting with those whose waveform no other gait uses";

#[test]
fn a_robot_may_have_as_many_gaits_as_its_section_has_room_for() {
    let gaits_toml = |count: usize| {
        let derive_gait = |i| format!("[gait.walk{i}]\nlike = \"walk\"\n");
        let derived_gaits: String = (2..count).map(derive_gait).collect();
        format!("{STAND}{WALK}{derived_gaits}")
    };
    let robot_with_80 = paper_with_gaits(&gaits_toml(80)).expect("80 gaits fit");
    assert_eq!(robot_with_80.gaits().len(), 80);
    let [walk, walk79] = ["walk", "walk79"].map(|name| robot_with_80.gait(name).expect(name));
    assert_eq!(walk79.index(), 79);
    assert_eq!(walk79.table_sweeps(99), walk.table_sweeps(99));
    // More gaits leave no room for the maps of certified cells but are accepted until the section is full.
    for count in 80..255 {
        match paper_with_gaits(&gaits_toml(count)) {
            Ok(robot) => assert!(robot.section().len() <= usize::from(REGION_BYTES)),
            Err(error) => {
                assert!(count > 85, "only {count} gaits fit");
                assert!(error.to_string().ends_with(NO_ROOM_ADVICE), "{error}");
                break;
            }
        }
    }
    let too_many = "gait has 256 gaits; the firmware supports at most 255";
    for (count, problem) in [(255, NO_ROOM_ADVICE), (256, too_many)] {
        let message = error_with_gaits(&gaits_toml(count));
        assert!(message.ends_with(problem), "{message}");
    }
}

#[test]
fn more_waveforms_than_the_section_has_room_for_are_rejected() {
    // The walk needs one waveform; each nod follows its own path, which takes two waveforms.
    let gaits_toml = |count: usize| {
        let make_nod = |i: usize| {
            let x = 0.03 * (i as f64 + 1.0);
            format!(
                "[gait.nod{i}]\nperiod = 4.0\n[gait.nod{i}.head]\ncentre = [{x:.2}, 55.0]\nx = [{{ k = 1, amplitude = 3.0 }}]\ny = [{{ k = 2, amplitude = {x:.2}, shift = 0.1 }}]\n"
            )
        };
        let nods: String = (0..count).map(make_nod).collect();
        format!("{STAND}{WALK}{nods}")
    };
    let robot = paper_with_gaits(&gaits_toml(6)).expect("13 waveforms fit");
    assert_eq!(robot.firmware().waves().len(), 13);
    for count in [14, 127] {
        let message = error_with_gaits(&gaits_toml(count));
        assert!(message.ends_with(NO_ROOM_ADVICE), "{message}");
    }
    let expected =
        "gait.nod127 needs more than the 255 waveforms that the firmware supports; gaits";
    assert_contains(&error_with_gaits(&gaits_toml(128)), expected);
}

#[test]
fn an_error_in_an_added_gait_is_reported_with_its_line_in_the_added_text() {
    let paper = paper_with_gaits(STAND).expect("the robot with stand alone is valid");
    let misspelled = "[gait.a]\nperiod = 1.0\nwaveform = \"wav\"\n";
    let duplicate = "\n[gait.a]\nperiod = 1.0\nperiod = 2.0\n";
    for (table, line, phrase) in [
        (misspelled, 3, "gait.a.waveform"),
        (duplicate, 4, "first on line 3"),
    ] {
        let error = paper.with_gait(table).expect_err(table);
        assert_eq!(error.line, Some(line), "{error}");
        assert_contains(&error.to_string(), phrase);
    }
}
