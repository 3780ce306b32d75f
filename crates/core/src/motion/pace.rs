//! The pace of a motion, as a share of its own full pace.
//!
//! A servo with a load cannot change its speed at once. A motion gathers pace when it
//! begins and loses it before it ends; a gait's pace is its speed in percent, too.

use lizard_avr::mul_unsigned;

/// Full pace, the largest value of a pace.
pub const FULL: u16 = 1024;

/// A motion gathers or loses all its pace in seven frames, 0.14 s. In an odd number of
/// steps a gait goes a whole number of its frames meanwhile, so that at full pace the
/// frames meet the corners between its moves: half a frame beside them, two legs would
/// move at once there, and `crawl` would lose 1.2 % of its distance.
const PACE_STEP: u16 = FULL.div_ceil(7);

/// The pace one frame later, on its way to `target`.
pub fn step_toward(pace: u16, target: u16) -> u16 {
    target
        .max(pace.saturating_sub(PACE_STEP))
        .min(pace + PACE_STEP)
}

/// Converts percent to a pace: 2622/256 is 1024/100 to four digits. The error is below one step,
/// so the slowest pace is right within one percent.
pub fn of_percent(percent: u8) -> u16 {
    ((mul_unsigned(u16::from(percent), 2622) + 128) >> 8) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gathering_and_losing_pace_take_whole_frames_of_a_gait() {
        for (from, to) in [(0, FULL), (FULL, 0)] {
            let (mut pace, mut sum) = (from, 0);
            while pace != to {
                pace = step_toward(pace, to);
                sum += pace;
            }
            let frames = f64::from(sum) / f64::from(FULL);
            assert!((frames - frames.round()).abs() < 0.02, "{frames}");
        }
    }

    #[test]
    fn a_speed_in_percent_rounds_to_the_nearest_pace() {
        for percent in 10..=100u8 {
            let exact = f64::from(percent) * 1024.0 / 100.0;
            // 2622/256 is 0.02 % more than that, and then to nearest.
            let error = f64::from(of_percent(percent)) - exact * 1.000_214;
            assert!(error.abs() <= 0.501, "{percent}: {error}");
        }
    }
}
