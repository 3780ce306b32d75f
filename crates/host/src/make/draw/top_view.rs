//! The mechanism from above, head up: chassis, five-bars, sliders and legs.

use lizard_kinematics::{End, Side, Solution, Vector};
use lizard_robot::{LegPoints, Robot};
use svg::node::element::{Group, Path};

use crate::shared::shapes::{DARK, SERVO_COLOURS, add_outline, circle, render_svg};

/// Width and height of the page, pixels.
pub(super) const PAGE_SIZE: (f64, f64) = (1000.0, 1110.0);
/// Largest scale of the drawing. The scale is smaller if the robot is too large for the page.
const MAX_PIXELS_PER_MM: f64 = 3.1;
/// Margins of the page in x and y for labels, pixels.
const PAGE_MARGIN: (f64, f64) = (80.0, 28.0);
/// Reach of the skin beyond the head point, mm. Its reach beyond the tail point is smaller.
pub(super) const SKIN_REACH_MM: f64 = 30.0;
/// Distance from the skin to its label, mm.
pub(super) const LABEL_GAP_MM: f64 = 6.0;
/// Half the plate length of the paper's robot, the reference for the skin's coordinates, mm.
const PAPER_PLATE_HALF_LENGTH_MM: f64 = 80.4;

const SKIN_COLOUR: &str = "#e3ecdc";
const STEEL_COLOUR: &str = "#555555";

/// Draws the robot at a solved pose, as SVG text; with names, angles and dimensions if `has_labels` is true.
pub fn draw_top_view(robot: &Robot, solution: &Solution, has_labels: bool) -> String {
    let view = TopView::new(robot, solution);
    let mut group = view.draw_skin(Group::new());
    group = view.draw_leg_parts_below_plate(group);
    group = view.draw_plate(group);
    group = view.draw_leg_parts_above_plate(group);
    for side in Side::ALL {
        group = view.draw_slider(group, side);
    }
    for end in End::ALL {
        group = view.draw_five_bar(group, end);
    }
    group = view.draw_strut_screws(group);
    if has_labels {
        group = view.draw_labels(group);
    }
    render_svg(PAGE_SIZE, group)
}

/// A robot at a solved pose, and the drawing's scale.
pub(super) struct TopView<'a> {
    pub(super) robot: &'a Robot,
    pub(super) solution: &'a Solution,
    /// Scale of the drawing.
    pub(super) pixels_per_mm: f64,
}

impl<'a> TopView<'a> {
    fn new(robot: &'a Robot, solution: &'a Solution) -> Self {
        let view = Self {
            robot,
            solution,
            pixels_per_mm: MAX_PIXELS_PER_MM,
        };
        let legs = view.legs();
        let joints = legs.iter().flat_map(|leg| leg.joints);
        let max_x = joints.map(|joint| joint.x.abs()).fold(1.0, f64::max);
        let ends = [solution.head_point(), solution.tail_point()];
        let label_reach = SKIN_REACH_MM * view.size_ratio() + LABEL_GAP_MM;
        let max_y = ends.map(|end| end.y.abs()).into_iter().fold(1.0, f64::max) + label_reach;
        let scales = [
            (PAGE_SIZE.0, PAGE_MARGIN.0, max_x),
            (PAGE_SIZE.1, PAGE_MARGIN.1, max_y),
        ];
        let scales = scales.map(|(page, margin, mm)| (page / 2.0 - margin) / mm);
        Self {
            pixels_per_mm: scales.into_iter().fold(MAX_PIXELS_PER_MM, f64::min),
            ..view
        }
    }

    /// Returns the position on the page of a point in the chassis frame.
    pub(super) fn to_page_point(&self, point: Vector) -> (f64, f64) {
        let (centre_x, centre_y) = (PAGE_SIZE.0 / 2.0, PAGE_SIZE.1 / 2.0);
        let scale = self.pixels_per_mm;
        (centre_x + scale * point.x, centre_y - scale * point.y)
    }

