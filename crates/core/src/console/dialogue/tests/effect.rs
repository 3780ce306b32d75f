//! The declared effect of each console word on the servos, compared with the observed one.

use super::*;
use crate::console::word::Effect;

/// Frames within which every effect is visible.
const FRAMES: usize = 40;

fn frames(robot: &mut Dialogue) -> Vec<[u16; 4]> {
    (0..FRAMES).map(|_| widths(robot)).collect()
}

/// Observes the effect of a line on a robot's pulses and calibration.
fn observe_effect(line: &str) -> Effect {
    let mut walking = wake_robot(Sample::paper());
    // With these settings `load` and `factory` change something.
    for setting in ["trim 2 3", "save", "trim 1 5", "sway"] {
        assert!(walking.send_line(setting).starts_with("ok "), "{setting}");
        walking.run_frames(60);
    }
    let mut unchanged = walking.clone();
    let mut still = walking.clone();
    still.send_line("stop");
    still.run_frames(60);
    still.send_line(line);
    assert!(walking.send_line(line).starts_with("ok "), "{line}");
    let [with, without, from_still] = [&mut walking, &mut unchanged, &mut still].map(frames);
    let is_constant = |frames: &[[u16; 4]]| frames[1..].iter().all(|frame| *frame == frames[1]);
    if with[FRAMES - 1] == [0; 4] {
        Effect::Rests
    } else if walking.motion().calibration() != unchanged.motion().calibration() {
        Effect::Calibrates
    } else if !is_constant(&from_still) {
        Effect::Moves
    } else if is_constant(&with) {
        Effect::Freezes
    } else if with != without {
        Effect::Paces
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
    for gait in GAITS {
        assert_eq!(command::effect(gait, &robot), Effect::Moves, "{gait}");
        assert_eq!(observe_effect(gait), Effect::Moves, "{gait}");
    }
    for line in ["", "pose", "pose 1", "nonsense", "sway now", "rest 1"] {
        assert_eq!(command::effect(line, &robot), Effect::None, "{line}");
    }
}
