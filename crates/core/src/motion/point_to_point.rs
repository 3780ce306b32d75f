//! A point-to-point move along a straight line between two poses.
//!
//! All four servos start together, follow the same smoothstep and arrive together. The largest turn of any servo
//! determines the duration, so that no servo exceeds the slew limit. The top speed of a smoothstep is one and a half
//! times its mean speed.

use lizard_avr::{mul, mul_unsigned};

use crate::numbers::pose::Pose;
use crate::numbers::slew::Slew;

/// The shortest duration of a move, in frames, so that even a small correction is smooth. With eight frames, no move
/// changes a servo's speed faster than the gaits do.
const MIN_FRAMES: u16 = 8;

/// The full duration of a move, 1.0 in Q15.
const FULL_DURATION: u16 = 1 << 15;

/// A move in progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointToPointMove {
    from: Pose,
    to: Pose,
    /// The fraction of the move's duration that a frame at full pace covers, Q15.
    fraction_per_frame: u16,
    /// The elapsed fraction of the move's duration, Q15.
    elapsed_fraction: u16,
}

impl PointToPointMove {
    /// Creates a move between two poses.
    pub fn new(from: &Pose, to: &Pose, slew: Slew) -> Self {
        let distance = from.max_turn_to(to);
        let frames = (mul_unsigned(distance, slew.frames_per_distance) >> 16) as u16 + 1;
        Self {
            from: *from,
            to: *to,
            fraction_per_frame: FULL_DURATION / frames.max(MIN_FRAMES),
            elapsed_fraction: 0,
        }
    }

    /// The pose at the end of the move.
    pub const fn target(&self) -> &Pose {
        &self.to
    }

    /// Advances the move by a frame at `pace` (1024 is full pace).
    pub fn advance(&mut self, pace: u16) {
        let step = (mul_unsigned(self.fraction_per_frame, pace) >> 10) as u16;
        self.elapsed_fraction = (self.elapsed_fraction + step).min(FULL_DURATION);
    }

    /// True once the move has reached its target.
    pub const fn has_arrived(&self) -> bool {
        self.elapsed_fraction == FULL_DURATION
    }

    /// Computes the current pose of the move.
    pub fn pose(&self) -> Pose {
        if self.has_arrived() {
            return self.to;
        }
        let fraction = smoothstep(self.elapsed_fraction) as i16;
        let mut pose = self.from;
        for (sweep, target) in pose.0.iter_mut().zip(&self.to.0) {
            // Half the distance is multiplied and the product doubled, because a distance of more than half a turn
            // would overflow.
            let half_distance = (target.0 >> 1) - (sweep.0 >> 1);
            let distance = (mul(half_distance, fraction) + (1 << 13)) >> 14;
            sweep.0 = sweep.0.wrapping_add(distance as i16);
        }
        pose
    }
}

/// Computes the smoothstep `3 u^2 - 2 u^3`, Q15; `u` must be below 1.
fn smoothstep(u: u16) -> u16 {
    let squared = (mul_unsigned(u, u) >> 15) as u16;
    (mul_unsigned(squared, 3 * (FULL_DURATION / 2) - u) >> 14) as u16
}

#[cfg(test)]
mod tests {
    use std::format;
    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;
    use crate::numbers::units::Sweep;

    const FULL_PACE: u16 = 1024;

    fn to_pose(sweeps: [i16; 4]) -> Pose {
        Pose(sweeps.map(Sweep))
    }

    /// Computes the sweeps of one servo in each frame of a move at full pace, from its start on.
    fn compute_sweeps(from: i16, to: i16, slew: Slew) -> Vec<i16> {
        let [start, end] = [from, to].map(|sweep| to_pose([0, 0, sweep, 0]));
        let mut path = PointToPointMove::new(&start, &end, slew);
        let mut sweeps = Vec::from([from]);
        while !path.has_arrived() {
            path.advance(FULL_PACE);
            sweeps.push(path.pose().0[2].0);
            assert!(sweeps.len() < 4000, "{from} to {to} never ends");
        }
        sweeps
    }

    /// Computes the largest change from one frame to the next.
    fn compute_max_change(sweeps: &[i16]) -> Option<u16> {
        let changes = sweeps.windows(2).map(|pair| pair[1].abs_diff(pair[0]));
        changes.max()
    }

