//! The crank sweeps that move the end point of the head or the tail along a path: the inverse kinematics of the
//! five-bar.

use lizard_kinematics::{End, Lizard, Vector, wrap};

use crate::config::servo::FORWARD_TURN_SIGN;
use crate::gaits::path::Path;

/// The motion of one of the two servos that move the end point of the head or the tail along a path.
#[derive(Debug, Clone, PartialEq)]
pub struct PathSweep {
    lizard: Lizard,
    /// The end whose point follows the path.
    end: End,
    path: Path,
    /// Index of the servo, 0 to 3.
    servo: usize,
    /// Neutral angle of this servo, deg.
    neutral_angle: f64,
}

/// Number of points per cycle at which `for_both_servos` checks that the path is within reach.
const CHECKED_POINTS_PER_CYCLE: usize = 4096;

impl PathSweep {
    /// Creates the motions of both servos of the head or the tail, each with its servo's index. `neutral_angles` are
    /// those of all four servos, deg.
    ///
    /// # Errors
    /// Returns a message if a point of the path is out of reach.
    pub(crate) fn for_both_servos(
        lizard: Lizard,
        neutral_angles: [f64; 4],
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
            let sweep = Self {
                lizard,
                end,
                path: path.clone(),
                servo,
                neutral_angle: neutral_angles[servo],
            };
            (servo, sweep)
        }))
    }

    /// The servo's sweep from neutral at a phase of 0 to 1, deg, positive if the foot is forward.
    pub fn sweep(&self, phase: f64) -> f64 {
        let angles_at = |phase: f64| {
            let point = self.path.point_at(phase);
            self.lizard.point_angles(self.end, point)
        };
        // Between two points that `for_both_servos` has checked, the path may be out of reach by a fraction of a
        // millimetre. The nearest checked point then replaces the point beyond the reach.
        let count = CHECKED_POINTS_PER_CYCLE as f64;
        let checked_phase = (phase * count).round() % count / count;
        let angles = angles_at(phase).or_else(|_| angles_at(checked_phase));
        let angle = angles.expect("the checked point is within reach")[self.servo % 2];
        FORWARD_TURN_SIGN[self.servo] * wrap(angle - self.neutral_angle)
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{assert_contains, paper_with_tables};

    #[test]
    fn a_path_that_leaves_the_reach_between_two_checked_points_is_rejected() {
        // At x = 0 the head reaches at most y = 79.3725 mm. The peaks at 79.3728 mm are halfway between checked points.
        let gait = "[gait.reach]\nperiod = 32.768\n[gait.reach.head]\ncentre = [0.0, 69.3728]\n\
                    y = [{ k = 16, amplitude = 10.0, shift = 0.001953125 }]";
        let error = paper_with_tables(gait).expect_err("the arms are straight at the peaks");
        assert_contains(&error.to_string(), "margin type1_a1");
    }
}
