//! Robots for the tests of this crate, made at run time from measurements in
//! floating point, which are also the truth that the integers are held against.
//!
//! [`Sample::odd`] and the random ones have no symmetry at all: no two bars are
//! equally long, each kind of limit differs, every servo has a gain, a neutral
//! width and a travel of its own. What one part is measured by instead of another
//! shows.

use std::vec::Vec;

use lizard_avr::Flash;
use lizard_kinematics as kinematics;
use lizard_kinematics::{Leg, Links, Lizard};
use proptest::prelude::*;

use crate::calibration::Calibration;
use crate::couplers::{self, Couplers};
use crate::curve::Table;
use crate::five_bar::{self, FiveBar};
use crate::gait::{Channel, Gait, GaitId, SAMPLES, Wave};
use crate::limits::Limits;
use crate::part::{End, Side};
use crate::point_to_point::Slew;
use crate::pose::Pose;
use crate::robot::Robot;
use crate::slider::{self, Slider};
use crate::units::{Angle, Scale, Sine, Sweep, Width};

/// Steps of an angle in a degree.
pub const STEPS_PER_DEGREE: f64 = 65536.0 / 360.0;

/// The gaits of every sample; the last one leaves safe ground halfway.
pub const GAITS: [&str; 6] = ["stand", "sway", "sway left", "swing", "back", "stray"];

/// One servo as robot.toml has it.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    /// Chassis angle at the neutral width, deg.
    pub neutral: f64,
    pub neutral_us: f64,
    /// Negative for a reversed servo.
    pub us_per_degree: f64,
    pub min_us: f64,
    pub max_us: f64,
}

/// A robot as a builder measures it.
#[derive(Clone, Copy, Debug)]
pub struct Measures {
    pub lizard: Lizard,
    pub limits: kinematics::Limits,
    pub servos: [Servo; 4],
    /// Fastest point-to-point move, deg/s.
    pub slew: f64,
}

/// A robot in integers, and what it was made from.
#[derive(Clone, Debug)]
pub struct Sample {
    pub measures: Measures,
    pub ends: [Loop; 2],
    pub sides: [Slider; 2],
    pub limits: Limits,
    pub slew: Slew,
    pub neutral: [Angle; 4],
    pub calibration: [Calibration; 4],
    pub gaits: Vec<Gait>,
    pub names: Vec<u8>,
    pub waves: Vec<Wave>,
    pub hash: u32,
}

/// The bars of one end, with every table that they need.
#[derive(Clone, Debug)]
pub struct Loop {
    /// Half the sum of base and cranks is the farthest that crank tips part.
    pub bars: [i16; 3],
    pub couplers: Bars,
}

/// Two couplers and their tables.
#[derive(Clone, Debug)]
pub struct Bars {
    pub left: i16,
    pub right: i16,
    rise: Table,
    stretched: Table,
    folded: Option<Table>,
    skew: Option<Table>,
}

impl Bars {
    pub fn new(left: i16, right: i16) -> Self {
        let unequal = left != right;
        Self {
            left,
            right,
            rise: couplers::rise(left, right),
            stretched: couplers::stretched(left, right),
            folded: Couplers::differ_much(left, right).then(|| couplers::folded(left, right)),
            skew: unequal.then(|| couplers::skew(left, right)),
        }
    }

    pub fn couplers(&self) -> Couplers<'_> {
        let tables = couplers::Tables {
            rise: Flash::from(&self.rise),
            stretched: Some(Flash::from(&self.stretched)),
            folded: self.folded.as_ref().map(Flash::from),
            skew: self.skew.as_ref().map(Flash::from),
        };
        Couplers::new(self.left, self.right, tables)
    }
}

impl Loop {
    /// Bars in mm, in the finest step that holds them; none if a coupler is too
    /// short beside the rest.
    pub fn new(bars: &kinematics::FiveBar) -> Option<Self> {
        let [base, left, right] = [bars.base, bars.crank_left, bars.crank_right];
        let couplers = [bars.coupler_left, bars.coupler_right];
        let longest = couplers.iter().copied().fold(base + left + right, f64::max);
        let scale = (0..=14)
            .rev()
            .map(|bits| Scale { bits })
            .find(|scale| longest * per_mm(*scale) < five_bar::LONGEST)?;
        let [a, b] = couplers.map(|mm| steps(mm, scale) as i16);
        if a.min(b) < five_bar::SHORTEST_COUPLER {
            return None;
        }
        Some(Self {
            bars: [base, left, right].map(|mm| steps(mm, scale) as i16),
            couplers: Bars::new(a, b),
        })
    }

