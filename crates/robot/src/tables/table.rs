//! The gaits in the firmware's form: waveforms of 64 samples that several servos share, each servo with its own offset
//! and gain.
//!
//! The core defines the form of the tables in [`lizard_core::numbers::gaits`], and the interpolation between their
//! samples in [`Channel::sweep`].

use lizard_avr::Flash;
use lizard_core::numbers::gaits::{Channel, Gait as TableGait, MAX_WAVES, SAMPLES_PER_WAVE, Wave};
use lizard_core::numbers::units::CYCLE;

use crate::config::servo::{FORWARD_TURN_SIGN, SERVO_NAMES};
use crate::file::{Error, ReadResult};
use crate::gaits::{Gait, Stride, Waveform, canonicalize, to_command};
use crate::units::{FRAMES_PER_SECOND, ONE_Q14, PHASE_STEPS_PER_CYCLE, STEPS_PER_DEGREE};

/// Largest difference between two waveforms that share one table, deg: about a third of an angle step.
const SHARED_WAVE_TOLERANCE_DEG: f64 = 0.002;

/// The samples of a waveform over a cycle.
type Samples = [f64; SAMPLES_PER_WAVE];

/// The tables of waveforms and gaits that the firmware reads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Tables {
    /// Waveforms, in angle steps at gain 1.
    pub waves: Vec<Wave>,
    /// Gaits in the order of the file.
    pub gaits: Vec<TableGait>,
    /// Names of the gaits, concatenated, with spaces between words.
    pub names: Vec<u8>,
}

impl Tables {
    /// Builds the tables of these gaits.
    ///
    /// # Errors
    /// Fails at the first gait that sweeps a servo by half a turn or more, or that needs more than [`MAX_WAVES`]
    /// waveforms.
    pub fn new(gaits: &[Gait]) -> ReadResult<Self> {
        let (mut waves, mut stored_strides) = (Vec::new(), Vec::new());
        for gait in gaits {
            for ((stride, forward_sign), name) in
                gait.strides.iter().zip(FORWARD_TURN_SIGN).zip(SERVO_NAMES)
            {
                let Some(stored_stride) = store_stride(&mut waves, stride, forward_sign) else {
                    let consequence =
                        format!("servo {name} would have to turn farther than it can");
                    let problem = "its sweep is half a turn or more";
                    return Err(Error::in_gait(&gait.name, &consequence, problem));
                };
                stored_strides.push(stored_stride);
            }
            if waves.len() > MAX_WAVES {
                let message = format!(
                    "needs more than the {MAX_WAVES} waveforms that the firmware supports; gaits that differ only in amplitude, start, gain, period or direction share a waveform"
                );
                return Err(Error::new(format!("gait.{}", gait.name), message));
            }
        }
        let peak_amplitudes = find_peak_amplitudes(waves.len(), &stored_strides);
        if waves.is_empty() {
            // A robot that only stands still needs a single table, of zeros.
            waves.push([0.0; SAMPLES_PER_WAVE]);
        }
        let scaled_waves = waves.iter().zip(peak_amplitudes.iter().chain([&1.0]));
        let table_waves = scaled_waves.map(|(samples, peak)| {
            samples.map(|value| (value * peak * STEPS_PER_DEGREE).round() as i16)
        });
        let build_channel = |stride: &StoredStride| {
            let peak = peak_amplitudes.get(stride.wave_index).unwrap_or(&1.0);
            let gain = stride.amplitude / peak;
            Channel {
                wave: stride.wave_index as u16,
                // A shift of one full cycle wraps to 0.
                offset: (stride.lead.rem_euclid(1.0) * PHASE_STEPS_PER_CYCLE).round() as u32 as u16,
                gain: (gain * ONE_Q14).round() as i16,
            }
        };
        let mut names = Vec::new();
        let mut table_gaits = Vec::new();
        for (gait, gait_strides) in gaits.iter().zip(stored_strides.chunks(4)) {
            table_gaits.push(TableGait {
                name_start: names.len() as u16,
                name_length: gait.name.len() as u16,
                increment: compute_increment(gait),
                channels: std::array::from_fn(|servo| build_channel(&gait_strides[servo])),
            });
            names.extend(to_command(&gait.name).bytes());
        }
        Ok(Self {
            waves: table_waves.collect(),
            gaits: table_gaits,
            names,
        })
    }

