//! A gait beside the table that was made of it.

use std::sync::Arc;

use lizard_avr::Flash;
use lizard_core::gait::Gait as TableGait;
use lizard_core::units::phase16;

use crate::gait::Gait;
use crate::table::Tables;
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
        let frames = (self.gait.period * FRAMES_PER_SECOND).ceil() as i32;
        (0..=frames).map(move |frame| {
            let phase = phase16((increment * frame) as u32);
            (f64::from(frame) / FRAMES_PER_SECOND, phase)
        })
    }
}
