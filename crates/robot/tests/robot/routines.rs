//! Routines of robot.toml: valid and invalid steps, the routines' records in the flash section, and the predicted
//! displacement of a round.

use lizard_core::numbers::gaits::Step;
use lizard_robot::RoutineRow;

use super::{gait, paper, paper_text, paper_with_tables, read_cases, record_fields};

/// Returns the error message for a routine `patrol` with these lines.
fn error_with_lines(lines: &str) -> String {
    let result = paper_with_tables(&format!("[routine.patrol]\n{lines}"));
    result.map(|_| ()).expect_err(lines).to_string()
}

/// A routine with a step for a time, steps for numbers of cycles, and a step without either.
const PATROL: &str = r#"
[routine.patrol]
steps = ["stand 1 s", "walk 4", "left 6", "look 1", "rest"]
repeat = 3
"#;

#[test]
fn steps_and_rounds_are_read() {
    let robot = paper_with_tables(PATROL).expect("the routine is valid");
    let gait_index = |name: &str| gait(&robot, name).index() as u8;
    let steps = [
        (Step::FRAMES, gait_index("stand"), 50),
        (Step::CYCLES, gait_index("walk"), 4),
        (Step::CYCLES, gait_index("left"), 6),
        (Step::CYCLES, gait_index("look"), 1),
        (Step::REST, 0, 1),
    ];
    let routine = robot.routine("patrol");
    let routine = routine.expect("the file defines the routine");
    assert_eq!(record_fields(routine), steps);
    assert_eq!(routine.round_count(), Some(3));
    let read_round_count = |repeat: &str| {
        let text = format!("[routine.one]\nsteps = [\"walk 1\"]\n{repeat}");
        paper_with_tables(&text).expect(repeat).routines()[0].round_count()
    };
    assert_eq!(read_round_count(""), Some(1));
    assert_eq!(read_round_count("repeat = 999"), Some(999));
    assert_eq!(read_round_count("repeat = \"for ever\""), None);
}

#[test]
fn names_of_two_words_and_times_with_decimals_are_read() {
    let text = r#"[routine.about-face]
steps = ["arc left 2", "arc-left 2.5 s", "  arc  left   999 ", "rest 0.02 s", "stand 999 s"]"#;
    let robot = paper_with_tables(text).expect("the routine is valid");
    let arc_index = gait(&robot, "arc-left").index() as u8;
    let steps = [
        (Step::CYCLES, arc_index, 2),
        (Step::FRAMES, arc_index, 125),
        (Step::CYCLES, arc_index, 999),
        (Step::REST, 0, 1),
        (Step::FRAMES, 0, 49_950),
    ];
    let routine = robot.routine("about face");
    let routine = routine.expect("the file defines the routine");
    assert_eq!(record_fields(routine), steps);
}

#[test]
fn the_core_finds_the_routines_after_the_unchanged_gaits() {
    let robot = paper_with_tables(&format!("{PATROL}[routine.other]\nsteps = [\"right 2\"]\n"))
        .expect("both routines are valid");
    let core = robot.core();
    let gait_count = robot.gaits().len();
    assert_eq!(core.gait_count(), gait_count + 2);
    let ids: Vec<_> = lizard_core::numbers::gaits::GaitId::all(core.gait_count()).collect();
    for (index, id) in ids.iter().enumerate() {
        assert_eq!(core.gait(*id).is_routine(), index >= gait_count);
        if index < gait_count {
            assert_eq!(core.gait(*id), paper().core().gait(*id));
        }
    }
    for (id, routine) in ids[gait_count..].iter().zip(robot.routines()) {
        let name: String = core.gait_name(*id).map(char::from).collect();
        assert_eq!(name, routine.name());
        let record = core.gait(*id);
        let [_, count, rounds, _] = record.channels;
        assert_eq!(usize::from(count.offset), routine.step_records().len());
        assert_eq!(rounds.offset, routine.round_count().unwrap_or(0));
        for (number, step) in routine.step_records().iter().enumerate() {
            assert_eq!(core.step(&record, number as u16), *step);
        }
    }
    assert_ne!(core.hash(), paper().core().hash());
}

#[test]
fn eight_routines_of_sixteen_steps_fit_next_to_the_papers_gaits_and_maps() {
    let steps = "\"walk 999\", \"arc-left 3\", \"look 1\", \"stand 2 s\", ".repeat(4);
    let format_table = |n| format!("[routine.a-long-routine-{n}]\nsteps = [{steps}]\n");
    let tables: String = (0..8).map(format_table).collect();
    let robot = paper_with_tables(&tables).expect("the routines fit");
    assert!(robot.has_room_for_maps());
    let bytes = robot.section().len() - paper().section().len();
    assert_eq!(bytes, 8 * (32 + 16 * 4 + "a-long-routine-0".len()));
}

