//! The settings that the user may change and the robot stores: the servos' adjustments, the action after power-on, and
//! the time for which a gait continues without a command.
//!
//! The settings have the same bytes in RAM as in the EEPROM, so saving and loading require no conversion.
//!
//! | byte | content |
//! |---|---|
//! | 0 | [`FORMAT_VERSION`] |
//! | 1 | the save number, incremented by every `save` of changed settings |
//! | 2 | the hash of the servos to which the settings belong, 4 bytes |
//! | 6 | for each servo: trim, gain, clockwise limit and counter-clockwise limit, 2 bytes each |
//! | 38 | `boot`: 0 for `rest`, otherwise the [`gait_key`] of a gait |
//! | 40 | `deadman`, ms |

use crate::memory::adjustment::Adjustment;
use crate::memory::record::{CONTENT_BYTES, RecordContent};
use crate::numbers::calibration::Calibration;
use crate::numbers::gaits::GaitId;
use crate::numbers::part::Servo;
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;
use crate::numbers::units::Sweep;

/// The version of the format, incremented when the meaning of a byte changes.
pub const FORMAT_VERSION: u8 = 1;

/// The offset of the save number. The table above has all offsets.
pub const SAVE_NUMBER_OFFSET: usize = 1;
const HASH_OFFSET: usize = 2;
const ADJUSTMENTS_OFFSET: usize = 6;
const BOOT_OFFSET: usize = 38;
const DEADMAN_OFFSET: usize = 40;

/// The robot's action three seconds after power-on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boot {
    /// A gait, which may be `stand`.
    Gait(GaitId),
    /// No pulses, as after `rest`.
    Rest,
}

/// The settings that `save` stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    bytes: RecordContent,
}

impl Settings {
    /// The settings if there is no robot.
    pub const NONE: Self = Self {
        bytes: [0; CONTENT_BYTES],
    };

    /// Returns the settings of robot.toml.
    #[inline(never)]
    pub fn for_robot(robot: &Robot) -> Self {
        let mut settings = Self::NONE;
        settings.set_header(robot);
        for servo in Servo::iter() {
            settings.set_adjustment(
                servo,
                Adjustment::from_calibration(&robot.servo_calibration(servo)),
            );
        }
        settings.set_boot(Boot::Gait(GaitId::STAND), robot);
        settings
    }

    /// Sets the format version, and the hash of a robot's servos.
    fn set_header(&mut self, robot: &Robot) {
        self.bytes[0] = FORMAT_VERSION;
        let hash = robot.servo_hash();
        self.put(HASH_OFFSET, hash as u16);
        self.put(HASH_OFFSET + 2, (hash >> 16) as u16);
    }

    /// Returns a record that contains a pose instead of settings, with each servo's sweep in place of its trim.
    #[inline(never)]
    pub fn for_pose(pose: &Pose, robot: &Robot) -> Self {
        let mut record = Self::NONE;
        record.set_header(robot);
        let mut offset = ADJUSTMENTS_OFFSET;
        for sweep in &pose.0 {
            record.put(offset, sweep.0 as u16);
            offset += 8;
        }
        record
    }

    /// Returns the pose in a record made by [`Settings::for_pose`]; for other settings, the pose whose sweeps are the
    /// trims.
    #[inline(never)]
    pub fn pose(&self) -> Pose {
        let mut pose = Pose::NEUTRAL;
        let mut offset = ADJUSTMENTS_OFFSET;
        for sweep in &mut pose.0 {
            sweep.0 = self.get(offset) as i16;
            offset += 8;
        }
        pose
    }

    /// Creates settings from the bytes of a record.
    pub const fn from_bytes(bytes: RecordContent) -> Self {
        Self { bytes }
    }

    /// The bytes of the record.
    pub const fn bytes(&self) -> &RecordContent {
        &self.bytes
    }

    /// The bytes of the record, mutable.
    pub const fn bytes_mut(&mut self) -> &mut RecordContent {
        &mut self.bytes
    }

