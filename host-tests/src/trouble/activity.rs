//! Activities of the robot, during which scenarios inject faults.

use std::fmt;

/// The robot's activity when a fault is injected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Activity {
    /// The robot rests, or has just received `rest`.
    Resting,
    /// The servos start after a rest.
    Waking,
    /// The robot stands or holds a pose.
    Holding,
    /// The robot moves from one pose to another.
    Moving,
    /// The robot walks or performs another gait.
    Cycling,
    /// The robot writes the EEPROM.
    Saving,
    /// The firmware has just started.
    Starting,
    /// The robot answers a request.
    Answering,
    /// The robot performs its routine while the contacts at its inputs close and open.
    Patrolling,
    /// A person drives the robot by radio.
    Driven,
}

impl Activity {
    /// All activities.
    pub const ALL: [Self; 10] = [
        Self::Resting,
        Self::Waking,
        Self::Holding,
        Self::Moving,
        Self::Cycling,
        Self::Saving,
        Self::Starting,
        Self::Answering,
        Self::Patrolling,
        Self::Driven,
    ];

    /// Returns the activity of the scenario with this number. Of thirteen scenarios, four are `Driven` and one is of
    /// each other activity.
    #[must_use]
    pub fn for_scenario(number: u64) -> Self {
        let index = (number % 13) as usize;
        Self::ALL.get(index).copied().unwrap_or(Self::Driven)
    }
}

impl fmt::Display for Activity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&format!("{self:?}").to_lowercase())
    }
}