    /// Returns the sweeps from neutral of the gait with this index at a phase in 1/65536 cycle: in angle steps,
    /// positive counter-clockwise, servo order.
    pub fn sweeps(&self, gait_index: usize, phase: u16) -> [i16; 4] {
        self.gaits[gait_index].channels.map(|channel| {
            let wave = Flash::from(&self.waves[usize::from(channel.wave)]);
            channel.sweep(wave, phase).0
        })
    }
}

/// Computes a gait's phase increment per frame, in 1/2^24 cycle; negative if the gait is reversed.
fn compute_increment(gait: &Gait) -> i32 {
    let increment = (f64::from(CYCLE) / (FRAMES_PER_SECOND * gait.period)).round() as i32;
    if gait.is_reversed {
        -increment
    } else {
        increment
    }
}

/// A stride in the firmware's form: a waveform times an amplitude, with a lead.
struct StoredStride {
    /// Index of the waveform.
    wave_index: usize,
    /// Lead of the stride over the stored waveform, cycles.
    lead: f64,
    /// Amplitude, deg, positive counter-clockwise.
    amplitude: f64,
}

/// Finds the waveform of a stride among `waves`, each scaled to a peak of 1, or adds it. `forward_sign` is the
/// direction in which the servo moves its foot forward: 1 for counter-clockwise, -1 for clockwise. `None` if the stride
/// sweeps half a turn or more.
fn store_stride(
    waves: &mut Vec<Samples>,
    stride: &Stride,
    forward_sign: f64,
) -> Option<StoredStride> {
    let (waveform, shift, sign) = canonicalize(&stride.waveform);
    let samples = sample_waveform(&waveform);
    let peak = find_peak(&samples);
    let amplitude = stride.amplitude * peak * sign * forward_sign;
    if amplitude == 0.0 || waveform == Waveform::Still {
        return Some(StoredStride {
            wave_index: 0,
            lead: 0.0,
            amplitude: 0.0,
        });
    }
    if amplitude.abs() >= 180.0 {
        return None;
    }
    let offset = -stride.start - shift;
    let samples = samples.map(|value| value / peak);
    let tolerance = SHARED_WAVE_TOLERANCE_DEG / amplitude.abs();
    let shared_wave = waves.iter().enumerate().find_map(|(index, existing)| {
        find_rotation(existing, &samples, tolerance).map(|rotation| (index, rotation))
    });
    let (wave_index, rotation) = shared_wave.unwrap_or_else(|| {
        waves.push(samples);
        (waves.len() - 1, 0)
    });
    Some(StoredStride {
        wave_index,
        lead: offset + rotation as f64 / SAMPLES_PER_WAVE as f64,
        amplitude,
    })
}

/// Finds the largest amplitude with which each waveform is used, deg. A waveform is stored with this amplitude, so that
/// no gain exceeds 1.
fn find_peak_amplitudes(wave_count: usize, stored_strides: &[StoredStride]) -> Vec<f64> {
    let mut peak_amplitudes = vec![0.0f64; wave_count];
    for stride in stored_strides {
        if let Some(peak) = peak_amplitudes.get_mut(stride.wave_index) {
            *peak = peak.max(stride.amplitude.abs());
        }
    }
    peak_amplitudes
}

