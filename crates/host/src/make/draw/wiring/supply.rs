//! The supply, from the battery's cells to the strips: plug, fuse, switch, converter, capacitor, alarm, and the
//! board's round plug.

use lizard_robot::{FUSE, SWITCH};
use svg::node::element::Group;

use super::strips::{ground_hole, supply_hole};
use super::wire::{BLACK, GREY_WIRE, LEG, THICK, THIN, Wire, draw_terminal};
use crate::make::draw::route::Path;
use crate::shared::ink::{DARK, RED, edged, line, rectangle, text_end, text_middle, text_start};

type Point = (f64, f64);

/// The battery's left edge.
const BATTERY: f64 = 560.0;
/// Vertical position of the battery's plus contact, and of the fuse, the switch and the single way (terminal) after
/// them. Positions grow downwards.
const PLUS: f64 = 40.0;
/// Vertical position of the battery's minus contact.
const MINUS: f64 = 112.0;
/// Vertical positions of the contacts of the battery's balance plug.
const BALANCE: [f64; 3] = [62.0, 76.0, 90.0];
/// The left edge of the battery's cells.
const CELLS: f64 = 600.0;
/// The alarm's right edge.
const ALARM: f64 = 500.0;
/// Horizontal positions of the fuse's left and right contacts.
const FUSE_AT: [f64; 2] = [458.0, 518.0];
/// Horizontal positions of the switch's left and right contacts.
const SWITCH_AT: [f64; 2] = [362.0, 428.0];
/// Horizontal positions of the left and right holes of the single way after the switch.
const WAY: [f64; 2] = [286.0, 322.0];
/// Distance from the middle of the single way to each of the two wires at its left hole.
const WIRE_OFFSET: f64 = 5.0;
/// The converter's left and right edges.
const CONVERTER: [f64; 2] = [130.0, 235.0];
/// Vertical position of the contact IN+ of the converter.
const CONVERTER_IN_PLUS: f64 = PLUS - WIRE_OFFSET;
/// Vertical position of the contacts IN- and OUT- of the converter.
const CONVERTER_MINUS: f64 = 104.0;
/// The capacitor's horizontal position.
const CAPACITOR: f64 = 150.0;
/// Horizontal positions of the two wires that lead down to the round plug.
const MARGINS: [f64; 2] = [20.0, 34.0];

/// Parts of the supply, each with its way (terminal) of the ground strip, counted from 0.
const GROUND_OF: [(&str, usize); 5] = [
    ("battery", 0),
    ("converter-in", 1),
    ("converter-out", 2),
    ("round-plug", 3),
    ("capacitor", 4),
];

/// The index of the ground strip's first way (terminal) for a servo.
pub const FIRST_SERVO_WAY: usize = GROUND_OF.len();

/// The wire hole of the ground strip for a part of the supply.
fn ground_way(name_of_part: &str) -> Point {
    let index = GROUND_OF.iter().find(|(name, _)| *name == name_of_part);
    ground_hole(index.map_or(0, |(_, way)| *way))
}

/// All wires of the supply; `socket` is the middle of the board's round socket.
pub fn wires(socket: Point) -> Vec<Wire> {
    let [plug_plus, plug_minus] = round_plug(socket);
    let segment = |a: Point, b: Point| vec![a, b];
    let thick = |name: &str, path: Path, colour| Wire::new(name, path, colour, THICK);
    let out = supply_hole(0);
    let minus = ground_way("battery");
    let inner = ground_way("converter-in");
    let outer = ground_way("converter-out");
    let round = ground_way("round-plug");
    let mut wires = vec![
        thick(
            "battery-fuse",
            segment((BATTERY, PLUS), (FUSE_AT[1], PLUS)),
            RED,
        ),
        thick(
            "fuse-switch",
            segment((FUSE_AT[0], PLUS), (SWITCH_AT[1], PLUS)),
            RED,
        ),
        thick(
            "switch-way",
            segment((SWITCH_AT[0], PLUS), (WAY[1], PLUS)),
            RED,
        ),
        thick(
            "way-converter",
            segment(
                (WAY[0], CONVERTER_IN_PLUS),
                (CONVERTER[1], CONVERTER_IN_PLUS),
            ),
            RED,
        ),
        thick(
            "battery-ground",
            vec![(BATTERY, MINUS), (546.0, MINUS), (546.0, minus.1), minus],
            BLACK,
        ),
        thick(
            "converter-in-ground",
            vec![
                (CONVERTER[1], CONVERTER_MINUS),
                (252.0, CONVERTER_MINUS),
                (252.0, inner.1),
                inner,
            ],
            BLACK,
        ),
        thick(
            "converter-out-ground",
            vec![
                (CONVERTER[0], CONVERTER_MINUS),
                (119.0, CONVERTER_MINUS),
                (119.0, outer.1),
                outer,
            ],
            BLACK,
        ),
        thick(
            "converter-supply",
            vec![(CONVERTER[0], PLUS), (106.0, PLUS), (106.0, out.1), out],
            RED,
        ),
        Wire::new(
            "round-plug-plus",
            vec![
                (WAY[0], PLUS + WIRE_OFFSET),
                (268.0, PLUS + WIRE_OFFSET),
                (268.0, 138.0),
                (MARGINS[0], 138.0),
                (MARGINS[0], plug_plus.1),
                plug_plus,
            ],
            RED,
            THIN,
        ),
        Wire::new(
            "round-plug-ground",
            vec![
                round,
                (MARGINS[1], round.1),
                (MARGINS[1], plug_minus.1),
                plug_minus,
            ],
            BLACK,
            THIN,
        ),
    ];
    let [above, below] = capacitor();
    wires.push(thick(
        "capacitor-ground",
        segment(above, ground_way("capacitor")),
        BLACK,
    ));
    wires.push(thick(
        "capacitor-supply",
        segment(below, supply_hole(1)),
        RED,
    ));
    for (number, (y, colour)) in (1..).zip(BALANCE.into_iter().zip([RED, GREY_WIRE, BLACK])) {
        let path = segment((BATTERY, y), (ALARM, y));
        wires.push(Wire::new(format!("balance-{number}"), path, colour, LEG));
    }
    wires
}

