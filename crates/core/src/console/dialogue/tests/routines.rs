//! Tests of routines, which are sequences of steps, and of the events that end them early.

use std::collections::BTreeSet;

use super::*;

/// The steps of a routine, each with its kind, its gait and its count of cycles or frames. Two consecutive steps have
/// the gait `sway`, and the robot rests after them.
const PATROL_STEPS: [(u8, &str, u16); 6] = [
    (Step::FRAMES, "stand", 30),
    (Step::CYCLES, "sway", 2),
    (Step::CYCLES, "sway", 1),
    (Step::REST, "stand", 50),
    (Step::FRAMES, "back", 60),
    (Step::CYCLES, "sway left", 1),
];

/// More frames than one round of the routine takes.
const LONG_FRAMES: u32 = 1_500;

/// Builds the asymmetric robot with the routine `patrol`, which executes its steps for `round_count` rounds, or
/// endlessly if that is 0.
fn build_patrol_robot(round_count: u16) -> Sample {
    Sample::asymmetric().with_routine("patrol", round_count, &PATROL_STEPS)
}

/// Runs a robot for `frames` frames. Returns the sequence of its activities and the printed lines.
fn record_activities(robot: &mut RunningRobot, frames: u32) -> (Vec<String>, Vec<String>) {
    let (mut activities, mut printed_lines): (Vec<String>, Vec<String>) = Default::default();
    for _ in 0..frames {
        printed_lines.extend(robot.run_frames(1));
        let activity = activity_name(robot);
        if activities.last() != Some(&activity) {
            activities.push(activity);
        }
    }
    (activities, printed_lines)
}

/// Starts the routine. Returns clones of the robot at many times during the routine, in some of which it rests.
fn record_snapshots() -> Vec<RunningRobot> {
    let mut robot = start_patrol(0, &PATROL_STEPS);
    let mut snapshots = Vec::new();
    for _ in 0..40 {
        robot.run_frames(17);
        snapshots.push(robot.clone());
    }
    let is_resting = |snapshot: &RunningRobot| snapshot.motion().is_resting();
    assert!(snapshots.iter().any(is_resting));
    snapshots
}

/// Checks that a robot, if it rests now, has saved its pose: after a loss of power it wakes in this pose. Returns true
/// if the robot rests.
fn check_rest_pose_if_resting(mut robot: RunningRobot, event: &str) -> bool {
    let pose = *robot.motion().pose();
    let is_resting = robot.motion().is_resting();
    if is_resting {
        robot.cycle_power(None);
        robot.run_frames(1);
        assert_eq!(*robot.motion().pose(), pose, "{event}");
    }
    is_resting
}

#[test]
fn a_routine_executes_its_steps_in_order_and_prints_done_once() {
    for round_count in [1, 2, 3] {
        let mut robot = wake_robot(build_patrol_robot(round_count));
        assert_eq!(robot.send_line("Patrol"), "ok patrol");
        assert_eq!(robot.status_value("gait"), "patrol");
        let (activities, printed_lines) =
            record_activities(&mut robot, LONG_FRAMES * u32::from(round_count));
        assert_eq!(printed_lines, ["# done"]);
        let mut expected_activities =
            ["stand", "sway", "Rest", "back", "sway left"].repeat(round_count.into());
        expected_activities.push("Stop");
        assert_eq!(activities, expected_activities);
        assert_eq!(robot.status_value("gait"), "stop");
    }
}

#[test]
fn a_count_limits_the_rounds_of_an_endless_routine() {
    let mut counted_robot = wake_robot(build_patrol_robot(0));
    counted_robot.send_line("patrol 2");
    let (activities, printed_lines) = record_activities(&mut counted_robot, 3 * LONG_FRAMES);
    assert_eq!(printed_lines, ["# done"]);
    assert_eq!(activities.iter().filter(|gait| *gait == "back").count(), 2);
    let mut endless_robot = start_patrol(0, &PATROL_STEPS);
    let (activities, printed_lines) = record_activities(&mut endless_robot, 20 * LONG_FRAMES);
    assert!(printed_lines.is_empty(), "{printed_lines:?}");
    assert!(activities.iter().filter(|gait| *gait == "back").count() > 20);
}