    /// Returns the size of the robot's plate relative to the plate of the paper's robot.
    pub(super) fn size_ratio(&self) -> f64 {
        self.robot.plate().half_size.y / PAPER_PLATE_HALF_LENGTH_MM
    }

    /// Returns the servo angles, deg.
    pub(super) fn angles(&self) -> [f64; 4] {
        self.solution.pose.into()
    }

    /// Returns the positions of the servos' shafts in the chassis frame, mm.
    pub(super) fn shafts(&self) -> [Vector; 4] {
        self.robot.lizard().shafts()
    }

    /// Draws a lizard's pale outline, so that the mechanism looks like an animal.
    fn draw_skin(&self, group: Group) -> Group {
        // The coordinates are in mm for the paper's robot, and are multiplied by `size_ratio`. The ends of the skin
        // follow the head point and the tail point; its flanks are fixed to the chassis.
        let size_ratio = self.size_ratio();
        let (head, tail) = (self.solution.head_point(), self.solution.tail_point());
        let chassis = Vector::default();
        // Each C begins a curve with two control points and an end.
        let points = [
            ("M ", head, 0.0, 30.0),
            ("C ", head, 18.0, 30.0),
            ("", head, 27.0, 2.0),
            ("", chassis, 27.0, 84.0),
            ("C ", chassis, 44.0, 50.0),
            ("", chassis, 44.0, -50.0),
            ("", chassis, 27.0, -84.0),
            ("C ", tail, 22.0, 0.0),
            ("", tail, 6.0, -6.0),
            ("", tail, 3.0, -26.0),
            ("L ", tail, -3.0, -26.0),
            ("C ", tail, -6.0, -6.0),
            ("", tail, -22.0, 0.0),
            ("", chassis, -27.0, -84.0),
            ("C ", chassis, -44.0, -50.0),
            ("", chassis, -44.0, 50.0),
            ("", chassis, -27.0, 84.0),
            ("C ", head, -27.0, 2.0),
            ("", head, -18.0, 30.0),
            ("", head, 0.0, 30.0),
        ];
        let commands = points.map(|(command, base, x, y)| {
            let (x, y) = self.to_page_point(base + Vector::new(x, y) * size_ratio);
            format!("{command}{x:.1} {y:.1}")
        });
        let outline = Path::new().set("d", commands.join(" ") + " Z");
        let draw_eye = |x: f64| {
            let centre = self.to_page_point(head + Vector::new(x, 12.0) * size_ratio);
            circle(centre, 6.5, DARK)
        };
        group
            .add(outline.set("fill", SKIN_COLOUR))
            .add(draw_eye(-9.0))
            .add(draw_eye(9.0))
    }

    /// Draws a side's slider, a prismatic joint between the arms of the front and the rear servo.
    fn draw_slider(&self, mut group: Group, side: Side) -> Group {
        let ([front, rear], slider) = (side.servos(), self.solution.side(side));
        let rear_shaft = self.shafts()[rear];
        let (rear_tip, front_tip) = (rear_shaft + slider.rear_tip, rear_shaft + slider.front_tip);
        let links = self.robot.lizard().links;
        let tube_length = match side {
            Side::Left => links.l12,
            Side::Right => links.l17,
        };
        let direction = (front_tip - rear_tip) * (1.0 / slider.d);
        let tube_end = rear_tip + direction * tube_length;
        group = group
            .add(self.draw_bar(rear_tip, front_tip, STEEL_COLOUR, 1.8))
            .add(self.draw_bar(rear_tip, tube_end, "#9a9a9a", 5.0));
        for (servo, tip) in [(front, front_tip), (rear, rear_tip)] {
            let arm = self.draw_bar(self.shafts()[servo], tip, SERVO_COLOURS[servo], 3.0);
            group = group
                .add(arm.set("stroke-opacity", 0.75))
                .add(self.draw_joint(tip, 2.0));
        }
        group
    }

