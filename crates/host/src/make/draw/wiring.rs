//! `lizard draw --wiring`: servos, supply and UNO, and every wire between them.

use lizard_robot::Robot;
use lizard_robot::servo::NAMES;
use svg::node::element::Group;

use super::route::{GAP, Path, below, beside, between_rows};
use super::uno::Uno;
use crate::shared::ink::pin_name;
use crate::shared::ink::{
    BROWN, DARK, GREY, ORANGE, PLACES, RED, SERVO, circle, cross, curve, line, page, rectangle,
    text_end, text_middle, text_start,
};

const WIDTH: f64 = 700.0;

/// Heights of the two rails, and where they begin and end.
const GROUND: f64 = 42.0;
const PLUS: f64 = 98.0;
const RAILS: (f64, f64) = (60.0, 598.0);

/// The ground wire to the UNO goes down here.
const MARGIN: f64 = 16.0;

/// The first servo's middle, the next one's distance; bodies' upper ends; their size.
const FIRST: f64 = 98.0;
const APART: f64 = 112.0;
const TOP: f64 = 158.0;
const BODY: (f64, f64) = (50.0, 92.0);

/// A servo's wires leave it this far from its middle.
const LEAD: f64 = 14.0;

/// Its signal goes down this far right of its middle.
const ASIDE: f64 = 42.0;

/// A pull-down resistor's body: its middle's height and its size.
const RESISTOR: f64 = 122.0;
const RESISTOR_SIZE: (f64, f64) = (9.0, 24.0);

/// The highest sideways part of a signal.
const LEVEL: f64 = 302.0;

const UNO: Uno = Uno {
    corner: (120.0, 378.0),
};

/// The wiring of a robot, as SVG text.
#[must_use]
pub fn wiring(robot: &Robot) -> String {
    let pins = robot.servos().map(|servo| servo.pin);
    let order = order(pins);
    let around = order
        .iter()
        .filter(|servo| is_analogue(pins[**servo]))
        .count();
    let mut used = pins.to_vec();
    used.extend(robot.firmware().rail_pin());
    let notes = UNO.far_corner().1 + GAP * around as f64 + 44.0;
    let mut group = supply().add(UNO.draw(&used));
    for (place, servo) in order.into_iter().enumerate() {
        group = group.add(body(servo, place, pins[servo]));
    }
    for (name, path, colour) in wires(pins) {
        group = group.add(wire(&name, &path, colour));
    }
    group = group.add(remarks(robot, notes));
    let height = notes + 138.0;
    page((WIDTH, height), group)
}

fn is_analogue(pin: u8) -> bool {
    pin >= 14
}

/// The servos from left to right, as their pins are met going round the UNO from its
/// upper left: so no signal crosses another.
fn order(pins: [u8; 4]) -> [usize; 4] {
    let mut order = [0, 1, 2, 3];
    order.sort_by_key(|servo| {
        let pin = pins[*servo];
        (is_analogue(pin), std::cmp::Reverse(pin))
    });
    order
}