/// Samples a waveform so that the straight lines between the samples have zero mean error.
///
/// A line between two points of a curve lies on the curve's concave side, so samples on the curve would make every
/// stride too short (the paper's walk by 1 %). Each sample is therefore moved outward by the mean distance between line
/// and curve, which is a twelfth of the second difference. No sample is moved beyond the waveform's peak, because a
/// servo's travel may end at the peak.
fn sample_waveform(waveform: &Waveform) -> Samples {
    let curve: Samples =
        std::array::from_fn(|i| waveform.value_at(i as f64 / SAMPLES_PER_WAVE as f64));
    let peak = find_peak(&curve);
    std::array::from_fn(|i| {
        let (previous, next) = (
            curve[(i + SAMPLES_PER_WAVE - 1) % SAMPLES_PER_WAVE],
            curve[(i + 1) % SAMPLES_PER_WAVE],
        );
        let outward_shift = -(previous - 2.0 * curve[i] + next) / 12.0;
        (curve[i] + outward_shift).clamp(-peak, peak)
    })
}

/// Finds the largest magnitude among the samples.
fn find_peak(samples: &Samples) -> f64 {
    let larger_magnitude = |peak: f64, value: &f64| peak.max(value.abs());
    samples.iter().fold(0.0, larger_magnitude)
}

/// Finds the number of samples by which to rotate `existing` so that it equals `samples` within `tolerance`.
fn find_rotation(existing: &Samples, samples: &Samples, tolerance: f64) -> Option<usize> {
    (0..SAMPLES_PER_WAVE).find(|rotation| {
        (0..SAMPLES_PER_WAVE)
            .all(|i| (samples[i] - existing[(i + rotation) % SAMPLES_PER_WAVE]).abs() <= tolerance)
    })
}

#[cfg(test)]
mod tests {
    use lizard_core::numbers::gaits::{Gait as TableGait, GaitId};

    use crate::robot::STAND;
    use crate::testing::{
        all_robots, assert_starts_with, error_with, for_each_gait, robot, text_before_gaits,
        valid_robot_with,
    };
    use crate::{CheckedGait, Robot};

    /// Number of waveforms in a robot's tables.
    fn wave_count(robot: &Robot) -> usize {
        robot.firmware().waves().len()
    }

    #[test]
    fn a_reversed_gait_has_the_same_channels_and_a_negative_increment() {
        let robot = robot("own-gaits");
        let table_gait = |name: &str| core_gait(&robot, robot.gait(name).expect(name));
        for (forward, backward) in [("stroll", "stroll-back"), ("veer-right", "veer-right-back")] {
            let (forward, backward) = (table_gait(forward), table_gait(backward));
            assert_eq!(forward.channels, backward.channels);
            assert!(forward.increment > 0);
            assert_eq!(forward.increment, -backward.increment);
        }
        let (stroll_on, stroll) = (table_gait("stroll-on"), table_gait("stroll"));
        assert_eq!(stroll_on.channels, stroll.channels);
        // 1.28 s are 64 frames: 2^24 / 64.
        assert_eq!(stroll_on.increment, 262_144);
    }

    #[test]
    fn the_increments_of_a_period_add_up_to_one_cycle() {
        for_each_gait(|label, robot, gait| {
            let increment = core_gait(robot, gait).increment;
            let frames = 50.0 * gait.period();
            let error = f64::from(increment.abs()) * frames - f64::from(1 << 24);
            assert!(error.abs() <= 0.5 * frames, "{label}");
            assert_eq!(increment < 0, gait.is_reversed());
        });
    }

    /// The id of a gait of a robot.
    fn gait_id(robot: &Robot, gait: &CheckedGait) -> GaitId {
        let mut ids = GaitId::all(robot.gaits().len());
        ids.nth(gait.index()).expect("the gait exists")
    }

    /// The core's record of a gait.
    fn core_gait(robot: &Robot, gait: &CheckedGait) -> TableGait {
        robot.firmware().gait(gait_id(robot, gait))
    }

    #[test]
    fn gait_names_in_the_core_have_spaces_instead_of_hyphens() {
        for_each_gait(|label, robot, gait| {
            let console_name = robot.firmware().gait_name(gait_id(robot, gait));
            let console_name = String::from_utf8(console_name.collect());
            assert_eq!(console_name, Ok(gait.command()), "{label}");
        });
    }

