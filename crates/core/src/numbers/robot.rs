//! A robot's numbers, read from its section of flash.
//!
//! One firmware drives any robot: lengths, limits, servos and gaits come from a section ([`crate::numbers::section`])
//! in the flash of a microcontroller or in the memory of a host. The section is checked once, when it is opened; each
//! number is read when it is used.

use core::fmt;
use core::mem::offset_of;

use lizard_avr::{Flash, Pod, Region};

use crate::numbers::calibration::{Calibration, SweepRange};
use crate::numbers::cells::CellMap;
use crate::numbers::couplers::CouplerTables;
use crate::numbers::gaits::{Gait, GaitId, GaitName, Step, Wave};
use crate::numbers::limits::Limits;
use crate::numbers::link_lengths::LinkLengths;
use crate::numbers::part::{End, Servo, Side};
use crate::numbers::pose::Pose;
use crate::numbers::section::{
    self, CURVE_COUNT, Header, MapHeader, NUMBERS_OFFSET, Numbers, PartRange, SectionPart,
};
use crate::numbers::slew::Slew;
use crate::numbers::slider::Slider;
use crate::numbers::supplies::Supplies;
use crate::numbers::units::Angle;

/// A lizard with four servos: its geometry, limits and gaits.
#[derive(Clone, Copy)]
pub struct Robot<'a> {
    section: Region<'a>,
    /// False only for [`Robot::NONE`].
    is_present: bool,
}

// The numbers are omitted, because they do not change while a program runs.
impl fmt::Debug for Robot<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.is_present { "Robot" } else { "no robot" })
    }
}

impl<'a> Robot<'a> {
    /// No robot: no gaits, and no motion allowed.
    pub const NONE: Self = Self {
        section: Region::DEFAULT,
        is_present: false,
    };

    /// Returns the robot in `flash`, which must be exactly a valid section; [`Robot::open`] checks this.
    #[inline(always)]
    pub(crate) const fn at(flash: Region<'a>) -> Self {
        Self {
            section: flash,
            is_present: true,
        }
    }

    /// Returns the robot of a new section whose numbers are not checked yet, for the code that checks them. Returns
    /// `None` if the section's header, length or checksum is wrong.
    #[cfg(any(test, feature = "host"))]
    pub fn unchecked(flash: Region<'a>) -> Option<Self> {
        let length = section::check(flash).ok()?;
        Some(Self::at(flash.prefix(length)))
    }

    /// True for [`Robot::NONE`].
    pub const fn is_none(&self) -> bool {
        !self.is_present
    }