    pub fn five_bar(&self) -> FiveBar<'_> {
        let [base, left, right] = self.bars;
        FiveBar::new(base, left, right, self.couplers.couplers())
    }
}

impl Measures {
    /// The paper's robot, with the limits and servos of robots/paper.toml.
    pub fn paper() -> Self {
        let servo = |neutral| Servo {
            neutral,
            neutral_us: 1500.0,
            us_per_degree: 10.0,
            min_us: 600.0,
            max_us: 2400.0,
        };
        let end = [20.0, 30.0, 50.0, 50.0, 30.0];
        let side = [135.0, 30.0, 45.0, 45.0, 30.0];
        Self {
            lizard: lizard(end, end, side, side),
            limits: kinematics::Limits {
                type2: 0.3,
                type1: 0.3,
                leg: 0.3,
                stroke_min: -15.0,
                stroke_max: 45.0,
            },
            servos: [138.590378, 41.409622, 318.590378, 221.409622].map(servo),
            slew: 300.0,
        }
    }

    /// A robot of which no two parts are alike.
    pub fn odd() -> Self {
        let servo = |neutral, neutral_us, us_per_degree: f64, back: f64, on: f64| Servo {
            neutral,
            neutral_us,
            us_per_degree,
            min_us: neutral_us - us_per_degree.abs() * back,
            max_us: neutral_us + us_per_degree.abs() * on,
        };
        Self {
            lizard: lizard(
                [26.0, 31.0, 52.0, 57.0, 34.0],
                [33.0, 37.0, 66.0, 61.0, 29.0],
                [141.0, 33.0, 43.0, 48.0, 28.0],
                [141.0, 25.0, 47.0, 51.0, 36.0],
            ),
            limits: kinematics::Limits {
                type2: 0.34,
                type1: 0.22,
                leg: 0.13,
                stroke_min: -21.0,
                stroke_max: 38.0,
            },
            servos: [
                servo(132.37, 1510.0, 10.5, 71.0, 83.0),
                servo(47.91, 1465.0, -9.3, 88.0, 66.0),
                servo(309.64, 1533.0, 11.7, 74.0, 69.0),
                servo(226.18, 1492.0, -8.6, 81.0, 92.0),
            ],
            slew: 60.0,
        }
    }

    /// Random robots without symmetry that stand safely in their neutral pose.
    pub fn random() -> impl Strategy<Value = Self> {
        let end = || (15.0..40.0, 22.0..45.0, 45.0..75.0, 45.0..75.0, 22.0..45.0);
        let side = || (20.0..42.0, 35.0..55.0, 35.0..55.0, 20.0..42.0);
        let limits = (
            0.12..0.4,
            0.0..0.35,
            0.0..0.35,
            -40.0..-5.0,
            5.0..60.0,
            20.0..600.0,
        );
        let servo = || {
            (
                -15.0..15.0f64,
                1300.0..1700.0f64,
                6.0..22.0f64,
                any::<bool>(),
                40.0..110.0f64,
                40.0..110.0f64,
            )
        };
        let servos = [servo(), servo(), servo(), servo()];
        let all = (end(), end(), 90.0..200.0, side(), side(), limits, servos);
        all.prop_map(|(head, tail, base, left, right, limits, servos)| {
            let neutral = [130.0, 50.0, 310.0, 230.0];
            let servos = core::array::from_fn(|n| {
                let (aside, neutral_us, gain, reversed, back, on) = servos[n];
                Servo {
                    neutral: neutral[n] + aside,
                    neutral_us,
                    us_per_degree: if reversed { -gain } else { gain },
                    min_us: (neutral_us - gain * back).max(500.0),
                    max_us: (neutral_us + gain * on).min(2500.0),
                }
            });
            let end = |(l0, l1, l2, l3, l4)| [l0, l1, l2, l3, l4];
            let side = |(l11, l12, l13, l14)| [base, l11, l12, l13, l14];
            let (type2, type1, leg, stroke_min, stroke_max, slew) = limits;
            Self {
                lizard: lizard(end(head), end(tail), side(left), side(right)),
                limits: kinematics::Limits {
                    type2,
                    type1,
                    leg,
                    stroke_min,
                    stroke_max,
                },
                servos,
                slew,
            }
        })
        .prop_filter("stands safely", |measures| {
            let standing = measures.servos.map(|servo| servo.neutral);
            let solved = measures.lizard.solve(&standing.into());
            solved.is_ok_and(|solution| measures.limits.allow(&solution))
        })
    }
}