    #[test]
    fn a_leg_that_starts_later_lags_by_the_difference_of_the_starts() {
        let robot = robot("paper");
        let walk = robot.gait("walk").expect("the robot has the gait walk");
        for phase in 0..=u16::MAX {
            let [a1, a2, a3, a4] = walk.table_sweeps(phase);
            // LH starts at 0, LF a quarter of a cycle later, RH half a cycle, RF three quarters.
            let left_hind_at = |delay: u16| walk.table_sweeps(phase.wrapping_sub(delay))[3];
            assert_eq!([a1, a4], [left_hind_at(0x4000), left_hind_at(0)]);
            assert_eq!([-a3, -a2], [left_hind_at(0x8000), left_hind_at(0xc000)]);
        }
    }

    #[test]
    fn tables_of_mirrored_gaits_differ_by_at_most_a_step() {
        for (name, a, b) in [
            ("paper", "left", "right"),
            ("paper", "arc-left", "arc-right"),
            ("unequal", "left", "right"),
            ("own-gaits", "veer-left", "veer-right"),
            ("own-gaits", "nod", "nod-to-the-left"),
        ] {
            let robot = robot(name);
            let (a, b) = (robot.gait(a).expect(a), robot.gait(b).expect(b));
            for phase in 0..=u16::MAX {
                let [a1, a2, a3, a4] = a.table_sweeps(phase);
                let mirrored = [-a2, -a1, -a4, -a3];
                let actual = b.table_sweeps(phase);
                // The core rounds halves up on both sides of zero, so mirrored values may differ by a step.
                let is_near = mirrored.iter().zip(actual).all(|(a, b)| a.abs_diff(b) <= 1);
                assert!(is_near, "{name} {} at {phase}", a.name());
            }
        }
    }

    #[test]
    fn gaits_that_differ_only_in_amplitude_start_and_gain_share_a_waveform() {
        // Two waves, two waveforms with holds that four turning gaits share, and one path for two servos that mirror
        // each other.
        assert_eq!(wave_count(&robot("paper")), 5);
        let added_wave = "[gait.step]\nperiod = 2.0\nwaveform = \"wave\"\nduty = 0.6\namplitude = 9.0\nstart = { LF = 0.1, RF = 0.2, RH = 0.3, LH = 0.4 }\n[gait.trot]";
        for (old, new, expected) in [
            ("amplitude = 15.0", "amplitude = 14.0", 5),
            ("duty = 0.875", "duty = 0.8", 5),
            ("[gait.trot]", added_wave, 6),
        ] {
            let changed_robot = valid_robot_with("paper", &[(old, new)]);
            assert_eq!(wave_count(&changed_robot), expected, "{new}");
        }
    }

    #[test]
    fn the_largest_gain_of_every_waveform_is_1() {
        for (name, robot) in all_robots() {
            let mut max_gains = vec![0; wave_count(&robot)];
            for gait in robot.gaits() {
                for channel in core_gait(&robot, gait).channels {
                    let max_gain = &mut max_gains[usize::from(channel.wave)];
                    *max_gain = channel.gain.unsigned_abs().max(*max_gain);
                }
            }
            assert_eq!(max_gains, vec![16384; max_gains.len()], "{name}");
        }
    }

    #[test]
    fn a_robot_that_only_stands_has_a_table_of_zeros() {
        let robot = Robot::parse(&(text_before_gaits("unequal") + STAND));
        let robot = robot.expect("the robot is valid");
        assert_eq!(wave_count(&robot), 1);
        let stand = &robot.gaits()[0];
        assert!(!stand.has_movement());
        assert_eq!(stand.table_sweeps(12_345), [0; 4]);
    }

    #[test]
    fn a_leg_may_not_sweep_half_a_turn() {
        let gait = "[gait.whirl]\nperiod = 9.0\nwaveform = \"wave\"\nduty = 0.5\namplitude = 90.0\nstart = { LF = 0, RF = 0, RH = 0, LH = 0 }\ngain = { RH = -2.5 }\n[gait.walk]";
        let message = error_with("unequal", &[("[gait.walk]", gait)]);
        let expected = "in \"whirl\" servo A3 would have to turn farther than it can: its sweep is half a turn or more (";
        assert_starts_with(&message, expected);
    }
}
