//! Tests of routines, which are sequences of steps, and of the events that end them early.

use super::*;

/// The steps of a routine, each with its kind, its gait and its count of cycles or frames. Two consecutive steps have
/// the gait `sway`, and the robot rests after them.
const PATROL_STEPS: [(u8, &str, u16); 6] = [
    (FRAMES, "stand", 30),
    (CYCLES, "sway", 2),
    (CYCLES, "sway", 1),
    (REST, "stand", 50),
    (FRAMES, "back", 60),
    (CYCLES, "sway left", 1),
];

/// More frames than one round of the routine takes.
const LONG_FRAMES: u32 = 1_500;

/// Builds the asymmetric robot with the routine `patrol`, which repeats its steps `rounds` times, or endlessly if that
/// is 0.
fn robot_with_routine(rounds: u16) -> Sample {
    Sample::asymmetric().with_routine("patrol", rounds, &PATROL_STEPS)
}

/// Runs a robot for `frames` frames. Returns the sequence of its activities and the printed lines.
fn run_and_record_activities(dialogue: &mut Dialogue, frames: u32) -> (Vec<String>, Vec<String>) {
    let (mut activities, mut printed_lines): (Vec<String>, Vec<String>) = Default::default();
    for _ in 0..frames {
        printed_lines.extend(dialogue.run_frames(1));
        let activity = activity_name(dialogue);
        if activities.last() != Some(&activity) {
            activities.push(activity);
        }
    }
    (activities, printed_lines)
}

/// Starts the routine. Returns clones of the dialogue at many times during the routine, in some of which it rests.
fn record_snapshots() -> Vec<Dialogue> {
    let mut dialogue = start_patrol(0, &PATROL_STEPS);
    let mut snapshots = Vec::new();
    for _ in 0..40 {
        dialogue.run_frames(17);
        snapshots.push(dialogue.clone());
    }
    let is_resting = |snapshot: &Dialogue| snapshot.motion().is_resting();
    assert!(snapshots.iter().any(is_resting));
    snapshots
}

/// Checks that a robot that now rests has saved its pose: after a loss of power it wakes in this pose.
fn assert_rest_pose_is_saved(mut dialogue: Dialogue, event: &str) {
    let pose = *dialogue.motion().pose();
    if dialogue.motion().is_resting() {
        dialogue.cycle_power(None);
        dialogue.run_frames(1);
        assert_eq!(*dialogue.motion().pose(), pose, "{event}");
    }
}

#[test]
fn a_routine_executes_its_steps_in_order_and_prints_done_once() {
    for rounds in [1, 2, 3] {
        let mut dialogue = wake_robot(robot_with_routine(rounds));
        assert_eq!(dialogue.send_line("Patrol"), "ok patrol");
        assert_eq!(dialogue.status_value("gait"), "patrol");
        let (gaits, printed_lines) =
            run_and_record_activities(&mut dialogue, LONG_FRAMES * u32::from(rounds));
        assert_eq!(printed_lines, ["# done"]);
        let mut expected_gaits =
            ["stand", "sway", "Rest", "back", "sway left"].repeat(rounds.into());
        expected_gaits.push("Stop");
        assert_eq!(gaits, expected_gaits);
        assert_eq!(dialogue.status_value("gait"), "stop");
    }
}

#[test]
fn a_count_limits_the_rounds_of_an_endless_routine() {
    let mut counted_dialogue = wake_robot(robot_with_routine(0));
    counted_dialogue.send_line("patrol 2");
    let (gaits, printed_lines) = run_and_record_activities(&mut counted_dialogue, 3 * LONG_FRAMES);
    assert_eq!(printed_lines, ["# done"]);
    assert_eq!(gaits.iter().filter(|gait| *gait == "back").count(), 2);
    let mut endless_dialogue = start_patrol(0, &PATROL_STEPS);
    let (gaits, printed_lines) = run_and_record_activities(&mut endless_dialogue, 20 * LONG_FRAMES);
    assert!(printed_lines.is_empty(), "{printed_lines:?}");
    assert!(gaits.iter().filter(|gait| *gait == "back").count() > 20);
}

#[test]
fn a_timed_step_lasts_its_number_of_frames() {
    let mut dialogue = start_patrol(1, &PATROL_STEPS);
    let (gaits, _) = run_and_record_activities(&mut dialogue, 29);
    assert_eq!(gaits, ["stand"]);
    let (gaits, _) = run_and_record_activities(&mut dialogue, 1);
    assert_eq!(gaits, ["sway"]);
}

#[test]
fn help_boot_and_cal_treat_a_routine_as_a_gait() {
    let mut dialogue = wake_robot(robot_with_routine(1));
    assert!(dialogue.send(b"help\r")[0].ends_with("|stray|patrol"));
    dialogue.expect_accepted("boot patrol");
    let printed_lines = dialogue.send(b"cal\r");
    assert!(printed_lines.contains(&"# boot patrol".to_string()));
    dialogue.expect_accepted("save");
    let mut unattended_dialogue = dialogue.power_on_copy();
    let printed_lines = unattended_dialogue.run_frames(150);
    let last_line = printed_lines.last().map(String::as_str);
    assert_eq!(last_line, Some("# boot: patrol"));
    assert_eq!(unattended_dialogue.status_value("gait"), "patrol");
    dialogue.send_line("rest");
    dialogue.expect_refused("patrol", "7 the servos are resting; send stand first");
}

