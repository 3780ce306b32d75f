//! The panel with the optional push button and obstacle switch, drawn if robot.toml has `[input]`.
//!
//! An active button or switch pulls its pin low. Otherwise the board's own pull-up holds the pin
//! high, so no resistor is needed.

use lizard_robot::Robot;
use svg::node::element::Group;

use super::wire::{BLACK, THIN_WIDTH, draw_terminal};
use crate::shared::ink::{
    DARK, GREY, ORANGE, RED, circle, curve, line, outlined, pin_name, rectangle, text_end,
    text_start,
};

/// Height of the panel, pixels.
const PANEL_HEIGHT: f64 = 214.0;
/// Horizontal position of the board's pins, pixels.
const BOARD_PINS_X: f64 = 120.0;
/// Horizontal position of the pins of the button and of the obstacle switch, pixels.
const COMPONENT_PINS_X: f64 = 400.0;
/// Distance between neighbouring rows, pixels.
const ROW_HEIGHT: f64 = 26.0;
/// Distance of the button's first row from the panel's top, pixels.
const BUTTON_ROW_Y: f64 = 58.0;
/// Distance of the obstacle switch's first row from the panel's top, pixels.
const OBSTACLE_SWITCH_ROW_Y: f64 = 122.0;

/// Height of the panel for a robot, pixels; 0 if the robot has no inputs.
pub fn panel_height(robot: &Robot) -> f64 {
    match robot.inputs().named_pins().count() {
        0 => 0.0,
        _ => PANEL_HEIGHT,
    }
}

/// Draws the panel with its upper edge at y = `top`.
pub fn draw(robot: &Robot, top: f64) -> Group {
    let frame = rectangle((16.0, top), (668.0, PANEL_HEIGHT - 12.0), "#fbfbf4").set("rx", 8);
    let frame = outlined(frame, GREY, 1.5).set("stroke-dasharray", "7 5");
    let title = "Option: inputs, for routines that wait or turn away";
    let mut group = Group::new()
        .add(frame)
        .add(text_start(title, (30.0, top + 26.0), 15.0).set("font-weight", "bold"));
    for (name, pin) in robot.inputs().named_pins() {
        group = match name {
            "button" => draw_button(group, pin, top + BUTTON_ROW_Y),
            _ => draw_obstacle_switch(group, pin, top + OBSTACLE_SWITCH_ROW_Y),
        };
    }
    group
}

/// Draws a wire from the board to a component; `names` are the component, the board's pin, and a label.
fn draw_wire(group: Group, names: [&str; 3], y: f64, colour: &'static str) -> Group {
    let [component, board_pin, label] = names;
    // The wire crosses no other wire, so it needs no white edge, which would cut the component's outline.
    let path = curve(
        &[(BOARD_PINS_X, y), (COMPONENT_PINS_X, y)],
        colour,
        THIN_WIDTH,
    );
    group
        .add(path.set("id", format!("input-{component}-{board_pin}")))
        .add(text_end(
            &format!("UNO {board_pin}"),
            (BOARD_PINS_X - 10.0, y + 5.0),
            13.0,
        ))
        .add(text_start(label, (COMPONENT_PINS_X + 40.0, y + 5.0), 13.0))
        .add(draw_terminal(
            &format!("{component}-{board_pin}"),
            (BOARD_PINS_X, y),
            DARK,
        ))
        .add(draw_terminal(
            &format!("{component}-at-{board_pin}"),
            (COMPONENT_PINS_X, y),
            DARK,
        ))
}

/// Draws a push button between its pin, at y = `y`, and ground.
fn draw_button(group: Group, pin: u8, y: f64) -> Group {
    let case = rectangle(
        (COMPONENT_PINS_X - 12.0, y - 14.0),
        (44.0, ROW_HEIGHT + 28.0),
        "#e6eef7",
    )
    .set("rx", 5);
    let middle_y = y + ROW_HEIGHT / 2.0;
    let group = group
        .add(outlined(case, DARK, 1.5))
        .add(line(
            (COMPONENT_PINS_X, y),
            (COMPONENT_PINS_X + 16.0, y),
            DARK,
            THIN_WIDTH,
        ))
        .add(line(
            (COMPONENT_PINS_X, y + ROW_HEIGHT),
            (COMPONENT_PINS_X + 16.0, y + ROW_HEIGHT),
            DARK,
            THIN_WIDTH,
        ))
        .add(outlined(
            circle((COMPONENT_PINS_X + 20.0, middle_y), 8.0, "white"),
            DARK,
            1.5,
        ));
    let group = draw_wire(
        group,
        ["button", &pin_name(pin), "push button, closes when pressed"],
        y,
        ORANGE,
    );
    draw_wire(
        group,
        ["button", "GND", "its other contact"],
        y + ROW_HEIGHT,
        BLACK,
    )
}

/// Draws the infrared obstacle switch of the robot's nose, with its first row at y = `y`.
fn draw_obstacle_switch(group: Group, pin: u8, y: f64) -> Group {
    let case = rectangle(
        (COMPONENT_PINS_X - 12.0, y - 14.0),
        (44.0, 2.0 * ROW_HEIGHT + 28.0),
        "#e6eef7",
    )
    .set("rx", 5);
    let group = group.add(outlined(case, DARK, 1.5));
    let group = draw_wire(
        group,
        [
            "nose",
            &pin_name(pin),
            "OUT of the obstacle switch, low at a wall",
        ],
        y,
        ORANGE,
    );
    let group = draw_wire(group, ["nose", "GND", "GND"], y + ROW_HEIGHT, BLACK);
    draw_wire(
        group,
        ["nose", "5V", "VCC, 3.3 to 5 V, at most 40 mA"],
        y + 2.0 * ROW_HEIGHT,
        RED,
    )
}
