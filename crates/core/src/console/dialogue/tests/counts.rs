//! Tests of counted gaits, which end after a number of cycles, and of the events that end them early.

use super::*;

/// Enough frames for the move to `sway`, three of its cycles, and the braking.
const LONG_FRAMES: u32 = 400;

#[test]
fn a_counted_gait_prints_done_at_its_end_and_holds_its_last_pose() {
    for name in ["sway", "sway left", "back"] {
        let mut robot = wake_and_send(&[&format!("{name}  2")]);
        assert_eq!(robot.status_value("gait"), name.replace(' ', "-"));
        assert_eq!(robot.run_frames(LONG_FRAMES), ["# done"]);
        robot.expect_status(&[("gait", "stop"), ("fault", "none")]);
        let held_pulses = robot.run_frame();
        assert!(robot.run_frames(LONG_FRAMES).is_empty());
        assert_eq!(robot.run_frame(), held_pulses);
    }
    let mut robot = wake_asymmetric_robot();
    let is_endless = robot.send_and_run("sway", 5 * LONG_FRAMES).is_empty();
    assert!(is_endless, "a gait without a count does not end");
}

#[test]
fn a_wrong_count_is_refused_and_changes_nothing() {
    let mut robot = wake_asymmetric_robot();
    for line in ["sway 0", "sway 1000", "sway 2x", "sway 1 1"] {
        robot.expect_refused(line, "2 a gait takes a count, 1..999");
        assert_eq!(robot.status_value("gait"), "stand");
    }
    robot.send_line("rest");
    robot.expect_refused("sway 3", "7 the servos are resting; send stand first");
    assert_eq!(robot.send_line("stand 1"), "ok stand 1");
}

#[test]
fn another_motion_a_fault_or_a_reset_ends_a_counted_gait_without_printing_done() {
    let start_counted_gait = || wake_and_run("sway 2", 30);
    for line in ["stop", "rest", "stand", NEUTRAL_COMMAND, "sway"] {
        let mut robot = start_counted_gait();
        assert!(robot.send_and_run(line, LONG_FRAMES).is_empty(), "{line}");
    }
    let mut silent_robot = start_counted_gait();
    let printed_lines = silent_robot.send_and_run("deadman 100", LONG_FRAMES);
    assert_line_starts(&printed_lines, &["# fault: no command"]);
    let mut low_supply_robot = start_counted_gait();
    let printed_lines = low_supply_robot.run_at_supply(4_200, LONG_FRAMES);
    let is_done = printed_lines.iter().any(|line| line == "# done");
    assert!(!is_done, "{printed_lines:?}");
    assert_eq!(low_supply_robot.status_value("fault"), "supply");
    for cause in [Cause::External, Cause::BrownOut, Cause::Watchdog] {
        let mut reset_robot = wake_and_run("sway 2", 60);
        reset_robot.reset(cause);
        let printed_lines = reset_robot.run_frames(LONG_FRAMES);
        let is_done = printed_lines.iter().any(|line| line == "# done");
        assert!(!is_done, "{cause:?}: {printed_lines:?}");
        let gait = reset_robot.status_value("gait");
        assert!(["stand", "stop"].contains(&gait.as_str()), "{cause:?}");
    }
    let printed_lines = wake_asymmetric_robot().send_and_run("stray 9", 5 * LONG_FRAMES);
    assert_line_starts(&printed_lines, &["# held"]);
}

#[test]
fn a_low_supply_slows_a_counted_gait_without_ending_it() {
    let count_frames_until_done = |supply_mv| {
        let mut robot = wake_asymmetric_robot();
        robot.run_at_supply(supply_mv, 40);
        robot.send_line("sway 2");
        (1..2_000_u32)
            .find(|_| robot.run_frames(1) == ["# done"])
            .expect("the gait ends")
    };
    let [full_frames, slow_frames] = [5_000, 4_400].map(count_frames_until_done);
    // An upper bound, because a lower pace lengthens the cycles but hardly the acceleration and the braking.
    let max_frames = full_frames * 100 / u32::from(SLOW_PACE);
    assert!(
        slow_frames > u32::midpoint(full_frames, max_frames) && slow_frames < max_frames,
        "{full_frames} frames, {slow_frames} on a low supply"
    );
}