#[test]
fn whatever_stops_or_moves_the_robot_ends_a_routine_at_any_of_its_steps() {
    for snapshot in record_snapshots() {
        for line in ["stop", "rest", "stand", "sway", "back 1", NEUTRAL_COMMAND] {
            let mut dialogue = snapshot.clone();
            dialogue.expect_accepted(line);
            let (gaits, printed_lines) = run_and_record_activities(&mut dialogue, 600);
            assert!(gaits.len() <= 2, "{line}: {gaits:?}");
            let line_count = usize::from(line == "back 1");
            assert_eq!(printed_lines.len(), line_count, "{line}: {printed_lines:?}");
            assert_ne!(dialogue.status_value("gait"), "patrol");
            assert_rest_pose_is_saved(dialogue, line);
        }
        let mut repeated_dialogue = snapshot.clone();
        repeated_dialogue.send_line("patrol");
        let (gaits, _) = run_and_record_activities(&mut repeated_dialogue, 30);
        assert_eq!(gaits.last().map(String::as_str), Some("sway"));
        let mut low_supply_dialogue = snapshot.clone();
        low_supply_dialogue.run_at_supply(4_200, 60);
        assert_eq!(low_supply_dialogue.status_value("fault"), "supply");
        set_supply(&mut low_supply_dialogue, 5_000);
        let (gaits, _) = run_and_record_activities(&mut low_supply_dialogue, 300);
        let has_ended = gaits == ["Stop"] || gaits == ["Rest"];
        assert!(has_ended, "the routine continues by itself: {gaits:?}");
        assert_rest_pose_is_saved(low_supply_dialogue, "a low supply");
        let mut failing_supply_dialogue = snapshot.clone();
        failing_supply_dialogue.run_at_supply(3_900, 60);
        assert_eq!(failing_supply_dialogue.status_value("gait"), "rest");
        for cause in [Cause::External, Cause::BrownOut, Cause::Watchdog] {
            let mut reset_dialogue = snapshot.clone();
            reset_dialogue.reset(cause);
            let (gaits, printed_lines) = run_and_record_activities(&mut reset_dialogue, 400);
            // A robot that rested rests until `boot` makes it stand.
            let is_ended = |gait: &String| ["stand", "Stop", "Rest"].contains(&gait.as_str());
            assert!(gaits.iter().all(is_ended), "{cause:?}: {gaits:?}");
            assert!(!printed_lines.contains(&"# done".to_string()));
        }
    }
}

#[test]
fn a_low_supply_slows_a_routine_without_ending_it() {
    let mut dialogue = wake_robot(robot_with_routine(1));
    dialogue.run_at_supply(4_400, 40);
    assert_eq!(dialogue.send_and_run("patrol", 2 * LONG_FRAMES), ["# done"]);
}

#[test]
fn the_guard_ends_a_routine_as_it_ends_a_gait() {
    let mut dialogue = start_patrol(0, &[(CYCLES, "stray", 3), (CYCLES, "sway", 1)]);
    let (gaits, printed_lines) = run_and_record_activities(&mut dialogue, LONG_FRAMES);
    assert_eq!(gaits, ["stray", "Stop"]);
    assert_line_starts(&printed_lines, &["# held"]);
    assert_eq!(dialogue.status_value("fault"), "guard");
}

#[test]
fn silence_ends_a_routine_that_a_command_began_but_not_one_that_boot_began() {
    for mut dialogue in record_snapshots() {
        let notice = "# fault: no command within the deadman time, stopped";
        assert_eq!(dialogue.send_and_run("deadman 200", 100), [notice]);
        let gait = dialogue.status_value("gait");
        assert!(["stop", "rest"].contains(&gait.as_str()), "{gait}");
        assert_rest_pose_is_saved(dialogue, "silence");
    }
    let mut dialogue = wake_robot(robot_with_routine(0));
    dialogue.expect_all_accepted(&["boot patrol", "deadman 200", "save"]);
    let mut unattended_dialogue = dialogue.power_on_copy();
    unattended_dialogue.run_frames(150);
    let mut idle_dialogue = unattended_dialogue.clone();
    let printed_lines = idle_dialogue.run_frames(5 * LONG_FRAMES);
    assert!(printed_lines.is_empty(), "the routine continues");
    // The first valid line starts the `deadman` timeout.
    assert_eq!(idle_dialogue.send_and_run("speed 90", 100).len(), 1);
    assert_eq!(idle_dialogue.status_value("fault"), "link");
    // Neither single bytes nor an invalid line starts the `deadman` timeout.
    unattended_dialogue.board.send(b"x");
    assert!(unattended_dialogue.run_frames(LONG_FRAMES).is_empty());
    unattended_dialogue.board.send(b"x\r");
    let printed_lines = unattended_dialogue.run_frames(100);
    assert_eq!(printed_lines.len(), 1, "only the error is printed");
}

#[test]
fn after_a_rest_in_a_routine_the_servos_wake_one_by_one() {
    let steps = [
        (CYCLES, "sway", 1),
        (REST, "stand", 50),
        (FRAMES, "stand", 100),
    ];
    let mut dialogue = start_patrol(2, &steps);
    let (mut frames_without_pulses, mut pulsing_counts) = (0, Vec::new());
    let mut printed_lines = Vec::new();
    for _ in 0..LONG_FRAMES {
        printed_lines.extend(dialogue.run_frames(1));
        let pulses = dialogue.board.submitted_pulses().0;
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
fn a_routine_that_ends_with_a_rest_saves_its_rest_pose() {
    let mut dialogue = start_patrol(2, &[(CYCLES, "sway", 1), (REST, "stand", 50)]);
    assert_eq!(dialogue.run_frames(LONG_FRAMES), ["# done"]);
    assert!(dialogue.motion().is_resting());
    assert_rest_pose_is_saved(dialogue, "the last round");
}
