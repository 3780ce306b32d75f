//! The parts that make the robot look like a lizard: two long links behind the tail's end point, as in the paper's
//! robot, and a head in front of the head's end point.
//!
//! These parts drive nothing. The screw of the end point and a second screw fix each part to a coupler: the left tail
//! link under the lower coupler, the right tail link and the head on the upper coupler. At neutral the head points
//! straight forward, and the tail links point back, spread by a few degrees.

use lizard_kinematics::{End, Solution, Vector};
use lizard_robot::servo::SERVO_NAMES;

use crate::bodies::builder::ScrewDirection::Down;
use crate::bodies::builder::{AssemblyBuilder, Screw};
use crate::layers::body::{Kind, Mount, Prism, coupler_length, end_and_index};
use crate::layers::shape::Shape;
use crate::layers::stack::HEAD_CLEARANCE;

/// Thickness of a decorative part, mm.
const THICKNESS: f64 = 3.0;
/// Distance from the end point to the second screw, mm.
const SECOND_SCREW_DISTANCE: f64 = 14.0;
/// Length of the second screw, which cuts its own thread, mm.
const SECOND_SCREW_LENGTH: f64 = 6.0;
/// Angle between each tail link and straight back at neutral, deg.
const TAIL_LINK_ANGLE: f64 = 3.5;

/// Decorative parts of an end beyond its couplers.
#[derive(Default)]
pub struct EndDecoration {
    /// Thickness of the part under the lower coupler at the end point, mm; 0 if there is no such part.
    pub lower_thickness: f64,
    /// Thickness of the part on the upper coupler, mm; 0 if there is no such part.
    pub upper_thickness: f64,
    /// Names of the bodies on the upper coupler.
    pub upper_body_names: Vec<String>,
}

/// True if an end has a decorative part, whose length is not 0.
fn has_decoration(builder: &AssemblyBuilder, end: End) -> bool {
    match end {
        End::Head => builder.parts.head > 0.0,
        End::Tail => builder.parts.tail > 0.0,
    }
}

/// Makes the holes for the second screw in a coupler's lower and upper layer; `None` if the coupler has no decorative
/// part. In the tail's left coupler, the screw's head is sunk into the upper layer.
pub fn make_second_screw_holes(builder: &AssemblyBuilder, servo: usize) -> Option<[Shape; 2]> {
    let (end, index) = end_and_index(servo);
    let position = second_screw_position(builder, servo);
    match (has_decoration(builder, end), end, index) {
        (true, End::Tail, 0) => Some([
            builder.clearance_hole(position),
            builder.counterbore(position),
        ]),
        (true, _, 1) => Some([builder.pilot_hole(position), builder.pilot_hole(position)]),
        _ => None,
    }
}

/// Adds an end's decorative parts with their second screws.
pub fn add(builder: &mut AssemblyBuilder, end: End) -> EndDecoration {
    let neutral = builder.robot.lizard().solve(&builder.robot.neutral_pose());
    let (true, Ok(neutral)) = (has_decoration(builder, end), neutral) else {
        return EndDecoration::default();
    };
    let [left, right] = end.servos();
    let (lower_thickness, name, upper_part) = match end {
        End::Head => {
            let part = make_head_part(builder, right, &neutral);
            (0.0, "head plate".to_owned(), part)
        }
        End::Tail => {
            let tail_name = |servo: usize| format!("tail {}", SERVO_NAMES[servo]);
            let lower_part = make_tail_part(builder, left, &neutral);
            add_part(builder, left, &tail_name(left), lower_part);
            let part = make_tail_part(builder, right, &neutral);
            (THICKNESS, tail_name(right), part)
        }
    };
    add_part(builder, right, &name, upper_part);
    EndDecoration {
        lower_thickness,
        upper_thickness: THICKNESS,
        upper_body_names: vec![name],
    }
}

/// A flat part: its filled shapes and its holes.
type FlatPart = (Vec<Shape>, Vec<Shape>);

/// Computes an end point, and the direction that points outward at neutral, both in a coupler's frame.
fn point_and_direction(builder: &AssemblyBuilder, servo: usize, neutral: &Solution) -> [Vector; 2] {
    let (end, index) = end_and_index(servo);
    let five_bar = neutral.end(end);
    let coupler_direction = end.mirror([five_bar.left_coupler, five_bar.right_coupler][index]);
    let chassis_direction = Vector::new(0.0, end.sign());
    let x = chassis_direction.dot(coupler_direction);
    let y = coupler_direction.cross(chassis_direction);
    let end_point = Vector::new(coupler_length(builder.robot, servo), 0.0);
    [end_point, Vector::new(x, y)]
}

