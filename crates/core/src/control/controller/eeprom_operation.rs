//! EEPROM operations, one byte at a time between the frames.
//!
//! Writing a byte takes 3.4 ms, so an order only starts an operation. The main loop advances the operation by a byte
//! whenever it has nothing more urgent to do, and takes no input until the operation is complete. At a low supply
//! voltage, a byte may be written incorrectly, so nothing is written below a certain voltage, or before the supply has
//! been measured.

use super::Controller;
use crate::control::refusal::Refusal;
use crate::control::safety::Notice;
use crate::control::supply::Level;
use crate::memory::copies::{self, SavedState};
use crate::memory::record::{Memory, Progress, RecordWrite};
use crate::memory::settings::Settings;

use EepromOperation::{ChooseCopy, Load, WriteCopy};

/// Frames after the program's start within which the supplies are measured. No order waits longer for the measurement.
const MEASURING_FRAMES: u32 = 25;

/// An EEPROM operation that an order has started.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EepromOperation {
    /// Load the saved settings.
    Load,
    /// Choose the copy to be overwritten, the first step of saving.
    ChooseCopy,
    /// Write the settings to the chosen copy.
    WriteCopy(RecordWrite),
}

impl Controller {
    /// True while an order's operation, or the write of a rest pose, is in progress; meanwhile no order may be given.
    /// While a rest pose waits for a better supply, its write does not count, because no order depends on it.
    pub fn is_memory_in_use(&self) -> bool {
        self.eeprom_operation.is_some()
            || self.rest_pose_write.is_some() && self.safety.allows_writing_now()
    }

    /// True while an order waits until the supply is measured, or until a dip ends with a recovery or with a lower
    /// level. Meanwhile there is nothing to do before the next frame.
    pub fn is_waiting_for_supply(&self) -> bool {
        let supply = self.safety.supply();
        let is_supply_undetermined = match supply.measured_level() {
            None => self.motion.frame_count() < MEASURING_FRAMES,
            Some(level) => level == Level::Good && !supply.is_steady(),
        };
        self.eeprom_operation.is_some() && is_supply_undetermined
    }

    /// Advances the write of a rest pose, or else the order's operation, by at most one byte. Returns the outcome of
    /// the order once the order is complete, otherwise `None`.
    #[inline(never)]
    pub fn advance_operation<M: Memory>(&mut self, memory: &mut M) -> Option<Result<(), Refusal>> {
        if !memory.is_ready() || self.is_waiting_for_supply() {
            return None;
        }
        let may_write = self.safety.allows_writing_now();
        if may_write && let Some(record_write) = &mut self.rest_pose_write {
            // Writing an equal record again would first remove its mark: a power cut before the last byte would lose
            // the pose.
            let is_saved = !record_write.is_invalidation()
                && copies::read_rest_pose(self.motion.robot(), memory).as_ref()
                    == Some(self.motion.pose());
            if is_saved {
                self.rest_pose_write = None;
                return None;
            }
            let rest_settings = Settings::for_pose(self.motion.pose(), self.motion.robot());
            match record_write.advance(rest_settings.bytes(), memory) {
                Progress::InProgress => return None,
                Progress::Done => {}
                Progress::Failed => self.safety.notify(Notice::RestPoseNotSaved),
            }
            self.rest_pose_write = None;
            return None;
        }
        let outcome = match &mut self.eeprom_operation {
            None => return None,
            Some(Load) => {
                let mut saved_settings = Settings::NONE;
                match copies::read_latest(self.motion.robot(), memory, &mut saved_settings) {
                    SavedState::Latest | SavedState::OneCopy => {
                        match self.replace_settings(&saved_settings) {
                            Err(Refusal::TravelTooNarrow(_)) => Err(Refusal::NothingSaved),
                            outcome => outcome,
                        }
                    }
                    _ => Err(Refusal::NothingSaved),
                }
            }
            Some(ChooseCopy | WriteCopy(_)) if !may_write => Err(Refusal::SupplyTooLow),
            Some(ChooseCopy) => match copies::start_save(&mut self.settings, memory) {
                None => Ok(()),
                Some(record_write) => {
                    self.eeprom_operation = Some(WriteCopy(record_write));
                    return None;
                }
            },
            Some(WriteCopy(record_write)) => {
                match record_write.advance(self.settings.bytes(), memory) {
                    Progress::InProgress => return None,
                    Progress::Done => Ok(()),
                    Progress::Failed => Err(Refusal::WriteFailed),
                }
            }
        };
        self.eeprom_operation = None;
        Some(outcome)
    }
}
