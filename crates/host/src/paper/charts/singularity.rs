//! The chart of the head servos' angles, with margins, singular curves and the gaits' paths.

use lizard_kinematics::{Check, End, FiveBar, Margins, Pose, SingularPose, Singularity, wrap};
use lizard_robot::{CheckedGait, Robot};
use svg::node::element::Group;

use super::square_plot;
use crate::shared::plot::{Axis, BLUES, ColourScale, EXCLUDED_COLOUR, Plot, draw_legend_entry};
use crate::shared::shapes::{
    DARK, add_outline, add_title, circle, cross, rectangle, render_svg, text_start,
};

/// Width and height of the page, px.
const PAGE_SIZE: (f64, f64) = (1500.0, 860.0);
/// Range of the angles in the left panel, deg.
const ANGLE_RANGE: (f64, f64) = (0.0, 180.0);
/// Colours and dashes of the paths: colours by Okabe and Ito, and other dark colours. Dashes distinguish paths with
/// similar colours.
const PATH_STYLES: [(&str, &str); 10] = [
    ("#000000", ""),
    ("#d55e00", ""),
    ("#117733", ""),
    ("#0b5394", ""),
    ("#aa4499", "7 5"),
    ("#882255", ""),
    ("#882255", "7 5"),
    ("#b58900", ""),
    ("#332288", ""),
    ("#332288", "7 5"),
];
/// Colour of the curves where A1's arm is singular.
const A1_COLOUR: &str = "#882255";
/// Colour of the curves where A2's arm is singular.
const A2_COLOUR: &str = "#b58900";

/// Draws the head's smallest margin over theta1 and theta4, with the gaits' paths.
pub fn draw_singularities(robot: &Robot) -> String {
    let scale = ColourScale {
        min: 0.3,
        max: 1.0,
        colours: BLUES,
    };
    let draw_axes = |group: Group, plot: &Plot, step: f64| {
        let [x_axis, y_axis] =
            ["theta1 (A1), deg", "theta4 (A2), deg"].map(|name| Axis::new(step, name));
        plot.draw_axes(group, &x_axis, &y_axis)
    };
    let left_plot = square_plot((90.0, 110.0), 600.0, ANGLE_RANGE);
    let paths = compute_gait_paths(robot);
    let [x_range, y_range] = enclose_paths(&paths);
    let right_plot = Plot {
        corner: (800.0, 110.0),
        size: (400.0, 400.0),
        x_range,
        y_range,
    };
    let mut group = Group::new();
    for (plot, cell_count) in [(&left_plot, 360), (&right_plot, 200)] {
        group = plot.draw_map(group, (cell_count, cell_count), |x, y| {
            let margin = compute_min_margin(robot, x, y);
            Some(margin.map_or(EXCLUDED_COLOUR, |margin| scale.colour(margin)))
        });
    }
    group = draw_singular_curves(group, &left_plot, robot);
    // The left panel shows the outline of the right panel.
    let (left, top) = left_plot.to_page_point(x_range.0, y_range.1);
    let (right, bottom) = left_plot.to_page_point(x_range.1, y_range.0);
    let outline = rectangle((left, top), (right - left, bottom - top), "none");
    group = group.add(add_outline(outline, DARK, 2.0));
    let styled_paths = || paths.iter().zip(PATH_STYLES.into_iter().cycle());
    for ((_, path), (colour, dashes)) in styled_paths() {
        if path.len() > 1 {
            let curve = right_plot.curve(path, colour, 2.2);
            group = group
                .add(right_plot.curve(path, "white", 4.5))
                .add(curve.set("stroke-dasharray", dashes));
        }
    }
    for ((_, path), (colour, _)) in styled_paths() {
        if let [point] = path[..] {
            let dot = right_plot.circle(point, 6.0, colour);
            group = group.add(add_outline(dot, "white", 1.5));
        }
    }
    group = draw_axes(group, &left_plot, 20.0);
    group = draw_axes(group, &right_plot, 10.0);
    for (i, ((names, path), (colour, dashes))) in styled_paths().enumerate() {
        let point = (1226.0, 124.0 + 27.0 * i as f64);
        let names = names.replace('-', " ");
        if path.len() > 1 {
            group = draw_legend_entry(group, point, colour, dashes, &names);
        } else {
            group = group
                .add(circle((point.0 + 17.0, point.1), 6.0, colour))
                .add(text_start(&names, (point.0 + 44.0, point.1 + 5.0), 15.0));
        }
    }
    group = scale.draw_key(group, (800.0, 640.0 - 20.0), 160.0, "least margin", 1);
    for (y, colour, label) in [
        (640.0, A1_COLOUR, "arm of A1 straight or folded (type 1)"),
        (668.0, A2_COLOUR, "arm of A2 straight or folded (type 1)"),
    ] {
        group = draw_legend_entry(group, (930.0, y), colour, "", label);
    }
    let legend_text = |text: &str, x: f64, y: f64| text_start(text, (x, y), 15.0);
    let excluded_label = "below the robot's limits, or cranks crossed";
    let margins_note = "Margins: type 2, type 1 and front legs.";
    group = group
        .add(cross((947.0, 696.0), 7.0, DARK, 3.0))
        .add(legend_text("crank tips coincide (type 2)", 974.0, 701.0))
        .add(rectangle((930.0, 716.0), (34.0, 18.0), EXCLUDED_COLOUR))
        .add(legend_text(excluded_label, 974.0, 730.0))
        .add(legend_text(margins_note, 930.0, 762.0));
    group = add_title(
        group,
        90.0,
        "Singularities of the head, and where the gaits go",
        "left: all angles of A1 and A2; right: the marked square with the path of each gait",
    );
    render_svg(PAGE_SIZE, group)
}

