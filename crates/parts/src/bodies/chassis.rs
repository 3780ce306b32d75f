//! The bodies that do not move: plate, servos, battery, deck and board.

use lizard_kinematics::{End, Vector};

use crate::bodies::builder::{Bolt, Builder, Direction};
use crate::bodies::fittings;
use crate::bodies::layout::{STANDOFF_RADIUS, STANDOFFS, UNO, UNO_BOARD_THICKNESS};
use crate::bodies::leads;
use crate::bodies::names::names;
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::mark;
use crate::layers::shape::Shape;

/// Radius of a servo's spline, mm.
pub const SPLINE: f64 = 2.4;
/// Radius of the hole that a servo's own screw cuts its thread into, mm. One of a servo's two
/// holes is beside the notch for the lead, with 0.35 mm between hole and notch: there the screw
/// holds on the three other sides.
const PILOT_RADIUS: f64 = 0.75;

/// Distance from a seat to the middle of its servo's number, and the number's outward shift from
/// the servo's middle, mm.
const NUMBER: f64 = 4.0;

/// The holes of a UNO relative to its middle, with the USB socket behind, mm: (550, 100), (600,
/// 2000), (2600, 300), (2600, 1400) mil from a corner.
const UNO_HOLES: [(f64, f64); 4] = [
    (24.13, -20.32),
    (-24.13, -19.05),
    (19.05, 31.75),
    (-8.89, 31.75),
];
/// The hole beside the pin AREF, whose header leaves no room for a screw's head.
const UNO_TIGHT_HOLE: usize = 1;

fn at(x: f64, y: f64) -> Vector {
    Vector::new(x, y)
}

pub fn add(builder: &mut Builder) {
    add_plate(builder);
    for servo in 0..4 {
        add_case(builder, servo);
    }
    leads::add(builder);
    add_battery(builder);
    fittings::add(builder);
    add_deck(builder);
    add_board(builder);
}

/// Outline of a servo's case from above, wider by `air` on each side.
fn opening(builder: &Builder, servo: usize, air: f64) -> Shape {
    let body = &builder.parts.servo;
    let size = at(body.width + 2.0 * air, body.length + 2.0 * air);
    Shape::rectangle(case_middle(builder, servo), size, 0.0)
}

fn case_middle(builder: &Builder, servo: usize) -> Vector {
    builder.layout.plate.cases[servo]
}

fn inward(servo: usize) -> Vector {
    at(0.0, -End::of_servo(servo).sign())
}

/// The positions of the two screws that hold a servo's flange.
fn flange_holes(builder: &Builder, servo: usize) -> [Vector; 2] {
    let half = inward(servo) * (builder.parts.servo.holes / 2.0);
    let middle = case_middle(builder, servo);
    [middle - half, middle + half]
}

/// Outline of a servo's seat, wider by `more` on each side.
fn seat(builder: &Builder, servo: usize, more: f64) -> Shape {
    let body = &builder.parts.servo;
    let around = builder.parts.fit + builder.parts.wall + more;
    let size = at(body.width + 2.0 * around, body.flange + 2.0 + 2.0 * more);
    Shape::rectangle(case_middle(builder, servo), size, 1.0)
}

/// The cut-outs that a servo needs in the plate and in its seat: for its case, for its lead, and
/// for its screws.
fn cutouts(builder: &Builder, servo: usize) -> Vec<Shape> {
    let (parts, outward) = (builder.parts, End::of_servo(servo).sign());
    let notch = leads::notch(
        &parts.servo,
        case_middle(builder, servo),
        parts.fit,
        outward,
    );
    let mut cut = vec![opening(builder, servo, parts.fit), notch];
    cut.extend(flange_holes(builder, servo).map(|at| Shape::disc(at, PILOT_RADIUS)));
    cut
}

fn standoffs() -> [Vector; 4] {
    let [x, y] = STANDOFFS;
    [at(-x, y), at(x, y), at(x, -y), at(-x, -y)]
}

