//! Gaits by path: the head or the tail point follows a closed curve, and the
//! inverse of the five-bar says how the two cranks must turn.

use lizard_kinematics::{End, Lizard, Vector, wrap};

use crate::error::Problem;
use crate::servo::FORWARD;
use crate::waveform::Harmonic;

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
    end: End,
    path: Path,
    /// Servo, 0 to 3.
    servo: usize,
    /// Its neutral angle, deg.
    neutral: f64,
}

/// Points per cycle at which a path is checked to be within reach.
const CHECKED: usize = 4096;

impl PathLeg {
    /// The two servos of an end, with their indices, once every point of the
    /// path was found within reach. `neutral`: all four neutral angles, deg.
    pub(crate) fn pair(
        lizard: Lizard,
        neutral: [f64; 4],
        end: End,
        path: &Path,
    ) -> Result<[(usize, Self); 2], Problem> {
        for i in 0..CHECKED {
            let phase = i as f64 / CHECKED as f64;
            let point = path.at(phase);
            if lizard.point_angles(end, point).is_err() {
                return Err(Problem::OutOfReach {
                    which: end.name(),
                    x: point.x,
                    y: point.y,
                    phase,
                });
            }
        }
        Ok(end.servos().map(|servo| {
            let leg = Self {
                lizard,
                end,
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
        let angles = self
            .lizard
            .point_angles(self.end, self.path.at(phase))
            .expect("a path within reach");
        let angle = angles[self.servo % 2];
        FORWARD[self.servo] * wrap(angle - self.neutral)
    }
}
