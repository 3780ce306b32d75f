//! The panel with an optional radio module that shares the board's serial line with the USB chip.
//!
//! The module and the USB chip both drive pin D0, and both hold it high while they are silent. The USB chip drives D0
//! through 1 kOhm; a module wired directly to D0 therefore overrides the chip, and uploads fail. With a diode, the
//! module can only pull D0 low. The module's input needs 3.3 V, which a divider derives from the board's 5 V.

use svg::node::element::{Group, Polygon};

use super::wire::{
    BLACK_WIRE, LEAD_WIDTH, THIN_WIRE_WIDTH, Wire, draw_case, draw_option_panel, draw_resistor,
    draw_terminal,
};
use crate::shared::shapes::{
    DARK, ORANGE, RED, circle, curve, line, text_end, text_middle, text_start,
};

/// Height of the panel, pixels.
pub const PANEL_HEIGHT: f64 = 246.0;
/// Horizontal position of the board's pins, pixels.
const BOARD_PINS_X: f64 = 120.0;
/// Horizontal position of the module's pins, pixels.
const MODULE_PINS_X: f64 = 500.0;
/// Horizontal position of the diode, pixels.
const DIODE_X: f64 = 300.0;
/// Horizontal position of the divider's upper resistor, pixels.
const UPPER_RESISTOR_X: f64 = 260.0;
/// Horizontal position of the divider's tap and lower resistor, pixels.
const DIVIDER_X: f64 = 390.0;
/// The panel's rows: the board's pin, the module's pin, and the distance below the panel's top, pixels.
const ROWS: [(&str, &str, f64); 4] = [
    ("D0 (RX)", "TXD", 64.0),
    ("D1 (TX)", "RXD", 102.0),
    ("GND", "GND", 154.0),
    ("5V", "VCC", 182.0),
];

/// Draws the panel with its upper edge at `top`.
pub fn draw(top: f64) -> Group {
    let row_y = |row: usize| top + ROWS[row].2;
    let row_wire = |name, row: usize, [start_x, end_x]: [f64; 2], colour| {
        let path = vec![(start_x, row_y(row)), (end_x, row_y(row))];
        Wire::new(name, path, colour, THIN_WIRE_WIDTH)
    };
    let divider_path = vec![(DIVIDER_X, row_y(1)), (DIVIDER_X, row_y(2))];
    let resistor_ends = [UPPER_RESISTOR_X - 14.0, UPPER_RESISTOR_X + 14.0];
    let wires = [
        row_wire("radio-d0", 0, [BOARD_PINS_X, DIODE_X - 12.0], ORANGE),
        row_wire("radio-txd", 0, [DIODE_X + 12.0, MODULE_PINS_X], ORANGE),
        row_wire("radio-d1", 1, [BOARD_PINS_X, resistor_ends[0]], ORANGE),
        row_wire("radio-rxd", 1, [resistor_ends[1], MODULE_PINS_X], ORANGE),
        Wire::new("radio-2k", divider_path, DARK, LEAD_WIDTH),
        row_wire("radio-ground", 2, [BOARD_PINS_X, MODULE_PINS_X], BLACK_WIRE),
        row_wire("radio-vcc", 3, [BOARD_PINS_X, MODULE_PINS_X], RED),
    ];
    let title = "Option: a radio module, to drive without a cable";
    let mut group = draw_option_panel(top, PANEL_HEIGHT, title);
    // These wires cross nothing, and the white halo of `Wire::draw` would cut the frame.
    for wire in wires {
        let path = curve(&wire.path, wire.colour, wire.width);
        group = group.add(path.set("id", wire.name));
    }
    group = draw_diode(group, (DIODE_X, row_y(0)));
    let upper_label_point = (UPPER_RESISTOR_X, row_y(1) - 10.0);
    let lower_resistor = (DIVIDER_X, (row_y(1) + row_y(2)) / 2.0);
    let lower_label_point = (DIVIDER_X + 12.0, lower_resistor.1 + 5.0);
    let diode_label_point = (DIODE_X, row_y(0) - 13.0);
    group = group
        .add(draw_resistor((UPPER_RESISTOR_X, row_y(1)), (28.0, 10.0)))
        .add(text_middle("1 k\u{3a9}", upper_label_point, 13.0))
        .add(draw_resistor(lower_resistor, (10.0, 26.0)))
        .add(text_start("2 k\u{3a9}", lower_label_point, 13.0))
        .add(circle((DIVIDER_X, row_y(1)), 4.5, ORANGE))
        .add(circle((DIVIDER_X, row_y(2)), 4.5, BLACK_WIRE))
        .add(text_middle("1N4148 or BAT85", diode_label_point, 13.0));
    let module_text = text_end("HM-10, HC-05", (MODULE_PINS_X + 142.0, top + 126.0), 13.0);
    let corner = (MODULE_PINS_X, top + 42.0);
    group = draw_case(group, corner, (150.0, 160.0), "#e6eef7").add(module_text);
    for (pin, module_pin, offset) in ROWS {
        let y = top + offset;
        let [board_label_x, module_label_x] = [BOARD_PINS_X - 10.0, MODULE_PINS_X + 10.0];
        let module_terminal = format!("radio-module-{module_pin}");
        group = group
            .add(text_end(
                &format!("UNO {pin}"),
                (board_label_x, y + 5.0),
                13.0,
            ))
            .add(text_start(module_pin, (module_label_x, y + 5.0), 13.0))
            .add(draw_terminal(
                &format!("radio-{pin}"),
                (BOARD_PINS_X, y),
                DARK,
            ))
            .add(draw_terminal(&module_terminal, (MODULE_PINS_X, y), DARK));
    }
    let note = "The diode's stripe is at the module. It lets the module only pull D0 low, so USB still works.";
    group.add(text_start(note, (30.0, top + 220.0), 13.0))
}

/// Draws a diode that conducts from left to right, with its stripe at the right.
fn draw_diode(group: Group, (x, y): (f64, f64)) -> Group {
    let [left, upper, lower, tip] = [x - 12.0, y - 9.0, y + 9.0, x + 8.0];
    let corners = format!("{left},{upper} {left},{lower} {tip},{y}");
    group
        .add(line((x - 12.0, y), (x + 12.0, y), DARK, LEAD_WIDTH))
        .add(Polygon::new().set("points", corners).set("fill", DARK))
        .add(line((x + 9.0, y - 9.0), (x + 9.0, y + 9.0), DARK, 3.0))
        .add(draw_terminal("diode-anode", (x - 12.0, y), DARK))
        .add(draw_terminal("diode-cathode", (x + 12.0, y), DARK))
}
