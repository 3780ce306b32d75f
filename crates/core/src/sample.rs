//! Robots for the tests of this crate, made at run time from floating-point measurements. The tests compare the core's
//! integer arithmetic with exact results for the same measurements.
//!
//! [`Sample::asymmetric`] and the random robots have no symmetry: left links differ from right links, front links from
//! rear links, and the head from the tail; each kind of limit has a different value, and every servo has its own gain,
//! neutral width and travel. Therefore a test fails if the code confuses the numbers of two parts.

mod five_bar;
mod measurements;

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
use crate::numbers::calibration::SweepRange;
use crate::numbers::gaits::{Channel, Gait, GaitId, Input, SAMPLES_PER_WAVE, Step, Wave};
use crate::numbers::limits::Limits;
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;
use crate::numbers::section::{Content, Header, Map, write_checksum};
use crate::numbers::slew::Slew;
use crate::numbers::slider::{self, Slider};
use crate::numbers::supplies::{Supplies, Thresholds};
use crate::numbers::units::{Angle, Scale, Sine, Sweep};

pub(crate) use crate::guard::bounds::steps_per_mm;
pub use five_bar::{SampleCouplers, SampleFiveBar};
pub use measurements::Measurements;

use five_bar::to_steps;

/// The number of steps of an [`Angle`] in a degree.
pub const STEPS_PER_DEGREE: f64 = 65536.0 / 360.0;

/// The names of the gaits that every sample has. The cycle of the last gait includes unsafe poses.
pub const GAIT_NAMES: [&str; 6] = ["stand", "sway", "sway left", "swing", "back", "stray"];

/// The lowest and the highest sweep of each servo that all gaits except `stray` need, 1/65536 turn; see [`make_waves`]
/// and [`add_gaits`].
const GAIT_TRAVEL: [[i16; 2]; 4] = [[-2000, 2100], [-1100, 1000], [-1500, 1600], [-900, 800]];

/// Returns the thresholds of a supply, mV: below the first, gaits slow down; below the second, the robot freezes; below
/// the third, the pulses end.
pub const fn thresholds([slow_mv, stop_mv, rest_mv]: [u16; 3]) -> Thresholds {
    Thresholds {
        slow_mv,
        stop_mv,
        rest_mv,
    }
}

/// Supplies with a reference voltage of 1.08 V, and a rail that is measured through a divider of 10 and 4.7 kiloohms.
const SUPPLIES: Supplies = Supplies {
    reference_mv: 1080,
    board: thresholds([4500, 4300, 4100]),
    rail_reference_mv: 3378,
    rail: thresholds([4700, 4400, 3900]),
};

/// The pace on a low supply, percent, which differs from the pace of robots without a measured rail.
pub const SLOW_PACE: u8 = 67;

/// A robot in integers, with the measurements from which it was made.
#[derive(Clone, Debug)]
pub struct Sample {
    pub measurements: Measurements,
    /// The content of the robot's section.
    pub content: Content,
    robot: Robot<'static>,
}

impl Deref for Sample {
    type Target = Robot<'static>;

    fn deref(&self) -> &Robot<'static> {
        &self.robot
    }
}

impl Sample {
    /// Converts measurements to a robot in integers.
    pub fn new(measurements: Measurements) -> Self {
        let (lizard, limits) = (measurements.lizard, measurements.limits);
        let servos = measurements.servos;
        let calibration = servos.map(|servo| servo.calibration());
        let to_sine = |margin: f64| Sine((margin * 32768.0).ceil() as i16);
        let mut content = Content {
            name: "sample".to_string(),
            pins: [9, 10, 5, 6],
            rail_pin: Some(14),
            slow_pace: SLOW_PACE,
            maps: core::array::from_fn(|_| Map::default()),
            ends: kinematics::End::ALL.map(|end| {
                let five_bar = SampleFiveBar::new(&lizard.end(end));
                five_bar.expect("the couplers are long enough").lengths
            }),
            sliders: kinematics::Side::ALL.map(|side| {
                slider_in_steps(&lizard.side(side), limits.stroke_min, limits.stroke_max)
            }),
            limits: Limits {
                type2: to_sine(limits.type2),
                type1: to_sine(limits.type1),
                leg: to_sine(limits.leg),
            },
            slew: Slew::new((measurements.slew_deg_per_s * STEPS_PER_DEGREE / 50.0) as u16),
            neutral_angles: servos
                .map(|servo| Angle((servo.neutral_deg * STEPS_PER_DEGREE).round() as u16)),
            calibration,
            gaits: Vec::new(),
            steps: Vec::new(),
            names: Vec::new(),
            waves: make_waves(),
            needed_travel: core::array::from_fn(|servo| {
                let [min, max] = GAIT_TRAVEL[servo].map(Sweep);
                SweepRange {
                    min: min.max(calibration[servo].travel_min),
                    max: max.min(calibration[servo].travel_max),
                }
            }),
            supplies: SUPPLIES,
            servo_hash: 0x7b5d_2e81,
        };
        add_gaits(&mut content);
        Self {
            robot: leak_robot(content.section_bytes()),
            measurements,
            content,
        }
    }

