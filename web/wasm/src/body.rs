//! Where the body is on the floor.
//!
//! The servos' angles of one frame and the next go through a contact model, which says how
//! the body moved. Today's model, [`Rigid`], has legs without springs. Another one
//! takes its place by the trait [`Contact`]; nothing else knows which it is.

use lizard_robot::{Ground, Robot, Travel};
use serde::Serialize;

/// Position and heading of the chassis on the floor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Place {
    /// To the right of the start, mm.
    pub x: f64,
    /// Ahead of the start, mm.
    pub y: f64,
    /// Heading, deg, counter-clockwise from the start's; not wrapped.
    pub heading: f64,
}

impl Place {
    /// After a way that is seen from here.
    #[must_use]
    pub fn moved(self, way: Travel) -> Self {
        let [x, y] = self.on_floor([-way.left, way.forward]);
        Self {
            x,
            y,
            heading: self.heading + way.turn,
        }
    }

    /// The way from here to another place, seen from here.
    #[must_use]
    pub fn way_to(self, other: Self) -> Travel {
        let (sin, cos) = self.heading.to_radians().sin_cos();
        let (x, y) = (other.x - self.x, other.y - self.y);
        Travel {
            forward: y * cos - x * sin,
            left: -x * cos - y * sin,
            turn: other.heading - self.heading,
        }
    }

    /// A point of the chassis frame (mm, x right, y forward) on the floor.
    #[must_use]
    pub fn on_floor(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.heading.to_radians().sin_cos();
        [self.x + x * cos - y * sin, self.y + x * sin + y * cos]
    }
}

/// What one step of a contact model makes of a move of the servos.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walked {
    /// How the body moved, seen from where it was.
    pub way: Travel,
    /// The legs' angles that it ended with, deg, chassis frame, servo order. Those of the
    /// servos, if the legs are rigid.
    pub legs: [f64; 4],
}

/// A contact model: how the body moves when the servos turn.
pub trait Contact {
    /// One step from the angles that the legs had to new servo angles (deg, chassis frame,
    /// servo order).
    fn step(&mut self, robot: &Robot, legs: [f64; 4], servos: [f64; 4]) -> Walked;
}

/// Rigid legs on pads with dry friction: [`lizard_robot::Ground`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    /// Friction of a pad that slides backward over that of one that slides forward.
    pub ratio: f64,
}

impl Contact for Rigid {
    fn step(&mut self, robot: &Robot, legs: [f64; 4], servos: [f64; 4]) -> Walked {
        let ground = Ground {
            ratio: self.ratio,
            ..*robot.ground()
        };
        let sweeps = [legs, servos].map(|angles| robot.sweeps(angles));
        Walked {
            way: ground.travel(sweeps),
            legs: servos,
        }
    }
}

/// A robot on the floor.
#[derive(Clone, Debug)]
pub struct Body<C> {
    /// Where it is.
    pub place: Place,
    /// The contact model.
    pub contact: C,
    legs: Option<[f64; 4]>,
    feet: Option<[[f64; 2]; 4]>,
}

impl<C: Contact> Body<C> {
    /// At the start, its legs anywhere.
    pub fn new(contact: C) -> Self {
        Self {
            place: Place::default(),
            contact,
            legs: None,
            feet: None,
        }
    }

    /// Takes the servos to these angles and returns how far each foot slid over the floor,
    /// mm, servo order. The first angles only say where the legs are.
    pub fn follow(&mut self, robot: &Robot, servos: [f64; 4]) -> [f64; 4] {
        let before = self.legs.unwrap_or(servos);
        let walked = self.contact.step(robot, before, servos);
        self.place = self.place.moved(walked.way);
        self.legs = Some(walked.legs);
        let feet = [0, 1, 2, 3].map(|servo| {
            let foot = robot.leg(servo, walked.legs[servo]).foot();
            self.place.on_floor([foot.x, foot.y])
        });
        let from = self.feet.replace(feet).unwrap_or(feet);
        [0, 1, 2, 3].map(|i| (feet[i][0] - from[i][0]).hypot(feet[i][1] - from[i][1]))
    }

    /// The angles of its legs, deg, chassis frame, servo order; none before the first step.
    #[must_use]
    pub fn legs(&self) -> Option<[f64; 4]> {
        self.legs
    }

    /// Puts it somewhere without walking there.
    pub fn put(&mut self, place: Place) {
        self.place = place;
        self.feet = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper() -> Robot {
        Robot::parse(include_str!("../../../robots/paper.toml")).expect("paper.toml is right")
    }

    #[test]
    fn a_cycle_frame_by_frame_leads_where_the_prediction_says() {
        let robot = paper();
        for name in ["walk", "left", "arc-right", "back"] {
            let gait = robot.gait(name).expect("a gait");
            let mut body = Body::new(Rigid { ratio: 1.0 });
            for (_, phase) in gait.frames() {
                body.follow(&robot, gait.table_angles(phase));
            }
            let way = robot.predict(gait);
            let near = |got: f64, wanted: Option<f64>, within: f64| {
                assert!(
                    (got - wanted.expect("decided")).abs() < within,
                    "{name} {body:?}"
                );
            };
            near(body.place.y, way.forward, 0.5);
            near(-body.place.x, way.left, 0.5);
            near(body.place.heading, way.turn, 0.3);
        }
    }

    #[test]
    fn in_a_walk_most_feet_hold() {
        let robot = paper();
        let gait = robot.gait("walk").expect("walk");
        let mut body = Body::new(Rigid { ratio: 1.0 });
        let mut slid = [0.0; 4];
        for (_, phase) in gait.frames() {
            let slides = body.follow(&robot, gait.table_angles(phase));
            let holds = slides.iter().filter(|mm| **mm < 0.3).count();
            assert!(holds >= 2, "{slides:?}");
            slid = [0, 1, 2, 3].map(|i| slid[i] + slides[i]);
        }
        assert!(
            slid.iter().all(|mm| *mm > 20.0),
            "each foot is dragged once: {slid:?}"
        );
    }

    #[test]
    fn a_turned_body_goes_where_it_looks() {
        let start = Place {
            heading: 90.0,
            ..Place::default()
        };
        let moved = start.moved(Travel {
            forward: 10.0,
            left: 2.0,
            turn: 5.0,
        });
        assert!(
            (moved.x + 10.0).abs() < 1e-12 && (moved.y + 2.0).abs() < 1e-12,
            "{moved:?}"
        );
        assert_eq!(moved.heading, 95.0);
        let way = start.way_to(moved);
        let off = (way.forward - 10.0)
            .hypot(way.left - 2.0)
            .hypot(way.turn - 5.0);
        assert!(off < 1e-12, "{way:?}");
    }
}
