//! A gait and the table that was made from it.

use std::sync::Arc;

use lizard_avr::Flash;
use lizard_core::numbers::gaits::Gait as TableGait;
use lizard_core::numbers::units::phase16;

use crate::gaits::Gait;
use crate::tables::table::Tables;
use crate::units::{FRAMES_PER_SECOND, STEPS_PER_DEGREE};

/// A gait in floating point, and in the integers of the firmware.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TabledGait {
    gait: Gait,
    /// Its place in the file and in the tables.
    index: usize,
    tables: Arc<Tables>,
}

impl TabledGait {
    /// A gait, its place, and the tables that were made of all gaits.
    pub fn new(gait: Gait, index: usize, tables: &Arc<Tables>) -> Self {
        Self {
            gait,
            index,
            tables: Arc::clone(tables),
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.gait.name
    }

    /// The gait in floating point.
    pub fn gait(&self) -> &Gait {
        &self.gait
    }

    /// Its place in the file, from 0.
    pub fn index(&self) -> usize {
        self.index
    }

    /// The gait as the firmware has it.
    pub fn table(&self) -> &TableGait {
        &self.tables.gaits[self.index]
    }

    /// True if a servo moves in the course of a cycle.
    pub fn moves(&self) -> bool {
        self.table().channels.iter().any(|channel| {
            let wave = &self.tables.waves[usize::from(channel.wave)];
            channel.gain != 0 && wave.iter().any(|sample| *sample != wave[0])
        })
    }

    /// The sweeps from neutral at a phase of 1/65536 cycle, in angle steps,
    /// counter-clockwise positive, servo order.
    pub fn sweeps(&self, phase: u16) -> [i16; 4] {
        self.table().channels.map(|channel| {
            let wave = Flash::from(&self.tables.waves[usize::from(channel.wave)]);
            channel.sweep(wave, phase).0
        })
    }

    /// The servo angles at a phase of 1/65536 cycle, deg, chassis frame, servo
    /// order.
    pub fn angles(&self, phase: u16) -> [f64; 4] {
        let sweeps = self.sweeps(phase);
        std::array::from_fn(|i| self.gait.neutral[i] + f64::from(sweeps[i]) / STEPS_PER_DEGREE)
    }

    /// One cycle at full speed from phase 0 on: the time of each frame in s, and
    /// its phase in 1/65536 cycle. The last is the first that completes the cycle.
    pub fn frames(&self) -> impl Iterator<Item = (f64, u16)> + use<> {
        let increment = self.table().increment;
        // 1.1 s are 55 frames, though 1.1 * 50.0 is a little more.
        const SLACK: f64 = 1e-9;
        let frames = (self.gait.period * FRAMES_PER_SECOND - SLACK).ceil() as i32;
        (0..=frames).map(move |frame| {
            let phase = phase16((increment * frame) as u32);
            (f64::from(frame) / FRAMES_PER_SECOND, phase)
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{all, robot};

    #[test]
    fn frames_are_20_ms_apart_and_the_last_completes_the_cycle() {
        for (name, robot) in all() {
            for gait in robot.gaits() {
                let frames: Vec<(f64, u16)> = gait.frames().collect();
                assert_eq!(frames[0], (0.0, 0));
                let (end, _) = frames[frames.len() - 1];
                let late = end - gait.period();
                assert!(
                    (-1e-9..0.02 - 1e-9).contains(&late),
                    "{name} {}",
                    gait.name()
                );
                for (seconds, phase) in frames {
                    // A whole cycle is phase 0 again.
                    let off = (f64::from(phase) / 65536.0 - gait.phase(seconds)).rem_euclid(1.0);
                    assert!(
                        off.min(1.0 - off) < 1e-4,
                        "{name} {} {seconds}",
                        gait.name()
                    );
                }
            }
        }
    }

    #[test]
    fn a_gait_moves_if_a_leg_does() {
        let robot = robot("own-gaits");
        let still: Vec<&str> = robot
            .gaits()
            .iter()
            .filter(|gait| !gait.moves())
            .map(|gait| gait.name())
            .collect();
        assert_eq!(still, ["stand"]);
    }
}