fn add_plate(builder: &mut Builder) {
    let (stack, layout) = (builder.stack, builder.layout);
    let plate = layout.plate;
    let seats: Vec<_> = (0..4).map(|servo| seat(builder, servo, 0.0)).collect();
    // First all openings, then all holes: the shapes appear in this order in the files, which
    // must not change.
    let all: Vec<_> = (0..4).map(|servo| cutouts(builder, servo)).collect();
    let openings = all.iter().flat_map(|cut| &cut[..2]);
    let cut: Vec<_> = openings
        .chain(all.iter().flat_map(|cut| &cut[2..]))
        .cloned()
        .collect();
    let body = Shape::rectangle(Vector::default(), plate.half * 2.0, plate.corner);
    let mut add = vec![body];
    let mut through = cut.clone();
    // Bars that end at the same point differ by 0.01 mm in half their width, so that no two ends are the same arc.
    for (leg, [between, driven, idle]) in layout.legs.iter().zip(plate.arms) {
        let bar = |[from, to]: [Vector; 2], half: f64| Shape::bar(from, to, half);
        add.push(bar(between, plate.arm));
        for (pivot, arm) in [(leg.crank_pivot, driven), (leg.follower_pivot, idle)] {
            add.push(bar(arm, plate.arm - 0.01));
            through.push(builder.hole(pivot));
        }
    }
    through.extend(standoffs().map(|at| builder.hole(at)));
    through.extend(leads::holes());
    through.extend(fittings::slots(builder));
    let [low, high] = stack.plate;
    let engraved = [&through[..], &numbers(builder)].concat();
    let prisms = [
        Prism::new(add.clone(), through, [low, high - mark::MARK_DEPTH]),
        Prism::new(add, engraved, [high - mark::MARK_DEPTH, high]),
        Prism::new(seats, cut, stack.seat),
    ];
    builder.add_printed("plate", Mount::Chassis, prisms);
}

/// The piece of the plate around one servo and the pivots of its leg, which is printed first, as
/// a trial.
pub fn corner(builder: &Builder, servo: usize) -> Vec<Prism> {
    /// Width of the plate around the seat, mm.
    const AROUND: f64 = 2.0;
    let (parts, stack, plate) = (builder.parts, builder.stack, builder.layout.plate);
    let leg = &builder.layout.legs[servo];
    let middle = case_middle(builder, servo);
    let mut add = vec![seat(builder, servo, AROUND)];
    let [between, driven, idle] = plate.arms[servo];
    // As in the plate, bars that end at the same point differ by 0.01 mm.
    add.push(Shape::bar(between[0], between[1], plate.arm));
    for [from, to] in [driven, idle] {
        add.push(Shape::bar(from, to, plate.arm - 0.01));
        add.push(Shape::bar(to, middle, plate.arm - 0.02));
    }
    let cut = cutouts(builder, servo);
    let pivots = [leg.crank_pivot, leg.follower_pivot].map(|at| builder.hole(at));
    let raised = stack.seat.map(|z| z + parts.plate);
    vec![
        Prism::new(add, [&cut[..], &pivots].concat(), [0.0, parts.plate]),
        Prism::new([seat(builder, servo, 0.0)], cut, raised),
    ]
}

/// The servos' numbers, engraved beside the seats, so that head and tail can be told apart.
fn numbers(builder: &Builder) -> Vec<Shape> {
    let body = &builder.parts.servo;
    let strokes = (0..4).flat_map(|servo| {
        let [wide, high] = mark::size("1");
        let middle = case_middle(builder, servo);
        // On the inner side of the seat, away from the hole for the leads.
        let out = middle.x.signum() * NUMBER;
        let before = inward(servo) * (body.flange / 2.0 + 1.0 + NUMBER);
        let at = middle + before + at(out - wide / 2.0, -high / 2.0);
        mark::strokes(&(servo + 1).to_string(), at)
    });
    strokes.collect()
}

fn add_case(builder: &mut Builder, servo: usize) {
    let (name, _) = names(servo);
    let body = builder.parts.servo;
    let bottom = builder.stack.servo;
    let shaft = builder.layout.shafts[servo];
    let layer =
        |add: Vec<Shape>, low: f64, high: f64| Prism::solid(add, [bottom + low, bottom + high]);
    let case = opening(builder, servo, 0.0);
    let flange = Shape::rectangle(
        case_middle(builder, servo),
        at(body.width, body.flange),
        0.0,
    );
    let gears = vec![
        Shape::disc(shaft, body.width / 2.0 - 0.05),
        Shape::bar(shaft, shaft + inward(servo) * body.shaft, 3.0),
    ];
    let over = body.flange_height + body.flange_thickness;
    let spline = vec![Shape::disc(shaft, SPLINE)];
    let prisms = [
        layer(vec![case.clone()], 0.0, body.flange_height),
        layer(vec![flange], body.flange_height, over),
        layer(vec![case], over, body.height),
        layer(gears, body.height, body.boss),
        layer(spline, body.boss, body.boss + 3.0),
    ];
    builder.add_body(format!("servo {name}"), Kind::Servo, Mount::Chassis, prisms);
    builder.allow_contact(&[format!("horn {name}")]);
    for (number, at) in flange_holes(builder, servo).into_iter().enumerate() {
        let head = Prism::solid([Shape::disc(at, 2.2)], [bottom + over, bottom + over + 1.6]);
        let screw = format!("servo screw {name} {}", number + 1);
        builder.add_body(screw, Kind::ServoScrew, Mount::Chassis, [head]);
    }
}

