//! The bodies that do not move: plate, servos, battery, deck and board.

use lizard_kinematics::{End, Vector};
use lizard_robot::servo::SERVO_NAMES;

use crate::bodies::builder::ScrewDirection::{Down, Up};
use crate::bodies::builder::{AssemblyBuilder, Screw};
use crate::bodies::fittings;
use crate::bodies::layout::{STANDOFF_DISTANCES, STANDOFF_RADIUS, UNO_BOARD_THICKNESS, UNO_SIZE};
use crate::bodies::leads;
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::mark;
use crate::layers::shape::{Shape, vector};

/// Radius of a servo's spline, mm.
pub const SPLINE_RADIUS: f64 = 2.4;
/// Radius of the hole in which a servo's own screw cuts its thread, mm. One of a servo's two holes is only 0.35 mm from
/// the lead's notch, so there the thread grips only on the other three sides.
const PILOT_RADIUS: f64 = 0.75;

/// Distance of a servo's engraved number from the seat, and outward from the servo's middle, mm.
const NUMBER_DISTANCE: f64 = 4.0;

/// Holes of a UNO relative to its middle, with the USB socket at the back, mm: (550, 100), (600, 2000), (2600, 300) and
/// (2600, 1400) mil from a corner.
const UNO_HOLES: [Vector; 4] = [
    Vector::new(24.13, -20.32),
    Vector::new(-24.13, -19.05),
    Vector::new(19.05, 31.75),
    Vector::new(-8.89, 31.75),
];
/// Index in [`UNO_HOLES`] of the hole beside the pin AREF, whose header leaves no room for a screw's head.
const UNO_SCREWLESS_HOLE: usize = 1;

/// Adds the bodies that do not move.
pub fn add(builder: &mut AssemblyBuilder) {
    add_plate(builder);
    for servo in 0..4 {
        add_servo(builder, servo);
    }
    leads::add(builder);
    add_battery(builder);
    fittings::add(builder);
    add_deck(builder);
    add_board(builder);
}

/// Makes the outline of a servo's case from above, wider by `margin` (mm) on each side.
fn case_outline(builder: &AssemblyBuilder, servo: usize, margin: f64) -> Shape {
    let body = &builder.parts.servo;
    let size = vector(body.width + 2.0 * margin, body.length + 2.0 * margin);
    Shape::rectangle(case_middle(builder, servo), size, 0.0)
}

/// Middle of a servo's case from above, chassis frame, mm.
fn case_middle(builder: &AssemblyBuilder, servo: usize) -> Vector {
    builder.layout.plate.case_centres[servo]
}

/// Direction from the shaft's end of a servo's case to the other end.
fn inward_direction(servo: usize) -> Vector {
    vector(0.0, -End::from_servo(servo).sign())
}

/// Positions of the two screws that hold a servo's flange.
fn flange_hole_positions(builder: &AssemblyBuilder, servo: usize) -> [Vector; 2] {
    let offset = inward_direction(servo) * (builder.parts.servo.holes / 2.0);
    let middle = case_middle(builder, servo);
    [middle - offset, middle + offset]
}

/// Makes the outline of a servo's seat, wider by `margin` (mm) on each side.
fn seat_outline(builder: &AssemblyBuilder, servo: usize, margin: f64) -> Shape {
    let body = &builder.parts.servo;
    let border = builder.parts.fit + builder.parts.wall + margin;
    let size = vector(body.width + 2.0 * border, body.flange + 2.0 + 2.0 * margin);
    Shape::rectangle(case_middle(builder, servo), size, 1.0)
}

/// Makes the cut-outs for a servo in the plate and in its seat: for case and lead, and the holes for the screws.
fn make_servo_cutouts(builder: &AssemblyBuilder, servo: usize) -> [[Shape; 2]; 2] {
    let (parts, outward) = (builder.parts, End::from_servo(servo).sign());
    let middle = case_middle(builder, servo);
    let notch = leads::make_lead_notch(&parts.servo, middle, parts.fit, outward);
    let openings = [case_outline(builder, servo, parts.fit), notch];
    let hole_positions = flange_hole_positions(builder, servo);
    let holes = hole_positions.map(|position| Shape::disc(position, PILOT_RADIUS));
    [openings, holes]
}

fn standoff_positions() -> [Vector; 4] {
    let [x, y] = STANDOFF_DISTANCES;
    [vector(-x, y), vector(x, y), vector(x, -y), vector(-x, -y)]
}