/// Rotates a direction counter-clockwise by `angle_deg`.
fn rotate(direction: Vector, angle_deg: f64) -> Vector {
    let rotation = Vector::from_angle(angle_deg);
    direction * rotation.x + direction.rotated_left() * rotation.y
}

fn make_tail_part(builder: &AssemblyBuilder, servo: usize, neutral: &Solution) -> FlatPart {
    let length = builder.parts.tail;
    let [end_point, straight_direction] = point_and_direction(builder, servo, neutral);
    // The left tail link points to the left, the right tail link to the right.
    let (_, index) = end_and_index(servo);
    let angle_deg = [-TAIL_LINK_ANGLE, TAIL_LINK_ANGLE][index];
    let link_direction = rotate(straight_direction, angle_deg);
    let half_width = builder.half_bar_width();
    let side_offset = link_direction.rotated_left() * (half_width - 1.5);
    let corners = [
        end_point + side_offset,
        end_point - side_offset,
        end_point + link_direction * (length - 1.5),
    ];
    let filled = vec![
        Shape::bar(second_screw_position(builder, servo), end_point, half_width),
        Shape::hull(&corners, 1.5),
    ];
    (filled, vec![builder.clearance_hole(end_point)])
}

fn make_head_part(builder: &AssemblyBuilder, servo: usize, neutral: &Solution) -> FlatPart {
    /// Radius of the head's corners, mm.
    const CORNER_RADIUS: f64 = 7.0;
    /// Radius of an eye, mm.
    const EYE_RADIUS: f64 = 2.5;
    let length = builder.parts.head;
    let [end_point, direction] = point_and_direction(builder, servo, neutral);
    let point_at =
        |forward: f64, left: f64| end_point + direction * forward + direction.rotated_left() * left;
    let half_width = 0.24 * length;
    let [cheek, neck] = [0.34 * length, -0.1 * length];
    let corners = [
        (cheek, half_width),
        (cheek, -half_width),
        (neck, 0.4 * half_width),
        (neck, -0.4 * half_width),
        (length - CORNER_RADIUS, 0.0),
    ];
    let corners = corners.map(|(forward, left)| point_at(forward, left));
    let face = Shape::hull(&corners, CORNER_RADIUS);
    let [left_eye, right_eye] = [half_width, -half_width]
        .map(|left| Shape::disc(point_at(0.42 * length, left), EYE_RADIUS));
    let screw_position = second_screw_position(builder, servo);
    let bar = Shape::bar(screw_position, end_point, builder.half_bar_width());
    let hole = builder.clearance_hole(end_point);
    (vec![bar, face], vec![hole, left_eye, right_eye])
}

/// Position of the second screw in a coupler's frame, mm.
fn second_screw_position(builder: &AssemblyBuilder, servo: usize) -> Vector {
    let x = coupler_length(builder.robot, servo) - SECOND_SCREW_DISTANCE;
    Vector::new(x, 0.0)
}

/// Adds a part to a coupler, with its second screw: under a left coupler, on a right one.
fn add_part(builder: &mut AssemblyBuilder, servo: usize, name: &str, part: FlatPart) {
    let (filled, mut cut) = part;
    let (stack, screw) = (builder.stack, builder.parts.screw);
    let (mount, position) = (Mount::Coupler(servo), second_screw_position(builder, servo));
    let (_, index) = end_and_index(servo);
    let is_left = index == 0;
    let (hole, z, seat_z) = if is_left {
        let [low, high] = stack.lower_coupler;
        // The screw's head is sunk, since the upper coupler turns above it.
        let seat_z = high - screw.head_height - HEAD_CLEARANCE;
        (builder.pilot_hole(position), [low - THICKNESS, low], seat_z)
    } else {
        let [_, low] = stack.upper_coupler;
        let high = low + THICKNESS;
        (builder.clearance_hole(position), [low, high], high)
    };
    cut.push(hole);
    builder.add_body(name, Kind::Printed, mount, [Prism::new(filled, cut, z)]);
    let screw = Screw::new(name, mount, position, seat_z, Down);
    builder.add_screw(&screw, SECOND_SCREW_LENGTH);
}
