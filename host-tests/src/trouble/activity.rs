//! The robot's activity when trouble comes.

use std::fmt;

/// The robot's activity when trouble begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Activity {
    /// It rests, or has just received `rest`.
    Resting,
    /// Its servos wake after a rest.
    Waking,
    /// It holds a pose or stands.
    Holding,
    /// It goes from one pose to another.
    Moving,
    /// It walks.
    Cycling,
    /// It writes the EEPROM.
    Saving,
    /// The program has just begun.
    Starting,
    /// It answers a question.
    Talking,
    /// It goes through its routine, and its contacts close and open.
    Patrolling,
    /// A person drives it by radio.
    Driving,
}

impl Activity {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Resting,
        Self::Waking,
        Self::Holding,
        Self::Moving,
        Self::Cycling,
        Self::Saving,
        Self::Starting,
        Self::Talking,
        Self::Patrolling,
        Self::Driving,
    ];

    /// The activity of a scenario by its number: four in thirteen are drives.
    #[must_use]
    pub fn of(number: u64) -> Self {
        let place = (number % 13) as usize;
        Self::ALL.get(place).copied().unwrap_or(Self::Driving)
    }
}

impl fmt::Display for Activity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&format!("{self:?}").to_lowercase())
    }
}
