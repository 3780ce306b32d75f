//! Tests of routine steps that end when a contact closes: a button, or a nose switch that touches a wall.

use super::*;
use crate::numbers::gaits::Input;
use crate::sample::{BUTTON, NOSE};

const WAIT: u8 = Step::WAIT;
const UNTIL: u8 = Step::UNTIL;
const ENDLESS: u16 = Step::ENDLESS;

/// The steps of a patrol: wait for the button, walk to a wall, walk back, turn. A step consists of its kind, a gait or
/// an input, and a count.
const PATROL_STEPS: [(u8, &str, u16); 6] = [
    (UNTIL, "button", 0),
    (WAIT, "stand", ENDLESS),
    (UNTIL, "nose", 0),
    (FRAMES, "sway", ENDLESS),
    (CYCLES, "back", 1),
    (CYCLES, "sway left", 1),
];

/// The number of frames after which a closed contact counts as closed.
const DEBOUNCE_FRAMES: u32 = 3;

/// More frames than any step without [`ENDLESS`] takes in these tests.
const LONG_FRAMES: u32 = 600;

fn set_contact(dialogue: &mut Dialogue, input: Input, is_closed: bool) {
    let bit = 1 << input.pin();
    dialogue.board.closed_pins &= !bit;
    dialogue.board.closed_pins |= bit * u32::from(is_closed);
}

/// Closes a contact for `frames` frames, then opens it. Returns the lines printed while the contact is closed.
fn press(dialogue: &mut Dialogue, input: Input, frames: u32) -> Vec<String> {
    set_contact(dialogue, input, true);
    let lines = dialogue.run_frames(frames);
    set_contact(dialogue, input, false);
    lines
}

/// Runs until the robot's activity changes, for at most [`LONG_FRAMES`] frames. Returns the number of frames and the
/// new activity.
fn run_until_change(dialogue: &mut Dialogue) -> (u32, String) {
    let activity_before = activity_name(dialogue);
    for frames in 0..LONG_FRAMES {
        if activity_name(dialogue) != activity_before {
            return (frames, activity_name(dialogue));
        }
        dialogue.run_frames(1);
    }
    (LONG_FRAMES, activity_before)
}

/// Closes a contact and runs until the robot's activity changes; see [`run_until_change`].
fn close_until_change(dialogue: &mut Dialogue, input: Input) -> (u32, String) {
    set_contact(dialogue, input, true);
    run_until_change(dialogue)
}

/// The last steps of some routines: wait for the button, walk back.
const WAIT_FOR_BUTTON_AND_GO_BACK: [(u8, &str, u16); 3] = [
    (UNTIL, "button", 0),
    (WAIT, "stand", ENDLESS),
    (CYCLES, "back", 1),
];

#[test]
fn in_each_round_the_robot_waits_for_the_button_walks_to_the_wall_and_turns() {
    let mut dialogue = start_patrol(2, &PATROL_STEPS);
    for _ in 0..2 {
        assert_eq!(dialogue.run_frames(LONG_FRAMES), ["# waiting for button"]);
        assert_eq!(activity_name(&dialogue), "Stop");
        assert_eq!(dialogue.status_value("gait"), "patrol");
        let printed_lines = press(&mut dialogue, BUTTON, DEBOUNCE_FRAMES);
        assert_eq!(printed_lines, ["# waiting for nose"]);
        assert_eq!(activity_name(&dialogue), "sway");
        let printed_lines = dialogue.run_frames(3 * LONG_FRAMES);
        assert!(printed_lines.is_empty(), "the walk ends only at a wall");
        assert_eq!(activity_name(&dialogue), "sway");
        assert!(press(&mut dialogue, NOSE, DEBOUNCE_FRAMES).is_empty());
        assert_eq!(activity_name(&dialogue), "back");
        assert_eq!(run_until_change(&mut dialogue).1, "sway left");
    }
    assert_eq!(dialogue.run_frames(LONG_FRAMES), ["# done"]);
    assert_eq!(dialogue.status_value("gait"), "stop");
}

