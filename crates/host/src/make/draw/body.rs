//! The plate and the legs from above.
//!
//! The parts are drawn from the lowest to the highest: feet with their leaf springs, couplers, the plate, cranks and
//! followers, struts. Bars are thinner than the real parts, so that joints stay visible.

use lizard_kinematics::Vector;
use lizard_robot::{LegPoints, Plate};
use svg::node::element::{Circle, Group, Line};

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

/// The page of the drawing, and the robot's position on the page.
pub struct Sheet<Projection> {
    /// The projection from the chassis frame, mm, to the page, pixels.
    pub project: Projection,
    /// Scale of the drawing.
    pub pixels_per_mm: f64,
    /// The robot's rotation on the page, deg counter-clockwise.
    pub rotation_deg: f64,
}

impl<Projection: Fn(Vector) -> (f64, f64)> Sheet<Projection> {
    /// Draws a bar between two points.
    pub fn draw_bar(&self, start: Vector, end: Vector, colour: &str, width_mm: f64) -> Line {
        line(
            (self.project)(start),
            (self.project)(end),
            colour,
            width_mm * self.pixels_per_mm,
        )
    }

    /// Draws a joint: a white disc.
    pub fn draw_joint(&self, point: Vector, radius_mm: f64) -> Circle {
        self.draw_disc(point, radius_mm, "white")
    }

    /// Draws a disc with an edge.
    pub fn draw_disc(&self, point: Vector, radius_mm: f64, fill: &str) -> Circle {
        add_outline(
            circle((self.project)(point), radius_mm * self.pixels_per_mm, fill),
            DARK,
            0.6 * self.pixels_per_mm,
        )
    }

    /// Draws a rectangle that turns with the robot, from its centre, half its size and its corner radius, mm.
    fn draw_rectangle(
        &self,
        centre: Vector,
        half_size: Vector,
        corner_radius: f64,
        fill: &str,
    ) -> Group {
        let (x, y) = (self.project)(centre);
        let [half_width, half_height] =
            [half_size.x, half_size.y].map(|half| half * self.pixels_per_mm);
        let shape = rectangle(
            (x - half_width, y - half_height),
            (2.0 * half_width, 2.0 * half_height),
            fill,
        )
        .set("rx", round_hundredths(corner_radius * self.pixels_per_mm));
        let svg_rotation_deg = round_hundredths(-self.rotation_deg);
        match svg_rotation_deg == 0.0 {
            true => Group::new().add(shape),
            false => Group::new().add(shape.set(
                "transform",
                format!(
                    "rotate({svg_rotation_deg} {} {})",
                    round_hundredths(x),
                    round_hundredths(y)
                ),
            )),
        }
    }

    /// Adds the leg parts beside and below the plate to `group`.
    pub fn draw_feet(
        &self,
        mut group: Group,
        legs: &[LegPoints; 4],
        foot_colours: [&str; 4],
    ) -> Group {
        for (servo, leg) in legs.iter().enumerate() {
            let [driven_joint, idle_joint] = leg.joints;
            group = group
                .add(self.draw_bar(idle_joint, leg.foot, LEAF_COLOUR, 2.2))
                .add(self.draw_disc(leg.foot, FOOT_RADIUS_MM, foot_colours[servo]))
                .add(self.draw_bar(driven_joint, idle_joint, SERVO_COLOURS[servo], 4.2));
        }
        group
    }

    /// Adds the plate and its servos to `group`.
    pub fn draw_plate(&self, mut group: Group, plate: &Plate) -> Group {
        let centre = Vector::default();
        let half_size_with = |margin: f64| plate.half_size + Vector::new(margin, margin);
        for (margin, colour) in [(EDGE_WIDTH_MM, EDGE_COLOUR), (0.0, PLATE_COLOUR)] {
            for [start, end] in plate.arms.as_flattened() {
                group = group.add(self.draw_bar(
                    *start,
                    *end,
                    colour,
                    2.0 * (plate.arm_half_width + margin),
                ));
            }
            group = group.add(self.draw_rectangle(
                centre,
                half_size_with(margin),
                plate.corner_radius + margin,
                colour,
            ));
        }
        for (case_centre, colour) in plate.case_centres.into_iter().zip(SERVO_COLOURS) {
            let case = self.draw_rectangle(case_centre, plate.case_size * 0.5, 1.3, colour);
            group = group.add(case.set("fill-opacity", 0.35));
        }
        group
    }

    /// Adds the leg parts above the plate, and the servo arms that drive the struts, to `group`.
    pub fn draw_cranks(
        &self,
        mut group: Group,
        shafts: [Vector; 4],
        legs: &[LegPoints; 4],
    ) -> Group {
        for (servo, leg) in legs.iter().enumerate() {
            let [servo_arm_tip, crank_joint] = leg.strut_anchors;
            group = group.add(self.draw_bar(leg.pivots[0], crank_joint, SERVO_COLOURS[servo], 3.2));
            for (pivot, joint) in leg.pivots.into_iter().zip(leg.joints) {
                group = group
                    .add(self.draw_bar(pivot, joint, SERVO_COLOURS[servo], 3.2))
                    .add(self.draw_joint(pivot, 1.7))
                    .add(self.draw_joint(joint, 1.7));
            }
            group = group
                .add(self.draw_bar(servo_arm_tip, crank_joint, STRUT_COLOUR, 1.6))
                .add(self.draw_joint(crank_joint, 1.2))
                .add(self.draw_bar(shafts[servo], servo_arm_tip, SERVO_COLOURS[servo], 3.0));
        }
        group
    }

    /// Adds the screws that hold the struts to the servo arms. They lie above all other parts.
    pub fn draw_strut_screws(&self, group: Group, legs: &[LegPoints; 4]) -> Group {
        let screws = legs
            .iter()
            .map(|leg| self.draw_joint(leg.strut_anchors[0], 1.2));
        screws.fold(group, Group::add)
    }
}
