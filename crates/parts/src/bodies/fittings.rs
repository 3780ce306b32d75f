//! The places of supply, terminal strips and straps on the robot.
//!
//! Each has a place, so that the proof of fit and the mass include it.

use lizard_kinematics::Vector;

use crate::bodies::builder::Builder;
use crate::bodies::layout::STANDOFFS;
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::fitting::{Fitting, STRAP};
use crate::layers::shape::Shape;

/// A slot for the battery's strap, mm: along the plate and across.
const STRAP_SLOT: [f64; 2] = [17.0, 2.4];
/// A slot for a cable tie, mm: along the plate and across.
const TIE_SLOT: [f64; 2] = [4.0, 2.0];
/// From the middle of the plate to the middles of the terminal strips, mm.
const STRIPS: f64 = 12.5;
/// From the middle of the plate to the cable ties, mm.
const TIES: f64 = 27.0;

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

/// Distance of the strap's slots from the plate's middle, mm; `None` if the plate is no
/// wider than the battery, so that the strap goes around both.
fn beside(builder: &Builder) -> Option<f64> {
    let [across, _, _] = builder.parts.battery;
    let x = (across + STRAP[1]) / 2.0;
    let least = x + STRAP_SLOT[1] / 2.0 + builder.parts.wall;
    (builder.layout.plate.half.x >= least).then_some(x)
}

pub fn add(builder: &mut Builder) {
    let stack = builder.stack;
    let [battery_x, battery_y, battery_z] = builder.parts.battery;
    // Under the strap, and under the heads of the standoffs' screws.
    let belly = stack.plate[0] - STRAP[1].max(builder.parts.screw.head_height) - 0.3;
    let deck = stack.deck[0];
    let room = STANDOFFS[1] - 3.4;
    let half = |fitting: Fitting| fitting.size()[1] / 2.0;
    // The strip for ground reaches this far to either side, and the others end there.
    let strip = half(Fitting::Ground);
    for (fitting, x, y, ceiling) in [
        (Fitting::Alarm, 0.0, half(Fitting::Alarm) - room, deck),
        (
            Fitting::Converter,
            0.0,
            room - half(Fitting::Converter),
            deck,
        ),
        (Fitting::Ground, -STRIPS, 0.0, belly),
        (
            Fitting::Supply,
            STRIPS,
            strip - half(Fitting::Supply),
            belly,
        ),
        (
            Fitting::Capacitor,
            STRIPS,
            half(Fitting::Capacitor) - strip,
            belly,
        ),
    ] {
        let [wide, long, high] = fitting.size();
        let block = Shape::rectangle(Vector::new(x, y), Vector::new(wide, long), 0.0);
        let block = Prism::solid([block], [ceiling - high, ceiling]);
        builder.body(
            fitting.name(),
            Kind::Fitting(fitting),
            Mount::Chassis,
            [block],
        );
    }
    // Around the battery, and under the plate.
    let [wide, thick] = STRAP;
    let wide = wide.min(battery_y);
    let x = battery_x / 2.0;
    let bar = |from: f64, to: f64| {
        let middle = Vector::new((from + to) / 2.0, 0.0);
        Shape::rectangle(middle, Vector::new(to - from, wide), 0.0)
    };
    let out = match beside(builder) {
        Some(_) => x,
        None => x.max(builder.layout.plate.half.x),
    };
    let sides = [bar(-out - thick, -out), bar(out, out + thick)];
    let across = bar(-out - thick, out + thick);
    let [under, battery] = [stack.plate[0], battery_z];
    let prisms = [
        Prism::solid([across.clone()], [under - thick, under]),
        Prism::solid(sides, [under, battery]),
        Prism::solid([across], [battery, battery + thick]),
    ];
    let (fitting, mount) = (Fitting::Strap, Mount::Chassis);
    builder.body(fitting.name(), Kind::Fitting(fitting), mount, prisms);
}
