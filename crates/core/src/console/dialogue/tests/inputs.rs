//! Tests of routine steps that end when a contact closes: a button, or a nose switch that touches a wall.

use super::*;
use crate::numbers::gaits::Input;
use crate::sample::{BUTTON, NOSE};

/// A record of a routine: its kind, a gait or an input, and a count.
type RecordTuple = (u8, &'static str, u16);

/// The record before a step that the button ends.
const UNTIL_BUTTON: RecordTuple = (Step::UNTIL, "button", 0);
/// The record before a step that the nose switch ends.
const UNTIL_NOSE: RecordTuple = (Step::UNTIL, "nose", 0);

/// The steps of a patrol: wait for the button, walk to a wall, walk back, turn.
const PATROL_STEPS: [RecordTuple; 6] = [
    UNTIL_BUTTON,
    (Step::WAIT, "stand", Step::ENDLESS),
    UNTIL_NOSE,
    (Step::FRAMES, "sway", Step::ENDLESS),
    (Step::CYCLES, "back", 1),
    (Step::CYCLES, "sway left", 1),
];

/// The number of frames for which a contact must stay closed before it counts as closed.
const DEBOUNCE_FRAMES: u32 = 3;

/// More frames than any step without [`Step::ENDLESS`] takes in these tests.
const LONG_FRAMES: u32 = 600;

fn set_contact(robot: &mut RunningRobot, input: Input, is_closed: bool) {
    let bit = 1 << input.pin();
    robot.board.closed_pins &= !bit;
    robot.board.closed_pins |= bit * u32::from(is_closed);
}

/// Closes a contact for `frames` frames, then opens it. Returns the lines printed while the contact is closed.
fn press(robot: &mut RunningRobot, input: Input, frames: u32) -> Vec<String> {
    set_contact(robot, input, true);
    let lines = robot.run_frames(frames);
    set_contact(robot, input, false);
    lines
}

/// Runs until the robot's activity changes, for at most [`LONG_FRAMES`] frames. Returns the number of frames and the
/// new activity.
fn run_until_change(robot: &mut RunningRobot) -> (u32, String) {
    let activity_before = activity_name(robot);
    for frames in 0..LONG_FRAMES {
        if activity_name(robot) != activity_before {
            return (frames, activity_name(robot));
        }
        robot.run_frames(1);
    }
    (LONG_FRAMES, activity_before)
}

/// Closes a contact and runs until the robot's activity changes; see [`run_until_change`].
fn close_until_change(robot: &mut RunningRobot, input: Input) -> (u32, String) {
    set_contact(robot, input, true);
    run_until_change(robot)
}

/// The last steps of some routines: wait for the button, walk back.
const WAIT_FOR_BUTTON_AND_WALK_BACK: [RecordTuple; 3] = [
    UNTIL_BUTTON,
    (Step::WAIT, "stand", Step::ENDLESS),
    (Step::CYCLES, "back", 1),
];

#[test]
fn in_each_round_the_robot_waits_for_the_button_walks_to_the_wall_and_turns() {
    let mut robot = start_patrol(2, &PATROL_STEPS);
    for _ in 0..2 {
        assert_eq!(robot.run_frames(LONG_FRAMES), ["# waiting for button"]);
        assert_eq!(activity_name(&robot), "Stop");
        assert_eq!(robot.status_value("gait"), "patrol");
        let printed_lines = press(&mut robot, BUTTON, DEBOUNCE_FRAMES);
        assert_eq!(printed_lines, ["# waiting for nose"]);
        assert_eq!(activity_name(&robot), "sway");
        let printed_lines = robot.run_frames(3 * LONG_FRAMES);
        assert!(printed_lines.is_empty(), "the walk ends only at a wall");
        assert_eq!(activity_name(&robot), "sway");
        assert!(press(&mut robot, NOSE, DEBOUNCE_FRAMES).is_empty());
        assert_eq!(activity_name(&robot), "back");
        assert_eq!(run_until_change(&mut robot).1, "sway left");
    }
    assert_eq!(robot.run_frames(LONG_FRAMES), ["# done"]);
    assert_eq!(robot.status_value("gait"), "stop");
}

#[test]
fn a_bouncing_contact_counts_as_closed_once_it_stays_closed_for_three_frames() {
    let mut robot = start_patrol(1, &PATROL_STEPS);
    robot.run_frames(LONG_FRAMES);
    for _ in 0..20 {
        press(&mut robot, BUTTON, DEBOUNCE_FRAMES - 1);
        robot.run_frames(1);
    }
    assert_eq!(activity_name(&robot), "Stop");
    let change = close_until_change(&mut robot, BUTTON);
    assert_eq!(change, (DEBOUNCE_FRAMES, "sway".to_string()));
}

#[test]
fn a_stuck_button_does_not_start_the_robot_until_it_is_released_and_pressed_again() {
    let mut robot = wake_robot(Sample::asymmetric().with_routine("patrol", 1, &PATROL_STEPS));
    set_contact(&mut robot, BUTTON, true);
    let printed_lines = robot.send_and_run("patrol", 5 * LONG_FRAMES);
    assert_eq!(printed_lines, ["# waiting for button"]);
    assert_eq!(activity_name(&robot), "Stop");
    set_contact(&mut robot, BUTTON, false);
    robot.run_frames(DEBOUNCE_FRAMES - 1);
    press(&mut robot, BUTTON, LONG_FRAMES);
    let activity = activity_name(&robot);
    assert_eq!(activity, "Stop", "the button was open for too short a time");
    robot.run_frames(DEBOUNCE_FRAMES);
    press(&mut robot, BUTTON, DEBOUNCE_FRAMES);
    assert_eq!(activity_name(&robot), "sway");
}

#[test]
fn a_nose_switch_that_is_already_closed_ends_the_walk_after_the_debounce_time() {
    let mut robot = start_patrol(1, &PATROL_STEPS);
    robot.run_frames(LONG_FRAMES);
    set_contact(&mut robot, NOSE, true);
    press(&mut robot, BUTTON, DEBOUNCE_FRAMES);
    let change = run_until_change(&mut robot);
    assert_eq!(change, (DEBOUNCE_FRAMES, "back".to_string()));
}

#[test]
fn a_step_of_every_kind_ends_at_its_contact_or_else_after_its_count_or_time() {
    let stand = (Step::FRAMES, "stand", 20);
    for (step, activity, expected_frames) in [
        ((Step::CYCLES, "sway", 2), "sway", 100..400),
        ((Step::FRAMES, "sway", 150), "sway", 149..151),
        ((Step::REST, "stand", 150), "Rest", 149..151),
        ((Step::WAIT, "stand", 150), "Stop", 120..151),
    ] {
        let steps = [(Step::FRAMES, "back", 40), UNTIL_NOSE, step, stand];
        let run_to_step = || {
            let mut robot = start_patrol(1, &steps);
            while activity_name(&robot) != activity {
                robot.run_frames(1);
            }
            robot
        };
        let mut interrupted_robot = run_to_step();
        interrupted_robot.run_frames(10);
        let change = close_until_change(&mut interrupted_robot, NOSE);
        assert_eq!(change, (DEBOUNCE_FRAMES, "stand".to_string()), "{step:?}");
        let (frames, next_activity) = run_until_change(&mut run_to_step());
        assert_eq!(next_activity, "stand");
        assert!(expected_frames.contains(&frames), "{step:?}: {frames}");
    }
}

#[test]
fn a_press_before_the_wait_for_it_has_no_effect() {
    for step in [
        (Step::CYCLES, "sway", 2),
        (Step::FRAMES, "sway", 150),
        (Step::FRAMES, "stand", 150),
        (Step::REST, "stand", 150),
    ] {
        let steps = [&[step][..], &WAIT_FOR_BUTTON_AND_WALK_BACK].concat();
        let mut robot = start_patrol(1, &steps);
        robot.run_frames(20);
        assert!(press(&mut robot, BUTTON, 50).is_empty());
        let printed_lines = robot.run_frames(LONG_FRAMES);
        assert_eq!(printed_lines, ["# waiting for button"], "{step:?}");
        assert!(["Stop", "Rest"].contains(&activity_name(&robot).as_str()));
        press(&mut robot, BUTTON, DEBOUNCE_FRAMES);
        assert_eq!(activity_name(&robot), "back");
    }
}

#[test]
fn a_wait_that_has_ended_before_its_line_could_be_printed_is_not_reported() {
    let stand = (Step::FRAMES, "stand", 10);
    let short_walk = [stand, UNTIL_NOSE, (Step::FRAMES, "sway", 5)];
    let steps = [&short_walk[..], &[(Step::FRAMES, "back", 100)]].concat();
    let mut robot = start_patrol(1, &steps);
    robot.run_without_reader(30);
    assert!(robot.run_frames(1).is_empty());
    let steps = [&[stand][..], &WAIT_FOR_BUTTON_AND_WALK_BACK].concat();
    let mut robot = start_patrol(1, &steps);
    robot.run_without_reader(20);
    robot.board.late_edges = 1;
    robot.run_without_reader(1);
    assert_eq!(robot.run_frames(1), ["# fault: a pulse was late, stopped"]);
}

#[test]
fn a_wait_after_a_rest_sends_no_pulse_until_a_press_wakes_the_servos() {
    let steps = [
        &[(Step::REST, "stand", 10)][..],
        &WAIT_FOR_BUTTON_AND_WALK_BACK,
    ]
    .concat();
    let mut robot = start_patrol(1, &steps);
    robot.run_frames(20);
    for _ in 0..LONG_FRAMES {
        assert_eq!(robot.run_frame(), Pulses::default());
    }
    press(&mut robot, BUTTON, DEBOUNCE_FRAMES);
    assert_eq!(activity_name(&robot), "back");
    assert_eq!(robot.run_frames(LONG_FRAMES), ["# done"]);
}

#[test]
fn a_wait_brakes_the_previous_gait_without_moving_a_servo_faster() {
    let steps = [
        (Step::FRAMES, "sway", 90),
        UNTIL_BUTTON,
        (Step::WAIT, "stand", Step::ENDLESS),
    ];
    let mut robot = start_patrol(1, &steps);
    let mut last_widths = run_frame_and_read_widths(&mut robot);
    let mut changes = Vec::new();
    for _ in 0..200 {
        let new_widths = run_frame_and_read_widths(&mut robot);
        let width_pairs = last_widths.iter().zip(new_widths);
        let change = width_pairs.map(|(last, new)| last.abs_diff(new)).max();
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
fn start_waiting_robots() -> [RunningRobot; 2] {
    let mut button_robot = start_patrol(0, &PATROL_STEPS);
    button_robot.run_frames(100);
    let mut nose_robot = button_robot.clone();
    press(&mut nose_robot, BUTTON, 100);
    [button_robot, nose_robot]
}

#[test]
fn whatever_ends_a_routine_ends_its_wait_and_then_no_contact_moves_the_robot() {
    let assert_ignores_contacts = |mut robot: RunningRobot, event: &str| {
        robot.run_frames(60);
        let activity_before = activity_name(&robot);
        for input in [BUTTON, NOSE] {
            press(&mut robot, input, 50);
            assert_eq!(robot.run_frames(50), Vec::<String>::new(), "{event}");
            assert_eq!(activity_name(&robot), activity_before, "{event}");
        }
    };
    for waiting_robot in start_waiting_robots() {
        for line in ["stop", "rest", "stand", NEUTRAL_COMMAND] {
            let mut robot = waiting_robot.clone();
            robot.send_and_run(line, 300);
            assert_ignores_contacts(robot, line);
        }
        for board_mv in [4_200, 3_900] {
            let mut low_supply_robot = waiting_robot.clone();
            low_supply_robot.run_at_supply(board_mv, 60);
            assert_eq!(low_supply_robot.status_value("fault"), "supply");
            set_board_supply(&mut low_supply_robot, 5_000);
            assert_ignores_contacts(low_supply_robot, "a low supply");
        }
        let mut late_robot = waiting_robot.clone();
        late_robot.board.late_edges = 1;
        assert_ignores_contacts(late_robot, "a late edge");
        let mut silent_robot = waiting_robot.clone();
        silent_robot.send_and_run("deadman 200", 20);
        assert_eq!(silent_robot.status_value("fault"), "link");
        assert_ignores_contacts(silent_robot, "silence");
        for cause in [Cause::External, Cause::BrownOut, Cause::Watchdog] {
            let mut reset_robot = waiting_robot.clone();
            reset_robot.reset(cause);
            reset_robot.run_frames(300);
            assert_ignores_contacts(reset_robot, "a reset");
        }
        let mut hung_robot = waiting_robot.clone();
        assert!(hung_robot.stall(1_000));
        hung_robot.run_frames(300);
        assert_ignores_contacts(hung_robot, "a hang");
    }
}

#[test]
fn a_contact_ends_a_walk_even_on_a_low_supply() {
    let [_, mut robot] = start_waiting_robots();
    robot.run_at_supply(4_400, 60);
    assert_eq!(activity_name(&robot), "sway");
    let change = close_until_change(&mut robot, NOSE);
    assert_eq!(change, (DEBOUNCE_FRAMES, "back".to_string()));
}

#[test]
fn deadman_does_not_limit_the_waits_of_a_routine_started_by_boot() {
    let mut robot = wake_robot(Sample::asymmetric().with_routine("patrol", 0, &PATROL_STEPS));
    robot.expect_all_accepted(&["boot patrol", "deadman 200", "save"]);
    let mut unattended_robot = robot.power_on_copy();
    let lines = unattended_robot.run_frames(10 * LONG_FRAMES);
    let expected_end = ["# boot: patrol", "# waiting for button"];
    assert_eq!(lines[lines.len() - 2..], expected_end);
    let lines = press(&mut unattended_robot, BUTTON, DEBOUNCE_FRAMES);
    assert_eq!(lines, ["# waiting for nose"]);
    assert_eq!(activity_name(&unattended_robot), "sway");
    assert!(unattended_robot.run_frames(10 * LONG_FRAMES).is_empty());
}

#[test]
fn the_pull_up_of_a_pin_is_switched_on_at_the_first_wait_for_its_contact() {
    let mut robot = wake_robot(Sample::asymmetric().with_routine("patrol", 1, &PATROL_STEPS));
    assert_eq!(robot.board.pulled_up_pins, 0);
    robot.send_and_run("patrol", 10);
    assert_eq!(robot.board.pulled_up_pins, 1 << BUTTON.pin());
    robot.run_frames(DEBOUNCE_FRAMES);
    press(&mut robot, BUTTON, 10);
    let expected_pins = 1 << BUTTON.pin() | 1 << NOSE.pin();
    assert_eq!(robot.board.pulled_up_pins, expected_pins);
}

#[test]
fn only_a_free_pin_of_the_board_gets_a_pull_up() {
    let pins = Sample::asymmetric().content.pins;
    for pin in 0..=127 {
        let robot = Sample::asymmetric().with_routine("patrol", 1, &PATROL_STEPS);
        let robot = robot.with_changes(|content| {
            let button = content
                .steps
                .iter_mut()
                .find(|step| step.kind == Step::UNTIL);
            button.expect("the patrol waits for the button").gait = pin;
        });
        let mut robot = wake_robot(robot);
        robot.board.closed_pins = u32::MAX;
        robot.send_and_run("patrol", 10);
        // D13 is the LED, and A0 (14) measures the rail.
        let is_free = (2..=12).contains(&pin) || (15..=19).contains(&pin);
        let gets_pull_up = is_free && !pins.contains(&pin);
        let expected_pins = if gets_pull_up { 1 << pin } else { 0 };
        assert_eq!(robot.board.pulled_up_pins, expected_pins, "pin {pin}");
        assert_eq!(activity_name(&robot), "Stop");
    }
}

#[test]
fn a_routine_that_starts_during_a_hold_of_the_guard_also_waits_for_its_contacts() {
    let walk_to_wall = [
        UNTIL_NOSE,
        (Step::FRAMES, "sway", Step::ENDLESS),
        (Step::CYCLES, "back", 1),
    ];
    let robot = Sample::asymmetric()
        .with_routine("patrol", 1, &PATROL_STEPS)
        .with_routine("wander", 1, &walk_to_wall);
    let mut held_robot = wake_robot(robot);
    let printed_lines = held_robot.send_and_run("stray", LONG_FRAMES);
    assert_line_starts(&printed_lines, &["# held"]);
    let mut waiting_robot = held_robot.clone();
    let printed_lines = waiting_robot.send_and_run("patrol", 10);
    assert_eq!(printed_lines, ["# waiting for button"]);
    waiting_robot.expect_status(&[("gait", "patrol"), ("fault", "none")]);
    press(&mut waiting_robot, BUTTON, DEBOUNCE_FRAMES);
    assert_eq!(activity_name(&waiting_robot), "sway");
    // The first step begins only after the pulses have settled.
    held_robot.expect_all_accepted(&["trim 1 15", "wander"]);
    held_robot.run_frames(10);
    assert_eq!(held_robot.status_value("gait"), "wander");
    press(&mut held_robot, NOSE, DEBOUNCE_FRAMES);
    assert_eq!(activity_name(&held_robot), "back");
}

#[test]
fn a_routine_that_ends_before_its_wait_is_printed_does_not_print_the_wait() {
    let steps = [
        (Step::FRAMES, "sway", 90),
        UNTIL_NOSE,
        (Step::CYCLES, "stray", 3),
    ];
    let mut robot = start_patrol(0, &steps);
    robot.run_without_reader(100 + LONG_FRAMES);
    assert_line_starts(&robot.run_frames(2), &["# held"]);
}

#[test]
fn a_routine_brakes_its_last_gait_before_it_is_done() {
    for steps in [
        &[(Step::FRAMES, "sway", 90)][..],
        &[UNTIL_NOSE, (Step::FRAMES, "sway", Step::ENDLESS)],
    ] {
        let mut robot = start_patrol(1, steps);
        robot.run_frames(90);
        set_contact(&mut robot, NOSE, true);
        assert_eq!(robot.run_frames(20), ["# done"]);
        assert_eq!(robot.status_value("gait"), "stop");
        let held_widths = run_frame_and_read_widths(&mut robot);
        assert!(robot.run_frames(LONG_FRAMES).is_empty());
        assert_eq!(run_frame_and_read_widths(&mut robot), held_widths);
    }
}

#[test]
fn a_routine_may_wait_once_and_repeat_only_the_later_steps() {
    let robot = Sample::asymmetric().with_routine("patrol", 3, &PATROL_STEPS);
    let robot = robot.with_changes(|content| {
        let routine = content.gaits.last_mut().expect("the robot has a routine");
        // The index of the step at which each round after the first begins.
        routine.channels[3].offset = 2;
    });
    let mut robot = wake_robot(robot);
    let printed_lines = robot.send_and_run("patrol", LONG_FRAMES);
    assert_eq!(printed_lines, ["# waiting for button"]);
    press(&mut robot, BUTTON, DEBOUNCE_FRAMES);
    for _ in 0..3 {
        assert_eq!(activity_name(&robot), "sway");
        assert_eq!(close_until_change(&mut robot, NOSE).1, "back");
        set_contact(&mut robot, NOSE, false);
        assert_eq!(run_until_change(&mut robot).1, "sway left");
        run_until_change(&mut robot);
    }
    assert_eq!(robot.status_value("gait"), "stop");
}