#[test]
fn an_error_is_reported_with_its_line_and_step() {
    let no_length = "needs a length: 1 to 999 cycles, for example \"walk 3\", or a time, for example \"walk 2 s\"";
    let unknown_gait = "names the gait \"wolk\", which does not exist; did you mean \"walk\"?";
    let empty_name = "names the gait \"\", which does not exist; allowed: stand, walk, trot, crawl, back, left, right, arc-left, arc-right, look";
    let no_time = "has a time that is not between 0.02 and 999 s";
    for (step, problem) in [
        ("wolk 4", unknown_gait),
        ("patrol 1", "is the routine itself, which would never end"),
        ("round 1", "is a routine; a step must be a gait"),
        ("walk", no_length),
        ("walk 0", no_length),
        ("walk 1000", no_length),
        ("walk 1.5", no_length),
        ("walk 0 s", no_time),
        ("rest nan s", no_time),
        ("", empty_name),
    ] {
        // The paper's file is followed by a blank line, the header of the routine's table, and then its first key.
        let line = paper_text().lines().count() + 3;
        let location = format!("robot.toml:{line}: routine.patrol.steps:");
        let round = "[routine.round]\nsteps = [\"patrol 1\"]";
        for (number, earlier_steps) in [(1, ""), (2, "\"walk 1\", ")] {
            let lines = format!("steps = [{earlier_steps}\"{step}\"]\n{round}");
            let expected = format!("{location} step {number}, \"{step}\", {problem}");
            assert_eq!(error_with_lines(&lines), expected);
        }
    }
    let mistakes = r#"
        steps = [] => steps has 0 steps; it must have between 1 and 99
        steps = "walk 1" => steps is the string "walk 1"; it must be an array of strings
        repeat = 1 => steps is missing; it must be an array of strings
        steps = ["walk 1"]\nrepeat = 0 => repeat is 0; it must be between 1 and 999 or "for ever"
        steps = ["walk 1"]\nrepeat = 1.5 => repeat is 1.5; it must be a whole number or "for ever"
        steps = ["walk 1"]\nrepeat = "ever" => repeat is the string "ever"; it must be a number
        steps = ["walk 1"]\nrepeat_from = 2 => repeat_from is 2; it must be between 1 and 1 (a step)
        steps = ["walk 1", "left 1"]\nrepeat_from = 1.5 => repeat_from is 1.5; it must be the number of a step
        steps = ["walk 1"]\nspeed = 5 => speed is not a known key; allowed: steps, repeat, repeat_from
    "#;
    for (lines, message) in read_cases(mistakes) {
        let actual = error_with_lines(&lines);
        let expected_end = format!(" routine.patrol.{message}");
        assert!(actual.ends_with(&expected_end), "{actual}");
        assert!(actual.starts_with("robot.toml:"), "{actual}");
    }
    let many_steps = "\"walk 1\", ".repeat(100);
    let actual = error_with_lines(&format!("steps = [{many_steps}]"));
    let expected = "has 100 steps; it must have between 1 and 99";
    assert!(actual.ends_with(expected), "{actual}");
}

#[test]
fn names_of_gaits_and_invalid_names_are_rejected() {
    let names = r#"
        walk => has the name of a gait; choose another name
        stop => is not a routine name: "stop" is a console command
        rest-now => is not a routine name: "rest" is a console command
        Patrol => is not a routine name: it must consist of lower-case letters, digits and hyphens, and begin with a letter
    "#;
    for (name, message) in read_cases(names) {
        let actual = paper_with_tables(&format!("[routine.{name}]\nsteps = [\"walk 1\"]"));
        let actual = actual.map(|_| ()).expect_err(&name).to_string();
        let expected = format!("routine.{name} {message}");
        assert!(actual.ends_with(&expected), "{actual}");
    }
}

#[test]
fn a_round_includes_the_changes_between_its_gaits() {
    let robot = paper_with_tables(
        "[routine.ahead]\nsteps = [\"walk 10\"]\n[routine.about]\nsteps = [\"left 5\", \"stand 2 s\"]\nrepeat = \"for ever\"\n[routine.gaze]\nsteps = [\"look 1\"]",
    )
    .expect("the routines are valid");
    let [ahead, about, gaze] = robot.routines() else {
        panic!("the robot has three routines");
    };
    let [walk_round, turn_round, gaze_round] =
        [ahead, about, gaze].map(|routine| RoutineRow::simulate(&robot, routine));
    let determined = |component: Option<f64>| component.expect("the movement is determined");
    let walk_forward = determined(robot.predict(gait(&robot, "walk")).forward);
    let left_turn = determined(robot.predict(gait(&robot, "left")).turn);
    // Ten cycles of one second each, and the changes from and to the neutral pose.
    let seconds = [walk_round.seconds, turn_round.seconds];
    assert!((10.0..11.0).contains(&seconds[0]), "{seconds:?}");
    let ratio = determined(walk_round.movement.forward) / (10.0 * walk_forward);
    assert!(
        (0.95..1.05).contains(&ratio),
        "the distance ratio is {ratio}"
    );
    assert!((7.0..8.0).contains(&seconds[1]), "{seconds:?}");
    let ratio = determined(turn_round.movement.turn) / (5.0 * left_turn);
    assert!((0.9..1.1).contains(&ratio), "the turn ratio is {ratio}");
    assert_eq!((turn_round.round_count, turn_round.step_count), (None, 2));
    // Two feet pull against the other two, so differences between the pads that cannot be measured decide the result.
    assert_eq!(gaze_round.movement.forward, None);
}