#[test]
fn a_timed_step_lasts_its_number_of_frames() {
    let mut robot = start_patrol(1, &PATROL_STEPS);
    let (activities, _) = record_activities(&mut robot, 29);
    assert_eq!(activities, ["stand"]);
    let (activities, _) = record_activities(&mut robot, 1);
    assert_eq!(activities, ["sway"]);
}

#[test]
fn help_boot_and_cal_treat_a_routine_as_a_gait() {
    let mut robot = wake_robot(build_patrol_robot(1));
    assert!(robot.send(b"help\r")[0].ends_with("|stray|patrol"));
    robot.expect_accepted("boot patrol");
    assert!(robot.send(b"cal\r").contains(&"# boot patrol".to_string()));
    robot.expect_accepted("save");
    let mut unattended_robot = robot.power_on_copy();
    let printed_lines = unattended_robot.run_frames(150);
    let last_line = printed_lines.last().map(String::as_str);
    assert_eq!(last_line, Some("# boot: patrol"));
    assert_eq!(unattended_robot.status_value("gait"), "patrol");
    robot.send_line("rest");
    robot.expect_refused("patrol", "7 the servos are resting; send stand first");
}

#[test]
fn whatever_stops_or_moves_the_robot_ends_a_routine_at_any_of_its_steps() {
    let mut events_before_rest = BTreeSet::new();
    for snapshot in record_snapshots() {
        for line in ["stop", "rest", "stand", "sway", "back 1", NEUTRAL_COMMAND] {
            let mut robot = snapshot.clone();
            robot.expect_accepted(line);
            let (activities, printed_lines) = record_activities(&mut robot, 600);
            assert!(activities.len() <= 2, "{line}: {activities:?}");
            let line_count = usize::from(line == "back 1");
            assert_eq!(printed_lines.len(), line_count, "{line}: {printed_lines:?}");
            assert_ne!(robot.status_value("gait"), "patrol");
            if check_rest_pose_if_resting(robot, line) {
                events_before_rest.insert(line);
            }
        }
        let mut repeated_robot = snapshot.clone();
        repeated_robot.send_line("patrol");
        let (activities, _) = record_activities(&mut repeated_robot, 30);
        assert_eq!(activities.last().map(String::as_str), Some("sway"));
        let mut low_supply_robot = snapshot.clone();
        low_supply_robot.run_at_supply(4_200, 60);
        assert_eq!(low_supply_robot.status_value("fault"), "supply");
        set_board_supply(&mut low_supply_robot, 5_000);
        let (activities, _) = record_activities(&mut low_supply_robot, 300);
        let has_ended = activities == ["Stop"] || activities == ["Rest"];
        assert!(has_ended, "the routine continues by itself: {activities:?}");
        if check_rest_pose_if_resting(low_supply_robot, "a low supply") {
            events_before_rest.insert("a low supply");
        }
        let mut failing_supply_robot = snapshot.clone();
        failing_supply_robot.run_at_supply(3_900, 60);
        assert_eq!(failing_supply_robot.status_value("gait"), "rest");
        for cause in [Cause::External, Cause::BrownOut, Cause::Watchdog] {
            let mut reset_robot = snapshot.clone();
            reset_robot.reset(cause);
            let (activities, printed_lines) = record_activities(&mut reset_robot, 400);
            // A robot that rested rests until `boot` makes it stand.
            let is_after_end = |gait: &String| ["stand", "Stop", "Rest"].contains(&gait.as_str());
            assert!(
                activities.iter().all(is_after_end),
                "{cause:?}: {activities:?}"
            );
            assert!(!printed_lines.contains(&"# done".to_string()));
        }
    }
    assert!(
        events_before_rest
            .into_iter()
            .eq(["a low supply", "rest", "stop"])
    );
}

#[test]
fn a_supply_that_only_slows_gaits_does_not_end_a_routine() {
    let mut robot = wake_robot(build_patrol_robot(1));
    robot.run_at_supply(4_400, 40);
    assert_eq!(robot.send_and_run("patrol", 2 * LONG_FRAMES), ["# done"]);
}

