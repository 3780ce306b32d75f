//! Draws a picture to share: the measured and the predicted path within a cycle, and the displacements per cycle.

use lizard_measure::{COMPONENT_LABELS, GaitReport, Report};
use svg::node::element::Group;

use crate::shared::plot::{Axis, Plot, draw_legend_entry};
use crate::shared::shapes::{
    Anchor, GREY, SERVO_COLOURS, add_outline, add_title, rectangle, render_svg, text, text_middle,
    text_start,
};

/// Width of the page, px.
const PAGE_WIDTH: f64 = 1000.0;
/// Height of the title with the legend below it, px.
const TITLE_HEIGHT: f64 = 110.0;
/// Height of a gait's row, px.
const ROW_HEIGHT: f64 = 360.0;
/// Left edge of the panel with the path, px.
const PATH_X: f64 = 90.0;
/// Left edge of the panel with the bars, px.
const BARS_X: f64 = 640.0;
/// Width of the panel with the path, px.
const PATH_WIDTH: f64 = 460.0;
/// Width of the panel with the bars, px.
const BARS_WIDTH: f64 = 330.0;
/// Height of each panel, px.
const PANEL_HEIGHT: f64 = 220.0;
/// Colour of measured values.
const MEASURED_COLOUR: &str = SERVO_COLOURS[0];
/// Colour of predicted values.
const PREDICTED_COLOUR: &str = GREY;
/// Half the length of an error bar, in standard errors.
const ERROR_BAR_HALF_LENGTH: f64 = 2.0;

/// Draws a report as SVG.
pub(super) fn draw(report: &Report) -> String {
    let mut group = add_title(
        Group::new(),
        PATH_X,
        "The measured robot",
        "mean over the cycles in a video, with two standard errors, and the prediction",
    );
    group = draw_legend_entry(group, (PATH_X, 92.0), MEASURED_COLOUR, "none", "measured");
    let point = (PATH_X + 150.0, 92.0);
    group = draw_legend_entry(group, point, PREDICTED_COLOUR, "none", "predicted");
    let row_y = |row: usize| TITLE_HEIGHT + ROW_HEIGHT * row as f64;
    for (row, gait) in report.gaits.iter().enumerate() {
        group = draw_gait(group, gait, row_y(row));
    }
    render_svg((PAGE_WIDTH, row_y(report.gaits.len())), group)
}

/// Draws a gait's row with its upper edge at `top`.
fn draw_gait(group: Group, gait: &GaitReport, top: f64) -> Group {
    let title = format!("{}, {} cycles", gait.name, gait.cycle_count);
    let group =
        group.add(text_start(&title, (PATH_X, top + 35.0), 18.0).set("font-weight", "bold"));
    let group = draw_path(group, gait, top + 55.0);
    draw_bars(group, gait, top + 55.0)
}

/// Draws the path within a cycle on the floor; x points forward, y to the left, mm.
fn draw_path(group: Group, gait: &GaitReport, top: f64) -> Group {
    let predicted = gait.predicted_path.iter();
    let predicted: Vec<_> = predicted.map(|pose| (pose.forward, pose.left)).collect();
    let mean_points = gait.mean_path.iter();
    let mut measured = vec![(0.0, 0.0)];
    measured.extend(mean_points.map(|point| (point.forward.mean, point.left.mean)));
    let last_point = (gait.forward.mean, gait.left.mean);
    measured.push(last_point);
    let extent_of = |coordinate: fn(&(f64, f64)) -> f64| {
        let values = predicted.iter().chain(&measured).map(coordinate);
        values.fold([0.0f64; 2], |[min, max], value| {
            [min.min(value), max.max(value)]
        })
    };
    let ([min_x, max_x], [min_y, max_y]) = (extent_of(|point| point.0), extent_of(|point| point.1));
    // Both directions have the same scale, with a margin.
    let mm_per_px = ((max_x - min_x) / PATH_WIDTH)
        .max((max_y - min_y) / PANEL_HEIGHT)
        .max(1e-3)
        * 1.15;
    let axis_range = |min: f64, max: f64, size: f64| {
        let (middle, half_range) = ((min + max) / 2.0, mm_per_px * size / 2.0);
        (middle - half_range, middle + half_range)
    };
    let plot = Plot {
        corner: (PATH_X, top),
        size: (PATH_WIDTH, PANEL_HEIGHT),
        x_range: axis_range(min_x, max_x, PATH_WIDTH),
        y_range: axis_range(min_y, max_y, PANEL_HEIGHT),
    };
    let tick_step = compute_tick_step(mm_per_px * PATH_WIDTH);
    let [forward_axis, left_axis] =
        ["ahead, mm", "left, mm"].map(|name| Axis::new(tick_step, name));
    let group = plot.draw_grid(group, &forward_axis, &left_axis);
    let mut group = plot
        .draw_axes(group, &forward_axis, &left_axis)
        .add(plot.curve(&predicted, PREDICTED_COLOUR, 2.0));
    for point in &gait.mean_path {
        let (x, y) = (point.forward.mean, point.left.mean);
        let [error_x, error_y] = [&point.forward, &point.left]
            .map(|component| ERROR_BAR_HALF_LENGTH * component.standard_error);
        for (start, end) in [
            ((x - error_x, y), (x + error_x, y)),
            ((x, y - error_y), (x, y + error_y)),
        ] {
            group = group.add(plot.line(start, end, MEASURED_COLOUR, 1.0));
        }
    }
    let start = plot.circle((0.0, 0.0), 5.0, "white");
    group
        .add(plot.curve(&measured, MEASURED_COLOUR, 2.0))
        .add(add_outline(start, MEASURED_COLOUR, 2.0))
        .add(plot.circle(last_point, 5.0, MEASURED_COLOUR))
}

