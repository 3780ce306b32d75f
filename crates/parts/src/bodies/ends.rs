//! Head and tail: two couplers each, the left one below the right one.

use lizard_kinematics::{End, Vector};

use crate::bodies::builder::Builder;
use crate::bodies::looks;
use crate::bodies::names::{coupler, names};
use crate::layers::body::{Kind, Mount, Prism, coupler_length};
use crate::layers::shape::Shape;
use crate::layers::stack::{PLAY, Span};

pub fn add(builder: &mut Builder) {
    for end in End::ALL {
        let [left, right] = end.servos();
        let (stack, lower, upper) = (builder.stack, builder.stack.lower, builder.stack.upper);
        bar(builder, left, lower);
        bar(builder, right, upper);
        let tip = |servo: usize| Vector::new(builder.layout.crank[servo], 0.0);
        let tips = [tip(left), tip(right)];
        builder.held_joint(
            &format!("tip {}", names(left).0),
            Mount::Link(left),
            tips[0],
            lower[1],
            &[&coupler(left)],
        );
        builder.spacer(
            format!("tip spacer {}", names(right).0),
            Mount::Link(right),
            tips[1],
            [stack.link[1], upper[0]],
            &[&coupler(right)],
        );
        builder.held_joint(
            &format!("tip {}", names(right).0),
            Mount::Link(right),
            tips[1],
            upper[1],
            &[&coupler(right)],
        );
        let apex = Vector::new(coupler_length(builder.robot, left), 0.0);
        let looks = looks::add(builder, end);
        let mut meets: Vec<&str> = looks.on_right.iter().map(String::as_str).collect();
        let right = coupler(right);
        meets.push(&right);
        builder.joint(
            end.name(),
            Mount::Coupler(left),
            apex,
            [lower[0] - looks.below, upper[1] + looks.above],
            &meets,
        );
    }
}

fn bar(builder: &mut Builder, servo: usize, z: Span) {
    let from = Vector::default();
    let to = Vector::new(coupler_length(builder.robot, servo), 0.0);
    let layer = |hole: Option<Shape>, z: Span| {
        let mut add = vec![Shape::bar(from, to, builder.half())];
        let mut cut = vec![builder.hole(from), builder.hole(to)];
        let around = |hole: &Shape| Shape::disc(hole.middle(), builder.around_head());
        add.extend(hole.iter().map(around));
        cut.extend(hole);
        Prism { add, cut, z }
    };
    let prisms = match looks::fixed(builder, servo, to) {
        Some([below, above]) => {
            let seat = z[1] - builder.parts.screw.head_height - PLAY;
            vec![
                layer(Some(below), [z[0], seat]),
                layer(Some(above), [seat, z[1]]),
            ]
        }
        None => vec![layer(None, z)],
    };
    builder.body(coupler(servo), Kind::Printed, Mount::Coupler(servo), prisms);
}