#[test]
fn a_bouncing_contact_counts_as_closed_once_it_stays_closed_for_three_frames() {
    let mut dialogue = start_patrol(1, &PATROL_STEPS);
    dialogue.run_frames(LONG_FRAMES);
    for _ in 0..20 {
        press(&mut dialogue, BUTTON, DEBOUNCE_FRAMES - 1);
        dialogue.run_frames(1);
    }
    assert_eq!(activity_name(&dialogue), "Stop");
    let change = close_until_change(&mut dialogue, BUTTON);
    assert_eq!(change, (DEBOUNCE_FRAMES, "sway".to_string()));
}

#[test]
fn a_stuck_button_does_not_start_the_robot_until_it_is_released_and_pressed_again() {
    let mut dialogue = wake_robot(Sample::asymmetric().with_routine("patrol", 1, &PATROL_STEPS));
    set_contact(&mut dialogue, BUTTON, true);
    let printed_lines = dialogue.send_and_run("patrol", 5 * LONG_FRAMES);
    assert_eq!(printed_lines, ["# waiting for button"]);
    assert_eq!(activity_name(&dialogue), "Stop");
    set_contact(&mut dialogue, BUTTON, false);
    dialogue.run_frames(DEBOUNCE_FRAMES - 1);
    press(&mut dialogue, BUTTON, LONG_FRAMES);
    let activity = activity_name(&dialogue);
    assert_eq!(activity, "Stop", "the button was open for too short a time");
    dialogue.run_frames(DEBOUNCE_FRAMES);
    press(&mut dialogue, BUTTON, DEBOUNCE_FRAMES);
    assert_eq!(activity_name(&dialogue), "sway");
}

#[test]
fn a_nose_switch_that_is_already_closed_ends_the_walk_after_the_debounce_time() {
    let mut dialogue = start_patrol(1, &PATROL_STEPS);
    dialogue.run_frames(LONG_FRAMES);
    set_contact(&mut dialogue, NOSE, true);
    press(&mut dialogue, BUTTON, DEBOUNCE_FRAMES);
    let change = run_until_change(&mut dialogue);
    assert_eq!(change, (DEBOUNCE_FRAMES, "back".to_string()));
}

#[test]
fn a_step_of_every_kind_ends_by_its_contact_or_else_by_its_count_or_time() {
    let stand = (FRAMES, "stand", 20);
    for (step, activity, expected_frames) in [
        ((CYCLES, "sway", 2), "sway", 100..400),
        ((FRAMES, "sway", 150), "sway", 149..151),
        ((REST, "stand", 150), "Rest", 149..151),
        ((WAIT, "stand", 150), "Stop", 120..151),
    ] {
        let steps = [(FRAMES, "back", 40), (UNTIL, "nose", 0), step, stand];
        let run_to_step = || {
            let mut dialogue = start_patrol(1, &steps);
            while activity_name(&dialogue) != activity {
                dialogue.run_frames(1);
            }
            dialogue
        };
        let mut interrupted_dialogue = run_to_step();
        interrupted_dialogue.run_frames(10);
        let change = close_until_change(&mut interrupted_dialogue, NOSE);
        assert_eq!(change, (DEBOUNCE_FRAMES, "stand".to_string()), "{step:?}");
        let (frames, next_activity) = run_until_change(&mut run_to_step());
        assert_eq!(next_activity, "stand");
        assert!(expected_frames.contains(&frames), "{step:?}: {frames}");
    }
}

#[test]
fn a_press_before_the_wait_for_it_has_no_effect() {
    for step in [
        (CYCLES, "sway", 2),
        (FRAMES, "sway", 150),
        (FRAMES, "stand", 150),
        (REST, "stand", 150),
    ] {
        let steps = [&[step][..], &WAIT_FOR_BUTTON_AND_GO_BACK].concat();
        let mut dialogue = start_patrol(1, &steps);
        dialogue.run_frames(20);
        assert!(press(&mut dialogue, BUTTON, 50).is_empty());
        let printed_lines = dialogue.run_frames(LONG_FRAMES);
        assert_eq!(printed_lines, ["# waiting for button"], "{step:?}");
        assert!(["Stop", "Rest"].contains(&activity_name(&dialogue).as_str()));
        press(&mut dialogue, BUTTON, DEBOUNCE_FRAMES);
        assert_eq!(activity_name(&dialogue), "back");
    }
}

