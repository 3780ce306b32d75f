//! The crank sweeps that move the end point of the head or the tail along a path: the inverse kinematics of the
//! five-bar.

use lizard_kinematics::{End, Lizard, Vector, wrap};

use crate::config::servo::FORWARD_TURN_SIGN;
use crate::gaits::path::Path;

/// The motion of one of the two servos that move the end point of the head or the tail along a path.
#[derive(Debug, Clone, PartialEq)]
pub struct PathLeg {
    lizard: Lizard,
    /// The end whose point follows the path.
    end: End,
    path: Path,
    /// Index of the servo, 0 to 3.
    servo: usize,
    /// Neutral angle of this servo, deg.
    neutral: f64,
}

/// Number of points per cycle at which a path is checked to be within reach.
const CHECKED_POINTS_PER_CYCLE: usize = 4096;

impl PathLeg {
    /// Creates the motions of both servos of the head or the tail, each with its servo's index. `neutral` contains the
    /// neutral angles of all four servos, deg.
    ///
    /// # Errors
    /// Returns a message if a point of the path is out of reach.
    pub(crate) fn for_both_servos(
        lizard: Lizard,
        neutral: [f64; 4],
        end: End,
        path: &Path,
    ) -> Result<[(usize, Self); 2], String> {
        for i in 0..CHECKED_POINTS_PER_CYCLE {
            let phase = i as f64 / CHECKED_POINTS_PER_CYCLE as f64;
            let point = path.point_at(phase);
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
        // `for_both_servos` has checked only some points of the path, but the points between them are within reach,
        // too: type-1 margins are zero at the edge of the reach, and the check of every sample keeps the path's margins
        // far from zero.
        let angles = self
            .lizard
            .point_angles(self.end, self.path.point_at(phase))
            .expect("the path is within reach");
        let angle = angles[self.servo % 2];
        FORWARD_TURN_SIGN[self.servo] * wrap(angle - self.neutral)
    }
}