fn add_plate(builder: &mut AssemblyBuilder) {
    let (stack, layout) = (builder.stack, builder.layout);
    let plate = layout.plate;
    let seats = [0, 1, 2, 3].map(|servo| seat_outline(builder, servo, 0.0));
    // First all openings, then all holes, which is the order of the shapes in the exported files.
    let servo_cutouts = [0, 1, 2, 3].map(|servo| make_servo_cutouts(builder, servo));
    let openings = servo_cutouts.iter().flat_map(|[openings, _]| openings);
    let screw_holes = servo_cutouts.iter().flat_map(|[_, holes]| holes);
    let all_cutouts: Vec<_> = openings.chain(screw_holes).cloned().collect();
    let size = plate.half_size * 2.0;
    let base = Shape::rectangle(Vector::default(), size, plate.corner_radius);
    let mut filled = vec![base];
    let mut through_holes = all_cutouts.clone();
    // The half widths of bars that start at the same point differ by 0.01 mm, so that no two bar ends coincide.
    for (leg, [pivot_arm, driven_arm, idle_arm]) in layout.legs.iter().zip(plate.arms) {
        let build_bar = |[from, to]: [Vector; 2], half_width: f64| Shape::bar(from, to, half_width);
        filled.push(build_bar(pivot_arm, plate.arm_half_width));
        for (pivot, arm) in [
            (leg.crank_pivot, driven_arm),
            (leg.follower_pivot, idle_arm),
        ] {
            filled.push(build_bar(arm, plate.arm_half_width - 0.01));
            through_holes.push(builder.clearance_hole(pivot));
        }
    }
    through_holes.extend(standoff_positions().map(|position| builder.clearance_hole(position)));
    through_holes.extend(leads::make_wire_holes());
    through_holes.extend(fittings::make_plate_slots(builder));
    let [low, high] = stack.plate;
    let mark_bottom = high - mark::MARK_DEPTH;
    let engraved_cuts = [&through_holes[..], &make_number_strokes(builder)].concat();
    let prisms = [
        Prism::new(filled.clone(), through_holes, [low, mark_bottom]),
        Prism::new(filled, engraved_cuts, [mark_bottom, high]),
        Prism::new(seats, all_cutouts, stack.seat),
    ];
    builder.add_body("plate", Kind::Printed, Mount::Chassis, prisms);
}

/// Makes the layers of a trial print: the corner of the plate with one servo and the pivots of its leg.
pub fn make_corner_prisms(builder: &AssemblyBuilder, servo: usize) -> Vec<Prism> {
    /// Margin of the plate around the seat, mm.
    const SEAT_MARGIN: f64 = 2.0;
    let (parts, stack, plate) = (builder.parts, builder.stack, builder.layout.plate);
    let leg = &builder.layout.legs[servo];
    let middle = case_middle(builder, servo);
    let mut filled = vec![seat_outline(builder, servo, SEAT_MARGIN)];
    let [pivot_arm, driven_arm, idle_arm] = plate.arms[servo];
    // As in the plate, the half widths of bars that start at the same point differ by 0.01 mm.
    filled.push(Shape::bar(pivot_arm[0], pivot_arm[1], plate.arm_half_width));
    for [from, to] in [driven_arm, idle_arm] {
        filled.push(Shape::bar(from, to, plate.arm_half_width - 0.01));
        filled.push(Shape::bar(to, middle, plate.arm_half_width - 0.02));
    }
    let servo_cutouts = make_servo_cutouts(builder, servo).concat();
    let pivots =
        [leg.crank_pivot, leg.follower_pivot].map(|position| builder.clearance_hole(position));
    let plate_cutouts = [&servo_cutouts[..], &pivots].concat();
    let seat = seat_outline(builder, servo, 0.0);
    let raised_z = stack.seat.map(|z| z + parts.plate);
    vec![
        Prism::new(filled, plate_cutouts, [0.0, parts.plate]),
        Prism::new([seat], servo_cutouts, raised_z),
    ]
}

/// Makes the strokes of the servos' numbers, engraved beside the seats to distinguish head and tail.
fn make_number_strokes(builder: &AssemblyBuilder) -> Vec<Shape> {
    let body = &builder.parts.servo;
    let strokes = (0..4).flat_map(|servo| {
        let [width, height] = mark::mark_size("1");
        let middle = case_middle(builder, servo);
        // On the inner side of the seat, away from the hole for the leads.
        let outward_shift = middle.x.signum() * NUMBER_DISTANCE;
        let inward_shift = inward_direction(servo) * (body.flange / 2.0 + 1.0 + NUMBER_DISTANCE);
        let corner = middle + inward_shift + vector(outward_shift - width / 2.0, -height / 2.0);
        mark::draw_strokes(&(servo + 1).to_string(), corner)
    });
    strokes.collect()
}