#[test]
fn a_wait_that_has_ended_before_its_line_could_be_printed_is_not_reported() {
    let stand = (FRAMES, "stand", 10);
    let short_walk = [stand, (UNTIL, "nose", 0), (FRAMES, "sway", 5)];
    let steps = [&short_walk[..], &[(FRAMES, "back", 100)]].concat();
    let mut dialogue = start_patrol(1, &steps);
    dialogue.run_without_reader(30);
    assert!(dialogue.run_frames(1).is_empty());
    let steps = [&[stand][..], &WAIT_FOR_BUTTON_AND_GO_BACK].concat();
    let mut dialogue = start_patrol(1, &steps);
    dialogue.run_without_reader(20);
    dialogue.board.late_edges = 1;
    dialogue.run_without_reader(1);
    let expected_lines = ["# fault: a pulse was late, stopped"];
    assert_eq!(dialogue.run_frames(1), expected_lines);
}

#[test]
fn a_wait_after_a_rest_sends_no_pulse_until_a_press_wakes_the_servos() {
    let steps = [&[(REST, "stand", 10)][..], &WAIT_FOR_BUTTON_AND_GO_BACK].concat();
    let mut dialogue = start_patrol(1, &steps);
    dialogue.run_frames(20);
    for _ in 0..LONG_FRAMES {
        assert_eq!(dialogue.run_frame(), Pulses::default());
    }
    press(&mut dialogue, BUTTON, DEBOUNCE_FRAMES);
    assert_eq!(activity_name(&dialogue), "back");
    assert_eq!(dialogue.run_frames(LONG_FRAMES), ["# done"]);
}

#[test]
fn a_wait_brakes_the_previous_gait_without_moving_a_servo_faster() {
    let steps = [
        (FRAMES, "sway", 90),
        (UNTIL, "button", 0),
        (WAIT, "stand", ENDLESS),
    ];
    let mut dialogue = start_patrol(1, &steps);
    let mut last_widths = run_frame_and_read_widths(&mut dialogue);
    let mut changes = Vec::new();
    for _ in 0..200 {
        let new_widths = run_frame_and_read_widths(&mut dialogue);
        let servo_changes = last_widths.iter().zip(new_widths);
        let change = servo_changes.map(|(a, b)| a.abs_diff(b)).max();
        changes.push(change.expect("there are four widths"));
        last_widths = new_widths;
    }
    let is_still = |change: &u16| *change == 0;
    let braking_frames = changes[90..].iter().position(is_still);
    let braking_frames = braking_frames.expect("the servos stop");
    assert!((4..12).contains(&braking_frames), "{changes:?}");
    let max_walking_change = changes[80..90].iter().max();
    let max_waiting_change = changes[90..].iter().max();
    assert!(max_waiting_change <= max_walking_change, "{changes:?}");
    assert!(changes[110..].iter().all(is_still), "{changes:?}");
}

/// Starts two robots on patrol: the first waits for the button, the second walks until the nose switch closes.
fn start_waiting_robots() -> [Dialogue; 2] {
    let mut button_dialogue = start_patrol(0, &PATROL_STEPS);
    button_dialogue.run_frames(100);
    let mut nose_dialogue = button_dialogue.clone();
    press(&mut nose_dialogue, BUTTON, 100);
    [button_dialogue, nose_dialogue]
}

