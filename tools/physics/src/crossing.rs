//! Placement of an edge on the path of a gait. Before the measured cycles, all feet are on one side of the edge; after
//! them, all feet are on the other side. So both front and hind feet climb the edge during the measurement.

use lizard_parts::Block;
use lizard_robot::{Place, Robot, Travel};

use crate::figures::Displacement;
use crate::surface::gait_purposes;
use crate::table::Component;

/// The minimum distance of the feet from the edge before and after the measured cycles, mm. Feet swing by 15 mm, and a
/// dome touches an edge of 2 mm when its middle is 11 mm away.
const CLEARANCE_MM: f64 = 25.0;
/// The turn after which the measurement ends, deg: after half a turn, other feet are at the edge. Only gaits that turn
/// on the spot are expected to reach it.
const MAX_TURN_DEG: f64 = 180.0;

/// An edge across the path of a gait, and the cycles in which it is crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The number of cycles to measure.
    pub cycle_count: u32,
    /// True if all feet pass the edge before the robot has turned by `MAX_TURN_DEG`.
    pub is_crossed: bool,
    /// The direction across the edge, in which the floor rises, deg counter-clockwise from ahead.
    heading_deg: f64,
    /// The distance of the edge from the place where the robot starts, mm.
    distance_mm: f64,
}

impl Crossing {
    /// Finds the crossing of a gait from its displacement in one cycle. Measuring begins after `unmeasured_cycles`.
    pub fn of(robot: &Robot, cycle_displacement: Displacement, unmeasured_cycles: u32) -> Self {
        let feet = robot.ground().feet.positions([0.0; 4]);
        let foot_distances_along = |place: Place, heading_deg: f64| {
            let (sin, cos) = heading_deg.to_radians().sin_cos();
            feet_at(place, feet).map(|[ahead, left]| ahead * cos + left * sin)
        };
        let Displacement([forward, left, turn]) = cycle_displacement;
        let cycle = Travel {
            forward,
            left,
            turn,
        };
        let measurement_start =
            (0..unmeasured_cycles).fold(Place::START, |place, _| place.moved_by_travel(cycle));
        let is_turn_on_the_spot = !matches!(
            gait_purposes(cycle_displacement)[..],
            [Component::Ahead, ..]
        );
        let mut end = measurement_start;
        for cycle_count in 1.. {
            end = end.moved_by_travel(cycle);
            let heading_deg = if is_turn_on_the_spot {
                0.0
            } else {
                direction_from(end, measurement_start)
            };
            // All feet are compared, since after an arc the order of the feet along the heading may differ.
            let distance_mm = foot_distances_along(measurement_start, heading_deg)
                .into_iter()
                .fold(f64::MIN, f64::max)
                + CLEARANCE_MM;
            let nearest_mm = foot_distances_along(end, heading_deg)
                .into_iter()
                .fold(f64::MAX, f64::min);
            let has_passed = nearest_mm > distance_mm + CLEARANCE_MM;
            if has_passed || end.travel_from(measurement_start).turn.abs() >= MAX_TURN_DEG {
                return Self {
                    cycle_count,
                    is_crossed: has_passed,
                    heading_deg,
                    distance_mm,
                };
            }
        }
        unreachable!("a walking gait moves or turns in every cycle")
    }

    /// Returns a block of this height that forms the floor beyond the edge.
    pub fn block(&self, height_mm: f64) -> Block {
        /// The size of the block, mm.
        const SIZE_MM: f64 = 1000.0;
        let (sin, cos) = self.heading_deg.to_radians().sin_cos();
        let middle = self.distance_mm + SIZE_MM / 2.0;
        Block {
            centre: [-middle * sin, middle * cos],
            size: [SIZE_MM, SIZE_MM, height_mm],
            rotation: self.heading_deg,
        }
    }
}

/// Converts the positions of a robot's feet from the robot's frame to the floor's frame.
fn feet_at(place: Place, feet: [[f64; 2]; 4]) -> [[f64; 2]; 4] {
    feet.map(|foot| place.to_floor(foot))
}

/// Returns the direction of a place from another place, deg counter-clockwise from ahead.
fn direction_from(place: Place, origin: Place) -> f64 {
    let offset = [place.left - origin.left, place.forward - origin.forward];
    offset[0].atan2(offset[1]).to_degrees()
}
