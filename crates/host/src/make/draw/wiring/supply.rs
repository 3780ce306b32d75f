//! The supply, from the battery's cells to the strips: plug, fuse, switch, converter, capacitor, low-voltage alarm, and
//! the board's barrel plug. Positions are in pixels and increase to the right and downwards.

use lizard_robot::{FUSE_RATING_A, MIN_SWITCH_RATING_A};
use svg::node::element::Group;

use super::strips::{ground_hole, supply_hole};
use super::wire::{
    BLACK_WIRE, GREY_WIRE, LEAD_WIDTH, THICK_WIRE_WIDTH, THIN_WIRE_WIDTH, Wire, draw_case,
    draw_terminal,
};
use crate::make::draw::route::Path;
use crate::shared::shapes::{
    DARK, RED, add_outline, line, rectangle, text_end, text_middle, text_start,
};

/// A point on the page.
type Point = (f64, f64);

/// The battery's left edge.
const BATTERY_LEFT_X: f64 = 560.0;
/// Vertical position of the battery's plus contact, the fuse, the switch, the single way (terminal) and the converter's
/// contact OUT+.
const PLUS_Y: f64 = 40.0;
/// Vertical position of the battery's minus contact.
const BATTERY_MINUS_Y: f64 = 112.0;
/// Vertical positions of the contacts on the battery's balance plug.
const BALANCE_CONTACTS_Y: [f64; 3] = [62.0, 76.0, 90.0];
/// The left edge of the battery's cells.
const CELLS_LEFT_X: f64 = 600.0;
/// The alarm's right edge.
const ALARM_RIGHT_X: f64 = 500.0;
/// Horizontal positions of the fuse's left and right contacts.
const FUSE_CONTACTS_X: [f64; 2] = [458.0, 518.0];
/// Horizontal positions of the switch's left and right contacts.
const SWITCH_CONTACTS_X: [f64; 2] = [362.0, 428.0];
/// Horizontal positions of the left and right holes of the single way after the switch.
const SINGLE_WAY_HOLES_X: [f64; 2] = [286.0, 322.0];
/// Vertical distance of the two wires at the single way's left hole from the way's middle.
const SINGLE_WAY_WIRE_OFFSET: f64 = 5.0;
/// The converter's left and right edges.
const CONVERTER_EDGES_X: [f64; 2] = [130.0, 235.0];
/// Vertical position of the converter's contact IN+.
const CONVERTER_IN_PLUS_Y: f64 = PLUS_Y - SINGLE_WAY_WIRE_OFFSET;
/// Vertical position of the converter's contacts IN- and OUT-.
const CONVERTER_MINUS_Y: f64 = 104.0;
/// The capacitor's horizontal position.
const CAPACITOR_X: f64 = 150.0;
/// Horizontal positions of the plus and minus wires down to the barrel plug.
const BARREL_PLUG_WIRES_X: [f64; 2] = [20.0, 34.0];

/// The supply's parts, each with the index of its way (terminal) on the ground strip.
const GROUND_WAYS: [(&str, usize); 5] = [
    ("battery", 0),
    ("converter-in", 1),
    ("converter-out", 2),
    ("round-plug", 3),
    ("capacitor", 4),
];

/// Index of the ground strip's first way for a servo.
pub const FIRST_SERVO_WAY: usize = GROUND_WAYS.len();

/// Returns the ground strip's wire hole for a part of the supply.
fn part_ground_hole(part_name: &str) -> Point {
    let entry = GROUND_WAYS.iter().find(|(name, _)| *name == part_name);
    ground_hole(entry.map_or(0, |(_, way)| *way))
}

