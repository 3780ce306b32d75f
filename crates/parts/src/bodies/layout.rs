//! The robot seen from above: pivots, anchors and lengths of links, all independent of the pose.

use lizard_kinematics::{End, Side, Vector};
use lizard_robot::servo::ARM_TURN_SIGN;
use lizard_robot::{LegPlan, Plate, Robot};

/// Distances of each standoff from the plate's middle, mm: sideways and lengthwise.
pub const STANDOFF_DISTANCES: [f64; 2] = [8.0, 39.0];

/// Radius of the circle around a hexagonal standoff of 5.5 mm across flats, mm.
pub const STANDOFF_RADIUS: f64 = 3.2;
/// Size of an Arduino UNO, mm: width and length of the board (2100 x 2700 mil), and the height from the board's
/// underside to the top of its components.
pub const UNO_SIZE: [f64; 3] = [53.34, 68.58, 12.0];
/// Thickness of an Arduino UNO's board, mm.
pub const UNO_BOARD_THICKNESS: f64 = 1.6;

/// Pivots of all moving bodies, lengths of the cranks, and the plate's outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// Servos' shafts, chassis frame, servo order, mm.
    pub shafts: [Vector; 4],
    /// Lengths of the cranks of head and tail, servo order, mm.
    pub crank_lengths: [f64; 4],
    /// Tip of each servo's slider arm, in the frame of the servo's crank, mm.
    pub arm_tips: [Vector; 4],
    /// Dimensions of the legs, servo order.
    pub legs: [LegPlan; 4],
    /// Outline of the chassis plate.
    pub plate: Plate,
}

impl Layout {
    /// Computes the layout of a robot.
    pub fn new(robot: &Robot) -> Self {
        let lizard = robot.lizard();
        let (mut crank_lengths, mut arm_lengths) = ([0.0; 4], [0.0; 4]);
        for side in Side::ALL {
            let [front, rear] = side.servos();
            let slider = lizard.side(side);
            (arm_lengths[front], arm_lengths[rear]) = (slider.front_arm, slider.rear_arm);
        }
        for end in End::ALL {
            let [left, right] = end.servos();
            let five_bar = lizard.end(end);
            (crank_lengths[left], crank_lengths[right]) =
                (five_bar.left_crank_length, five_bar.right_crank_length);
        }
        let arm_tip = |servo: usize| Vector::new(0.0, ARM_TURN_SIGN[servo] * arm_lengths[servo]);
        Self {
            shafts: lizard.shafts(),
            crank_lengths,
            arm_tips: [0, 1, 2, 3].map(arm_tip),
            legs: *robot.legs(),
            plate: robot.plate(),
        }
    }
}
