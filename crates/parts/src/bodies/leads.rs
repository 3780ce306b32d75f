//! The servos' leads: three wires side by side, which leave the case at the shaft's end.
//!
//! A servo is pushed into the plate from above, plug and lead first. The lead protrudes from the case, so the opening
//! needs a notch for it. Below the plate the lead is folded around the case's corner, runs between the servos towards
//! the middle, and goes up through plate and deck to the board.

use lizard_kinematics::{End, Vector};
use lizard_robot::ServoBody;
use lizard_robot::servo::SERVO_NAMES;

use crate::bodies::builder::AssemblyBuilder;
use crate::bodies::layout::STANDOFF_DISTANCES;
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::shape::{Shape, vector};

/// Width and thickness of a lead, mm.
pub const LEAD_SECTION: [f64; 2] = [4.0, 1.2];
/// Difference in width between a notch and its lead, mm.
const NOTCH_CLEARANCE: f64 = 1.0;
/// Height of the lower edge of a lead, which lies on edge, above the case's bottom, mm.
const LEAD_EXIT_HEIGHT: f64 = 3.0;
/// Length of a lead between the case and the fold, mm.
const BEND_LENGTH: f64 = 4.0;
/// Size of a hole for the leads and the wires, mm: across and along the plate.
const WIRE_HOLE_SIZE: [f64; 2] = [8.4, 6.0];
/// Distance along the plate from the standoffs' middles to the middle of a hole for leads, mm.
const HOLE_BEYOND_STANDOFFS: f64 = 2.0;

/// Makes the notch for the lead in a servo's opening. `middle` is the middle of the case; `fit` is the clearance on
/// each side, mm; `outward` is the direction of the shaft's end of the case: 1 forward, -1 back.
pub fn make_lead_notch(body: &ServoBody, middle: Vector, fit: f64, outward: f64) -> Shape {
    let reach = body.length / 2.0 + LEAD_SECTION[1] + fit;
    // The notch overlaps the opening for the case.
    let from = body.length / 2.0 - 2.0;
    let half_width = (LEAD_SECTION[0] + NOTCH_CLEARANCE) / 2.0;
    let corner_at = |x: f64, y: f64| middle + Vector::new(x, outward * y);
    let [left, right] = [-half_width, half_width].map(|x| [from, reach].map(|y| corner_at(x, y)));
    Shape::hull(&[left, right].concat(), 0.0)
}

/// Centre of the front hole for leads if `sign` is 1, of the rear hole if it is -1.
fn wire_hole_centre(sign: f64) -> Vector {
    Vector::new(0.0, sign * (STANDOFF_DISTANCES[1] + HOLE_BEYOND_STANDOFFS))
}

/// Makes the holes in plate and deck through which leads and wires go up.
pub fn make_wire_holes() -> [Shape; 2] {
    let [width, length] = WIRE_HOLE_SIZE;
    [1.0, -1.0]
        .map(|sign| Shape::rectangle(wire_hole_centre(sign), Vector::new(width, length), 1.0))
}

/// Adds the leads of all servos.
pub fn add(builder: &mut AssemblyBuilder) {
    for (servo, name) in SERVO_NAMES.into_iter().enumerate() {
        let outward = End::from_servo(servo).sign();
        let body = builder.parts.servo;
        let middle = builder.layout.plate.case_centres[servo];
        let half_size = Vector::new(body.width, body.length) * 0.5;
        // The neighbour's lead is on the other side of the plate's centre line.
        let inward_sign = -middle.x.signum();
        let x = middle.x + inward_sign * (half_size.x + LEAD_SECTION[1]);
        let bend_y = middle.y + outward * (half_size.y + BEND_LENGTH / 2.0);
        let riser_position = wire_hole_centre(outward) + vector(-inward_sign * 1.6, 0.0);
        let radius = LEAD_SECTION[1];
        let low = builder.stack.servo_bottom + LEAD_EXIT_HEIGHT;
        let [bend, corner] = [vector(middle.x, bend_y), vector(x, bend_y)];
        let inner_corner = vector(x, middle.y - outward * half_size.y);
        let lead_path = vec![
            Shape::rectangle(bend, vector(LEAD_SECTION[0], BEND_LENGTH), 0.0),
            Shape::bar(bend, corner, radius),
            Shape::bar(corner, inner_corner, radius),
            Shape::bar(inner_corner, riser_position, radius),
        ];
        let z = [low, low + LEAD_SECTION[0]];
        let riser = Shape::disc(riser_position, radius);
        let riser = Prism::solid([riser], [z[1], builder.stack.deck[1]]);
        let prisms = [Prism::solid(lead_path, z), riser];
        builder.add_body(format!("lead {name}"), Kind::Lead, Mount::Chassis, prisms);
    }
}
