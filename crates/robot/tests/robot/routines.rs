//! Routines of robot.toml: valid and invalid steps, the routines' records in the section, and the predicted movement
//! of a round.

use lizard_core::numbers::gaits::Step;
use lizard_robot::Round;

use super::{gait, paper, paper_text, paper_with_tables};

/// Returns the error message for a routine `patrol` with these lines.
fn refusal_of(lines: &str) -> String {
    let result = paper_with_tables(&format!("[routine.patrol]\n{lines}"));
    result.map(|_| ()).expect_err(lines).to_string()
}

/// A routine with steps of a given time, of a number of cycles, and without either.
const PATROL: &str = r#"
[routine.patrol]
steps = ["stand 1 s", "walk 4", "left 6", "look 1", "rest"]
repeat = 3
"#;

#[test]
fn the_steps_and_the_repeats_of_a_routine_are_read() {
    let robot = paper_with_tables(PATROL).expect("the routine is valid");
    let routine = robot
        .routine("patrol")
        .expect("the file defines the routine");
    let gait_index_of = |name: &str| robot.gait(name).expect(name).index() as u8;
    let steps = [
        (Step::FRAMES, gait_index_of("stand"), 50),
        (Step::CYCLES, gait_index_of("walk"), 4),
        (Step::CYCLES, gait_index_of("left"), 6),
        (Step::CYCLES, gait_index_of("look"), 1),
        (Step::REST, 0, 1),
    ]
    .map(|(kind, gait, count)| Step { kind, gait, count });
    assert_eq!(routine.step_records(), steps);
    assert_eq!(routine.rounds(), Some(3));
    let rounds_of = |repeat: &str| {
        let text = format!("[routine.one]\nsteps = [\"walk 1\"]\n{repeat}");
        paper_with_tables(&text).expect(repeat).routines()[0].rounds()
    };
    assert_eq!(rounds_of(""), Some(1));
    assert_eq!(rounds_of("repeat = 999"), Some(999));
    assert_eq!(rounds_of("repeat = \"for ever\""), None);
}

#[test]
fn names_of_two_words_and_times_with_decimals_are_read() {
    let text = r#"[routine.about-face]
steps = ["arc left 2", "arc-left 2.5 s", "  arc  left   999 ", "rest 0.02 s", "stand 999 s"]"#;
    let robot = paper_with_tables(text).expect("the routine is valid");
    let arc_index = gait(&robot, "arc-left").index() as u8;
    let routine = robot.routine("about face");
    let steps = routine
        .expect("the file defines the routine")
        .step_records();
    let fields_of = |step: &Step| (step.kind, step.gait, step.count);
    let step_fields: Vec<_> = steps.iter().map(fields_of).collect();
    let expected = [
        (Step::CYCLES, arc_index, 2),
        (Step::FRAMES, arc_index, 125),
        (Step::CYCLES, arc_index, 999),
        (Step::REST, 0, 1),
        (Step::FRAMES, 0, 49_950),
    ];
    assert_eq!(step_fields, expected);
}

#[test]
fn the_core_finds_the_routines_of_the_file_after_the_unchanged_gaits() {
    let robot = paper_with_tables(&format!("{PATROL}[routine.other]\nsteps = [\"right 2\"]\n"))
        .expect("both routines are valid");
    let core = robot.core();
    let gait_count = robot.gaits().len();
    assert_eq!(core.gait_count(), gait_count + 2);
    let ids: Vec<_> = lizard_core::numbers::gaits::GaitId::all(core.gait_count()).collect();
    for (index, id) in ids.iter().enumerate() {
        assert_eq!(core.gait(*id).is_routine(), index >= gait_count);
        if index < gait_count {
            let paper_gait = paper().core().gait(*id);
            assert_eq!(core.gait(*id), paper_gait);
        }
    }
    for (id, routine) in ids[gait_count..].iter().zip(robot.routines()) {
        let name: String = core.gait_name(*id).map(char::from).collect();
        assert_eq!(name, routine.name());
        let record = core.gait(*id);
        let [_, count, rounds, _] = record.channels;
        assert_eq!(usize::from(count.offset), routine.step_records().len());
        assert_eq!(rounds.offset, routine.rounds().unwrap_or(0));
        for (number, step) in routine.step_records().iter().enumerate() {
            assert_eq!(core.step(&record, number as u16), *step);
        }
    }
    assert_ne!(core.hash(), paper().core().hash());
}

#[test]
fn eight_routines_of_sixteen_steps_fit_beside_the_papers_gaits_and_their_maps() {
    let steps = "\"walk 999\", \"arc-left 3\", \"look 1\", \"stand 2 s\", ".repeat(4);
    let tables: String = (0..8)
        .map(|n| format!("[routine.a-long-routine-{n}]\nsteps = [{steps}]\n"))
        .collect();
    let robot = paper_with_tables(&tables).expect("the routines fit");
    assert!(robot.has_room_for_maps());
    let bytes = robot.section().len() - paper().section().len();
    assert_eq!(bytes, 8 * (32 + 16 * 4 + "a-long-routine-0".len()));
}