#[test]
fn whatever_ends_a_routine_ends_its_wait_and_then_no_contact_moves_the_robot() {
    let assert_ignores_contacts = |mut dialogue: Dialogue, event: &str| {
        dialogue.run_frames(60);
        let activity_before = activity_name(&dialogue);
        for input in [BUTTON, NOSE] {
            press(&mut dialogue, input, 50);
            assert_eq!(dialogue.run_frames(50), Vec::<String>::new(), "{event}");
            assert_eq!(activity_name(&dialogue), activity_before, "{event}");
        }
    };
    for waiting_dialogue in start_waiting_robots() {
        for line in ["stop", "rest", "stand", NEUTRAL_COMMAND] {
            let mut dialogue = waiting_dialogue.clone();
            dialogue.send_and_run(line, 300);
            assert_ignores_contacts(dialogue, line);
        }
        for board_mv in [4_200, 3_900] {
            let mut low_supply_dialogue = waiting_dialogue.clone();
            low_supply_dialogue.run_at_supply(board_mv, 60);
            assert_eq!(low_supply_dialogue.status_value("fault"), "supply");
            set_supply(&mut low_supply_dialogue, 5_000);
            assert_ignores_contacts(low_supply_dialogue, "a weak supply");
        }
        let mut late_dialogue = waiting_dialogue.clone();
        late_dialogue.board.late_edges = 1;
        assert_ignores_contacts(late_dialogue, "a late edge");
        let mut silent_dialogue = waiting_dialogue.clone();
        silent_dialogue.send_and_run("deadman 200", 20);
        assert_eq!(silent_dialogue.status_value("fault"), "link");
        assert_ignores_contacts(silent_dialogue, "silence");
        for cause in [Cause::External, Cause::BrownOut, Cause::Watchdog] {
            let mut reset_dialogue = waiting_dialogue.clone();
            reset_dialogue.reset(cause);
            reset_dialogue.run_frames(300);
            assert_ignores_contacts(reset_dialogue, "a reset");
        }
        let mut hung_dialogue = waiting_dialogue.clone();
        assert!(hung_dialogue.stall(1_000));
        hung_dialogue.run_frames(300);
        assert_ignores_contacts(hung_dialogue, "a hang");
    }
}

#[test]
fn a_contact_ends_a_walk_even_on_a_low_supply() {
    let [_, mut dialogue] = start_waiting_robots();
    dialogue.run_at_supply(4_400, 60);
    assert_eq!(activity_name(&dialogue), "sway");
    let change = close_until_change(&mut dialogue, NOSE);
    assert_eq!(change, (DEBOUNCE_FRAMES, "back".to_string()));
}

#[test]
fn deadman_does_not_limit_the_waits_of_a_routine_started_by_boot() {
    let mut dialogue = wake_robot(Sample::asymmetric().with_routine("patrol", 0, &PATROL_STEPS));
    dialogue.expect_all_accepted(&["boot patrol", "deadman 200", "save"]);
    let mut unattended_dialogue = dialogue.power_on_copy();
    let lines = unattended_dialogue.run_frames(10 * LONG_FRAMES);
    let expected_end = ["# boot: patrol", "# waiting for button"];
    assert_eq!(lines[lines.len() - 2..], expected_end);
    let lines = press(&mut unattended_dialogue, BUTTON, DEBOUNCE_FRAMES);
    assert_eq!(lines, ["# waiting for nose"]);
    assert_eq!(activity_name(&unattended_dialogue), "sway");
    assert!(unattended_dialogue.run_frames(10 * LONG_FRAMES).is_empty());
}

#[test]
fn a_pins_pull_up_is_switched_on_at_the_first_wait_for_its_contact() {
    let mut dialogue = wake_robot(Sample::asymmetric().with_routine("patrol", 1, &PATROL_STEPS));
    assert_eq!(dialogue.board.pulled_up_pins, 0);
    dialogue.send_and_run("patrol", 10);
    assert_eq!(dialogue.board.pulled_up_pins, 1 << BUTTON.pin());
    dialogue.run_frames(DEBOUNCE_FRAMES);
    press(&mut dialogue, BUTTON, 10);
    let expected_pins = 1 << BUTTON.pin() | 1 << NOSE.pin();
    assert_eq!(dialogue.board.pulled_up_pins, expected_pins);
}

