//! Settings of the servos: set, saved, and restored.

use super::*;
use crate::memory::copies::COPIES;
use crate::memory::record::Progress;
use crate::numbers::part::Servo;
use crate::numbers::units::Sweep;

/// Sends `cal` and returns the lines of its answer.
fn read_cal(dialogue: &mut Dialogue) -> Vec<String> {
    dialogue.send(b"cal\r")
}

#[test]
fn cal_prints_all_settings_and_no_state() {
    let mut dialogue = wake_odd_robot();
    let initial_lines = read_cal(&mut dialogue);
    assert_eq!(initial_lines.len(), 7);
    assert!(initial_lines[0].starts_with("# A1 trim 0.00 limit 61.37 215.36 dir "));
    assert_eq!(
        initial_lines[4..],
        ["# boot stand", "# deadman 0", "ok cal"]
    );
    for line in [
        "trim 1 -3.25",
        "limit 2 350 130.5",
        "dir 3 -",
        "scale 4 9.87",
        "boot sway left",
        "deadman 1500",
    ] {
        dialogue.expect_accepted(line);
    }
    let printed_lines = read_cal(&mut dialogue);
    assert!(
        printed_lines[0].starts_with("# A1 trim -3.25 limit 61.37 215.36 dir "),
        "{printed_lines:?}"
    );
    assert!(
        printed_lines[1].starts_with("# A2 trim 0.00 limit 350.00 130.50 dir "),
        "{printed_lines:?}"
    );
    assert!(
        printed_lines[2].contains(" dir - scale "),
        "{printed_lines:?}"
    );
    assert!(
        printed_lines[3].ends_with(" scale 9.87"),
        "{printed_lines:?}"
    );
    assert_eq!(
        printed_lines[4..],
        ["# boot sway left", "# deadman 1500", "ok cal"]
    );
    dialogue.send_line("sway");
    dialogue.run_frames(77);
    assert_eq!(read_cal(&mut dialogue), printed_lines);
    dialogue.expect_accepted("factory");
    assert_eq!(read_cal(&mut dialogue), initial_lines);
}

#[test]
fn only_saved_settings_survive_power_off() {
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("trim 2 4");
    dialogue.expect_accepted("save");
    let saved_lines = read_cal(&mut dialogue);
    dialogue.send_line("trim 2 5");
    assert_ne!(read_cal(&mut dialogue), saved_lines);
    let mut restarted = Dialogue::with_memory(
        *Sample::odd(),
        dialogue.board.memory.clone(),
        Restart::default(),
    );
    assert_eq!(restarted.read_lines().len(), 1, "the banner alone");
    assert_eq!(read_cal(&mut restarted), saved_lines);
    // Also without a power cycle.
    dialogue.expect_accepted("load");
    assert_eq!(read_cal(&mut dialogue), saved_lines);
}

#[test]
fn load_before_the_first_save_and_a_worn_memory_are_refused() {
    let mut dialogue = wake_odd_robot();
    dialogue.expect_refused("load", "9 nothing is saved that could be loaded");
    dialogue.board.memory.is_worn = true;
    dialogue.expect_refused("save", "9 the memory does not keep what is written");
    dialogue.expect_accepted("stand");
}

#[test]
fn a_calibration_moves_only_its_servo_at_once_within_the_slew_limit() {
    for change in [
        "trim 1 20",
        "trim 1 -12.5",
        "scale 1 8",
        "dir 1 -",
        "dir 1 +",
        "load",
        "factory",
    ] {
        let mut dialogue = wake_odd_robot();
        if change == "factory" {
            dialogue.send_line("trim 1 15");
        }
        if change == "load" {
            dialogue.send_line("trim 1 -15");
            dialogue.send_line("save");
            dialogue.send_line("factory");
        }
        dialogue.run_frames(100);
        dialogue.send_line("pose 145 50 311 224.5");
        dialogue.run_frames(150);
        let widths_before = widths(&mut dialogue);
        dialogue.expect_accepted(change);
        let motion = dialogue.motion();
        let expected_widths = motion
            .pose()
            .pulses(motion.calibration())
            .0
            .map(|width| width.0);
        let gain = f64::from(motion.calibration()[0].gain).abs() / 16384.0;
        let max_change = f64::from(motion.robot().slew().per_frame) * gain;
        let mut last_widths = widths_before;
        for _ in 0..200 {
            let new_widths = widths(&mut dialogue);
            assert!(
                f64::from(new_widths[0].abs_diff(last_widths[0])) <= max_change.max(1.0),
                "{change}"
            );
            assert_eq!(new_widths[1..], widths_before[1..], "{change}");
            last_widths = new_widths;
        }
        assert_eq!(last_widths, expected_widths, "{change}");
        assert_eq!(dialogue.status("pose"), "145.00,50.00,311.00,224.50");
    }
}

