//! Gaits by path: the head or the tail point follows a closed curve, and the
//! inverse of the five-bar says how the two cranks must turn.

use lizard_kinematics::{Lizard, Vector, wrap};

use crate::error::Problem;
use crate::servo::FORWARD;
use crate::waveform::Harmonic;

/// Which of the two five-bars a path belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loop {
    /// Between A1 and A2.
    Head,
    /// Between A4 and A3.
    Tail,
}

impl Loop {
    /// Its key in robot.toml.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Head => "head",
            Self::Tail => "tail",
        }
    }

    /// Its two servos, as indices in servo order.
    pub const fn servos(self) -> [usize; 2] {
        match self {
            Self::Head => [0, 1],
            Self::Tail => [2, 3],
        }
    }
}

/// A closed curve: in each coordinate a centre and a sum of harmonics, mm from
/// the middle of the base, outward positive in y.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The mean point.
    pub centre: [f64; 2],
    /// Terms across.
    pub x: Vec<Harmonic>,
    /// Terms outward.
    pub y: Vec<Harmonic>,
}

impl Path {
    /// The point at a phase of 0 to 1, mm.
    pub fn at(&self, phase: f64) -> Vector {
        let sum = |terms: &[Harmonic]| terms.iter().map(|term| term.at(phase)).sum::<f64>();
        Vector::new(self.centre[0] + sum(&self.x), self.centre[1] + sum(&self.y))
    }
}

/// One of the two servos that move a point along its path.
#[derive(Debug, Clone, PartialEq)]
pub struct PathLeg {
    lizard: Lizard,
    whole: Loop,
    path: Path,
    /// Servo, 0 to 3.
    servo: usize,
    /// Its neutral angle, deg.
    neutral: f64,
}

/// Points per cycle at which a path is checked to be within reach.
const CHECKED: usize = 4096;

impl PathLeg {
    /// The two servos of a loop, with their indices, once every point of the
    /// path was found within reach. `neutral`: all four neutral angles, deg.
    pub(crate) fn pair(
        lizard: Lizard,
        neutral: [f64; 4],
        whole: Loop,
        path: &Path,
    ) -> Result<[(usize, Self); 2], Problem> {
        for i in 0..CHECKED {
            let phase = i as f64 / CHECKED as f64;
            let point = path.at(phase);
            if angles(&lizard, whole, point).is_none() {
                return Err(Problem::OutOfReach {
                    which: whole.name(),
                    x: point.x,
                    y: point.y,
                    phase,
                });
            }
        }
        Ok(whole.servos().map(|servo| {
            let leg = Self {
                lizard,
                whole,
                path: path.clone(),
                servo,
                neutral: neutral[servo],
            };
            (servo, leg)
        }))
    }

    /// The leg's sweep from neutral at a phase of 0 to 1, deg, foot forward
    /// positive.
    pub fn sweep(&self, phase: f64) -> f64 {
        // Out of reach cannot happen: `pair` saw no such point, and the check
        // of every sample keeps the path's type-1 margins, which are zero at
        // the edge of reach, far from zero.
        let angles =
            angles(&self.lizard, self.whole, self.path.at(phase)).expect("a path within reach");
        let angle = angles[self.servo % 2];
        FORWARD[self.servo] * wrap(angle - self.neutral)
    }
}

/// The crank angles that put a loop's point somewhere, elbows outward.
fn angles(lizard: &Lizard, whole: Loop, point: Vector) -> Option<[f64; 2]> {
    match whole {
        Loop::Head => lizard.head_angles(point).ok(),
        Loop::Tail => lizard.tail_angles(point).ok(),
    }
}
