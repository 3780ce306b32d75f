//! Charts of the points that the head can reach, and of the local conditioning index at them.

use lizard_kinematics::{Circle, End, Vector, Workspace};
use lizard_paper::design::{CLAIM, Performance, lci};
use lizard_robot::Robot;
use svg::node::element::{Circle as Ring, Group};

use crate::shared::ink::{DARK, GREY, circle, edged, page, text_start, title};
use crate::shared::plot::{Axis, IMPOSSIBLE, Plot, Scale, VIRIDIS, draw_entry};

const SIZE: (f64, f64) = (1120.0, 900.0);
const X_AXIS: Axis<'static> = Axis::new(20.0, "x, mm from the middle of l0");
const Y_AXIS: Axis<'static> = Axis::new(20.0, "y, mm");
const RED: &str = "#d55e00";
const BLUE: &str = "#0072b2";

/// The four circles, the workspace between them, the inscribed circle, and the
/// head at neutral.
pub fn workspace(robot: &Robot) -> String {
    let bars = robot.lizard().end(End::Head);
    let space = Workspace::of(&bars);
    let reach = (space.outer_radius / 20.0).ceil() * 20.0 + 20.0;
    let plot = Plot {
        corner: (90.0, 90.0),
        size: (720.0, 720.0),
        x: (-reach, reach),
        y: (-reach, reach),
    };
    let mut group = plot.draw_grid(Group::new(), &X_AXIS, &Y_AXIS);
    group = plot.draw_map(group, (480, 480), |x, y| {
        space
            .contains(Vector::new(x, y))
            .then_some(if y >= 0.0 { "#cfe3f1" } else { "#e6e3df" })
    });
    for shaft in [bars.left_shaft(), bars.right_shaft()] {
        for radius in [space.inner_radius, space.outer_radius] {
            group = group
                .add(draw_ring(&plot, shaft, radius, GREY, 1.2).set("stroke-dasharray", "5 4"));
        }
    }
    if let Some(mic) = space.inscribed_circle() {
        group = group.add(draw_ring(&plot, mic.centre, mic.radius, RED, 3.0));
    }
    for path in look_paths(robot) {
        group = group.add(plot.curve(&path, "#009e73", 2.5));
    }
    group = draw_mechanism(group, &plot, robot);
    group = plot.draw_axes(group, &X_AXIS, &Y_AXIS);
    group = title(
        group,
        90.0,
        "Theoretical workspace of the head",
        "all points that both arms reach; the tail has the same behind",
    );
    let performance = Performance::of(&bars, 32);
    let legend_x = 840.0;
    group = draw_entry(group, (legend_x, 120.0), GREY, "5 4", "limits of each arm");
    group = draw_entry(
        group,
        (legend_x, 148.0),
        RED,
        "",
        "maximal inscribed circle",
    );
    group = draw_entry(
        group,
        (legend_x, 176.0),
        "#009e73",
        "",
        "path of the gesture \"look\"",
    );
    group = draw_entry(group, (legend_x, 204.0), DARK, "", "five-bar at neutral");
    let facts = [
        format!("area {:.1} mm²", performance.area),
        format!("upper half {:.1} mm² (blue)", performance.area / 2.0),
        format!("circle: radius {:.2} mm,", performance.r_mic),
        format!("centre (0, {:.2}) mm", performance.y_mic),
    ];
    for (i, fact) in facts.iter().enumerate() {
        group = group.add(text_start(fact, (legend_x, 250.0 + 24.0 * i as f64), 16.0));
    }
    page(SIZE, group)
}

