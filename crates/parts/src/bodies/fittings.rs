//! Bodies of the fittings: power supply, terminal strips, plugs and strap.
//!
//! Each fitting is a body, so that the proof of fit and the mass include it. Since no part of the robot moves above the
//! deck, the deck has two wings beside the board for the fittings that must be reached by hand: on the right the parts
//! of the battery's positive line; on the left, beside the board's pins, the signals.

use lizard_kinematics::Vector;

use crate::bodies::builder::AssemblyBuilder;
use crate::bodies::layout::{STANDOFF_DISTANCES, STANDOFF_RADIUS, UNO_BOARD_THICKNESS, UNO_SIZE};
use crate::layers::body::{Kind, Mount, Prism};
use crate::layers::fitting::{Fitting, FittingSpec, STRAP_SECTION, STRIP_PITCH};
use crate::layers::shape::{Shape, vector};

/// Size of a slot for the battery's strap, mm: along the plate and across.
const STRAP_SLOT: [f64; 2] = [17.0, 2.4];
/// Size of a slot for a cable tie, mm: along the plate and across.
const TIE_SLOT: [f64; 2] = [4.0, 2.0];
/// Smallest distance from the plate's middle to the terminal strips' middles, mm.
const MIN_STRIP_X: f64 = 13.2;
/// Distance from the plate's middle to the cable ties, which pass beside the battery's ends, mm.
const TIE_DISTANCE: f64 = 31.5;
/// Thickness of a cable tie, mm.
const TIE_THICKNESS: f64 = 1.6;

/// Distances from the deck's middle to a wing's inner and outer edge, mm.
const WING_EDGES: [f64; 2] = [25.2, 51.2];
/// Half of a wing's length, mm. A longer wing would cover nuts of the sliders.
const WING_HALF_LENGTH: f64 = 40.0;
/// Openings of a wing, mm: for each, the limits in x, away from the middle, and the limits in y. The openings save
/// weight; the material between them is the arm that carries the wing.
const WING_OPENINGS: [[[f64; 2]; 2]; 2] = [
    [[32.5, 43.0], [-36.5, -26.0]],
    [[32.5, 43.0], [-12.0, 26.0]],
];
/// Distance from the middle to the inner edge of a wing's fittings, mm.
const WING_FITTING_X: f64 = 29.5;
/// Distances from the middle to a wing's cable ties, mm: on the inner and on the outer side of the fittings.
const WING_TIE_X: [f64; 2] = [28.0, 48.4];
/// Height of the barrel jack's middle above the board, mm.
const JACK_HEIGHT: f64 = 6.5;
/// Length of the barrel jack beyond the board's edge, mm.
const JACK_OVERHANG: f64 = 2.0;
/// Position of the barrel jack's middle, mm to the right of the board's middle.
const JACK_X: f64 = 19.05;

/// Makes a slot with its middle at `x`, `y`, mm.
fn make_slot(x: f64, y: f64, [slot_length, slot_width]: [f64; 2]) -> Shape {
    Shape::rectangle(vector(x, y), vector(slot_width, slot_length), 0.5)
}

/// Makes the plate's slots: for the battery's strap if the plate is wide enough, and for the terminal strips' ties.
pub fn make_plate_slots(builder: &AssemblyBuilder) -> Vec<Shape> {
    let mut slots = Vec::new();
    if let Some(x) = strap_slot_x(builder) {
        slots.extend([-x, x].map(|x| make_slot(x, 0.0, STRAP_SLOT)));
    }
    let strip_distance = strip_x(builder);
    for middle in [-strip_distance, strip_distance] {
        for x in [middle - 4.5, middle + 4.5] {
            slots.extend([-TIE_DISTANCE, TIE_DISTANCE].map(|y| make_slot(x, y, TIE_SLOT)));
        }
    }
    slots
}

/// Distance from the plate's middle to the terminal strips' middles, mm. The servos' leads pass between the strips,
/// along the inner sides of the servos' cases.
fn strip_x(builder: &AssemblyBuilder) -> f64 {
    let plate = builder.layout.plate;
    let cases = plate.case_centres.iter().map(|case| case.x.abs());
    let lead_edge = cases.fold(0.0, f64::max) - plate.case_size.x / 2.0;
    MIN_STRIP_X.max(lead_edge + 0.3 + fitting_size(Fitting::GroundStrip, 0) / 2.0)
}