/// Returns the smallest margin of the head and the front legs, with the tail at neutral. `None` if the pose is
/// impossible or violates a limit other than a slider's stroke.
fn compute_min_margin(robot: &Robot, theta1: f64, theta4: f64) -> Option<f64> {
    let pose = Pose {
        theta1,
        theta4,
        ..robot.neutral_pose()
    };
    let solution = robot.lizard().solve(&pose).ok()?;
    let violates_limit = robot
        .limits()
        .violations(&solution)
        .any(|violation| !matches!(violation.check, Check::StrokeLeft | Check::StrokeRight));
    let Margins { type2, type1, leg } = solution.margins;
    let margins = [type2[0], type1[0], type1[1], leg[0], leg[1]];
    (!violates_limit).then(|| margins.into_iter().fold(1.0, f64::min))
}

/// Returns the paths of all gaits in the plane of theta1 and theta4, each with the names of its gaits. A gait and its
/// reverse have the same path.
fn compute_gait_paths(robot: &Robot) -> Vec<(String, Vec<(f64, f64)>)> {
    let mut paths: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
    for gait in robot.gaits() {
        let path = compute_gait_path(gait);
        let same_path = paths
            .iter_mut()
            .find(|(_, known_path)| are_same_path(known_path, &path));
        match same_path {
            Some((names, _)) => *names += &format!(", {}", gait.name()),
            None => paths.push((gait.name().to_string(), path)),
        }
    }
    paths
}

/// Returns a gait's path in the plane of theta1 and theta4; a single point if neither angle changes.
fn compute_gait_path(gait: &CheckedGait) -> Vec<(f64, f64)> {
    let point_at_step = |i: i32| {
        let [theta1, theta4, ..] = gait.angles(f64::from(i) / 500.0);
        (theta1, theta4)
    };
    let start = point_at_step(0);
    let is_moving =
        (1..500).any(|i| (point_at_step(i).0 - start.0).hypot(point_at_step(i).1 - start.1) > 1e-6);
    match is_moving {
        true => (0..=500).map(point_at_step).collect(),
        false => vec![start],
    }
}

/// True if every point of each path is within 0.5 deg of a point of the other path.
fn are_same_path(first: &[(f64, f64)], second: &[(f64, f64)]) -> bool {
    let is_near = |point: &(f64, f64), path: &[(f64, f64)]| {
        path.iter()
            .any(|other| (point.0 - other.0).hypot(point.1 - other.1) < 0.5)
    };
    first.iter().all(|point| is_near(point, second))
        && second.iter().all(|point| is_near(point, first))
}

