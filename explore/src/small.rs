//! A small robot: the paper's, with few and short gaits, so that the states of a
//! walk soon come round again. One of its gaits is not safe, which no robot.toml
//! would be allowed.

use std::fmt;

use lizard_avr::Flash;
use lizard_core::adjustment::Reach;
use lizard_core::calibration::Calibration;
use lizard_core::five_bar::FiveBar;
use lizard_core::gait::{Channel, Gait, SAMPLES, Wave};
use lizard_core::limits::Limits;
use lizard_core::part::{End, Servo, Side};
use lizard_core::point_to_point::Slew;
use lizard_core::robot::Robot;
use lizard_core::slider::Slider;
use lizard_core::supply::Supplies;
use lizard_core::units::{Angle, Sweep};
use lizard_robot::CoreRobot;

/// The paper's robot with gaits of its own.
#[derive(Clone)]
pub struct Small {
    firmware: CoreRobot,
    gaits: Vec<Gait>,
    names: Vec<u8>,
    waves: Vec<Wave>,
}

/// A third of the paper's speed, 1/65536 turn in a frame: servos that begin elsewhere than
/// they are leap by more than that.
const PER_FRAME: u16 = 364;

/// Every gait needs no more than this of a servo.
const NEED: i16 = 1_000;

impl Small {
    /// With `stand`, `walk`, `trot` and `stray`, which leaves safe ground.
    ///
    /// # Panics
    /// If robots/paper.toml is no robot.
    #[must_use]
    pub fn new() -> Self {
        let text = include_str!("../../robots/paper.toml");
        let robot = lizard_robot::Robot::parse(text).expect("robots/paper.toml is right");
        let sine = |n: usize| (n as f64 / SAMPLES as f64 * std::f64::consts::TAU).sin();
        let hump =
            |n: usize| 4.0 * (1.0 - (n as f64 / SAMPLES as f64 * std::f64::consts::TAU).cos());
        let wave = |of: &dyn Fn(usize) -> f64| -> Wave {
            std::array::from_fn(|n| (of(n) * 1820.0).round() as i16)
        };
        let mut small = Self {
            firmware: robot.firmware().clone(),
            gaits: Vec::new(),
            names: Vec::new(),
            waves: vec![wave(&sine), wave(&hump)],
        };
        // A cycle of sixteen frames.
        let increment = (1 << 24) / 16;
        small.add("stand", increment, 0, [0; 4]);
        small.add("walk", increment, 0, [7_000, -6_000, 5_000, 4_000]);
        small.add("trot", -increment, 0, [-5_000, 6_000, 4_000, 7_000]);
        small.add("stray", increment / 12, 1, [16_384, 0, 0, 0]);
        small
    }

    fn add(&mut self, name: &str, increment: i32, wave: u8, gains: [i16; 4]) {
        self.gaits.push(Gait {
            name_start: self.names.len() as u16,
            name_length: name.len() as u8,
            increment,
            channels: gains.map(|gain| Channel {
                wave,
                offset: 0,
                gain,
            }),
        });
        self.names.extend(name.bytes());
    }
}

impl Default for Small {
    fn default() -> Self {
        Self::new()
    }
}

// Its numbers are the same in every state.
impl fmt::Debug for Small {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Small")
    }
}

impl Robot for Small {
    fn end(&self, end: End) -> FiveBar<'_> {
        self.firmware.end(end)
    }

    fn side(&self, side: Side) -> Slider {
        self.firmware.side(side)
    }

    fn limits(&self) -> Limits {
        self.firmware.limits()
    }

    fn slew(&self) -> Slew {
        Slew::new(PER_FRAME)
    }

    fn neutral(&self) -> [Angle; 4] {
        self.firmware.neutral()
    }

    fn calibration(&self) -> [Calibration; 4] {
        self.firmware.calibration()
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

    fn reach(&self, _: Servo) -> Reach {
        Reach {
            min: Sweep(-NEED),
            max: Sweep(NEED),
        }
    }

    fn supplies(&self) -> Supplies {
        self.firmware.supplies()
    }

    fn hash(&self) -> u32 {
        self.firmware.hash()
    }

    fn servo_hash(&self) -> u32 {
        self.firmware.servo_hash()
    }
}
