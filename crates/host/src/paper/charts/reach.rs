//! The chart of the workspaces of tail, body and legs, seen from above.
//!
//! The paper plots only the head's workspace, and claims that the other workspaces can be plotted in the same way. The
//! tail's workspace mirrors the head's workspace. A slider has no end point, so its middle is plotted. A foot has one
//! degree of freedom, so its workspace is an arc.

use std::collections::HashSet;

use lizard_kinematics::{End, Pose, Side, SliderPose, Solution, Vector, Workspace};
use lizard_robot::Robot;
use svg::node::element::Group;

use super::square_plot;
use crate::shared::plot::{Axis, draw_legend_entry};
use crate::shared::shapes::{
    DARK, GREY, add_outline, add_title, circle, rectangle, render_svg, text_start,
};

/// Width and height of the page, px.
const PAGE_SIZE: (f64, f64) = (1120.0, 900.0);
const AXES: [Axis<'static>; 2] = [
    Axis::new(40.0, "x, mm to the right of the plate's middle"),
    Axis::new(40.0, "y, mm ahead of it"),
];
/// Half the width of the plotted square, mm.
const HALF_WIDTH: f64 = 160.0;
/// Width of a cell in the plotted square, mm.
const CELL_WIDTH: f64 = 2.0;
/// Largest tested servo turn to either side of neutral, deg.
const MAX_TURN_DEG: i32 = 80;
/// Colours of the tail's areas: the area that the linkage allows, and the area that the guard accepts.
const TAIL_COLOURS: [&str; 2] = ["#cfe3f1", "#4a9bd0"];
/// Colours of the sliders' areas: the area that the linkage allows, and the area that the guard accepts.
const SLIDER_COLOURS: [&str; 2] = ["#f9e0cc", "#e08a4a"];
/// Colour of the arcs where the guard accepts a foot.
const LEG_COLOUR: &str = "#117733";

/// Indices of cells in the plotted square.
type Cells = HashSet<(i32, i32)>;

/// Returns the cell that contains a point.
fn to_cell(point: Vector) -> (i32, i32) {
    (
        (point.x / CELL_WIDTH).floor() as i32,
        (point.y / CELL_WIDTH).floor() as i32,
    )
}

/// Draws the workspaces of tail, both sliders and all feet.
pub fn draw_workspaces(robot: &Robot) -> String {
    let plot = square_plot((90.0, 90.0), 720.0, (-HALF_WIDTH, HALF_WIDTH));
    let tail_cells = find_accepted_tail_cells(robot);
    let linkage_cells = find_linkage_slider_cells(robot);
    let slider_cells = find_accepted_slider_cells(robot);
    let cell_count = (2.0 * HALF_WIDTH / CELL_WIDTH) as usize;
    let mut group = plot.draw_grid(Group::new(), &AXES[0], &AXES[1]);
    group = plot.draw_map(group, (cell_count, cell_count), |x, y| {
        let point = Vector::new(x, y);
        let cell = to_cell(point);
        let colours = [
            (slider_cells.contains(&cell), SLIDER_COLOURS[1]),
            (tail_cells.contains(&cell), TAIL_COLOURS[1]),
            (linkage_cells.contains(&cell), SLIDER_COLOURS[0]),
            (is_in_tail_workspace(robot, point), TAIL_COLOURS[0]),
        ];
        let mut colours = colours.into_iter();
        colours.find_map(|(is_in, colour)| is_in.then_some(colour))
    });
    for servo in 0..4 {
        let full_circle = compute_foot_positions(robot, servo, 180, false);
        let guarded_arc = compute_foot_positions(robot, servo, MAX_TURN_DEG, true);
        let full_curve = plot.curve(&full_circle, GREY, 1.2);
        let walk_curve = plot.curve(&compute_foot_path(robot, servo), DARK, 8.0);
        group = group
            .add(full_curve.set("stroke-dasharray", "5 4"))
            .add(plot.curve(&guarded_arc, LEG_COLOUR, 4.0))
            .add(walk_curve.set("stroke-opacity", 0.55));
    }
    for shaft in robot.lizard().shafts() {
        let shaft_circle = plot.circle((shaft.x, shaft.y), 6.0, "white");
        group = group.add(add_outline(shaft_circle, DARK, 2.0));
    }
    group = plot.draw_axes(group, &AXES[0], &AXES[1]);
    group = add_title(
        group,
        90.0,
        "Workspaces of tail, body and legs",
        "from above; light: what the links alone allow, dark: what the guard accepts",
    );
    render_svg(PAGE_SIZE, draw_legend(group))
}