#[test]
fn a_calibration_during_a_gait_halts_it_until_the_pulses_have_settled() {
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("sway");
    dialogue.run_frames(120);
    let phase_before = dialogue.motion().phase();
    dialogue.send_line("trim 2 15");
    dialogue.run_frames(1);
    assert_eq!(dialogue.motion().phase(), phase_before);
    dialogue.run_frames(200);
    assert_eq!(dialogue.status("gait"), "sway");
    assert_ne!(dialogue.motion().phase(), phase_before);
    let motion = dialogue.motion();
    let expected_pulses = motion.pose().pulses(motion.calibration());
    assert_eq!(motion.sent(), &expected_pulses);
}

#[test]
fn a_calibration_too_narrow_for_gaits_or_pose_is_refused_and_changes_nothing() {
    let mut dialogue = wake_odd_robot();
    let lines_before = read_cal(&mut dialogue);
    for line in [
        "limit 1 140 215",
        "limit 1 61.37 132",
        "limit 2 131 350",
        "limit 3 309 310",
    ] {
        let message = dialogue.send_line(line);
        assert!(message.starts_with("err 3 A"), "{line}: {message}");
        assert!(message.contains(" would not reach what the gaits need, "));
        assert_eq!(read_cal(&mut dialogue), lines_before);
    }
    dialogue.send_line("pose 150 47.91 309.64 226.18");
    dialogue.run_frames(2);
    let message = dialogue.send_line("limit 1 61.37 149");
    assert!(message.ends_with(" would not reach where it is or goes, send stand first"));
    assert_eq!(read_cal(&mut dialogue), lines_before);
    dialogue.send_line("stand");
    dialogue.run_frames(150);
    dialogue.expect_accepted("limit 1 61.37 149");
    dialogue.expect_refused("pose 150 47.91 309.64 226.18", "3 A1 reaches 61.37..149.00");
}

#[test]
fn a_factory_or_a_load_that_is_refused_changes_nothing() {
    let mut dialogue = wake_odd_robot();
    for line in [
        "trim 1 10",
        "limit 1 61.37 149",
        "save",
        "limit 1 61.37 215.36",
    ] {
        dialogue.expect_accepted(line);
    }
    dialogue.send_line("pose 155 47.91 309.64 226.18");
    dialogue.run_frames(150);
    let lines_before = read_cal(&mut dialogue);
    dialogue.expect_refused("load", "3 A1 would not reach where it is");
    assert_eq!(read_cal(&mut dialogue), lines_before);
    let mut other_dialogue = wake_odd_robot();
    other_dialogue.send_line("trim 3 4");
    let lines_before = read_cal(&mut other_dialogue);
    other_dialogue.board.memory.bytes_mut()[0] = 0;
    other_dialogue.expect_refused("load", "9 nothing is saved that could be loaded");
    assert_eq!(read_cal(&mut other_dialogue), lines_before);
    // Settings for other servos are not loaded, and the current ones stay.
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("save");
    other_dialogue.board.memory = dialogue.board.memory.clone();
    other_dialogue.board.memory.bytes_mut()[44] ^= 1;
    other_dialogue.expect_refused("load", "9 ");
    assert_eq!(read_cal(&mut other_dialogue), lines_before);
    // A trim moves the travel: the pose below is within the moved travel, but not within robot.toml's.
    let narrow_max = Sweep(2200);
    let robot = Sample::odd().with(|content| content.calibration[0].max = narrow_max);
    let mut narrow_dialogue = wake_robot(robot);
    narrow_dialogue.expect_accepted("trim 1 -5");
    narrow_dialogue.expect_accepted("limit 1 67 149");
    narrow_dialogue.run_frames(100);
    let pose = "pose 146 47.91 309.64 226.18";
    narrow_dialogue.expect_accepted(pose);
    narrow_dialogue.run_frames(150);
    let lines_before = read_cal(&mut narrow_dialogue);
    narrow_dialogue.expect_refused("factory", "3 A1 would not reach where it is");
    assert_eq!(read_cal(&mut narrow_dialogue), lines_before);
}

