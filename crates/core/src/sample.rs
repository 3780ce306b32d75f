//! Robots for the tests of this crate, made at run time from measurements in floating point. The tests compare the
//! integers with the same measurements.
//!
//! [`Sample::odd`] and the random robots have no symmetry at all: no two bars are equally long, each kind of limit
//! differs, and every servo has its own gain, neutral width and travel. So a test fails if the code uses one part's
//! number for another part.

pub mod bounds;
mod end;
mod measures;

use core::mem::offset_of;
use core::ops::Deref;
use std::string::ToString;
use std::vec::Vec;

use lizard_avr::Region;
use lizard_kinematics as kinematics;
use proptest::prelude::*;

use crate::control::safety::Health;
use crate::control::supply::Reading;
use crate::guard::clearance::Clearance;
use crate::numbers::calibration::Reach;
use crate::numbers::checksum::Checksum;
use crate::numbers::gaits::{Channel, Gait, GaitId, Input, SAMPLES, Step, Wave};
use crate::numbers::limits::Limits;
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;
use crate::numbers::section::{Content, Header, Map};
use crate::numbers::slew::Slew;
use crate::numbers::slider::{self, Slider};
use crate::numbers::supplies::{Supplies, Thresholds};
use crate::numbers::units::{Angle, Scale, Sine, Sweep};

pub use end::{SampleCouplers, SampleFiveBar, per_mm};
pub use measures::Measures;

use end::steps;

/// Steps of an angle in a degree.
pub const STEPS_PER_DEGREE: f64 = 65536.0 / 360.0;

/// The gaits of every sample; the last one becomes unsafe halfway.
pub const GAITS: [&str; 6] = ["stand", "sway", "sway left", "swing", "back", "stray"];

/// The range of sweeps that the gaits need of each servo, within the travel; see [`waves`].
const REACH: [Reach; 4] = [
    Reach {
        min: Sweep(-2000),
        max: Sweep(2100),
    },
    Reach {
        min: Sweep(-1100),
        max: Sweep(1000),
    },
    Reach {
        min: Sweep(-1500),
        max: Sweep(1600),
    },
    Reach {
        min: Sweep(-900),
        max: Sweep(800),
    },
];

/// A reference voltage of 1.08 V, and the servos' rail measured through a divider of 10 and 4.7 kiloohms.
const SUPPLIES: Supplies = Supplies {
    reference: 1080,
    board: Thresholds {
        slow: 4500,
        stop: 4300,
        rest: 4100,
    },
    rail_reference: 3378,
    rail: Thresholds {
        slow: 4700,
        stop: 4400,
        rest: 3900,
    },
};

/// The pace on a low supply, percent; it differs from that of robots without a measured rail.
pub const SLOW_PACE: u8 = 67;

/// A robot in integers, and the measurements it was made from.
#[derive(Clone, Debug)]
pub struct Sample {
    pub measures: Measures,
    pub content: Content,
    pub ends: [SampleFiveBar; 2],
    robot: Robot<'static>,
}

impl Deref for Sample {
    type Target = Robot<'static>;

    fn deref(&self) -> &Robot<'static> {
        &self.robot
    }
}

impl Sample {
    /// The robot of these measurements, in integers.
    pub fn new(measures: Measures) -> Self {
        let Measures {
            lizard,
            limits,
            servos,
            slew,
        } = measures;
        let five_bar_of =
            |end| SampleFiveBar::new(&lizard.end(end)).expect("couplers that are long enough");
        let slider_of = |side| {
            let slider = lizard.side(side);
            side_of(&slider, limits.stroke_min, limits.stroke_max)
        };
        let sine_of = |margin: f64| Sine((margin * 32768.0).ceil() as i16);
        let mut names = Vec::new();
        let gaits = gaits(&mut names);
        let ends = [
            five_bar_of(kinematics::End::Head),
            five_bar_of(kinematics::End::Tail),
        ];
        let content = Content {
            name: "sample".to_string(),
            pins: [9, 10, 5, 6],
            rail: Some(14),
            slow_pace: SLOW_PACE,
            maps: core::array::from_fn(|_| Map::default()),
            ends: ends.each_ref().map(SampleFiveBar::content),
            sides: [
                slider_of(kinematics::Side::Left),
                slider_of(kinematics::Side::Right),
            ],
            limits: Limits {
                type2: sine_of(limits.type2),
                type1: sine_of(limits.type1),
                leg: sine_of(limits.leg),
            },
            slew: Slew::new((slew * STEPS_PER_DEGREE / 50.0) as u16),
            neutral: servos.map(|servo| Angle((servo.neutral * STEPS_PER_DEGREE).round() as u16)),
            calibration: servos.map(|servo| servo.calibration()),
            gaits,
            steps: Vec::new(),
            names,
            waves: waves(),
            reach: core::array::from_fn(|servo| {
                let travel = servos[servo].calibration();
                Reach {
                    min: REACH[servo].min.max(travel.min),
                    max: REACH[servo].max.min(travel.max),
                }
            }),
            supplies: SUPPLIES,
            servo_hash: 0x7b5d_2e81,
        };
        Self {
            robot: robot_from(&content),
            measures,
            content,
            ends,
        }
    }

