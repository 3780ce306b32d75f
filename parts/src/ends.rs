//! Head and tail: two couplers each, the left one below the right one.

use lizard_kinematics::{End, Vector};
use lizard_robot::Robot;

use crate::body::{Kind, Mount, Prism, at_end};
use crate::builder::Builder;
use crate::names::{coupler, names};
use crate::shape::Shape;
use crate::stack::Span;

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
        builder.joint(
            end.name(),
            Mount::Coupler(left),
            apex,
            [lower[0], upper[1]],
            &[&coupler(right)],
        );
    }
}

fn bar(builder: &mut Builder, servo: usize, z: Span) {
    let from = Vector::default();
    let to = Vector::new(coupler_length(builder.robot, servo), 0.0);
    let bar = Prism {
        add: vec![Shape::bar(from, to, builder.half())],
        cut: vec![builder.hole(from), builder.hole(to)],
        z,
    };
    builder.body(
        coupler(servo),
        Kind::Printed,
        Mount::Coupler(servo),
        vec![bar],
    );
}

/// Length of the coupler on a servo's crank, mm.
fn coupler_length(robot: &Robot, servo: usize) -> f64 {
    let (end, hand) = at_end(servo);
    let bars = robot.lizard().end(end);
    [bars.coupler_left, bars.coupler_right][hand]
}