#[test]
fn a_mistake_is_reported_with_its_line_and_its_step() {
    let no_length = "must say how long: cycles, as \"walk 3\", a whole number of 1 to 999, or a time, as \"walk 2 s\"";
    let no_time = "has a time that is not within 0.02 to 999 s";
    for (step, problem) in [
        (
            "wolk 4",
            "names the gait \"wolk\", which does not exist; did you mean \"walk\"?",
        ),
        ("patrol 1", "is the routine itself, which would never end"),
        ("round 1", "is a routine; a step is a gait"),
        ("walk", no_length),
        ("walk 0", no_length),
        ("walk 1000", no_length),
        ("walk 1.5", no_length),
        ("walk 0 s", no_time),
        ("rest nan s", no_time),
        (
            "",
            "names the gait \"\", which does not exist; allowed are stand, walk, trot, crawl, back, left, right, arc-left, arc-right, look",
        ),
    ] {
        // The paper's file is followed by a blank line, the header of the routine's table, and then its first key.
        let line = paper_text().lines().count() + 3;
        let location = format!("robot.toml:{line}: routine.patrol.steps:");
        let round = "[routine.round]\nsteps = [\"patrol 1\"]";
        for (number, earlier_steps) in [(1, ""), (2, "\"walk 1\", ")] {
            let lines = format!("steps = [{earlier_steps}\"{step}\"]\n{round}");
            let expected = format!("{location} step {number}, \"{step}\", {problem}");
            assert_eq!(refusal_of(&lines), expected);
        }
    }
    for (lines, message) in [
        (
            "steps = []",
            "routine.patrol.steps has 0 steps; it must have 1 to 99",
        ),
        (
            "steps = \"walk 1\"",
            "routine.patrol.steps is the string \"walk 1\"; it must be an array of strings",
        ),
        (
            "repeat = 1",
            "routine.patrol.steps is missing; it must be an array of strings",
        ),
        (
            "steps = [\"walk 1\"]\nrepeat = 0",
            "routine.patrol.repeat is 0; it must be within 1 to 999 or \"for ever\"",
        ),
        (
            "steps = [\"walk 1\"]\nrepeat = 1.5",
            "routine.patrol.repeat is 1.5; it must be a whole number or \"for ever\"",
        ),
        (
            "steps = [\"walk 1\"]\nrepeat = \"ever\"",
            "routine.patrol.repeat is the string \"ever\"; it must be a number",
        ),
        (
            "steps = [\"walk 1\"]\nrepeat_from = 2",
            "routine.patrol.repeat_from is 2; it must be within 1 to 1 (a step)",
        ),
        (
            "steps = [\"walk 1\", \"left 1\"]\nrepeat_from = 1.5",
            "routine.patrol.repeat_from is 1.5; it must be the number of a step",
        ),
        (
            "steps = [\"walk 1\"]\nspeed = 5",
            "routine.patrol.speed is not a known key; allowed are steps, repeat, repeat_from",
        ),
    ] {
        let actual = refusal_of(lines);
        assert!(actual.ends_with(message), "{actual}");
        assert!(actual.starts_with("robot.toml:"), "{actual}");
    }
    let many_steps = "\"walk 1\", ".repeat(100);
    let actual = refusal_of(&format!("steps = [{many_steps}]"));
    assert!(
        actual.ends_with("has 100 steps; it must have 1 to 99"),
        "{actual}"
    );
}

#[test]
fn the_name_of_a_gait_or_an_invalid_name_is_refused() {
    for (name, message) in [
        (
            "walk",
            "routine.walk has the name of a gait; give it another one",
        ),
        (
            "stop",
            "routine.stop is not a routine name: \"stop\" is a command of the console",
        ),
        (
            "rest-now",
            "routine.rest-now is not a routine name: \"rest\" is a command of the console",
        ),
        (
            "Patrol",
            "routine.Patrol is not a routine name: it must be lower-case letters, digits and dashes, a letter first",
        ),
    ] {
        let actual = paper_with_tables(&format!("[routine.{name}]\nsteps = [\"walk 1\"]"));
        let actual = actual.map(|_| ()).expect_err(name).to_string();
        assert!(actual.ends_with(message), "{actual}");
    }
}

#[test]
fn a_round_takes_as_long_and_goes_as_far_as_its_gaits_and_the_changes_between_them() {
    let robot = paper_with_tables(
        "[routine.ahead]\nsteps = [\"walk 10\"]\n[routine.about]\nsteps = [\"left 5\", \"stand 2 s\"]\nrepeat = \"for ever\"\n[routine.gaze]\nsteps = [\"look 1\"]",
    )
    .expect("the routines are valid");
    let rounds = robot
        .routines()
        .iter()
        .map(|routine| Round::of(&robot, routine));
    let [ahead_round, about_round, gaze_round]: [Round; 3] = rounds
        .collect::<Vec<_>>()
        .try_into()
        .expect("there are three routines");
    let walk_forward = robot.predict(gait(&robot, "walk")).forward;
    let walk_forward = walk_forward.expect("the movement is decided");
    let left_turn = robot.predict(gait(&robot, "left")).turn;
    let left_turn = left_turn.expect("the movement is decided");
    // Ten cycles of one second each, and the changes from and to the neutral pose.
    assert!(
        (10.0..11.0).contains(&ahead_round.seconds),
        "{}",
        ahead_round.seconds
    );
    let forward = ahead_round.movement.forward;
    let share = forward.expect("the movement is decided") / (10.0 * walk_forward);
    assert!((0.95..1.05).contains(&share), "{share}");
    assert!(
        (7.0..8.0).contains(&about_round.seconds),
        "{}",
        about_round.seconds
    );
    let share = about_round.movement.turn.expect("the movement is decided") / (5.0 * left_turn);
    assert!((0.9..1.1).contains(&share), "{share}");
    assert_eq!((about_round.round_count, about_round.step_count), (None, 2));
    // Two feet pull against two: differences between the pads that cannot be measured decide whether the robot moves.
    assert_eq!(gaze_round.movement.forward, None);
}
