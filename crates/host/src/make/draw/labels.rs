//! Labels of the view from above.

use lizard_kinematics::Vector;
use lizard_robot::servo::SERVO_NAMES;
use svg::node::element::Group;

use super::cranks::offset_point;
use super::top_view::{LABEL_GAP_MM, PAGE_SIZE, SKIN_REACH_MM, TopView};
use crate::shared::shapes::{
    Anchor, DARK, GREY, SERVO_COLOURS, SERVO_POSITIONS, line, pin_name, text, text_middle,
    text_start,
};

/// Distance of the servos' names from the middle of the page, horizontally and vertically, pixels.
const SERVO_NAME_DISTANCE: f64 = 347.0;

impl TopView<'_> {
    /// Adds to `group` the labels of servos and parts, with angles and dimensions, the axes and the scale bar.
    pub(super) fn draw_labels(&self, mut group: Group) -> Group {
        let angles = self.angles();
        for servo in 0..4 {
            let shaft = self.shafts()[servo];
            let side = if matches!(servo, 0 | 3) { -1.0 } else { 1.0 };
            let y_sign = shaft.y.signum();
            let anchor = outward_anchor(side);
            let colour = SERVO_COLOURS[servo];
            let x = PAGE_SIZE.0 / 2.0 + side * SERVO_NAME_DISTANCE;
            let y = PAGE_SIZE.1 / 2.0 - y_sign * SERVO_NAME_DISTANCE;
            let shaft_point = self.to_page_point(shaft + Vector::new(side * 3.5, y_sign * 2.0));
            let pin = pin_name(self.robot.servos()[servo].pin);
            let name_text = format!("{} · {pin}", SERVO_NAMES[servo]);
            let symbol = ["θ1", "θ4", "θ8", "θ5"][servo];
            let angle_text = format!("{symbol} = {:.2}°", angles[servo].rem_euclid(360.0));
            let pointer = line((x + 6.0 * -side, y - 4.0), shaft_point, colour, 1.2);
            let name = text(&name_text, (x, y - 8.0), 20.0, colour, anchor);
            group = group
                .add(pointer.set("stroke-dasharray", "3 4"))
                .add(name.set("font-weight", "bold"))
                .add(text(&angle_text, (x, y + 16.0), 18.0, DARK, anchor));
        }
        group = self.draw_part_labels(group);
        draw_axes_and_scale_bar(group, self.pixels_per_mm)
    }

    /// Adds to `group` the labels of head, tail, sliders and feet.
    fn draw_part_labels(&self, mut group: Group) -> Group {
        let solution = self.solution;
        let head = solution.head_point();
        let tail = solution.tail_point();
        let format_point =
            |name: &str, point: Vector| format!("{name} ({:.1}, {:.1}) mm", point.x, point.y);
        let (x, y) = self.to_page_point(
            head + Vector::new(0.0, SKIN_REACH_MM * self.size_ratio() + LABEL_GAP_MM),
        );
        group = group.add(text_middle(&format_point("head", head), (x, y), 18.0));
        let (x, y) = self.to_page_point(tail + Vector::new(0.0, -26.0 * self.size_ratio() - 8.0));
        group = group.add(text_middle(&format_point("tail", tail), (x, y), 18.0));
        for (side, slider) in [(-1.0, solution.left), (1.0, solution.right)] {
            let anchor = outward_anchor(side);
            let (x, y) = self.to_page_point(Vector::new(side * 50.0 * self.size_ratio(), 0.0));
            let travel_text = match slider.s.abs() < 0.05 {
                true => "s = 0.0 mm".to_owned(),
                false => format!("s = {:+.1} mm", slider.s),
            };
            group = group
                .add(text("slider", (x, y - 4.0), 17.0, GREY, anchor))
                .add(text(&travel_text, (x, y + 18.0), 17.0, GREY, anchor));
        }
        for (servo, position) in SERVO_POSITIONS.into_iter().enumerate() {
            let foot = self.foot(servo);
            let side = foot.x.signum();
            let point = self.to_page_point(foot + Vector::new(side * 24.0, -2.0));
            let name = format!("{position} foot");
            group = group.add(text(&name, point, 17.0, GREY, outward_anchor(side)));
        }
        group
    }
}

/// Returns the anchor of a text that leads away from the robot; `side` is -1 on the left and 1 on the right.
fn outward_anchor(side: f64) -> Anchor {
    match side < 0.0 {
        true => Anchor::End,
        false => Anchor::Start,
    }
}

/// Draws the axes of the chassis frame and a scale bar.
fn draw_axes_and_scale_bar(mut group: Group, pixels_per_mm: f64) -> Group {
    let origin = (50.0, PAGE_SIZE.1 - 50.0);
    for (degrees, name) in [(0.0, "x, right"), (90.0, "y, forward")] {
        let tip = offset_point(origin, degrees, 62.0);
        let barb_end = |lean_deg: f64| offset_point(tip, degrees + lean_deg, 11.0);
        let name_point = match degrees == 0.0 {
            true => (tip.0 + 10.0, tip.1 + 6.0),
            false => (tip.0 - 10.0, tip.1 - 12.0),
        };
        group = group
            .add(line(origin, tip, DARK, 2.0))
            .add(line(tip, barb_end(155.0), DARK, 2.0))
            .add(line(tip, barb_end(-155.0), DARK, 2.0))
            .add(text_start(name, name_point, 16.0));
    }
    let end = (PAGE_SIZE.0 - 60.0, PAGE_SIZE.1 - 48.0);
    let start = (end.0 - 50.0 * pixels_per_mm, end.1);
    for (x, y) in [start, end] {
        group = group.add(line((x, y - 7.0), (x, y + 7.0), DARK, 2.0));
    }
    let label_point = ((start.0 + end.0) / 2.0, end.1 - 12.0);
    group
        .add(line(start, end, DARK, 2.0))
        .add(text_middle("50 mm", label_point, 16.0))
}