/// Returns the ranges of theta1 and theta4 of a square that contains all paths.
fn enclose_paths(paths: &[(String, Vec<(f64, f64)>)]) -> [(f64, f64); 2] {
    let all_points = || paths.iter().flat_map(|(_, path)| path);
    let middle_and_half_range = |coordinate: fn(&(f64, f64)) -> f64| {
        let values = || all_points().map(coordinate);
        let min = values().fold(f64::INFINITY, f64::min);
        let max = values().fold(f64::NEG_INFINITY, f64::max);
        ((min + max) / 2.0, (max - min) / 2.0)
    };
    let (x, half_width) = middle_and_half_range(|point| point.0);
    let (y, half_height) = middle_and_half_range(|point| point.1);
    let half_size = (half_width.max(half_height) + 5.0).ceil();
    [x, y].map(|middle| (middle.round() - half_size, middle.round() + half_size))
}

/// Draws the singular curves within the plot, as short segments.
fn draw_singular_curves(mut group: Group, plot: &Plot, robot: &Robot) -> Group {
    let five_bar = robot.lizard().end(End::Head);
    group = draw_sweep(group, plot, |theta1| {
        five_bar.find_singular_poses(theta1).collect()
    });
    // A sweep over theta1 has few points on steep curves, so a sweep over theta4 follows. The second sweep uses the
    // mirrored five-bar, in which left and right are swapped.
    let mirrored_five_bar = FiveBar {
        base: five_bar.base,
        left_crank_length: five_bar.right_crank_length,
        left_coupler_length: five_bar.right_coupler_length,
        right_coupler_length: five_bar.left_coupler_length,
        right_crank_length: five_bar.left_crank_length,
    };
    group = draw_sweep(group, plot, |theta4| {
        let unmirror = |pose: SingularPose| SingularPose {
            kind: match pose.kind {
                Singularity::LeftArm => Singularity::RightArm,
                Singularity::RightArm => Singularity::LeftArm,
                Singularity::Couplers => Singularity::Couplers,
            },
            theta_left: wrap(180.0 - pose.theta_right),
            theta_right: theta4,
        };
        mirrored_five_bar
            .find_singular_poses(180.0 - theta4)
            .map(unmirror)
            .collect()
    });
    for pose in five_bar.find_coinciding_tip_poses() {
        if pose.theta_left >= 0.0 && pose.theta_right >= 0.0 {
            let position = plot.to_page_point(pose.theta_left, pose.theta_right);
            group = group.add(cross(position, 7.0, DARK, 3.0));
        }
    }
    group
}

/// Sweeps an angle from 0 to 180 deg, and connects each singular pose to the nearest pose of the same kind at the
/// previous angle, if the two are close.
fn draw_sweep(
    mut group: Group,
    plot: &Plot,
    find_poses: impl Fn(f64) -> Vec<SingularPose>,
) -> Group {
    const STEP_DEG: f64 = 0.5;
    let is_inside = |pose: &&SingularPose| {
        let mut thetas = [pose.theta_left, pose.theta_right].into_iter();
        thetas.all(|theta| (0.0..=180.0).contains(&theta))
    };
    let distance_between = |a: &SingularPose, b: &SingularPose| {
        (a.theta_left - b.theta_left).hypot(a.theta_right - b.theta_right)
    };
    let mut previous_poses: Vec<SingularPose> = Vec::new();
    for i in 0..=360 {
        let poses = find_poses(f64::from(i) * STEP_DEG);
        for pose in poses.iter().filter(is_inside) {
            let nearest = previous_poses
                .iter()
                .filter(is_inside)
                .filter(|other| {
                    other.kind == pose.kind && distance_between(other, pose) < 4.0 * STEP_DEG
                })
                .min_by(|a, b| distance_between(a, pose).total_cmp(&distance_between(b, pose)));
            if let Some(previous_pose) = nearest {
                let colour = match pose.kind {
                    Singularity::LeftArm => A1_COLOUR,
                    Singularity::RightArm => A2_COLOUR,
                    Singularity::Couplers => DARK,
                };
                let [start, end] =
                    [previous_pose, pose].map(|pose| (pose.theta_left, pose.theta_right));
                group = group.add(plot.line(start, end, colour, 2.5));
            }
        }
        previous_poses = poses;
    }
    group
}