/// Makes the filled shapes of the deck's wings and of the arms from the wings to the board's holes; then the openings
/// and slots in the wings.
pub fn make_wing_shapes(board_holes: [Vector; 4]) -> [Vec<Shape>; 2] {
    let [inner, outer] = WING_EDGES;
    let middle = (inner + outer) / 2.0;
    let mut filled = Vec::new();
    let mut cut = Vec::new();
    for side in [-1.0, 1.0] {
        let size = vector(outer - inner, 2.0 * WING_HALF_LENGTH);
        filled.push(Shape::rectangle(vector(side * middle, 0.0), size, 4.0));
        for [x, y] in WING_OPENINGS {
            let size = vector(x[1] - x[0], y[1] - y[0]);
            let opening_middle = vector(side * (x[0] + x[1]) / 2.0, (y[0] + y[1]) / 2.0);
            cut.push(Shape::rectangle(opening_middle, size, 2.0));
        }
    }
    for hole in board_holes {
        let wing_point = vector(middle.copysign(hole.x), hole.y);
        filled.push(Shape::bar(hole, wing_point, 5.0));
    }
    // The signal strip's ties are behind the resistors, whose wires lie beside the strip's middle.
    for x in WING_TIE_X {
        cut.push(make_slot(-x, signal_strip_y() - 11.0, TIE_SLOT));
    }
    let fuse_edge = WING_FITTING_X + fitting_size(Fitting::Fuse, 0);
    cut.extend([WING_TIE_X[0], fuse_edge + 2.4].map(|x| make_slot(x, fuse_y(), TIE_SLOT)));
    let [tie_length, tie_width] = TIE_SLOT;
    cut.push(make_slot(38.5, switch_tie_y(), [tie_width, tie_length]));
    [filled, cut]
}

/// Size of a fitting along an axis, mm: 0 to the right, 1 forward, 2 up.
fn fitting_size(fitting: Fitting, axis: usize) -> f64 {
    fitting.spec().size[axis]
}

/// Position of the signal strip's middle, mm forward of the plate's middle. The strip begins at the wing's rear end.
fn signal_strip_y() -> f64 {
    0.5 - WING_HALF_LENGTH + fitting_size(Fitting::SignalStrip, 1) / 2.0
}

/// Position of the fuse's middle, mm forward of the plate's middle. The fuse is at the wing's front end.
fn fuse_y() -> f64 {
    WING_HALF_LENGTH - 0.5 - fitting_size(Fitting::Fuse, 1) / 2.0
}

/// Position of the switch's middle, mm forward of the plate's middle. The switch is at the wing's rear end, and its
/// cable tie goes around this end.
fn switch_y() -> f64 {
    0.3 - WING_HALF_LENGTH + fitting_size(Fitting::Switch, 1) / 2.0
}

/// Position of the slot for the cable tie in front of the switch, mm forward of the plate's middle.
fn switch_tie_y() -> f64 {
    switch_y() + fitting_size(Fitting::Switch, 1) / 2.0 + 1.2
}

/// Distance from the plate's middle to the strap's slots, mm; `None` if the plate is too narrow for slots beside the
/// battery, so that the strap goes around battery and plate.
fn strap_slot_x(builder: &AssemblyBuilder) -> Option<f64> {
    let [battery_width, _, _] = builder.parts.battery;
    let x = (battery_width + STRAP_SECTION[1]) / 2.0;
    let min_half_width = x + STRAP_SLOT[1] / 2.0 + builder.parts.wall;
    (builder.layout.plate.half_size.x >= min_half_width).then_some(x)
}

/// Adds all fittings.
pub fn add(builder: &mut AssemblyBuilder) {
    add_under_deck_and_plate(builder);
    add_on_deck(builder);
    add_plugs(builder);
    add_strap(builder);
}

/// Adds a fitting as a block of its own size with its lower face at the height `low`, mm.
fn add_block(builder: &mut AssemblyBuilder, fitting: Fitting, middle: Vector, low: f64) {
    let FittingSpec { name, size, .. } = fitting.spec();
    add_sized_block(builder, fitting, name, middle, low, size);
}

/// Adds a fitting as a block of a given width, length and height, mm.
fn add_sized_block(
    builder: &mut AssemblyBuilder,
    fitting: Fitting,
    name: &str,
    middle: Vector,
    low: f64,
    [width, length, height]: [f64; 3],
) {
    let shape = Shape::rectangle(middle, vector(width, length), 0.0);
    let prism = Prism::solid([shape], [low, low + height]);
    builder.add_body(name, Kind::Fitting(fitting), Mount::Chassis, [prism]);
}

/// Adds the fittings under the deck and under the plate.
fn add_under_deck_and_plate(builder: &mut AssemblyBuilder) {
    let stack = builder.stack;
    // The fittings hang below the strap and the heads of the standoffs' screws.
    let lower_ceiling =
        stack.plate[0] - STRAP_SECTION[1].max(builder.parts.screw.head_height) - 0.3;
    let deck_bottom = stack.deck[0];
    let half_free_length = STANDOFF_DISTANCES[1] - 3.4;
    let half_length = |fitting: Fitting| fitting_size(fitting, 1) / 2.0;
    let alarm_y = half_length(Fitting::Alarm) - half_free_length;
    let converter_y = half_free_length - half_length(Fitting::Converter);
    // The supply strip's front end and the capacitor's rear end are level with the ground strip's ends.
    let strip_reach = half_length(Fitting::GroundStrip);
    let supply_y = strip_reach - half_length(Fitting::SupplyStrip);
    let capacitor_y = half_length(Fitting::Capacitor) - strip_reach;
    let right_x = strip_x(builder);
    for (fitting, x, y, ceiling) in [
        (Fitting::Alarm, 0.0, alarm_y, deck_bottom),
        (Fitting::Converter, 0.0, converter_y, deck_bottom),
        (Fitting::GroundStrip, -right_x, 0.0, lower_ceiling),
        (Fitting::SupplyStrip, right_x, supply_y, lower_ceiling),
        (Fitting::Capacitor, right_x, capacitor_y, lower_ceiling),
    ] {
        let low = ceiling - fitting_size(fitting, 2);
        add_block(builder, fitting, vector(x, y), low);
    }
}

