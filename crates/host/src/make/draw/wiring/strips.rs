//! Terminal strips, and the links between their ways (single terminals).
//!
//! A strip does not connect its ways: each is a brass tube with a screw at both ends. So short links lead from way
//! to way on one side of a strip, and the wires are on the other side.

use svg::node::element::Group;

use super::wire::{BLACK, LEG, THICK, Wire, draw_terminal};
use crate::make::draw::route::Path;
use crate::shared::ink::{
    DARK, ORANGE, RED, circle, edged, line, rectangle, text_middle, text_start,
};

/// Pixels between neighbouring ways of the upright strips.
const PITCH: f64 = 22.0;
/// Width of a strip, pixels.
const STRIP_WIDTH: f64 = 36.0;
/// Reach of a link beyond its strip, pixels.
const LINK: f64 = 11.0;
/// Number of ways of the ground strip that have links; two more ways are spare.
pub const GROUNDS: usize = 10;
/// Number of all ways of the ground strip.
const GROUND_WAYS: usize = 12;
/// Number of ways of the +5 V strip.
pub const SUPPLIES: usize = 6;
/// First wire hole of the ground strip: x of the strip's inner edge, and y.
const GROUND: (f64, f64) = (640.0, 160.0);
/// First wire hole of the +5 V strip: x of the strip's inner edge, and y.
const SUPPLY: (f64, f64) = (96.0, 259.0);
/// The ways of the signal strip: x of the first one, and distance to the next.
const SIGNALS: (f64, f64) = (265.0, 48.0);
/// Heights of the upper and lower edges of the signal strip.
const SIGNALS_AT: (f64, f64) = (597.0, 633.0);
/// Distance from the middle of a way to the board's jumper in it, away from the strip's middle way.
const JUMPER: f64 = 5.0;

/// The wire hole of a way of the ground strip; ways count from 0.
pub fn ground_hole(way: usize) -> (f64, f64) {
    (GROUND.0, GROUND.1 + PITCH * way as f64)
}

/// The wire hole of a way of the +5 V strip; ways count from 0.
pub fn supply_hole(way: usize) -> (f64, f64) {
    (SUPPLY.0, SUPPLY.1 + PITCH * way as f64)
}

/// Index of a servo's way of the signal strip; `index` counts the servos from left to right. The middle way is for
/// ground.
const fn way_of_servo(index: usize) -> usize {
    if index < 2 { index } else { index + 1 }
}

/// Index of the ground way of the signal strip.
const MIDDLE: usize = 2;

/// Horizontal position of a way of the signal strip.
fn signal_x(way: usize) -> f64 {
    SIGNALS.0 + SIGNALS.1 * way as f64
}

/// The hole of the signal strip for a servo's signal; `index` counts the servos from left to right.
pub fn servo_hole(index: usize) -> (f64, f64) {
    (signal_x(way_of_servo(index)), SIGNALS_AT.0)
}

/// The hole of the signal strip for the wire from the ground strip.
pub fn signal_ground() -> (f64, f64) {
    (signal_x(MIDDLE), SIGNALS_AT.0)
}

/// The hole of the signal strip for a servo's jumper to the board; `index` counts the servos from left to right.
pub fn board_hole(index: usize) -> (f64, f64) {
    let outward = if index < 2 { -JUMPER } else { JUMPER };
    (signal_x(way_of_servo(index)) + outward, SIGNALS_AT.1)
}

/// The hole of the signal strip for the board's ground.
pub fn board_ground() -> (f64, f64) {
    (signal_x(MIDDLE), SIGNALS_AT.1)
}

/// The links of the ground strip and of the +5 V strip.
pub fn links() -> Vec<Wire> {
    let link = |name: String, out: f64, from: (f64, f64)| {
        let (x, y) = from;
        let path: Path = vec![(x, y), (x + out, y), (x + out, y + PITCH), (x, y + PITCH)];
        Wire::new(name, path, if out > 0.0 { BLACK } else { RED }, THICK - 1.0)
    };
    let grounds = (1..GROUNDS).map(|way| {
        let (x, y) = ground_hole(way - 1);
        link(format!("link-ground-{way}"), LINK, (x + STRIP_WIDTH, y))
    });
    let supplies = (1..SUPPLIES).map(|way| {
        let (x, y) = supply_hole(way - 1);
        link(format!("link-supply-{way}"), -LINK, (x - STRIP_WIDTH, y))
    });
    grounds.chain(supplies).collect()
}

