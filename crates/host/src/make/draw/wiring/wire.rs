//! A wire of the drawing, and the terminals that it connects.
//!
//! Wires have horizontal and vertical parts only. Each is drawn with a white edge, which leaves a gap in an earlier
//! wire where it crosses it. Without the gap the crossing would look like a joint.

use svg::node::element::{Circle, Group};

use crate::make::draw::route::Path;
use crate::shared::ink::{circle, curve, edged};

/// The colour of black wires.
pub const BLACK: &str = "#1b1b1b";
/// The colour of a balance plug's middle wire.
pub const GREY_WIRE: &str = "#9a9a9a";

/// Widths, pixels: a wire of 0.5 mm2, a thin jumper (`THIN`), and a lead that belongs to a component or the battery
/// and is not bought as a wire (`LEG`).
pub const THICK: f64 = 4.5;
/// See [`THICK`].
pub const THIN: f64 = 2.8;
/// See [`THICK`].
pub const LEG: f64 = 1.8;

/// A wire or a leg by its name, path, colour and width.
pub struct Wire {
    pub name: String,
    pub path: Path,
    pub colour: &'static str,
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

    pub fn draw(&self) -> Group {
        let gap = curve(&self.path, "white", self.width + 5.0).set("stroke-linecap", "butt");
        let wire = curve(&self.path, self.colour, self.width);
        Group::new().add(gap).add(wire.set("id", self.name.clone()))
    }
}

/// A terminal, where a wire ends.
pub fn draw_terminal(name: &str, point: (f64, f64), colour: &str) -> Circle {
    edged(circle(point, 4.5, "#e9e4d8"), colour, 2.0).set("id", format!("end-{name}"))
}
