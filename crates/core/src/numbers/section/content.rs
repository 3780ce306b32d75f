//! The content of a section, from which a host makes the section's bytes.

use std::string::String;
use std::vec::Vec;

use crc::{CRC_32_ISO_HDLC, Crc};
use lizard_avr::{Flash, Pod};

use super::seal::add_seal;
use super::{
    AFTER_NUMBERS_OFFSET, CURVE_COUNT, FORMAT, Header, MAGIC, MAX_NAME_BYTES, MapHeader, Numbers,
    PartRange, SectionPart,
};
use crate::numbers::calibration::{Calibration, SweepRange};
use crate::numbers::cells::CellMap;
use crate::numbers::couplers::{self, Couplers};
use crate::numbers::curve::Table;
use crate::numbers::gaits::{Gait, Step, Wave};
use crate::numbers::limits::Limits;
use crate::numbers::link_lengths::LinkLengths;
use crate::numbers::slew::Slew;
use crate::numbers::slider::Slider;
use crate::numbers::supplies::Supplies;
use crate::numbers::units::{Angle, Scale};

/// The hash function whose result identifies a robot.
static ROBOT_HASH_FUNCTION: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The data of a robot from which a section is made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Content {
    /// The robot's name, at most [`MAX_NAME_BYTES`] bytes.
    pub name: String,
    /// The hash of the servo pins, pulses and neutral angles. Settings are saved with it, and are valid only for servos
    /// with the same hash.
    pub servo_hash: u32,
    /// The Arduino numbers of the servo pins, A1 to A4; 14 to 19 are A0 to A5.
    pub pins: [u8; 4],
    /// The Arduino number of the pin where the servo rail is measured; `None` if the rail is not measured.
    pub rail_pin: Option<u8>,
    /// The pace to which a low supply limits gaits, in percent of the pace in robot.toml, 10 to 100.
    pub slow_pace: u8,
    /// The servos' angles in the neutral pose.
    pub neutral_angles: [Angle; 4],
    /// The calibration of the servos.
    pub calibration: [Calibration; 4],
    /// The range of sweeps that the gaits need from each servo.
    pub needed_travel: [SweepRange; 4],
    /// The smallest allowed margins.
    pub limits: Limits,
    /// The slew limit of a move.
    pub slew: Slew,
    /// The supplies and their thresholds.
    pub supplies: Supplies,
    /// The link lengths of head and tail.
    pub ends: [FiveBarLengths; 2],
    /// The left and the right slider.
    pub sliders: [Slider; 2],
    /// The gaits, `stand` first, then the routines. A routine's `channels[0].offset` is the index of its first step in
    /// `steps`.
    pub gaits: Vec<Gait>,
    /// The steps of the routines.
    pub steps: Vec<Step>,
    /// The names of gaits and routines, one after another.
    pub names: Vec<u8>,
    /// The waveforms of the gaits.
    pub waves: Vec<Wave>,
    /// The certified cells of head, tail, left and right.
    pub maps: [Map; 4],
}

/// The lengths of an end's five-bar, in steps of their scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FiveBarLengths {
    /// The scale of the lengths; the margins do not depend on it.
    pub scale: Scale,
    /// The distance between the shafts.
    pub base: i16,
    /// The left and the right crank.
    pub cranks: [i16; 2],
    /// The left and the right coupler.
    pub couplers: [i16; 2],
    /// True if the crank tips can be so far apart that [`Couplers::is_near_stretched`] is true.
    pub can_nearly_stretch: bool,
}

/// A map of certified cells, see [`CellMap::from_rows`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Map {
    /// The row number of the first row.
    pub first_row: i8,
    /// The first and the last column of each row; in a row without certified cells, the first column is greater than
    /// the last.
    pub rows: Vec<[i8; 2]>,
}

impl Map {
    /// Converts the map to the form that the guard reads.
    pub fn cells(&self) -> CellMap<'_> {
        CellMap::new(self.first_row, Flash::from(self.rows.as_slice()))
    }
}

impl FiveBarLengths {
    /// Adds the reciprocals and shifts with which the guard replaces divisions.
    pub fn link_lengths(&self) -> LinkLengths {
        let [left, right] = self.cranks;
        LinkLengths::new([self.base, left, right], self.couplers, self.scale)
    }

    /// Computes the tables that the couplers require: rise, stretched rise, folded rise, skew.
    fn tables(&self) -> [Option<Table>; CURVE_COUNT] {
        let [left, right] = self.couplers;
        [
            Some(couplers::compute_rise_table(left, right)),
            self.can_nearly_stretch
                .then(|| couplers::compute_stretched_rise_table(left, right)),
            Couplers::needs_folded_table(left, right)
                .then(|| couplers::compute_folded_rise_table(left, right)),
            (left != right).then(|| couplers::compute_skew_table(left, right)),
        ]
    }
}