/// Routes all wires of the supply; `barrel_jack` is the centre of the board's barrel jack.
pub fn route_wires(barrel_jack: Point) -> Vec<Wire> {
    let [plug_plus, plug_minus] = barrel_plug_terminals(barrel_jack);
    let [plus_x, minus_x] = BARREL_PLUG_WIRES_X;
    let [fuse_left, fuse_right] = FUSE_CONTACTS_X;
    let [switch_left, switch_right] = SWITCH_CONTACTS_X;
    let [way_left, way_right] = SINGLE_WAY_HOLES_X;
    let [converter_left, converter_right] = CONVERTER_EDGES_X;
    let way_plus = (way_left, PLUS_Y + SINGLE_WAY_WIRE_OFFSET);
    // Returns a path whose vertical segment is at `x`.
    let route_via_x = |start: Point, x: f64, end: Point| vec![start, (x, start.1), (x, end.1), end];
    let red_wire = |name: &str, path: Path| Wire::new(name, path, RED, THICK_WIRE_WIDTH);
    let straight_red_wire = |name: &str, [start_x, end_x]: [f64; 2], y: f64| {
        red_wire(name, vec![(start_x, y), (end_x, y)])
    };
    let black_wire = |part: &str, path: Path, width: f64| {
        Wire::new(format!("{part}-ground"), path, BLACK_WIRE, width)
    };
    let ground_wire = |part: &str, start: Point, x: f64| {
        let path = route_via_x(start, x, part_ground_hole(part));
        black_wire(part, path, THICK_WIRE_WIDTH)
    };
    let plug_ground_path = route_via_x(part_ground_hole("round-plug"), minus_x, plug_minus);
    let mut plug_plus_path = route_via_x(way_plus, 268.0, (plus_x, 138.0));
    plug_plus_path.extend([(plus_x, plug_plus.1), plug_plus]);
    let [upper_lead, lower_lead] = capacitor_leads();
    let capacitor_ground_path = vec![upper_lead, part_ground_hole("capacitor")];
    let converter_supply_path = route_via_x((converter_left, PLUS_Y), 106.0, supply_hole(0));
    let converter_input_xs = [way_left, converter_right];
    let mut wires = vec![
        straight_red_wire("battery-fuse", [BATTERY_LEFT_X, fuse_right], PLUS_Y),
        straight_red_wire("fuse-switch", [fuse_left, switch_right], PLUS_Y),
        straight_red_wire("switch-way", [switch_left, way_right], PLUS_Y),
        straight_red_wire("way-converter", converter_input_xs, CONVERTER_IN_PLUS_Y),
        ground_wire("battery", (BATTERY_LEFT_X, BATTERY_MINUS_Y), 546.0),
        ground_wire("converter-in", (converter_right, CONVERTER_MINUS_Y), 252.0),
        ground_wire("converter-out", (converter_left, CONVERTER_MINUS_Y), 119.0),
        red_wire("converter-supply", converter_supply_path),
        Wire::new("round-plug-plus", plug_plus_path, RED, THIN_WIRE_WIDTH),
        black_wire("round-plug", plug_ground_path, THIN_WIRE_WIDTH),
        black_wire("capacitor", capacitor_ground_path, THICK_WIRE_WIDTH),
        red_wire("capacitor-supply", vec![lower_lead, supply_hole(1)]),
    ];
    let colours = [RED, GREY_WIRE, BLACK_WIRE];
    for (number, (y, colour)) in (1..).zip(BALANCE_CONTACTS_Y.into_iter().zip(colours)) {
        let path = vec![(BATTERY_LEFT_X, y), (ALARM_RIGHT_X, y)];
        let name = format!("balance-{number}");
        wires.push(Wire::new(name, path, colour, LEAD_WIDTH));
    }
    wires
}

/// Returns the barrel plug's terminals, plus and minus.
fn barrel_plug_terminals((x, y): Point) -> [Point; 2] {
    [(x - 40.0, y - 9.0), (x - 40.0, y + 9.0)]
}

/// Returns the ends of the capacitor's leads, minus and plus.
fn capacitor_leads() -> [Point; 2] {
    [
        (CAPACITOR_X, part_ground_hole("capacitor").1),
        (CAPACITOR_X, supply_hole(1).1),
    ]
}

