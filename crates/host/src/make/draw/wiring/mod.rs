//! `lizard draw --wiring`: draws every wire from the battery's cells to the servos and the board.
//!
//! The picture follows the current from top to bottom: first the supply, then the servos between the +5 V strip on the
//! left and the ground strip on the right, then the signal strip, and the board last. All positions are in pixels.

mod inputs;
mod radio;
mod strips;
mod supply;
mod wire;

use std::ops::RangeInclusive;

use lizard_robot::servo::SERVO_NAMES;
use lizard_robot::{FUSE_RATING_A, MIN_SWITCH_RATING_A, Robot};
use svg::node::element::Group;

use super::route::{WIRE_SPACING, route_between_rows, turn_point};
use super::uno::Uno;
use crate::shared::shapes::{
    BROWN, DARK, GREY, ORANGE, RED, SERVO_COLOURS, SERVO_POSITIONS, add_outline, circle, cross,
    line, pin_name, rectangle, render_svg, text_middle, text_start,
};
use wire::{BLACK_WIRE, THICK_WIRE_WIDTH, THIN_WIRE_WIDTH, Wire, draw_terminal};

const PAGE_WIDTH: f64 = 700.0;
/// Horizontal position of the middle of the leftmost servo.
const FIRST_SERVO_X: f64 = 170.0;
/// Distance between the middles of neighbouring servos.
const SERVO_SPACING: f64 = 118.0;
/// Vertical position of the upper edges of the servos.
const SERVO_TOP_Y: f64 = 420.0;
/// Width and height of a servo on the page.
const SERVO_SIZE: (f64, f64) = (50.0, 92.0);
/// Distance of a servo's supply wires from the servo's middle.
const LEAD_OFFSET: f64 = 14.0;
/// Vertical positions of the signal wires' uppermost horizontal segments, above and below the signal strip.
const SIGNAL_WIRES_Y: [f64; 2] = [530.0, 694.0];
/// Vertical positions of the ground wires' horizontal segments to the signal strip and to the board, below the signal
/// wires.
const GROUND_WIRES_Y: [f64; 2] = [582.0, 748.0];
/// Horizontal position of the wire from the ground strip down to the signal strip.
const GROUND_WIRE_X: f64 = 622.0;
const UNO: Uno = Uno {
    upper_left_corner: (120.0, 776.0),
};
/// The barrel jack's centre relative to the board's upper left corner.
const BARREL_JACK_OFFSET: (f64, f64) = (-11.0, 252.0);
/// Distance between neighbouring lines of remarks.
const LINE_HEIGHT: f64 = 19.0;

/// Draws a robot's wiring, as SVG text.
pub fn draw_wiring(robot: &Robot) -> String {
    let pins = robot.servos().map(|servo| servo.pin);
    let order = sort_servos(pins);
    let analogue_count = pins.into_iter().filter(|pin| is_analogue(*pin)).count();
    let mut used_pins = pins.to_vec();
    used_pins.extend(robot.firmware().rail_pin());
    used_pins.extend(robot.inputs().named_pins().map(|(_, pin)| pin));
    let remarks_y = UNO.lower_right_corner().1 + WIRE_SPACING * analogue_count as f64 + 50.0;
    let (x, y) = UNO.upper_left_corner;
    let barrel_jack = (x + BARREL_JACK_OFFSET.0, y + BARREL_JACK_OFFSET.1);
    let names = order.map(|servo| SERVO_NAMES[servo]);
    let mut wires = supply::route_wires(barrel_jack);
    wires.extend(strips::route_links());
    wires.extend(strips::route_resistor_leads(names));
    wires.extend(route_servo_and_board_wires(order, pins));
    let drawn_wires = wires.iter().map(Wire::draw);
    let mut group = drawn_wires
        .fold(Group::new(), Group::add)
        .add(supply::draw(barrel_jack))
        .add(strips::draw())
        .add(strips::draw_resistor_bodies())
        .add(UNO.draw(&used_pins));
    for (index, servo) in order.into_iter().enumerate() {
        group = group.add(draw_servo(servo, index, pins[servo]));
    }
    let remarks = list_remarks(robot);
    let radio_y = remarks_y + LINE_HEIGHT * remarks.len() as f64 + 6.0;
    for (index, remark) in remarks.iter().enumerate() {
        let y = remarks_y + LINE_HEIGHT * index as f64;
        group = group.add(text_start(remark, (16.0, y), 14.0));
    }
    let inputs_y = radio_y + radio::PANEL_HEIGHT;
    group = group.add(draw_board_notes()).add(radio::draw(radio_y));
    if inputs::panel_height(robot) > 0.0 {
        group = group.add(inputs::draw(robot, inputs_y));
    }
    render_svg((PAGE_WIDTH, inputs_y + inputs::panel_height(robot)), group)
}

