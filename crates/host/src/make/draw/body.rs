//! The plate and the legs from above, as built; every drawing of the robot contains them.
//!
//! The parts are drawn from the lowest to the highest: feet with the leaves that carry them, couplers, the plate,
//! cranks and followers, struts. Bars are thinner than the real parts, so that joints stay visible.

use lizard_kinematics::Vector;
use lizard_robot::{LegPlace, Plate};
use svg::node::element::{Circle, Group, Line};

use crate::shared::ink::{DARK, SERVO, circle, edged, fixed, line, rectangle};

const PLATE_COLOUR: &str = "#f4f1ea";
const EDGE_COLOUR: &str = "#b8b0a0";
const LEAF_COLOUR: &str = "#8a8a8a";
const STRUT_COLOUR: &str = "#6b6b6b";
/// Radius of a foot, mm.
const FOOT_RADIUS: f64 = 6.5;
/// Width of the plate's edge, mm.
const RIM_WIDTH: f64 = 0.6;

/// A page onto which the robot is drawn.
pub struct Sheet<Projection> {
    /// The projection from mm in the chassis frame to the page.
    pub project: Projection,
    /// The length of 1 mm on the page.
    pub scale: f64,
    /// The robot's turn on the page, deg counter-clockwise.
    pub turn: f64,
}

impl<Projection: Fn(Vector) -> (f64, f64)> Sheet<Projection> {
    /// A bar between two points.
    pub fn bar(&self, from: Vector, to: Vector, colour: &str, width_mm: f64) -> Line {
        line(
            (self.project)(from),
            (self.project)(to),
            colour,
            width_mm * self.scale,
        )
    }

    /// A joint: a white disc.
    pub fn joint(&self, point: Vector, radius_mm: f64) -> Circle {
        self.disc(point, radius_mm, "white")
    }

    /// A disc with an edge.
    pub fn disc(&self, point: Vector, radius_mm: f64, fill: &str) -> Circle {
        edged(
            circle((self.project)(point), radius_mm * self.scale, fill),
            DARK,
            0.6 * self.scale,
        )
    }

    /// A rectangle that turns with the robot, given by its centre, half its size and the radius of its corners, mm.
    fn rectangle(&self, middle: Vector, half: Vector, corner: f64, fill: &str) -> Group {
        let (x, y) = (self.project)(middle);
        let [half_width, half_height] = [half.x, half.y].map(|half| half * self.scale);
        let shape = rectangle(
            (x - half_width, y - half_height),
            (2.0 * half_width, 2.0 * half_height),
            fill,
        )
        .set("rx", fixed(corner * self.scale));
        let turn = fixed(-self.turn);
        match turn == 0.0 {
            true => Group::new().add(shape),
            false => Group::new().add(shape.set(
                "transform",
                format!("rotate({turn} {} {})", fixed(x), fixed(y)),
            )),
        }
    }

    /// Adds the parts of the legs beside and below the plate to `group`; `pads` are the colours of the feet.
    pub fn draw_feet(&self, mut group: Group, legs: &[LegPlace; 4], pads: [&str; 4]) -> Group {
        for (i, leg) in legs.iter().enumerate() {
            let [driven_joint, idle_joint] = leg.joints;
            group = group
                .add(self.bar(idle_joint, leg.foot, LEAF_COLOUR, 2.2))
                .add(self.disc(leg.foot, FOOT_RADIUS, pads[i]))
                .add(self.bar(driven_joint, idle_joint, SERVO[i], 4.2));
        }
        group
    }

    /// Adds the plate and the servos in it to `group`.
    pub fn draw_plate(&self, mut group: Group, plate: &Plate) -> Group {
        let middle = Vector::default();
        let half_size_with = |margin: f64| plate.half + Vector::new(margin, margin);
        for (margin, colour) in [(RIM_WIDTH, EDGE_COLOUR), (0.0, PLATE_COLOUR)] {
            for [from, to] in plate.arms.as_flattened() {
                group = group.add(self.bar(*from, *to, colour, 2.0 * (plate.arm + margin)));
            }
            group = group.add(self.rectangle(
                middle,
                half_size_with(margin),
                plate.corner + margin,
                colour,
            ));
        }
        for (case, colour) in plate.cases.into_iter().zip(SERVO) {
            let case = self.rectangle(case, plate.case * 0.5, 1.3, colour);
            group = group.add(case.set("fill-opacity", 0.35));
        }
        group
    }

    /// Adds the parts of the legs above the plate, and the servo arms that drive their struts, to `group`.
    pub fn draw_cranks(
        &self,
        mut group: Group,
        shafts: [Vector; 4],
        legs: &[LegPlace; 4],
    ) -> Group {
        for (i, leg) in legs.iter().enumerate() {
            let [link, crank] = leg.strut;
            group = group.add(self.bar(leg.pivots[0], crank, SERVO[i], 3.2));
            for (pivot, joint) in leg.pivots.into_iter().zip(leg.joints) {
                group = group
                    .add(self.bar(pivot, joint, SERVO[i], 3.2))
                    .add(self.joint(pivot, 1.7))
                    .add(self.joint(joint, 1.7));
            }
            group = group
                .add(self.bar(link, crank, STRUT_COLOUR, 1.6))
                .add(self.joint(crank, 1.2))
                .add(self.bar(shafts[i], link, SERVO[i], 3.0));
        }
        group
    }

    /// Adds the screws that hold the struts to the servo arms. They lie above all other parts.
    pub fn draw_anchors(&self, group: Group, legs: &[LegPlace; 4]) -> Group {
        let screws = legs.iter().map(|leg| self.joint(leg.strut[0], 1.2));
        screws.fold(group, Group::add)
    }
}
