//! What the page's sliders set: floor, weight and springs.

use lizard_robot::{Body, Ground, Spring};
use serde::Serialize;

/// What a robot stands on, what it weighs and what pulls its legs. The rest of the ground is
/// the robot's own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Floor {
    /// Friction of a pad that slides forward, above 0.
    pub friction: f64,
    /// Friction of a pad that slides backward over that of one that slides forward, above 0.
    pub ratio: f64,
    /// Mass of the robot, g, above 0.
    pub mass: f64,
    /// Of a leg's spring, N mm/deg, above 0; infinite where legs are rigid, which is `null` in
    /// JSON.
    pub stiffness: f64,
    /// Torque up to which a leg does not lag at all, N mm: a strut with a stop.
    pub preload: f64,
}

impl Floor {
    /// As a robot.toml has it.
    #[must_use]
    pub fn of(ground: &Ground) -> Self {
        Self {
            friction: ground.friction,
            ratio: ground.ratio,
            mass: ground.body.mass,
            stiffness: ground.spring.map_or(f64::INFINITY, |spring| spring.rate),
            preload: ground.spring.map_or(0.0, |spring| spring.preload),
        }
    }

    /// A robot's ground with these values. One that is out of its range leaves the ground's
    /// own.
    #[must_use]
    pub fn over(self, ground: &Ground) -> Ground {
        let own = Self::of(ground);
        let pick = |value: f64, own: f64| match value > 0.0 && value.is_finite() {
            true => value,
            false => own,
        };
        Ground {
            friction: pick(self.friction, own.friction),
            ratio: pick(self.ratio, own.ratio),
            body: Body {
                mass: pick(self.mass, own.mass),
                ..ground.body
            },
            spring: match self.stiffness {
                f64::INFINITY => None,
                rate if rate > 0.0 => Some(Spring {
                    rate,
                    preload: self.preload.max(0.0),
                }),
                _ => ground.spring,
            },
            ..*ground
        }
    }
}

#[cfg(test)]
mod tests {
    use lizard_robot::Robot;

    use super::*;

    #[test]
    fn what_is_out_of_range_stays_as_it_was() {
        let robot = Robot::parse(include_str!("../../../robots/paper.toml")).expect("right");
        let nonsense = Floor {
            friction: 0.0,
            ratio: -1.0,
            mass: f64::NAN,
            stiffness: f64::NAN,
            preload: f64::NAN,
        };
        assert_eq!(nonsense.over(robot.ground()), *robot.ground());
    }

    #[test]
    fn a_floor_of_a_ground_is_that_ground() {
        let text = include_str!("../../../robots/paper.toml");
        let springs = text.replace("[leg]", "[leg]\nspring = 5.0\npreload = 12.0");
        for text in [text, &springs] {
            let robot = Robot::parse(text).expect("right");
            let ground = robot.ground();
            assert_eq!(Floor::of(ground).over(ground), *ground);
        }
    }
}