/// The leads of the resistors from each servo's way of the signal strip to the ground way. `names` has the servos
/// from left to right.
pub fn resistors(names: [&str; 4]) -> Vec<Wire> {
    let resistor = |(index, name): (usize, &str)| {
        // The leads of the outer resistors run below those of the inner ones, so that they do not cross.
        let (to_middle, inner) = match index {
            0 => (-5.0, false),
            1 => (-11.0, true),
            2 => (11.0, true),
            _ => (5.0, false),
        };
        let inward = if index < 2 { JUMPER } else { -JUMPER };
        let from = (signal_x(way_of_servo(index)) + inward, SIGNALS_AT.1);
        let to = (signal_x(MIDDLE) + to_middle, SIGNALS_AT.1);
        let low = SIGNALS_AT.1 + if inner { 17.0 } else { 35.0 };
        let path = vec![from, (from.0, low), (to.0, low), to];
        Wire::new(format!("resistor-{name}"), path, DARK, LEG)
    };
    names.into_iter().enumerate().map(resistor).collect()
}

/// The bodies of the resistors at the signal strip.
pub fn resistor_bodies() -> Group {
    let mut group = Group::new();
    for (way, low) in [(0, 35.0), (1, 17.0), (2, 17.0), (3, 35.0)] {
        let x = (signal_x(way) + signal_x(way + 1)) / 2.0;
        let (width, height) = (22.0, 9.0);
        let corner = (x - width / 2.0, SIGNALS_AT.1 + low - height / 2.0);
        let body = rectangle(corner, (width, height), "#f3e3c3").set("rx", 2);
        group = group.add(edged(body, DARK, 1.5));
    }
    let point = (signal_x(4) + 22.0, SIGNALS_AT.1 + 31.0);
    group
        .add(text_start("4 x 10 k\u{3a9}", point, 13.0))
        .add(text_start("own legs", (point.0, point.1 + 16.0), 12.0))
}

/// Draws a way of a strip: its brass tube and its number.
fn draw_brass_strip(group: Group, from: (f64, f64), to: (f64, f64), number: usize) -> Group {
    let middle = ((from.0 + to.0) / 2.0, (from.1 + to.1) / 2.0);
    group
        .add(line(from, to, "#c9b26b", 7.0))
        .add(circle(middle, 8.5, "white"))
        .add(text_middle(
            &number.to_string(),
            (middle.0, middle.1 + 4.5),
            12.0,
        ))
}

fn case(corner: (f64, f64), size: (f64, f64)) -> svg::node::element::Rectangle {
    edged(rectangle(corner, size, "#f2f2f2").set("rx", 4), DARK, 1.3)
}

/// The three strips.
pub fn draw() -> Group {
    let mut group = Group::new();
    let upright = |ways: usize, left: f64, top: f64| {
        let size = (STRIP_WIDTH, PITCH * ways as f64);
        case((left, top - PITCH / 2.0), size)
    };
    group = group
        .add(upright(GROUND_WAYS, GROUND.0, GROUND.1))
        .add(upright(SUPPLIES, SUPPLY.0 - STRIP_WIDTH, SUPPLY.1));
    let upright = [("ground", GROUND_WAYS), ("supply", SUPPLIES)];
    for (name, ways) in upright {
        for way in 0..ways {
            let (hole, other) = match name {
                "ground" => (ground_hole(way), STRIP_WIDTH),
                _ => (supply_hole(way), -STRIP_WIDTH),
            };
            let link = (hole.0 + other, hole.1);
            group = draw_brass_strip(group, hole, link, way + 1)
                .add(draw_terminal(
                    &format!("{name}-{}-wire", way + 1),
                    hole,
                    DARK,
                ))
                .add(draw_terminal(
                    &format!("{name}-{}-link", way + 1),
                    link,
                    DARK,
                ));
        }
    }
    let (top, bottom) = SIGNALS_AT;
    let half = SIGNALS.1 / 2.0;
    group = group.add(case(
        (SIGNALS.0 - half, top),
        (5.0 * SIGNALS.1, bottom - top),
    ));
    for way in 0..5 {
        let x = signal_x(way);
        group = draw_brass_strip(group, (x, top + 3.0), (x, bottom - 3.0), way + 1)
            .add(draw_terminal(
                &format!("signals-{}-servo", way + 1),
                (x, top),
                ORANGE,
            ))
            .add(draw_terminal(
                &format!("signals-{}-board", way + 1),
                (x, bottom),
                ORANGE,
            ));
    }
    let last = GROUND.1 + PITCH * GROUND_WAYS as f64;
    group
        .add(text_middle("ground", (GROUND.0 + 20.0, last + 4.0), 13.0))
        .add(text_middle("strip,", (GROUND.0 + 20.0, last + 19.0), 13.0))
        .add(text_middle("12 ways", (GROUND.0 + 20.0, last + 34.0), 13.0))
        .add(text_start(
            "+5 V strip",
            (46.0, SUPPLY.1 + PITCH * 6.0 + 4.0),
            13.0,
        ))
        .add(text_start(
            "6 ways",
            (46.0, SUPPLY.1 + PITCH * 6.0 + 20.0),
            13.0,
        ))
        .add(text_start(
            "signal strip, 5 ways:",
            (76.0, top + 16.0),
            13.0,
        ))
        .add(text_start("3 is ground", (76.0, top + 32.0), 13.0))
}
