//! EEPROM operations, a byte at a time between the frames.
//!
//! A byte takes 3.4 ms to write. So no order waits for it: the main loop asks for the next step when it has
//! nothing more urgent to do, and takes no input meanwhile. A weak supply may write a wrong byte, so nothing is
//! written below a certain voltage, or before the supply has been measured.

use super::Control;
use crate::control::refusal::Refusal;
use crate::control::safety::Notice;
use crate::control::supply::Level;
use crate::memory::copies::{self, SavedState};
use crate::memory::record::{Memory, Progress, Writing};
use crate::memory::settings::Settings;

/// Frames within which the supplies are measured; no order waits longer for that.
const MEASURING_FRAMES: u32 = 25;

/// An EEPROM operation that an order has started.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Job {
    /// Load the saved settings.
    Load,
    /// Choose the copy that the settings overwrite.
    Save,
    /// Write the settings.
    Saving(Writing),
}

impl Control {
    /// True while an EEPROM operation is in progress; no order may be given meanwhile. A rest
    /// pose that waits for a better supply does not count, since no order waits for it.
    pub fn is_writing(&self) -> bool {
        self.job.is_some() || self.rest_record.is_some() && self.safety.allows_writing_now()
    }

    /// True while an order waits for the supply: until the supply is measured, or until a dip ends or
    /// turns out to be a low supply. Meanwhile there is nothing to do before the next frame.
    pub fn waits_for_supply(&self) -> bool {
        let supply = self.safety.supply();
        let will_be_measured = match supply.measured_level() {
            None => self.motion.frames() < MEASURING_FRAMES,
            Some(level) => level == Level::Good && !supply.is_steady(),
        };
        self.job.is_some() && will_be_measured
    }

    /// Does a step of the EEPROM operation: one byte at most. Returns the outcome of an order
    /// once the order is complete, otherwise `None`.
    #[inline(never)]
    pub fn write_memory<M: Memory>(&mut self, memory: &mut M) -> Option<Result<(), Refusal>> {
        if !memory.is_ready() || self.waits_for_supply() {
            return None;
        }
        let may_write = self.safety.allows_writing_now();
        if may_write && let Some(writing) = &mut self.rest_record {
            let rest_settings = Settings::of_pose(self.motion.pose(), self.motion.robot());
            match writing.step(rest_settings.bytes(), memory) {
                Progress::InProgress => return None,
                Progress::Done => {}
                Progress::Failed => self.safety.notify(Notice::NotKept),
            }
            self.rest_record = None;
            return None;
        }
        let outcome = match &mut self.job {
            None => return None,
            Some(Job::Load) => {
                let mut saved_settings = Settings::NONE;
                match copies::read(self.motion.robot(), memory, &mut saved_settings) {
                    SavedState::Latest | SavedState::OneCopy => {
                        match self.replace_settings(&saved_settings) {
                            Err(Refusal::TravelTooNarrow(_)) => Err(Refusal::NothingSaved),
                            outcome => outcome,
                        }
                    }
                    _ => Err(Refusal::NothingSaved),
                }
            }
            Some(Job::Save | Job::Saving(_)) if !may_write => Err(Refusal::Supply),
            Some(Job::Save) => match copies::save(&mut self.settings, memory) {
                None => Ok(()),
                Some(writing) => {
                    self.job = Some(Job::Saving(writing));
                    return None;
                }
            },
            Some(Job::Saving(writing)) => match writing.step(self.settings.bytes(), memory) {
                Progress::InProgress => return None,
                Progress::Done => Ok(()),
                Progress::Failed => Err(Refusal::NotKept),
            },
        };
        self.job = None;
        Some(outcome)
    }
}