/// True for the pins from A0 on, whose numbers are 14 and more.
fn is_analogue(pin: u8) -> bool {
    pin >= 14
}

/// Returns the servos from left to right, in the order of their pins around the UNO from its upper left, so that no two
/// signals cross.
fn sort_servos(pins: [u8; 4]) -> [usize; 4] {
    let mut order = [0, 1, 2, 3];
    order.sort_by_key(|servo| {
        let pin = pins[*servo];
        (is_analogue(pin), std::cmp::Reverse(pin))
    });
    order
}

/// Returns the horizontal position of a servo's middle; `index` counts the servos from left to right.
fn servo_x(index: usize) -> f64 {
    FIRST_SERVO_X + SERVO_SPACING * index as f64
}

/// Routes the wires of the servos, and of the signal strip to the board. `order` lists the servos from left to right.
fn route_servo_and_board_wires(order: [usize; 4], pins: [u8; 4]) -> Vec<Wire> {
    let mut wires = Vec::new();
    for (index, servo) in order.into_iter().enumerate() {
        let x = servo_x(index);
        let name = SERVO_NAMES[servo];
        let ground_hole = strips::ground_hole(supply::FIRST_SERVO_WAY + index);
        // The first ways of the strip belong to the converter and the capacitor.
        let supply_hole = strips::supply_hole(strips::SUPPLY_WAY_COUNT - 1 - index);
        for (kind, x, hole, colour) in [
            ("ground", x + LEAD_OFFSET, ground_hole, BROWN),
            ("plus", x - LEAD_OFFSET, supply_hole, RED),
        ] {
            let path = vec![(x, SERVO_TOP_Y), (x, hole.1), hole];
            let name = format!("{kind}-{name}");
            wires.push(Wire::new(name, path, colour, THIN_WIRE_WIDTH));
        }
    }
    let indices: [usize; 4] = [0, 1, 2, 3];
    let servo_points = indices.map(|index| (servo_x(index), SERVO_TOP_Y + SERVO_SIZE.1));
    let strip_holes = indices.map(strips::servo_hole);
    let paths = route_between_rows(&servo_points, &strip_holes, SIGNAL_WIRES_Y[0]);
    for (servo, path) in order.into_iter().zip(paths) {
        let name = format!("signal-{}", SERVO_NAMES[servo]);
        wires.push(Wire::new(name, path, ORANGE, THIN_WIRE_WIDTH));
    }
    let start = strips::ground_hole(strips::LINKED_GROUND_WAY_COUNT - 1);
    let end = strips::signal_ground_hole();
    let (x, y) = (GROUND_WIRE_X, GROUND_WIRES_Y[0]);
    let path = vec![start, (x, start.1), (x, y), (end.0, y), end];
    let ground_wire = Wire::new("signals-ground", path, BLACK_WIRE, THICK_WIRE_WIDTH);
    wires.push(ground_wire);
    wires.extend(route_board_wires(order, pins));
    wires
}

/// Routes the jumpers from the signal strip to the board.
fn route_board_wires(order: [usize; 4], pins: [u8; 4]) -> Vec<Wire> {
    let (start, end) = (strips::board_ground_hole(), UNO.ground_point());
    let y = GROUND_WIRES_Y[1];
    let path = vec![start, (start.0, y), (end.0, y), end];
    let mut wires = vec![Wire::new("board-ground", path, BROWN, THIN_WIRE_WIDTH)];
    let strip_holes = [0, 1, 2, 3].map(strips::board_hole);
    let mut analogue_count = 0;
    // A wire to an analogue pin goes around the board: it first leads to the point where it turns to the lower row.
    let first_ends = order.map(|servo| {
        if !is_analogue(pins[servo]) {
            return UNO.pin_point(pins[servo]);
        }
        analogue_count += 1;
        turn_point(UNO.lower_right_corner(), analogue_count - 1)
    });
    let paths = route_between_rows(&strip_holes, &first_ends, SIGNAL_WIRES_Y[1]);
    for ((servo, mut path), (_, turn_y)) in order.into_iter().zip(paths).zip(first_ends) {
        if is_analogue(pins[servo]) {
            let pin = UNO.pin_point(pins[servo]);
            path.extend([(pin.0, turn_y), pin]);
        }
        let name = format!("pin-wire-{}", SERVO_NAMES[servo]);
        wires.push(Wire::new(name, path, ORANGE, THIN_WIRE_WIDTH));
    }
    wires
}

