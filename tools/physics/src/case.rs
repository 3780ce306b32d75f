//! Cases in which each gait is simulated: the drive of the legs, and the length of the feet.

use std::fmt;

use lizard_robot::{Drive, DriveKind, Ground, Robot, Stance};

/// The drive of the legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Legs {
    /// Bars with two holes.
    Rigid,
    /// Struts with a slot and the spring of `[parts.spring]` in it.
    Strut,
}

/// The length of the feet, and the stiffness of their leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feet {
    /// All feet equally long, on leaves as in robot.toml.
    Level,
    /// The front left foot 0.6 mm too long, on stiff leaves of 2 N/mm.
    Stiff,
    /// The front left foot 1.0 mm too long, on leaves as in robot.toml.
    Soft,
}

impl Feet {
    /// All kinds of feet, in the order of the tables.
    pub const ALL: [Self; 3] = [Self::Level, Self::Stiff, Self::Soft];

    /// Returns the excess length of the front left foot, mm.
    pub fn excess_length_mm(self) -> f64 {
        match self {
            Self::Level => 0.0,
            Self::Stiff => 0.6,
            Self::Soft => 1.0,
        }
    }

    /// Returns the stiffness of the feet's leaves on a robot, N/mm.
    pub fn stiffness(self, robot: &Robot) -> f64 {
        match self {
            Self::Stiff => 2.0,
            Self::Level | Self::Soft => robot.ground().stance.stiffness,
        }
    }
}

/// A combination of legs and feet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// The drive of the legs.
    pub legs: Legs,
    /// The length of the feet.
    pub feet: Feet,
}

impl Case {
    /// All cases in the order of the tables. Legs on struts with springs walk like rigid legs, so one
    /// case of a long foot is enough for them.
    pub const ALL: [Self; 5] = {
        const fn case(legs: Legs, feet: Feet) -> Case {
            Case { legs, feet }
        }
        [
            case(Legs::Rigid, Feet::Level),
            case(Legs::Rigid, Feet::Stiff),
            case(Legs::Rigid, Feet::Soft),
            case(Legs::Strut, Feet::Level),
            case(Legs::Strut, Feet::Stiff),
        ]
    };

    /// Returns the input of the contact model: the robot on pads whose friction is equal in all
    /// directions, as in MuJoCo.
    pub fn ground(self, robot: &Robot) -> Ground {
        Ground {
            stance: Stance {
                stiffness: self.feet.stiffness(robot),
                twist: self.feet.excess_length_mm(),
                ..Stance::LEVEL
            },
            drive: match self.legs {
                Legs::Rigid => Drive::RIGID,
                Legs::Strut => Drive {
                    kind: DriveKind::Strut(robot.strut_with_coil(&robot.parts().spring)),
                    ..Drive::RIGID
                },
            },
            friction_ratio: 1.0,
            ..*robot.ground()
        }
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let legs = match self.legs {
            Legs::Rigid => "rigid",
            Legs::Strut => "strut",
        };
        let feet = match self.feet {
            Feet::Level => "level",
            Feet::Stiff => "0.6 mm long on 2 N/mm",
            Feet::Soft => "1.0 mm long",
        };
        write!(f, "{legs}, {feet}")
    }
}
