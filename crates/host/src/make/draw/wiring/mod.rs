//! `lizard draw --wiring`: every wire from the battery's cells to the servos and the board.
//!
//! The picture follows the current: the supply at the top, the strip for +5 V on the left and the one for ground on
//! the right, the servos between them, then the strip for the signals, and the board at the bottom.

mod inputs;
mod radio;
mod strips;
mod supply;
mod wire;

use lizard_robot::servo::NAMES;
use lizard_robot::{FUSE, Robot, SWITCH};
use svg::node::element::Group;

use super::route::{GAP, Path, between_rows, route_end, turn_point};
use super::uno::Uno;
use crate::shared::ink::pin_name;
use crate::shared::ink::{
    BROWN, DARK, GREY, ORANGE, PLACES, RED, SERVO, circle, cross, edged, line, page, rectangle,
    text_middle, text_start,
};
use wire::{BLACK, THICK, THIN, Wire, draw_terminal};

const WIDTH: f64 = 700.0;
/// Horizontal position of the middle of the leftmost servo.
const FIRST: f64 = 170.0;
/// Distance between the middles of neighbouring servos.
const SERVO_SPACING: f64 = 118.0;
/// Vertical position of the upper edges of the servos.
const TOP: f64 = 420.0;
/// Width and height of a servo on the page.
const BODY: (f64, f64) = (50.0, 92.0);
/// Distance from a servo's middle at which its supply wires leave it.
const LEAD: f64 = 14.0;
/// Heights of the uppermost horizontal parts of the signal wires, above their strip and below it.
const LEVELS: [f64; 2] = [530.0, 694.0];
/// Heights of the horizontal parts of the ground wires of signals and board, below all other wires.
const GROUND_LEVELS: [f64; 2] = [582.0, 748.0];
/// Horizontal position at which the wire from the ground strip to the signal strip runs down.
const GROUND_WIRE_X: f64 = 622.0;
const UNO: Uno = Uno {
    corner: (120.0, 776.0),
};
/// The middle of the board's round power socket, relative to its corner.
const SOCKET: (f64, f64) = (-11.0, 252.0);
/// Distance between the lines of the remarks.
const LINE: f64 = 19.0;

/// The wiring of a robot, as SVG text.
pub fn wiring(robot: &Robot) -> String {
    let pins = robot.servos().map(|servo| servo.pin);
    let order = order(pins);
    let around = order
        .iter()
        .filter(|servo| is_analogue(pins[**servo]))
        .count();
    let mut used = pins.to_vec();
    used.extend(robot.firmware().rail_pin());
    used.extend(robot.inputs().each().map(|(_, pin)| pin));
    let notes = UNO.far_corner().1 + GAP * around as f64 + 50.0;
    let socket = (UNO.corner.0 + SOCKET.0, UNO.corner.1 + SOCKET.1);
    let mut group = Group::new();
    let mut wires = supply::wires(socket);
    wires.extend(strips::links());
    wires.extend(strips::resistors(order.map(|servo| NAMES[servo])));
    wires.extend(servo_wires(order, pins));
    for wire in wires {
        group = group.add(wire.draw());
    }
    group = group
        .add(supply::draw(socket))
        .add(strips::draw())
        .add(strips::resistor_bodies())
        .add(UNO.draw(&used));
    for (index, servo) in order.into_iter().enumerate() {
        group = group.add(body(servo, index, pins[servo]));
    }
    let lines = remarks(robot);
    let option = notes + LINE * lines.len() as f64 + 6.0;
    for (index, words) in lines.iter().enumerate() {
        let y = notes + LINE * index as f64;
        group = group.add(text_start(words, (16.0, y), 14.0));
    }
    let inputs = option + radio::HEIGHT;
    group = group.add(draw_board_notes()).add(radio::draw(option));
    if inputs::height(robot) > 0.0 {
        group = group.add(inputs::draw(robot, inputs));
    }
    page((WIDTH, inputs + inputs::height(robot)), group)
}

fn is_analogue(pin: u8) -> bool {
    pin >= 14
}

/// The servos from left to right, in the order of their pins around the UNO from its upper left, so that no two
/// signals cross.
fn order(pins: [u8; 4]) -> [usize; 4] {
    let mut order = [0, 1, 2, 3];
    order.sort_by_key(|servo| {
        let pin = pins[*servo];
        (is_analogue(pin), std::cmp::Reverse(pin))
    });
    order
}

/// Horizontal position of the middle of a servo; `index` counts the servos from left to right.
fn servo_x(index: usize) -> f64 {
    FIRST + SERVO_SPACING * index as f64
}

/// The wires of the servos, and those of their signals to the board. `order` has the servos from left to right.
fn servo_wires(order: [usize; 4], pins: [u8; 4]) -> Vec<Wire> {
    let mut wires = Vec::new();
    for (index, servo) in order.into_iter().enumerate() {
        let (x, name) = (servo_x(index), NAMES[servo]);
        let ground = strips::ground_hole(supply::FIRST_SERVO_WAY + index);
        let brown = vec![(x + LEAD, TOP), (x + LEAD, ground.1), ground];
        wires.push(Wire::new(format!("ground-{name}"), brown, BROWN, THIN));
        // The first ways of the strip belong to the converter and the capacitor.
        let plus = strips::supply_hole(strips::SUPPLIES - 1 - index);
        let red = vec![(x - LEAD, TOP), (x - LEAD, plus.1), plus];
        wires.push(Wire::new(format!("plus-{name}"), red, RED, THIN));
    }
    let places: [usize; 4] = [0, 1, 2, 3];
    let from = places.map(|index| (servo_x(index), TOP + BODY.1));
    let paths = between_rows(&from, &places.map(strips::servo_hole), LEVELS[0]);
    for (servo, path) in order.into_iter().zip(paths) {
        let name = format!("signal-{}", NAMES[servo]);
        wires.push(Wire::new(name, path, ORANGE, THIN));
    }
    let last = strips::ground_hole(strips::GROUNDS - 1);
    let to = strips::signal_ground();
    let level = GROUND_LEVELS[0];
    let path = vec![
        last,
        (GROUND_WIRE_X, last.1),
        (GROUND_WIRE_X, level),
        (to.0, level),
        to,
    ];
    wires.push(Wire::new("signals-ground", path, BLACK, THICK));
    wires.extend(board_wires(order, pins));
    wires
}

