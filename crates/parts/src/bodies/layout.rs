//! The robot seen from above: pivots, anchors and lengths of links, all of them independent
//! of the pose.

use lizard_kinematics::{End, Side, Vector};
use lizard_robot::servo::ARM_SIDE;
use lizard_robot::{LegPlan, Plate, Robot};

/// Distance of the standoffs from the plate's middle, mm: to the right, forward.
pub const STANDOFFS: [f64; 2] = [8.0, 39.0];

/// Radius of the circle around a hexagonal standoff of 5.5 mm over flats, mm.
pub const STANDOFF_RADIUS: f64 = 3.2;
/// Size of an Arduino UNO, mm: its board of 2700 x 2100 mil, and the height from the
/// board's underside to the top of its parts.
pub const UNO: [f64; 3] = [53.34, 68.58, 12.0];
/// Thickness of an Arduino UNO's board, mm.
pub const UNO_BOARD_THICKNESS: f64 = 1.6;

/// The pivots of all moving bodies, and the lengths of the servos' links.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// The servos' shafts, mm, chassis frame, servo order.
    pub shafts: [Vector; 4],
    /// The side of a link's arm: 1 if it is counter-clockwise from the crank, otherwise -1.
    pub arm_side: [f64; 4],
    /// Length of the cranks of head and tail, mm.
    pub crank: [f64; 4],
    /// Length of the arms of the sliders, mm.
    pub arm: [f64; 4],
    /// Pivots and anchors of the legs, servo order.
    pub legs: [LegPlan; 4],
    /// The outline of the chassis plate.
    pub plate: Plate,
}

impl Layout {
    /// The layout of a robot.
    pub fn new(robot: &Robot) -> Self {
        let lizard = robot.lizard();
        let (mut crank, mut arm) = ([0.0; 4], [0.0; 4]);
        for side in Side::ALL {
            let [front, rear] = side.servos();
            let slider = lizard.side(side);
            (arm[front], arm[rear]) = (slider.front, slider.rear);
        }
        for end in End::ALL {
            let [left, right] = end.servos();
            let bars = lizard.end(end);
            (crank[left], crank[right]) = (bars.crank_left, bars.crank_right);
        }
        Self {
            shafts: lizard.shafts(),
            arm_side: ARM_SIDE,
            crank,
            arm,
            legs: *robot.legs(),
            plate: robot.plate(),
        }
    }
}