fn add_servo(builder: &mut AssemblyBuilder, servo: usize) {
    let name = SERVO_NAMES[servo];
    let body = builder.parts.servo;
    let bottom = builder.stack.servo_bottom;
    let shaft = builder.layout.shafts[servo];
    let solid_layer = |filled: Vec<Shape>, low: f64, high: f64| {
        Prism::solid(filled, [bottom + low, bottom + high])
    };
    let case = case_outline(builder, servo, 0.0);
    let flange_size = vector(body.width, body.flange);
    let flange = Shape::rectangle(case_middle(builder, servo), flange_size, 0.0);
    let gears = vec![
        Shape::disc(shaft, body.width / 2.0 - 0.05),
        Shape::bar(shaft, shaft + inward_direction(servo) * body.shaft, 3.0),
    ];
    let flange_top = body.flange_height + body.flange_thickness;
    let spline = vec![Shape::disc(shaft, SPLINE_RADIUS)];
    let prisms = [
        solid_layer(vec![case.clone()], 0.0, body.flange_height),
        solid_layer(vec![flange], body.flange_height, flange_top),
        solid_layer(vec![case], flange_top, body.height),
        solid_layer(gears, body.height, body.boss),
        solid_layer(spline, body.boss, body.boss + 3.0),
    ];
    let servo_body = builder.add_body(format!("servo {name}"), Kind::Servo, Mount::Chassis, prisms);
    servo_body.allowed_contacts = vec![format!("horn {name}")];
    for (number, position) in (1..).zip(flange_hole_positions(builder, servo)) {
        let z = [bottom + flange_top, bottom + flange_top + 1.6];
        let head = Prism::solid([Shape::disc(position, 2.2)], z);
        let screw = format!("servo screw {name} {number}");
        builder.add_body(screw, Kind::ServoScrew, Mount::Chassis, [head]);
    }
}

fn add_battery(builder: &mut AssemblyBuilder) {
    let [x, y, z] = builder.parts.battery;
    let block = Shape::rectangle(Vector::default(), vector(x, y), 0.0);
    let block = Prism::solid([block], [0.0, z]);
    builder.add_body("battery", Kind::Battery, Mount::Chassis, [block]);
}

fn add_deck(builder: &mut AssemblyBuilder) {
    let (stack, parts) = (builder.stack, builder.parts);
    let [x, y] = STANDOFF_DISTANCES;
    let size = vector(2.0 * x + 10.5, 2.0 * y + 14.0);
    let mut filled = vec![
        Shape::rectangle(Vector::default(), size, 5.0),
        Shape::bar(UNO_HOLES[0], UNO_HOLES[1], 5.0),
        Shape::bar(UNO_HOLES[2], UNO_HOLES[3], 5.0),
    ];
    let [wings, openings] = fittings::make_wing_shapes(UNO_HOLES);
    filled.extend(wings);
    let screws = standoff_positions().map(|position| builder.clearance_hole(position));
    let pilot_holes = UNO_HOLES.map(|position| builder.pilot_hole(position));
    // The window saves weight; the cable ties of the fittings under the deck pass through it.
    let window = Shape::rectangle(vector(0.0, 4.0), vector(12.0, 36.0), 3.0);
    let wire_holes = leads::make_wire_holes();
    let holes = [&screws[..], &pilot_holes, &wire_holes, &[window], &openings].concat();
    let bosses = UNO_HOLES.map(|position| Shape::disc(position, 4.0));
    let prisms = [
        Prism::new(filled, holes, stack.deck),
        Prism::new(bosses, pilot_holes, stack.board_boss),
    ];
    builder.add_body("deck", Kind::Printed, Mount::Chassis, prisms);
    for (number, position) in (1..).zip(standoff_positions()) {
        let length = stack.deck[0];
        let post = Shape::disc(position, STANDOFF_RADIUS);
        let post = Prism::new([post], [builder.pilot_hole(position)], [0.0, length]);
        let name = format!("standoff {number}");
        builder.add_body(&name, Kind::Standoff(length), Mount::Chassis, [post]);
        for (end, seat_z, direction) in [
            ("below", stack.plate[0], Up),
            ("above", stack.deck[1], Down),
        ] {
            let name = format!("{name} {end}");
            let screw = Screw::new(name, Mount::Chassis, position, seat_z, direction);
            builder.add_screw(&screw, parts.plate + 4.0);
        }
    }
}

fn add_board(builder: &mut AssemblyBuilder) {
    let low = builder.stack.board_boss[1];
    let [x, y, z] = UNO_SIZE;
    let top = low + UNO_BOARD_THICKNESS;
    let build_block = |x: f64, y: f64| [Shape::rectangle(Vector::default(), vector(x, y), 0.0)];
    let holes = UNO_HOLES.map(|position| Shape::disc(position, 1.6));
    let heads = UNO_HOLES.map(|position| builder.counterbore(position));
    let board = Prism::new(build_block(x, y), holes, [low, top]);
    let components = Prism::new(build_block(x - 4.0, y - 4.0), heads, [top, low + z]);
    builder.add_body("board", Kind::Board, Mount::Chassis, [board, components]);
    for (index, position) in UNO_HOLES.into_iter().enumerate() {
        if index != UNO_SCREWLESS_HOLE {
            let name = format!("board {}", index + 1);
            let screw = Screw::new(name, Mount::Chassis, position, top, Down);
            builder.add_screw(&screw, 10.0);
        }
    }
}
