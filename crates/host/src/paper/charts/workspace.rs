//! Charts of the head's workspace and of the local conditioning index in the workspace.

use lizard_kinematics::{End, Vector, Workspace};
use lizard_paper::design::{CLAIMED_LCI, Performance, lci};
use lizard_robot::Robot;
use svg::node::element::{Circle, Group};

use super::square_plot;
use crate::shared::plot::{Axis, ColourScale, EXCLUDED_COLOUR, Plot, VIRIDIS, draw_legend_entry};
use crate::shared::shapes::{DARK, GREY, add_outline, add_title, render_svg, text_start};

/// Width and height of the page, px.
const PAGE_SIZE: (f64, f64) = (1120.0, 900.0);
const X_AXIS: Axis<'static> = Axis::new(20.0, "x, mm from the middle of l0");
const Y_AXIS: Axis<'static> = Axis::new(20.0, "y, mm");
/// Colour of the maximal inscribed circle.
const CIRCLE_COLOUR: &str = "#d55e00";
/// Colour of the head's path in the gesture `look`.
const LOOK_COLOUR: &str = "#009e73";
const SHAFT_COLOUR: &str = "#0072b2";

/// Draws the limits of each arm, the workspace between them, the inscribed circle, the head's path in the gesture
/// `look`, and the five-bar at neutral.
pub fn draw_workspace(robot: &Robot) -> String {
    let five_bar = robot.lizard().end(End::Head);
    let workspace = Workspace::for_five_bar(&five_bar);
    let half_range = (workspace.outer_radius / 20.0).ceil() * 20.0 + 20.0;
    let plot = square_plot((90.0, 90.0), 720.0, (-half_range, half_range));
    let mut group = plot.draw_grid(Group::new(), &X_AXIS, &Y_AXIS);
    group = plot.draw_map(group, (480, 480), |x, y| {
        workspace
            .contains(Vector::new(x, y))
            .then_some(if y >= 0.0 { "#cfe3f1" } else { "#e6e3df" })
    });
    for shaft in [five_bar.left_shaft(), five_bar.right_shaft()] {
        for radius in [workspace.inner_radius, workspace.outer_radius] {
            let ring = draw_ring(&plot, shaft, radius, GREY, 1.2);
            group = group.add(ring.set("stroke-dasharray", "5 4"));
        }
    }
    if let Some(mic) = workspace.inscribed_circle() {
        group = group.add(draw_ring(&plot, mic.centre, mic.radius, CIRCLE_COLOUR, 3.0));
    }
    if let Some(path) = compute_look_path(robot) {
        group = group.add(plot.curve(&path, LOOK_COLOUR, 2.5));
    }
    group = draw_five_bar(group, &plot, robot);
    group = plot.draw_axes(group, &X_AXIS, &Y_AXIS);
    group = add_title(
        group,
        90.0,
        "Theoretical workspace of the head",
        "all points that both arms reach",
    );
    let performance = Performance::compute(&five_bar, 32);
    let legend_x = 840.0;
    for (y, colour, dashes, meaning) in [
        (120.0, GREY, "5 4", "limits of each arm"),
        (148.0, CIRCLE_COLOUR, "", "maximal inscribed circle"),
        (176.0, LOOK_COLOUR, "", "path of the gesture \"look\""),
        (204.0, DARK, "", "five-bar at neutral"),
    ] {
        group = draw_legend_entry(group, (legend_x, y), colour, dashes, meaning);
    }
    let facts = [
        format!("area {:.1} mm²", performance.area),
        format!("upper half {:.1} mm² (blue)", performance.area / 2.0),
        format!("circle: radius {:.2} mm,", performance.r_mic),
        format!("centre (0, {:.2}) mm", performance.y_mic),
    ];
    for (i, fact) in facts.iter().enumerate() {
        group = group.add(text_start(fact, (legend_x, 250.0 + 24.0 * i as f64), 16.0));
    }
    render_svg(PAGE_SIZE, group)
}