/// The jumpers from the signal strip to the board.
fn board_wires(order: [usize; 4], pins: [u8; 4]) -> Vec<Wire> {
    let (from, to) = (strips::board_ground(), UNO.ground());
    let level = GROUND_LEVELS[1];
    let path = vec![from, (from.0, level), (to.0, level), to];
    let mut wires = vec![Wire::new("board-ground", path, BROWN, THIN)];
    let from = [0, 1, 2, 3].map(strips::board_hole);
    let mut around = 0;
    let mut ends: Vec<Path> = Vec::new();
    let to = order.map(|servo| {
        let pin = UNO.pin(pins[servo]);
        if !is_analogue(pins[servo]) {
            ends.push(vec![]);
            return pin;
        }
        ends.push(route_end(UNO.far_corner(), around, pin));
        around += 1;
        turn_point(UNO.far_corner(), around - 1)
    });
    let paths = between_rows(&from, &to, LEVELS[1]);
    for ((servo, mut path), end) in order.into_iter().zip(paths).zip(ends) {
        path.extend(end.iter().skip(1));
        let name = format!("pin-wire-{}", NAMES[servo]);
        wires.push(Wire::new(name, path, ORANGE, THIN));
    }
    wires
}

/// A servo from above, with its name, its place in the robot and its pin.
fn body(servo: usize, index: usize, pin: u8) -> Group {
    let x = servo_x(index);
    let colour = SERVO[servo];
    let corner = (x - BODY.0 / 2.0, TOP);
    let name = NAMES[servo];
    Group::new()
        .add(rectangle(corner, BODY, "white").set("rx", 5))
        .add(edged(
            rectangle(corner, BODY, colour)
                .set("rx", 5)
                .set("fill-opacity", 0.18),
            colour,
            2,
        ))
        .add(edged(circle((x, TOP + 32.0), 15.0, "white"), colour, 2))
        .add(circle((x, TOP + 32.0), 5.0, DARK))
        .add(text_middle(name, (x, TOP + 72.0), 20.0).set("font-weight", "bold"))
        .add(text_start(PLACES[servo], (x + 28.0, TOP + 28.0), 12.0))
        .add(text_start(
            &format!("to {}", pin_name(pin)),
            (x + 28.0, TOP + 46.0),
            13.0,
        ))
        .add(draw_terminal(
            &format!("{name}-ground"),
            (x + LEAD, TOP),
            BROWN,
        ))
        .add(draw_terminal(&format!("{name}-plus"), (x - LEAD, TOP), RED))
        .add(draw_terminal(
            &format!("{name}-signal"),
            (x, TOP + BODY.1),
            ORANGE,
        ))
}

/// The cable to a computer, and the 5V pin, which stays free.
fn draw_board_notes() -> Group {
    let five = UNO.five_volts();
    let edge = UNO.far_corner().1;
    let usb = UNO.corner.1 + 82.0;
    Group::new()
        .add(cross(five, 6.0, RED, 2.5))
        .add(text_middle("no servo at 5V", (five.0, edge + 17.0), 13.0))
        .add(line((44.0, usb), (84.0, usb), GREY, 7.0))
        .add(text_start("computer", (42.0, usb - 12.0), 13.0))
}

/// Remarks about facts that a drawing cannot show.
fn remarks(robot: &Robot) -> Vec<String> {
    let mut lines = vec![
        "Thick lines: wire of 0.5 mm\u{b2} (20 AWG), red or black. Thin lines: jumpers (26 AWG), a".to_string(),
        "servo's are orange (signal), red (+5 V), brown (ground). The thinnest belong to a part.".into(),
        "A gap is a crossing, no joint.".into(),
        "A terminal strip does not join its ways. The bows beside it are links of 0.5 mm\u{b2}: one".into(),
        "from way 1 to 2, one from 2 to 3, and so on, two ends in a hole. Ways 11, 12 are spare.".into(),
        format!("The fuse has {FUSE} A: the converter draws 2.8 A at most. It must not be larger than the"),
        format!("switch's rating: {SWITCH} A, which count by half, because they are for alternating current."),
        "The single way is the last of the second strip. It has 7.4 V from the battery: no link.".into(),
        "The capacitor's stripe (\u{2212}) goes to ground. The alarm is on the battery's balance plug.".into(),
        "A resistor of 10 k\u{3a9} joins each signal to ground: until the program begins, pins drive".into(),
        "nothing, and a servo might take noise for a pulse.".into(),
        "The UNO has its power from USB, or from the battery at its round socket.".into(),
    ];
    if let (Some(pin), Some(rail)) = (robot.firmware().rail_pin(), robot.supplies().rail) {
        lines.push(format!(
            "{} measures the +5 V strip, divided by {:.2}.",
            pin_name(pin),
            rail.ratio
        ));
    }
    lines
}
