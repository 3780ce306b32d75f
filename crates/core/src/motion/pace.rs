//! The pace of a motion: its speed as a fraction of its full speed.
//!
//! A servo with a load cannot change its speed at once. Therefore a motion accelerates from a pace of 0 and brakes to a
//! pace of 0. The user sets the speed of gaits as a pace in percent.

use lizard_avr::mul_unsigned;

/// Full pace, the largest value of a pace.
pub const FULL_PACE: u16 = 1024;

/// The change of the pace per frame. A motion gains or loses its full pace in seven frames, 0.14 s. Because this number
/// is odd, a gait meanwhile covers the phase of a whole number of frames at full pace. Therefore later frames coincide
/// with the corners of the waveforms, between the swings of two legs. With a difference of half a frame, both legs
/// would move at the same time at each corner, and `crawl` would lose 1.2 % of its distance.
const PACE_STEP: u16 = FULL_PACE.div_ceil(7);

/// Returns the pace one frame later on the way to `target`.
pub fn step_toward(pace: u16, target: u16) -> u16 {
    target
        .max(pace.saturating_sub(PACE_STEP))
        .min(pace + PACE_STEP)
}

/// Converts percent to a pace. The factor 2622/256 is 0.02 % more than 1024/100, so the error is below one step of the
/// pace and, at the lowest pace of 10 %, below one percent of it.
pub fn from_percent(percent: u8) -> u16 {
    ((mul_unsigned(u16::from(percent), 2622) + 128) >> 8) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn acceleration_and_braking_cover_a_whole_number_of_frames_at_full_pace() {
        for (from, to) in [(0, FULL_PACE), (FULL_PACE, 0)] {
            let (mut pace, mut pace_sum) = (from, 0);
            while pace != to {
                pace = step_toward(pace, to);
                pace_sum += pace;
            }
            let full_pace_frames = f64::from(pace_sum) / f64::from(FULL_PACE);
            let error = full_pace_frames - full_pace_frames.round();
            assert!(error.abs() < 0.02, "{full_pace_frames}");
        }
    }

    #[test]
    fn a_speed_in_percent_is_converted_to_the_nearest_pace() {
        for percent in 10..=100u8 {
            let exact = f64::from(percent) * 1024.0 / 100.0;
            // 2622/256 is 0.02 % more than `exact`; the result is rounded to nearest.
            let error = f64::from(from_percent(percent)) - exact * 1.000_214;
            assert!(error.abs() <= 0.501, "{percent}: {error}");
        }
    }
}
