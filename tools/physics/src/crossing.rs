//! Placement of an edge on the path of a gait. Before the measured cycles, all feet are on one side of
//! the edge, and afterwards on the other, so that front and hind feet have climbed it.

use lizard_parts::Block;
use lizard_robot::{Place, Robot, Travel};

use crate::figures::Displacement;
use crate::surface::gait_purposes;
use crate::table::Part;

/// The distance of the nearest foot from the edge before and after the measured cycles, mm: feet
/// swing by 15 mm, and a dome touches an edge 2 mm high while its middle is 11 mm away.
const CLEARANCE_MM: f64 = 25.0;
/// The turn after which the measurement of a gait that turns on the spot ends, deg: other feet are at the edge then.
const MAX_TURN_DEG: f64 = 180.0;

/// An edge across the path of a gait, and the cycles in which it is crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The number of cycles to measure.
    pub cycles: u32,
    /// True if all feet pass the edge; false for a gait that turns on the spot.
    pub is_crossed: bool,
    /// The direction across the edge, in which the floor rises, deg counter-clockwise from ahead.
    heading: f64,
    /// The distance of the edge from the robot's place at the start, mm.
    distance: f64,
}

impl Crossing {
    /// Finds the crossing of a gait with this displacement in one cycle, after some cycles that are not
    /// measured.
    pub fn of(robot: &Robot, by_cycle: Displacement, unmeasured_cycles: u32) -> Self {
        let feet = robot.ground().feet.positions([0.0; 4]);
        let distances_along = |place: Place, heading: f64| {
            let (sin, cos) = heading.to_radians().sin_cos();
            feet_at(place, feet).map(|[ahead, left]| ahead * cos + left * sin)
        };
        let Displacement([forward, left, turn]) = by_cycle;
        let cycle = Travel {
            forward,
            left,
            turn,
        };
        let begin =
            (0..unmeasured_cycles).fold(Place::START, |place, _| place.moved_by_travel(cycle));
        let is_turn = !matches!(gait_purposes(by_cycle)[..], [Part::Ahead, ..]);
        let mut end = begin;
        for cycles in 1.. {
            end = end.moved_by_travel(cycle);
            let heading = if is_turn {
                0.0
            } else {
                direction_from(end, begin)
            };
            // Takes the extreme of all feet, since a foot that is ahead at the beginning may be behind after an arc.
            let distance = distances_along(begin, heading)
                .into_iter()
                .fold(f64::MIN, f64::max)
                + CLEARANCE_MM;
            let nearest_end = distances_along(end, heading)
                .into_iter()
                .fold(f64::MAX, f64::min);
            let has_passed = nearest_end > distance + CLEARANCE_MM;
            if has_passed || end.travel_from(begin).turn.abs() >= MAX_TURN_DEG {
                return Self {
                    cycles,
                    is_crossed: has_passed,
                    heading,
                    distance,
                };
            }
        }
        unreachable!("every gait that is walked moves")
    }

    /// Returns the block, `height_mm` mm high, that forms the floor beyond the edge.
    pub fn block(&self, height_mm: f64) -> Block {
        /// The size of the block, mm.
        const SIZE_MM: f64 = 1000.0;
        let (sin, cos) = self.heading.to_radians().sin_cos();
        let middle = self.distance + SIZE_MM / 2.0;
        Block {
            centre: [-middle * sin, middle * cos],
            size: [SIZE_MM, SIZE_MM, height_mm],
            rotation: self.heading,
        }
    }
}

/// Returns the positions of the feet of a robot at a place on the floor.
fn feet_at(place: Place, feet: [[f64; 2]; 4]) -> [[f64; 2]; 4] {
    feet.map(|foot| place.to_floor(foot))
}

/// Returns the direction of a place from another place, deg counter-clockwise from ahead.
fn direction_from(place: Place, origin: Place) -> f64 {
    let offset = [place.left - origin.left, place.forward - origin.forward];
    offset[0].atan2(offset[1]).to_degrees()
}
