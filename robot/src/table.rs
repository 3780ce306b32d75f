//! The gaits as the firmware holds them: waveforms of 128 samples that several
//! servos share, each servo with an offset and a gain.
//!
//! What a table means, and how it is read between its samples, is the core's:
//! [`lizard_core::gait`].

use lizard_core::gait::{Channel, Gait as TableGait, MOST_WAVES, SAMPLES, Wave};
use lizard_core::units::CYCLE;

use crate::gait::{Gait, Stride};
use crate::servo::FORWARD;
use crate::units::{FRAMES_PER_SECOND, ONE_Q14, PHASES, STEPS_PER_DEGREE};
use crate::waveform::{Waveform, canonical};

/// Two waveforms that differ by less than this (deg) share a table: a third of
/// an angle step.
const SAME: f64 = 0.002;

/// Everything the firmware needs to walk.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Tables {
    /// Waveforms, angle steps at gain 1.
    pub waves: Vec<Wave>,
    /// Gaits in the order of the file.
    pub gaits: Vec<TableGait>,
    /// Their names one after the other, words with a blank in between.
    pub names: Vec<u8>,
}

/// Why a gait has no table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unfit {
    /// The sweep of a servo (by its index) is half a turn or more.
    HalfTurn(usize),
    /// The gaits so far share as many waveforms as there may be.
    Waves,
}

impl Tables {
    /// Builds the tables, or names the first gait (by index) that the fixed point
    /// does not hold.
    pub fn new(gaits: &[Gait]) -> Result<Self, (usize, Unfit)> {
        let mut bank = Bank::default();
        let mut parts = Vec::new();
        for (g, gait) in gaits.iter().enumerate() {
            for (s, stride) in gait.strides.iter().enumerate() {
                let part = bank.find(stride, FORWARD[s]);
                parts.push(part.ok_or((g, Unfit::HalfTurn(s)))?);
            }
            if bank.samples.len() > MOST_WAVES {
                return Err((g, Unfit::Waves));
            }
        }
        let largest = bank.largest(&parts);
        if bank.samples.is_empty() {
            // A robot that only stands still reads one table, of zeros.
            bank.samples.push([0.0; SAMPLES]);
        }
        let waves =
            bank.samples
                .iter()
                .zip(largest.iter().chain([&1.0]))
                .map(|(samples, largest)| {
                    samples.map(|value| (value * largest * STEPS_PER_DEGREE).round() as i16)
                });
        let channel = |part: &Part| {
            let gain = part.amplitude / largest.get(part.wave).copied().unwrap_or(1.0);
            Channel {
                wave: part.wave as u8,
                // A shift of a whole cycle is none: the cast to u16 wraps.
                offset: (part.ahead.rem_euclid(1.0) * PHASES).round() as u32 as u16,
                gain: (gain * ONE_Q14).round() as i16,
            }
        };
        let mut names = Vec::new();
        let mut table = Vec::new();
        for (gait, parts) in gaits.iter().zip(parts.chunks(4)) {
            table.push(TableGait {
                name_start: names.len() as u16,
                name_length: gait.name.len() as u8,
                increment: increment(gait),
                channels: [&parts[0], &parts[1], &parts[2], &parts[3]].map(channel),
            });
            names.extend(gait.name.replace('-', " ").bytes());
        }
        Ok(Self {
            waves: waves.collect(),
            gaits: table,
            names,
        })
    }
}

/// Advance of the phase in one frame, 1/2^24 cycle.
fn increment(gait: &Gait) -> i32 {
    let step = (f64::from(CYCLE) / (FRAMES_PER_SECOND * gait.period)).round() as i32;
    if gait.reversed { -step } else { step }
}

/// A stride as amplitude times a waveform of the bank.
struct Part {
    wave: usize,
    /// Cycles by which it reads ahead.
    ahead: f64,
    /// deg, counter-clockwise positive.
    amplitude: f64,
}

/// The waveforms so far, each scaled to a largest value of 1.
#[derive(Default)]
struct Bank {
    samples: Vec<[f64; SAMPLES]>,
}

impl Bank {
    /// Finds or adds the waveform of a stride; `forward` is the sense in which
    /// the servo moves its foot forward. None if it sweeps half a turn.
    fn find(&mut self, stride: &Stride, forward: f64) -> Option<Part> {
        let (waveform, shift, sign) = canonical(&stride.waveform);
        let samples: [f64; SAMPLES] =
            std::array::from_fn(|i| waveform.at(i as f64 / SAMPLES as f64));
        let peak = samples
            .iter()
            .fold(0.0f64, |peak, value| peak.max(value.abs()));
        let amplitude = stride.amplitude * peak * sign * forward;
        if amplitude == 0.0 || waveform == Waveform::Still {
            return Some(Part {
                wave: 0,
                ahead: 0.0,
                amplitude: 0.0,
            });
        }
        if amplitude.abs() >= 180.0 {
            return None;
        }
        let ahead = -stride.start - shift;
        let samples = samples.map(|value| value / peak);
        let found = self.samples.iter().enumerate().find_map(|(wave, known)| {
            let rotation = same(known, &samples, SAME / amplitude.abs())?;
            Some(Part {
                wave,
                ahead: ahead + rotation as f64 / SAMPLES as f64,
                amplitude,
            })
        });
        Some(found.unwrap_or_else(|| {
            self.samples.push(samples);
            Part {
                wave: self.samples.len() - 1,
                ahead,
                amplitude,
            }
        }))
    }

    /// The largest amplitude that is asked of each waveform, deg. Tables are
    /// stored at that size, so that no gain exceeds 1.
    fn largest(&self, parts: &[Part]) -> Vec<f64> {
        let of = |wave| {
            parts
                .iter()
                .filter(|p| p.wave == wave)
                .fold(0.0f64, |most, p| most.max(p.amplitude.abs()))
        };
        (0..self.samples.len()).map(of).collect()
    }
}

/// The rotation by which `known` gives `samples` within `tolerance`.
fn same(known: &[f64; SAMPLES], samples: &[f64; SAMPLES], tolerance: f64) -> Option<usize> {
    (0..SAMPLES).find(|rotation| {
        (0..SAMPLES).all(|i| (samples[i] - known[(i + rotation) % SAMPLES]).abs() <= tolerance)
    })
}
