//! The panel with the optional push button and obstacle switch, drawn if robot.toml has `[input]`.
//!
//! An active button or switch pulls its pin low. Otherwise the microcontroller's internal pull-up holds the pin high,
//! so no resistor is needed.

use lizard_robot::Robot;
use svg::node::element::Group;

use super::wire::{BLACK_WIRE, THIN_WIRE_WIDTH, draw_case, draw_option_panel, draw_terminal};
use crate::shared::shapes::{
    DARK, ORANGE, RED, add_outline, circle, curve, line, pin_name, text_end, text_start,
};

/// Height of the panel, pixels.
const PANEL_HEIGHT: f64 = 214.0;
/// Horizontal position of the board's pins, pixels.
const BOARD_PINS_X: f64 = 120.0;
/// Horizontal position of the pins on the button and the obstacle switch, pixels.
const COMPONENT_PINS_X: f64 = 400.0;
/// Distance between neighbouring rows, pixels.
const ROW_HEIGHT: f64 = 26.0;
/// Distance of the button's first row from the panel's top, pixels.
const BUTTON_ROW_Y: f64 = 58.0;
/// Distance of the obstacle switch's first row from the panel's top, pixels.
const OBSTACLE_SWITCH_ROW_Y: f64 = 122.0;

/// Returns the height of a robot's panel, pixels; 0 if the robot has no inputs.
pub fn panel_height(robot: &Robot) -> f64 {
    match robot.inputs().named_pins().count() {
        0 => 0.0,
        _ => PANEL_HEIGHT,
    }
}

/// Draws the panel with its upper edge at `top`.
pub fn draw(robot: &Robot, top: f64) -> Group {
    let title = "Option: inputs, for routines that wait or avoid obstacles";
    let mut group = draw_option_panel(top, PANEL_HEIGHT, title);
    for (name, pin) in robot.inputs().named_pins() {
        group = match name {
            "button" => draw_button(group, pin, top + BUTTON_ROW_Y),
            _ => draw_obstacle_switch(group, pin, top + OBSTACLE_SWITCH_ROW_Y),
        };
    }
    group
}

/// Draws a labelled wire from a pin of the board to a component.
fn draw_wire(
    group: Group,
    [component, board_pin, label]: [&str; 3],
    y: f64,
    colour: &'static str,
) -> Group {
    // The wire crosses no other wire and needs no white halo, which would cut into the component's outline.
    let ends = [(BOARD_PINS_X, y), (COMPONENT_PINS_X, y)];
    let path = curve(&ends, colour, THIN_WIRE_WIDTH);
    let board_label = format!("UNO {board_pin}");
    let board_terminal = format!("{component}-{board_pin}");
    let component_terminal = format!("{component}-at-{board_pin}");
    group
        .add(path.set("id", format!("input-{component}-{board_pin}")))
        .add(text_end(&board_label, (BOARD_PINS_X - 10.0, y + 5.0), 13.0))
        .add(text_start(label, (COMPONENT_PINS_X + 40.0, y + 5.0), 13.0))
        .add(draw_terminal(&board_terminal, ends[0], DARK))
        .add(draw_terminal(&component_terminal, ends[1], DARK))
}

/// Draws a component's case around its rows: the first at `y`, the last `height` below.
fn draw_case_around(group: Group, y: f64, height: f64) -> Group {
    let corner = (COMPONENT_PINS_X - 12.0, y - 14.0);
    draw_case(group, corner, (44.0, height + 28.0), "#e6eef7")
}

/// Draws a push button between its pin, at `y`, and ground.
fn draw_button(group: Group, pin: u8, y: f64) -> Group {
    let draw_contact = |y: f64| {
        let (start, end) = ((COMPONENT_PINS_X, y), (COMPONENT_PINS_X + 16.0, y));
        line(start, end, DARK, THIN_WIRE_WIDTH)
    };
    let middle = (COMPONENT_PINS_X + 20.0, y + ROW_HEIGHT / 2.0);
    let group = draw_case_around(group, y, ROW_HEIGHT)
        .add(draw_contact(y))
        .add(draw_contact(y + ROW_HEIGHT))
        .add(add_outline(circle(middle, 8.0, "white"), DARK, 1.5));
    let names = ["button", &pin_name(pin), "push button, closes when pressed"];
    let group = draw_wire(group, names, y, ORANGE);
    let names = ["button", "GND", "other contact"];
    draw_wire(group, names, y + ROW_HEIGHT, BLACK_WIRE)
}

/// Draws the infrared obstacle switch on the robot's nose, with its first row at `y`.
fn draw_obstacle_switch(group: Group, pin: u8, y: f64) -> Group {
    let group = draw_case_around(group, y, 2.0 * ROW_HEIGHT);
    let label = "OUT of the obstacle switch, low at an obstacle";
    let group = draw_wire(group, ["nose", &pin_name(pin), label], y, ORANGE);
    let group = draw_wire(group, ["nose", "GND", "GND"], y + ROW_HEIGHT, BLACK_WIRE);
    let names = ["nose", "5V", "VCC, 3.3 to 5 V, at most 40 mA"];
    draw_wire(group, names, y + 2.0 * ROW_HEIGHT, RED)
}
