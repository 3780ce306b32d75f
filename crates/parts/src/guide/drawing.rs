//! A drawing of polygons and labels, as SVG.

use std::fmt::Write;

use lizard_kinematics::Vector;

use crate::layers::outline::compute_bounds;

/// Margin around the drawing, pixels.
const MARGIN: f64 = 12.0;
/// Space for labels on each side of a picture, pixels.
const LABEL_MARGIN: f64 = 165.0;
/// Line spacing of the labels, pixels.
const LINE_SPACING: f64 = 16.0;
/// SVG attributes of the labels' text.
const FONT_ATTRIBUTES: &str = "font-family=\"sans-serif\" font-size=\"12\" fill=\"#111\"";

/// The vertices of a closed outline in the drawing, mm, before scaling to pixels.
pub(super) type Ring = Vec<(f64, f64)>;
/// A point of the drawing, mm, and its label.
pub(super) type PlacedLabel<'a> = ((f64, f64), &'a Label);

/// A label in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Labelled point, chassis frame, mm.
    pub position: Vector,
    /// Height of the labelled point, mm.
    pub z: f64,
    /// Text of the label.
    pub text: String,
    /// True for a text beside the picture with a line to the labelled point; false for a text at the point.
    pub is_beside: bool,
}

/// The visible part of the drawing, mm, before scaling to pixels.
pub(super) struct Frame {
    min: Vector,
    max: Vector,
}

impl Frame {
    /// Creates the smallest frame around some points, with a margin in a close-up.
    pub(super) fn around(points: impl Iterator<Item = (f64, f64)>, is_close_up: bool) -> Self {
        /// Margin of a close-up, mm.
        const CLOSE_UP_MARGIN: f64 = 12.0;
        let [min, max] = compute_bounds(points.map(|(x, y)| Vector::new(x, y)));
        let margin = if is_close_up { CLOSE_UP_MARGIN } else { 0.0 };
        Self {
            min: Vector::new(min.x - margin, min.y - margin),
            max: Vector::new(max.x + margin, max.y + margin),
        }
    }

    fn contains(&self, (x, y): (f64, f64)) -> bool {
        self.min.x <= x && x <= self.max.x && self.min.y <= y && y <= self.max.y
    }
}

/// A drawing: the styles (as CSS) and the rings of its polygons in drawing order.
#[derive(Default)]
pub(super) struct Drawing {
    polygons: Vec<(String, Vec<Ring>)>,
}

impl Drawing {
    /// Draws a polygon on top; rings within its outer ring are holes.
    pub(super) fn draw_polygon(&mut self, rings: Vec<Ring>, colour: [f64; 3], has_edge: bool) {
        let [r, g, b] = colour.map(|channel| channel.clamp(0.0, 255.0).round() as u8);
        let colour = format!("#{r:02x}{g:02x}{b:02x}");
        // Without an edge, a thin stroke in the polygon's own colour closes the seams between neighbours.
        let (stroke, stroke_width) = if has_edge { ("#333", 5) } else { (&*colour, 4) };
        let style = format!("fill:{colour};stroke:{stroke};stroke-width:{stroke_width}");
        self.polygons.push((style, rings));
    }

