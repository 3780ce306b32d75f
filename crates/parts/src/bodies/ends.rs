//! The couplers of head and tail, with their screws. Each end's left coupler is below its right coupler.

use lizard_kinematics::{End, Vector};

use crate::bodies::builder::{Bolt, Builder, Direction};
use crate::bodies::decoration;
use crate::bodies::names::{coupler_name, servo_and_leg_names};
use crate::layers::body::{Mount, Prism, coupler_length};
use crate::layers::shape::Shape;
use crate::layers::stack::{HEAD_PLAY, Span, Stack};

/// Adds the couplers of both ends, the screws and spacers of their joints, and the decorative parts.
pub fn add(builder: &mut Builder) {
    for end in End::ALL {
        let [left, right] = end.servos();
        let Stack {
            link,
            lower_coupler: lower,
            upper_coupler: upper,
            ..
        } = builder.stack;
        add_coupler(builder, left, lower);
        add_coupler(builder, right, upper);
        // A spacer fills the gap between the crank and the right coupler, which lies higher.
        for (servo, top, spacer_top) in [(left, lower[1], None), (right, upper[1], Some(upper[0]))]
        {
            let tip = Vector::new(builder.layout.crank_lengths[servo], 0.0);
            let (mount, contacts) = (Mount::Link(servo), [&*coupler_name(servo)]);
            let (name, _) = servo_and_leg_names(servo);
            if let Some(spacer_top) = spacer_top {
                let name = format!("tip spacer {name}");
                builder.add_spacer(name, mount, tip, [link[1], spacer_top], &contacts);
            }
            builder.add_link_joint(&format!("tip {name}"), mount, tip, top, &contacts);
        }
        // The screw of the end point joins both couplers and the decorative parts.
        let apex = Vector::new(coupler_length(builder.robot, left), 0.0);
        let decoration = decoration::add(builder, end);
        let mut contacts: Vec<&str> = decoration.upper_bodies.iter().map(String::as_str).collect();
        let upper_coupler_name = coupler_name(right);
        contacts.push(&upper_coupler_name);
        let (head_z, mount) = (lower[0] - decoration.lower_thickness, Mount::Coupler(left));
        builder.add_bolt(&Bolt {
            nut_z: upper[1] + decoration.upper_thickness + HEAD_PLAY,
            contacts: &contacts,
            ..Bolt::new(end.name(), mount, apex, head_z, Direction::Up)
        });
    }
}

/// Adds the coupler of a servo between the heights `z`, mm. A coupler with a decorative part has two layers, since the
/// head of the part's second screw may be sunk into the upper layer.
fn add_coupler(builder: &mut Builder, servo: usize, z: Span) {
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
    let prisms = match decoration::make_second_screw_holes(builder, servo, to) {
        Some([lower_hole, upper_hole]) => {
            let seat_z = z[1] - builder.parts.screw.head_height - HEAD_PLAY;
            let lower = build_layer(Some(lower_hole), [z[0], seat_z]);
            vec![lower, build_layer(Some(upper_hole), [seat_z, z[1]])]
        }
        None => vec![build_layer(None, z)],
    };
    builder.add_printed(coupler_name(servo), Mount::Coupler(servo), prisms);
}
