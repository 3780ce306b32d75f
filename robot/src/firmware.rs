//! The robot's numbers as the firmware has them: integers, in the types of the
//! core.
//!
//! The build script writes them into the firmware as constants; on a host they
//! are a [`lizard_core::robot::Robot`] themselves, so that guard, gaits and motion
//! of any robot.toml can be run and proved without building a firmware.

use lizard_avr::Flash;
use lizard_core::calibration::Calibration;
use lizard_core::couplers::{self, Couplers};
use lizard_core::curve::Table;
use lizard_core::five_bar::{self, FiveBar};
use lizard_core::gait::{Gait, Wave};
use lizard_core::guard::Limits;
use lizard_core::part::{End, Side};
use lizard_core::point_to_point::Slew;
use lizard_core::robot::Robot;
use lizard_core::slider::{self, Slider};
use lizard_core::units::{Angle, CYCLES_PER_US, ONE_Q15, Scale, Sine, Sweep, Width};
use lizard_kinematics as kinematics;

use crate::Pace;
use crate::generate;
use crate::servo::Servo;
use crate::table::{FRAMES_PER_SECOND, STEPS_PER_DEGREE, Tables};

/// 1.0 in Q14.
const ONE_Q14: f64 = 16384.0;
/// What rounding may add to a number that robot.toml gives exactly.
const SLACK: f64 = 1e-6;
/// The finest step of lengths: 1/16384 mm.
const FINEST: u8 = 14;

/// A robot in the integers of its firmware.
#[derive(Debug, Clone, PartialEq)]
pub struct Firmware {
    /// Arduino numbers of the servos' pins, A1 to A4; 14 to 19 are A0 to A5.
    pub(crate) pins: [u8; 4],
    pub(crate) ends: [Loop; 2],
    pub(crate) sides: [Slider; 2],
    pub(crate) limits: Limits,
    pub(crate) slew: Slew,
    pub(crate) neutral: [Angle; 4],
    pub(crate) calibration: [Calibration; 4],
    pub(crate) tables: Tables,
    pub(crate) hash: u32,
}

/// One end's loop, in steps of its scale.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Loop {
    /// Steps in a millimetre; the margins do not need it.
    pub scale: Scale,
    pub base: i16,
    pub left: i16,
    pub right: i16,
    pub couplers: Bars,
}

/// The couplers of a loop, and which tables they need.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bars {
    pub left: i16,
    pub right: i16,
    pub near_stretched: bool,
    rise: Table,
    stretched: Option<Table>,
    folded: Option<Table>,
    skew: Option<Table>,
}

/// The scale in which every length of `lengths` (mm, and the most steps that it
/// may have) fits; none if they are too long for any.
pub(crate) fn scale(lengths: &[(f64, f64)]) -> Option<Scale> {
    let fits = |bits: &u8| {
        let steps = f64::from(1u32 << bits);
        lengths.iter().all(|(mm, most)| mm * steps < *most)
    };
    (0..=FINEST).rev().find(fits).map(|bits| Scale { bits })
}

/// The scale of an end's loop.
pub(crate) fn loop_scale(bars: &kinematics::FiveBar) -> Option<Scale> {
    let all = bars.base + bars.crank_left + bars.crank_right;
    scale(&[
        (all, five_bar::LONGEST),
        (bars.coupler_left, five_bar::LONGEST),
        (bars.coupler_right, five_bar::LONGEST),
    ])
}

/// The scale of a side.
pub(crate) fn side_scale(side: &kinematics::Slider, stroke_max: f64) -> Option<Scale> {
    scale(&[
        (
            side.base + side.front + side.rear + side.offset.abs(),
            slider::LONGEST,
        ),
        (side.nominal + stroke_max.max(0.0), slider::LONGEST),
        (
            side.front + side.rear + side.offset.abs(),
            slider::LONGEST_ACROSS,
        ),
    ])
}

impl Firmware {
    /// A robot's integers; its lengths are known to fit.
    pub(crate) fn new(
        lizard: &kinematics::Lizard,
        servos: &[Servo; 4],
        limits: &kinematics::Limits,
        pace: &Pace,
        tables: Tables,
    ) -> Option<Self> {
        let stroke = (limits.stroke_min, limits.stroke_max);
        let mut firmware = Self {
            pins: servos.map(|servo| servo.pin),
            ends: [
                Loop::new(&lizard.end(kinematics::End::Head))?,
                Loop::new(&lizard.end(kinematics::End::Tail))?,
            ],
            sides: [
                side(&lizard.side(kinematics::Side::Left), stroke)?,
                side(&lizard.side(kinematics::Side::Right), stroke)?,
            ],
            limits: Limits {
                type2: sine(limits.type2),
                type1: sine(limits.type1),
                leg: sine(limits.leg),
            },
            slew: Slew::new(floor(pace.slew * STEPS_PER_DEGREE / FRAMES_PER_SECOND) as u16),
            neutral: servos
                .map(|servo| Angle((servo.neutral * STEPS_PER_DEGREE).round() as u32 as u16)),
            calibration: servos.map(|servo| calibration(&servo)),
            tables,
            hash: 0,
        };
        firmware.hash = generate::hash(&firmware);
        Some(firmware)
    }