/// Draws the components of the displacement per cycle as bars.
fn draw_bars(group: Group, gait: &GaitReport, top: f64) -> Group {
    let components = gait.components();
    let values = components.iter().flat_map(|component| {
        let half_length = ERROR_BAR_HALF_LENGTH * component.standard_error;
        let error_ends = [component.mean - half_length, component.mean + half_length];
        error_ends.into_iter().chain(component.predicted)
    });
    let [min, max] = values.fold([0.0f64; 2], |[min, max], value| {
        [min.min(value), max.max(value)]
    });
    let margin = 0.1 * (max - min).max(1e-3);
    let plot = Plot {
        corner: (BARS_X, top),
        size: (BARS_WIDTH, PANEL_HEIGHT),
        x_range: (0.5, 0.5 + components.len() as f64),
        y_range: (min - margin, max + margin),
    };
    // The tick step is longer than the axis, so no ticks are drawn. The names of the bars are below the axis.
    let name_axis = Axis::new(10.0, "");
    let value_axis = Axis::new(compute_tick_step(max - min + 2.0 * margin), "");
    let mut group = plot.draw_grid(group, &name_axis, &value_axis);
    for (i, component) in components.into_iter().enumerate() {
        // Each component has an interval of width 1: the measured bar is on the left, the predicted bar on the right.
        let interval_left = 0.5 + i as f64;
        let draw_bar = |offset: f64, value: f64, colour: &str| {
            let (left, top) = plot.to_page_point(interval_left + offset, value.max(0.0));
            let (right, bottom) = plot.to_page_point(interval_left + offset + 0.28, value.min(0.0));
            rectangle((left, top), (right - left, bottom - top), colour)
        };
        group = group.add(draw_bar(0.2, component.mean, MEASURED_COLOUR));
        if let Some(predicted) = component.predicted {
            group = group.add(draw_bar(0.52, predicted, PREDICTED_COLOUR).set("fill-opacity", 0.6));
        }
        let half_length = ERROR_BAR_HALF_LENGTH * component.standard_error;
        let error_ends = [component.mean - half_length, component.mean + half_length];
        let x = interval_left + 0.34;
        let [low, high] = error_ends.map(|end| (x, end));
        group = group.add(plot.line(low, high, "black", 1.5));
        for end in error_ends {
            group = group.add(plot.line((x - 0.05, end), (x + 0.05, end), "black", 1.5));
        }
        let point_below = |lines: f64| {
            let (x, y) = plot.to_page_point(interval_left + 0.5, plot.y_range.0);
            (x, y + 20.0 + 18.0 * lines)
        };
        group = group.add(text_middle(COMPONENT_LABELS[i], point_below(0.0), 15.0));
        let verdict = component.format_verdict();
        // "more" or "less" is on a line of its own, because the three verdicts are beside each other.
        let (first_line, second_line) = verdict.rsplit_once(' ').unwrap_or((&verdict, ""));
        for (lines, part) in [(1.0, first_line), (2.0, second_line)]
            .into_iter()
            .filter(|(_, part)| !part.is_empty())
        {
            group = group.add(text(part, point_below(lines), 13.0, GREY, Anchor::Middle));
        }
    }
    let [line_start, line_end] = [plot.x_range.0, plot.x_range.1].map(|x| (x, 0.0));
    group = group.add(plot.line(line_start, line_end, "black", 1.0));
    plot.draw_axes(group, &name_axis, &value_axis)
}

/// Returns the distance between ticks that divides `range` into 4 to 10 steps: 1, 2 or 5 times a power of ten.
fn compute_tick_step(range: f64) -> f64 {
    let max_step = range / 4.0;
    let power = 10f64.powf(max_step.log10().floor());
    let mut factors = [5.0, 2.0].into_iter();
    let factor = factors.find(|factor| factor * power <= max_step);
    factor.unwrap_or(1.0) * power
}