    /// Converts the drawing to SVG, `width` pixels wide, with the labels within the frame.
    pub(super) fn into_svg(self, width: f64, frame: &Frame, labels: &[PlacedLabel]) -> String {
        let Frame { min, max } = frame;
        let side_margin = match labels.iter().any(|(_, label)| label.is_beside) {
            true => LABEL_MARGIN,
            false => 0.0,
        };
        let left_offset = MARGIN + side_margin;
        let scale = (width - 2.0 * left_offset) / (max.x - min.x);
        let height = ((max.y - min.y) * scale + 2.0 * MARGIN).ceil();
        // To make the SVG about four times smaller, each style is written once, and a point is relative to the previous
        // one, in whole tenths of a pixel.
        let mut styles: Vec<&str> = Vec::new();
        let mut paths = String::new();
        let to_tenths = |x: f64, offset: f64| (10.0 * (x * scale + offset)).round() as i64;
        for (style, rings) in &self.polygons {
            let listed_index = styles.iter().position(|listed| listed == style);
            let class_index = listed_index.unwrap_or(styles.len());
            if listed_index.is_none() {
                styles.push(style);
            }
            let mut path_data = String::new();
            let mut position = (0, 0);
            for ring in rings {
                let mut start = None;
                for (x, y) in ring {
                    let column = to_tenths(x - min.x, left_offset);
                    let row = to_tenths(y - min.y, MARGIN);
                    let (dx, dy) = (column - position.0, row - position.1);
                    // After the first point, each pair is a relative line, and a minus sign separates numbers.
                    let _ = match (start, dx < 0) {
                        (None, _) => write!(path_data, "m{dx}"),
                        (Some(_), _) if (dx, dy) == (0, 0) => continue,
                        (Some(_), true) => write!(path_data, "{dx}"),
                        (Some(_), false) => write!(path_data, " {dx}"),
                    };
                    let _ = write!(path_data, "{}{dy}", if dy < 0 { "" } else { " " });
                    position = (column, row);
                    start.get_or_insert(position);
                }
                path_data.push('z');
                position = start.unwrap_or(position);
            }
            let _ = writeln!(paths, "<path class=\"c{class_index}\" d=\"{path_data}\"/>");
        }
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             width=\"{width}\" height=\"{height}\">\n<style>\n"
        );
        for (class_index, style) in styles.into_iter().enumerate() {
            let _ = writeln!(svg, ".c{class_index}{{{style}}}");
        }
        let _ = writeln!(
            svg,
            "</style>\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n\
             <g transform=\"scale(.1)\" fill-rule=\"evenodd\" stroke-linejoin=\"round\">\n{paths}</g>"
        );
        // The labels within the frame, each with its point in pixels.
        let shown_labels = labels.iter().filter(|(point, _)| frame.contains(*point));
        let scaled_labels = shown_labels.map(|((x, y), label)| {
            let scaled_x = (x - min.x) * scale + left_offset;
            ((scaled_x, (y - min.y) * scale + MARGIN), *label)
        });
        let (beside_labels, point_labels): (Vec<PlacedLabel>, Vec<PlacedLabel>) =
            scaled_labels.partition(|(_, label)| label.is_beside);
        for ((x, y), Label { text, .. }) in point_labels {
            let _ = writeln!(
                svg,
                "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\" {FONT_ATTRIBUTES} font-weight=\"bold\" \
                 stroke=\"white\" stroke-width=\"3\" paint-order=\"stroke\">{text}</text>"
            );
        }
        for is_left in [true, false] {
            let labels = beside_labels.iter().copied();
            let labels = labels.filter(|((x, _), _)| (*x < width / 2.0) == is_left);
            let mut column: Vec<_> = labels.collect();
            column.sort_by(|((_, a), _), ((_, b), _)| a.total_cmp(b));
            write_column(&mut svg, &column, is_left, width, height);
        }
        svg.push_str("</svg>\n");
        svg
    }
}

/// Writes a column of labels on one side of the picture, each with a line to the labelled point.
fn write_column(svg: &mut String, labels: &[PlacedLabel], is_left: bool, width: f64, height: f64) {
    let count = labels.len() as f64;
    let mut min_y = LINE_SPACING;
    for (index, ((x, y), label)) in labels.iter().enumerate() {
        let max_y = height - (count - index as f64) * LINE_SPACING + 8.0;
        let text_y = (y + 4.0).min(max_y).max(min_y);
        min_y = text_y + LINE_SPACING;
        // The line begins about where the text ends.
        let text_width = 6.4 * label.text.chars().count() as f64;
        let line_offset = (8.0 + text_width).min(LABEL_MARGIN - 4.0);
        let (text_x, line_start, anchor) = match is_left {
            true => (8.0, line_offset, "start"),
            false => (width - 8.0, width - line_offset, "end"),
        };
        let _ = writeln!(
            svg,
            "<path d=\"M{line_start:.1} {:.1}L{x:.1} {y:.1}\" stroke=\"#111\" stroke-width=\"0.8\"/>\
             <circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2\"/>\
             <text x=\"{text_x}\" y=\"{text_y:.1}\" text-anchor=\"{anchor}\" {FONT_ATTRIBUTES}>{}</text>",
            text_y - 4.0,
            label.text
        );
    }
}