#[test]
fn the_guard_ends_a_routine_as_it_ends_a_gait() {
    let mut robot = start_patrol(0, &[(Step::CYCLES, "stray", 3), (Step::CYCLES, "sway", 1)]);
    let (activities, printed_lines) = record_activities(&mut robot, LONG_FRAMES);
    assert_eq!(activities, ["stray", "Stop"]);
    assert_line_starts(&printed_lines, &["# held"]);
    assert_eq!(robot.status_value("fault"), "guard");
}

#[test]
fn silence_ends_a_routine_that_a_command_began_but_not_one_that_boot_began() {
    let mut has_rested = false;
    for mut robot in record_snapshots() {
        let notice = "# fault: no command within the deadman time, stopped";
        assert_eq!(robot.send_and_run("deadman 200", 100), [notice]);
        let gait = robot.status_value("gait");
        assert!(["stop", "rest"].contains(&gait.as_str()), "{gait}");
        has_rested |= check_rest_pose_if_resting(robot, "silence");
    }
    assert!(has_rested);
    let mut robot = wake_robot(build_patrol_robot(0));
    robot.expect_all_accepted(&["boot patrol", "deadman 200", "save"]);
    let mut unattended_robot = robot.power_on_copy();
    unattended_robot.run_frames(150);
    let mut idle_robot = unattended_robot.clone();
    let printed_lines = idle_robot.run_frames(5 * LONG_FRAMES);
    assert!(
        printed_lines.is_empty(),
        "the first command starts the deadman time, not boot: {printed_lines:?}"
    );
    // The first valid line starts the `deadman` timeout.
    assert_eq!(idle_robot.send_and_run("speed 90", 100).len(), 1);
    assert_eq!(idle_robot.status_value("fault"), "link");
    // Neither single bytes nor an invalid line starts the `deadman` timeout.
    unattended_robot.board.send(b"x");
    assert!(unattended_robot.run_frames(LONG_FRAMES).is_empty());
    unattended_robot.board.send(b"x\r");
    let printed_lines = unattended_robot.run_frames(100);
    assert_eq!(printed_lines.len(), 1, "only the error is printed");
}

#[test]
fn after_a_rest_in_a_routine_the_servos_wake_one_by_one() {
    let steps = [
        (Step::CYCLES, "sway", 1),
        (Step::REST, "stand", 50),
        (Step::FRAMES, "stand", 100),
    ];
    let mut robot = start_patrol(2, &steps);
    let (mut frames_without_pulses, mut pulsing_counts) = (0, Vec::new());
    let mut printed_lines = Vec::new();
    for _ in 0..LONG_FRAMES {
        printed_lines.extend(robot.run_frames(1));
        let pulses = robot.board.submitted_pulses().0;
        let count = pulses.iter().filter(|width| width.0 > 0).count();
        frames_without_pulses += usize::from(count == 0);
        if pulsing_counts.last() != Some(&count) {
            pulsing_counts.push(count);
        }
    }
    assert_eq!(printed_lines, ["# done"]);
    assert_eq!(pulsing_counts, [4, 0, 1, 2, 3, 4, 0, 1, 2, 3, 4]);
    // Each of the two rests takes 50 frames; the first servo wakes five frames later.
    let is_expected = (100..=112).contains(&frames_without_pulses);
    assert!(is_expected, "{frames_without_pulses}");
}

#[test]
fn the_saved_rest_pose_is_invalid_once_a_routine_started_by_boot_wakes_the_servos() {
    let steps = [(Step::REST, "stand", 50), (Step::CYCLES, "sway", 1)];
    let mut robot = wake_robot(Sample::asymmetric().with_routine("patrol", 1, &steps));
    robot.expect_all_accepted(&["boot patrol", "save", "rest"]);
    robot.run_frames(50);
    assert_eq!(rest_pose_mark(&robot), 0xa5);
    robot.reset(Cause::External);
    robot.run_frames(220);
    assert!(!robot.motion().is_resting());
    assert_eq!(rest_pose_mark(&robot), 0xff);
}

#[test]
fn a_routine_that_ends_with_a_rest_saves_its_rest_pose() {
    let mut robot = start_patrol(2, &[(Step::CYCLES, "sway", 1), (Step::REST, "stand", 50)]);
    assert_eq!(robot.run_frames(LONG_FRAMES), ["# done"]);
    assert!(robot.motion().is_resting());
    check_rest_pose_if_resting(robot, "the last round");
}
