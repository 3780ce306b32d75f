//! Elements that all charts share: axes, maps in colour bands, and colour scales.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use svg::node::element::{Circle, Group, Line, Path, Polyline};

use crate::shared::shapes::{
    DARK, GRID_COLOUR, add_outline, circle, curve, line, rectangle, text_end, text_middle,
    text_start,
};

/// Viridis in ten bands of evenly increasing lightness, legible in grey print and for colour-blind people.
pub const VIRIDIS: &[&str] = &[
    "#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58",
    "#b5de2b", "#fde725",
];

/// Light blues, for maps with coloured lines on top.
pub const BLUES: &[&str] = &[
    "#f7fbff", "#e3eef8", "#d0e1f2", "#b7d4ea", "#9ac7e0", "#7fb8da", "#65a9d2",
];

/// The colour of excluded regions.
pub const EXCLUDED_COLOUR: &str = "#d4d0cb";

/// A rectangle on the page with its own coordinate system.
#[derive(Clone, Copy)]
pub struct Plot {
    /// Upper left corner on the page, px.
    pub corner: (f64, f64),
    /// Width and height on the page, px.
    pub size: (f64, f64),
    /// Range from left to right.
    pub x_range: (f64, f64),
    /// Range from bottom to top.
    pub y_range: (f64, f64),
}

/// The ticks and the name of an axis.
pub struct Axis<'a> {
    /// Distance between ticks, in the axis's unit.
    pub tick_step: f64,
    /// Name and unit.
    pub name: &'a str,
}

impl<'a> Axis<'a> {
    /// Creates an axis with ticks at multiples of `tick_step`.
    pub const fn new(tick_step: f64, name: &'a str) -> Self {
        Self { tick_step, name }
    }
}

impl Plot {
    /// Converts a point in the plot's coordinates to its position on the page, px.
    pub fn to_page_point(self, x: f64, y: f64) -> (f64, f64) {
        (
            self.corner.0 + self.size.0 * (x - self.x_range.0) / (self.x_range.1 - self.x_range.0),
            self.corner.1 + self.size.1 * (self.y_range.1 - y) / (self.y_range.1 - self.y_range.0),
        )
    }

    /// Returns the number of pixels per unit of x.
    pub fn scale(&self) -> f64 {
        self.size.0 / (self.x_range.1 - self.x_range.0)
    }

    /// Returns the lower right corner on the page.
    fn lower_right_corner(&self) -> (f64, f64) {
        (self.corner.0 + self.size.0, self.corner.1 + self.size.1)
    }

    /// Adds grid lines at the ticks of both axes.
    pub fn draw_grid(&self, mut group: Group, x_axis: &Axis, y_axis: &Axis) -> Group {
        let ((left, top), (right, bottom)) = (self.corner, self.lower_right_corner());
        for value in compute_ticks(self.x_range, x_axis.tick_step) {
            let page_x = self.to_page_point(value, 0.0).0;
            group = group.add(line((page_x, top), (page_x, bottom), GRID_COLOUR, 1.0));
        }
        for value in compute_ticks(self.y_range, y_axis.tick_step) {
            let page_y = self.to_page_point(0.0, value).1;
            group = group.add(line((left, page_y), (right, page_y), GRID_COLOUR, 1.0));
        }
        group
    }

    /// Adds the frame, and the ticks, numbers and names of both axes.
    pub fn draw_axes(&self, mut group: Group, x_axis: &Axis, y_axis: &Axis) -> Group {
        let ((left, top), (right, bottom)) = (self.corner, self.lower_right_corner());
        let frame = rectangle(self.corner, self.size, "none");
        group = group.add(add_outline(frame, DARK, 1.0));
        for value in compute_ticks(self.x_range, x_axis.tick_step) {
            let page_x = self.to_page_point(value, 0.0).0;
            let label = format_tick(value, x_axis.tick_step);
            group = group
                .add(line((page_x, bottom), (page_x, bottom + 6.0), DARK, 1.0))
                .add(text_middle(&label, (page_x, bottom + 23.0), 15.0));
        }
        for value in compute_ticks(self.y_range, y_axis.tick_step) {
            let page_y = self.to_page_point(0.0, value).1;
            let label = format_tick(value, y_axis.tick_step);
            group = group
                .add(line((left - 6.0, page_y), (left, page_y), DARK, 1.0))
                .add(text_end(&label, (left - 10.0, page_y + 5.0), 15.0));
        }
        let (name_x, name_y) = (left - 58.0, (top + bottom) / 2.0);
        let x_name = text_middle(x_axis.name, ((left + right) / 2.0, bottom + 50.0), 17.0);
        let y_name = text_middle(y_axis.name, (name_x, name_y), 17.0);
        let rotation = format!("rotate(-90 {name_x} {name_y})");
        group.add(x_name).add(y_name.set("transform", rotation))
    }

