//! The movement of each foot. A foot is never lifted, so only its direction of movement matters.

use simulated_uno::FREQUENCY;

use super::analysis::ServoFrame;
use super::frame::FRAME_CYCLES;

/// Highest angular rate of a leg whose foot counts as still, deg/s. A motion that starts or ends as a cubic or
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

/// A time span with one kind of movement of a foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootSpan {
    /// The kind of movement.
    pub phase: Phase,
    /// Start of the time span, s since power-on.
    pub start_s: f64,
    /// End of the time span, s since power-on.
    pub end_s: f64,
}

/// Lists the movements of a servo's foot in order of time; there is no span while the servo rests.
pub fn list_foot_spans(
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
        let (start_s, end_s) = (current.seconds, next.seconds);
        match spans.last_mut() {
            Some(last_span)
                if last_span.phase == phase && start_s - last_span.end_s < frame_s / 2.0 =>
            {
                last_span.end_s = end_s
            }
            _ => spans.push(FootSpan {
                phase,
                start_s,
                end_s,
            }),
        }
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;
    use lizard_robot::servo::FORWARD_TURN_SIGN;

    /// Creates five seconds of a gait and a second of rest.
    fn create_gait_frames(gait: &str) -> Vec<ServoFrame> {
        let robot = crate::shared::robot_args::built_in_robot("paper");
        let gait = robot.gait(gait).expect("the gait is in robot.toml");
        let neutral: [f64; 4] = robot.neutral_pose().into();
        (0..300)
            .map(|n| f64::from(n) / 50.0)
            .map(|seconds| {
                let angles = (seconds < 5.0).then(|| gait.angles(gait.phase_at(seconds)));
                let to_sweep =
                    |angles: [f64; 4], i: usize| (angles[i] - neutral[i]) * FORWARD_TURN_SIGN[i];
                ServoFrame {
                    seconds,
                    angles,
                    sweeps: angles.map(|angles| std::array::from_fn(|i| to_sweep(angles, i))),
                }
            })
            .collect()
    }

    /// Returns the movement of a servo's foot at a time in [`create_gait_frames`]; `None` while the robot rests.
    fn find_phase(gait: &str, servo: usize, seconds: f64) -> Option<Phase> {
        let spans = list_foot_spans(create_gait_frames(gait).into_iter(), servo);
        let mut spans = spans.iter();
        let span = spans.find(|span| (span.start_s..span.end_s).contains(&seconds));
        span.map(|span| span.phase)
    }

    #[test]
    fn feet_in_walk_are_in_stance_for_three_quarters_of_the_cycle() {
        for servo in 0..4 {
            let spans = list_foot_spans(create_gait_frames("walk").into_iter(), servo);
            let sum_seconds = |phase| {
                let phase_spans = spans.iter().filter(move |span| span.phase == phase);
                phase_spans
                    .map(|span| span.end_s.min(4.0) - span.start_s.max(1.0))
                    .filter(|seconds| *seconds > 0.0)
                    .sum::<f64>()
            };
            // In these three cycles, a foot is still only where it reverses.
            for (phase, expected) in [(Phase::Stance, 2.25), (Phase::Swing, 0.75)] {
                let seconds = sum_seconds(phase);
                assert!((seconds - expected).abs() < 0.13, "{phase:?} {seconds}");
            }
        }
    }

    #[test]
    fn turning_left_moves_the_left_feet_forward_and_the_right_feet_back() {
        // In the first fifth of `left`, all legs make their stroke together.
        let phases = [0, 1, 2, 3].map(|servo| find_phase("left", servo, 1.1));
        let [left, right] = [Some(Phase::Swing), Some(Phase::Stance)];
        assert_eq!(phases, [left, right, right, left]);
    }

    #[test]
    fn a_standing_foot_is_still_and_a_resting_foot_has_no_phase() {
        assert_eq!(find_phase("stand", 0, 2.0), Some(Phase::Still));
        assert_eq!(find_phase("walk", 0, 5.5), None);
    }
}
