//! What is to be done with the memory, a byte at a time between the frames.
//!
//! A byte takes 3.4 ms to write. So no command waits for it: main asks for the next
//! step whenever it has nothing more urgent to do, and takes no input meanwhile.

use super::Console;
use crate::answer::Answer;
use crate::memory::{Memory, Progress, Writing};
use crate::record::{self, Outcome};
use crate::refusal::Refusal;
use crate::robot::Robot;
use crate::settings::Settings;

/// Something to do with the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Job {
    /// Take the settings that are kept.
    Load,
    /// Find out where the settings are to be kept.
    Save,
    /// Keep the settings.
    Saving(Writing),
    /// Keep the pose in which the robot rests, or forget it.
    Pose(Writing),
}

impl<R: Robot> Console<R> {
    /// Begins something to do with the memory that ends with an answer.
    pub(super) fn begin_job(&mut self, job: Job) {
        self.job = Some(job);
        self.answer = None;
    }

    /// Does a part of what there is to do with the memory: one byte at most.
    #[inline(never)]
    pub fn write_memory<M: Memory>(&mut self, memory: &mut M) {
        if !memory.is_ready() {
            return;
        }
        let robot = self.motion.robot();
        let progress = match &mut self.job {
            None => return,
            Some(Job::Load) => {
                let mut kept = self.settings;
                self.job = None;
                self.answer = Some(Answer::Done);
                // Either way, what is to be said is in the answer.
                _ = match record::load(robot, memory, &mut kept) {
                    Outcome::Latest | Outcome::Other => self.replace(&kept),
                    _ => self.refuse(Refusal::NothingSaved),
                };
                return;
            }
            Some(Job::Save) => match record::save(&mut self.settings, memory) {
                None => Progress::Done,
                Some(writing) => {
                    self.job = Some(Job::Saving(writing));
                    return;
                }
            },
            Some(Job::Saving(writing)) => writing.step(self.settings.bytes(), memory),
            Some(Job::Pose(writing)) => {
                let pose = Settings::of_pose(self.motion.pose(), robot);
                if writing.step(pose.bytes(), memory) != Progress::Going {
                    self.job = None;
                }
                return;
            }
        };
        self.answer = Some(match progress {
            Progress::Going => return,
            Progress::Done => Answer::Done,
            Progress::Failed => Answer::Refused(Refusal::NotKept),
        });
        self.job = None;
    }
}
