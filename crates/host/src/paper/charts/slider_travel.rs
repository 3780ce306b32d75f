//! The chart of slider travel in each gait.

use lizard_robot::{CheckedGait, Robot};
use svg::node::element::Group;

use crate::shared::number::round_to_decimals;
use crate::shared::plot::{Axis, EXCLUDED_COLOUR, Plot, draw_legend_entry};
use crate::shared::shapes::{Anchor, GREY, add_title, rectangle, render_svg, text, text_start};

/// Number of columns of panels.
const COLUMN_COUNT: usize = 4;
/// Width and height of a panel, px.
const PANEL_SIZE: (f64, f64) = (255.0, 150.0);
/// Horizontal and vertical distance between neighbouring panels, px.
const PANEL_PITCH: (f64, f64) = (330.0, 240.0);
/// Upper left corner of the first panel, px.
const FIRST_CORNER: (f64, f64) = (80.0, 120.0);
/// Width and height of the chart without the pitches of its panels, px.
const MARGINS: (f64, f64) = (90.0, 130.0);
const LEFT_COLOUR: &str = "#0072b2";
const RIGHT_COLOUR: &str = "#d55e00";
const RIGHT_DASHES: &str = "7 4";

/// Draws both sliders' travel over a cycle of every gait, and the limits.
pub fn draw_slider_travel(robot: &Robot) -> String {
    let row_count = robot.gaits().len().div_ceil(COLUMN_COUNT);
    let size = (
        MARGINS.0 + PANEL_PITCH.0 * COLUMN_COUNT as f64,
        MARGINS.1 + PANEL_PITCH.1 * row_count as f64,
    );
    let limits = robot.limits();
    let travel_range = (limits.stroke_min - 5.0, limits.stroke_max + 5.0);
    let mut group = add_title(
        Group::new(),
        60.0,
        "Slider travel over a cycle of each gait",
        "s, mm from the nominal length; grey: beyond the travel that robot.toml allows",
    );
    for (y, colour, dashes, meaning) in [
        (36.0, LEFT_COLOUR, "", "left slider (A1, A4)"),
        (62.0, RIGHT_COLOUR, RIGHT_DASHES, "right slider (A2, A3)"),
    ] {
        group = draw_legend_entry(group, (size.0 - 300.0, y), colour, dashes, meaning);
    }
    for (i, gait) in robot.gaits().iter().enumerate() {
        let plot = Plot {
            corner: (
                FIRST_CORNER.0 + PANEL_PITCH.0 * (i % COLUMN_COUNT) as f64,
                FIRST_CORNER.1 + PANEL_PITCH.1 * (i / COLUMN_COUNT) as f64,
            ),
            size: PANEL_SIZE,
            x_range: (0.0, 1.0),
            y_range: travel_range,
        };
        group = draw_panel(group, &plot, robot, gait);
    }
    render_svg(size, group)
}

fn draw_panel(mut group: Group, plot: &Plot, robot: &Robot, gait: &CheckedGait) -> Group {
    let is_first_column = plot.corner.0 < PANEL_PITCH.0;
    let x_axis = Axis::new(0.25, "phase");
    let y_axis = Axis::new(15.0, if is_first_column { "s, mm" } else { "" });
    group = plot.draw_grid(group, &x_axis, &y_axis);
    for (min, max) in [
        (plot.y_range.0, robot.limits().stroke_min),
        (robot.limits().stroke_max, plot.y_range.1),
    ] {
        let (top_left, bottom_left) = (plot.to_page_point(0.0, max), plot.to_page_point(0.0, min));
        let size = (plot.size.0, bottom_left.1 - top_left.1);
        group = group.add(rectangle(top_left, size, EXCLUDED_COLOUR));
    }
    let samples: Vec<(f64, f64, f64)> = (0..=400)
        .map(|i| f64::from(i) / 400.0)
        .filter_map(|phase| {
            let solution = robot.lizard().solve(&gait.pose(phase)).ok()?;
            Some((phase, solution.left.s, solution.right.s))
        })
        .collect();
    let draw_curve = |travel: fn(&(f64, f64, f64)) -> f64, colour: &str| {
        let points = samples.iter().map(|sample| (sample.0, travel(sample)));
        plot.curve(&points.collect::<Vec<_>>(), colour, 2.5)
    };
    let right_curve = draw_curve(|(_, _, right)| *right, RIGHT_COLOUR);
    group = group
        .add(draw_curve(|(_, left, _)| *left, LEFT_COLOUR))
        .add(right_curve.set("stroke-dasharray", RIGHT_DASHES));
    group = plot.draw_axes(group, &x_axis, &y_axis);
    let travels = || samples.iter().flat_map(|(_, left, right)| [*left, *right]);
    let min_travel = travels().fold(f64::INFINITY, f64::min);
    let max_travel = travels().fold(f64::NEG_INFINITY, f64::max);
    let title_point = (plot.corner.0, plot.corner.1 - 10.0);
    let [min, max] = [min_travel, max_travel].map(|travel| round_to_decimals(travel, 1));
    let range_text = format!("{min:+.1} to {max:+.1} mm");
    let range_point = (plot.corner.0 + plot.size.0, title_point.1);
    group
        .add(text_start(&gait.command(), title_point, 17.0).set("font-weight", "bold"))
        .add(text(&range_text, range_point, 14.0, GREY, Anchor::End))
}