#[test]
fn only_a_free_pin_of_the_board_gets_a_pull_up() {
    let pins = Sample::asymmetric().content.pins;
    for pin in 0..=127 {
        let robot = Sample::asymmetric().with_routine("patrol", 1, &PATROL_STEPS);
        let robot = robot.with_changes(|content| {
            let button = content.steps.iter_mut().find(|step| step.kind == UNTIL);
            button.expect("the patrol waits for the button").gait = pin;
        });
        let mut dialogue = wake_robot(robot);
        dialogue.board.closed_pins = u32::MAX;
        dialogue.send_and_run("patrol", 10);
        let is_free = (2..=12).contains(&pin) || (15..=19).contains(&pin);
        let gets_pull_up = is_free && !pins.contains(&pin);
        let expected_pins = if gets_pull_up { 1 << pin } else { 0 };
        assert_eq!(dialogue.board.pulled_up_pins, expected_pins, "pin {pin}");
        assert_eq!(activity_name(&dialogue), "Stop");
    }
}

#[test]
fn a_routine_that_starts_while_the_guard_holds_the_robot_still_waits_for_its_contacts() {
    let walk_to_wall = [
        (UNTIL, "nose", 0),
        (FRAMES, "sway", ENDLESS),
        (CYCLES, "back", 1),
    ];
    let robot = Sample::asymmetric()
        .with_routine("patrol", 1, &PATROL_STEPS)
        .with_routine("wander", 1, &walk_to_wall);
    let mut held_dialogue = wake_robot(robot);
    let printed_lines = held_dialogue.send_and_run("stray", LONG_FRAMES);
    assert_line_starts(&printed_lines, &["# held"]);
    let mut waiting_dialogue = held_dialogue.clone();
    let printed_lines = waiting_dialogue.send_and_run("patrol", 10);
    assert_eq!(printed_lines, ["# waiting for button"]);
    waiting_dialogue.expect_status(&[("gait", "patrol"), ("fault", "none")]);
    press(&mut waiting_dialogue, BUTTON, DEBOUNCE_FRAMES);
    assert_eq!(activity_name(&waiting_dialogue), "sway");
    // The first step begins only after the pulses have settled.
    held_dialogue.expect_all_accepted(&["trim 1 15", "wander"]);
    held_dialogue.run_frames(10);
    assert_eq!(held_dialogue.status_value("gait"), "wander");
    press(&mut held_dialogue, NOSE, DEBOUNCE_FRAMES);
    assert_eq!(activity_name(&held_dialogue), "back");
}

#[test]
fn a_routine_brakes_its_last_gait_before_it_is_done() {
    for steps in [
        &[(FRAMES, "sway", 90)][..],
        &[(UNTIL, "nose", 0), (FRAMES, "sway", ENDLESS)],
    ] {
        let mut dialogue = start_patrol(1, steps);
        dialogue.run_frames(90);
        set_contact(&mut dialogue, NOSE, true);
        assert_eq!(dialogue.run_frames(20), ["# done"]);
        assert_eq!(dialogue.status_value("gait"), "stop");
        let held_widths = run_frame_and_read_widths(&mut dialogue);
        assert!(dialogue.run_frames(LONG_FRAMES).is_empty());
        assert_eq!(run_frame_and_read_widths(&mut dialogue), held_widths);
    }
}

#[test]
fn a_routine_may_wait_once_and_repeat_only_the_later_steps() {
    let robot = Sample::asymmetric().with_routine("patrol", 3, &PATROL_STEPS);
    let robot = robot.with_changes(|content| {
        let routine = content.gaits.last_mut().expect("the robot has a routine");
        routine.channels[3].offset = 2;
    });
    let mut dialogue = wake_robot(robot);
    let printed_lines = dialogue.send_and_run("patrol", LONG_FRAMES);
    assert_eq!(printed_lines, ["# waiting for button"]);
    press(&mut dialogue, BUTTON, DEBOUNCE_FRAMES);
    for _ in 0..3 {
        assert_eq!(activity_name(&dialogue), "sway");
        assert_eq!(close_until_change(&mut dialogue, NOSE).1, "back");
        set_contact(&mut dialogue, NOSE, false);
        assert_eq!(run_until_change(&mut dialogue).1, "sway left");
        run_until_change(&mut dialogue);
    }
    assert_eq!(dialogue.status_value("gait"), "stop");
}
