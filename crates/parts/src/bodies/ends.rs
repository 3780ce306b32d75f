//! The couplers of head and tail, with their screws. Each end's left coupler is below its right coupler.

use lizard_kinematics::{End, Vector};
use lizard_robot::servo::SERVO_NAMES;

use crate::bodies::builder::ScrewDirection::Up;
use crate::bodies::builder::{AssemblyBuilder, Screw};
use crate::bodies::decoration;
use crate::layers::body::{Mount, Prism, coupler_length};
use crate::layers::shape::Shape;
use crate::layers::stack::{HEAD_CLEARANCE, Span};

/// Adds the couplers of both ends, the screws and spacers of their joints, and the decorative parts.
pub fn add(builder: &mut AssemblyBuilder) {
    for end in End::ALL {
        let [left, right] = end.servos();
        let stack = builder.stack;
        let (link, lower, upper) = (stack.link, stack.lower_coupler, stack.upper_coupler);
        add_coupler(builder, left, lower);
        add_coupler(builder, right, upper);
        for (servo, [bottom, top]) in [(left, lower), (right, upper)] {
            let tip = Vector::new(builder.layout.crank_lengths[servo], 0.0);
            let (mount, coupler) = (Mount::Link(servo), Mount::Coupler(servo).name());
            let name = SERVO_NAMES[servo];
            // A spacer fills the gap between the crank and the right coupler, which lies higher.
            if servo == right {
                let name = format!("tip spacer {name}");
                builder.add_spacer(name, mount, tip, [link[1], bottom], &coupler);
            }
            builder.add_link_joint(format!("tip {name}"), mount, tip, top, &coupler);
        }
        // The screw of the end point joins both couplers and the decorative parts.
        let end_point = Vector::new(coupler_length(builder.robot, left), 0.0);
        let decoration = decoration::add(builder, end);
        let (seat_z, mount) = (lower[0] - decoration.lower_thickness, Mount::Coupler(left));
        let mut screw = Screw::new(end.name(), mount, end_point, seat_z, Up);
        screw.allowed_contacts = decoration.upper_body_names;
        let nut_z = upper[1] + decoration.upper_thickness + HEAD_CLEARANCE;
        builder.add_bolt(&screw.touching(Mount::Coupler(right).name()), nut_z);
    }
}

/// Adds the coupler of a servo between the heights `z`, mm. A coupler with a decorative part has two layers, since the
/// head of the part's second screw may be sunk into the upper layer.
fn add_coupler(builder: &mut AssemblyBuilder, servo: usize, z: Span) {
    let from = Vector::default();
    let to = Vector::new(coupler_length(builder.robot, servo), 0.0);
    let build_layer = |hole: Option<Shape>, z: Span| {
        let mut filled = vec![Shape::bar(from, to, builder.half_bar_width())];
        let mut cut = vec![builder.clearance_hole(from), builder.clearance_hole(to)];
        let build_boss = |hole: &Shape| Shape::disc(hole.middle(), builder.head_boss_radius());
        filled.extend(hole.iter().map(build_boss));
        cut.extend(hole);
        Prism::new(filled, cut, z)
    };
    let prisms = match decoration::make_second_screw_holes(builder, servo) {
        Some([lower_hole, upper_hole]) => {
            let seat_z = z[1] - builder.parts.screw.head_height - HEAD_CLEARANCE;
            let lower = build_layer(Some(lower_hole), [z[0], seat_z]);
            vec![lower, build_layer(Some(upper_hole), [seat_z, z[1]])]
        }
        None => vec![build_layer(None, z)],
    };
    builder.add_printed(Mount::Coupler(servo), prisms);
}