    /// Arduino numbers of the servos' pins, A1 to A4; 14 to 19 are A0 to A5.
    pub fn pins(&self) -> [u8; 4] {
        self.pins
    }

    /// The gaits.
    pub fn tables(&self) -> &Tables {
        &self.tables
    }

    /// CRC-32 of all the numbers, as the firmware's banner shows it.
    pub fn hash(&self) -> u32 {
        self.hash
    }
}

impl Loop {
    fn new(bars: &kinematics::FiveBar) -> Option<Self> {
        let scale = loop_scale(bars)?;
        let length = |mm: f64| steps(mm, scale) as i16;
        // The crank tips part the furthest where both cranks point outwards.
        let [base, left, right] = [bars.base, bars.crank_left, bars.crank_right].map(length);
        let furthest = (base as u32 + left as u32 + right as u32) / 2 + 2;
        let [a, b] = [bars.coupler_left, bars.coupler_right].map(length);
        let near_stretched = Couplers::is_near_stretched(a, b, furthest * furthest);
        Some(Self {
            scale,
            base,
            left,
            right,
            couplers: Bars {
                left: a,
                right: b,
                near_stretched,
                rise: couplers::rise(a, b),
                stretched: near_stretched.then(|| couplers::stretched(a, b)),
                folded: (a != b).then(|| couplers::folded(a, b)),
                skew: (a != b).then(|| couplers::skew(a, b)),
            },
        })
    }

    fn five_bar(&self) -> FiveBar<'_> {
        let bars = &self.couplers;
        let tables = couplers::Tables {
            rise: Flash::from(&bars.rise),
            stretched: bars.stretched.as_ref().map(Flash::from),
            folded: bars.folded.as_ref().map(Flash::from),
            skew: bars.skew.as_ref().map(Flash::from),
        };
        let couplers = Couplers::new(bars.left, bars.right, tables);
        FiveBar::new(self.base, self.left, self.right, couplers)
    }
}

impl Robot for Firmware {
    fn end(&self, end: End) -> FiveBar<'_> {
        self.ends[end as usize].five_bar()
    }

    fn side(&self, side: Side) -> Slider {
        self.sides[side as usize]
    }

    fn limits(&self) -> Limits {
        self.limits
    }

    fn slew(&self) -> Slew {
        self.slew
    }

    fn neutral(&self) -> [Angle; 4] {
        self.neutral
    }

    fn calibration(&self) -> [Calibration; 4] {
        self.calibration
    }

    fn gaits(&self) -> Flash<'_, [Gait]> {
        Flash::from(self.tables.gaits.as_slice())
    }

    fn names(&self) -> Flash<'_, [u8]> {
        Flash::from(self.tables.names.as_slice())
    }

    fn waves(&self) -> Flash<'_, [Wave]> {
        Flash::from(self.tables.waves.as_slice())
    }

    fn hash(&self) -> u32 {
        self.hash
    }
}

fn calibration(servo: &Servo) -> Calibration {
    let (min, max) = servo.travel();
    let cycles_per_us = f64::from(CYCLES_PER_US);
    let gain = servo.us_per_degree * cycles_per_us / STEPS_PER_DEGREE * ONE_Q14;
    Calibration {
        neutral: Width((servo.neutral_us * cycles_per_us).round() as u16),
        gain: gain.round() as i16,
        min: Sweep(ceil(min * STEPS_PER_DEGREE) as i16),
        max: Sweep(floor(max * STEPS_PER_DEGREE) as i16),
    }
}

/// A side, its stroke rounded inwards.
fn side(slider: &kinematics::Slider, (min, max): (f64, f64)) -> Option<Slider> {
    let scale = side_scale(slider, max)?;
    let length = |mm: f64| steps(mm, scale);
    let per_mm = f64::from(1u32 << scale.bits);
    Some(Slider {
        scale,
        offset: length(slider.offset) as i16,
        base: length(slider.base) as u16,
        front: length(slider.front) as i16,
        rear: length(slider.rear) as i16,
        nominal: length(slider.nominal) as u16,
        min: ceil((slider.nominal + min) * per_mm) as u16,
        max: floor((slider.nominal + max) * per_mm) as u16,
    })
}

fn steps(mm: f64, scale: Scale) -> i32 {
    (mm * f64::from(1u32 << scale.bits)).round() as i32
}

/// A smallest margin, rounded up.
fn sine(margin: f64) -> Sine {
    Sine(ceil(margin * f64::from(ONE_Q15)) as i16)
}

fn ceil(value: f64) -> i64 {
    (value - SLACK).ceil() as i64
}

fn floor(value: f64) -> i64 {
    (value + SLACK).floor() as i64
}
