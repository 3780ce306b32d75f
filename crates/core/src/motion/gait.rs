//! A gait: four sweeps as functions of one phase.
//!
//! Feet are never lifted; each leg swings and drags its pad on the floor. The robot advances because of the shape of
//! the swings and the order of the legs. Therefore a gait defines a waveform, a phase offset and a gain for each servo.
//! A waveform is a table of 64 samples in flash. Linear interpolation between the samples has an error of at most half
//! a degree, less than a hobby servo resolves; the host that makes the tables checks this.

use lizard_avr::{Flash, mul};

use crate::numbers::gaits::{Channel, Gait, Wave};
use crate::numbers::pose::Pose;
use crate::numbers::units::{CYCLE, Sweep, phase16};

impl Gait {
    /// Computes the pose at `phase` (1/2^24 cycle) from a robot's waveforms.
    pub fn pose(&self, waves: Flash<[Wave]>, phase: u32) -> Pose {
        let mut pose = Pose::NEUTRAL;
        for (sweep, channel) in pose.0.iter_mut().zip(&self.channels) {
            if let Some(wave) = waves.get(usize::from(channel.wave)) {
                *sweep = channel.sweep(wave, phase16(phase));
            }
        }
        pose
    }

    /// Computes the phase one frame later at `pace` (1024 is full pace).
    pub const fn advance(&self, phase: u32, pace: u16) -> u32 {
        let step = self.increment.wrapping_mul(pace as i32) >> 10;
        phase.wrapping_add(step as u32) & (CYCLE - 1)
    }
}

