//! The strut between a servo's link and its leg: slotted with a spring, or rigid.
//!
//! A slotted strut has a hole at the servo's end, a slot at the leg's end, and the spring between the screws in hole
//! and slot. The spring pulls the leg's screw against the slot's inner end, so the leg follows its servo exactly until
//! the force on the foot exceeds the spring's pull. Then the screw moves along the slot.
//!
//! The mounted spring's coil extends nearly from screw to screw, and lengthens when the leg lags. The strut is
//! therefore a channel, with the coil along the whole floor of the channel.
//!
//! A rigid strut is a bar with holes for the same screws. It fits into the space of a slotted strut, so either can
//! replace the other, and a rigid strut is at least as far from all other parts.

use lizard_kinematics::Vector;
use lizard_robot::SLOT_LENGTH;
use lizard_robot::servo::{LEG_NAMES, SERVO_NAMES};

use crate::bodies::builder::{AssemblyBuilder, strut_name};
use crate::layers::body::{Body, Kind, Mount, Prism};
use crate::layers::shape::Shape;

/// Adds all struts, and their springs if they have any.
pub fn add(builder: &mut AssemblyBuilder) {
    for servo in 0..4 {
        let strut = make_strut(builder, servo, builder.has_slotted_struts());
        builder.bodies.push(strut);
        if builder.has_slotted_struts() {
            add_spring(builder, servo);
        }
    }
}

/// Makes the struts of the kind that the robot does not have.
pub fn make_alternatives(builder: &AssemblyBuilder) -> Vec<Body> {
    let is_slotted = !builder.has_slotted_struts();
    let struts = (0..4).map(|servo| make_strut(builder, servo, is_slotted));
    struts.collect()
}

fn make_strut(builder: &AssemblyBuilder, servo: usize, is_slotted: bool) -> Body {
    Body {
        name: strut_name(is_slotted, servo),
        kind: Kind::Printed,
        mount: Mount::Strut(servo),
        prisms: match is_slotted {
            true => make_slotted_prisms(builder, servo),
            false => vec![make_rigid_prism(builder, servo)],
        },
        allowed_contacts: vec![Mount::Crank(servo).name()],
    }
}

/// The point on a strut's axis at a distance from the servo's end, mm.
fn point_at(x: f64) -> Vector {
    Vector::new(x, 0.0)
}

/// Half of the width of the channel for spring, hooks and screw heads, mm.
fn channel_half_width(builder: &AssemblyBuilder) -> f64 {
    let parts = builder.parts;
    let spring_radius = parts.spring.outer_diameter / 2.0 + 1.5 * parts.fit;
    (parts.screw.head / 2.0).max(spring_radius) + parts.fit
}

fn make_slotted_prisms(builder: &AssemblyBuilder, servo: usize) -> Vec<Prism> {
    let (stack, half_width) = (builder.stack, channel_half_width(builder));
    let length = builder.layout.legs[servo].strut_length;
    let [from, slot_start, slot_end] = [0.0, length, length + SLOT_LENGTH].map(point_at);
    let build_full_bar = |half_width: f64| Shape::bar(from, slot_end, half_width);
    let outer = vec![build_full_bar(half_width + builder.parts.wall)];
    let hole = builder.clearance_hole(from);
    let slot = Shape::bar(slot_start, slot_end, hole.radius);
    vec![
        Prism::new(outer.clone(), [hole, slot], stack.strut_floor),
        Prism::new(outer, [build_full_bar(half_width)], stack.strut_wall),
    ]
}

fn make_rigid_prism(builder: &AssemblyBuilder, servo: usize) -> Prism {
    let [from, to] = [0.0, builder.layout.legs[servo].strut_length].map(point_at);
    let bar = Shape::bar(from, to, channel_half_width(builder) + builder.parts.wall);
    let holes = [from, to].map(|position| builder.clearance_hole(position));
    Prism::new([bar], holes, builder.stack.rigid_strut)
}

fn add_spring(builder: &mut AssemblyBuilder, servo: usize) {
    let (name, leg) = (SERVO_NAMES[servo], LEG_NAMES[servo]);
    let (stack, parts) = (builder.stack, builder.parts);
    let length = builder.layout.legs[servo].strut_length;
    let radius = parts.spring.outer_diameter / 2.0;
    // Each hook lies around the far side of its screw; the coil is between both hooks.
    let hook_length = parts.spring.outer_diameter - 2.0 * parts.spring.wire_diameter;
    let coil_length = builder.robot.mounted_spring_length() - 2.0 * hook_length;
    let size = Vector::new(coil_length, parts.spring.outer_diameter);
    let coil = Shape::rectangle(point_at(length / 2.0), size, 0.0);
    let z = [stack.coil_middle - radius, stack.coil_middle + radius];
    let coil = Prism::solid([coil], z);
    let mount = Mount::Strut(servo);
    let spring = builder.add_body(format!("spring {leg}"), Kind::Spring, mount, [coil]);
    // The screw heads lie over the hooks and extend to the coil's ends.
    let leg_screw = format!("screw leg anchor {leg}");
    spring.allowed_contacts = vec![leg_screw, format!("screw anchor {name}")];
}