impl Sample {
    pub fn new(measures: Measures) -> Self {
        let Measures {
            lizard,
            limits,
            servos,
            slew,
        } = measures;
        let end = |end| Loop::new(&lizard.end(end)).expect("couplers that are long enough");
        let side = |side| {
            let slider = lizard.side(side);
            side_of(&slider, limits.stroke_min, limits.stroke_max)
        };
        let limit = |margin: f64| Sine((margin * 32768.0).ceil() as i16);
        let mut names = Vec::new();
        let gaits = gaits(&mut names);
        Self {
            measures,
            ends: [end(kinematics::End::Head), end(kinematics::End::Tail)],
            sides: [side(kinematics::Side::Left), side(kinematics::Side::Right)],
            limits: Limits {
                type2: limit(limits.type2),
                type1: limit(limits.type1),
                leg: limit(limits.leg),
            },
            slew: Slew::new((slew * STEPS_PER_DEGREE / 50.0) as u16),
            neutral: servos.map(|servo| Angle((servo.neutral * STEPS_PER_DEGREE).round() as u16)),
            calibration: servos.map(|servo| servo.calibration()),
            gaits,
            names,
            waves: waves(),
            hash: 0x1f0a_9c3e,
        }
    }

    /// See [`Measures::paper`].
    pub fn paper() -> Self {
        Self::new(Measures::paper())
    }

    /// See [`Measures::odd`].
    pub fn odd() -> Self {
        Self::new(Measures::odd())
    }

    /// See [`Measures::random`].
    pub fn random() -> impl Strategy<Value = Self> {
        Measures::random().prop_map(Self::new)
    }

    /// A gait by its name.
    pub fn id(&self, name: &str) -> GaitId {
        GaitId::all(self.gaits().len())
            .find(|id| self.name(*id).eq(name.bytes()))
            .expect("a gait of that name")
    }

    /// With one more gait that stands still, of this name.
    pub fn with_gait(mut self, name: &str) -> Self {
        self.gaits.push(Gait {
            name_start: self.names.len() as u16,
            name_length: name.len() as u8,
            ..Gait::STILL
        });
        self.names.extend(name.bytes());
        self
    }

    /// The chassis angles of a pose, deg.
    pub fn degrees(&self, pose: &Pose) -> [f64; 4] {
        pose.angles(&self.neutral).map(degrees)
    }

    /// The truth about a pose; none where a loop does not close.
    pub fn solve(&self, pose: &Pose) -> Option<kinematics::Solution> {
        let angles = self.degrees(pose);
        self.measures.lizard.solve(&angles.into()).ok()
    }

    /// Sweeps within the travel of every servo.
    pub fn pose(&self) -> impl Strategy<Value = Pose> + use<> {
        self.calibration
            .map(|servo| (servo.min.0..=servo.max.0).prop_map(Sweep))
            .prop_map(Pose)
    }
}

impl Servo {
    fn calibration(&self) -> Calibration {
        let sweep = |us: f64| (us - self.neutral_us) / self.us_per_degree * STEPS_PER_DEGREE;
        let ends = [sweep(self.min_us), sweep(self.max_us)];
        Calibration {
            neutral: Width((self.neutral_us * 16.0).round() as u16),
            gain: (self.us_per_degree * 16.0 / STEPS_PER_DEGREE * 16384.0).round() as i16,
            min: Sweep(ends[0].min(ends[1]).ceil() as i16),
            max: Sweep(ends[0].max(ends[1]).floor() as i16),
        }
    }
}

impl Robot for Sample {
    fn end(&self, end: End) -> FiveBar<'_> {
        match end {
            End::Head => self.ends[0].five_bar(),
            End::Tail => self.ends[1].five_bar(),
        }
    }

    fn side(&self, side: Side) -> Slider {
        match side {
            Side::Left => self.sides[0],
            Side::Right => self.sides[1],
        }
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
        Flash::from(self.gaits.as_slice())
    }

    fn names(&self) -> Flash<'_, [u8]> {
        Flash::from(self.names.as_slice())
    }

    fn waves(&self) -> Flash<'_, [Wave]> {
        Flash::from(self.waves.as_slice())
    }

    fn hash(&self) -> u32 {
        self.hash
    }
}

