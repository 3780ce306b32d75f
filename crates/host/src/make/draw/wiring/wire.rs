//! A wire of the drawing, and the terminals that it connects.
//!
//! Wires have horizontal and vertical parts only. Each is drawn with a white edge, which leaves a gap in the
//! earlier wires that it crosses. Without the gap a crossing would look like a joint.

use svg::node::element::{Circle, Group, Rectangle};

use crate::make::draw::route::Path;
use crate::shared::ink::{DARK, GREY, circle, curve, outlined, rectangle, text_start};

/// The colour of black wires.
pub const BLACK: &str = "#1b1b1b";
/// The colour of a balance plug's middle wire.
pub const GREY_WIRE: &str = "#9a9a9a";

/// Width of a wire of 0.5 mm2 on the page, pixels.
pub const THICK_WIDTH: f64 = 4.5;
/// Width of a thin jumper on the page, pixels.
pub const THIN_WIDTH: f64 = 2.8;
/// Width of a component's leg or of a wire that is part of the battery's balance plug, pixels.
pub const LEG_WIDTH: f64 = 1.8;

/// A wire or a component's leg: its name, path, colour and width.
pub struct Wire {
    pub name: String,
    pub path: Path,
    pub colour: &'static str,
    /// Width on the page, pixels.
    pub width: f64,
}

impl Wire {
    pub fn new(name: impl Into<String>, path: Path, colour: &'static str, width: f64) -> Self {
        Self {
            name: name.into(),
            path,
            colour,
            width,
        }
    }

    /// Draws the wire over a wider white one.
    pub fn draw(&self) -> Group {
        let gap = curve(&self.path, "white", self.width + 5.0).set("stroke-linecap", "butt");
        let wire = curve(&self.path, self.colour, self.width);
        Group::new().add(gap).add(wire.set("id", self.name.clone()))
    }
}

/// Draws the frame and the title of a panel with an option, with its upper edge at y = `top`.
pub fn draw_option_panel(top: f64, height: f64, title: &str) -> Group {
    let frame = rectangle((16.0, top), (668.0, height - 12.0), "#fbfbf4").set("rx", 8);
    let title = text_start(title, (30.0, top + 26.0), 15.0);
    Group::new()
        .add(outlined(frame, GREY, 1.5).set("stroke-dasharray", "7 5"))
        .add(title.set("font-weight", "bold"))
}

/// Draws the body of a resistor by its centre and its size.
pub fn draw_resistor((x, y): (f64, f64), (width, height): (f64, f64)) -> Rectangle {
    let corner = (x - width / 2.0, y - height / 2.0);
    let body = rectangle(corner, (width, height), "#f3e3c3").set("rx", 2);
    outlined(body, DARK, 1.5)
}

/// Draws a terminal, at which a wire ends.
pub fn draw_terminal(name: &str, point: (f64, f64), colour: &str) -> Circle {
    outlined(circle(point, 4.5, "#e9e4d8"), colour, 2.0).set("id", format!("end-{name}"))
}
