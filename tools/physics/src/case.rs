//! What is tried with each gait: how the legs are driven, and how the feet stand.

use std::fmt;

use lizard_robot::{Drive, Ground, Kind, Robot, Stance};

/// How the legs are driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Legs {
    /// By bars with two holes.
    Rigid,
    /// By struts with a slot, and the spring of `[parts.spring]` in it.
    Strut,
}

/// How the feet stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feet {
    /// All of one length, on leaves as robot.toml has them.
    Level,
    /// The front left one 0.6 mm too long, on stiff leaves of 2 N/mm.
    Stiff,
    /// The same 1.0 mm too long, on leaves as robot.toml has them.
    Soft,
}

impl Feet {
    /// In the order of the tables.
    pub const ALL: [Self; 3] = [Self::Level, Self::Stiff, Self::Soft];

    /// By how much the front left foot is too long, mm.
    #[must_use]
    pub fn long(self) -> f64 {
        match self {
            Self::Level => 0.0,
            Self::Stiff => 0.6,
            Self::Soft => 1.0,
        }
    }

    /// What a foot gives, N/mm, on this robot.
    #[must_use]
    pub fn stiffness(self, robot: &Robot) -> f64 {
        match self {
            Self::Stiff => 2.0,
            Self::Level | Self::Soft => robot.ground().stance.stiffness,
        }
    }
}

/// Legs and feet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// How the legs are driven.
    pub legs: Legs,
    /// How the feet stand.
    pub feet: Feet,
}

impl Case {
    /// In the order of the tables. Struts with springs go as rigid ones, so one long foot
    /// will do there.
    pub const ALL: [Self; 5] = {
        let [level, stiff, soft] = Feet::ALL;
        let (rigid, strut) = (Legs::Rigid, Legs::Strut);
        [
            Self {
                legs: rigid,
                feet: level,
            },
            Self {
                legs: rigid,
                feet: stiff,
            },
            Self {
                legs: rigid,
                feet: soft,
            },
            Self {
                legs: strut,
                feet: level,
            },
            Self {
                legs: strut,
                feet: stiff,
            },
        ]
    };

    /// The robot as the contact model gets it: the friction of the pads is equal in all
    /// directions, as in the engine.
    #[must_use]
    pub fn ground(self, robot: &Robot) -> Ground {
        Ground {
            stance: Stance {
                stiffness: self.feet.stiffness(robot),
                twist: self.feet.long(),
                ..Stance::LEVEL
            },
            drive: match self.legs {
                Legs::Rigid => Drive::RIGID,
                Legs::Strut => Drive {
                    kind: Kind::Strut(robot.strut_of(&robot.parts().spring)),
                    ..Drive::RIGID
                },
            },
            ratio: 1.0,
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
