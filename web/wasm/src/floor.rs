//! The values of the page's sliders: floor, mass, feet and leg drive.

use lizard_robot::{Body, Drive, DriveKind, GroundContact, Robot, Stance};
use serde::{Deserialize, Serialize};
use tsify::Tsify;

/// The kind of leg drive, by its name in robot.toml.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Tsify)]
#[serde(rename_all = "lowercase")]
pub enum LegDrive {
    /// A rigid strut.
    Rigid,
    /// A slotted strut with a spring, which yields in one direction.
    Strut,
}

/// The values of the sliders. The ground's other values are the robot's own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Tsify)]
pub struct Floor {
    /// Friction coefficient of a pad that slides forward, above 0.
    pub friction: f64,
    /// Ratio of backward to forward friction of a pad, above 0.
    pub ratio: f64,
    /// Mass of the robot, g, above 0.
    pub mass: f64,
    /// Kind of leg drive.
    pub kind: LegDrive,
    /// Pull of the spring in a strut, N, above 0.
    pub force: f64,
    /// Rate of the spring in a strut, N/mm.
    pub rate: f64,
    /// Play of a leg to either side, deg.
    pub play: f64,
    /// Stiffness of a foot, N/mm, above 0.
    pub leaf: f64,
    /// Length by which the front left foot is too long, mm.
    pub twist: f64,
}

impl Floor {
    /// Returns a robot's own values.
    pub fn for_robot(robot: &Robot) -> Self {
        let ground = robot.ground();
        let own_strut = robot.own_strut();
        let strut = ground.drive.strut().unwrap_or(&own_strut);
        Self {
            friction: ground.friction_coefficient,
            ratio: ground.friction_ratio,
            mass: ground.body.mass,
            kind: match ground.drive.kind {
                DriveKind::Rigid => LegDrive::Rigid,
                DriveKind::Strut(_) => LegDrive::Strut,
            },
            force: strut.preload,
            rate: strut.spring_rate,
            play: ground.drive.play,
            leaf: ground.stance.stiffness,
            twist: ground.stance.twist,
        }
    }

    /// Replaces every value out of range by the robot's own value.
    #[must_use]
    pub fn with_valid_values(self, robot: &Robot) -> Self {
        let own_floor = Self::for_robot(robot);
        let finite_or_own = |value: f64, is_in_range: bool, own_value: f64| {
            let is_valid = is_in_range && value.is_finite();
            if is_valid { value } else { own_value }
        };
        let positive_or_own = |value, own_value| finite_or_own(value, value > 0.0, own_value);
        let non_negative_or_own = |value, own_value| finite_or_own(value, value >= 0.0, own_value);
        Self {
            friction: positive_or_own(self.friction, own_floor.friction),
            ratio: positive_or_own(self.ratio, own_floor.ratio),
            mass: positive_or_own(self.mass, own_floor.mass),
            kind: self.kind,
            force: positive_or_own(self.force, own_floor.force),
            rate: non_negative_or_own(self.rate, own_floor.rate),
            play: non_negative_or_own(self.play, own_floor.play),
            leaf: positive_or_own(self.leaf, own_floor.leaf),
            twist: finite_or_own(self.twist, true, own_floor.twist),
        }
    }

    /// Returns the robot's ground with these values.
    pub fn to_ground(self, robot: &Robot) -> GroundContact {
        let (floor, ground) = (self.with_valid_values(robot), robot.ground());
        GroundContact {
            friction_coefficient: floor.friction,
            friction_ratio: floor.ratio,
            body: Body {
                mass: floor.mass,
                ..ground.body
            },
            stance: Stance {
                stiffness: floor.leaf,
                twist: floor.twist,
                ..ground.stance
            },
            drive: Drive {
                kind: match floor.kind {
                    LegDrive::Strut => {
                        DriveKind::Strut(robot.strut_with_spring(floor.force, floor.rate))
                    }
                    LegDrive::Rigid => DriveKind::Rigid,
                },
                play: floor.play,
            },
            ..*ground
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::PAPER_TOML;

    fn parse_robot_with(extra_toml: &str) -> Robot {
        Robot::parse(&format!("{PAPER_TOML}\n{extra_toml}"))
            .expect("paper.toml with these keys is valid")
    }

    #[test]
    fn the_robots_own_value_replaces_a_value_out_of_range() {
        for extra_toml in ["", "[leg.drive]\nkind = \"strut\"\nforce = 3.0\nplay = 0.5"] {
            let robot = parse_robot_with(extra_toml);
            let invalid_floor = Floor {
                friction: 0.0,
                ratio: -1.0,
                mass: f64::NAN,
                force: 0.0,
                rate: -1.0,
                play: -0.1,
                leaf: 0.0,
                twist: f64::INFINITY,
                ..Floor::for_robot(&robot)
            };
            assert_eq!(invalid_floor.to_ground(&robot), *robot.ground());
        }
    }

    #[test]
    fn the_ground_has_every_value_of_the_floor() {
        let robot = parse_robot_with("");
        let floor = Floor {
            friction: 0.4,
            ratio: 1.2,
            mass: 300.0,
            kind: LegDrive::Strut,
            force: 2.5,
            rate: 0.3,
            play: 0.2,
            leaf: 1.5,
            twist: -0.6,
        };
        let ground = floor.to_ground(&robot);
        let kind = DriveKind::Strut(robot.strut_with_spring(2.5, 0.3));
        assert_eq!(ground.drive, Drive { kind, play: 0.2 });
        let pads = [ground.friction_coefficient, ground.friction_ratio];
        let feet = [ground.stance.stiffness, ground.stance.twist];
        assert_eq!((pads, feet), ([0.4, 1.2], [1.5, -0.6]));
        assert_eq!(ground.body.mass, 300.0);
    }

    #[test]
    fn the_floor_of_a_robot_reproduces_its_ground() {
        for extra_toml in [
            "",
            "[leg.drive]\nkind = \"strut\"\nforce = 2.5\nplay = 0.4",
            "[feet]\nstiffness = 2.0\ntwist = -0.6",
        ] {
            let robot = parse_robot_with(extra_toml);
            let floor = Floor::for_robot(&robot);
            assert_eq!(floor.to_ground(&robot), *robot.ground(), "{extra_toml}");
            // The page gets the kind by its name in robot.toml.
            let kind = serde_json::json!(floor.kind);
            assert_eq!(kind, robot.drive().kind_name(), "{extra_toml}");
        }
    }
}
