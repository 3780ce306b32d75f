//! The gaits as the firmware holds them: waveforms of 128 samples that several
//! servos share, each servo with an offset and a gain.
//!
//! What a table means, and how it is read between its samples, is the core's:
//! [`lizard_core::gait`].

use lizard_avr::Flash;
use lizard_core::gait::{Channel, Gait as TableGait, MOST_WAVES, SAMPLES, Wave};
use lizard_core::units::{CYCLE, FRAMES_PER_SECOND as FRAMES};

use crate::gait::{Gait, Stride};
use crate::servo::FORWARD;
use crate::waveform::{Waveform, canonical};

/// Steps of an angle in one degree.
pub const STEPS_PER_DEGREE: f64 = 65536.0 / 360.0;
/// Frames of 20 ms in a second.
pub const FRAMES_PER_SECOND: f64 = FRAMES as f64;
/// 1.0 as a gain.
const ONE_Q14: f64 = 16384.0;
/// Two waveforms that differ by less than this (deg) share a table: a third of
/// an angle step.
const SAME: f64 = 0.002;

/// Everything the firmware needs to walk.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tables {
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
    /// The four sweeps of a gait (by its index) at a phase, angle steps,
    /// counter-clockwise positive.
    pub fn sweeps(&self, gait: usize, phase: u16) -> [i16; 4] {
        self.gaits[gait].channels.map(|channel| {
            let wave = Flash::from(&self.waves[usize::from(channel.wave)]);
            channel.sweep(wave, phase).0
        })
    }

    /// The four servo angles of a gait at a phase, deg, chassis frame.
    pub fn angles(&self, gait: &Gait, index: usize, phase: u16) -> [f64; 4] {
        let sweeps = self.sweeps(index, phase);
        std::array::from_fn(|i| gait.neutral[i] + f64::from(sweeps[i]) / STEPS_PER_DEGREE)
    }

    /// One cycle of a gait at full speed from phase 0 on: the time of each frame
    /// in s, and its phase. The last is the first that completes the cycle.
    pub fn frames(&self, gait: &Gait, index: usize) -> impl Iterator<Item = (f64, u16)> + use<> {
        let increment = self.gaits[index].increment;
        let frames = (gait.period * FRAMES_PER_SECOND).ceil() as i32;
        (0..=frames).map(move |frame| {
            let phase = (increment * frame) as u32 >> 8;
            (f64::from(frame) / FRAMES_PER_SECOND, phase as u16)
        })
    }

    /// Builds the tables, or names the first gait (by index) that the fixed point
    /// does not hold.
    pub(crate) fn new(gaits: &[Gait]) -> Result<Self, (usize, Unfit)> {
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
            bank
                .samples
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
                offset: (part.ahead.rem_euclid(1.0) * 65536.0).round() as u32 as u16,
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
