//! What the robot carries beside its mechanism: supply, strips for wires, straps.
//!
//! Each has a place on the robot, so that the proof of fit knows it and its grams count.
//! Shops have them in many sizes: the sizes here are the largest that the places take.

use lizard_kinematics::Vector;

use crate::body::{Kind, Mount, Prism};
use crate::builder::Builder;
use crate::chassis::STANDOFFS;
use crate::shape::Shape;
use crate::stack::Span;

/// Width of the battery's strap, and its thickness, mm.
pub const STRAP: [f64; 2] = [16.0, 1.5];
/// A slot for it, mm: along the plate and across.
const STRAP_SLOT: [f64; 2] = [17.0, 2.4];
/// A slot for a cable tie, mm: along the plate and across.
const TIE_SLOT: [f64; 2] = [4.0, 2.0];
/// From the middle of the plate to the middles of the terminal strips, mm.
const STRIPS: f64 = 12.5;

/// A thing that is bought and put on the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fitting {
    /// Makes 5 V for the servos from the battery's voltage.
    Converter,
    /// Holds the servos' supply up when they start.
    Capacitor,
    /// Beeps before the battery is damaged.
    Alarm,
    /// Joins everything that belongs to ground.
    Ground,
    /// Joins the servos' supply.
    Supply,
    /// Holds the battery.
    Strap,
}

impl Fitting {
    /// Its name as a body.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Converter => "converter",
            Self::Capacitor => "capacitor",
            Self::Alarm => "alarm",
            Self::Ground => "ground strip",
            Self::Supply => "supply strip",
            Self::Strap => "battery strap",
        }
    }

    /// What to buy.
    #[must_use]
    pub fn what(self) -> String {
        let [x, y, z] = self.size();
        let least = format!("at most {x} x {y} x {z} mm");
        match self {
            Self::Converter => format!("converter from 7.4 V to 5 V, 3 A, {least}"),
            Self::Capacitor => {
                format!("capacitor 1000 uF, 10 V or more, at most {x} mm thick and {y} mm long")
            }
            Self::Alarm => format!("low-voltage alarm for two lithium cells, {least}"),
            Self::Ground => format!("terminal strip, 12 ways, for ground, {least}"),
            Self::Supply => format!("terminal strip, 8 ways, for +5 V, {least}"),
            Self::Strap => format!("hook-and-loop strap, {x} mm wide, 150 mm long"),
        }
    }

    /// Its mass, g, as shops give it.
    #[must_use]
    pub fn grams(self) -> f64 {
        match self {
            Self::Converter => 8.0,
            Self::Capacitor => 2.0,
            Self::Alarm => 9.0,
            Self::Ground => 12.0,
            Self::Supply => 8.0,
            Self::Strap => 3.0,
        }
    }

    /// To the right, forward, up, mm.
    fn size(self) -> [f64; 3] {
        match self {
            Self::Converter => [18.0, 28.0, 8.0],
            Self::Capacitor => [10.0, 20.0, 10.0],
            Self::Alarm => [25.0, 40.0, 9.0],
            Self::Ground => [16.0, 84.0, 13.0],
            Self::Supply => [16.0, 60.0, 13.0],
            Self::Strap => [STRAP[0], 0.0, STRAP[1]],
        }
    }
}

/// Slots in the plate: for the strap beside the battery, if the plate is so wide, and
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