/// Every wire and rail: its name, its path, its colour.
fn wires(pins: [u8; 4]) -> Vec<(String, Path, &'static str)> {
    let mut wires = vec![
        (
            "rail-plus".into(),
            vec![(RAILS.0, PLUS), (RAILS.1, PLUS)],
            RED,
        ),
        (
            "rail-ground".into(),
            vec![(MARGIN, GROUND), (RAILS.1, GROUND)],
            BROWN,
        ),
    ];
    // The UNO's ground is one more wire in front of the signals.
    let (mut from, mut to) = (vec![(MARGIN, GROUND)], vec![UNO.ground()]);
    let (mut names, mut ends) = (vec!["uno-ground".to_string()], vec![vec![]]);
    let mut around = 0;
    for (place, servo) in order(pins).into_iter().enumerate() {
        let (x, pin) = (FIRST + APART * place as f64, UNO.pin(pins[servo]));
        let name = NAMES[servo];
        wires.push((
            format!("ground-{name}"),
            vec![(x - LEAD, TOP), (x - LEAD, GROUND)],
            BROWN,
        ));
        wires.push((format!("plus-{name}"), vec![(x, TOP), (x, PLUS)], RED));
        wires.push((
            format!("pull-down-{name}"),
            vec![(x + ASIDE, TOP - GAP), (x + ASIDE, GROUND)],
            DARK,
        ));
        from.push((x + ASIDE, TOP - GAP));
        names.push(format!("signal-{name}"));
        if is_analogue(pins[servo]) {
            to.push(beside(UNO.far_corner(), around));
            ends.push(below(UNO.far_corner(), around, pin));
            around += 1;
        } else {
            to.push(pin);
            ends.push(vec![]);
        }
    }
    let paths = between_rows(&from, &to, LEVEL);
    for (wire, mut path) in paths.into_iter().enumerate() {
        let colour = if wire == 0 { BROWN } else { ORANGE };
        if wire > 0 {
            let (x, y) = from[wire];
            path.splice(0..0, [(x - ASIDE + LEAD, TOP), (x - ASIDE + LEAD, y)]);
        }
        path.extend(ends[wire].iter().skip(1));
        wires.push((names[wire].clone(), path, colour));
    }
    wires
}

/// A wire; where one to ground passes over the other rail, it is seen to pass.
fn wire(name: &str, path: &Path, colour: &str) -> Group {
    let width = match name {
        _ if name.starts_with("rail") => 6.0,
        _ if name.starts_with("pull-down-") => 2.0,
        _ => 3.5,
    };
    let mut group = Group::new();
    if name.starts_with("ground-") || name.starts_with("pull-down-") {
        let x = path[0].0;
        let over = [(x, PLUS - 6.0), (x, PLUS + 6.0)];
        group = group.add(curve(&over, "white", 8.5).set("stroke-linecap", "butt"));
    }
    group = group.add(curve(path, colour, width).set("id", name));
    // A joint where a servo's wire ends at its rail, and at both ends of a resistor.
    match (path.first(), path.last()) {
        (_, Some(end)) if name.starts_with("ground-") || name.starts_with("plus-") => {
            group.add(circle(*end, 5.5, colour))
        }
        (Some(signal), Some(ground)) if name.starts_with("pull-down-") => group
            .add(resistor(ground.0))
            .add(circle(*ground, 5.5, BROWN))
            .add(circle(*signal, 4.5, ORANGE)),
        _ => group,
    }
}

/// A pull-down resistor in its wire.
fn resistor(x: f64) -> Group {
    let (width, height) = RESISTOR_SIZE;
    let corner = (x - width / 2.0, RESISTOR - height / 2.0);
    Group::new()
        .add(
            rectangle(corner, RESISTOR_SIZE, "#f3e3c3")
                .set("rx", 2)
                .set("stroke", DARK)
                .set("stroke-width", 1.5),
        )
        .add(text_start(
            "10 k\u{3a9}",
            (x + width - 1.0, RESISTOR + 4.0),
            12.0,
        ))
}

/// A servo from above.
fn body(servo: usize, place: usize, pin: u8) -> Group {
    let x = FIRST + APART * place as f64;
    let colour = SERVO[servo];
    let corner = (x - BODY.0 / 2.0, TOP);
    let below = TOP + BODY.1;
    Group::new()
        .add(rectangle(corner, BODY, "white").set("rx", 5))
        .add(
            rectangle(corner, BODY, colour)
                .set("rx", 5)
                .set("fill-opacity", 0.18)
                .set("stroke", colour)
                .set("stroke-width", 2),
        )
        .add(
            circle((x, TOP + 27.0), 15.0, "white")
                .set("stroke", colour)
                .set("stroke-width", 2),
        )
        .add(circle((x, TOP + 27.0), 5.0, DARK))
        .add(text_middle(NAMES[servo], (x, below - 18.0), 20.0).set("font-weight", "bold"))
        .add(text_middle(PLACES[servo], (x - 2.0, below + 17.0), 13.0))
        .add(text_middle(
            &format!("to {}", pin_name(pin)),
            (x - 2.0, below + 34.0),
            13.0,
        ))
}

