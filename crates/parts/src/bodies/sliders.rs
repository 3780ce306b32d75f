//! The sliders: a rod in a sleeve between the arms of a front and a rear servo. A slider's pins are the bolts at the
//! arms' tips.
//!
//! A sleeve between the pins would be too short for the stroke, so sleeve and rod lie beside the line between the pins:
//! the sleeve begins at the rear pin, and the rod may pass this pin.

use lizard_kinematics::{Side, Vector};
use lizard_robot::Robot;
use lizard_robot::servo::SERVO_NAMES;

use crate::bodies::builder::AssemblyBuilder;
use crate::layers::body::{Mount, Prism};
use crate::layers::shape::Shape;

/// Outward offset of sleeve and rod from the line between the pins, mm.
pub const ROD_OFFSET: f64 = 9.0;
/// Width of a rod, mm.
pub(crate) const ROD_WIDTH: f64 = 6.0;
/// Smallest length of the rod inside its sleeve, mm.
const MIN_OVERLAP: f64 = 20.0;
/// Smallest gap between the sleeve's front end and the front pin, at the shortest distance of the pins, mm.
const MIN_GAP: f64 = 8.0;

/// Lengths of a slider, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderLengths {
    /// Length of the sleeve, which begins at the rear pin.
    pub sleeve: f64,
    /// Length of the rod, from the front pin to its rear end.
    pub rod: f64,
    /// Offset of sleeve and rod from the line between the pins, positive to the left.
    pub lateral_offset: f64,
}

impl SliderLengths {
    /// Computes the lengths for a side whose pins are between `shortest` and `longest` mm apart.
    pub fn new(side: Side, [shortest, longest]: [f64; 2]) -> Self {
        let sleeve = shortest - MIN_GAP;
        Self {
            sleeve,
            rod: longest - sleeve + MIN_OVERLAP,
            lateral_offset: side.sign() * ROD_OFFSET,
        }
    }
}

/// Adds both sliders.
pub fn add(builder: &mut AssemblyBuilder) {
    for side in Side::ALL {
        let lengths = SliderLengths::new(side, compute_slider_range(builder.robot, side));
        add_sleeve(builder, side, &lengths);
        add_rod(builder, side, &lengths);
        add_pins(builder, side);
    }
}

fn add_sleeve(builder: &mut AssemblyBuilder, side: Side, lengths: &SliderLengths) {
    let (parts, stack) = (builder.parts, builder.stack);
    let half_width = builder.half_bar_width();
    let pin = Vector::default();
    let bore_width = ROD_WIDTH + 2.0 * parts.fit;
    let outer_width = bore_width + 2.0 * parts.wall;
    let middle = Vector::new(lengths.sleeve / 2.0, lengths.lateral_offset);
    let case = Shape::rectangle(middle, Vector::new(lengths.sleeve, outer_width), 0.8);
    // The sleeve's corners must not protrude beyond the arm of its eye.
    let arm_end = Vector::new(half_width, lengths.lateral_offset);
    let arm = Shape::bar(pin, arm_end, half_width - 0.02);
    // The bore is open at both ends, so the cut is longer than the sleeve.
    let size = Vector::new(lengths.sleeve + 2.0 * lengths.rod, bore_width);
    let open_bore = Shape::rectangle(middle, size, 0.0);
    let eye_and_case = [Shape::disc(pin, half_width), arm, case.clone()];
    let hole = builder.clearance_hole(pin);
    let (low, top) = (stack.sleeve[0], stack.lower_coupler[1]);
    let [bore_low, bore_high] = stack.bore;
    let mut prisms = vec![
        Prism::new(eye_and_case.clone(), [hole.clone()], [low, bore_low]),
        Prism::new(eye_and_case, [hole, open_bore.clone()], [bore_low, top]),
        Prism::new([case.clone()], [open_bore], [top, bore_high]),
        Prism::solid([case], [bore_high, stack.sleeve[1]]),
    ];
    prisms.retain(Prism::has_height);
    let sleeve = builder.add_printed(Mount::Sleeve(side), prisms);
    sleeve.allowed_contacts = vec![Mount::Rod(side).name()];
}

fn add_rod(builder: &mut AssemblyBuilder, side: Side, lengths: &SliderLengths) {
    let half_width = builder.half_bar_width();
    let pin = Vector::default();
    let middle = Vector::new(-lengths.rod / 2.0, lengths.lateral_offset);
    let bar = Shape::rectangle(middle, Vector::new(lengths.rod, ROD_WIDTH), 1.0);
    // The bend lies in front of the pin, so that the sleeve can come near the pin.
    let bend_end = Vector::new(1.0, lengths.lateral_offset);
    let bend = Shape::bar(pin, bend_end, half_width - 0.02);
    let filled = [Shape::disc(pin, half_width), bend, bar];
    let prism = Prism::new(filled, [builder.clearance_hole(pin)], builder.stack.rod);
    builder.add_printed(Mount::Rod(side), [prism]);
}

fn add_pins(builder: &mut AssemblyBuilder, side: Side) {
    let [front, rear] = side.servos();
    let (stack, arm_tips) = (builder.stack, builder.layout.arm_tips);
    let [sleeve, rod] = [Mount::Sleeve(side), Mount::Rod(side)].map(Mount::name);
    let name = format!("arm {}", SERVO_NAMES[rear]);
    let (position, mount) = (arm_tips[rear], Mount::Link(rear));
    builder.add_link_joint(name, mount, position, stack.lower_coupler[1], &sleeve);
    let name = SERVO_NAMES[front];
    let (position, mount) = (arm_tips[front], Mount::Link(front));
    let spacer_z = [stack.link[1], stack.rod[0]];
    let (spacer_name, name) = (format!("arm spacer {name}"), format!("arm {name}"));
    builder.add_spacer(spacer_name, mount, position, spacer_z, &rod);
    builder.add_link_joint(name, mount, position, stack.rod[1], &rod);
}

/// Computes the shortest and the longest distance between a slider's pins, mm.
pub fn compute_slider_range(robot: &Robot, side: Side) -> [f64; 2] {
    let (slider, limits) = (robot.lizard().side(side), robot.limits());
    [limits.stroke_min, limits.stroke_max].map(|stroke| slider.nominal_length + stroke)
}