    /// Adds a map of coloured cells. `cell_counts` are the numbers of columns and rows. `colour_at` returns the colour
    /// at a cell's centre, or `None` for an empty cell. Each colour is one path. Neighbouring cells with the same
    /// colour in a row become one rectangle.
    pub fn draw_map(
        &self,
        mut group: Group,
        cell_counts: (usize, usize),
        colour_at: impl Fn(f64, f64) -> Option<&'static str>,
    ) -> Group {
        let cell_width = (self.x_range.1 - self.x_range.0) / cell_counts.0 as f64;
        let cell_height = (self.y_range.1 - self.y_range.0) / cell_counts.1 as f64;
        let mut path_data: BTreeMap<&str, String> = BTreeMap::new();
        for row in 0..cell_counts.1 {
            let row_bottom = self.y_range.0 + row as f64 * cell_height;
            let column_left = |column: usize| self.x_range.0 + column as f64 * cell_width;
            let cell_colour = |column: usize| {
                colour_at(
                    column_left(column) + cell_width / 2.0,
                    row_bottom + cell_height / 2.0,
                )
            };
            let fills: Vec<_> = (0..cell_counts.0).map(cell_colour).collect();
            let mut first_column = 0;
            for equal_fills in fills.chunk_by(|fill, next_fill| fill == next_fill) {
                let end_column = first_column + equal_fills.len();
                if let Some(fill) = equal_fills[0] {
                    let (left, top) =
                        self.to_page_point(column_left(first_column), row_bottom + cell_height);
                    let (right, bottom) = self.to_page_point(column_left(end_column), row_bottom);
                    let (run_width, run_height) = (right - left, bottom - top);
                    let _ = write!(
                        path_data.entry(fill).or_default(),
                        "M{left:.1} {top:.1}h{run_width:.1}v{run_height:.1}h-{run_width:.1}z"
                    );
                }
                first_column = end_column;
            }
        }
        for (fill, outline) in path_data {
            let path = Path::new().set("d", outline).set("fill", fill);
            group = group.add(path.set("shape-rendering", "crispEdges"));
        }
        group
    }

    /// Returns a straight line between two points in the plot's coordinates.
    pub fn line(&self, start: (f64, f64), end: (f64, f64), colour: &str, width: f64) -> Line {
        let [start, end] = [start, end].map(|(x, y)| self.to_page_point(x, y));
        line(start, end, colour, width)
    }

    /// Returns a circle from its centre in the plot's coordinates and its radius, px.
    pub fn circle(&self, (x, y): (f64, f64), radius: f64, fill: &str) -> Circle {
        circle(self.to_page_point(x, y), radius, fill)
    }

    /// Returns an open curve through points in the plot's coordinates.
    pub fn curve(&self, points: &[(f64, f64)], colour: &str, width: f64) -> Polyline {
        let points = points.iter().map(|&(x, y)| self.to_page_point(x, y));
        curve(&points.collect::<Vec<_>>(), colour, width)
    }
}

/// Returns the multiples of a step within a range.
fn compute_ticks(range: (f64, f64), step: f64) -> impl Iterator<Item = f64> {
    let first = (range.0 / step - 1e-9).ceil() as i64;
    let last = (range.1 / step + 1e-9).floor() as i64;
    (first..=last).map(move |i| i as f64 * step)
}

/// Formats a tick's value with as many decimals as the step needs.
fn format_tick(value: f64, step: f64) -> String {
    let is_enough = |decimals: &i32| (step * 10f64.powi(*decimals)).fract().abs() < 1e-9;
    let decimals = (0..4).find(is_enough).unwrap_or(4) as usize;
    // Adding 0.0 turns -0.0 into 0.0.
    format!("{:.decimals$}", value + 0.0)
}

/// A colour scale for a quantity.
pub struct ColourScale {
    /// Value at the lower end of the first band.
    pub min: f64,
    /// Value at the upper end of the last band.
    pub max: f64,
    /// The bands' colours.
    pub colours: &'static [&'static str],
}

impl ColourScale {
    /// Returns the colour of a value; a value outside the range gets the nearest band.
    pub fn colour(&self, value: f64) -> &'static str {
        let fraction = (value - self.min) / (self.max - self.min);
        // The small addend puts a value on the boundary of two bands into the upper band, despite rounding.
        let band_index = (fraction * self.colours.len() as f64 + 1e-9).max(0.0) as usize;
        self.colours[band_index.min(self.colours.len() - 1)]
    }

    /// Adds a vertical colour key with the limits of the bands. `corner` is its upper left corner; `height` is in px.
    pub fn draw_key(
        &self,
        mut group: Group,
        corner: (f64, f64),
        height: f64,
        name: &str,
        decimals: usize,
    ) -> Group {
        let band_count = self.colours.len();
        let band_height = height / band_count as f64;
        for (i, colour) in self.colours.iter().enumerate() {
            let top = corner.1 + height - (i + 1) as f64 * band_height;
            group = group.add(rectangle((corner.0, top), (22.0, band_height), colour));
        }
        for i in 0..=band_count {
            let value = self.min + (self.max - self.min) * i as f64 / band_count as f64;
            let limit_y = corner.1 + height - i as f64 * band_height;
            let label = format!("{value:.decimals$}");
            group = group.add(text_start(&label, (corner.0 + 30.0, limit_y + 5.0), 14.0));
        }
        group
            .add(rectangle(corner, (22.0, height), "none").set("stroke", DARK))
            .add(text_start(name, (corner.0, corner.1 - 14.0), 15.0))
    }
}

/// Adds an entry of a legend: a short line from `left_end`, and the line's meaning. `dashes` is an SVG dash pattern;
/// the line is solid if it is "" or "none".
pub fn draw_legend_entry(
    group: Group,
    left_end: (f64, f64),
    colour: &str,
    dashes: &str,
    meaning: &str,
) -> Group {
    group
        .add(
            line(left_end, (left_end.0 + 34.0, left_end.1), colour, 3.0)
                .set("stroke-dasharray", dashes),
        )
        .add(text_start(
            meaning,
            (left_end.0 + 44.0, left_end.1 + 5.0),
            15.0,
        ))
}