    /// The region of flash that is exactly the robot's section.
    pub const fn section(&self) -> Region<'a> {
        self.section
    }

    /// Reads the number at `offset` bytes from the beginning of [`Numbers`].
    #[inline(always)]
    fn read_number<T: Pod>(&self, offset: usize) -> T {
        self.section.read(NUMBERS_OFFSET + offset as u16)
    }

    /// The robot's name, byte by byte.
    pub fn name(&self) -> impl Iterator<Item = u8> + use<'a> {
        let section = self.section;
        let name_offset = offset_of!(Header, name) as u16;
        (name_offset..name_offset + section::MAX_NAME_BYTES as u16)
            .map(move |offset| section.read(offset))
            .take_while(|byte| *byte != 0)
    }

    /// The hash of the robot's numbers, which identifies the robot.
    pub fn hash(&self) -> u32 {
        self.section.read(offset_of!(Header, hash) as u16)
    }

    /// The hash of the servos alone: their pins, neutral angles, pulses and travel.
    pub fn servo_hash(&self) -> u32 {
        self.section.read(offset_of!(Header, servo_hash) as u16)
    }

    /// The Arduino numbers of the servo pins, A1 to A4; 14 to 19 are A0 to A5.
    pub fn pins(&self) -> [u8; 4] {
        self.read_number(offset_of!(Numbers, pins))
    }

    /// The Arduino number of the pin where the servo rail is measured, 14 to 19; `None` if the rail is not measured.
    pub fn rail_pin(&self) -> Option<u8> {
        match self.read_number(offset_of!(Numbers, rail_pin)) {
            0 => None,
            pin => Some(pin),
        }
    }

    /// The pace to which a low supply limits gaits, in percent of the pace in robot.toml.
    pub fn slow_pace(&self) -> u8 {
        self.read_number(offset_of!(Numbers, slow_pace))
    }

    /// The link lengths of an end's five-bar, in the frame of this end.
    pub fn link_lengths(&self, end: End) -> LinkLengths {
        self.read_number(offset_of!(Numbers, ends) + end as usize * size_of::<LinkLengths>())
    }

    /// The tables of an end's couplers.
    pub(crate) fn coupler_tables(&self, end: End) -> CouplerTables<'a> {
        let curves_offset =
            offset_of!(Numbers, curves) + end as usize * size_of::<[u16; CURVE_COUNT]>();
        let read_table =
            |curve: usize| match self.read_number(curves_offset + curve * size_of::<u16>()) {
                0 => None,
                address => self.section.values(address, 1).get(0),
            };
        CouplerTables {
            rise: read_table(0),
            stretched_rise: read_table(1),
            folded_rise: read_table(2),
            skew: read_table(3),
        }
    }

    /// The slider of a side, in the chassis frame.
    pub fn slider(&self, side: Side) -> Slider {
        self.read_number(offset_of!(Numbers, sliders) + side as usize * size_of::<Slider>())
    }

    /// The smallest allowed margins.
    pub fn limits(&self) -> Limits {
        self.read_number(offset_of!(Numbers, limits))
    }

    /// The slew limit of point-to-point moves.
    pub fn slew(&self) -> Slew {
        self.read_number(offset_of!(Numbers, slew))
    }

    /// The servos' angles in the neutral pose.
    pub fn neutral_angles(&self) -> [Angle; 4] {
        self.read_number(offset_of!(Numbers, neutral_angles))
    }

    /// The neutral angle of a servo.
    #[inline(never)]
    pub fn servo_neutral_angle(&self, servo: Servo) -> Angle {
        self.read_number(offset_of!(Numbers, neutral_angles) + servo.index() * size_of::<Angle>())
    }

    /// The calibration that robot.toml gives for each servo.
    pub fn calibration(&self) -> [Calibration; 4] {
        self.read_number(offset_of!(Numbers, calibration))
    }

    /// The calibration that robot.toml gives for a servo.
    #[inline(never)]
    pub fn servo_calibration(&self, servo: Servo) -> Calibration {
        self.read_number(
            offset_of!(Numbers, calibration) + servo.index() * size_of::<Calibration>(),
        )
    }

    /// The range of a servo's sweeps that the gaits need, which includes the neutral angle.
    #[inline(never)]
    pub fn needed_travel(&self, servo: Servo) -> SweepRange {
        self.read_number(
            offset_of!(Numbers, needed_travel) + servo.index() * size_of::<SweepRange>(),
        )
    }

    /// The supplies and their thresholds.
    pub fn supplies(&self) -> Supplies {
        self.read_number(offset_of!(Numbers, supplies))
    }

    /// The number of gaits and routines; the first gait is `stand`, which holds the neutral pose.
    pub fn gait_count(&self) -> usize {
        match self.is_present {
            true => usize::from(self.part_range(SectionPart::Gaits).count),
            false => 0,
        }
    }

    /// The address of a part and the number of its elements.
    pub(crate) fn part_range(&self, part: SectionPart) -> PartRange {
        self.read_number(offset_of!(Numbers, parts) + part as usize * size_of::<PartRange>())
    }

    /// Returns all elements of a part.
    #[inline(always)]
    fn part_elements<T: Pod>(&self, part: SectionPart) -> Flash<'a, [T]> {
        let PartRange { address, count } = self.part_range(part);
        self.section.values(address, count)
    }

    /// The waveforms of all gaits.
    pub fn waves(&self) -> Flash<'a, [Wave]> {
        self.part_elements(SectionPart::Waves)
    }

    /// Reads the record of a gait or a routine.
    #[inline(never)]
    pub fn gait(&self, id: GaitId) -> Gait {
        self.part_elements(SectionPart::Gaits)
            .get(id.index())
            .map_or(Gait::STILL, Flash::load)
    }

    /// Reads the record of a routine's step.
    pub fn step(&self, routine: &Gait, step_index: u16) -> Step {
        let first_offset = routine.channels[0].offset;
        self.section
            .read(first_offset.wrapping_add(step_index * size_of::<Step>() as u16))
    }

    /// The name of a gait or a routine.
    #[inline(never)]
    pub fn gait_name(&self, id: GaitId) -> GaitName<'a> {
        // Reads only these fields instead of the entire record, because a line may be compared with every name.
        let gait_offset = id.index() as u16 * size_of::<Gait>() as u16;
        let gait_address = self.part_range(SectionPart::Gaits).address + gait_offset;
        let read_field = |field: usize| self.section.read(gait_address + field as u16);
        let start = read_field(offset_of!(Gait, name_start));
        let length = read_field(offset_of!(Gait, name_length));
        GaitName::new(start, length, self.part_elements(SectionPart::Names))
    }

    /// True if a pose is in certified cells, in which the guard accepts every pose. The head, the tail and both sides
    /// have a map each, and the pose must be in a cell of all four maps. A pose outside the cells may be safe, too.
    pub fn is_certified(&self, pose: &Pose) -> bool {
        let rows = self.part_elements::<[i8; 2]>(SectionPart::Rows);
        let mut start_row = 0;
        let mut map_index = 0;
        while map_index < 4 {
            let MapHeader {
                first_row,
                row_count,
            } = self.read_number(offset_of!(Numbers, maps) + map_index * size_of::<MapHeader>());
            let [row_servo, column_servo] = SERVO_PAIRS.at(map_index).load();
            let row = pose.0[usize::from(row_servo & 3)];
            let column = pose.0[usize::from(column_servo & 3)];
            if !CellMap::from_rows(first_row, start_row, row_count, rows).contains(row, column) {
                return false;
            }
            start_row += u16::from(row_count);
            map_index += 1;
        }
        true
    }
}

lizard_avr::flash! {
    /// The indices of the two servos of each map: the first selects the row, the second the column.
    const SERVO_PAIRS: [[u8; 2]; 4] = [[0, 1], [2, 3], [0, 3], [1, 2]];
}