    /// Draws the five-bar of the head or tail: two cranks, two couplers, and the end point.
    fn draw_five_bar(&self, mut group: Group, end: End) -> Group {
        let (servos, point) = (end.servos(), self.solution.point(end));
        let scale = self.pixels_per_mm;
        let crank_tips = self.solution.crank_tips();
        for servo in servos {
            group = group.add(self.draw_bar(crank_tips[servo], point, STEEL_COLOUR, 3.4));
        }
        for servo in servos {
            let (shaft, tip) = (self.shafts()[servo], crank_tips[servo]);
            let shaft_point = self.to_page_point(shaft);
            group = group
                .add(self.draw_bar(shaft, tip, SERVO_COLOURS[servo], 4.6))
                .add(self.draw_joint(tip, 2.3))
                .add(circle(shaft_point, 3.4 * scale, DARK))
                .add(circle(shaft_point, 1.2 * scale, "white"));
        }
        let end_disc = circle(self.to_page_point(point), 3.4 * scale, "#f0e442");
        group.add(add_outline(end_disc, DARK, 2.5))
    }

    /// Returns the position of a servo's foot in the chassis frame, mm.
    pub(super) fn foot(&self, servo: usize) -> Vector {
        self.legs()[servo].foot
    }

    /// Returns the positions of the legs' points at this pose if no leg lags behind its servo.
    pub(super) fn legs(&self) -> [LegPoints; 4] {
        let angles = self.angles();
        std::array::from_fn(|leg| self.robot.legs()[leg].points_at(angles[leg], angles[leg]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::robot_args::built_in_robot;
    use lizard_kinematics::Pose;

    /// Passes the paper's robot at `pose` to `check_view`; `None` is the neutral pose.
    fn with_view(pose: Option<Pose>, check_view: impl Fn(&TopView)) {
        let robot = built_in_robot("paper");
        let pose = pose.unwrap_or_else(|| robot.neutral_pose());
        let solution = robot.lizard().solve(&pose).expect("the pose closes");
        check_view(&TopView::new(&robot, &solution));
    }

    #[test]
    fn the_feet_are_beside_the_hips_at_neutral() {
        with_view(None, |view| {
            let feet = [0, 1, 2, 3].map(|servo| view.foot(servo));
            let feet = feet.map(|foot| (foot.x.round(), foot.y.round()));
            let expected = [(-80.0, 55.0), (80.0, 55.0), (80.0, -55.0), (-80.0, -55.0)];
            assert_eq!(feet, expected);
        });
    }

    #[test]
    fn a_forward_turn_moves_the_foot_forward() {
        use lizard_robot::servo::FORWARD_TURN_SIGN;
        with_view(None, |view| {
            for servo in 0..4 {
                let mut angles: [f64; 4] = view.angles();
                angles[servo] += 10.0 * FORWARD_TURN_SIGN[servo];
                let foot_before = view.foot(servo);
                with_view(Some(angles.into()), |moved_view| {
                    assert!(moved_view.foot(servo).y > foot_before.y + 7.0);
                });
            }
        });
    }

    #[test]
    fn a_large_robot_fits_the_page() {
        let robot = built_in_robot("large");
        let solution = robot.lizard().solve(&robot.neutral_pose());
        let solution = solution.expect("the neutral pose closes");
        let view = TopView::new(&robot, &solution);
        let ends = [solution.head_point(), solution.tail_point()];
        let joints = view.legs().into_iter().flat_map(|leg| leg.joints);
        for joint in joints.chain(ends) {
            let (x, y) = view.to_page_point(joint);
            assert!((50.0..PAGE_SIZE.0 - 50.0).contains(&x), "{x}");
            assert!((50.0..PAGE_SIZE.1 - 50.0).contains(&y), "{y}");
        }
    }

    #[test]
    fn labels_can_be_omitted() {
        with_view(None, |view| {
            assert!(draw_top_view(view.robot, view.solution, true).contains("θ1 = 138.59°"));
            assert!(!draw_top_view(view.robot, view.solution, false).contains("<text"));
        });
    }
}