/// Draws the local conditioning index in the upper workspace, with outward elbows.
pub fn draw_conditioning(robot: &Robot) -> String {
    let five_bar = robot.lizard().end(End::Head);
    let workspace = Workspace::for_five_bar(&five_bar);
    let half_range = (workspace.outer_radius / 20.0).ceil() * 20.0;
    let plot = Plot {
        corner: (90.0, 90.0),
        size: (720.0, 720.0 * 110.0 / 160.0),
        x_range: (-half_range, half_range),
        y_range: (-half_range * 0.25, half_range * 1.125),
    };
    let scale = ColourScale {
        min: 0.0,
        max: 1.0,
        colours: VIRIDIS,
    };
    let mut group = plot.draw_grid(Group::new(), &X_AXIS, &Y_AXIS);
    group = plot.draw_map(group, (480, 330), |x, y| {
        let point = Vector::new(x, y);
        workspace
            .contains(point)
            .then(|| match five_bar.pose_at_point(point) {
                Ok(pose) if y >= 0.0 && pose.gap.x > 0.0 => scale.colour(lci(&five_bar, point)),
                _ => EXCLUDED_COLOUR,
            })
    });
    let performance = Performance::compute(&five_bar, 64);
    if let (Some(mic), Some(lci_stats)) = (workspace.inscribed_circle(), performance.lci) {
        let draw_mic_ring =
            |radius: f64, colour, width| draw_ring(&plot, mic.centre, radius, colour, width);
        let lci_radius = lci_stats.radius_above;
        let lci_ring = draw_mic_ring(lci_radius, DARK, 2.0);
        group = group
            .add(draw_mic_ring(mic.radius, "white", 6.0))
            .add(draw_mic_ring(mic.radius, CIRCLE_COLOUR, 3.0))
            .add(draw_mic_ring(lci_radius, "white", 5.0))
            .add(lci_ring.set("stroke-dasharray", "7 4"));
        let radius_text = format!("all ≥ {CLAIMED_LCI} within {lci_radius:.2} mm");
        for (y, colour, dashes, meaning) in [
            (530.0, CIRCLE_COLOUR, "", "maximal inscribed circle"),
            (558.0, DARK, "7 4", &radius_text),
        ] {
            group = draw_legend_entry(group, (840.0, y), colour, dashes, meaning);
        }
        group = group.add(text_start(&format!("in the circle: mean {:.3}, least {:.3}, most {:.3}; above {CLAIMED_LCI} on {:.1} % of its area", lci_stats.mean, lci_stats.min, lci_stats.max, 100.0 * lci_stats.share_above), (90.0, 690.0), 16.0));
    }
    group = plot.draw_axes(group, &X_AXIS, &Y_AXIS);
    group = scale.draw_key(group, (870.0, 120.0), 360.0, "LCI", 1);
    group = add_title(
        group,
        90.0,
        "Local conditioning index of the head",
        "outward elbows, spectral norm; grey: cranks crossed, or behind the base",
    );
    render_svg((PAGE_SIZE.0, 720.0), group)
}

/// Draws a circle whose centre and radius are in the plot's units.
fn draw_ring(plot: &Plot, centre: Vector, radius: f64, colour: &str, width: f64) -> Circle {
    let ring = plot.circle((centre.x, centre.y), radius * plot.scale(), "none");
    add_outline(ring, colour, width)
}

/// Returns the head's path in the gesture `look`; `None` if the robot does not have this gesture.
fn compute_look_path(robot: &Robot) -> Option<Vec<(f64, f64)>> {
    let gait = robot.gait("look")?;
    let solutions =
        (0..=200).filter_map(|i| robot.lizard().solve(&gait.pose(f64::from(i) / 200.0)).ok());
    let end_points = solutions.map(|solution| solution.head.end_point);
    Some(end_points.map(|point| (point.x, point.y)).collect())
}

fn draw_five_bar(mut group: Group, plot: &Plot, robot: &Robot) -> Group {
    if let Ok(solution) = robot.lizard().solve(&robot.neutral_pose()) {
        let head = &solution.head;
        let points = [
            head.five_bar.left_shaft(),
            head.left_tip,
            head.end_point,
            head.right_tip,
            head.five_bar.right_shaft(),
        ]
        .map(|p| (p.x, p.y));
        group = group.add(plot.curve(&points, DARK, 4.0));
        for (i, point) in points.into_iter().enumerate() {
            let fill = if i % 4 == 0 { SHAFT_COLOUR } else { "white" };
            group = group.add(add_outline(plot.circle(point, 6.0, fill), DARK, 2.0));
        }
    }
    group
}