/// The local conditioning index over the upper workspace, with outward elbows.
pub fn conditioning(robot: &Robot) -> String {
    let bars = robot.lizard().end(End::Head);
    let space = Workspace::of(&bars);
    let reach = (space.outer_radius / 20.0).ceil() * 20.0;
    let plot = Plot {
        corner: (90.0, 90.0),
        size: (720.0, 720.0 * 110.0 / 160.0),
        x: (-reach, reach),
        y: (-reach * 0.25, reach * 1.125),
    };
    let scale = Scale {
        least: 0.0,
        most: 1.0,
        colours: VIRIDIS,
    };
    let mut group = plot.draw_grid(Group::new(), &X_AXIS, &Y_AXIS);
    group = plot.draw_map(group, (480, 330), |x, y| {
        let point = Vector::new(x, y);
        space
            .contains(point)
            .then(|| match bars.pose_at_point(point) {
                Ok(pose) if y >= 0.0 && pose.gap.x > 0.0 => scale.colour(lci(&bars, point)),
                _ => IMPOSSIBLE,
            })
    });
    let performance = Performance::of(&bars, 64);
    if let (Some(mic), Some(lci_stats)) = (space.inscribed_circle(), performance.lci) {
        let circle = Circle {
            radius: lci_stats.radius_above,
            ..mic
        };
        group = group
            .add(draw_ring(&plot, mic.centre, mic.radius, "white", 6.0))
            .add(draw_ring(&plot, mic.centre, mic.radius, RED, 3.0))
            .add(draw_ring(&plot, circle.centre, circle.radius, "white", 5.0))
            .add(
                draw_ring(&plot, circle.centre, circle.radius, DARK, 2.0)
                    .set("stroke-dasharray", "7 4"),
            );
        let legend_x = 850.0;
        group = draw_entry(
            group,
            (legend_x - 10.0, 530.0),
            RED,
            "",
            "maximal inscribed circle",
        );
        group = draw_entry(
            group,
            (legend_x - 10.0, 558.0),
            DARK,
            "7 4",
            &format!("all ≥ {CLAIM} within {:.2} mm", lci_stats.radius_above),
        );
        group = group.add(text_start(&format!("in the circle: mean {:.3}, least {:.3}, most {:.3}; above {CLAIM} on {:.1} % of its area", lci_stats.mean, lci_stats.least, lci_stats.most, 100.0 * lci_stats.share_above), (90.0, 690.0), 16.0));
    }
    group = plot.draw_axes(group, &X_AXIS, &Y_AXIS);
    group = scale.draw_key(group, (870.0, 120.0), 360.0, "LCI", 1);
    group = title(
        group,
        90.0,
        "Local conditioning index of the head",
        "outward elbows, spectral norm; grey: cranks crossed, or behind the base",
    );
    page((SIZE.0, 720.0), group)
}

/// A circle in the plot.
fn draw_ring(plot: &Plot, centre: Vector, radius: f64, colour: &str, width: f64) -> Ring {
    edged(
        circle(
            plot.page_point(centre.x, centre.y),
            radius * plot.scale(),
            "none",
        ),
        colour,
        width,
    )
}

/// The closed path of the head in the gesture `look`; empty if the robot does not have that gesture.
fn look_paths(robot: &Robot) -> Vec<Vec<(f64, f64)>> {
    robot
        .gait("look")
        .into_iter()
        .map(|gait| {
            (0..=200)
                .filter_map(|i| robot.lizard().solve(&gait.pose(f64::from(i) / 200.0)).ok())
                .map(|solution| (solution.head.end_point.x, solution.head.end_point.y))
                .collect()
        })
        .collect()
}

fn draw_mechanism(mut group: Group, plot: &Plot, robot: &Robot) -> Group {
    if let Ok(solution) = robot.lizard().solve(&robot.neutral_pose()) {
        let head = &solution.head;
        let points = [
            head.bars.left_shaft(),
            head.left_tip,
            head.end_point,
            head.right_tip,
            head.bars.right_shaft(),
        ]
        .map(|p| (p.x, p.y));
        group = group.add(plot.curve(&points, DARK, 4.0));
        for (i, (x, y)) in points.into_iter().enumerate() {
            let fill = if i % 4 == 0 { BLUE } else { "white" };
            group = group.add(edged(circle(plot.page_point(x, y), 6.0, fill), DARK, 2.0));
        }
    }
    group
}
