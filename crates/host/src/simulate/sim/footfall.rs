//! The movement of each foot. A foot is never lifted, so only the direction of its movement matters.

use simulated_uno::FREQUENCY;

use super::analysis::ServoFrame;
use super::frame::FRAME_CYCLES;

/// Angular rate of a leg, deg/s, below which its foot counts as still. A motion that starts or ends as a cubic or
/// smoothstep function passes this rate within a frame.
const MAX_STILL_RATE: f64 = 4.0;

/// The movement of a foot from one frame to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The foot moves back: in a forward gait it pushes the body forward.
    Stance,
    /// The foot moves forward.
    Swing,
    /// The foot stands still.
    Still,
}

/// A time span in which a foot keeps the same kind of movement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootSpan {
    /// The kind of movement.
    pub phase: Phase,
    /// The start of the time span, s since power-on.
    pub from: f64,
    /// The end of the time span, s since power-on.
    pub to: f64,
}

/// Lists the movements of a servo's foot in order of time, without a span while the servo rests.
pub fn foot_spans(
    servo_frames: impl Iterator<Item = ServoFrame> + Clone,
    servo: usize,
) -> Vec<FootSpan> {
    let frame_s = FRAME_CYCLES as f64 / FREQUENCY as f64;
    let mut spans: Vec<FootSpan> = Vec::new();
    for (current, next) in servo_frames.clone().zip(servo_frames.skip(1)) {
        let (Some(sweeps_before), Some(sweeps_after)) = (current.sweeps, next.sweeps) else {
            continue;
        };
        let rate = (sweeps_after[servo] - sweeps_before[servo]) / frame_s;
        let phase = if rate.abs() < MAX_STILL_RATE {
            Phase::Still
        } else if rate > 0.0 {
            Phase::Swing
        } else {
            Phase::Stance
        };
        let (from, to) = (current.seconds, next.seconds);
        match spans.last_mut() {
            Some(last_span) if last_span.phase == phase && from - last_span.to < frame_s / 2.0 => {
                last_span.to = to
            }
            _ => spans.push(FootSpan { phase, from, to }),
        }
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;
    use lizard_robot::servo::FORWARD_TURN_SIGN;

    /// Five seconds of a gait, then a second of rest.
    fn gait_frames(gait: &str) -> Vec<ServoFrame> {
        let robot = crate::shared::robot_file::built_in_robot("paper");
        let gait = robot.gait(gait).expect("the gait is in robot.toml");
        let neutral: [f64; 4] = robot.neutral_pose().into();
        (0..300)
            .map(|n| f64::from(n) / 50.0)
            .map(|seconds| {
                let angles = (seconds < 5.0).then(|| gait.angles(gait.phase_at(seconds)));
                let sweep_of =
                    |angles: [f64; 4], i: usize| (angles[i] - neutral[i]) * FORWARD_TURN_SIGN[i];
                ServoFrame {
                    seconds,
                    angles,
                    sweeps: angles.map(|angles| std::array::from_fn(|i| sweep_of(angles, i))),
                }
            })
            .collect()
    }

    /// The movement of a servo's foot at a time of [`gait_frames`]; `None` while the robot rests.
    fn phase_at(gait: &str, servo: usize, seconds: f64) -> Option<Phase> {
        let spans = foot_spans(gait_frames(gait).into_iter(), servo);
        let span = spans
            .iter()
            .find(|span| (span.from..span.to).contains(&seconds));
        span.map(|span| span.phase)
    }

    #[test]
    fn in_walk_every_foot_is_in_stance_three_quarters_of_the_time_and_in_swing_the_rest() {
        for servo in 0..4 {
            let spans = foot_spans(gait_frames("walk").into_iter(), servo);
            let seconds_in = |phase| {
                let phase_spans = spans.iter().filter(move |span| span.phase == phase);
                phase_spans
                    .map(|span| span.to.min(4.0) - span.from.max(1.0))
                    .filter(|seconds| *seconds > 0.0)
                    .sum::<f64>()
            };
            // In these three cycles a foot is still only where it reverses.
            assert!(
                (seconds_in(Phase::Stance) - 2.25).abs() < 0.13,
                "{}",
                seconds_in(Phase::Stance)
            );
            assert!(
                (seconds_in(Phase::Swing) - 0.75).abs() < 0.13,
                "{}",
                seconds_in(Phase::Swing)
            );
        }
    }

    #[test]
    fn turning_left_moves_the_left_feet_forward_and_the_right_feet_back() {
        // In the first fifth of `left` all legs make their stroke together.
        let phases = [0, 1, 2, 3].map(|servo| phase_at("left", servo, 1.1));
        let [left, right] = [Some(Phase::Swing), Some(Phase::Stance)];
        assert_eq!(phases, [left, right, right, left]);
    }

    #[test]
    fn a_standing_foot_is_still_and_a_resting_foot_has_no_phase() {
        assert_eq!(phase_at("stand", 0, 2.0), Some(Phase::Still));
        assert_eq!(phase_at("walk", 0, 5.5), None);
    }
}
