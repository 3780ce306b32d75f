//! The contents of the EEPROM: two copies of the settings, and the last rest pose.
//!
//! The two copies are written alternately, so that one is valid while the other is being written; the newer one
//! counts. A damaged copy is not used. If neither copy can be used, robot.toml's numbers apply.
//!
//! | address | what |
//! |---|---|
//! | 0 | settings, first copy |
//! | 64 | settings, second copy |
//! | 128 | pose of the last `rest`: settings whose trims are the pose's sweeps |

use crate::memory::record::{Address, CONTENT_BYTES, Memory, RecordState, Writing};
use crate::memory::settings::{SAVE_NUMBER, Settings};
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;

/// The addresses of the two copies of the settings.
pub const COPIES: [Address; 2] = [copy_address(0), copy_address(1)];

/// The address of the first copy for an even number, of the second for an odd one.
const fn copy_address(number: usize) -> Address {
    Address((number as u16 & 1) * 64)
}

/// The address of the rest pose.
pub const REST_POSE: Address = Address(128);

/// The state of the saved settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SavedState {
    /// The settings saved last are valid.
    Latest,
    /// No settings were ever saved.
    Blank,
    /// One copy is valid, the other is damaged and may have been the newer one.
    OneCopy,
    /// No copy is valid.
    Damaged,
    /// The settings are for other servos, or in the format of another firmware.
    Foreign,
    /// With these settings some gait would leave a servo's travel.
    Unfit,
}

/// The state of both copies.
struct Copies {
    /// The result of checking each copy.
    states: [RecordState; 2],
    /// The number of the copy that was saved last; without meaning if no copy is valid.
    latest: usize,
}

impl Copies {
    #[inline(never)]
    fn check<M: Memory>(memory: &M) -> Self {
        let states = [copy_address(0).check(memory), copy_address(1).check(memory)];
        let save_number_of =
            |copy: usize| self::copy_address(copy).byte(memory, SAVE_NUMBER as u16);
        let latest = match states {
            [RecordState::Valid, RecordState::Valid] => {
                usize::from(save_number_of(1).wrapping_sub(save_number_of(0)) < 0x80)
            }
            [RecordState::Valid, _] => 0,
            _ => 1,
        };
        Self { states, latest }
    }

    fn has_no_valid_copy(&self) -> bool {
        self.states[self.latest & 1] != RecordState::Valid
    }

    fn address(&self) -> Address {
        copy_address(self.latest)
    }
}

/// Reads the settings saved last into `settings`, and returns their state. Without a valid copy, `settings` stay
/// as they are.
#[inline(never)]
pub fn read<M: Memory>(robot: &Robot, memory: &M, settings: &mut Settings) -> SavedState {
    let copies = Copies::check(memory);
    if copies.has_no_valid_copy() {
        return match copies.states {
            [RecordState::Blank, RecordState::Blank] => SavedState::Blank,
            _ => SavedState::Damaged,
        };
    }
    copies.address().fetch(memory, settings.bytes_mut());
    if !settings.is_for(robot) {
        SavedState::Foreign
    } else if copies.states.contains(&RecordState::Damaged) {
        SavedState::OneCopy
    } else {
        SavedState::Latest
    }
}

/// Loads the settings to use: those saved last if all gaits work with them, else robot.toml's.
#[inline(never)]
pub fn load<M: Memory>(robot: &Robot, memory: &M, settings: &mut Settings) -> SavedState {
    let mut outcome = read(robot, memory, settings);
    if matches!(outcome, SavedState::Latest | SavedState::OneCopy) {
        if settings.first_unfit_servo(robot).is_none() {
            return outcome;
        }
        outcome = SavedState::Unfit;
    }
    *settings = Settings::of(robot);
    outcome
}

/// Starts writing the settings over the older of the two copies; `None` if the newer one holds
/// the same settings.
pub fn save<M: Memory>(settings: &mut Settings, memory: &M) -> Option<Writing> {
    let copies = Copies::check(memory);
    if copies.has_no_valid_copy() {
        settings.set_save_number(1);
        return Some(copy_address(0).start_write());
    }
    let latest_address = copies.address();
    let save_number = latest_address.byte(memory, SAVE_NUMBER as u16);
    settings.set_save_number(save_number);
    let is_saved = |(index, byte): (usize, &u8)| latest_address.byte(memory, index as u16) == *byte;
    if settings.bytes().iter().enumerate().all(is_saved) {
        return None;
    }
    settings.set_save_number(save_number.wrapping_add(1));
    Some(copy_address(copies.latest ^ 1).start_write())
}

/// The pose of the last rest. `None` if the robot has moved since, or if the record is damaged or belongs to other
/// servos.
pub fn last_rest_pose<M: Memory>(robot: &Robot, memory: &M) -> Option<Pose> {
    let mut bytes = [0; CONTENT_BYTES];
    REST_POSE.fetch(memory, &mut bytes);
    let saved_settings = Settings::from_bytes(bytes);
    (REST_POSE.check(memory) == RecordState::Valid && saved_settings.is_for(robot))
        .then(|| saved_settings.pose())
}

#[cfg(test)]
mod tests;
