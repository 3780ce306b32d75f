//! A test that compares the declared effect of each command word with its observed effect on the servos.

use super::*;
use crate::console::word::Effect;

/// The number of frames within which every effect is visible.
const FRAME_COUNT: usize = 40;

/// Runs [`FRAME_COUNT`] frames. Returns the pulse widths of each frame.
fn run_frames_and_read_widths(robot: &mut RunningRobot) -> [[u16; 4]; FRAME_COUNT] {
    [(); FRAME_COUNT].map(|()| run_frame_and_read_widths(robot))
}

/// Determines the effect of a line from the pulses and the calibration of robots that execute it.
fn observe_effect(line: &str) -> Effect {
    let mut walking_robot = wake_robot(Sample::paper());
    // These settings make `load` and `factory` change something.
    for setting in ["trim 2 3", "save", "trim 1 5", "sway"] {
        walking_robot.send_and_run(setting, 60);
    }
    let mut undisturbed_robot = walking_robot.clone();
    let mut standing_robot = walking_robot.clone();
    standing_robot.send_and_run("stop", 60);
    standing_robot.send_line(line);
    assert!(walking_robot.send_line(line).starts_with("ok "), "{line}");
    let walking_widths = run_frames_and_read_widths(&mut walking_robot);
    let undisturbed_widths = run_frames_and_read_widths(&mut undisturbed_robot);
    let standing_widths = run_frames_and_read_widths(&mut standing_robot);
    let is_constant = |frames: &[[u16; 4]]| frames[1..].iter().all(|frame| *frame == frames[1]);
    if walking_widths[FRAME_COUNT - 1] == [0; 4] {
        Effect::Rest
    } else if walking_robot.motion().calibration() != undisturbed_robot.motion().calibration() {
        Effect::CalibrationChange
    } else if !is_constant(&standing_widths) {
        Effect::Motion
    } else if is_constant(&walking_widths) {
        Effect::Freeze
    } else if walking_widths != undisturbed_widths {
        Effect::SpeedChange
    } else {
        Effect::None
    }
}

#[test]
fn every_word_and_every_gait_has_its_declared_effect() {
    let robot = Sample::paper();
    for word in Word::ALL {
        let line = word.example();
        assert_eq!(command::effect(line, &robot), word.effect(), "{line}");
        assert_eq!(observe_effect(line), word.effect(), "{line}");
    }
    for gait in GAIT_NAMES {
        assert_eq!(command::effect(gait, &robot), Effect::Motion, "{gait}");
        assert_eq!(observe_effect(gait), Effect::Motion, "{gait}");
    }
    for line in ["", "pose", "pose 1", "nonsense", "sway now", "rest 1"] {
        assert_eq!(command::effect(line, &robot), Effect::None, "{line}");
    }
}
