//! The limits of an observed robot, and the accuracy of the observation.

use crate::event::{MS, Time};

/// The limits of the robot, and the accuracy with which a tool observes the robot.
#[derive(Clone, Debug)]
pub struct Limits {
    /// The largest change in each servo's pulse width from one frame to the next, cycles.
    pub max_change_cycles: [u32; 4],
    /// The shortest and the longest pulse width of each servo, cycles.
    pub width_ranges: [(u32, u32); 4],
    /// The supply voltages below which EEPROM writes, motions and pulses are forbidden, mV.
    pub levels_mv: [u32; 3],
    /// The largest error of the robot's own supply measurement, mV: a step of the converter, and the rounding to two
    /// decimals.
    pub supply_error_mv: u32,
    /// The longest time from an answer to the end of the current frame.
    pub max_frame_remainder: Time,
    /// The longest time from a fault to its report on the console.
    pub max_report_time: Time,
    /// The longest time for which a line of the robot waits in the queue before it is printed.
    pub max_queue_time: Time,
    /// The longest rest within a routine; 0 if no routine rests.
    pub max_routine_rest: Time,
    /// True if the robot's `boot` setting may be `rest`.
    pub can_boot_to_rest: bool,
    /// True if the EEPROM keeps every byte that is written to it.
    pub is_memory_reliable: bool,
    /// True if a brown-out may clear RAM.
    pub can_brown_outs_clear_ram: bool,
    /// True if the saved travel may be narrower than the travel in use.
    pub can_saved_travel_be_narrower: bool,
}

impl Default for Limits {
    /// Returns the limits for a robot that is observed exactly, between its frames.
    fn default() -> Self {
        Self {
            max_change_cycles: [u32::MAX; 4],
            width_ranges: [(1_000, 63_000); 4],
            levels_mv: [0; 3],
            supply_error_mv: 40,
            max_frame_remainder: MS,
            max_report_time: 60 * MS - 1,
            max_queue_time: 0,
            max_routine_rest: 0,
            can_boot_to_rest: false,
            is_memory_reliable: true,
            can_brown_outs_clear_ram: false,
            can_saved_travel_be_narrower: false,
        }
    }
}

impl Limits {
    /// Returns the lowest supply voltage that counts as good, mV.
    pub(crate) fn min_good_mv(&self) -> u32 {
        /// Margin above the level for EEPROM writes.
        const MARGIN_MV: u32 = 200;
        self.levels_mv[0] + MARGIN_MV
    }
}
