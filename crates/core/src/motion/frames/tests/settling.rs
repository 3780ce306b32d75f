//! Tests of settling, the gradual change of the pulses to the widths of a new calibration.

use std::collections::BTreeSet;

use super::*;

/// Recalibrates each servo so that its neutral pulse is 1000 cycles longer.
fn lengthen_neutral_pulses(motion: &mut Motion) {
    for (index, mut calibration) in motion.calibration.into_iter().enumerate() {
        calibration.neutral_width = PulseWidth(calibration.neutral_width.0 + 1000);
        motion.calibrate(Servo::at(index), calibration);
    }
}

#[test]
fn every_servo_settles_exactly_as_fast_as_its_gain_allows() {
    // The gains of this robot differ from servo to servo.
    let mut motion = Motion::standing();
    let pulses_before = motion.sent_pulses().0;
    let sweep_per_frame = f64::from(motion.robot.slew().per_frame);
    let max_changes = motion.calibration.map(|calibration| {
        // CPU cycles per frame at the slew limit, rounded down.
        (sweep_per_frame * f64::from(calibration.gain).abs() / 16_384.0).floor() as u16
    });
    let distinct_changes = BTreeSet::from(max_changes);
    assert_eq!(distinct_changes.len(), 4, "{max_changes:?}");
    lengthen_neutral_pulses(&mut motion);
    motion.settle();
    for frame in 1..=1000u16 {
        motion.advance_frame();
        for (index, sent_width) in motion.sent_pulses().0.iter().enumerate() {
            let change = sent_width.0 - pulses_before[index].0;
            let max_change = frame.saturating_mul(max_changes[index]);
            assert_eq!(change, max_change.min(1000), "A{}", index + 1);
        }
    }
}

#[test]
fn the_first_pulses_after_a_reset_repeat_the_last_pulses_despite_other_settings() {
    // The reset may have occurred after the last pulses were computed and before they were sent.
    let servo_state_before = *Motion::standing().servo_state();
    let mut motion = Motion::new(*Sample::asymmetric());
    lengthen_neutral_pulses(&mut motion);
    assert!(motion.resume(&servo_state_before, false));
    assert_eq!(motion.advance_frame(), servo_state_before.sent_pulses);
    let next_pulses = motion.advance_frame();
    assert!((0..4).all(|index| next_pulses.0[index].0 > servo_state_before.sent_pulses.0[index].0));
}
