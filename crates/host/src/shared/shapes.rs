//! Colours and basic shapes of all drawings. Points are (x, y) on the page, with y downwards; all lengths are in px.

use svg::node::Value;
use svg::node::element::{Circle, Group, Line, Polyline, Rectangle, Text};
use svg::{Document, Node};

/// Colours of servos A1 to A4 and their legs: three colours by Okabe and Ito, and a purple by Tol. Colour-blind
/// people can distinguish them.
pub const SERVO_COLOURS: [&str; 4] = ["#0072b2", "#d55e00", "#009e73", "#aa4499"];
/// Positions of servos A1 to A4 on the robot.
pub const SERVO_POSITIONS: [&str; 4] = ["front left", "front right", "back right", "back left"];
/// The colour of text and axes.
pub const DARK: &str = "#222222";
/// The colour of secondary text.
pub const GREY: &str = "#666666";
/// The colour of grid lines.
pub const GRID_COLOUR: &str = "#dddddd";
/// The colour of a signal wire. In grey print, signal wires are light, +5 V wires medium, and ground wires dark.
pub const ORANGE: &str = "#e8930c";
/// The colour of the +5 V wire; see [`ORANGE`].
pub const RED: &str = "#e5383b";
/// The colour of the ground wire; see [`ORANGE`].
pub const BROWN: &str = "#3d2210";
/// The background colour of panels.
pub const PANEL_COLOUR: &str = "#f7f7f7";

/// The fonts, in order of preference.
const FONTS: &str = "Helvetica, Arial, 'DejaVu Sans', sans-serif";

/// The part of a text that lies at a given point.
#[derive(Clone, Copy)]
pub enum Anchor {
    /// The text begins at the point.
    Start,
    /// The middle of the text is at the point.
    Middle,
    /// The text ends at the point.
    End,
}

/// Returns a line of text. `point` is on the text's baseline, at the part that `anchor` names.
pub fn text(content: &str, point: (f64, f64), size: f64, colour: &str, anchor: Anchor) -> Text {
    let anchor = match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    Text::new(content)
        .set("x", round_hundredths(point.0))
        .set("y", round_hundredths(point.1))
        .set("font-size", size)
        .set("font-family", FONTS)
        .set("fill", colour)
        .set("text-anchor", anchor)
}

/// Returns dark text that starts at a point.
pub fn text_start(content: &str, point: (f64, f64), size: f64) -> Text {
    text(content, point, size, DARK, Anchor::Start)
}

/// Returns dark text centred on a point.
pub fn text_middle(content: &str, point: (f64, f64), size: f64) -> Text {
    text(content, point, size, DARK, Anchor::Middle)
}

/// Returns dark text that ends at a point.
pub fn text_end(content: &str, point: (f64, f64), size: f64) -> Text {
    text(content, point, size, DARK, Anchor::End)
}

/// Adds the title of a picture, with a note below the title.
pub fn add_title(group: Group, left: f64, heading: &str, note: &str) -> Group {
    group
        .add(text_start(heading, (left, 40.0), 24.0).set("font-weight", "bold"))
        .add(text(note, (left, 66.0), 15.0, GREY, Anchor::Start))
}

/// Returns a picture on a white page as SVG text.
pub fn render_svg(size: (f64, f64), group: Group) -> String {
    Document::new()
        .set("viewBox", (0.0, 0.0, size.0, size.1))
        .set("width", size.0)
        .set("height", size.1)
        .add(rectangle((0.0, 0.0), size, "white"))
        .add(group)
        .to_string()
}

/// Returns a diagonal cross, like the letter x.
pub fn cross(centre: (f64, f64), arm_length: f64, colour: &str, width: f64) -> Group {
    let (x, y) = centre;
    let [left, right] = [x - arm_length, x + arm_length];
    let [top, bottom] = [y - arm_length, y + arm_length];
    Group::new()
        .add(line((left, top), (right, bottom), colour, width))
        .add(line((left, bottom), (right, top), colour, width))
}

/// Returns a straight line.
pub fn line(start: (f64, f64), end: (f64, f64), colour: &str, width: f64) -> Line {
    Line::new()
        .set("x1", round_hundredths(start.0))
        .set("y1", round_hundredths(start.1))
        .set("x2", round_hundredths(end.0))
        .set("y2", round_hundredths(end.1))
        .set("stroke", colour)
        .set("stroke-width", width)
        .set("stroke-linecap", "round")
}

/// Returns a rectangle from its upper left corner and size.
pub fn rectangle(corner: (f64, f64), size: (f64, f64), fill: &str) -> Rectangle {
    Rectangle::new()
        .set("x", round_hundredths(corner.0))
        .set("y", round_hundredths(corner.1))
        .set("width", round_hundredths(size.0))
        .set("height", round_hundredths(size.1))
        .set("fill", fill)
}

/// Returns a circle from its centre and radius.
pub fn circle(centre: (f64, f64), radius: f64, fill: &str) -> Circle {
    Circle::new()
        .set("cx", round_hundredths(centre.0))
        .set("cy", round_hundredths(centre.1))
        .set("r", radius)
        .set("fill", fill)
}

/// Adds an outline to a shape.
pub fn add_outline<T: Node>(mut shape: T, colour: &str, width: impl Into<Value>) -> T {
    shape.assign("stroke", colour);
    shape.assign("stroke-width", width);
    shape
}

/// Returns an open curve through points.
pub fn curve(points: &[(f64, f64)], colour: &str, width: f64) -> Polyline {
    let coordinates: Vec<String> = points
        .iter()
        .map(|(x, y)| format!("{},{}", round_hundredths(*x), round_hundredths(*y)))
        .collect();
    Polyline::new()
        .set("points", coordinates.join(" "))
        .set("fill", "none")
        .set("stroke", colour)
        .set("stroke-width", width)
        .set("stroke-linejoin", "round")
        .set("stroke-linecap", "round")
}

/// Rounds to hundredths of a pixel, so that files are small and identical on all machines.
pub fn round_hundredths(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// Returns the name that an Arduino board shows next to a pin: D9 for pin 9, A0 for pin 14.
pub fn pin_name(pin_number: u8) -> String {
    const A0: u8 = 14;
    match pin_number.checked_sub(A0) {
        Some(index) => format!("A{index}"),
        None => format!("D{pin_number}"),
    }
}
