//! A wire in the drawing, and its terminals.
//!
//! Wires have only horizontal and vertical segments. A wire is drawn with a white halo, which leaves a gap in the wires
//! below. Without the gap, a crossing would look like a junction.

use svg::node::element::{Circle, Group, Rectangle};

use crate::make::draw::route::Path;
use crate::shared::shapes::{DARK, GREY, add_outline, circle, curve, rectangle, text_start};

/// The colour of black wires.
pub const BLACK_WIRE: &str = "#1b1b1b";
/// The colour of a balance plug's middle wire.
pub const GREY_WIRE: &str = "#9a9a9a";

/// Stroke width of a 0.5 mm2 wire, pixels.
pub const THICK_WIRE_WIDTH: f64 = 4.5;
/// Stroke width of a thin jumper, pixels.
pub const THIN_WIRE_WIDTH: f64 = 2.8;
/// Stroke width of a component's lead or a balance plug's wire, pixels.
pub const LEAD_WIDTH: f64 = 1.8;

/// A wire or a component's lead.
pub struct Wire {
    /// The id of its SVG element.
    pub name: String,
    pub path: Path,
    pub colour: &'static str,
    /// Stroke width, pixels.
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

    /// Draws the wire on top of a wider white line.
    pub fn draw(&self) -> Group {
        let halo = curve(&self.path, "white", self.width + 5.0).set("stroke-linecap", "butt");
        let wire = curve(&self.path, self.colour, self.width);
        Group::new()
            .add(halo)
            .add(wire.set("id", self.name.clone()))
    }
}

/// Draws the frame and title of a panel that shows a wiring option; its upper edge is at `top`.
pub fn draw_option_panel(top: f64, height: f64, title: &str) -> Group {
    let frame = rectangle((16.0, top), (668.0, height - 12.0), "#fbfbf4").set("rx", 8);
    let title = text_start(title, (30.0, top + 26.0), 15.0);
    Group::new()
        .add(add_outline(frame, GREY, 1.5).set("stroke-dasharray", "7 5"))
        .add(title.set("font-weight", "bold"))
}

/// Draws a component's case from its upper left corner and size.
pub fn draw_case(group: Group, corner: (f64, f64), size: (f64, f64), fill: &str) -> Group {
    let case = rectangle(corner, size, fill).set("rx", 5);
    group.add(add_outline(case, DARK, 1.5))
}

/// Draws a resistor's body from its centre and size.
pub fn draw_resistor((x, y): (f64, f64), (width, height): (f64, f64)) -> Rectangle {
    let corner = (x - width / 2.0, y - height / 2.0);
    let body = rectangle(corner, (width, height), "#f3e3c3").set("rx", 2);
    add_outline(body, DARK, 1.5)
}

/// Draws a terminal at the end of a wire.
pub fn draw_terminal(name: &str, point: (f64, f64), colour: &str) -> Circle {
    add_outline(circle(point, 4.5, "#e9e4d8"), colour, 2.0).set("id", format!("end-{name}"))
}
