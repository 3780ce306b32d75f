//! The pace of a motion, as a share of its full pace.
//!
//! A servo with a load cannot change its speed at once, so a motion speeds up when it begins and slows down before it
//! ends. The pace also sets a gait's speed in percent.

use lizard_avr::mul_unsigned;

/// Full pace, the largest value of a pace.
pub const FULL_PACE: u16 = 1024;

/// The change of the pace per frame. A motion gains or loses its full pace in seven frames, 0.14 s. With an odd
/// number of steps, a gait meanwhile covers the distance of a whole number of frames at full pace. Frames at full
/// pace then fall exactly on the corners between the gait's moves. If they were half a frame off, two legs would move
/// at once at each corner, and `crawl` would lose 1.2 % of its distance.
const PACE_STEP: u16 = FULL_PACE.div_ceil(7);

/// The pace one frame later, as it approaches `target`.
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
        for (from, to) in [(0, FULL_PACE), (FULL_PACE, 0)] {
            let (mut pace, mut sum) = (from, 0);
            while pace != to {
                pace = step_toward(pace, to);
                sum += pace;
            }
            let frames = f64::from(sum) / f64::from(FULL_PACE);
            assert!((frames - frames.round()).abs() < 0.02, "{frames}");
        }
    }

    #[test]
    fn a_speed_in_percent_rounds_to_the_nearest_pace() {
        for percent in 10..=100u8 {
            let exact = f64::from(percent) * 1024.0 / 100.0;
            // 2622/256 is 0.02 % more than `exact`; the result is rounded to nearest.
            let error = f64::from(of_percent(percent)) - exact * 1.000_214;
            assert!(error.abs() <= 0.501, "{percent}: {error}");
        }
    }
}
