//! The robot's numbers as the firmware has them: integers, in the types of the
//! core.
//!
//! Sixteen bits hold any robot's lengths if their step follows the robot's size,
//! so each mechanism has a scale of its own. Where a number does not come out
//! even, it is rounded to the safe side: limits of margins up, strokes and
//! travels inwards, the slew limit down.

use std::sync::Arc;

use lizard_avr::Flash;
use lizard_core::calibration::Calibration;
use lizard_core::couplers::{self, Couplers};
use lizard_core::curve::Table;
use lizard_core::five_bar::FiveBar;
use lizard_core::guard::Limits;
use lizard_core::point_to_point::Slew;
use lizard_core::slider::Slider;
use lizard_core::units::{Angle, Scale, Sine, Sweep, Width};
use lizard_kinematics as kinematics;

use crate::measure::Measures;
use crate::scale;
use crate::servo::Servo;
use crate::table::Tables;
use crate::units::{CYCLES_PER_US, FRAMES_PER_SECOND, ONE_Q14, ONE_Q15, STEPS_PER_DEGREE};

/// What rounding may add to a number that robot.toml gives exactly.
const SLACK: f64 = 1e-6;

/// A robot in the integers of its firmware, in the types of the core.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Numbers {
    /// Arduino numbers of the servos' pins, A1 to A4; 14 to 19 are A0 to A5.
    pub pins: [u8; 4],
    pub ends: [Loop; 2],
    pub sides: [Slider; 2],
    pub limits: Limits,
    pub slew: Slew,
    pub neutral: [Angle; 4],
    pub calibration: [Calibration; 4],
    pub tables: Arc<Tables>,
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

impl Numbers {
    /// The integers of a robot.
    pub fn new(measures: &Measures, tables: Tables) -> Self {
        let Measures {
            lizard,
            servos,
            limits,
            pace,
            ..
        } = measures;
        Self {
            pins: servos.map(|servo| servo.pin),
            ends: kinematics::End::ALL.map(|end| Loop::new(&lizard.end(end))),
            sides: kinematics::Side::ALL.map(|of| side(&lizard.side(of), limits)),
            limits: Limits {
                type2: sine(limits.type2),
                type1: sine(limits.type1),
                leg: sine(limits.leg),
            },
            slew: Slew::new(floor(pace.slew * STEPS_PER_DEGREE / FRAMES_PER_SECOND) as u16),
            neutral: servos
                .map(|servo| Angle((servo.neutral * STEPS_PER_DEGREE).round() as u32 as u16)),
            calibration: servos.map(|servo| calibration(&servo)),
            tables: Arc::new(tables),
        }
    }
}

impl Bars {
    /// Whether the table of folded couplers is needed.
    pub fn differ_much(&self) -> bool {
        self.folded.is_some()
    }
}

impl Loop {
    fn new(bars: &kinematics::FiveBar) -> Self {
        let scale = scale::of_loop(bars);
        let length = |mm: f64| steps(mm, scale) as i16;
        // The crank tips part the furthest where both cranks point outwards.
        let [base, left, right] = [bars.base, bars.crank_left, bars.crank_right].map(length);
        let furthest = (base as u32 + left as u32 + right as u32) / 2 + 2;
        let [a, b] = [bars.coupler_left, bars.coupler_right].map(length);
        let near_stretched = Couplers::is_near_stretched(a, b, furthest * furthest);
        Self {
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
                folded: Couplers::differ_much(a, b).then(|| couplers::folded(a, b)),
                skew: (a != b).then(|| couplers::skew(a, b)),
            },
        }
    }

    /// The loop as the core has it.
    pub fn five_bar(&self) -> FiveBar<'_> {
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

fn calibration(servo: &Servo) -> Calibration {
    let (min, max) = servo.travel();
    let gain = servo.us_per_degree * CYCLES_PER_US / STEPS_PER_DEGREE * ONE_Q14;
    Calibration {
        neutral: Width((servo.neutral_us * CYCLES_PER_US).round() as u16),
        gain: gain.round() as i16,
        min: Sweep(ceil(min * STEPS_PER_DEGREE) as i16),
        max: Sweep(floor(max * STEPS_PER_DEGREE) as i16),
    }
}

/// A side, its stroke rounded inwards.
fn side(slider: &kinematics::Slider, limits: &kinematics::Limits) -> Slider {
    let scale = scale::of_side(slider, limits.stroke_max);
    let length = |mm: f64| steps(mm, scale);
    let per_mm = scale::steps_per_mm(scale);
    Slider {
        scale,
        offset: length(slider.offset) as i16,
        base: length(slider.base) as u16,
        front: length(slider.front) as i16,
        rear: length(slider.rear) as i16,
        nominal: length(slider.nominal) as u16,
        min: ceil((slider.nominal + limits.stroke_min) * per_mm) as u16,
        max: floor((slider.nominal + limits.stroke_max) * per_mm) as u16,
    }
}

fn steps(mm: f64, scale: Scale) -> i32 {
    (mm * scale::steps_per_mm(scale)).round() as i32
}

/// A smallest margin, rounded up.
fn sine(margin: f64) -> Sine {
    Sine(ceil(margin * ONE_Q15) as i16)
}

fn ceil(value: f64) -> i64 {
    (value - SLACK).ceil() as i64
}

fn floor(value: f64) -> i64 {
    (value + SLACK).floor() as i64
}
