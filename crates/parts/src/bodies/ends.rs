//! The couplers of head and tail, with their screws. The left coupler of each end lies below the right one.

use lizard_kinematics::{End, Vector};

use crate::bodies::builder::{Bolt, Builder, Direction};
use crate::bodies::looks;
use crate::bodies::names::{coupler, names};
use crate::layers::body::{Mount, Prism, coupler_length};
use crate::layers::shape::Shape;
use crate::layers::stack::{PLAY, Span, Stack};

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
        add_bar(builder, left, lower);
        add_bar(builder, right, upper);
        // The right coupler lies higher, so a spacer fills the gap between the crank and this coupler.
        for (servo, top, spacer_top) in [(left, lower[1], None), (right, upper[1], Some(upper[0]))]
        {
            let tip = Vector::new(builder.layout.crank[servo], 0.0);
            let (mount, meets) = (Mount::Link(servo), [&*coupler(servo)]);
            let (name, _) = names(servo);
            if let Some(spacer_top) = spacer_top {
                let name = format!("tip spacer {name}");
                builder.add_spacer(name, mount, tip, [link[1], spacer_top], &meets);
            }
            builder.add_held_joint(&format!("tip {name}"), mount, tip, top, &meets);
        }
        // The screw of the end point joins both couplers and the decorative parts.
        let apex = Vector::new(coupler_length(builder.robot, left), 0.0);
        let looks = looks::add(builder, end);
        let mut meets: Vec<&str> = looks.on_right.iter().map(String::as_str).collect();
        let right = coupler(right);
        meets.push(&right);
        let (head, mount) = (lower[0] - looks.below, Mount::Coupler(left));
        builder.add_bolt(&Bolt {
            nut_z: upper[1] + looks.above + PLAY,
            meets: &meets,
            ..Bolt::new(end.name(), mount, apex, head, Direction::Up)
        });
    }
}

/// Adds the coupler of a servo between the heights `z`. If a second screw holds a decorative part on it, the coupler
/// has two layers, since the head of that screw may be sunk in the upper one.
fn add_bar(builder: &mut Builder, servo: usize, z: Span) {
    let from = Vector::default();
    let to = Vector::new(coupler_length(builder.robot, servo), 0.0);
    let layer_of = |hole: Option<Shape>, z: Span| {
        let mut filled = vec![Shape::bar(from, to, builder.half_bar())];
        let mut cut = vec![builder.hole(from), builder.hole(to)];
        let boss_of = |hole: &Shape| Shape::disc(hole.middle(), builder.around_head());
        filled.extend(hole.iter().map(boss_of));
        cut.extend(hole);
        Prism::new(filled, cut, z)
    };
    let prisms = match looks::second_screw_holes(builder, servo, to) {
        Some([lower_hole, upper_hole]) => {
            let seat = z[1] - builder.parts.screw.head_height - PLAY;
            let lower = layer_of(Some(lower_hole), [z[0], seat]);
            vec![lower, layer_of(Some(upper_hole), [seat, z[1]])]
        }
        None => vec![layer_of(None, z)],
    };
    builder.add_printed(coupler(servo), Mount::Coupler(servo), prisms);
}