/// The supply, its two rails' names and the capacitor between them.
fn supply() -> Group {
    let can = 506.0;
    let half = 12.0;
    let (top, bottom) = (GROUND + 12.0, PLUS - 10.0);
    let size = (WIDTH - 8.0 - RAILS.1, PLUS - GROUND + 48.0);
    let middle = RAILS.1 + size.0 / 2.0 + 6.0;
    Group::new()
        .add(
            rectangle((RAILS.1, GROUND - 24.0), size, "#eeeeee")
                .set("rx", 6)
                .set("stroke", DARK)
                .set("stroke-width", 1.5),
        )
        .add(text_start("\u{2212}", (RAILS.1 + 8.0, GROUND + 6.0), 18.0))
        .add(text_start("+", (RAILS.1 + 8.0, PLUS + 6.0), 18.0))
        .add(text_middle("supply", (middle, PLUS - 32.0), 15.0))
        .add(text_middle("5 V, 3 A", (middle, PLUS - 12.0), 15.0))
        .add(text_start("ground (brown)", (MARGIN, GROUND - 12.0), 13.0))
        .add(text_end("+5 V", (RAILS.0 - 6.0, PLUS - 2.0), 13.0))
        .add(text_end("(red)", (RAILS.0 - 6.0, PLUS + 14.0), 13.0))
        .add(line((can, GROUND), (can, PLUS), DARK, 2.0))
        .add(
            rectangle((can - half, top), (2.0 * half, bottom - top), "#dddddd")
                .set("rx", 3)
                .set("stroke", DARK)
                .set("stroke-width", 1.5),
        )
        .add(rectangle((can - half, top), (2.0 * half, 9.0), DARK).set("rx", 2))
        .add(text_start("1000 µF", (can + half + 6.0, PLUS - 32.0), 13.0))
        .add(text_start("10 V", (can + half + 6.0, PLUS - 15.0), 13.0))
}

/// Remarks that a drawing cannot show.
fn remarks(robot: &Robot, top: f64) -> Group {
    let five = UNO.five_volts();
    let edge = UNO.far_corner().1;
    let mut lines = vec![
        "Wires of a servo: orange is the signal, red is +5 V, brown is ground.".to_string(),
        "A wire that passes over the red rail does not touch it.".into(),
        "A resistor of 10 k\u{3a9} joins each signal to ground: until the program begins, pins drive".into(),
        "nothing, and a servo might take noise for a pulse.".into(),
        "The capacitor's stripe (\u{2212}) goes to ground.".into(),
        "The UNO has its power from USB, or from 7 to 12 V at its round socket.".into(),
        "Its ground is joined to the supply's; nothing is connected to its 5V pin.".into(),
    ];
    if let (Some(pin), Some(rail)) = (robot.firmware().rail_pin(), robot.supplies().rail) {
        lines.push(format!(
            "{} measures the red rail, divided by {:.2}.",
            pin_name(pin),
            rail.ratio
        ));
    }
    let mut group = Group::new()
        .add(cross(five, 6.0, RED, 2.5))
        .add(text_middle("5V stays free", (five.0, edge + 17.0), 13.0))
        .add(line((MARGIN, 437.0), (84.0, 437.0), GREY, 7.0))
        .add(text_start("computer", (8.0, 461.0), 13.0))
        .add(text_start("or charger", (8.0, 477.0), 13.0));
    for (place, words) in lines.iter().enumerate() {
        let y = top + 18.0 * place as f64;
        group = group.add(text_start(words, (MARGIN, y), 14.0));
    }
    group
}
