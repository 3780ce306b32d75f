//! A picture to share: the path within a cycle and the distances per cycle of each gait, measured beside predicted.

use lizard_measure::{GaitReport, PARTS, Report};
use svg::node::element::Group;

use crate::shared::ink::Anchor;
use crate::shared::ink::{
    GREY, SERVO, circle, edged, line, page, rectangle, text, text_middle, text_start, title,
};
use crate::shared::plot::{Axis, Plot, draw_entry};

const WIDTH: f64 = 1000.0;
/// Height of the title with the legend below it, px.
const TOP: f64 = 110.0;
/// Height of a gait's row, px.
const ROW: f64 = 360.0;
/// Left edge of the panel with the path, px.
const PATH: f64 = 90.0;
/// Left edge of the panel with the bars, px.
const BARS: f64 = 640.0;
/// Width of the panel with the path, px.
const PATH_WIDTH: f64 = 460.0;
/// Width of the panel with the bars, px.
const BARS_WIDTH: f64 = 330.0;
/// Height of each panel, px.
const PANEL: f64 = 220.0;
/// Colour of measured values.
const MEASURED: &str = SERVO[0];
/// Colour of predicted values.
const PREDICTED: &str = GREY;
/// Half the length of an error bar, in standard errors.
const ERROR_BAR_ERRORS: f64 = 2.0;

/// Draws a report as SVG.
pub(super) fn draw(report: &Report) -> String {
    let mut group = title(
        Group::new(),
        PATH,
        "The robot measured",
        "mean of a cycle in a film, with twice its standard error, beside the prediction",
    );
    group = draw_entry(group, (PATH, 92.0), MEASURED, "none", "measured");
    group = draw_entry(group, (PATH + 150.0, 92.0), PREDICTED, "none", "predicted");
    for (row, gait) in report.gaits.iter().enumerate() {
        group = draw_gait(group, gait, TOP + ROW * row as f64);
    }
    page((WIDTH, TOP + ROW * report.gaits.len() as f64), group)
}

/// Draws a gait with its upper edge at this height.
fn draw_gait(group: Group, gait: &GaitReport, top: f64) -> Group {
    let name = format!("{}, {} cycles", gait.gait, gait.cycles);
    let group = group.add(text_start(&name, (PATH, top + 35.0), 18.0).set("font-weight", "bold"));
    let group = draw_path(group, gait, top + 55.0);
    draw_bars(group, gait, top + 55.0)
}

/// The path within a cycle on the floor. Ahead is to the right, left is upward.
fn draw_path(group: Group, gait: &GaitReport, top: f64) -> Group {
    let predicted: Vec<(f64, f64)> = gait
        .expected
        .iter()
        .map(|place| (place.forward, place.left))
        .collect();
    let mut points: Vec<(f64, f64)> = gait
        .within
        .iter()
        .map(|point| (point.forward.mean, point.left.mean))
        .collect();
    points.insert(0, (0.0, 0.0));
    points.push((gait.forward.mean, gait.left.mean));
    let reach = |part: fn(&(f64, f64)) -> f64| {
        let all = predicted.iter().chain(&points).map(part);
        all.fold([0.0f64; 2], |[low, high], value| {
            [low.min(value), high.max(value)]
        })
    };
    let ([x, right], [y, upper]) = (reach(|point| point.0), reach(|point| point.1));
    // The same scale in both directions, with a margin.
    let scale = ((right - x) / PATH_WIDTH)
        .max((upper - y) / PANEL)
        .max(1e-3)
        * 1.15;
    let range = |low: f64, high: f64, size: f64| {
        let half = scale * size / 2.0;
        ((low + high) / 2.0 - half, (low + high) / 2.0 + half)
    };
    let plot = Plot {
        corner: (PATH, top),
        size: (PATH_WIDTH, PANEL),
        x: range(x, right, PATH_WIDTH),
        y: range(y, upper, PANEL),
    };
    let step = step(scale * PATH_WIDTH);
    let (ahead, left) = (Axis::new(step, "ahead, mm"), Axis::new(step, "left, mm"));
    let group = plot.draw_grid(group, &ahead, &left);
    let mut group = plot
        .draw_axes(group, &ahead, &left)
        .add(plot.curve(&predicted, PREDICTED, 2.0));
    for point in &gait.within {
        let (x, y) = (point.forward.mean, point.left.mean);
        let [ex, ey] = [&point.forward, &point.left].map(|part| ERROR_BAR_ERRORS * part.error);
        group = group
            .add(line(
                plot.page_point(x - ex, y),
                plot.page_point(x + ex, y),
                MEASURED,
                1.0,
            ))
            .add(line(
                plot.page_point(x, y - ey),
                plot.page_point(x, y + ey),
                MEASURED,
                1.0,
            ));
    }
    group = group.add(plot.curve(&points, MEASURED, 2.0));
    let (begin, end) = (plot.page_point(0.0, 0.0), points[points.len() - 1]);
    group
        .add(edged(circle(begin, 5.0, "white"), MEASURED, 2.0))
        .add(circle(plot.page_point(end.0, end.1), 5.0, MEASURED))
}