    /// The sample with some of its numbers changed.
    pub fn with(mut self, change: impl FnOnce(&mut Content)) -> Self {
        change(&mut self.content);
        self.robot = robot_from(&self.content);
        self
    }

    /// The robot of [`Measures::paper`].
    pub fn paper() -> Self {
        Self::new(Measures::paper())
    }

    /// The robot of [`Measures::odd`].
    pub fn odd() -> Self {
        Self::new(Measures::odd())
    }

    /// Random robots of [`Measures::random`]. The integer guard accepts the neutral pose of each, as it must for
    /// every robot of a firmware: because of rounding, some poses are safe in floating point but not in integers.
    pub fn random() -> impl Strategy<Value = Self> {
        Measures::random()
            .prop_map(Self::new)
            .prop_filter("stands safely", Self::stands_safely)
    }

    /// True if the integer guard accepts the neutral pose.
    pub fn stands_safely(&self) -> bool {
        Clearance::of(self, &Pose::NEUTRAL)
            .first_hazard(self)
            .is_none()
    }

    /// This robot with another hash, in a section with a correct checksum.
    pub fn with_hash(&self, hash: u32) -> Robot<'static> {
        let mut section = self.content.section();
        let offset = offset_of!(Header, hash);
        section[offset..offset + 4].copy_from_slice(&hash.to_le_bytes());
        let crc = Checksum::of(&section[offset_of!(Header, name)..]).0;
        let offset = offset_of!(Header, crc);
        section[offset..offset + 2].copy_from_slice(&crc.to_le_bytes());
        Robot::unchecked(Region::new(Vec::leak(section))).expect("a whole section")
    }

    /// Adds a gait of this name whose servos do not move.
    pub fn with_gait(self, name: &str) -> Self {
        self.with(|content| {
            content.gaits.push(Gait {
                name_start: content.names.len() as u16,
                name_length: name.len() as u16,
                increment: 100_000,
                ..Gait::STILL
            });
            content.names.extend(name.bytes());
        })
    }

    /// Adds a routine that repeats `steps`. Each step is a kind, a gait or an input, and a count; 0 rounds do not
    /// end.
    pub fn with_routine(self, name: &str, rounds: u16, steps: &[(u8, &str, u16)]) -> Self {
        let steps: Vec<Step> = steps
            .iter()
            .map(|(kind, gait, count)| Step {
                kind: *kind,
                gait: match *gait {
                    "button" => BUTTON.byte(),
                    "nose" => NOSE.byte(),
                    gait => self.id(gait).index() as u8,
                },
                count: *count,
            })
            .collect();
        self.with(|content| {
            let (first, count) = (content.steps.len() as u16, steps.len() as u16);
            content.gaits.push(Gait {
                name_start: content.names.len() as u16,
                name_length: name.len() as u16,
                ..Gait::routine(first, count, rounds)
            });
            content.steps.extend(steps);
            content.names.extend(name.bytes());
        })
    }

    /// The chassis angles of a pose, deg.
    pub fn degrees(&self, pose: &Pose) -> [f64; 4] {
        pose.angles(&self.neutral()).map(degrees)
    }

    /// The exact solution of a pose; `None` if a loop does not close.
    pub fn solve(&self, pose: &Pose) -> Option<kinematics::Solution> {
        let angles = self.degrees(pose);
        self.measures.lizard.solve(&angles.into()).ok()
    }

    /// Sweeps within the travel of every servo.
    pub fn pose(&self) -> impl Strategy<Value = Pose> + use<> {
        self.calibration()
            .map(|servo| (servo.min.0..=servo.max.0).prop_map(Sweep))
            .prop_map(Pose)
    }
}

