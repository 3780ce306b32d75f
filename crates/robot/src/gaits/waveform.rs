//! The shape of one leg's sweep over a cycle. Feet are never lifted: their pads drag, and the robot walks because
//! three feet hold while one returns. A wave is therefore a slow stance, in which the foot moves back, and a fast swing
//! forward, which join without a step in speed. In a held gait, all feet move back together, and then forward one after
//! the other.
//!
//! A waveform maps the phase (one cycle = 1) to -1..1, foot forward = 1.

use crate::gaits::path_sweep::PathSweep;

/// The fraction of the cycle that each of the five moves of a held gait takes.
const MOVE_FRACTION: f64 = 0.2;

/// A function of the phase with values from -1 to 1, except for [`Waveform::Path`].
#[derive(Debug, Clone, PartialEq)]
pub enum Waveform {
    /// A leg that does not move.
    Still,
    /// A linear stance over `duty` of the cycle, then a cubic Hermite swing that has the stance's speed at both ends.
    /// The swing's peak is 1.
    Wave {
        /// The duty factor: the stance's fraction of the cycle, 0 to 1.
        duty: f64,
    },
    /// A smoothstep back in the first fifth of the cycle, the stance common to all legs, and a smoothstep forward in
    /// one of the other four fifths, this leg's swing. In the remaining fifths the leg holds.
    Held {
        /// Index of this leg's swing among the four, 0 to 3.
        swing_index: usize,
    },
    /// A leg whose servo follows a path of the head or tail point. The value is the sweep itself in degrees, so the
    /// amplitude is 1.
    Path(Box<PathSweep>),
}

impl Waveform {
    /// The value at any `phase`, taken modulo 1.
    pub fn value_at(&self, phase: f64) -> f64 {
        let u = phase.rem_euclid(1.0);
        match self {
            Self::Still => 0.0,
            Self::Wave { duty } => wave_value(u, *duty),
            Self::Held { swing_index } => held_value(u, *swing_index),
            Self::Path(leg) => leg.sweep(u),
        }
    }
}

/// The value at phase u of a wave with duty factor beta (`duty`). The stance is 1 - 2u/beta. The swing is the Hermite
/// cubic in t = (u - beta)/(1 - beta) from -1 to 1, with the stance's slope m = -2 (1 - beta)/beta at both ends. Since
/// the foot keeps its speed at both ends, it overshoots a little before it reverses (by 1.4 % at beta = 0.75). Both
/// parts are therefore divided by the cubic's peak, and the amplitude includes the overshoot.
fn wave_value(u: f64, duty: f64) -> f64 {
    let m = -2.0 * (1.0 - duty) / duty;
    let shape = if u < duty {
        1.0 - 2.0 * u / duty
    } else {
        hermite((u - duty) / (1.0 - duty), m)
    };
    // The cubic is odd about t = 1/2, so its first turning point is its peak.
    let (a, b) = (6.0 * m - 12.0, 12.0 - 6.0 * m);
    let turning_point = (-b + (b * b - 4.0 * a * m).sqrt()) / (2.0 * a);
    shape / -hermite(turning_point, m)
}

/// The Hermite cubic from -1 at t = 0 to 1 at t = 1, with slope m at both ends.
fn hermite(t: f64, m: f64) -> f64 {
    2.0 * smoothstep(t) - 1.0 + m * t * (1.0 - t) * (1.0 - 2.0 * t)
}

/// The value of a held waveform at phase u.
fn held_value(u: f64, swing_index: usize) -> f64 {
    let start = MOVE_FRACTION * (swing_index + 1) as f64;
    1.0 - 2.0 * smoothstep(u / MOVE_FRACTION) + 2.0 * smoothstep((u - start) / MOVE_FRACTION)
}