/// The components of the motion in a cycle as bars.
fn draw_bars(group: Group, gait: &GaitReport, top: f64) -> Group {
    let parts = gait.parts();
    let ends = parts.iter().flat_map(|part| {
        let own = [
            part.mean - ERROR_BAR_ERRORS * part.error,
            part.mean + ERROR_BAR_ERRORS * part.error,
        ];
        own.into_iter().chain(part.predicted)
    });
    let [low, high] = ends.fold([0.0f64; 2], |[low, high], end| {
        [low.min(end), high.max(end)]
    });
    let margin = 0.1 * (high - low).max(1e-3);
    let plot = Plot {
        corner: (BARS, top),
        size: (BARS_WIDTH, PANEL),
        x: (0.5, 0.5 + parts.len() as f64),
        y: (low - margin, high + margin),
    };
    // The step is longer than the axis, so no ticks are drawn; the names of the bars are below the axis.
    let across = Axis::new(10.0, "");
    let value = Axis::new(step(high - low + 2.0 * margin), "");
    let mut group = plot.draw_grid(group, &across, &value);
    for (i, part) in parts.into_iter().enumerate() {
        // Each component has a slot of width 1, with the measured bar to the left of the predicted one.
        let at = 0.5 + i as f64;
        let bar = |from: f64, value: f64, colour: &str| {
            let (left, top) = plot.page_point(at + from, value.max(0.0));
            let (right, bottom) = plot.page_point(at + from + 0.28, value.min(0.0));
            rectangle((left, top), (right - left, bottom - top), colour)
        };
        group = group.add(bar(0.2, part.mean, MEASURED));
        if let Some(predicted) = part.predicted {
            group = group.add(bar(0.52, predicted, PREDICTED).set("fill-opacity", 0.6));
        }
        let [low, high] =
            [-ERROR_BAR_ERRORS, ERROR_BAR_ERRORS].map(|errors| part.mean + errors * part.error);
        let x = at + 0.34;
        group = group.add(line(
            plot.page_point(x, low),
            plot.page_point(x, high),
            "black",
            1.5,
        ));
        for end in [low, high] {
            group = group.add(line(
                plot.page_point(x - 0.05, end),
                plot.page_point(x + 0.05, end),
                "black",
                1.5,
            ));
        }
        let below = |lines: f64| {
            let (x, y) = plot.page_point(at + 0.5, plot.y.0);
            (x, y + 20.0 + 18.0 * lines)
        };
        group = group.add(text_middle(PARTS[i], below(0.0), 15.0)).add(text(
            &part.verdict(),
            below(1.0),
            13.0,
            GREY,
            Anchor::Middle,
        ));
    }
    group = group.add(line(
        plot.page_point(plot.x.0, 0.0),
        plot.page_point(plot.x.1, 0.0),
        "black",
        1.0,
    ));
    plot.draw_axes(group, &across, &value)
}

/// Distance between ticks for which `range` has four to ten of them: 1, 2 or 5 times a power of ten.
fn step(range: f64) -> f64 {
    let rough = range / 4.0;
    let power = 10f64.powf(rough.log10().floor());
    let fits = [5.0, 2.0].into_iter().find(|times| times * power <= rough);
    fits.unwrap_or(1.0) * power
}