fn draw_legend(mut group: Group) -> Group {
    let legend_x = 840.0;
    let patches = [
        (110.0, TAIL_COLOURS, "tail's point"),
        (142.0, SLIDER_COLOURS, "middle of a slider (the body)"),
    ];
    for (y, [light_colour, dark_colour], label) in patches {
        group = group
            .add(rectangle((legend_x, y), (17.0, 17.0), light_colour))
            .add(rectangle((legend_x + 17.0, y), (17.0, 17.0), dark_colour))
            .add(text_start(label, (legend_x + 44.0, y + 14.0), 15.0));
    }
    let legend_text = |text: &str, y: f64| text_start(text, (legend_x + 44.0, y), 15.0);
    group = draw_legend_entry(group, (legend_x, 190.0), GREY, "5 4", "circle of a foot");
    let accepted_text = "accepted by the guard,";
    group = draw_legend_entry(group, (legend_x, 218.0), LEG_COLOUR, "", accepted_text);
    group = group.add(legend_text("other servos at neutral", 242.0));
    let walk_text = "path of a foot in walk";
    group = draw_legend_entry(group, (legend_x, 268.0), DARK, "", walk_text);
    let shaft = circle((legend_x + 17.0, 300.0), 6.0, "white");
    group
        .add(add_outline(shaft, DARK, 2.0))
        .add(legend_text("shaft of a servo", 305.0))
}

/// Returns the neutral servo angles plus `turns`, deg.
fn angles_from_turns(robot: &Robot, turns: [f64; 4]) -> [f64; 4] {
    let neutral: [f64; 4] = robot.neutral_pose().into();
    std::array::from_fn(|servo| neutral[servo] + turns[servo])
}

/// Returns the solutions that the guard accepts, for all pairs of turns in steps of 1 degree. `turns` converts a pair
/// to the turns of all four servos.
fn find_accepted_solutions(robot: &Robot, turns: impl Fn(f64, f64) -> [f64; 4]) -> Vec<Solution> {
    let turn_range = || (-MAX_TURN_DEG..=MAX_TURN_DEG).map(f64::from);
    let pairs = turn_range().flat_map(|a| turn_range().map(move |b| (a, b)));
    pairs
        .filter_map(|(a, b)| robot.solve_if_allowed(angles_from_turns(robot, turns(a, b))))
        .collect()
}

/// Returns the cells that the tail's point reaches in accepted poses.
fn find_accepted_tail_cells(robot: &Robot) -> Cells {
    let solutions = find_accepted_solutions(robot, |a, b| [0.0, 0.0, a, b]);
    let points = solutions.iter().map(Solution::tail_point);
    points.map(to_cell).collect()
}

/// Returns the cells that the sliders' middles reach in accepted poses. Only mirror-symmetric poses are tested, because
/// the guard accepts the widest range of angles there.
fn find_accepted_slider_cells(robot: &Robot) -> Cells {
    let solutions = find_accepted_solutions(robot, |a, b| [a, -a, -b, b]);
    let points = solutions.iter().flat_map(|solution| {
        Side::ALL.map(|side| compute_slider_middle(robot, side, solution.side(side)))
    });
    points.map(to_cell).collect()
}

/// Returns a slider's middle from the tips of its arms, which are relative to its rear shaft.
fn compute_slider_middle(robot: &Robot, side: Side, pose: &SliderPose) -> Vector {
    robot.lizard().shafts()[side.servos()[1]] + (pose.rear_tip + pose.front_tip) * 0.5
}

/// Returns the cells that the sliders' middles reach at all arm angles for which the travel is within the stroke.
fn find_linkage_slider_cells(robot: &Robot) -> Cells {
    let limits = robot.limits();
    let mut cells = Cells::new();
    for side in Side::ALL {
        let slider = robot.lizard().side(side);
        let directions = || (0..180).map(|step| Vector::from_angle(2.0 * f64::from(step)));
        let pairs = directions().flat_map(|front| directions().map(move |rear| (front, rear)));
        for (front, rear) in pairs {
            let pose = slider.pose_unchecked(rear, front);
            if (limits.stroke_min..=limits.stroke_max).contains(&pose.s) {
                cells.insert(to_cell(compute_slider_middle(robot, side, &pose)));
            }
        }
    }
    cells
}

