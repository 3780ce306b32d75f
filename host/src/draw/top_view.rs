//! The mechanism from above, head up: chassis, five-bars, sliders and legs.

use lizard_kinematics::{End, Side, Solution, Vector};
use lizard_robot::{LegPlace, Robot};
use svg::Document;
use svg::node::element::{Group, Path};

use super::ink::{DARK, SERVO, circle, line, rectangle};

pub(super) const SIZE: (f64, f64) = (1000.0, 1110.0);
pub(super) const PIXELS_PER_MM: f64 = 3.1;

/// An SG-90's body seen from above and how far its shaft is from its end, mm.
const SERVO_BODY: (f64, f64) = (12.2, 22.8);
const SERVO_SHAFT: f64 = 6.0;

const SKIN: &str = "#e3ecdc";
const STEEL: &str = "#555555";
const FRAME: &str = "#f4f1ea";

/// A joint of the robot: mm, chassis frame.
pub(super) type Joint = Vector;

/// The robot at a solved pose, as SVG text; with names and measures if
/// `labels`.
#[must_use]
pub fn top_view(robot: &Robot, solution: &Solution, labels: bool) -> String {
    let view = View { robot, solution };
    let mut group = Group::new().add(rectangle((0.0, 0.0), SIZE, "white"));
    group = view.skin(group);
    for servo in 0..4 {
        group = view.leg(group, servo);
    }
    group = view.chassis(group);
    for side in Side::ALL {
        group = view.slider(group, side);
    }
    for end in End::ALL {
        group = view.five_bar(group, end);
    }
    if labels {
        group = view.labels(group);
    }
    Document::new()
        .set("viewBox", (0.0, 0.0, SIZE.0, SIZE.1))
        .set("width", SIZE.0)
        .set("height", SIZE.1)
        .add(group)
        .to_string()
}

pub(super) struct View<'a> {
    pub(super) robot: &'a Robot,
    pub(super) solution: &'a Solution,
}

/// From the chassis frame to the page.
pub(super) fn page(joint: Joint) -> (f64, f64) {
    (
        SIZE.0 / 2.0 + PIXELS_PER_MM * joint.x,
        SIZE.1 / 2.0 - PIXELS_PER_MM * joint.y,
    )
}

fn bar(from: Joint, to: Joint, colour: &str, mm: f64) -> svg::node::element::Line {
    line(page(from), page(to), colour, mm * PIXELS_PER_MM)
}

fn pivot(at: Joint, mm: f64) -> svg::node::element::Circle {
    circle(page(at), mm * PIXELS_PER_MM, "white")
        .set("stroke", DARK)
        .set("stroke-width", 2.0)
}