/// Draws all parts of the supply; `barrel_jack` is the centre of the board's barrel jack.
pub fn draw(barrel_jack: Point) -> Group {
    let mut group = draw_alarm(draw_battery(Group::new()));
    group = draw_converter(draw_fuse_switch_and_way(group));
    let [upper_lead, lower_lead] = capacitor_leads();
    let corner = (CAPACITOR_X - 9.0, upper_lead.1 + 5.0);
    let size = (18.0, lower_lead.1 - upper_lead.1 - 10.0);
    let label_point = (CAPACITOR_X + 8.0, upper_lead.1 - 6.0);
    group = draw_case(group, corner, size, "#dddddd")
        .add(rectangle(corner, (18.0, 7.0), DARK))
        .add(draw_terminal("capacitor-minus", upper_lead, DARK))
        .add(draw_terminal("capacitor-plus", lower_lead, RED))
        .add(text_start("1000 µF, 10 V", label_point, 13.0));
    for (label, point) in [
        ("0.5 mm\u{b2}", (300.0, 176.0)),
        ("0.25 mm\u{b2}", (140.0, 134.0)),
        ("26 AWG", (545.0, 330.0)),
    ] {
        group = group.add(text_start(label, point, 12.0));
    }
    let [plus, minus] = barrel_plug_terminals(barrel_jack);
    let tip_corner = (plus.0 + 34.0, barrel_jack.1 - 5.0);
    draw_case(group, (plus.0, plus.1 - 8.0), (34.0, 34.0), "#8f8f8f")
        .add(rectangle(tip_corner, (10.0, 10.0), "#8f8f8f"))
        .add(draw_terminal("round-plug-plus", plus, RED))
        .add(draw_terminal("round-plug-minus", minus, DARK))
        .add(text_start("barrel plug,", (44.0, plus.1 - 28.0), 13.0))
        .add(text_start("+ inside", (44.0, plus.1 - 13.0), 13.0))
}

fn draw_battery(group: Group) -> Group {
    let mut group = draw_case(group, (BATTERY_LEFT_X, 18.0), (132.0, 114.0), "#f4efe2");
    let cell_middle_x = CELLS_LEFT_X + 41.0;
    for (number, top) in [(2, 30.0), (1, 82.0)] {
        let label = format!("cell {number}: 3.7 V");
        let label_text = text_middle(&label, (cell_middle_x, top + 23.0), 12.0);
        group = draw_case(group, (CELLS_LEFT_X, top), (82.0, 38.0), "white").add(label_text);
    }
    let line_to = |x: f64, y: f64| line((BATTERY_LEFT_X, y), (x, y), DARK, 1.6);
    let cell_link = line((cell_middle_x, 68.0), (cell_middle_x, 82.0), DARK, 1.6);
    group = group
        .add(line_to(CELLS_LEFT_X, PLUS_Y))
        .add(line_to(CELLS_LEFT_X, BALANCE_CONTACTS_Y[0]))
        .add(cell_link)
        .add(line_to(cell_middle_x, BALANCE_CONTACTS_Y[1]))
        .add(line_to(CELLS_LEFT_X, BALANCE_CONTACTS_Y[2]))
        .add(line_to(CELLS_LEFT_X, BATTERY_MINUS_Y));
    for (number, y) in (1..).zip(BALANCE_CONTACTS_Y) {
        let name = format!("battery-balance-{number}");
        group = group.add(draw_terminal(&name, (BATTERY_LEFT_X, y), DARK));
    }
    // The plug disconnects both wires, so it is drawn on each.
    for y in [PLUS_Y, BATTERY_MINUS_Y] {
        let plug = rectangle((534.0, y - 7.0), (9.0, 14.0), "#f0c808");
        group = group.add(add_outline(plug, DARK, 1.0));
    }
    let minus_point = (BATTERY_LEFT_X, BATTERY_MINUS_Y);
    group
        .add(draw_terminal("battery-plus", (BATTERY_LEFT_X, PLUS_Y), RED))
        .add(draw_terminal("battery-minus", minus_point, DARK))
        .add(text_end("plug", (556.0, 24.0), 12.0))
        .add(text_end("battery, 7.4 V", (690.0, 147.0), 13.0))
}