impl Content {
    /// Computes the length of the section in bytes, which may exceed [`super::REGION_BYTES`].
    /// [`Content::section_bytes`] may append a few bytes, so that the checksum detects every likely change.
    pub fn section_length(&self) -> usize {
        let mut curves = Vec::new();
        self.append_curves(&mut curves);
        let row_count: usize = self.maps.iter().map(|map| map.rows.len()).sum();
        usize::from(AFTER_NUMBERS_OFFSET)
            + curves.len()
            + size_of_val(self.gaits.as_slice())
            + size_of_val(self.steps.as_slice())
            + size_of_val(self.waves.as_slice())
            + self.names.len()
            + row_count * size_of::<[i8; 2]>()
    }

    /// Makes the bytes of the section, whose length may exceed [`super::REGION_BYTES`].
    ///
    /// # Panics
    /// Panics if the name has more than [`MAX_NAME_BYTES`] bytes, if a map has more than 255 rows, or if the section
    /// has more than 65 535 bytes.
    pub fn section_bytes(&self) -> Vec<u8> {
        let [head, tail] = &self.ends;
        let mut bytes_after_numbers = Vec::new();
        let curves = self.append_curves(&mut bytes_after_numbers);
        let to_u16 =
            |value: usize| u16::try_from(value).expect("a section has at most 65535 bytes");
        let steps_offset = usize::from(AFTER_NUMBERS_OFFSET)
            + bytes_after_numbers.len()
            + size_of_val(self.gaits.as_slice());
        let mut gaits = self.gaits.clone();
        for routine in gaits.iter_mut().filter(|gait| gait.is_routine()) {
            let first_step = &mut routine.channels[0].offset;
            *first_step = to_u16(steps_offset + usize::from(*first_step) * size_of::<Step>());
        }
        let gait_bytes: Vec<u8> = gaits.iter().flat_map(Pod::bytes).copied().collect();
        let steps = self.steps.iter().flat_map(Pod::bytes).copied();
        let gait_and_step_bytes: Vec<u8> = gait_bytes.into_iter().chain(steps).collect();
        let mut append_part = |count: usize, bytes: &[u8]| {
            let offset = usize::from(AFTER_NUMBERS_OFFSET) + bytes_after_numbers.len();
            bytes_after_numbers.extend(bytes);
            PartRange {
                address: to_u16(offset),
                count: to_u16(count),
            }
        };
        let wave_bytes: Vec<u8> = self.waves.iter().flat_map(Pod::bytes).copied().collect();
        let rows: Vec<[i8; 2]> = self.maps.iter().flat_map(|map| map.rows.clone()).collect();
        let row_bytes: Vec<u8> = rows
            .as_flattened()
            .iter()
            .map(|column| *column as u8)
            .collect();
        // The rows are the last part, because the hash does not include them.
        let parts = [
            append_part(self.gaits.len(), &gait_and_step_bytes),
            append_part(self.waves.len(), &wave_bytes),
            append_part(self.names.len(), &self.names),
            append_part(rows.len(), &row_bytes),
        ];
        let numbers = Numbers {
            ends: [head.link_lengths(), tail.link_lengths()],
            sliders: self.sliders,
            neutral_angles: self.neutral_angles,
            calibration: self.calibration,
            needed_travel: self.needed_travel,
            limits: self.limits,
            slew: self.slew,
            supplies: self.supplies,
            curves,
            parts,
            rail_pin: self.rail_pin.unwrap_or(0),
            slow_pace: self.slow_pace,
            pins: self.pins,
            maps: self.maps.each_ref().map(|map| MapHeader {
                first_row: map.first_row,
                row_count: u8::try_from(map.rows.len()).expect("a map has at most 255 rows"),
            }),
        };

        let mut digest = ROBOT_HASH_FUNCTION.digest();
        // The hash does not include the maps, because they save time but change no decision.
        let mut without_maps = numbers;
        without_maps.parts[SectionPart::Rows as usize] = PartRange {
            address: 0,
            count: 0,
        };
        without_maps.maps = [MapHeader {
            first_row: 0,
            row_count: 0,
        }; 4];
        digest.update(without_maps.bytes());
        digest.update(&bytes_after_numbers[..bytes_after_numbers.len() - row_bytes.len()]);
        let mut name = [0; MAX_NAME_BYTES];
        name[..self.name.len()].copy_from_slice(self.name.as_bytes());
        let header = Header {
            magic: MAGIC,
            format: FORMAT,
            length: 0,
            crc: 0,
            hash: digest.finalize(),
            servo_hash: self.servo_hash,
            name,
        };
        add_seal([header.bytes(), numbers.bytes(), &bytes_after_numbers].concat())
    }

    /// Appends the tables of head and tail to the bytes after the numbers, equal tables only once. Returns the address
    /// of each table; 0 for a missing table.
    fn append_curves(&self, bytes_after_numbers: &mut Vec<u8>) -> [[u16; CURVE_COUNT]; 2] {
        let mut written_tables: Vec<(Table, u16)> = Vec::new();
        self.ends.each_ref().map(|end| {
            end.tables().map(|table| {
                let Some(table) = table else { return 0 };
                if let Some((_, offset)) = written_tables
                    .iter()
                    .find(|(other_table, _)| other_table.bytes() == table.bytes())
                {
                    return *offset;
                }
                let offset = AFTER_NUMBERS_OFFSET + bytes_after_numbers.len() as u16;
                bytes_after_numbers.extend(table.bytes());
                written_tables.push((table, offset));
                offset
            })
        })
    }
}
