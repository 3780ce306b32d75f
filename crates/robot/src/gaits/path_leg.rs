//! The sweeps of the two cranks of the head or the tail that move its end point along a path:
//! the inverse kinematics of the five-bar.

use lizard_kinematics::{End, Lizard, Vector, wrap};

use crate::gaits::path::Path;
use crate::measures::servo::FORWARD;

/// The motion of one of the two servos that move the end point of head or tail along a path.
#[derive(Debug, Clone, PartialEq)]
pub struct PathLeg {
    lizard: Lizard,
    end: End,
    path: Path,
    /// Index of the servo, 0 to 3.
    servo: usize,
    /// Neutral angle of this servo, deg.
    neutral: f64,
}

/// Number of points per cycle at which a path is checked to be within reach.
const CHECKED_POINTS: usize = 4096;

impl PathLeg {
    /// Makes the motions of the two servos of head or tail, each with its servo's index.
    /// `neutral` has all four neutral angles, deg.
    ///
    /// # Errors
    /// Returns the message for a point of the path that is out of reach.
    pub(crate) fn both_servos(
        lizard: Lizard,
        neutral: [f64; 4],
        end: End,
        path: &Path,
    ) -> Result<[(usize, Self); 2], String> {
        for i in 0..CHECKED_POINTS {
            let phase = i as f64 / CHECKED_POINTS as f64;
            let point = path.at(phase);
            if lizard.point_angles(end, point).is_err() {
                let (Vector { x, y }, end) = (point, end.name());
                return Err(format!(
                    "the point ({x:.2}, {y:.2}) mm at phase {phase:.4} is out of reach of the {end}"
                ));
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

    /// The servo's sweep from neutral at a phase of 0 to 1, deg, positive if the foot is forward.
    pub fn sweep(&self, phase: f64) -> f64 {
        // `both_servos` has checked only some points of the path. But none between them is out of reach
        // either: type-1 margins are zero at the edge of reach, and the check of every sample
        // keeps the path's margins far from zero.
        let angles = self
            .lizard
            .point_angles(self.end, self.path.at(phase))
            .expect("a path within reach");
        let angle = angles[self.servo % 2];
        FORWARD[self.servo] * wrap(angle - self.neutral)
    }
}
