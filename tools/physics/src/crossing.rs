//! Placement of an edge on the path of a gait. All feet are before the edge when the measurement starts, and beyond the
//! edge when the measurement ends. Therefore both the front and the hind feet climb the edge during the measurement.

use lizard_parts::Block;
use lizard_robot::{BodyPose, Robot, Travel};

use crate::results::Displacement;
use crate::surface::list_gait_purposes;
use crate::table::Component;

/// The minimum distance between the feet and the edge before and after the measured cycles, mm. Feet swing by 15 mm,
/// and a dome touches an edge of 2 mm when the dome's middle is 11 mm away.
const CLEARANCE_MM: f64 = 25.0;
/// The turn at which the measurement ends, deg: after half a turn, the opposite feet are at the edge. Only gaits that
/// turn on the spot are expected to reach this limit.
const MAX_TURN_DEG: f64 = 180.0;

/// An edge across the path of a gait, and the cycles in which it is crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The number of cycles to measure.
    pub cycle_count: u32,
    /// True if all feet pass the edge before the robot has turned by `MAX_TURN_DEG`.
    pub is_crossed: bool,
    /// The direction across the edge in which the floor rises, deg counter-clockwise from the forward direction.
    heading_deg: f64,
    /// The distance between the edge and the point where the robot starts, mm.
    distance_mm: f64,
}

impl Crossing {
    /// Finds the crossing of a gait from its displacement per cycle. The measurement starts after `unmeasured_cycles`.
    pub fn find(robot: &Robot, cycle_displacement: Displacement, unmeasured_cycles: u32) -> Self {
        let feet = robot.ground().legs.foot_positions([0.0; 4]);
        let project_feet = |pose: BodyPose, heading_deg: f64| {
            let (sin, cos) = heading_deg.to_radians().sin_cos();
            let floor_feet = feet.map(|foot| pose.to_floor(foot));
            floor_feet.map(|[forward, left]| forward * cos + left * sin)
        };
        let Displacement([forward, left, turn]) = cycle_displacement;
        let cycle = Travel {
            forward,
            left,
            turn,
        };
        let measurement_start =
            (0..unmeasured_cycles).fold(BodyPose::START, |pose, _| pose.moved_by_travel(cycle));
        let purposes = list_gait_purposes(cycle_displacement);
        let turns_on_the_spot = !matches!(purposes[..], [Component::Forward, ..]);
        let mut end = measurement_start;
        for cycle_count in 1.. {
            end = end.moved_by_travel(cycle);
            let heading_deg = match turns_on_the_spot {
                true => 0.0,
                false => {
                    let left = end.left - measurement_start.left;
                    let forward = end.forward - measurement_start.forward;
                    left.atan2(forward).to_degrees()
                }
            };
            // All feet are compared, because their order along the heading may change on an arc.
            let start_feet = project_feet(measurement_start, heading_deg).into_iter();
            let distance_mm = start_feet.fold(f64::MIN, f64::max) + CLEARANCE_MM;
            let end_feet = project_feet(end, heading_deg).into_iter();
            let nearest_mm = end_feet.fold(f64::MAX, f64::min);
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
    pub fn make_block(&self, height_mm: f64) -> Block {
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