    /// Yields random slew limits from 10 to 1000 deg/s.
    fn any_slew() -> impl Strategy<Value = Slew> {
        (Slew::MIN_PER_FRAME..=3640).prop_map(Slew::new)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        #[test]
        fn a_move_arrives_within_the_slew_limit_and_without_delay(
            from: i16,
            to: i16,
            slew in any_slew(),
        ) {
            let sweeps = compute_sweeps(from, to, slew);
            prop_assert_eq!(sweeps.last(), Some(&to));
            let max_change = compute_max_change(&sweeps);
            prop_assert!(max_change <= Some(slew.per_frame), "{max_change:?} of {slew:?}");
            // A smoothstep takes one and a half times as long as a move at constant speed, and each frame covers a
            // multiple of 1/32768 of its duration.
            let frames = 1.5 * f64::from(from.abs_diff(to)) / f64::from(slew.per_frame - 6);
            let min_frames = frames.ceil().max(8.0) + 1.0;
            let max_frames = 32_768.0 / (32_768.0 / min_frames).floor() + 1.0;
            prop_assert!((sweeps.len() - 1) as f64 <= max_frames, "{} of {max_frames}", sweeps.len() - 1);
            prop_assert!(sweeps.len() > 8, "the move is too short");
        }

        #[test]
        fn all_servos_follow_the_same_smoothstep_straight_to_their_targets(
            from: [i16; 4],
            to: [i16; 4],
            slew in any_slew(),
        ) {
            let distances: [f64; 4] = core::array::from_fn(|n| f64::from(to[n]) - f64::from(from[n]));
            let [from, to] = [from, to].map(to_pose);
            let mut path = PointToPointMove::new(&from, &to, slew);
            let mut elapsed_fraction = 0.0;
            let mut turns = [0.0; 4];
            while !path.has_arrived() {
                path.advance(FULL_PACE);
                elapsed_fraction += f64::from(path.fraction_per_frame) / 32_768.0;
                let fraction = f64::min(elapsed_fraction, 1.0);
                let smooth_fraction = fraction * fraction * (3.0 - 2.0 * fraction);
                for (n, distance) in distances.iter().enumerate() {
                    let turn = f64::from(path.pose().0[n].0) - f64::from(from.0[n].0);
                    let error = turn - smooth_fraction * distance;
                    // Two roundings of the distance in Q15, and the halving of odd sweeps.
                    let rounding = 2.0 + distance.abs() / 8000.0;
                    prop_assert!(error.abs() <= rounding, "A{}: {error}", n + 1);
                    let progress = (turn - turns[n]) * distance.signum();
                    prop_assert!(progress >= -rounding, "A{}: {turn} after {}", n + 1, turns[n]);
                    turns[n] = turn;
                }
            }
            prop_assert_eq!(path.pose(), to);
        }

        #[test]
        fn a_move_at_any_pace_stays_on_its_line_and_within_the_slew_limit(
            from: [i16; 4],
            to: [i16; 4],
            slew in any_slew(),
            paces in prop::collection::vec(0..=FULL_PACE, 1..60),
        ) {
            let (start, end) = (to_pose(from), to_pose(to));
            let mut path = PointToPointMove::new(&start, &end, slew);
            let mut last_pose = start;
            for pace in paces {
                path.advance(pace);
                let current_pose = path.pose();
                prop_assert!(last_pose.max_turn_to(&current_pose) <= slew.per_frame);
                for n in 0..4 {
                    let (low, high) = (from[n].min(to[n]), from[n].max(to[n]));
                    let allowed_range = i32::from(low) - 1..=i32::from(high) + 1;
                    prop_assert!(allowed_range.contains(&i32::from(current_pose.0[n].0)));
                }
                last_pose = current_pose;
            }
        }
    }

    #[test]
    fn a_move_of_any_length_stays_within_every_slew_limit() {
        for slew in [Slew::MIN_PER_FRAME, 100, 1092, 3640].map(Slew::new) {
            for length in (0..=u16::MAX).step_by(251).chain([u16::MAX]) {
                let to = i16::MIN.wrapping_add(length as i16);
                let max_change = compute_max_change(&compute_sweeps(i16::MIN, to, slew));
                let case = format!("{length}: {max_change:?} of {slew:?}");
                assert!(max_change <= Some(slew.per_frame), "{case}");
            }
        }
    }

    #[test]
    fn a_move_to_the_current_pose_takes_eight_frames() {
        assert_eq!(compute_sweeps(77, 77, Slew::new(1000)), [77; 9]);
        let path = PointToPointMove::new(&to_pose([0; 4]), &to_pose([9; 4]), Slew::new(1000));
        let fraction = path.fraction_per_frame;
        assert_eq!(fraction, 32_768 / 8, "each frame covers an equal fraction");
    }

    #[test]
    fn a_pace_of_zero_stops_a_move() {
        let mut path = PointToPointMove::new(&to_pose([0; 4]), &to_pose([900; 4]), Slew::new(1000));
        path.advance(FULL_PACE);
        let held_pose = path.pose();
        path.advance(0);
        assert_eq!(path.pose(), held_pose);
        assert!(!path.has_arrived());
    }
}
