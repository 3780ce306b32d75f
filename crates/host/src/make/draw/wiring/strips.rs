//! Terminal strips, and the links between their ways (single terminals).
//!
//! A strip does not connect its ways: each way is a brass tube with a screw at both ends. Short links therefore lead
//! from way to way on one side of a strip, and the wires are on the other side.

use svg::node::element::Group;

use super::wire::{BLACK_WIRE, LEAD_WIDTH, THICK_WIRE_WIDTH, Wire, draw_resistor, draw_terminal};
use crate::shared::shapes::{
    DARK, ORANGE, RED, add_outline, circle, line, rectangle, text_middle, text_start,
};

/// Distance between neighbouring ways of the upright strips, pixels.
const PITCH: f64 = 22.0;
/// Width of a strip, pixels.
const STRIP_WIDTH: f64 = 36.0;
/// Reach of a link beyond its strip, pixels.
const LINK_REACH: f64 = 11.0;
/// Number of linked ways of the ground strip; two more ways are spare.
pub const LINKED_GROUND_WAY_COUNT: usize = 10;
/// Number of ways of the ground strip.
const GROUND_WAY_COUNT: usize = 12;
/// Number of ways of the +5 V strip.
pub const SUPPLY_WAY_COUNT: usize = 6;
/// First wire hole of the ground strip, at the strip's inner edge: x and y, pixels.
const FIRST_GROUND_HOLE: (f64, f64) = (640.0, 160.0);
/// First wire hole of the +5 V strip, at the strip's inner edge: x and y, pixels.
const FIRST_SUPPLY_HOLE: (f64, f64) = (96.0, 259.0);
/// Horizontal position of the signal strip's first way, pixels.
const FIRST_SIGNAL_WAY_X: f64 = 265.0;
/// Distance between neighbouring ways of the signal strip, pixels.
const SIGNAL_WAY_PITCH: f64 = 48.0;
/// Vertical positions of the signal strip's upper and lower edges, pixels.
const SIGNAL_EDGES_Y: (f64, f64) = (597.0, 633.0);
/// Distance of the board's jumper from the middle of its way, away from the strip's middle way, pixels.
const JUMPER_OFFSET: f64 = 5.0;

/// Returns the wire hole of a way in the ground strip; ways count from 0.
pub fn ground_hole(way: usize) -> (f64, f64) {
    let (x, first_y) = FIRST_GROUND_HOLE;
    (x, first_y + PITCH * way as f64)
}

/// Returns the wire hole of a way in the +5 V strip; ways count from 0.
pub fn supply_hole(way: usize) -> (f64, f64) {
    let (x, first_y) = FIRST_SUPPLY_HOLE;
    (x, first_y + PITCH * way as f64)
}

/// Returns the index of a servo's way in the signal strip; `index` counts the servos from left to right. The middle way
/// is for ground and is skipped.
const fn servo_way(index: usize) -> usize {
    if index < 2 { index } else { index + 1 }
}

/// Index of the ground way in the signal strip.
const SIGNAL_GROUND_WAY: usize = 2;

/// Returns the horizontal position of a way in the signal strip.
fn signal_way_x(way: usize) -> f64 {
    FIRST_SIGNAL_WAY_X + SIGNAL_WAY_PITCH * way as f64
}

/// Returns the signal strip's hole for a servo's signal; `index` counts the servos from left to right.
pub fn servo_hole(index: usize) -> (f64, f64) {
    (signal_way_x(servo_way(index)), SIGNAL_EDGES_Y.0)
}

/// Returns the signal strip's hole for the wire from the ground strip.
pub fn signal_ground_hole() -> (f64, f64) {
    (signal_way_x(SIGNAL_GROUND_WAY), SIGNAL_EDGES_Y.0)
}

/// Returns the signal strip's hole for a servo's jumper to the board; `index` counts the servos from left to right.
pub fn board_hole(index: usize) -> (f64, f64) {
    let side = if index < 2 { -1.0 } else { 1.0 };
    let x = signal_way_x(servo_way(index)) + side * JUMPER_OFFSET;
    (x, SIGNAL_EDGES_Y.1)
}

/// Returns the signal strip's hole for the board's ground.
pub fn board_ground_hole() -> (f64, f64) {
    (signal_way_x(SIGNAL_GROUND_WAY), SIGNAL_EDGES_Y.1)
}

/// Routes the links of the ground strip and the +5 V strip.
pub fn route_links() -> Vec<Wire> {
    let link_wire = |name: String, (x, y): (f64, f64), side: f64, colour| {
        let x = x + side * STRIP_WIDTH;
        let far_x = x + side * LINK_REACH;
        let path = vec![(x, y), (far_x, y), (far_x, y + PITCH), (x, y + PITCH)];
        Wire::new(name, path, colour, THICK_WIRE_WIDTH - 1.0)
    };
    let ground_links = (1..LINKED_GROUND_WAY_COUNT).map(|way| {
        let name = format!("link-ground-{way}");
        link_wire(name, ground_hole(way - 1), 1.0, BLACK_WIRE)
    });
    let supply_links = (1..SUPPLY_WAY_COUNT).map(|way| {
        let name = format!("link-supply-{way}");
        link_wire(name, supply_hole(way - 1), -1.0, RED)
    });
    ground_links.chain(supply_links).collect()
}

