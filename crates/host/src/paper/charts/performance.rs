//! The performance charts over the whole design space.

use lizard_paper::design::{Point, Proportions, SUM};

use std::collections::HashMap;

use svg::node::element::Group;

use crate::shared::ink::{circle, edged, line, page, text_start, title};
use crate::shared::plot::{Axis, Plot, Scale, VIRIDIS};

const SIZE: (f64, f64) = (1530.0, 570.0);
const PANEL_SIZE: f64 = 340.0;

/// Workspace area, inscribed circle and mean conditioning index over r1 and r2.
pub fn performance(points: &[Point], step: f64) -> String {
    let cell_of = |p: &Proportions| ((p.r1 / step).round() as i64, (p.r2 / step).round() as i64);
    let cells: HashMap<_, _> = points
        .iter()
        .map(|p| (cell_of(&p.proportions), p))
        .collect();
    let look_up = |x: f64, y: f64| {
        cells
            .get(&((x / step).round() as i64, (y / step).round() as i64))
            .copied()
    };
    type Value = fn(&Point) -> Option<f64>;
    let panels: [(&str, Value, f64, usize); 3] = [
        ("workspace area / D²", |p| Some(p.performance.area), 2.5, 2),
        (
            "radius of the inscribed circle / D",
            |p| (p.performance.r_mic > 0.0).then_some(p.performance.r_mic),
            0.5,
            2,
        ),
        (
            "mean LCI in the inscribed circle",
            |p| p.performance.lci.map(|lci| lci.mean),
            1.0,
            1,
        ),
    ];
    let mut group = title(
        Group::new(),
        90.0,
        "Performance charts of the five-bar",
        "every design r1 + r2 + r3 = 0.9 (crank, coupler, half base, in units of D); dashed: r3 = 0.1 to 0.4; white: no design; ring: the paper's design",
    );
    for (i, (name, value, max, digits)) in panels.into_iter().enumerate() {
        let plot = Plot {
            corner: (90.0 + 480.0 * i as f64, 150.0),
            size: (PANEL_SIZE, PANEL_SIZE),
            x: (0.0, SUM),
            y: (0.0, SUM),
        };
        let scale = Scale {
            least: 0.0,
            most: max,
            colours: VIRIDIS,
        };
        let count = (SUM / step).round() as usize;
        // Cells are centred on the grid points, so the map extends half a cell beyond the axes.
        let map_plot = Plot {
            corner: plot.page_point(-step / 2.0, SUM + step / 2.0),
            size: (
                PANEL_SIZE * (SUM + step) / SUM,
                PANEL_SIZE * (SUM + step) / SUM,
            ),
            x: (-step / 2.0, SUM + step / 2.0),
            y: (-step / 2.0, SUM + step / 2.0),
        };
        let axes = (
            Axis::new(0.1, "r1, crank"),
            Axis::new(0.1, if i == 0 { "r2, coupler" } else { "" }),
        );
        group = plot.draw_grid(group, &axes.0, &axes.1);
        group = map_plot.draw_map(group, (count + 1, count + 1), |x, y| {
            look_up(x, y)
                .and_then(value)
                .map(|value| scale.colour(value))
        });
        for r3 in [0.1, 0.2, 0.3, 0.4] {
            let (from, to) = (
                plot.page_point(0.0, SUM - r3),
                plot.page_point(SUM - r3, 0.0),
            );
            group = group.add(line(from, to, "white", 0.8).set("stroke-dasharray", "3 4"));
        }
        let (x, y) = plot.page_point(Proportions::PAPER.r1, Proportions::PAPER.r2);
        group = group
            .add(edged(circle((x, y), 7.0, "none"), "white", 5.0))
            .add(edged(circle((x, y), 7.0, "none"), "#d55e00", 2.5));
        group = plot.draw_axes(group, &axes.0, &axes.1);
        group = group.add(text_start(name, (plot.corner.0, 128.0), 17.0));
        group = scale.draw_key(
            group,
            (plot.corner.0 + PANEL_SIZE + 20.0, 150.0),
            PANEL_SIZE,
            "",
            digits,
        );
    }
    page(SIZE, group)
}
