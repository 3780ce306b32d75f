//! Where supply, strips for wires and straps are on the robot.
//!
//! Each has a place, so that the proof of fit and the mass include it.

use lizard_kinematics::Vector;

use crate::bodies::builder::Builder;
use crate::bodies::layout::STANDOFFS;
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::fitting::{Fitting, STRAP};
use crate::layers::shape::Shape;
use crate::layers::stack::Span;

/// A slot for it, mm: along the plate and across.
const STRAP_SLOT: [f64; 2] = [17.0, 2.4];
/// A slot for a cable tie, mm: along the plate and across.
const TIE_SLOT: [f64; 2] = [4.0, 2.0];
/// From the middle of the plate to the middles of the terminal strips, mm.
const STRIPS: f64 = 12.5;

/// Slots in the plate: for the strap beside the battery, if the plate is wide enough, and
/// for cable ties beside the terminal strips.
pub fn slots(builder: &Builder) -> Vec<Shape> {
    let slot = |x: f64, y: f64, [along, across]: [f64; 2]| {
        Shape::rectangle(Vector::new(x, y), Vector::new(across, along), 0.5)
    };
    let mut slots = Vec::new();
    if let Some(x) = beside(builder) {
        slots.extend([-x, x].map(|x| slot(x, 0.0, STRAP_SLOT)));
    }
    for x in [-STRIPS - 4.5, -STRIPS + 4.5, STRIPS - 4.5, STRIPS + 4.5] {
        slots.extend([-TIES, TIES].map(|y| slot(x, y, TIE_SLOT)));
    }
    slots
}

/// From the middle of the plate to the cable ties, mm.
const TIES: f64 = 27.0;

/// Where the strap's slots are beside the battery, mm; `None` where the plate is no
/// wider than the battery, and the strap goes around both.
fn beside(builder: &Builder) -> Option<f64> {
    let [across, _, _] = builder.parts.battery;
    let x = (across + STRAP[1]) / 2.0;
    let least = x + STRAP_SLOT[1] / 2.0 + builder.parts.wall;
    (builder.layout.plate.half.x >= least).then_some(x)
}

pub fn add(builder: &mut Builder) {
    let stack = builder.stack;
    let [_, battery_y, battery_z] = builder.parts.battery;
    let under = |fitting: Fitting, ceiling: f64| {
        let [.., z] = fitting.size();
        [ceiling - z, ceiling]
    };
    // Under the strap, and under the heads of the standoffs' screws.
    let belly = stack.plate[0] - STRAP[1].max(builder.parts.screw.head_height) - 0.3;
    let deck = stack.deck[0];
    let room = STANDOFFS[1] - 3.4;
    let half = |fitting: Fitting| fitting.size()[1] / 2.0;
    for (fitting, at, z) in [
        (
            Fitting::Alarm,
            (0.0, half(Fitting::Alarm) - room),
            under(Fitting::Alarm, deck),
        ),
        (
            Fitting::Converter,
            (0.0, room - half(Fitting::Converter)),
            under(Fitting::Converter, deck),
        ),
        (
            Fitting::Ground,
            (-STRIPS, 0.0),
            under(Fitting::Ground, belly),
        ),
        (
            Fitting::Supply,
            (STRIPS, half(Fitting::Ground) - half(Fitting::Supply)),
            under(Fitting::Supply, belly),
        ),
        (
            Fitting::Capacitor,
            (STRIPS, half(Fitting::Capacitor) - half(Fitting::Ground)),
            under(Fitting::Capacitor, belly),
        ),
    ] {
        let [x, y, _] = fitting.size();
        let block = Shape::rectangle(Vector::new(at.0, at.1), Vector::new(x, y), 0.0);
        one(builder, fitting, vec![(block, z)]);
    }
    // Around the battery, and under the plate.
    let [wide, thick] = STRAP;
    let wide = wide.min(battery_y);
    let x = builder.parts.battery[0] / 2.0;
    let bar = |from: f64, to: f64| {
        Shape::rectangle(
            Vector::new((from + to) / 2.0, 0.0),
            Vector::new(to - from, wide),
            0.0,
        )
    };
    let out = match beside(builder) {
        Some(_) => x,
        None => x.max(builder.layout.plate.half.x),
    };
    let sides = [bar(-out - thick, -out), bar(out, out + thick)];
    let across = bar(-out - thick, out + thick);
    let prisms = vec![
        (
            vec![across.clone()],
            [stack.plate[0] - thick, stack.plate[0]],
        ),
        (sides.to_vec(), [stack.plate[0], battery_z]),
        (vec![across], [battery_z, battery_z + thick]),
    ];
    layers(builder, Fitting::Strap, prisms);
}

fn one(builder: &mut Builder, fitting: Fitting, shapes: Vec<(Shape, Span)>) {
    let prisms = shapes.into_iter().map(|(shape, z)| (vec![shape], z));
    layers(builder, fitting, prisms.collect());
}

fn layers(builder: &mut Builder, fitting: Fitting, layers: Vec<(Vec<Shape>, Span)>) {
    let prisms = layers.into_iter().map(|(add, z)| Prism {
        add,
        cut: Vec::new(),
        z,
    });
    builder.body(
        fitting.name().to_owned(),
        Kind::Fitting(fitting),
        Mount::Chassis,
        prisms.collect(),
    );
}