/// Routes the resistors' leads from each servo's way in the signal strip to the ground way. `names` lists the servos
/// from left to right.
pub fn route_resistor_leads(names: [&str; 4]) -> Vec<Wire> {
    let resistor_wire = |(index, name): (usize, &str)| {
        // The outer resistors' leads run below the inner resistors' leads, so that they do not cross.
        let (ground_offset, reach) = match index {
            0 => (-5.0, 35.0),
            1 => (-11.0, 17.0),
            2 => (11.0, 17.0),
            _ => (5.0, 35.0),
        };
        let (y, far_y) = (SIGNAL_EDGES_Y.1, SIGNAL_EDGES_Y.1 + reach);
        let side = if index < 2 { 1.0 } else { -1.0 };
        let start_x = signal_way_x(servo_way(index)) + side * JUMPER_OFFSET;
        let end_x = signal_way_x(SIGNAL_GROUND_WAY) + ground_offset;
        let path = vec![(start_x, y), (start_x, far_y), (end_x, far_y), (end_x, y)];
        Wire::new(format!("resistor-{name}"), path, DARK, LEAD_WIDTH)
    };
    names.into_iter().enumerate().map(resistor_wire).collect()
}

/// Draws the resistors' bodies at the signal strip.
pub fn draw_resistor_bodies() -> Group {
    let mut group = Group::new();
    for (way, y_offset) in [(0, 35.0), (1, 17.0), (2, 17.0), (3, 35.0)] {
        let x = (signal_way_x(way) + signal_way_x(way + 1)) / 2.0;
        group = group.add(draw_resistor((x, SIGNAL_EDGES_Y.1 + y_offset), (22.0, 9.0)));
    }
    let point = (signal_way_x(4) + 22.0, SIGNAL_EDGES_Y.1 + 31.0);
    group
        .add(text_start("4 x 10 k\u{3a9}", point, 13.0))
        .add(text_start("own leads", (point.0, point.1 + 16.0), 12.0))
}

/// Adds a strip's way, a brass tube with a number, to `group`.
fn draw_way(group: Group, start: (f64, f64), end: (f64, f64), number: usize) -> Group {
    let (x, y) = ((start.0 + end.0) / 2.0, (start.1 + end.1) / 2.0);
    group
        .add(line(start, end, "#c9b26b", 7.0))
        .add(circle((x, y), 8.5, "white"))
        .add(text_middle(&number.to_string(), (x, y + 4.5), 12.0))
}

/// Draws the case of a strip.
fn draw_strip(corner: (f64, f64), size: (f64, f64)) -> svg::node::element::Rectangle {
    add_outline(rectangle(corner, size, "#f2f2f2").set("rx", 4), DARK, 1.3)
}

/// Draws the three strips.
pub fn draw() -> Group {
    let draw_upright_strip = |way_count: usize, (left, top): (f64, f64)| {
        let size = (STRIP_WIDTH, PITCH * way_count as f64);
        draw_strip((left, top - PITCH / 2.0), size)
    };
    let supply_strip = (FIRST_SUPPLY_HOLE.0 - STRIP_WIDTH, FIRST_SUPPLY_HOLE.1);
    let mut group = Group::new()
        .add(draw_upright_strip(GROUND_WAY_COUNT, FIRST_GROUND_HOLE))
        .add(draw_upright_strip(SUPPLY_WAY_COUNT, supply_strip));
    let upright_strips = [("ground", GROUND_WAY_COUNT), ("supply", SUPPLY_WAY_COUNT)];
    for (name, way_count) in upright_strips {
        for way in 0..way_count {
            let (hole, link_offset) = match name {
                "ground" => (ground_hole(way), STRIP_WIDTH),
                _ => (supply_hole(way), -STRIP_WIDTH),
            };
            let link_point = (hole.0 + link_offset, hole.1);
            group = draw_way(group, hole, link_point, way + 1);
            for (side, point) in [("wire", hole), ("link", link_point)] {
                let name = format!("{name}-{}-{side}", way + 1);
                group = group.add(draw_terminal(&name, point, DARK));
            }
        }
    }
    let (top, bottom) = SIGNAL_EDGES_Y;
    let corner = (FIRST_SIGNAL_WAY_X - SIGNAL_WAY_PITCH / 2.0, top);
    group = group.add(draw_strip(corner, (5.0 * SIGNAL_WAY_PITCH, bottom - top)));
    for way in 0..5 {
        let x = signal_way_x(way);
        group = draw_way(group, (x, top + 3.0), (x, bottom - 3.0), way + 1);
        for (side, y) in [("servo", top), ("board", bottom)] {
            let name = format!("signals-{}-{side}", way + 1);
            group = group.add(draw_terminal(&name, (x, y), ORANGE));
        }
    }
    let lower_end_y = FIRST_GROUND_HOLE.1 + PITCH * GROUND_WAY_COUNT as f64;
    for (label, y_offset) in [("ground", 4.0), ("strip,", 19.0), ("12 ways", 34.0)] {
        let point = (FIRST_GROUND_HOLE.0 + 20.0, lower_end_y + y_offset);
        group = group.add(text_middle(label, point, 13.0));
    }
    let supply_end_y = FIRST_SUPPLY_HOLE.1 + PITCH * SUPPLY_WAY_COUNT as f64;
    for (label, point) in [
        ("+5 V strip", (46.0, supply_end_y + 4.0)),
        ("6 ways", (46.0, supply_end_y + 20.0)),
        ("signal strip, 5 ways:", (76.0, top + 16.0)),
        ("3 is ground", (76.0, top + 32.0)),
    ] {
        group = group.add(text_start(label, point, 13.0));
    }
    group
}
