//! The contents of the EEPROM: two copies of the settings, and the last rest pose.
//!
//! The two copies are written alternately, so that one copy is valid while the other is being written. The newer valid
//! copy is used. If neither copy is usable, the numbers in robot.toml are used.
//!
//! | address | content |
//! |---|---|
//! | 0 | settings, first copy |
//! | 64 | settings, second copy |
//! | 128 | pose of the last `rest`: settings whose trims are the pose's sweeps |

use crate::memory::record::{CONTENT_BYTES, Memory, RecordAddress, RecordState, RecordWrite};
use crate::memory::settings::{SAVE_NUMBER_OFFSET, Settings};
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;

/// The addresses of the two copies of the settings.
pub const COPY_ADDRESSES: [RecordAddress; 2] = [copy_address(0), copy_address(1)];

/// Returns the address of the first copy for an even number, of the second copy for an odd number.
const fn copy_address(number: usize) -> RecordAddress {
    RecordAddress((number as u16 & 1) * 64)
}

/// The address of the rest pose.
pub const REST_POSE_ADDRESS: RecordAddress = RecordAddress(128);

/// The state of the saved settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SavedState {
    /// The last saved settings are valid.
    Latest,
    /// No settings have ever been saved.
    Blank,
    /// One copy is valid; the other is damaged and may have been the newer copy.
    OneCopy,
    /// No copy is valid.
    Damaged,
    /// The settings are for other servos, or in the format of another firmware.
    Foreign,
    /// With the saved settings, a gait would exceed a servo's travel.
    Unfit,
}

/// The state of both copies.
struct Copies {
    /// The result of checking each copy.
    states: [RecordState; 2],
    /// The index of the newest valid copy; meaningless if no copy is valid.
    latest_index: usize,
}

impl Copies {
    #[inline(never)]
    fn check<M: Memory>(memory: &M) -> Self {
        let states = [copy_address(0).check(memory), copy_address(1).check(memory)];
        let read_save_number =
            |copy: usize| copy_address(copy).read_byte(memory, SAVE_NUMBER_OFFSET as u16);
        let latest_index = match states {
            [RecordState::Valid, RecordState::Valid] => {
                usize::from(read_save_number(1).wrapping_sub(read_save_number(0)) < 0x80)
            }
            [RecordState::Valid, _] => 0,
            _ => 1,
        };
        Self {
            states,
            latest_index,
        }
    }

    fn has_no_valid_copy(&self) -> bool {
        self.states[self.latest_index & 1] != RecordState::Valid
    }

    fn latest_address(&self) -> RecordAddress {
        copy_address(self.latest_index)
    }
}

/// Reads the last saved settings into `settings`, and returns their state. If there is no valid copy, `settings` do not
/// change.
#[inline(never)]
pub fn read_latest<M: Memory>(robot: &Robot, memory: &M, settings: &mut Settings) -> SavedState {
    let copies = Copies::check(memory);
    if copies.has_no_valid_copy() {
        return match copies.states {
            [RecordState::Blank, RecordState::Blank] => SavedState::Blank,
            _ => SavedState::Damaged,
        };
    }
    copies
        .latest_address()
        .read_content(memory, settings.bytes_mut());
    if !settings.are_for(robot) {
        SavedState::Foreign
    } else if copies.states.contains(&RecordState::Damaged) {
        SavedState::OneCopy
    } else {
        SavedState::Latest
    }
}

/// Loads the settings to use into `settings`: the last saved settings if all gaits are within their travel, otherwise
/// the settings of robot.toml. Returns the state of the saved settings.
#[inline(never)]
pub fn load<M: Memory>(robot: &Robot, memory: &M, settings: &mut Settings) -> SavedState {
    let mut state = read_latest(robot, memory, settings);
    if matches!(state, SavedState::Latest | SavedState::OneCopy) {
        if settings.cover_gaits(robot) {
            return state;
        }
        state = SavedState::Unfit;
    }
    *settings = Settings::for_robot(robot);
    state
}

/// Starts writing the settings over the older or damaged copy. Returns `None` if the newer copy already holds these
/// settings and the other copy is not damaged.
pub fn start_save<M: Memory>(settings: &mut Settings, memory: &M) -> Option<RecordWrite> {
    let copies = Copies::check(memory);
    if copies.has_no_valid_copy() {
        settings.set_save_number(1);
        return Some(copy_address(0).start_write());
    }
    let latest_address = copies.latest_address();
    let save_number = latest_address.read_byte(memory, SAVE_NUMBER_OFFSET as u16);
    settings.set_save_number(save_number);
    let is_saved =
        |(index, byte): (usize, &u8)| latest_address.read_byte(memory, index as u16) == *byte;
    let is_other_damaged = copies.states.contains(&RecordState::Damaged);
    if !is_other_damaged && settings.bytes().iter().enumerate().all(is_saved) {
        return None;
    }
    settings.set_save_number(save_number.wrapping_add(1));
    Some(copy_address(copies.latest_index ^ 1).start_write())
}

/// Reads the pose of the last rest. Returns `None` if the robot has moved since, or if the record is damaged or belongs
/// to other servos.
pub fn read_rest_pose<M: Memory>(robot: &Robot, memory: &M) -> Option<Pose> {
    let mut bytes = [0; CONTENT_BYTES];
    REST_POSE_ADDRESS.read_content(memory, &mut bytes);
    let saved_settings = Settings::from_bytes(bytes);
    (REST_POSE_ADDRESS.check(memory) == RecordState::Valid && saved_settings.are_for(robot))
        .then(|| saved_settings.pose())
}

#[cfg(test)]
mod tests;