/// Adds the fittings on the deck's wings.
fn add_on_deck(builder: &mut AssemblyBuilder) {
    let top = builder.stack.deck[1];
    let half_width = |fitting: Fitting| fitting_size(fitting, 0) / 2.0;
    let radio_y = WING_HALF_LENGTH - 0.5 - fitting_size(Fitting::RadioSpace, 1) / 2.0;
    let plus_y = fuse_y()
        - (fitting_size(Fitting::Fuse, 1) + fitting_size(Fitting::PlusTerminal, 1)) / 2.0
        - 0.3;
    for (fitting, side, y) in [
        (Fitting::SignalStrip, -1.0, signal_strip_y()),
        (Fitting::RadioSpace, -1.0, radio_y),
        (Fitting::Fuse, 1.0, fuse_y()),
        (Fitting::Switch, 1.0, switch_y()),
        (Fitting::PlusTerminal, 1.0, plus_y),
    ] {
        let x = side * (WING_FITTING_X + half_width(fitting));
        add_block(builder, fitting, vector(x, y), top);
    }
    // Each resistor leads from a signal terminal to the middle terminal: two resistors span one pitch, two span two.
    let resistor_x = -WING_FITTING_X
        - fitting_size(Fitting::SignalStrip, 0)
        - 0.4
        - half_width(Fitting::Resistor);
    let row_pitch = fitting_size(Fitting::Resistor, 0) + 0.4;
    let rows_and_pitches = [(1.0, -1.0), (0.0, -0.5), (0.0, 0.5), (1.0, 1.0)];
    for (number, (row, pitches)) in (1..).zip(rows_and_pitches) {
        let y = signal_strip_y() + pitches * STRIP_PITCH;
        let middle = vector(resistor_x - row * row_pitch, y);
        let (size, name) = (Fitting::Resistor.spec().size, format!("resistor {number}"));
        add_sized_block(builder, Fitting::Resistor, &name, middle, top + 4.0, size);
    }
}

/// Adds the plug in the board's barrel jack, and the battery's plug in front of the battery, or on top of it if a long
/// battery leaves no room in front.
fn add_plugs(builder: &mut AssemblyBuilder) {
    let [_, battery_length, battery_height] = builder.parts.battery;
    let fitting = Fitting::BatteryPlug;
    let FittingSpec { name, size, .. } = fitting.spec();
    let [width, thickness, height] = size;
    let battery_end = battery_length / 2.0 + 0.3;
    let (y, low, size) = if battery_end + thickness <= STANDOFF_DISTANCES[1] - STANDOFF_RADIUS {
        let y = battery_end + thickness / 2.0;
        (y, TIE_THICKNESS, size)
    } else {
        let y = STRAP_SECTION[0] / 2.0 + 1.0 + height / 2.0;
        (y, battery_height + 0.2, [width, height, thickness])
    };
    add_sized_block(builder, fitting, name, vector(0.0, y), low, size);
    let [_, plug_length, plug_height] = Fitting::BarrelPlug.spec().size;
    let y = -(UNO_SIZE[1] + plug_length) / 2.0 - JACK_OVERHANG - 0.1;
    let low = builder.stack.board_boss[1] + UNO_BOARD_THICKNESS + JACK_HEIGHT - plug_height / 2.0;
    add_block(builder, Fitting::BarrelPlug, vector(JACK_X, y), low);
}

/// Adds the strap around battery and plate.
fn add_strap(builder: &mut AssemblyBuilder) {
    let stack = builder.stack;
    let [battery_x, battery_y, battery_z] = builder.parts.battery;
    let [width, thickness] = STRAP_SECTION;
    let width = width.min(battery_y);
    let bar_between = |from: f64, to: f64| {
        let middle = vector((from + to) / 2.0, 0.0);
        Shape::rectangle(middle, vector(to - from, width), 0.0)
    };
    let half_battery_x = battery_x / 2.0;
    let half_width = match strap_slot_x(builder) {
        Some(_) => half_battery_x,
        None => half_battery_x.max(builder.layout.plate.half_size.x),
    };
    let outer = half_width + thickness;
    let [left, right] = [(-outer, -half_width), (half_width, outer)];
    let sides = [left, right].map(|(from, to)| bar_between(from, to));
    let full_bar = bar_between(-outer, outer);
    let [strap_bottom, battery_top] = [stack.plate[0], battery_z];
    let prisms = [
        Prism::solid([full_bar.clone()], [strap_bottom - thickness, strap_bottom]),
        Prism::solid(sides, [strap_bottom, battery_top]),
        Prism::solid([full_bar], [battery_top, battery_top + thickness]),
    ];
    let (name, kind) = (Fitting::Strap.spec().name, Kind::Fitting(Fitting::Strap));
    builder.add_body(name, kind, Mount::Chassis, prisms);
}