/// The terminals of the round plug, plus and minus.
fn round_plug((x, y): Point) -> [Point; 2] {
    [(x - 40.0, y - 9.0), (x - 40.0, y + 9.0)]
}

/// The ends of the capacitor's legs, minus and plus.
fn capacitor() -> [Point; 2] {
    [
        (CAPACITOR, ground_way("capacitor").1),
        (CAPACITOR, supply_hole(1).1),
    ]
}

fn draw_case(group: Group, corner: Point, size: Point, fill: &str) -> Group {
    group.add(edged(rectangle(corner, size, fill).set("rx", 5), DARK, 1.5))
}

/// Draws all parts that the wires connect.
pub fn draw(socket: Point) -> Group {
    let mut group = draw_battery(Group::new());
    group = draw_alarm(group);
    group = draw_supply_line(group);
    group = draw_converter(group);
    let [above, below] = capacitor();
    group = draw_case(
        group,
        (CAPACITOR - 9.0, above.1 + 5.0),
        (18.0, below.1 - above.1 - 10.0),
        "#dddddd",
    )
    .add(rectangle(
        (CAPACITOR - 9.0, above.1 + 5.0),
        (18.0, 7.0),
        DARK,
    ))
    .add(draw_terminal("capacitor-minus", above, DARK))
    .add(draw_terminal("capacitor-plus", below, RED))
    .add(text_start(
        "1000 µF, 10 V",
        (CAPACITOR + 8.0, above.1 - 6.0),
        13.0,
    ));
    for (words, at) in [
        ("0.5 mm\u{b2}", (300.0, 176.0)),
        ("0.25 mm\u{b2}", (140.0, 134.0)),
        ("26 AWG", (545.0, 330.0)),
    ] {
        group = group.add(text_start(words, at, 12.0));
    }
    let [plus, minus] = round_plug(socket);
    draw_case(group, (plus.0, plus.1 - 8.0), (34.0, 34.0), "#8f8f8f")
        .add(rectangle(
            (plus.0 + 34.0, socket.1 - 5.0),
            (10.0, 10.0),
            "#8f8f8f",
        ))
        .add(draw_terminal("round-plug-plus", plus, RED))
        .add(draw_terminal("round-plug-minus", minus, DARK))
        .add(text_start("round plug,", (44.0, plus.1 - 28.0), 13.0))
        .add(text_start("+ inside", (44.0, plus.1 - 13.0), 13.0))
}