impl Channel {
    /// Computes the sweep at `phase` (1/65536 cycle).
    pub fn sweep(&self, wave: Flash<Wave>, phase: u16) -> Sweep {
        if self.gain == 0 {
            return Sweep(0);
        }
        let shifted_phase = phase.wrapping_add(self.offset);
        let (index, fraction) = ((shifted_phase >> 10) as u8, (shifted_phase >> 2) as u8);
        let sample = wave.at(usize::from(index)).load();
        let next_sample = wave.at(usize::from((index + 1) & 0x3f)).load();
        let rise = (mul(next_sample.wrapping_sub(sample), i16::from(fraction)) + 128) >> 8;
        let value = sample.wrapping_add(rise as i16);
        Sweep((mul(value, self.gain).wrapping_add(1 << 13) >> 14) as i16)
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use proptest::prelude::*;

    use super::*;
    use crate::numbers::gaits::SAMPLES_PER_WAVE;
    use crate::sample::Sample;

    const FULL_PACE: u16 = 1024;

    /// Returns a channel of the first waveform.
    const fn channel_with(offset: u16, gain: i16) -> Channel {
        Channel {
            wave: 0,
            offset,
            gain,
        }
    }

    /// A channel that reads a waveform unchanged.
    const PLAIN_CHANNEL: Channel = channel_with(0, 1 << 14);

    proptest! {
        #[test]
        fn a_sweep_between_two_samples_is_on_the_straight_line(
            samples in prop::collection::vec(-16_000i16..16_000, SAMPLES_PER_WAVE),
            offset: u16,
            gain: i16,
            phase: u16,
        ) {
            let channel = channel_with(offset, gain);
            let wave: Wave = core::array::from_fn(|n| samples[n]);
            let actual = f64::from(channel.sweep(Flash::from(&wave), phase).0);
            let position = f64::from(phase.wrapping_add(offset)) / 1024.0;
            let (sample, next_sample) = (samples[position as usize], samples[(position as usize + 1) % SAMPLES_PER_WAVE]);
            let rise = f64::from(next_sample) - f64::from(sample);
            let factor = f64::from(gain) / 16384.0;
            let exact = factor * (f64::from(sample) + rise * position.fract());
            // Half a step of rounding before and after the gain, and the two lowest bits of the phase, which are
            // dropped.
            let max_error = 0.5 + factor.abs() * (0.5 + 3.0 * rise.abs() / 1024.0);
            prop_assume!(exact.abs() < 32_000.0);
            prop_assert!((actual - exact).abs() <= max_error, "{actual}, exactly {exact}");
        }

        #[test]
        fn the_phase_advances_by_the_increment_times_the_pace_within_the_cycle(
            increment in -400_000i32..400_000,
            pace in 0..=FULL_PACE,
            phase in 0..CYCLE,
        ) {
            let gait = Gait { increment, ..Gait::STILL };
            let next_phase = gait.advance(phase, pace);
            prop_assert!(next_phase < CYCLE);
            let exact = f64::from(increment) * f64::from(pace) / 1024.0;
            let advance = (i64::from(next_phase) - i64::from(phase)).rem_euclid(CYCLE.into());
            let error = (advance as f64 - exact).rem_euclid(f64::from(CYCLE));
            prop_assert!(error < 1e-6 || error > f64::from(CYCLE) - 1.0, "{error}");
        }
    }

    #[test]
    fn every_sample_is_read_at_its_phase_and_the_first_sample_follows_the_last() {
        let wave: Wave = core::array::from_fn(|n| 100 * n as i16 - 3000);
        for n in 0..SAMPLES_PER_WAVE {
            let sweep = PLAIN_CHANNEL.sweep(Flash::from(&wave), (n << 10) as u16);
            assert_eq!(sweep, Sweep(wave[n]));
        }
        let wrapped_sweep = PLAIN_CHANNEL.sweep(Flash::from(&wave), 0xfe00);
        assert_eq!(wrapped_sweep.0, (wave[63] + wave[0]) / 2);
    }

    #[test]
    fn halves_round_up_after_interpolation_and_after_the_gain() {
        let wave: Wave = core::array::from_fn(|n| [0, 1, 0, -1][n % 4]);
        let sweep_at = |phase, gain| channel_with(0, gain).sweep(Flash::from(&wave), phase).0;
        let gain = PLAIN_CHANNEL.gain;
        assert_eq!([sweep_at(0x01fc, gain), sweep_at(0x0200, gain)], [0, 1]);
        assert_eq!([sweep_at(0x0a00, gain), sweep_at(0x0a04, gain)], [0, -1]);
        assert_eq!([sweep_at(0x0400, 8191), sweep_at(0x0400, 8192)], [0, 1]);
        assert_eq!([sweep_at(0x0c00, 8192), sweep_at(0x0c00, 8193)], [0, -1]);
    }

    #[test]
    fn an_offset_reads_ahead_a_negative_gain_reverses_and_a_zero_gain_stops_a_channel() {
        let robot = Sample::asymmetric();
        let wave = Flash::from(&robot.content.waves[1]);
        for phase in (0..=u16::MAX).step_by(97) {
            let offset_channel = channel_with(0x1800, 1 << 14);
            let plain_sweep = PLAIN_CHANNEL.sweep(wave, phase.wrapping_add(0x1800));
            assert_eq!(offset_channel.sweep(wave, phase), plain_sweep);
            let reversed_channel = channel_with(0x1800, -(1 << 14));
            assert_eq!(reversed_channel.sweep(wave, phase), Sweep(-plain_sweep.0));
            assert_eq!(channel_with(0x1800, 0).sweep(wave, phase), Sweep(0));
        }
    }

    #[test]
    fn a_pose_uses_each_servos_own_channel_and_waveform() {
        let robot = Sample::asymmetric();
        for gait in &robot.content.gaits {
            for phase in (0..CYCLE).step_by(99_991) {
                let pose = gait.pose(robot.waves(), phase);
                for (sweep, channel) in pose.0.iter().zip(&gait.channels) {
                    let wave = Flash::from(&robot.content.waves[usize::from(channel.wave)]);
                    assert_eq!(*sweep, channel.sweep(wave, (phase >> 8) as u16));
                }
            }
        }
    }

    #[test]
    fn a_gait_with_a_negative_increment_is_read_backwards() {
        let robot = Sample::asymmetric();
        let [forward_gait, backward_gait] =
            ["sway", "back"].map(|name| robot.gait(robot.gait_id(name)));
        let mut phases = Vec::from([0]);
        for frame in 0..50 {
            phases.push(forward_gait.advance(phases[frame], FULL_PACE));
        }
        let mut phase = phases[50];
        for forward_phase in phases.iter().rev() {
            assert_eq!(phase, *forward_phase);
            phase = backward_gait.advance(phase, FULL_PACE);
        }
        let forward_advance = forward_gait.advance(0, FULL_PACE);
        assert_eq!(backward_gait.advance(0, FULL_PACE), CYCLE - forward_advance);
    }
}
