//! The input pins in robot.toml, and routine steps that end on an input.

use lizard_core::numbers::gaits::{Input, Step};
use lizard_robot::{OPEN_INPUTS_NOTE, Report, RoutineRow};

use super::{gait, paper, paper_text, paper_with_tables, read_cases, record_fields};

/// Both inputs, each with a free pin.
const INPUTS: &str = "[input.button]\npin = \"A1\"\n[input.nose]\npin = \"A2\"\n";

/// Returns the error message for these tables, whose line number is counted from the tables' first line.
fn error_with_tables(tables: &str) -> String {
    let error = paper_with_tables(tables).map(|_| ()).expect_err(tables);
    let lines_before = paper_text().trim_end().lines().count() + 1;
    let line = error.line.expect("the error has a line");
    let location = format!("robot.toml:{line}");
    let line_in_tables = (line - lines_before).to_string();
    error.to_string().replacen(&location, &line_in_tables, 1)
}

/// Returns kind, gait and count of each record of a routine with only this step.
fn step_records(step: &str) -> Vec<(u8, u8, u16)> {
    let tables = format!("{INPUTS}[routine.one]\nsteps = [\"{step}\"]");
    let robot = paper_with_tables(&tables).expect(step);
    let [routine] = robot.routines() else {
        panic!("the robot has one routine");
    };
    assert_eq!(routine.step_count(), 1);
    record_fields(routine)
}

#[test]
fn a_step_with_an_input_has_two_records_with_the_input_first() {
    let (button, nose) = (Input::button(15), Input::nose(16));
    let until_record = |input: Input| (Step::UNTIL, input.byte(), 0);
    let wait_record = (Step::WAIT, 0, Step::ENDLESS);
    let gait_index = |name: &str| gait(paper(), name).index() as u8;
    let (frames, endless) = (Step::FRAMES, Step::ENDLESS);
    let [walk, arc] = ["walk", "arc-left"].map(gait_index);
    for (step, input, record) in [
        ("wait button", button, wait_record),
        (" wait  nose ", nose, wait_record),
        ("walk until nose", nose, (frames, walk, endless)),
        ("walk 10 until nose", nose, (Step::CYCLES, walk, 10)),
        ("arc left 2.5 s until button", button, (frames, arc, 125)),
        ("stand until button", button, (frames, 0, endless)),
        ("rest until button", button, (Step::REST, 0, endless)),
        ("rest 5 s until button", button, (Step::REST, 0, 250)),
    ] {
        let expected = [until_record(input), record];
        assert_eq!(step_records(step), expected, "{step}");
    }
    assert_eq!(step_records("rest"), [(Step::REST, 0, 1)]);
    assert_eq!((button.pin(), nose.pin()), (15, 16));
    assert!(nose.is_nose() && !button.is_nose());
}

#[test]
fn unused_inputs_do_not_change_the_flash_section() {
    let robot = paper_with_tables(INPUTS).expect("the inputs are valid");
    assert_eq!(robot.section(), paper().section());
    let named_pins: Vec<_> = robot.inputs().named_pins().collect();
    assert_eq!(named_pins, [("button", 15), ("nose", 16)]);
    assert_eq!(paper().inputs().named_pins().count(), 0);
}

#[test]
fn every_free_pin_can_be_an_input_and_used_pins_are_rejected() {
    let rail = "[supply.rail]\npin = \"A3\"\nratio = 2.0\n";
    let unusable =
        "; it must be one of D2 to D12 or A0 to A5 (D0 and D1 are the serial line, D13 is the LED)";
    for (pin, message) in [
        ("D9", ", which servo.A1 already uses"),
        ("D3", ", which servo.A4 already uses"),
        ("A3", ", which supply.rail already uses"),
        ("D0", unusable),
        ("D1", unusable),
        ("D13", unusable),
        ("A6", unusable),
        ("A7", unusable),
        ("a1", unusable),
    ] {
        for name in ["button", "nose"] {
            let actual = error_with_tables(&format!("[input.{name}]\npin = \"{pin}\"\n{rail}"));
            assert_eq!(actual, format!("2: input.{name}.pin is \"{pin}\"{message}"));
        }
    }
    for pin in "D2 D4 D5 D6 D7 D8 D12 A0 A1 A2 A4 A5".split(' ') {
        let tables = format!("[input.nose]\npin = \"{pin}\"\n{rail}");
        let robot = paper_with_tables(&tables).expect(pin);
        assert!(robot.inputs().nose.is_some() && robot.inputs().button.is_none());
    }
    let message = error_with_tables("[input.button]\npin = \"A1\"\n[input.nose]\npin = \"A1\"");
    let expected = "4: input.nose.pin is \"A1\", which input.button already uses";
    assert_eq!(message, expected);
}

