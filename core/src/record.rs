//! What the robot keeps in its EEPROM: two copies of the settings, and where it
//! rested last.
//!
//! The two copies are written in turn, so that the one before is whole while the
//! other is being written; the one with the later turn counts. What is not wholly
//! right is not used, and robot.toml's numbers take its place.
//!
//! | address | what |
//! |---|---|
//! | 0 | settings, first copy |
//! | 64 | settings, second copy |
//! | 128 | pose of the last `rest`: settings whose trims are the pose's sweeps |

use crate::adjustment::Adjustment;
use crate::memory::{CONTENT, Found, Memory, Place, Writing};
use crate::pose::Pose;
use crate::robot::Robot;
use crate::settings::Settings;

/// The two copies of the settings.
pub const COPIES: [Place; 2] = [Place(0), Place(64)];

/// The pose.
pub const RESTED: Place = Place(128);

/// What was found in the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The settings saved last.
    Latest,
    /// Nothing: nothing was ever saved.
    Blank,
    /// Settings, but the other copy is damaged; it may have been the later one.
    Other,
    /// Nothing that is whole.
    Damaged,
    /// Settings for other servos, or of another firmware.
    Foreign,
    /// Settings with which some gait would leave a servo's travel.
    Unfit,
}

/// What the memory holds of settings.
struct Copies {
    /// What was found of each.
    found: [Found; 2],
    /// The place of the one that was saved last; none if neither is whole.
    latest: Option<usize>,
    /// What that one says.
    settings: Settings,
}

impl Copies {
    #[inline(never)]
    fn read<M: Memory>(memory: &M) -> Self {
        let mut bytes = [0; CONTENT];
        let first = COPIES[0].read(memory, &mut bytes);
        let turn = bytes[1];
        let second = COPIES[1].read(memory, &mut bytes);
        let later = bytes[1].wrapping_sub(turn) < 0x80;
        let latest = match (first, second) {
            (Found::Whole, Found::Whole) if later => Some(1),
            (Found::Whole, _) => {
                COPIES[0].read(memory, &mut bytes);
                Some(0)
            }
            (_, Found::Whole) => Some(1),
            _ => None,
        };
        Self {
            found: [first, second],
            latest,
            settings: Settings::from_bytes(bytes),
        }
    }
}

/// Reads the settings to use into `settings`, which are robot.toml's: those saved
/// last, if they will do.
#[inline(never)]
pub fn load<R: Robot, M: Memory>(robot: &R, memory: &M, settings: &mut Settings) -> Outcome {
    let copies = Copies::read(memory);
    if copies.latest.is_none() {
        return match copies.found {
            [Found::Blank, Found::Blank] => Outcome::Blank,
            _ => Outcome::Damaged,
        };
    }
    if !copies.settings.are_for(robot) {
        return Outcome::Foreign;
    }
    if copies.settings.calibration(robot).is_err() {
        return Outcome::Unfit;
    }
    *settings = copies.settings;
    match copies.found {
        [Found::Damaged, _] | [_, Found::Damaged] => Outcome::Other,
        _ => Outcome::Latest,
    }
}

/// Begins to save settings over the older copy, and gives them their turn. None where
/// they are what the latest copy holds.
#[inline(never)]
pub fn save<M: Memory>(settings: &mut Settings, memory: &M) -> Option<Writing> {
    let copies = Copies::read(memory);
    let turn = copies.settings.turn();
    let Some(latest) = copies.latest else {
        settings.set_turn(1);
        return Some(COPIES[0].write());
    };
    settings.set_turn(turn);
    if copies.settings == *settings {
        return None;
    }
    settings.set_turn(turn.wrapping_add(1));
    Some(COPIES[latest & 1 ^ 1].write())
}

/// A pose as the memory keeps it.
pub fn pose<R: Robot>(pose: &Pose, robot: &R) -> Settings {
    let mut kept = Settings::blank(robot);
    for (place, sweep) in pose.0.iter().enumerate() {
        let none = Adjustment::default();
        kept.set_servo(
            place,
            Adjustment {
                trim: *sweep,
                ..none
            },
        );
    }
    kept
}

/// Where the robot rested last, if it has not moved since.
#[inline(never)]
pub fn rested<R: Robot, M: Memory>(robot: &R, memory: &M) -> Option<Pose> {
    let mut bytes = [0; CONTENT];
    let found = RESTED.read(memory, &mut bytes);
    let kept = Settings::from_bytes(bytes);
    if found != Found::Whole || !kept.are_for(robot) {
        return None;
    }
    let mut pose = Pose::NEUTRAL;
    for (place, sweep) in pose.0.iter_mut().enumerate() {
        *sweep = kept.servo(place).trim;
    }
    Some(pose)
}

#[cfg(test)]
mod tests;