    /// Applies `change` to the content of the section and rebuilds the robot.
    pub fn with_changes(mut self, change: impl FnOnce(&mut Content)) -> Self {
        change(&mut self.content);
        self.robot = leak_robot(self.content.section_bytes());
        self
    }

    /// Creates the robot of [`Measurements::paper`].
    pub fn paper() -> Self {
        Self::new(Measurements::paper())
    }

    /// Creates the robot of [`Measurements::asymmetric`].
    pub fn asymmetric() -> Self {
        Self::new(Measurements::asymmetric())
    }

    /// Yields random robots of [`Measurements::random`] whose neutral pose the integer guard accepts, as
    /// [`Robot::open`] requires. Because of rounding, some poses are safe in floating point but not in integers.
    pub fn random() -> impl Strategy<Value = Self> {
        Measurements::random()
            .prop_map(Self::new)
            .prop_filter("stands safely", Self::stands_safely)
    }

    /// Yields random robots, each with a random pose within the travel of every servo.
    pub fn random_with_pose() -> impl Strategy<Value = (Self, Pose)> {
        Self::random().prop_flat_map(|robot| {
            let pose = robot.any_pose();
            (Just(robot), pose)
        })
    }

    /// True if the integer guard accepts the neutral pose.
    pub fn stands_safely(&self) -> bool {
        Clearance::measure(self, &Pose::NEUTRAL)
            .first_hazard(self)
            .is_none()
    }

    /// Builds this robot with another hash, in a section with a correct checksum.
    pub fn with_hash(&self, hash: u32) -> Robot<'static> {
        let mut section = self.content.section_bytes();
        let offset = offset_of!(Header, hash);
        section[offset..offset + 4].copy_from_slice(&hash.to_le_bytes());
        write_checksum(&mut section);
        leak_robot(section)
    }

    /// Adds a gait of this name whose servos do not move.
    pub fn with_gait(self, name: &str) -> Self {
        let gait = Gait {
            increment: 100_000,
            ..Gait::STILL
        };
        self.with_changes(|content| add_gait(content, name, gait))
    }

    /// Adds a routine that executes `steps` for `round_count` rounds, or endlessly if that is 0. Each step consists of
    /// its kind, the name of a gait or an input, and a count.
    pub fn with_routine(self, name: &str, round_count: u16, steps: &[(u8, &str, u16)]) -> Self {
        let steps: Vec<Step> = steps
            .iter()
            .map(|(kind, gait_or_input, count)| Step {
                kind: *kind,
                gait: match *gait_or_input {
                    "button" => BUTTON.byte(),
                    "nose" => NOSE.byte(),
                    gait => self.gait_id(gait).index() as u8,
                },
                count: *count,
            })
            .collect();
        self.with_changes(|content| {
            let (first_step, step_count) = (content.steps.len() as u16, steps.len() as u16);
            let routine = Gait::routine(first_step, step_count, round_count);
            add_gait(content, name, routine);
            content.steps.extend(steps);
        })
    }

    /// Computes the chassis angles of a pose, deg.
    pub fn degrees(&self, pose: &Pose) -> [f64; 4] {
        pose.angles(&self.neutral_angles()).map(to_degrees)
    }

    /// Solves a pose in floating point; returns `None` if a linkage cannot be assembled in this pose.
    pub fn solve(&self, pose: &Pose) -> Option<kinematics::Solution> {
        let angles = self.degrees(pose);
        self.measurements.lizard.solve(&angles.into()).ok()
    }

    /// Yields random poses within the travel of every servo.
    pub fn any_pose(&self) -> impl Strategy<Value = Pose> + use<> {
        self.calibration()
            .map(|servo| (servo.travel_min.0..=servo.travel_max.0).prop_map(Sweep))
            .prop_map(Pose)
    }
}

impl Robot<'_> {
    /// Finds a gait by its name.
    pub fn gait_id(&self, name: &str) -> GaitId {
        GaitId::all(self.gait_count())
            .find(|id| self.gait_name(*id).eq(name.bytes()))
            .expect("the robot has a gait of that name")
    }
}

/// Builds the robot of a section, which stays in memory until the tests end.
fn leak_robot(section: Vec<u8>) -> Robot<'static> {
    Robot::unchecked(Region::new(Vec::leak(section))).expect("the section is complete")
}

/// Converts an angle of the core to degrees, 0..360.
pub fn to_degrees(angle: Angle) -> f64 {
    f64::from(angle.0) / STEPS_PER_DEGREE
}