impl View<'_> {
    pub(super) fn angles(&self) -> [f64; 4] {
        self.solution.pose.into()
    }

    pub(super) fn shafts(&self) -> [Joint; 4] {
        self.robot.lizard().shafts()
    }

    /// Tip of a servo's crank.
    fn crank_tip(&self, servo: usize) -> Joint {
        self.solution.crank_tips()[servo]
    }

    /// A lizard's outline, pale, so that a mechanism looks like an animal.
    fn skin(&self, group: Group) -> Group {
        let at = |x: f64, y: f64| {
            let (x, y) = page(Vector::new(x, y));
            format!("{x:.1} {y:.1}")
        };
        let around = |point: Joint, x: f64, y: f64| at(point.x + x, point.y + y);
        let head = self.solution.head_point();
        let tail = self.solution.tail_point();
        let d = [
            format!("M {}", around(head, 0.0, 30.0)),
            format!(
                "C {} {} {}",
                around(head, 18.0, 30.0),
                around(head, 27.0, 2.0),
                at(27.0, 84.0)
            ),
            format!(
                "C {} {} {}",
                at(44.0, 50.0),
                at(44.0, -50.0),
                at(27.0, -84.0)
            ),
            format!(
                "C {} {} {}",
                around(tail, 22.0, 0.0),
                around(tail, 6.0, -6.0),
                around(tail, 3.0, -26.0)
            ),
            format!("L {}", around(tail, -3.0, -26.0)),
            format!(
                "C {} {} {}",
                around(tail, -6.0, -6.0),
                around(tail, -22.0, 0.0),
                at(-27.0, -84.0)
            ),
            format!(
                "C {} {} {}",
                at(-44.0, -50.0),
                at(-44.0, 50.0),
                at(-27.0, 84.0)
            ),
            format!(
                "C {} {} {} Z",
                around(head, -27.0, 2.0),
                around(head, -18.0, 30.0),
                around(head, 0.0, 30.0)
            ),
        ];
        let outline = Path::new().set("d", d.join(" ")).set("fill", SKIN);
        let eye = |x: f64| circle(page(head + Vector::new(x, 12.0)), 6.5, DARK);
        group.add(outline).add(eye(-9.0)).add(eye(9.0))
    }

    fn chassis(&self, mut group: Group) -> Group {
        let shafts = self.shafts();
        let half = shafts[1].x.max(shafts[2].x) + 9.0;
        let top = shafts[0].y + 8.0;
        let corner = page(Vector::new(-half, top));
        let size = (2.0 * half * PIXELS_PER_MM, 2.0 * top * PIXELS_PER_MM);
        group = group.add(
            rectangle(corner, size, FRAME)
                .set("rx", 16)
                .set("stroke", "#b8b0a0")
                .set("stroke-width", 2),
        );
        for (servo, shaft) in shafts.into_iter().enumerate() {
            // The body reaches from the shaft towards the middle.
            let outward = shaft.y.signum();
            let (low, high) = (
                shaft.y + outward * SERVO_SHAFT,
                shaft.y - outward * (SERVO_BODY.1 - SERVO_SHAFT),
            );
            let corner = page(Vector::new(shaft.x - SERVO_BODY.0 / 2.0, low.max(high)));
            let size = (SERVO_BODY.0 * PIXELS_PER_MM, SERVO_BODY.1 * PIXELS_PER_MM);
            group = group.add(
                rectangle(corner, size, SERVO[servo])
                    .set("rx", 4)
                    .set("fill-opacity", 0.35),
            );
        }
        group
    }

    /// The prismatic joint between the arms of a front and a rear servo.
    fn slider(&self, mut group: Group, side: Side) -> Group {
        let ([front, rear], slider) = (side.servos(), self.solution.side(side));
        let rear_shaft = self.shafts()[rear];
        let (low, high) = (rear_shaft + slider.rear_tip, rear_shaft + slider.front_tip);
        let links = self.robot.lizard().links;
        let tube = match side {
            Side::Left => links.l12,
            Side::Right => links.l17,
        };
        let along = (high - low) * (1.0 / slider.d);
        group =
            group
                .add(bar(low, high, STEEL, 1.8))
                .add(bar(low, low + along * tube, "#9a9a9a", 5.0));
        for (servo, tip) in [(front, high), (rear, low)] {
            group = group
                .add(bar(self.shafts()[servo], tip, SERVO[servo], 3.0).set("stroke-opacity", 0.75))
                .add(pivot(tip, 2.0));
        }
        group
    }

    /// Two cranks, two couplers and the point that they carry.
    fn five_bar(&self, mut group: Group, end: End) -> Group {
        let (servos, point) = (end.servos(), self.solution.point(end));
        for servo in servos {
            group = group.add(bar(self.crank_tip(servo), point, STEEL, 3.4));
        }
        for servo in servos {
            let (shaft, tip) = (self.shafts()[servo], self.crank_tip(servo));
            group = group
                .add(bar(shaft, tip, SERVO[servo], 4.6))
                .add(pivot(tip, 2.3))
                .add(circle(page(shaft), 3.4 * PIXELS_PER_MM, DARK))
                .add(circle(page(shaft), 1.2 * PIXELS_PER_MM, "white"));
        }
        group.add(
            circle(page(point), 3.4 * PIXELS_PER_MM, "#f0e442")
                .set("stroke", DARK)
                .set("stroke-width", 2.5),
        )
    }

    pub(super) fn foot(&self, servo: usize) -> Joint {
        self.place(servo).foot()
    }

    fn place(&self, servo: usize) -> LegPlace {
        self.robot.leg(servo, self.angles()[servo])
    }

    fn leg(&self, mut group: Group, servo: usize) -> Group {
        let place = self.place(servo);
        let (pivots, joints) = (place.pivots(), place.joints());
        let colour = SERVO[servo];
        group = group.add(bar(pivots[0], pivots[1], "#c9c3b6", 5.0));
        for (pivot, joint) in pivots.into_iter().zip(joints) {
            group = group.add(bar(pivot, joint, colour, 3.2).set("stroke-opacity", 0.8));
        }
        group = group.add(bar(joints[0], joints[1], colour, 4.2));
        for (at, joint) in pivots.into_iter().zip(joints) {
            group = group.add(pivot(at, 1.7)).add(pivot(joint, 1.7));
        }
        let foot = page(place.foot());
        let pad = (8.0 * PIXELS_PER_MM, 11.0 * PIXELS_PER_MM);
        group.add(rectangle((foot.0 - pad.0 / 2.0, foot.1 - pad.1 / 2.0), pad, DARK).set("rx", 10))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lizard_kinematics::{Pose, wrap};

    fn check(pose: Option<Pose>, verdict: impl Fn(&View)) {
        let robot =
            Robot::parse(include_str!("../../../robots/paper.toml")).expect("paper.toml is right");
        let pose = pose.unwrap_or_else(|| robot.neutral());
        let solution = robot.lizard().solve(&pose).expect("the pose closes");
        verdict(&View {
            robot: &robot,
            solution: &solution,
        });
    }

    const ASKEW: [f64; 4] = [120.0, 50.0, 330.0, 200.0];

    #[test]
    fn every_drawn_link_has_its_length() {
        for pose in [None, Some(ASKEW.into())] {
            check(pose, |view| {
                for servo in 0..4 {
                    let tip = view.crank_tip(servo);
                    let crank = tip - view.shafts()[servo];
                    assert!((crank.length() - 30.0).abs() < 1e-9);
                    assert!((wrap(crank.angle() - view.angles()[servo])).abs() < 1e-9);
                    let point = if servo < 2 {
                        view.solution.head_point()
                    } else {
                        view.solution.tail_point()
                    };
                    assert!(((point - tip).length() - 50.0).abs() < 1e-9);
                }
            });
        }
    }

    #[test]
    fn at_neutral_each_foot_is_straight_beside_its_hip() {
        check(None, |view| {
            let feet: Vec<(f64, f64)> = (0..4)
                .map(|servo| view.foot(servo))
                .map(|foot| (foot.x.round(), foot.y.round()))
                .collect();
            assert_eq!(
                feet,
                [(-80.0, 55.0), (80.0, 55.0), (80.0, -55.0), (-80.0, -55.0)]
            );
        });
    }

    #[test]
    fn a_foot_goes_forward_where_the_gaits_say_so() {
        use lizard_robot::servo::FORWARD;
        check(None, |view| {
            for servo in 0..4 {
                let mut angles: [f64; 4] = view.angles();
                angles[servo] += 10.0 * FORWARD[servo];
                let before = view.foot(servo);
                check(Some(angles.into()), |swept| {
                    assert!(swept.foot(servo).y > before.y + 7.0);
                });
            }
        });
    }

    #[test]
    fn names_can_be_left_out() {
        check(None, |view| {
            assert!(top_view(view.robot, view.solution, true).contains("θ1 = 138.59°"));
            assert!(!top_view(view.robot, view.solution, false).contains("<text"));
        });
    }
}
