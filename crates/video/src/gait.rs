//! A predicted gait with which a path is compared.

use lizard_contact::{BodyPose, Travel};

use crate::least_squares::squared_norm;
use crate::path;

/// Distance of the robot's legs from its centre, mm; a turn of 1 rad counts as this distance.
const TURN_LEVER_ARM: f64 = 60.0;
/// Smallest movement per cycle of a robot that counts as moving, mm.
pub(crate) const MIN_MOVEMENT: f64 = 3.0;
/// Half of the time window whose frames determine the pose at a calm phase, cycles.
pub(crate) const HALF_WINDOW: f64 = 0.08;

/// A predicted gait.
#[derive(Debug, Clone, PartialEq)]
pub struct Gait {
    /// Duration of a cycle at the pace in the video, s.
    pub period: f64,
    /// The poses along a cycle at equal intervals, relative to its start. The last pose is the end of the cycle.
    pub path: Vec<BodyPose>,
}

impl Gait {
    /// Computes the length of the movement per cycle divided by the cycle's duration, mm/s. A turn counts as the
    /// distance by which it moves the legs.
    pub fn speed(&self) -> f64 {
        let travel = self.path[self.path.len() - 1].travel();
        movement_length(movement_in_mm(travel)) / self.period
    }

    /// Returns the pose at a phase, relative to the start of cycle 0.
    pub(crate) fn pose_at(&self, phase: f64) -> BodyPose {
        let count = self.path.len() - 1;
        let position = phase.rem_euclid(1.0) * count as f64;
        let i = (position as usize).min(count - 1);
        let (a, b, fraction) = (self.path[i], self.path[i + 1], position - i as f64);
        let mut pose = path::interpolate(a, b, fraction);
        for _ in 0..phase.floor().max(0.0) as usize {
            pose = path::compose(self.path[count], pose);
        }
        pose
    }

    /// Finds the phase around which the robot is predicted to move least and most evenly: there, interpolation between
    /// frames is most accurate.
    pub(crate) fn find_calm_phase(&self) -> f64 {
        let count = 50;
        let roughness_at = |i: usize| {
            let movement_at = |j: f64| {
                let start = (i as f64 + j) / count as f64;
                self.movement_between(start, start + 1.0 / count as f64)
            };
            let movements = [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0].map(movement_at);
            let changes = movements
                .windows(2)
                .map(|pair| movement_length([0, 1, 2].map(|axis| pair[1][axis] - pair[0][axis])));
            // A movement itself has half the weight of a change, because the clock is not known exactly.
            let lengths = movements.iter().map(|movement| movement_length(*movement));
            changes.sum::<f64>() + 0.5 * lengths.sum::<f64>()
        };
        let calmest = (0..count).min_by(|&a, &b| roughness_at(a).total_cmp(&roughness_at(b)));
        calmest.unwrap_or(0) as f64 / count as f64
    }

    /// Returns the predicted rate of movement around a phase, per cycle: mm, mm, deg.
    pub(crate) fn rate_at(&self, phase: f64) -> [f64; 3] {
        // The middle half of the time window around the phase.
        let [forward, left, turn] =
            self.movement_between(phase - HALF_WINDOW / 2.0, phase + HALF_WINDOW / 2.0);
        [forward, left, (turn / TURN_LEVER_ARM).to_degrees()].map(|value| value / HALF_WINDOW)
    }

    /// Returns the components of the predicted movement between two phases; see [`movement_in_mm`].
    pub(crate) fn movement_between(&self, from: f64, to: f64) -> [f64; 3] {
        let whole_cycles = from.floor();
        let [from, to] = [from, to].map(|phase| self.pose_at(phase - whole_cycles));
        movement_in_mm(to.travel_from(from))
    }
}

/// Converts a movement to components in mm: forward, left, and the turn times [`TURN_LEVER_ARM`].
pub(crate) fn movement_in_mm(travel: Travel) -> [f64; 3] {
    [
        travel.forward,
        travel.left,
        TURN_LEVER_ARM * travel.turn.to_radians(),
    ]
}

/// Returns the length of a movement, mm.
pub(crate) fn movement_length(movement: [f64; 3]) -> f64 {
    squared_norm(&movement).sqrt()
}