/// The smoothstep t^2 (3 - 2t) for t from 0 to 1; 0 before, 1 after.
fn smoothstep(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Reduces a waveform to a waveform with its own table: `value_at(u) = sign * base.value_at(u - shift)`. Returns base,
/// shift and sign.
///
/// The held waveforms of the first and the last swing are each other's negative with a phase shift, and so are the
/// waveforms of the second and the third swing. Two tables are therefore enough for all four.
pub(crate) fn canonicalize(waveform: &Waveform) -> (Waveform, f64, f64) {
    match waveform {
        Waveform::Held { swing_index } if *swing_index >= 2 => (
            Waveform::Held {
                swing_index: 3 - swing_index,
            },
            MOVE_FRACTION * (swing_index + 1) as f64,
            -1.0,
        ),
        canonical => (canonical.clone(), 0.0, 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All held waveforms, and waves of several duty factors.
    fn all_waveforms() -> Vec<Waveform> {
        let held = (0..4).map(|swing_index| Waveform::Held { swing_index });
        let waves = [0.5, 0.75, 0.875].map(|duty| Waveform::Wave { duty });
        held.chain(waves).collect()
    }

    #[test]
    fn every_waveform_is_continuous_and_reaches_1_and_minus_1() {
        for waveform in all_waveforms() {
            let samples = (0..=10_000).map(|i| waveform.value_at(f64::from(i) / 1e4));
            let samples: Vec<f64> = samples.collect();
            let mut steps = samples.windows(2).map(|pair| (pair[0] - pair[1]).abs());
            assert!(steps.all(|step| step < 3e-3), "{waveform:?} jumps");
            let max = samples.iter().fold(f64::MIN, |a, b| a.max(*b));
            let min = samples.iter().fold(f64::MAX, |a, b| a.min(*b));
            let is_full = (max - 1.0).abs() < 1e-5 && (min + 1.0).abs() < 1e-5;
            assert!(is_full, "{waveform:?}");
        }
    }

    #[test]
    fn a_wave_has_equal_speed_on_both_sides_of_each_corner() {
        let step = 1e-6;
        for duty in [0.5, 0.75, 0.875] {
            let waveform = Waveform::Wave { duty };
            let stance_speed = (waveform.value_at(duty) - waveform.value_at(0.0)) / duty;
            for corner in [0.0, duty] {
                for start in [corner - step, corner] {
                    let speed = (waveform.value_at(start + step) - waveform.value_at(start)) / step;
                    let error = (speed - stance_speed).abs();
                    assert!(error < 1e-3, "duty {duty}, from {start} at corner {corner}");
                }
            }
        }
    }

    #[test]
    fn a_wave_starts_its_stance_just_below_its_peak() {
        // For a duty factor of 3/4, a numerical search finds the turning point at t = 0.0435645 with the value
        // -1.0143010.
        assert!((Waveform::Wave { duty: 0.75 }.value_at(0.0) - 1.0 / 1.014_301_03).abs() < 1e-7);
    }

    #[test]
    fn a_held_leg_swings_only_in_its_own_fifth_of_the_cycle() {
        for swing_index in 0..4 {
            let waveform = Waveform::Held { swing_index };
            let start = 0.2 * (swing_index + 1) as f64;
            for i in 0..=1000 {
                let u = i as f64 / 1e3 * 0.999_999;
                if u < 0.2 || (u > start && u < start + 0.2) {
                    continue;
                }
                let expected = if u <= start { -1.0 } else { 1.0 };
                let error = waveform.value_at(u) - expected;
                assert!(error.abs() < 1e-12, "swing {swing_index}, phase {u}");
            }
            for middle in [0.1, start + 0.1] {
                assert!(waveform.value_at(middle).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_canonical_waveform_reproduces_the_original() {
        for waveform in all_waveforms() {
            let (base, shift, sign) = canonicalize(&waveform);
            for i in 0..1000 {
                let u = i as f64 / 1e3;
                let error = waveform.value_at(u) - sign * base.value_at(u - shift);
                assert!(error.abs() < 1e-12, "{waveform:?} at {u}");
            }
        }
    }
}