/// Converts a sine of the core to a floating-point number.
pub fn to_f64(sine: Sine) -> f64 {
    f64::from(sine.0) / 32768.0
}

/// Converts a slider to the finest steps that its lengths allow. Rounds the stroke, given in mm, inwards.
pub fn slider_in_steps(exact: &kinematics::Slider, stroke_min: f64, stroke_max: f64) -> Slider {
    let total = exact.base + exact.front_arm + exact.rear_arm + exact.front_offset.abs();
    let arms = exact.front_arm + exact.rear_arm + exact.front_offset.abs();
    let is_fine_enough = |scale: &Scale| {
        total.max(exact.nominal_length + stroke_max) * steps_per_mm(*scale)
            < slider::MAX_LENGTH_STEPS
            && arms * steps_per_mm(*scale) < slider::MAX_ARM_STEPS
    };
    let scale = (0..=14)
        .rev()
        .map(|bits| Scale { bits })
        .find(is_fine_enough);
    let scale = scale.expect("the lengths are those of a robot");
    let in_steps = |mm: f64| to_steps(mm, scale);
    Slider {
        scale,
        offset: in_steps(exact.front_offset) as i16,
        base: in_steps(exact.base) as u16,
        front_arm: in_steps(exact.front_arm) as i16,
        rear_arm: in_steps(exact.rear_arm) as i16,
        nominal_length: in_steps(exact.nominal_length) as u16,
        stroke_min: ((exact.nominal_length + stroke_min) * steps_per_mm(scale)).ceil() as u16,
        stroke_max: ((exact.nominal_length + stroke_max) * steps_per_mm(scale)).floor() as u16,
    }
}

/// The health of a board without a fault, with 5.0 V at the chip and 6.0 V at the rail.
pub const HEALTHY_BOARD: Health = Health {
    supply: Reading {
        reference: 221,
        rail: 393,
    },
    late_edges: 0,
    is_stack_intact: true,
    is_contact_closed: false,
};

/// The button for which routines wait.
pub const BUTTON: Input = Input::button(15);
/// The obstacle switch for which routines wait.
pub const NOSE: Input = Input::nose(16);

/// Makes three waveforms: a sine, a slow rise with a fast fall, and a hump. The value 1 of a formula becomes 1820 steps
/// of an [`Angle`], or 10 degrees. Each channel of a gait multiplies its waveform by a gain.
fn make_waves() -> Vec<Wave> {
    let make_wave = |function: fn(f64) -> f64| -> Wave {
        core::array::from_fn(|n| {
            (function(n as f64 / SAMPLES_PER_WAVE as f64) * 1820.0).round() as i16
        })
    };
    std::vec![
        make_wave(|phase| (phase * core::f64::consts::TAU).sin()),
        make_wave(|phase| if phase < 0.75 {
            phase / 0.75 - 0.5
        } else {
            3.5 - 4.0 * phase
        }),
        make_wave(|phase| 4.0 * (1.0 - (phase * core::f64::consts::TAU).cos())),
    ]
}

/// Adds a gait of this name.
fn add_gait(content: &mut Content, name: &str, gait: Gait) {
    content.gaits.push(Gait {
        name_start: content.names.len() as u16,
        name_length: name.len() as u16,
        ..gait
    });
    content.names.extend(name.bytes());
}

/// Adds the gaits of [`GAIT_NAMES`].
fn add_gaits(content: &mut Content) {
    let channel = |wave, offset, gain| Channel { wave, offset, gain };
    let still_channels = [channel(0, 0, 0); 4];
    let swaying_channels = [
        channel(0, 0, 16_384),
        channel(0, 0x3000, -9_000),
        channel(0, 0x6e00, 12_000),
        channel(0, 0xb000, 5_000),
    ];
    let mut swaying_left_channels = swaying_channels;
    swaying_left_channels[0].gain = 4_000;
    let swinging_channels = [
        channel(1, 0x1234, 8_000),
        channel(1, 0x8765, -8_000),
        channel(0, 0xcdef, 3_000),
        channel(1, 0x4321, -6_500),
    ];
    let mut straying_channels = still_channels;
    straying_channels[0] = channel(2, 0, 16_384);
    let one_hertz_increment = (1 << 24) / 50;
    let motions = [
        (still_channels, one_hertz_increment),
        (swaying_channels, one_hertz_increment),
        (swaying_left_channels, one_hertz_increment * 4 / 5),
        (swinging_channels, one_hertz_increment / 2),
        (swaying_channels, -one_hertz_increment),
        (straying_channels, one_hertz_increment),
    ];
    for (name, (channels, increment)) in GAIT_NAMES.into_iter().zip(motions) {
        let gait = Gait {
            increment,
            channels,
            ..Gait::STILL
        };
        add_gait(content, name, gait);
    }
}
