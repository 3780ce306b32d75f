//! Tests that docs/faults.md shows the tables, and that every entry of the tables satisfies the safety rules.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::*;

const FAULTS_PAGE: &str = include_str!("../../../../../docs/faults.md");

const SUPPLY_LEVELS: [(Option<Level>, &str); 5] = [
    (Some(Level::Good), "good"),
    (None, "not measured yet"),
    (Some(Level::Slow), "low"),
    (Some(Level::Stop), "too low to move"),
    (Some(Level::Rest), "too low to hold"),
];

const fn describe_event(event: Event) -> &'static str {
    match event {
        Event::Stand => "`stand`",
        Event::Move => "another motion",
        Event::Stop => "`stop`",
        Event::Rest => "`rest`",
        Event::Save => "`save`",
        Event::BootDue => "the time of `boot` has come",
        Event::Silence => "no command within the `deadman` time",
        Event::SupplyTooLowToMove => "the supply gets too low to move",
        Event::SupplyTooLowToHold => "the supply gets too low to hold",
        Event::LateEdge => "an edge of a pulse is late",
        Event::StackOverflow => "the stack reaches the data",
        Event::UnsafePose => "the next pose would not be safe",
    }
}

fn describe_response(response: Response, state: State) -> String {
    let is_resting = state == State::Resting;
    match response {
        Response::Nothing => "-".into(),
        Response::Obey => "done".into(),
        Response::RefuseResting => "refused, 7".into(),
        Response::RefuseSupply => "refused, 8".into(),
        Response::Freeze(fault) if is_resting => format!("fault {}", fault.code()),
        Response::Freeze(fault) => format!("frozen, fault {}", fault.code()),
        Response::EndPulses(fault) if is_resting => format!("fault {}", fault.code()),
        Response::EndPulses(fault) => format!("pulses end, fault {}", fault.code()),
    }
}

/// Formats an event's rows in the table of events, one for each set of supply levels with equal responses.
fn format_event_rows(event: Event) -> Vec<String> {
    let format_cells = |supply| {
        let format_cell = |state| describe_response(response(event, supply, state), state);
        State::ALL.map(format_cell).join(" | ")
    };
    let mut groups: Vec<(Vec<&str>, String)> = Vec::new();
    for (supply, name) in SUPPLY_LEVELS {
        let cells = format_cells(supply);
        match groups.iter_mut().find(|(_, other)| *other == cells) {
            Some((names, _)) => names.push(name),
            None => groups.push((Vec::from([name]), cells)),
        }
    }
    let format_row = |(names, cells): &(Vec<&str>, String)| {
        let supply = if names.len() == SUPPLY_LEVELS.len() {
            "any".into()
        } else {
            names.join(", ")
        };
        format!("| {} | {supply} | {cells} |", describe_event(event))
    };
    groups.iter().map(format_row).collect()
}

/// Checks that docs/faults.md contains the table with this header and these rows.
#[track_caller]
fn assert_in_docs(header: &str, rows: &[String]) {
    let rule = "|---".repeat(header.matches('|').count() - 1);
    let table = format!("{header}\n{rule}|\n{}\n", rows.join("\n"));
    let is_shown = FAULTS_PAGE.contains(&table);
    assert!(is_shown, "docs/faults.md must contain:\n{table}");
}

#[test]
fn the_docs_show_the_table_of_events() {
    let rows: Vec<String> = Event::ALL.into_iter().flat_map(format_event_rows).collect();
    let header =
        "| what happens | supply | resting | standing, holding, moving to a pose | walking |";
    assert_in_docs(header, &rows);
}

#[test]
fn the_docs_show_the_table_of_resets() {
    let mut rows = Vec::new();
    for cause in Cause::ALL {
        let [first_actions, later_actions] = [0, BROWN_OUTS_TO_REST]
            .map(|count| ServosBefore::ALL.map(|servos| first_action(cause, count, servos)));
        let groups = if first_actions == later_actions {
            Vec::from([("any", first_actions)])
        } else {
            Vec::from([
                ("once, twice", first_actions),
                ("three times in a row", later_actions),
            ])
        };
        for (frequency, actions) in groups {
            let cells = actions.map(|(action, _)| match action {
                FirstAction::Wake => "wakes, stands",
                FirstAction::WakeInPlace => "wakes where it was, stands",
                FirstAction::Hold => "held",
                FirstAction::Rest => "rests",
            });
            let (_, fault) = actions[ServosBefore::Held as usize];
            rows.push(format!(
                "| {} | {} | {} | {} |",
                match cause {
                    Cause::Power => "`power`",
                    Cause::External => "`external`",
                    Cause::BrownOut => "`brownout`",
                    Cause::Watchdog => "`watchdog`",
                },
                frequency,
                cells.join(" | "),
                fault.map_or("-".into(), |fault| format!("{}", fault.code())),
            ));
        }
    }
    let header = "| reset | maybe by the supply | nothing known | rested | held | fault |";
    assert_in_docs(header, &rows);
}

#[test]
fn only_stand_and_boot_give_pulses_to_a_resting_robot() {
    for event in Event::ALL {
        for (supply, _) in SUPPLY_LEVELS {
            // `save` is executed, too, but moves no servo.
            if response(event, supply, State::Resting) == Response::Obey {
                assert!(matches!(event, Event::Stand | Event::BootDue | Event::Save));
            }
        }
    }
}

#[test]
fn a_lower_supply_never_allows_a_command_that_a_higher_supply_refuses() {
    for event in [Event::Stand, Event::Move, Event::Save, Event::BootDue] {
        for state in State::ALL {
            let is_executed = |(supply, _)| response(event, supply, state) == Response::Obey;
            let are_executed = [0, 2, 3, 4].map(|index| is_executed(SUPPLY_LEVELS[index]));
            let is_sorted = are_executed.is_sorted_by(|higher, lower| higher >= lower);
            assert!(is_sorted, "{event:?}");
        }
    }
}

#[test]
fn servos_resume_only_if_held_and_wake_otherwise_only_after_power_on_or_an_unknown_state() {
    for cause in Cause::ALL {
        for suspected_brown_outs in 0..=BROWN_OUTS_TO_REST {
            for servos_before in ServosBefore::ALL {
                let case =
                    format!("{cause:?}, {suspected_brown_outs} brown-outs, {servos_before:?}");
                let (action, fault) = first_action(cause, suspected_brown_outs, servos_before);
                let is_unknown = servos_before == ServosBefore::Unknown && fault.is_none();
                let must_wake = cause == Cause::Power || is_unknown;
                match action {
                    FirstAction::Wake => assert!(must_wake, "must not wake: {case}"),
                    FirstAction::WakeInPlace | FirstAction::Hold => {
                        let is_held = servos_before == ServosBefore::Held;
                        assert!(is_held, "nothing to resume: {case}");
                        assert!(!must_wake, "must wake: {case}");
                    }
                    FirstAction::Rest => assert!(!must_wake, "must wake: {case}"),
                }
            }
        }
    }
}