fn draw_battery(group: Group) -> Group {
    let mut group = draw_case(group, (BATTERY, 18.0), (132.0, 114.0), "#f4efe2");
    for (number, top) in [(2, 30.0), (1, 82.0)] {
        group = draw_case(group, (CELLS, top), (82.0, 38.0), "white").add(text_middle(
            &format!("cell {number}: 3.7 V"),
            (CELLS + 41.0, top + 23.0),
            12.0,
        ));
    }
    let inside = |group: Group, from: Point, to: Point| group.add(line(from, to, DARK, 1.6));
    group = inside(group, (BATTERY, PLUS), (CELLS, PLUS));
    group = inside(group, (BATTERY, BALANCE[0]), (CELLS, BALANCE[0]));
    group = inside(group, (CELLS + 41.0, 68.0), (CELLS + 41.0, 82.0));
    group = inside(group, (BATTERY, BALANCE[1]), (CELLS + 41.0, BALANCE[1]));
    group = inside(group, (BATTERY, BALANCE[2]), (CELLS, BALANCE[2]));
    group = inside(group, (BATTERY, MINUS), (CELLS, MINUS));
    for (number, y) in (1..).zip(BALANCE) {
        group = group.add(draw_terminal(
            &format!("battery-balance-{number}"),
            (BATTERY, y),
            DARK,
        ));
    }
    // The plug that disconnects both wires.
    for y in [PLUS, MINUS] {
        group = group.add(edged(
            rectangle((534.0, y - 7.0), (9.0, 14.0), "#f0c808"),
            DARK,
            1.0,
        ));
    }
    group
        .add(draw_terminal("battery-plus", (BATTERY, PLUS), RED))
        .add(draw_terminal("battery-minus", (BATTERY, MINUS), DARK))
        .add(text_end("plug", (556.0, 24.0), 12.0))
        .add(text_end("battery, 7.4 V", (690.0, 147.0), 13.0))
}

fn draw_alarm(group: Group) -> Group {
    let mut group = draw_case(group, (ALARM - 92.0, 58.0), (92.0, 38.0), "#e6eef7")
        .add(text_start("low-voltage", (ALARM - 84.0, 74.0), 13.0))
        .add(text_start("alarm", (ALARM - 84.0, 90.0), 13.0))
        .add(text_end(
            "balance plug, its own wires",
            (ALARM + 26.0, 113.0),
            12.0,
        ));
    for (number, y) in (1..).zip(BALANCE) {
        group = group.add(draw_terminal(&format!("alarm-{number}"), (ALARM, y), DARK));
    }
    group
}

/// Draws the fuse, the switch and the single way after it.
fn draw_supply_line(group: Group) -> Group {
    let mut group = group;
    for ([left, right], fill) in [
        (FUSE_AT, "#fde9e9"),
        (SWITCH_AT, "#e9f3e9"),
        (WAY, "#f2f2f2"),
    ] {
        group = draw_case(group, (left, PLUS - 13.0), (right - left, 26.0), fill);
    }
    let middle = |ends: [f64; 2]| (ends[0] + ends[1]) / 2.0;
    let lever = [
        (SWITCH_AT[0] + 16.0, PLUS + 4.0),
        (SWITCH_AT[1] - 18.0, PLUS - 8.0),
    ];
    group = group
        .add(line((WAY[0], PLUS), (WAY[1], PLUS), "#c9b26b", 9.0))
        .add(line(lever[0], lever[1], DARK, 2.5))
        .add(text_middle("fuse", (middle(FUSE_AT), 20.0), 13.0))
        .add(text_middle(
            &format!("{FUSE} A"),
            (middle(FUSE_AT), PLUS + 5.0),
            14.0,
        ))
        .add(text_middle(
            &format!("switch, {SWITCH} A"),
            (middle(SWITCH_AT), 20.0),
            13.0,
        ))
        .add(text_middle("single way", (middle(WAY), 20.0), 13.0));
    let ends = [("fuse", FUSE_AT), ("switch", SWITCH_AT), ("way", WAY)];
    for (name, [left, right]) in ends {
        group = group
            .add(draw_terminal(&format!("{name}-1"), (left, PLUS), RED))
            .add(draw_terminal(&format!("{name}-2"), (right, PLUS), RED));
    }
    group
}

fn draw_converter(group: Group) -> Group {
    let [left, right] = CONVERTER;
    let middle = (left + right) / 2.0;
    draw_case(group, (left, 20.0), (right - left, 102.0), "#e3f0e3")
        .add(text_middle("converter", (middle, 66.0), 14.0))
        .add(text_middle("to 5.0 V, 3 A", (middle, 84.0), 14.0))
        .add(text_start("OUT+", (left + 8.0, PLUS + 5.0), 12.0))
        .add(text_start(
            "OUT\u{2212}",
            (left + 8.0, CONVERTER_MINUS + 5.0),
            12.0,
        ))
        .add(text_end(
            "IN+",
            (right - 8.0, CONVERTER_IN_PLUS + 5.0),
            12.0,
        ))
        .add(text_end(
            "IN\u{2212}",
            (right - 8.0, CONVERTER_MINUS + 5.0),
            12.0,
        ))
        .add(draw_terminal("converter-out-plus", (left, PLUS), RED))
        .add(draw_terminal(
            "converter-out-minus",
            (left, CONVERTER_MINUS),
            DARK,
        ))
        .add(draw_terminal(
            "converter-in-plus",
            (right, CONVERTER_IN_PLUS),
            RED,
        ))
        .add(draw_terminal(
            "converter-in-minus",
            (right, CONVERTER_MINUS),
            DARK,
        ))
}
