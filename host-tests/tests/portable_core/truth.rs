//! What is right, in floating point and without the core: its units in degrees
//! and millimetres, and every condition of a safe pose from lizard-kinematics.

use std::fmt;

use lizard::clearance::Clearance;
use lizard::pose::Pose;
use lizard_host_tests::robot;
use lizard_kinematics::Lizard;

/// An angle of the core in degrees, 0..360.
pub fn degrees(angle: u16) -> f64 {
    f64::from(angle) * 360.0 / 65536.0
}

/// A margin of the core as a sine.
pub fn sine(q15: i16) -> f64 {
    f64::from(q15) / 32768.0
}

/// A length of the core in mm.
pub fn mm(length: i16) -> f64 {
    f64::from(length) / 256.0
}

/// The chassis angles of a pose in degrees, exactly what the core means by it.
pub fn angles(pose: &Pose) -> [f64; 4] {
    std::array::from_fn(|servo| degrees(pose.angle(servo)))
}

/// The number of a condition's place: ten margins, two strokes.
pub const NAMES: [&str; 12] = [
    "type-2 head",
    "type-2 tail",
    "type-1 A1",
    "type-1 A2",
    "type-1 A3",
    "type-1 A4",
    "leg A1",
    "leg A2",
    "leg A3",
    "leg A4",
    "stroke left",
    "stroke right",
];

/// Every condition of a pose, in the core's order.
#[derive(Clone, Copy, Debug)]
pub struct Conditions {
    /// Sines.
    pub margins: [f64; 10],
    /// Slider travel from nominal, mm.
    pub travels: [f64; 2],
    /// K2 of head and tail, mm: from the left crank tip to the right one,
    /// across. Not above 0, the cranks are crossed.
    pub across: [f64; 2],
    /// Distance between the crank tips of head and tail, mm.
    pub tips: [f64; 2],
}

impl Conditions {
    /// At chassis angles in degrees; None where a loop does not close.
    pub fn of(lizard: &Lizard, angles: [f64; 4]) -> Option<Self> {
        let solution = lizard.solve(&angles.into()).ok()?;
        let mut margins = [0.0; 10];
        for (margin, (_, value)) in margins.iter_mut().zip(solution.margins.iter()) {
            *margin = value;
        }
        Some(Self {
            margins,
            travels: [solution.left.s, solution.right.s],
            across: [solution.head.gap.x, solution.tail.gap.x],
            tips: [solution.head.gap.length(), solution.tail.gap.length()],
        })
    }

    /// How far each condition is on the safe side of its limit in robot.toml:
    /// sines, then mm.
    pub fn clear_by(&self) -> [f64; 12] {
        let limits = &robot().limits;
        std::array::from_fn(|place| match place {
            0..2 => self.margins[place] - limits.type2,
            2..6 => self.margins[place] - limits.type1,
            6..10 => self.margins[place] - limits.leg,
            _ => {
                let travel = self.travels[place - 10];
                (travel - limits.stroke_min).min(limits.stroke_max - travel)
            }
        })
    }
}

/// The width of the band around each limit within which the core and the truth
/// may decide differently.
pub const MARGIN_BAND: f64 = 0.002;
/// Of the sliders' strokes, mm.
pub const STROKE_BAND: f64 = 0.05;
/// Of the crossing of the crank tips, K2 = 0, mm.
pub const CROSSING_BAND: f64 = 0.02;

/// Where a pose stands by the truth, the band apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Clear of every limit by more than the band.
    Safe,
    /// Beyond some limit by more than the band.
    Unsafe,
    /// Too near to a limit to tell.
    Between,
}

impl Verdict {
    /// Of a whole pose, at chassis angles in degrees.
    pub fn of(angles: [f64; 4]) -> Self {
        let Some(truth) = Conditions::of(&robot().lizard, angles) else {
            return Self::Unsafe;
        };
        let by_band = truth
            .clear_by()
            .into_iter()
            .enumerate()
            .map(|(place, by)| by / if place < 10 { MARGIN_BAND } else { STROKE_BAND })
            .chain(truth.across.map(|across| across / CROSSING_BAND));
        let least = by_band.fold(f64::INFINITY, f64::min);
        if least > 1.0 {
            Self::Safe
        } else if least < -1.0 {
            Self::Unsafe
        } else {
            Self::Between
        }
    }
}

/// The largest and the root mean square of many errors.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spread {
    pub max: f64,
    squares: f64,
    count: f64,
}

impl Spread {
    pub fn add(&mut self, error: f64) {
        self.max = self.max.max(error.abs());
        self.squares += error * error;
        self.count += 1.0;
    }
}

impl fmt::Display for Spread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rms = (self.squares / self.count.max(1.0)).sqrt();
        write!(f, "max {:.6} rms {rms:.6}", self.max)
    }
}

/// Poses to try before a search is given up.
pub const TRIES: u32 = 1_000_000;

/// Random numbers that are the same in every run.
pub struct Numbers(fastrand::Rng);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// Within a range, its ends included.
    pub fn within(&mut self, least: i16, most: i16) -> i16 {
        self.0.i16(least..=most)
    }

    /// A pose anywhere in the servos' travel.
    pub fn pose(&mut self) -> Pose {
        Pose(std::array::from_fn(|servo| {
            let servo = &lizard::robot::SERVOS[servo];
            self.within(servo.min_sweep, servo.max_sweep)
        }))
    }

    /// A pose that the guard lets pass.
    pub fn safe_pose(&mut self) -> Pose {
        (0..TRIES)
            .map(|_| self.pose())
            .find(|pose| Clearance::of(pose).hazard().is_none())
            .expect("one pose in 24 is safe")
    }
}
