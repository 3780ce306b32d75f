//! The content of a section, and its bytes, made by a host.

use std::string::String;
use std::vec::Vec;

use crc::{CRC_32_ISO_HDLC, Crc};
use lizard_avr::{Flash, Plain};

use super::seal::add_seal;
use super::{
    AFTER_NUMBERS, CURVES, FORMAT, Header, MAGIC, MAX_NAME_BYTES, MapHeader, Numbers, Part,
    PartRange,
};
use crate::numbers::bars::Bars;
use crate::numbers::calibration::Calibration;
use crate::numbers::calibration::Reach;
use crate::numbers::cells::Cells;
use crate::numbers::couplers::{self, Couplers};
use crate::numbers::curve::Table;
use crate::numbers::gaits::{Gait, Step, Wave};
use crate::numbers::limits::Limits;
use crate::numbers::slew::Slew;
use crate::numbers::slider::Slider;
use crate::numbers::supplies::Supplies;
use crate::numbers::units::{Angle, Scale};

/// The algorithm of the hash that identifies a robot.
static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The numbers of a robot, from which a section is made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Content {
    /// The robot's name, at most [`MAX_NAME_BYTES`] characters.
    pub name: String,
    /// The hash that tells if saved settings belong to these servos.
    pub servo_hash: u32,
    /// The Arduino numbers of the servos' pins, A1 to A4; 14 to 19 are A0 to A5.
    pub pins: [u8; 4],
    /// The Arduino number of the pin where the servos' rail is measured.
    pub rail: Option<u8>,
    /// The percentage of their own pace to which a low supply limits gaits, 10 to 100.
    pub slow_pace: u8,
    /// The servos' angles in the neutral pose.
    pub neutral: [Angle; 4],
    /// The pulse widths and the travel of the servos.
    pub calibration: [Calibration; 4],
    /// The range of sweeps that the gaits need of each servo.
    pub reach: [Reach; 4],
    /// The smallest margins that are allowed.
    pub limits: Limits,
    /// The slew limit of a move.
    pub slew: Slew,
    /// The supplies and their thresholds.
    pub supplies: Supplies,
    /// The bars of head and tail.
    pub ends: [Loop; 2],
    /// The sliders left and right.
    pub sides: [Slider; 2],
    /// The gaits, `stand` first, then the routines; a routine refers to its first step by its index in `steps`.
    pub gaits: Vec<Gait>,
    /// The steps of the routines.
    pub steps: Vec<Step>,
    /// The names of gaits and routines, one after the other.
    pub names: Vec<u8>,
    /// The waveforms of the gaits.
    pub waves: Vec<Wave>,
    /// The certified cells of head, tail, left and right.
    pub maps: [Map; 4],
}

/// The bars of the five-bar of head or tail, in steps of their scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loop {
    /// The scale of the lengths; the margins do not depend on it.
    pub scale: Scale,
    /// Distance between the shafts.
    pub base: i16,
    /// The left and the right crank.
    pub cranks: [i16; 2],
    /// The left and the right coupler.
    pub couplers: [i16; 2],
    /// True if the crank tips can be so far apart that the couplers are nearly stretched.
    pub is_near_stretched: bool,
}

/// A map of certified cells, see [`crate::numbers::cells::Cells`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Map {
    /// The number of the first row.
    pub first: i8,
    /// The first and the last column of each row; in a row without certified cells, the first is greater than the
    /// last.
    pub rows: Vec<[i8; 2]>,
}

impl Map {
    /// The map in the form that the guard reads.
    pub fn cells(&self) -> Cells<'_> {
        Cells::new(self.first, Flash::from(self.rows.as_slice()))
    }
}

impl Loop {
    /// The bars, and the factors that follow from them.
    pub fn bars(&self) -> Bars {
        let [left, right] = self.cranks;
        Bars::new([self.base, left, right], self.couplers, self.scale)
    }

    /// The tables that the couplers need: rise, stretched, folded, skew.
    fn tables(&self) -> [Option<Table>; CURVES] {
        let [left, right] = self.couplers;
        [
            Some(couplers::rise(left, right)),
            self.is_near_stretched
                .then(|| couplers::stretched(left, right)),
            Couplers::differ_much(left, right).then(|| couplers::folded(left, right)),
            (left != right).then(|| couplers::skew(left, right)),
        ]
    }
}