fn draw_alarm(group: Group) -> Group {
    let label_x = ALARM_RIGHT_X - 84.0;
    let note_point = (ALARM_RIGHT_X + 26.0, 113.0);
    let mut group = draw_case(group, (ALARM_RIGHT_X - 92.0, 58.0), (92.0, 38.0), "#e6eef7")
        .add(text_start("low-voltage", (label_x, 74.0), 13.0))
        .add(text_start("alarm", (label_x, 90.0), 13.0))
        .add(text_end("balance plug, its own wires", note_point, 12.0));
    for (number, y) in (1..).zip(BALANCE_CONTACTS_Y) {
        let name = format!("alarm-{number}");
        group = group.add(draw_terminal(&name, (ALARM_RIGHT_X, y), DARK));
    }
    group
}

/// Draws the fuse, the switch and the single way.
fn draw_fuse_switch_and_way(mut group: Group) -> Group {
    for ([left, right], fill) in [
        (FUSE_CONTACTS_X, "#fde9e9"),
        (SWITCH_CONTACTS_X, "#e9f3e9"),
        (SINGLE_WAY_HOLES_X, "#f2f2f2"),
    ] {
        group = draw_case(group, (left, PLUS_Y - 13.0), (right - left, 26.0), fill);
    }
    let middle = |ends: [f64; 2]| (ends[0] + ends[1]) / 2.0;
    let lever_start = (SWITCH_CONTACTS_X[0] + 16.0, PLUS_Y + 4.0);
    let lever_end = (SWITCH_CONTACTS_X[1] - 18.0, PLUS_Y - 8.0);
    let [way_left, way_right] = SINGLE_WAY_HOLES_X.map(|x| (x, PLUS_Y));
    group = group
        .add(line(way_left, way_right, "#c9b26b", 9.0))
        .add(line(lever_start, lever_end, DARK, 2.5));
    let fuse_rating = format!("{FUSE_RATING_A} A");
    let switch_label = format!("switch, {MIN_SWITCH_RATING_A} A");
    for (label, ends, y, size) in [
        ("fuse", FUSE_CONTACTS_X, 20.0, 13.0),
        (&fuse_rating, FUSE_CONTACTS_X, PLUS_Y + 5.0, 14.0),
        (&switch_label, SWITCH_CONTACTS_X, 20.0, 13.0),
        ("single way", SINGLE_WAY_HOLES_X, 20.0, 13.0),
    ] {
        group = group.add(text_middle(label, (middle(ends), y), size));
    }
    let parts = [
        ("fuse", FUSE_CONTACTS_X),
        ("switch", SWITCH_CONTACTS_X),
        ("way", SINGLE_WAY_HOLES_X),
    ];
    for (name, [left, right]) in parts {
        group = group
            .add(draw_terminal(&format!("{name}-1"), (left, PLUS_Y), RED))
            .add(draw_terminal(&format!("{name}-2"), (right, PLUS_Y), RED));
    }
    group
}

fn draw_converter(group: Group) -> Group {
    let [left, right] = CONVERTER_EDGES_X;
    let middle_x = (left + right) / 2.0;
    let label_y = |y: f64| y + 5.0;
    let (left_label_x, right_label_x) = (left + 8.0, right - 8.0);
    let minus_label_y = label_y(CONVERTER_MINUS_Y);
    let in_plus_label_point = (right_label_x, label_y(CONVERTER_IN_PLUS_Y));
    let out_minus_label_point = (left_label_x, minus_label_y);
    let mut group = draw_case(group, (left, 20.0), (right - left, 102.0), "#e3f0e3")
        .add(text_middle("converter", (middle_x, 66.0), 14.0))
        .add(text_middle("to 5.0 V, 3 A", (middle_x, 84.0), 14.0))
        .add(text_start("OUT+", (left_label_x, label_y(PLUS_Y)), 12.0))
        .add(text_start("OUT\u{2212}", out_minus_label_point, 12.0))
        .add(text_end("IN+", in_plus_label_point, 12.0))
        .add(text_end("IN\u{2212}", (right_label_x, minus_label_y), 12.0));
    for (name, point, colour) in [
        ("converter-out-plus", (left, PLUS_Y), RED),
        ("converter-out-minus", (left, CONVERTER_MINUS_Y), DARK),
        ("converter-in-plus", (right, CONVERTER_IN_PLUS_Y), RED),
        ("converter-in-minus", (right, CONVERTER_MINUS_Y), DARK),
    ] {
        group = group.add(draw_terminal(name, point, colour));
    }
    group
}
