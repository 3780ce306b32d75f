//! Cases in which each gait is simulated: the drive of the legs, and the setup of the feet.

use std::fmt;

use lizard_robot::{Drive, DriveKind, GroundContact, Robot, Stance};

/// The parts that drive the legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LegDrive {
    /// Bars with two holes.
    Rigid,
    /// Struts with a slot and the spring of `[parts.spring]` in it.
    Strut,
}

/// The lengths of the feet, and the stiffness of their leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FootSetup {
    /// All feet have the same length; their leaves are as in robot.toml.
    Level,
    /// The front left foot is 0.6 mm too long; all leaves have a stiffness of 2 N/mm.
    LongStiff,
    /// The front left foot is 1.0 mm too long; the leaves are as in robot.toml.
    Long,
}

impl FootSetup {
    /// Returns the excess length of the front left foot, mm.
    pub fn excess_length_mm(self) -> f64 {
        match self {
            Self::Level => 0.0,
            Self::LongStiff => 0.6,
            Self::Long => 1.0,
        }
    }

    /// Returns the leaves' stiffness on a robot, N/mm.
    pub fn leaf_stiffness(self, robot: &Robot) -> f64 {
        match self {
            Self::LongStiff => 2.0,
            Self::Level | Self::Long => robot.ground().stance.stiffness,
        }
    }
}

/// A combination of legs and feet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// The drive of the legs.
    pub legs: LegDrive,
    /// The setup of the feet.
    pub feet: FootSetup,
}

impl Case {
    /// All cases, in the order of the tables. Legs on struts with springs walk like rigid legs; therefore one
    /// case with a long foot is enough for them.
    pub const ALL: [Self; 5] = {
        const fn case(legs: LegDrive, feet: FootSetup) -> Case {
            Case { legs, feet }
        }
        [
            case(LegDrive::Rigid, FootSetup::Level),
            case(LegDrive::Rigid, FootSetup::LongStiff),
            case(LegDrive::Rigid, FootSetup::Long),
            case(LegDrive::Strut, FootSetup::Level),
            case(LegDrive::Strut, FootSetup::LongStiff),
        ]
    };

    /// Returns the contact model's input: the robot on pads with equal friction in all directions, as in MuJoCo.
    pub fn ground(self, robot: &Robot) -> GroundContact {
        GroundContact {
            stance: Stance {
                stiffness: self.feet.leaf_stiffness(robot),
                twist: self.feet.excess_length_mm(),
                ..Stance::LEVEL
            },
            drive: match self.legs {
                LegDrive::Rigid => Drive::RIGID,
                LegDrive::Strut => Drive {
                    kind: DriveKind::Strut(robot.own_strut()),
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
            LegDrive::Rigid => "rigid",
            LegDrive::Strut => "strut",
        };
        let feet = match self.feet {
            FootSetup::Level => "level",
            FootSetup::LongStiff => "0.6 mm long on 2 N/mm",
            FootSetup::Long => "1.0 mm long",
        };
        write!(f, "{legs}, {feet}")
    }
}