#[test]
fn a_mistake_in_an_input_or_in_a_step_with_an_input_is_reported_with_its_line() {
    let mistakes = r#"
        [input.knob]\npin = "A1" => 1: input.knob is not a known key; allowed: button, nose
        [input.nose]\npim = "A1" => 2: input.nose.pim is not a known key; did you mean "pin"?
        [input.nose]\n => 1: input.nose.pin is missing; it must be a string
    "#;
    for (tables, message) in read_cases(mistakes) {
        assert_eq!(error_with_tables(&tables), message);
    }
    let no_length = "needs a length: 1 to 999 cycles, for example \"walk 3\", or a time, for example \"walk 2 s\"";
    let gaits = "stand, walk, trot, crawl, back, left, right, arc-left, arc-right, look";
    let steps = format!(
        r#"
        wait => must name an input, for example "wait button"
        walk until => must name an input after until, for example "walk until nose"
        wait buton => names the input "buton", which does not exist; did you mean "button"?
        walk until wall => names the input "wall", which does not exist; allowed: button, nose
        wolk until nose => names the gait "wolk", which does not exist; did you mean "walk"?
        walk 0 until nose => {no_length}
        one until nose => is the routine itself, which would never end
        walk 0 s until nose => has a time that is not between 0.02 and 999 s
        wait button until nose => names the gait "wait-button", which does not exist; allowed: {gaits}
        "#
    );
    for (step, message) in read_cases(&steps) {
        let tables = format!("{INPUTS}[routine.one]\nsteps = [\"walk 1\", \"{step}\"]");
        let expected = format!("6: routine.one.steps: step 2, \"{step}\", {message}");
        assert_eq!(error_with_tables(&tables), expected);
    }
    let actual = error_with_tables("[routine.one]\nsteps = [\"wait nose\"]");
    let message = "names the input \"nose\", which has no pin; set one in [input.nose], for example pin = \"A1\"";
    let expected = format!("2: routine.one.steps: step 1, \"wait nose\", {message}");
    assert_eq!(actual, expected);
}

#[test]
fn a_round_counts_a_wait_as_one_frame_and_an_endless_gait_as_one_cycle() {
    let simulate_round = |steps: &str| {
        let routine = format!("[routine.one]\nsteps = [{steps}]\nrepeat = \"for ever\"");
        let robot = paper_with_tables(&(INPUTS.to_owned() + &routine)).expect(steps);
        RoutineRow::simulate(&robot, &robot.routines()[0])
    };
    let round_with_inputs = simulate_round(
        "\"wait button\", \"walk until nose\", \"left 3 until nose\", \"rest until button\"",
    );
    let plain_round = simulate_round("\"walk 1\", \"left 3\", \"rest\"");
    assert!(round_with_inputs.has_inputs && !plain_round.has_inputs);
    let step_counts = [&round_with_inputs, &plain_round].map(|round| round.step_count);
    assert_eq!(step_counts, [4, 3]);
    let extra_seconds = round_with_inputs.seconds - plain_round.seconds;
    assert!((0.0..0.1).contains(&extra_seconds), "{extra_seconds} s");
    let turn_of = |round: &RoutineRow| round.movement.turn.expect("the turn is determined");
    assert!((turn_of(&round_with_inputs) - turn_of(&plain_round)).abs() < 0.1);
}

#[test]
fn a_report_has_a_note_if_a_step_ends_on_an_input() {
    let format_report =
        |tables: &str| Report::compute(&paper_with_tables(tables).expect(tables)).to_string();
    let tables = format!("{INPUTS}[routine.one]\nsteps = [\"wait button\"]");
    assert!(format_report(&tables).contains(OPEN_INPUTS_NOTE));
    assert!(!format_report(INPUTS).contains(OPEN_INPUTS_NOTE));
}

#[test]
fn the_patrol_in_the_docs_repeats_from_its_second_step() {
    let docs = include_str!("../../../../docs/gaits.md");
    let blocks = docs.split("```toml\n").skip(1);
    let mut blocks = blocks.filter_map(|block| block.split("```").next());
    let patrol = blocks.find(|block| block.contains("[input."));
    let patrol = patrol.expect("the page has a block with inputs");
    assert!(include_str!("../../../../docs/quickstart.md").contains(patrol));
    let robot = paper_with_tables(patrol).expect("the robot is valid");
    let [routine] = robot.routines() else {
        panic!("the robot has one routine");
    };
    assert_eq!((routine.step_count(), routine.round_count()), (4, None));
    let core = robot.core();
    let ids = lizard_core::numbers::gaits::GaitId::all(core.gait_count());
    let record = core.gait(ids.last().expect("the robot has a routine"));
    let [_, record_count, _, repeat_from] = record.channels.map(|channel| channel.offset);
    assert_eq!((record_count, repeat_from), (6, 2));
    assert_eq!(core.step(&record, repeat_from).kind, Step::UNTIL);
}