    /// True if the settings have the format [`FORMAT_VERSION`] and belong to this robot's servos.
    pub fn are_for(&self, robot: &Robot) -> bool {
        let hash = robot.servo_hash();
        self.bytes[0] == FORMAT_VERSION
            && self.get(HASH_OFFSET) == hash as u16
            && self.get(HASH_OFFSET + 2) == (hash >> 16) as u16
    }

    /// Sets the save number, modulo 256.
    pub const fn set_save_number(&mut self, number: u8) {
        self.bytes[SAVE_NUMBER_OFFSET] = number;
    }

    /// The adjustment of a servo.
    pub fn adjustment(&self, servo: Servo) -> Adjustment {
        let number_at = |n: usize| self.get(ADJUSTMENTS_OFFSET + 8 * servo.index() + 2 * n) as i16;
        Adjustment {
            trim: Sweep(number_at(0)),
            gain: number_at(1),
            travel_min: Sweep(number_at(2)),
            travel_max: Sweep(number_at(3)),
        }
    }

    /// Sets a servo's adjustment.
    pub fn set_adjustment(&mut self, servo: Servo, adjustment: Adjustment) {
        let numbers = [
            adjustment.trim.0,
            adjustment.gain,
            adjustment.travel_min.0,
            adjustment.travel_max.0,
        ];
        let mut offset = ADJUSTMENTS_OFFSET + 8 * servo.index();
        for number in numbers {
            self.put(offset, number as u16);
            offset += 2;
        }
    }

    /// The action after power-on, which is `stand` if its gait no longer exists.
    pub fn boot(&self, robot: &Robot) -> Boot {
        let saved_key = self.get(BOOT_OFFSET);
        if saved_key == 0 {
            return Boot::Rest;
        }
        let gait =
            GaitId::all(robot.gait_count()).find(|id| gait_key(robot.gait_name(*id)) == saved_key);
        Boot::Gait(gait.unwrap_or(GaitId::STAND))
    }

    /// Sets the action after power-on.
    pub fn set_boot(&mut self, boot: Boot, robot: &Robot) {
        let saved_key = match boot {
            Boot::Rest => 0,
            Boot::Gait(id) => gait_key(robot.gait_name(id)),
        };
        self.put(BOOT_OFFSET, saved_key);
    }

    /// The time without a command after which a gait ends, ms; 0 if it never ends.
    pub fn deadman_ms(&self) -> u16 {
        self.get(DEADMAN_OFFSET)
    }

    /// Sets the time without a command after which a gait ends, ms; 0 if it never ends.
    pub fn set_deadman_ms(&mut self, ms: u16) {
        self.put(DEADMAN_OFFSET, ms);
    }

    /// Returns the calibration of a servo with its adjustment.
    #[inline(never)]
    pub fn calibration(&self, servo: Servo, robot: &Robot) -> Calibration {
        self.adjustment(servo)
            .apply(&robot.servo_calibration(servo))
    }

    /// True if the travel of every servo covers the range that the gaits need.
    #[inline(never)]
    pub fn cover_gaits(&self, robot: &Robot) -> bool {
        Servo::iter().all(|servo| {
            let calibration = self.calibration(servo, robot);
            robot.needed_travel(servo).is_within(&calibration)
        })
    }

    /// Reads the 16-bit number at an offset.
    fn get(&self, offset: usize) -> u16 {
        match self.bytes.get(offset..) {
            Some([low, high, ..]) => u16::from_le_bytes([*low, *high]),
            _ => 0,
        }
    }

    /// Stores a 16-bit number at an offset.
    fn put(&mut self, offset: usize, number: u16) {
        if let Some([low, high, ..]) = self.bytes.get_mut(offset..) {
            [*low, *high] = number.to_le_bytes();
        }
    }
}

/// Computes the key under which a gait is saved: a hash of the gait's name, never 0. With this key the gait is found
/// even after other gaits in robot.toml have changed. The host that made the section has checked that no two gaits have
/// the same key.
pub fn gait_key(name: impl Iterator<Item = u8>) -> u16 {
    let mut hash = 0u16;
    for byte in name {
        hash = (hash << 5).wrapping_sub(hash).wrapping_add(byte.into());
    }
    hash.max(1)
}
