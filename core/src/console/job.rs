//! What is to be done with the memory, a byte at a time between the frames.
//!
//! A byte takes 3.4 ms to write. So no command waits for it: main asks for the next
//! step whenever it has nothing more urgent to do, and takes no input meanwhile.

use crate::memory::Writing;

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
