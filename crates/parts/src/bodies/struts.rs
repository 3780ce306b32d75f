//! The strut between a servo's link and its leg: one with a spring, or a rigid one.
//!
//! A strut with a spring has a hole at the servo's end, a slot at the leg's end, and the spring between the
//! screws in both. The spring pulls the leg's screw against the slot's inner end, so the leg follows its servo
//! exactly until the force on the foot exceeds the spring's pull. Then the screw moves along the slot.
//!
//! An installed spring is stretched, and so is its coil. The coil reaches nearly from screw to screw, and
//! becomes longer when the leg lags. So the strut is a channel, and the coil lies on its floor along its whole
//! length.
//!
//! A rigid strut is a bar with two holes in the same places, for the same screws. It fits in the space of a
//! strut with a spring, so either can replace the other, and its distance from all other parts is at least as
//! large.

use lizard_kinematics::Vector;
use lizard_robot::SLOT;

use crate::bodies::builder::Builder;
use crate::bodies::names::{self, names};
use crate::layers::body::{Body, Kind, Mount, Prism};
use crate::layers::shape::Shape;

pub fn add(builder: &mut Builder) {
    for servo in 0..4 {
        let strut = strut_body(builder, servo, builder.has_slotted_struts());
        builder.bodies.push(strut);
        if builder.has_slotted_struts() {
            add_spring(builder, servo);
        }
    }
}

/// The struts of the other kind, which can replace the robot's own.
pub fn alternatives(builder: &Builder) -> Vec<Body> {
    (0..4)
        .map(|servo| strut_body(builder, servo, !builder.has_slotted_struts()))
        .collect()
}

fn strut_body(builder: &Builder, servo: usize, is_slotted: bool) -> Body {
    let (_, leg) = names(servo);
    Body {
        name: names::strut(is_slotted, leg),
        kind: Kind::Printed,
        mount: Mount::Strut(servo),
        prisms: match is_slotted {
            true => slotted_prisms(builder, servo),
            false => vec![rigid_prism(builder, servo)],
        },
        allowed_contacts: vec![format!("crank {leg}")],
    }
}

fn point_at(x: f64) -> Vector {
    Vector::new(x, 0.0)
}

/// Half the width of the channel in which spring, hooks and screw heads lie, mm.
fn channel_half_width(builder: &Builder) -> f64 {
    let parts = builder.parts;
    let spring = parts.spring.outer / 2.0 + 1.5 * parts.fit;
    (parts.screw.head / 2.0).max(spring) + parts.fit
}

fn slotted_prisms(builder: &Builder, servo: usize) -> Vec<Prism> {
    let (stack, channel) = (builder.stack, channel_half_width(builder));
    let length = builder.layout.legs[servo].strut_length;
    let whole_bar_of = |half: f64| Shape::bar(point_at(0.0), point_at(length + SLOT), half);
    let outer = vec![whole_bar_of(channel + builder.parts.wall)];
    let hole = builder.hole(point_at(0.0));
    let slot = Shape::bar(point_at(length), point_at(length + SLOT), hole.radius);
    vec![
        Prism::new(outer.clone(), [hole, slot], stack.strut),
        Prism::new(outer, [whole_bar_of(channel)], stack.recess),
    ]
}

fn rigid_prism(builder: &Builder, servo: usize) -> Prism {
    let [from, to] = [
        point_at(0.0),
        point_at(builder.layout.legs[servo].strut_length),
    ];
    let bar = Shape::bar(from, to, channel_half_width(builder) + builder.parts.wall);
    let holes = [from, to].map(|position| builder.hole(position));
    Prism::new([bar], holes, builder.stack.rigid)
}

fn add_spring(builder: &mut Builder, servo: usize) {
    let (name, leg) = names(servo);
    let (stack, parts) = (builder.stack, builder.parts);
    let length = builder.layout.legs[servo].strut_length;
    let radius = parts.spring.outer / 2.0;
    // Each hook lies around the far side of its screw; the coil is between both hooks.
    let hook = parts.spring.outer - 2.0 * parts.spring.wire;
    let size = Vector::new(
        builder.robot.mounted_spring_length() - 2.0 * hook,
        parts.spring.outer,
    );
    let coil = Shape::rectangle(point_at(length / 2.0), size, 0.0);
    let coil = Prism::solid([coil], [stack.coil - radius, stack.coil + radius]);
    let (spring, mount) = (format!("spring {leg}"), Mount::Strut(servo));
    builder.add_body(spring, Kind::Spring, mount, [coil]);
    // The screw heads lie over the hooks and reach to the coil's ends.
    builder.allow_contact(&[
        format!("screw leg anchor {leg}"),
        format!("screw anchor {name}"),
    ]);
}