impl Robot<'_> {
    /// Finds a gait by its name.
    pub fn id(&self, name: &str) -> GaitId {
        GaitId::all(self.gait_count())
            .find(|id| self.name(*id).eq(name.bytes()))
            .expect("a gait of that name")
    }
}

/// Makes the robot of a section, which stays in memory until the tests end.
fn robot_from(content: &Content) -> Robot<'static> {
    Robot::unchecked(Region::new(Vec::leak(content.section()))).expect("a whole section")
}

/// An angle of the core in degrees, 0..360.
pub fn degrees(angle: Angle) -> f64 {
    f64::from(angle.0) / STEPS_PER_DEGREE
}

/// A margin of the core as a sine.
pub fn sine(sine: Sine) -> f64 {
    f64::from(sine.0) / 32768.0
}

/// A side in the finest step that its lengths allow, with its stroke rounded inwards.
pub fn side_of(side: &kinematics::Slider, stroke_min: f64, stroke_max: f64) -> Slider {
    let total = side.base + side.front + side.rear + side.offset.abs();
    let arms = side.front + side.rear + side.offset.abs();
    let is_fine_enough = |scale: &Scale| {
        total.max(side.nominal + stroke_max) * per_mm(*scale) < slider::MAX_STEPS
            && arms * per_mm(*scale) < slider::MAX_ARM_STEPS
    };
    let scale = (0..=14)
        .rev()
        .map(|bits| Scale { bits })
        .find(is_fine_enough);
    let scale = scale.expect("lengths of a robot");
    let to_steps = |mm: f64| steps(mm, scale);
    Slider {
        scale,
        offset: to_steps(side.offset) as i16,
        base: to_steps(side.base) as u16,
        front: to_steps(side.front) as i16,
        rear: to_steps(side.rear) as i16,
        nominal: to_steps(side.nominal) as u16,
        min: ((side.nominal + stroke_min) * per_mm(scale)).ceil() as u16,
        max: ((side.nominal + stroke_max) * per_mm(scale)).floor() as u16,
    }
}

/// A board without a fault: 5.0 V on the chip and 6.0 V on the rail.
pub const HEALTHY: Health = Health {
    supply: Reading {
        reference: 221,
        rail: 393,
    },
    late_edges: 0,
    is_stack_intact: true,
    is_closed: false,
};

/// The button of routines.
pub const BUTTON: Input = Input::button(15);
/// The obstacle switch of routines.
pub const NOSE: Input = Input::nose(16);

/// A sine, a slow rise with a quick fall, and a hump, each to be scaled by a gain.
fn waves() -> Vec<Wave> {
    let wave_of = |function: fn(f64) -> f64| -> Wave {
        core::array::from_fn(|n| (function(n as f64 / SAMPLES as f64) * 1820.0).round() as i16)
    };
    std::vec![
        wave_of(|u| (u * core::f64::consts::TAU).sin()),
        wave_of(|u| if u < 0.75 {
            u / 0.75 - 0.5
        } else {
            3.5 - 4.0 * u
        }),
        wave_of(|u| 4.0 * (1.0 - (u * core::f64::consts::TAU).cos())),
    ]
}

/// The gaits named in [`GAITS`].
fn gaits(names: &mut Vec<u8>) -> Vec<Gait> {
    let channel = |wave, offset, gain| Channel { wave, offset, gain };
    let still = [channel(0, 0, 0); 4];
    let swaying = [
        channel(0, 0, 16_384),
        channel(0, 0x3000, -9_000),
        channel(0, 0x6e00, 12_000),
        channel(0, 0xb000, 5_000),
    ];
    let mut swaying_left = swaying;
    swaying_left[0].gain = 4_000;
    let swinging = [
        channel(1, 0x1234, 8_000),
        channel(1, 0x8765, -8_000),
        channel(0, 0xcdef, 3_000),
        channel(1, 0x4321, -6_500),
    ];
    let straying = [channel(2, 0, 16_384), still[1], still[2], still[3]];
    let one_hertz = (1 << 24) / 50;
    let motions = [
        (still, one_hertz),
        (swaying, one_hertz),
        (swaying_left, one_hertz * 4 / 5),
        (swinging, one_hertz / 2),
        (swaying, -one_hertz),
        (straying, one_hertz),
    ];
    GAITS
        .iter()
        .zip(motions)
        .map(|(name, (channels, increment))| {
            let name_start = names.len() as u16;
            names.extend(name.bytes());
            Gait {
                name_start,
                name_length: name.len() as u16,
                increment,
                channels,
            }
        })
        .collect()
}