#[test]
fn settings_too_narrow_for_a_gait_are_not_loaded_and_change_nothing() {
    for servo in Servo::ALL {
        for (excess, is_loaded) in [(1, true), (-1, false)] {
            let mut dialogue = wake_odd_robot();
            let robot = Sample::odd();
            let mut settings = Settings::of(&robot);
            let mut adjustment = settings.servo(servo);
            adjustment.min = Sweep(robot.reach(servo).min.0 - excess);
            settings.set_servo(servo, adjustment);
            let mut writing = COPIES[0].start_write();
            while writing.step(settings.bytes(), &mut dialogue.board.memory) == Progress::InProgress
            {
            }
            let lines_before = read_cal(&mut dialogue);
            let answer = dialogue.send_line("load");
            let is_refused = answer == "err 9 nothing is saved that could be loaded";
            assert_eq!(is_refused, !is_loaded, "{servo:?}: {answer}");
            assert_eq!(
                read_cal(&mut dialogue) == lines_before,
                is_refused,
                "{servo:?}"
            );
        }
    }
}

#[test]
fn center_goes_to_the_neutral_pulses_of_robot_toml_with_any_trims() {
    let mut dialogue = wake_odd_robot();
    for line in ["trim 1 3", "trim 2 -4.5", "trim 3 2", "trim 4 -1"] {
        dialogue.send_line(line);
    }
    dialogue.run_frames(100);
    dialogue.expect_refused("center 1", "2 ");
    dialogue.expect_accepted("center");
    dialogue.run_frames(200);
    let neutral = Sample::odd().calibration().map(|servo| servo.neutral.0);
    for (width, neutral) in widths(&mut dialogue).into_iter().zip(neutral) {
        assert!(width.abs_diff(neutral) <= 1, "{width} {neutral}");
    }
    dialogue.send_line("stand");
    dialogue.run_frames(200);
    let motion = dialogue.motion();
    assert_eq!(motion.sent(), &Pose::NEUTRAL.pulses(motion.calibration()));
}

#[test]
fn a_boot_gait_is_the_one_that_was_named_however_alike_the_names_are() {
    let names = ["walk 1", "walk 2", "walk 3", "walk 4"];
    let make_robot = || {
        names
            .iter()
            .fold(Sample::odd(), |robot, name| robot.with_gait(name))
    };
    for name in names {
        let mut dialogue = Dialogue::power_on(*make_robot());
        dialogue.run_frames(30);
        assert_eq!(
            dialogue.send_line(&format!("boot {name}")),
            format!("ok boot {name}")
        );
        dialogue.expect_accepted("save");
        let memory = dialogue.board.memory.clone();
        let mut restarted = Dialogue::with_memory(*make_robot(), memory, Restart::NONE);
        restarted.run_frames(151);
        assert_eq!(restarted.status("gait"), name.replace(' ', "-"));
    }
}

#[test]
fn a_travel_that_was_saved_short_of_a_gait_is_not_used_whichever_servo_it_is() {
    for servo in Servo::ALL {
        let robot = Sample::odd();
        let mut settings = Settings::of(&robot);
        let mut adjustment = settings.servo(servo);
        adjustment.max = Sweep(robot.reach(servo).max.0 - 1);
        settings.set_servo(servo, adjustment);
        assert_eq!(settings.first_unfit_servo(&robot), Some(servo));
    }
}

#[test]
fn a_travel_may_not_end_before_a_pose_that_is_to_come_next() {
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("sway left");
    dialogue.run_frames(150);
    // The pose is far outside of all gaits. The gait brakes first, so the move to the pose has not begun yet.
    dialogue.expect_accepted("pose 152 50 311 224.5");
    dialogue.run_frames(2);
    let message = dialogue.send_line("limit 1 115 150");
    assert!(
        message.starts_with("err 3 A1 would not reach where it is"),
        "{message}"
    );
    dialogue.run_frames(300);
    assert_eq!(dialogue.status("pose"), "152.00,50.00,311.00,224.50");
    dialogue.send_line("stand");
    dialogue.run_frames(200);
    dialogue.expect_accepted("limit 1 115 150");
}

#[test]
fn after_a_calibration_a_gait_gathers_its_pace_again() {
    let mut dialogue = wake_odd_robot();
    dialogue.send_line("sway left");
    dialogue.run_frames(150);
    let full_advance = run_and_measure_phase(&mut dialogue);
    dialogue.send_line("trim 2 3");
    let mut advances = Vec::new();
    for _ in 0..100 {
        advances.push(run_and_measure_phase(&mut dialogue));
    }
    let first_moving = advances
        .iter()
        .position(|phase| *phase > 0)
        .expect("it goes on");
    assert!(
        first_moving > 0 && advances[first_moving] < full_advance / 4,
        "{advances:?}"
    );
    assert_eq!(advances.last(), Some(&full_advance));
}

/// The advance of the phase in a frame, 1/2^24 cycle.
fn run_and_measure_phase(dialogue: &mut Dialogue) -> u32 {
    let phase_before = dialogue.motion().phase();
    dialogue.frame();
    dialogue.motion().phase().wrapping_sub(phase_before) & 0xff_ffff
}
