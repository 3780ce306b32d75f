//! The plate and the legs from above.
//!
//! The parts are drawn from the lowest to the highest: feet with their leaf springs, couplers, the plate, cranks and
//! followers, struts. Bars are thinner than the real parts, so that joints stay visible.

use lizard_kinematics::Vector;
use svg::node::element::{Circle, Group, Line};

use super::top_view::TopView;
use crate::shared::shapes::{
    DARK, SERVO_COLOURS, add_outline, circle, line, rectangle, round_hundredths,
};

const PLATE_COLOUR: &str = "#f4f1ea";
const EDGE_COLOUR: &str = "#b8b0a0";
const LEAF_COLOUR: &str = "#8a8a8a";
const STRUT_COLOUR: &str = "#6b6b6b";
/// Radius of a foot, mm.
const FOOT_RADIUS_MM: f64 = 6.5;
/// Width of the plate's drawn edge, mm.
const EDGE_WIDTH_MM: f64 = 0.6;

impl TopView<'_> {
    /// Draws a bar between two points.
    pub(super) fn draw_bar(&self, start: Vector, end: Vector, colour: &str, width_mm: f64) -> Line {
        let [start, end] = [start, end].map(|point| self.to_page_point(point));
        line(start, end, colour, width_mm * self.pixels_per_mm)
    }

    /// Draws a joint: a white disc.
    pub(super) fn draw_joint(&self, point: Vector, radius_mm: f64) -> Circle {
        self.draw_disc(point, radius_mm, "white")
    }

    /// Draws a disc with an edge.
    fn draw_disc(&self, point: Vector, radius_mm: f64, fill: &str) -> Circle {
        let page_point = self.to_page_point(point);
        let disc = circle(page_point, radius_mm * self.pixels_per_mm, fill);
        add_outline(disc, DARK, 0.6 * self.pixels_per_mm)
    }

    /// Draws a rectangle from its centre, half its size and its corner radius, mm.
    fn draw_rectangle(
        &self,
        centre: Vector,
        half_size: Vector,
        corner_radius: f64,
        fill: &str,
    ) -> Group {
        let (x, y) = self.to_page_point(centre);
        let [half_width, half_height] =
            [half_size.x, half_size.y].map(|half| half * self.pixels_per_mm);
        let corner = (x - half_width, y - half_height);
        let shape = rectangle(corner, (2.0 * half_width, 2.0 * half_height), fill);
        let corner_radius = round_hundredths(corner_radius * self.pixels_per_mm);
        Group::new().add(shape.set("rx", corner_radius))
    }

    /// Adds the leg parts beside and below the plate to `group`.
    pub(super) fn draw_leg_parts_below_plate(&self, mut group: Group) -> Group {
        for (leg, colour) in self.legs().into_iter().zip(SERVO_COLOURS) {
            let [crank_joint, follower_joint] = leg.joints;
            group = group
                .add(self.draw_bar(follower_joint, leg.foot, LEAF_COLOUR, 2.2))
                .add(self.draw_disc(leg.foot, FOOT_RADIUS_MM, DARK))
                .add(self.draw_bar(crank_joint, follower_joint, colour, 4.2));
        }
        group
    }

    /// Adds the plate and its servos to `group`.
    pub(super) fn draw_plate(&self, mut group: Group) -> Group {
        let plate = self.robot.plate();
        let centre = Vector::default();
        for (margin, colour) in [(EDGE_WIDTH_MM, EDGE_COLOUR), (0.0, PLATE_COLOUR)] {
            let arm_width = 2.0 * (plate.arm_half_width + margin);
            for [start, end] in plate.arms.as_flattened() {
                group = group.add(self.draw_bar(*start, *end, colour, arm_width));
            }
            let half_size = plate.half_size + Vector::new(margin, margin);
            let corner_radius = plate.corner_radius + margin;
            group = group.add(self.draw_rectangle(centre, half_size, corner_radius, colour));
        }
        for (case_centre, colour) in plate.case_centres.into_iter().zip(SERVO_COLOURS) {
            let case = self.draw_rectangle(case_centre, plate.case_size * 0.5, 1.3, colour);
            group = group.add(case.set("fill-opacity", 0.35));
        }
        group
    }

    /// Adds the leg parts above the plate, and the servos' links, which drive the struts, to `group`.
    pub(super) fn draw_leg_parts_above_plate(&self, mut group: Group) -> Group {
        let legs = self.legs().into_iter();
        for ((leg, shaft), colour) in legs.zip(self.shafts()).zip(SERVO_COLOURS) {
            let [link_anchor, crank_anchor] = leg.strut_anchors;
            group = group.add(self.draw_bar(leg.pivots[0], crank_anchor, colour, 3.2));
            for (pivot, joint) in leg.pivots.into_iter().zip(leg.joints) {
                group = group
                    .add(self.draw_bar(pivot, joint, colour, 3.2))
                    .add(self.draw_joint(pivot, 1.7))
                    .add(self.draw_joint(joint, 1.7));
            }
            group = group
                .add(self.draw_bar(link_anchor, crank_anchor, STRUT_COLOUR, 1.6))
                .add(self.draw_joint(crank_anchor, 1.2))
                .add(self.draw_bar(shaft, link_anchor, colour, 3.0));
        }
        group
    }

    /// Adds the screws that hold the struts to the servos' links. They lie above all other parts.
    pub(super) fn draw_strut_screws(&self, group: Group) -> Group {
        let anchors = self.legs().map(|leg| leg.strut_anchors[0]);
        let screws = anchors.map(|anchor| self.draw_joint(anchor, 1.2));
        screws.into_iter().fold(group, Group::add)
    }
}