/// Draws a servo from above, with its name, position on the robot and pin; `index` counts from left to right.
fn draw_servo(servo: usize, index: usize, pin: u8) -> Group {
    let x = servo_x(index);
    let colour = SERVO_COLOURS[servo];
    let corner = (x - SERVO_SIZE.0 / 2.0, SERVO_TOP_Y);
    let name = SERVO_NAMES[servo];
    let shaft = (x, SERVO_TOP_Y + 32.0);
    let case = rectangle(corner, SERVO_SIZE, colour).set("rx", 5);
    let pin_text = format!("to {}", pin_name(pin));
    let text_x = x + 28.0;
    let position_point = (text_x, SERVO_TOP_Y + 28.0);
    let mut group = Group::new()
        .add(rectangle(corner, SERVO_SIZE, "white").set("rx", 5))
        .add(add_outline(case.set("fill-opacity", 0.18), colour, 2))
        .add(add_outline(circle(shaft, 15.0, "white"), colour, 2))
        .add(circle(shaft, 5.0, DARK))
        .add(text_middle(name, (x, SERVO_TOP_Y + 72.0), 20.0).set("font-weight", "bold"))
        .add(text_start(SERVO_POSITIONS[servo], position_point, 12.0))
        .add(text_start(&pin_text, (text_x, SERVO_TOP_Y + 46.0), 13.0));
    for (lead, point, colour) in [
        ("ground", (x + LEAD_OFFSET, SERVO_TOP_Y), BROWN),
        ("plus", (x - LEAD_OFFSET, SERVO_TOP_Y), RED),
        ("signal", (x, SERVO_TOP_Y + SERVO_SIZE.1), ORANGE),
    ] {
        group = group.add(draw_terminal(&format!("{name}-{lead}"), point, colour));
    }
    group
}

/// Draws the cable to a computer, and a cross at the unused 5V pin.
fn draw_board_notes() -> Group {
    let pin_5v = UNO.five_volt_point();
    let note_point = (pin_5v.0, UNO.lower_right_corner().1 + 17.0);
    let usb_y = UNO.upper_left_corner.1 + 82.0;
    Group::new()
        .add(cross(pin_5v, 6.0, RED, 2.5))
        .add(text_middle("no servo at 5V", note_point, 13.0))
        .add(line((44.0, usb_y), (84.0, usb_y), GREY, 7.0))
        .add(text_start("computer", (42.0, usb_y - 12.0), 13.0))
}

/// The servos' supply voltages for which the drawn 5 V converter is suitable, V.
const DRAWN_SERVO_VOLTS: RangeInclusive<f64> = 4.5..=5.5;

/// Returns the remarks below the drawing, about facts that a drawing cannot show.
fn list_remarks(robot: &Robot) -> Vec<String> {
    let mut lines = vec![
        "Thick lines: 0.5 mm\u{b2} wire (20 AWG), red or black. Thin lines: jumpers (26 AWG);".to_string(),
        "servo wires: orange (signal), red (+5 V), brown (ground). The thinnest belong to a part.".into(),
        "A gap marks a crossing without a junction.".into(),
        "A terminal strip does not join its ways. The bows beside it are 0.5 mm\u{b2} links: one from".into(),
        "way 1 to 2, one from 2 to 3, and so on, two ends in each hole. Ways 11, 12 are spare.".into(),
        format!("The fuse is rated {FUSE_RATING_A} A: the converter draws at most 2.8 A. It must not exceed half the"),
        format!("switch's rating of {MIN_SWITCH_RATING_A} A, which is for alternating current."),
        "The single way is the last of the second strip. It carries 7.4 V and gets no link.".into(),
        "The capacitor's stripe (\u{2212}) goes to ground. The alarm is on the battery's balance plug.".into(),
        "A 10 k\u{3a9} resistor joins each signal to ground: before the program starts, pins drive".into(),
        "nothing, and a servo might take noise for a pulse.".into(),
        "The UNO gets its power from USB, or from the battery through its barrel jack.".into(),
    ];
    let servo_volts = robot.servo_type().supply_volts;
    if !DRAWN_SERVO_VOLTS.contains(&servo_volts) {
        lines.push(format!(
            "The drawing is for servos at 5 V, but this robot's servos are at {servo_volts} V: the converter,"
        ));
        lines.push("the fuse and the capacitor must fit that voltage.".into());
    }
    if let (Some(pin), Some(rail)) = (robot.firmware().rail_pin(), robot.supplies().rail) {
        let (name, ratio) = (pin_name(pin), rail.divider_ratio);
        lines.push(format!(
            "Pin {name} measures the +5 V strip, divided by {ratio:.2}."
        ));
        // With a ratio of 1, the pin is on the strip itself.
        if ratio > 1.0 {
            let upper_kohm = 10.0 * (ratio - 1.0);
            lines.push(format!(
                "Its divider: for example {upper_kohm:.1} k\u{3a9} from the strip to the pin, 10 k\u{3a9} to ground."
            ));
        }
    }
    lines
}