/// True if a point in the chassis frame is behind the tail's base and within reach of both arms.
fn is_in_tail_workspace(robot: &Robot, point: Vector) -> bool {
    let local_point = robot.lizard().to_end(End::Tail, point);
    local_point.y >= 0.0
        && Workspace::for_five_bar(&robot.lizard().end(End::Tail)).contains(local_point)
}

/// Returns a foot's positions if only its servo turns from neutral, in steps of 1 degree up to `max_turn_deg` to either
/// side. If `is_guarded` is true, positions that the guard refuses are omitted.
fn compute_foot_positions(
    robot: &Robot,
    servo: usize,
    max_turn_deg: i32,
    is_guarded: bool,
) -> Vec<(f64, f64)> {
    let accepted_position = |turn: i32| {
        let mut turns = [0.0; 4];
        turns[servo] = f64::from(turn);
        let angles = angles_from_turns(robot, turns);
        let is_accepted = !is_guarded || robot.solve_if_allowed(angles).is_some();
        is_accepted.then(|| compute_foot_position(robot, servo, angles[servo]))
    };
    let turns = -max_turn_deg..=max_turn_deg;
    turns.filter_map(accepted_position).collect()
}

/// Returns a foot's position with its servo at `angle` (deg), without lag.
fn compute_foot_position(robot: &Robot, servo: usize, angle: f64) -> (f64, f64) {
    let foot = robot.legs()[servo].points_at(angle, angle).foot;
    (foot.x, foot.y)
}

/// Returns a foot's path in the gait `walk`; empty if the robot does not have this gait.
fn compute_foot_path(robot: &Robot, servo: usize) -> Vec<(f64, f64)> {
    let gait = robot.gait("walk").into_iter();
    let poses = gait.flat_map(|gait| (0..=100).map(move |i| gait.pose(f64::from(i) / 100.0)));
    let servo_angle = |pose: Pose| <[f64; 4]>::from(pose)[servo];
    poses
        .map(|pose| compute_foot_position(robot, servo, servo_angle(pose)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::robot_args::built_in_robot;

    #[test]
    fn accepted_tail_points_and_nearly_all_slider_cells_are_within_reach_of_the_links() {
        let robot = built_in_robot("paper");
        let solutions = find_accepted_solutions(&robot, |a, b| [0.0, 0.0, a, b]);
        assert!(solutions.len() > 300, "{}", solutions.len());
        for solution in solutions {
            let is_within_reach = is_in_tail_workspace(&robot, solution.tail_point());
            assert!(is_within_reach, "{solution:?}");
        }
        let accepted_cells = find_accepted_slider_cells(&robot);
        let linkage_cells = find_linkage_slider_cells(&robot);
        let outside_count = accepted_cells.difference(&linkage_cells).count();
        assert!(accepted_cells.len() > 100, "{}", accepted_cells.len());
        assert!(outside_count * 20 < accepted_cells.len(), "{outside_count}");
    }

    #[test]
    fn areas_and_arcs_agree_with_geometry() {
        let robot = built_in_robot("paper");
        // The half behind the tail's base has the same area as the head's upper half in `lizard design`.
        let coordinate = |i: i32| f64::from(i) - 160.5;
        let points =
            (0..321).flat_map(|i| (0..321).map(move |j| Vector::new(coordinate(i), coordinate(j))));
        let points = points.filter(|point| is_in_tail_workspace(&robot, *point));
        let area = points.count() as f64;
        assert!((area / 7446.3 - 1.0).abs() < 0.01, "{area}");
        // A slider's middle is half the sum of two arms of 30 mm, so it lies in a disc with a radius of 30 mm.
        for (x, y) in find_linkage_slider_cells(&robot) {
            let [x, y] = [x, y].map(|index| CELL_WIDTH * (f64::from(index) + 0.5));
            let distance = (x.abs() - 10.0).hypot(y);
            assert!(distance < 30.0 + 2.0 * CELL_WIDTH, "slider at ({x}, {y})");
        }
        // A foot keeps its distance of 45 mm from its hip, 35 mm to the side and 55 mm ahead.
        for (x, y) in compute_foot_positions(&robot, 0, 180, false) {
            let distance = (x + 35.0).hypot(y - 55.0);
            assert!((distance - 45.0).abs() < 0.01, "foot: {x} {y} {distance}");
        }
    }
}
