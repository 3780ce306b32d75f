//! The performance charts over the whole design space.

use std::collections::HashMap;

use lizard_paper::design::{ChartPoint, PROPORTION_SUM, Proportions};
use svg::node::element::Group;

use super::square_plot;
use crate::shared::plot::{Axis, ColourScale, VIRIDIS};
use crate::shared::shapes::{add_outline, add_title, render_svg, text_start};

/// Width and height of the page, px.
const PAGE_SIZE: (f64, f64) = (1530.0, 570.0);
/// Width and height of each panel, px.
const PANEL_SIZE: f64 = 340.0;

/// Draws the workspace area, the radius of the maximal inscribed circle and the mean conditioning index over r1 and r2.
pub fn draw_performance(points: &[ChartPoint], step: f64) -> String {
    let to_cell = |r1: f64, r2: f64| ((r1 / step).round() as i64, (r2 / step).round() as i64);
    let cells: HashMap<_, _> = points
        .iter()
        .map(|p| (to_cell(p.proportions.r1, p.proportions.r2), p))
        .collect();
    let find_point = |r1: f64, r2: f64| cells.get(&to_cell(r1, r2)).copied();
    type ValueFn = fn(&ChartPoint) -> Option<f64>;
    let radius_of: ValueFn = |p| (p.performance.r_mic > 0.0).then_some(p.performance.r_mic);
    let mean_lci_of: ValueFn = |p| p.performance.lci.map(|lci| lci.mean);
    let panels: [(&str, ValueFn, f64, usize); 3] = [
        ("workspace area / D²", |p| Some(p.performance.area), 2.5, 2),
        ("radius of the inscribed circle / D", radius_of, 0.5, 2),
        ("mean LCI in the inscribed circle", mean_lci_of, 1.0, 1),
    ];
    let mut group = add_title(
        Group::new(),
        90.0,
        "Performance charts of the five-bar",
        "every design r1 + r2 + r3 = 0.9 (crank, coupler, half base, in units of D); dashed: r3 = 0.1 to 0.4; white: no design; ring: the paper's design",
    );
    for (i, (name, value_of, max, decimals)) in panels.into_iter().enumerate() {
        let corner = (90.0 + 480.0 * i as f64, 150.0);
        let plot = square_plot(corner, PANEL_SIZE, (0.0, PROPORTION_SUM));
        let scale = ColourScale {
            min: 0.0,
            max,
            colours: VIRIDIS,
        };
        let step_count = (PROPORTION_SUM / step).round() as usize;
        // Cells are centred on the grid points, so the map extends half a cell beyond the axes.
        let map_size = PANEL_SIZE * (PROPORTION_SUM + step) / PROPORTION_SUM;
        let map_range = (-step / 2.0, PROPORTION_SUM + step / 2.0);
        let map_corner = plot.to_page_point(map_range.0, map_range.1);
        let map_plot = square_plot(map_corner, map_size, map_range);
        let x_axis = Axis::new(0.1, "r1, crank");
        let y_axis = Axis::new(0.1, if i == 0 { "r2, coupler" } else { "" });
        group = plot.draw_grid(group, &x_axis, &y_axis);
        group = map_plot.draw_map(group, (step_count + 1, step_count + 1), |x, y| {
            let value = find_point(x, y).and_then(value_of);
            value.map(|value| scale.colour(value))
        });
        for r3 in [0.1, 0.2, 0.3, 0.4] {
            let max = PROPORTION_SUM - r3;
            let r3_line = plot.line((0.0, max), (max, 0.0), "white", 0.8);
            group = group.add(r3_line.set("stroke-dasharray", "3 4"));
        }
        let paper_point = (Proportions::PAPER.r1, Proportions::PAPER.r2);
        for (colour, width) in [("white", 5.0), ("#d55e00", 2.5)] {
            let ring = plot.circle(paper_point, 7.0, "none");
            group = group.add(add_outline(ring, colour, width));
        }
        group = plot.draw_axes(group, &x_axis, &y_axis);
        group = group.add(text_start(name, (corner.0, 128.0), 17.0));
        let key_corner = (corner.0 + PANEL_SIZE + 20.0, 150.0);
        group = scale.draw_key(group, key_corner, PANEL_SIZE, "", decimals);
    }
    render_svg(PAGE_SIZE, group)
}