/// An angle of the core in degrees, 0..360.
pub fn degrees(angle: Angle) -> f64 {
    f64::from(angle.0) / STEPS_PER_DEGREE
}

/// A margin of the core as a sine.
pub fn sine(sine: Sine) -> f64 {
    f64::from(sine.0) / 32768.0
}

/// Steps in a millimetre.
pub fn per_mm(scale: Scale) -> f64 {
    f64::from(1u32 << scale.bits)
}

fn steps(mm: f64, scale: Scale) -> i32 {
    (mm * per_mm(scale)).round() as i32
}

/// The links of two ends (base, left crank, couplers, right crank) and two sides
/// (chassis, rear arm, rear and front half of the slider, front arm).
fn lizard(head: [f64; 5], tail: [f64; 5], left: [f64; 5], right: [f64; 5]) -> Lizard {
    let mut links = [0.0; 20];
    for (place, part) in [head, tail, left, right].iter().enumerate() {
        links[5 * place..][..5].copy_from_slice(part);
    }
    Lizard {
        links: Links::from(links),
        leg: Leg {
            ground: 50.0,
            crank: 45.0,
            coupler: 50.0,
            follower: 45.0,
        },
    }
}

/// A side in the finest step that holds it, its stroke rounded inwards.
pub fn side_of(side: &kinematics::Slider, stroke_min: f64, stroke_max: f64) -> Slider {
    let all = side.base + side.front + side.rear + side.offset.abs();
    let across = side.front + side.rear + side.offset.abs();
    let fits = |scale: &Scale| {
        all.max(side.nominal + stroke_max) * per_mm(*scale) < slider::LONGEST
            && across * per_mm(*scale) < slider::LONGEST_ARMS
    };
    let scale = (0..=14).rev().map(|bits| Scale { bits }).find(fits);
    let scale = scale.expect("lengths of a robot");
    let length = |mm: f64| steps(mm, scale);
    Slider {
        scale,
        offset: length(side.offset) as i16,
        base: length(side.base) as u16,
        front: length(side.front) as i16,
        rear: length(side.rear) as i16,
        nominal: length(side.nominal) as u16,
        min: ((side.nominal + stroke_min) * per_mm(scale)).ceil() as u16,
        max: ((side.nominal + stroke_max) * per_mm(scale)).floor() as u16,
    }
}

/// A sine, a slow rise with a quick fall, and a hump, as large as a gain asks.
fn waves() -> Vec<Wave> {
    let wave = |of: fn(f64) -> f64| -> Wave {
        core::array::from_fn(|n| (of(n as f64 / SAMPLES as f64) * 1820.0).round() as i16)
    };
    std::vec![
        wave(|u| (u * core::f64::consts::TAU).sin()),
        wave(|u| if u < 0.75 {
            u / 0.75 - 0.5
        } else {
            3.5 - 4.0 * u
        }),
        wave(|u| 4.0 * (1.0 - (u * core::f64::consts::TAU).cos())),
    ]
}

/// What [`GAITS`] names.
fn gaits(names: &mut Vec<u8>) -> Vec<Gait> {
    let channel = |wave, offset, gain| Channel { wave, offset, gain };
    let still = [channel(0, 0, 0); 4];
    let swaying = [
        channel(0, 0, 16_384),
        channel(0, 0x3000, -9_000),
        channel(0, 0x7000, 12_000),
        channel(0, 0xb000, 5_000),
    ];
    let mut other = swaying;
    other[0].gain = 4_000;
    let swinging = [
        channel(1, 0x1234, 8_000),
        channel(1, 0x8765, -8_000),
        channel(0, 0xcdef, 3_000),
        channel(1, 0x4321, -6_500),
    ];
    let straying = [channel(2, 0, 16_384), still[1], still[2], still[3]];
    let second = (1 << 24) / 50;
    let all = [
        (still, second),
        (swaying, second),
        (other, second * 4 / 5),
        (swinging, second / 2),
        (swaying, -second),
        (straying, second),
    ];
    GAITS
        .iter()
        .zip(all)
        .map(|(name, (channels, increment))| {
            let name_start = names.len() as u16;
            names.extend(name.bytes());
            Gait {
                name_start,
                name_length: name.len() as u8,
                increment,
                channels,
            }
        })
        .collect()
}
