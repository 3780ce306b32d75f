//! The work to do on the memory, a byte at a time between the frames.
//!
//! A byte takes 3.4 ms to write. So no order waits for it: main asks for the next step
//! when it has nothing more urgent to do, and takes no input meanwhile. A weak supply may
//! write a wrong byte, so nothing is written below a certain voltage, or before the
//! supply has been measured.

use super::Control;
use crate::control::refusal::Refusal;
use crate::control::safety::Notice;
use crate::control::supply::Level;
use crate::memory::copies::{self, Outcome};
use crate::memory::record::{Memory, Progress, Writing};
use crate::memory::settings::Settings;

/// Frames after which the supplies have been measured, or never will be.
const MEASURED_BY: u32 = 25;

/// What an order has the memory do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Job {
    /// Take the settings that are kept.
    Load,
    /// Find out where the settings are to be kept.
    Save,
    /// Keep the settings.
    Saving(Writing),
}

impl Control {
    /// True while there is something to do with the memory. No order is to be given
    /// meanwhile. The pose of a rest waits for a supply that allows to write it, and
    /// nothing has to wait with it.
    pub fn is_writing(&self) -> bool {
        self.job.is_some() || self.rested.is_some() && self.safety.allows_writing_now()
    }

    /// True while an order waits for the supply: to be measured, or for a dip to end or
    /// to be a low supply. Nothing can be done before the next frame.
    pub fn waits_for_supply(&self) -> bool {
        let supply = self.safety.supply();
        let soon = match supply.measured() {
            None => self.motion.frames() < MEASURED_BY,
            Some(level) => level == Level::Good && !supply.is_steady(),
        };
        self.job.is_some() && soon
    }

    /// Does a part of what there is to do with the memory: one byte at most. Returns
    /// what has come of an order, once it is done.
    #[inline(never)]
    pub fn write_memory<M: Memory>(&mut self, memory: &mut M) -> Option<Result<(), Refusal>> {
        if !memory.is_ready() || self.waits_for_supply() {
            return None;
        }
        let may_write = self.safety.allows_writing_now();
        if may_write && let Some(writing) = &mut self.rested {
            let pose = Settings::of_pose(self.motion.pose(), self.motion.robot());
            match writing.step(pose.bytes(), memory) {
                Progress::Going => return None,
                Progress::Done => {}
                Progress::Failed => self.safety.notify(Notice::NotKept),
            }
            self.rested = None;
            return None;
        }
        let done = match &mut self.job {
            None => return None,
            Some(Job::Load) => {
                let mut kept = Settings::NONE;
                match copies::read(self.motion.robot(), memory, &mut kept) {
                    Outcome::Latest | Outcome::Other => match self.replace(&kept) {
                        Err(Refusal::Unfit(_)) => Err(Refusal::NothingSaved),
                        done => done,
                    },
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
                Progress::Going => return None,
                Progress::Done => Ok(()),
                Progress::Failed => Err(Refusal::NotKept),
            },
        };
        self.job = None;
        Some(done)
    }
}
