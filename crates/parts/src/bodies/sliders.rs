//! The sides: a rod in a sleeve between the arms of a front and a rear servo.
//!
//! The sleeve would be too short for the stroke if it lay between the pins. So both
//! lie beside them, the sleeve begins at the rear pin, and the rod passes it.

use lizard_kinematics::{Side, Vector};
use lizard_robot::Robot;

use crate::bodies::builder::Builder;
use crate::bodies::names::names;
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::shape::Shape;
use crate::layers::stack::Span;

/// How far sleeve and rod lie beside the pins, outward, mm.
pub const BESIDE: f64 = 9.0;
/// Width of a rod, mm.
pub(crate) const ROD: f64 = 6.0;
/// The least length of the rod inside its sleeve, mm.
const OVERLAP: f64 = 20.0;
/// From the sleeve's end to the front pin at the shortest, mm.
const SHORT: f64 = 8.0;

/// Lengths of one slider, mm, along its line from the rear pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderLengths {
    /// The sleeve's end; it begins at the rear pin.
    pub sleeve: f64,
    /// The rod, from the front pin to its rear end.
    pub rod: f64,
    /// From the pins' line to the rod's, positive to the left.
    pub beside: f64,
}

impl SliderLengths {
    /// Of a side whose pins may be from `shortest` to `longest` mm apart.
    #[must_use]
    pub fn new(side: Side, [shortest, longest]: [f64; 2]) -> Self {
        let sleeve = shortest - SHORT;
        Self {
            sleeve,
            rod: longest - sleeve + OVERLAP,
            beside: side.sign() * BESIDE,
        }
    }
}

pub fn add(builder: &mut Builder) {
    for side in Side::ALL {
        let lengths = SliderLengths::new(side, slider_range(builder.robot, side));
        sleeve(builder, side, &lengths);
        rod(builder, side, &lengths);
        pins(builder, side);
    }
}

fn sleeve(builder: &mut Builder, side: Side, lengths: &SliderLengths) {
    let (parts, stack) = (builder.parts, builder.stack);
    let half = builder.half();
    let pin = Vector::default();
    let bore = ROD + 2.0 * parts.fit;
    let outer = bore + 2.0 * parts.wall;
    let middle = Vector::new(lengths.sleeve / 2.0, lengths.beside);
    let case = Shape::rectangle(middle, Vector::new(lengths.sleeve, outer), 0.8);
    // The sleeve's corners must not stand out beyond the eye's arm.
    let arm = Shape::bar(pin, Vector::new(half, lengths.beside), half - 0.02);
    // The bore is open at both ends, for as far as the rod reaches.
    let open = Shape::rectangle(
        middle,
        Vector::new(lengths.sleeve + 2.0 * lengths.rod, bore),
        0.0,
    );
    let eye = vec![Shape::disc(pin, half), arm, case.clone()];
    let hole = builder.hole(pin);
    let top = stack.lower[1];
    let layer = |add: &[Shape], cut: Vec<Shape>, z: Span| Prism {
        add: add.to_vec(),
        cut,
        z,
    };
    let prisms = vec![
        layer(&eye, vec![hole.clone()], [stack.sleeve[0], stack.bore[0]]),
        layer(&eye, vec![hole, open.clone()], [stack.bore[0], top]),
        layer(
            std::slice::from_ref(&case),
            vec![open],
            [top, stack.bore[1]],
        ),
        layer(&[case], Vec::new(), [stack.bore[1], stack.sleeve[1]]),
    ];
    let prisms = prisms
        .into_iter()
        .filter(|prism| prism.z[1] > prism.z[0] + 1e-9)
        .collect();
    builder.body(
        format!("sleeve {side}"),
        Kind::Printed,
        Mount::Sleeve(side),
        prisms,
    );
    builder.meeting(&format!("rod {side}"));
}

fn rod(builder: &mut Builder, side: Side, lengths: &SliderLengths) {
    let half = builder.half();
    let pin = Vector::default();
    let middle = Vector::new(-lengths.rod / 2.0, lengths.beside);
    let bar = Shape::rectangle(middle, Vector::new(lengths.rod, ROD), 1.0);
    // Ahead of the pin, so that the sleeve may come near.
    let bend = Vector::new(1.0, lengths.beside);
    let prism = Prism {
        add: vec![
            Shape::disc(pin, half),
            Shape::bar(pin, bend, half - 0.02),
            bar,
        ],
        cut: vec![builder.hole(pin)],
        z: builder.stack.rod,
    };
    builder.body(
        format!("rod {side}"),
        Kind::Printed,
        Mount::Rod(side),
        vec![prism],
    );
}

fn pins(builder: &mut Builder, side: Side) {
    let [front, rear] = side.servos();
    let stack = builder.stack;
    let arm =
        |servo: usize| Vector::new(0.0, builder.layout.hand[servo] * builder.layout.arm[servo]);
    let (front_arm, rear_arm) = (arm(front), arm(rear));
    let (rod, sleeve) = (format!("rod {side}"), format!("sleeve {side}"));
    builder.held_joint(
        &format!("arm {}", names(rear).0),
        Mount::Link(rear),
        rear_arm,
        stack.lower[1],
        &[&sleeve],
    );
    builder.spacer(
        format!("arm spacer {}", names(front).0),
        Mount::Link(front),
        front_arm,
        [stack.link[1], stack.rod[0]],
        &[&rod],
    );
    builder.held_joint(
        &format!("arm {}", names(front).0),
        Mount::Link(front),
        front_arm,
        stack.rod[1],
        &[&rod],
    );
}

/// The shortest and the longest that a slider may be from pin to pin, mm.
pub fn slider_range(robot: &Robot, side: Side) -> [f64; 2] {
    let (slider, limits) = (robot.lizard().side(side), robot.limits());
    [
        slider.nominal + limits.stroke_min,
        slider.nominal + limits.stroke_max,
    ]
}