fn add_battery(builder: &mut Builder) {
    let [x, y, z] = builder.parts.battery;
    let block = Shape::rectangle(Vector::default(), at(x, y), 0.0);
    let block = Prism::solid([block], [0.0, z]);
    builder.add_body("battery", Kind::Battery, Mount::Chassis, [block]);
}

fn add_deck(builder: &mut Builder) {
    let (stack, parts) = (builder.stack, builder.parts);
    let [x, y] = STANDOFFS;
    let bar = |a: (f64, f64), b: (f64, f64)| Shape::bar(at(a.0, a.1), at(b.0, b.1), 5.0);
    let mut add = vec![
        Shape::rectangle(Vector::default(), at(2.0 * x + 10.5, 2.0 * y + 14.0), 5.0),
        bar(UNO_HOLES[0], UNO_HOLES[1]),
        bar(UNO_HOLES[2], UNO_HOLES[3]),
    ];
    let [wings, open] = fittings::wings(UNO_HOLES);
    add.extend(wings);
    let screws = standoffs().map(|at| builder.hole(at));
    let threads = UNO_HOLES.map(|(x, y)| builder.thread(at(x, y)));
    // The window saves weight, and cable ties for the parts below the deck pass through it.
    let window = Shape::rectangle(at(0.0, 4.0), at(12.0, 36.0), 3.0);
    let holes = [&screws[..], &threads, &leads::holes(), &[window], &open].concat();
    let bosses = UNO_HOLES.map(|(x, y)| Shape::disc(at(x, y), 4.0));
    let prisms = [
        Prism::new(add, holes, stack.deck),
        Prism::new(bosses, threads, stack.boss),
    ];
    builder.add_printed("deck", Mount::Chassis, prisms);
    for (number, place) in (1..).zip(standoffs()) {
        let length = stack.deck[0];
        let (post, thread) = (Shape::disc(place, STANDOFF_RADIUS), builder.thread(place));
        let post = Prism::new([post], [thread], [0.0, length]);
        let name = format!("standoff {number}");
        builder.add_body(&name, Kind::Standoff(length), Mount::Chassis, [post]);
        for (end, head, points) in [
            ("below", stack.plate[0], Direction::Up),
            ("above", stack.deck[1], Direction::Down),
        ] {
            let name = format!("{name} {end}");
            let bolt = Bolt::new(&name, Mount::Chassis, place, head, points);
            builder.add_screw(&bolt, parts.plate + 4.0);
        }
    }
}

fn add_board(builder: &mut Builder) {
    let low = builder.stack.boss[1];
    let [x, y, z] = UNO;
    let top = low + UNO_BOARD_THICKNESS;
    let block = |x: f64, y: f64| [Shape::rectangle(Vector::default(), at(x, y), 0.0)];
    let holes = UNO_HOLES.map(|(x, y)| Shape::disc(at(x, y), 1.6));
    let heads = UNO_HOLES.map(|(x, y)| builder.sink(at(x, y)));
    let board = Prism::new(block(x, y), holes, [low, top]);
    let parts = Prism::new(block(x - 4.0, y - 4.0), heads, [top, low + z]);
    builder.add_body("board", Kind::Board, Mount::Chassis, [board, parts]);
    for (number, (x, y)) in UNO_HOLES.into_iter().enumerate() {
        if number != UNO_TIGHT_HOLE {
            let name = format!("board {}", number + 1);
            let bolt = Bolt::new(&name, Mount::Chassis, at(x, y), top, Direction::Down);
            builder.add_screw(&bolt, 10.0);
        }
    }
}