impl Content {
    /// The size of the section in bytes, which may exceed the flash of a board. [`Content::section`] may append a
    /// few bytes, see [`super::seal()`].
    pub fn length(&self) -> usize {
        let mut curves = Vec::new();
        self.curves(&mut curves);
        let rows: usize = self.maps.iter().map(|map| map.rows.len()).sum();
        usize::from(AFTER_NUMBERS)
            + curves.len()
            + size_of_val(self.gaits.as_slice())
            + size_of_val(self.steps.as_slice())
            + size_of_val(self.waves.as_slice())
            + self.names.len()
            + rows * size_of::<[i8; 2]>()
    }

    /// The bytes of the section, which may exceed the flash of a board: see [`super::SPACE`].
    ///
    /// # Panics
    /// If a map has more than 255 rows, or the section more than 65 535 bytes.
    pub fn section(&self) -> Vec<u8> {
        let [head, tail] = &self.ends;
        let mut rest = Vec::new();
        let curves = self.curves(&mut rest);
        let to_u16 = |value: usize| u16::try_from(value).expect("at most 65535");
        let steps_offset =
            usize::from(AFTER_NUMBERS) + rest.len() + size_of_val(self.gaits.as_slice());
        let mut gaits = self.gaits.clone();
        for routine in gaits.iter_mut().filter(|gait| gait.is_routine()) {
            let first_step = &mut routine.channels[0].offset;
            *first_step = to_u16(steps_offset + usize::from(*first_step) * size_of::<Step>());
        }
        let gaits: Vec<u8> = gaits.iter().flat_map(Plain::bytes).copied().collect();
        let steps = self.steps.iter().flat_map(Plain::bytes).copied();
        let gaits: Vec<u8> = gaits.into_iter().chain(steps).collect();
        let mut append_part = |count: usize, bytes: &[u8]| {
            let offset = usize::from(AFTER_NUMBERS) + rest.len();
            rest.extend(bytes);
            PartRange {
                at: to_u16(offset),
                count: to_u16(count),
            }
        };
        let waves: Vec<u8> = self.waves.iter().flat_map(Plain::bytes).copied().collect();
        let rows: Vec<[i8; 2]> = self.maps.iter().flat_map(|map| map.rows.clone()).collect();
        let columns: Vec<u8> = rows
            .as_flattened()
            .iter()
            .map(|column| *column as u8)
            .collect();
        // The rows are the last part, because the hash does not cover them.
        let parts = [
            append_part(self.gaits.len(), &gaits),
            append_part(self.waves.len(), &waves),
            append_part(self.names.len(), &self.names),
            append_part(rows.len(), &columns),
        ];
        let numbers = Numbers {
            ends: [head.bars(), tail.bars()],
            sides: self.sides,
            neutral: self.neutral,
            calibration: self.calibration,
            reach: self.reach,
            limits: self.limits,
            slew: self.slew,
            supplies: self.supplies,
            curves,
            parts,
            rail: self.rail.unwrap_or(0),
            slow_pace: self.slow_pace,
            pins: self.pins,
            maps: self.maps.each_ref().map(|map| MapHeader {
                first: map.first,
                rows: u8::try_from(map.rows.len()).expect("at most 255"),
            }),
        };

        let mut digest = CRC.digest();
        // The hash does not include the maps: they only save time and change no decision.
        let mut without_maps = numbers;
        without_maps.parts[Part::Rows as usize] = PartRange { at: 0, count: 0 };
        without_maps.maps = [MapHeader { first: 0, rows: 0 }; 4];
        digest.update(without_maps.bytes());
        digest.update(&rest[..rest.len() - columns.len()]);
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
        add_seal([header.bytes(), numbers.bytes(), &rest].concat())
    }

    /// Appends the tables of head and tail to `rest`, equal ones only once, and returns the address of each; 0 for a
    /// table that is not needed.
    fn curves(&self, rest: &mut Vec<u8>) -> [[u16; CURVES]; 2] {
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
                let offset = AFTER_NUMBERS + rest.len() as u16;
                rest.extend(table.bytes());
                written_tables.push((table, offset));
                offset
            })
        })
    }
}
