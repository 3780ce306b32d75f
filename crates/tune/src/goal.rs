//! The goal of a gait: to walk straight, or to turn on the spot.

use lizard_robot::servo::LEG_NAMES;
use lizard_robot::{CheckedGait, Ground, Travel};
use thiserror::Error;

/// Smallest movement in a cycle that is not regarded as zero: distance in mm, turn in deg.
const MIN_MOVEMENT: (f64, f64) = (1.0, 0.5);

fn is_left(servo: usize) -> bool {
    LEG_NAMES[servo].starts_with('L')
}

fn is_front(servo: usize) -> bool {
    LEG_NAMES[servo].ends_with('F')
}

/// The error for a gait that has no goal; contains the gait's name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum GoalError {
    /// The gait's movement depends on unmeasurable differences between the pads: two feet pull against two.
    #[error(
        "the direction of the gait `{0}` is undecided, since two feet pull against two; tune another gait"
    )]
    Undecided(String),
    /// The gait stands or returns to its start.
    #[error("the gait `{0}` goes nowhere")]
    Nowhere(String),
    /// The gait walks along a curve.
    #[error(
        "the gait `{0}` goes ahead and turns; tune a straight gait or a turn on the spot, and make \
         an arc of it with `like` and `gain`"
    )]
    Arc(String),
}

/// The direction of a gait's movement, with a sign: positive for forward and for a turn to the left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// Straight forward or backward.
    Ahead(f64),
    /// A turn on the spot.
    Turn(f64),
}

impl Goal {
    /// Derives the goal of a gait from its movement on rigid legs.
    ///
    /// # Errors
    /// Fails for a gait that stands, walks along a curve, or whose movement depends on unmeasurable differences
    /// between the pads.
    pub fn of(gait: &CheckedGait, ground: &Ground) -> Result<Self, GoalError> {
        let name_of_gait = || gait.name().to_owned();
        let movement = gait.predict(&ground.with_rigid_drive());
        let (Some(forward), Some(turn)) = (movement.forward, movement.turn) else {
            return Err(GoalError::Undecided(name_of_gait()));
        };
        let is_enough = |value: f64, min: f64| value.abs() >= min;
        match (
            is_enough(forward, MIN_MOVEMENT.0),
            is_enough(turn, MIN_MOVEMENT.1),
        ) {
            (true, false) => Ok(Self::Ahead(forward.signum())),
            (false, true) => Ok(Self::Turn(turn.signum())),
            (false, false) => Err(GoalError::Nowhere(name_of_gait())),
            (true, true) => Err(GoalError::Arc(name_of_gait())),
        }
    }

    /// The component of a movement towards this goal, mm or deg.
    pub fn progress(self, movement: &Travel) -> f64 {
        match self {
            Self::Ahead(sign) => sign * movement.forward,
            Self::Turn(sign) => sign * movement.turn,
        }
    }

    /// True if a movement has almost no component other than that towards this goal.
    pub fn is_true_to(self, movement: &Travel) -> bool {
        match self {
            Self::Ahead(_) => {
                movement.turn.abs() < MIN_MOVEMENT.1 && movement.left.abs() < MIN_MOVEMENT.0
            }
            Self::Turn(_) => movement.forward.hypot(movement.left) < MIN_MOVEMENT.0,
        }
    }

    /// Returns the sign of a leg's stroke: 1 if the leg moves backward in stance, -1 if it moves forward.
    pub fn sign(self, servo: usize) -> f64 {
        match self {
            Self::Ahead(sign) => sign,
            // In a turn to the left, the left feet push forward.
            Self::Turn(sign) => {
                if is_left(servo) {
                    -sign
                } else {
                    sign
                }
            }
        }
    }

    /// Returns the index of the pair of legs that a leg belongs to: 0 for the pair that contains LH, else 1.
    pub fn pair(self, servo: usize) -> usize {
        match self {
            Self::Ahead(_) => usize::from(is_front(servo)),
            Self::Turn(_) => usize::from(is_front(servo) == is_left(servo)),
        }
    }

    /// Returns the unit of the speed towards this goal.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Ahead(_) => "mm/s",
            Self::Turn(_) => "deg/s",
        }
    }
}

#[cfg(test)]
mod tests {
    use lizard_robot::Robot;

    use super::*;

    #[test]
    fn a_goal_is_what_the_gait_does() {
        let robot = Robot::parse(include_str!("../../../robots/paper.toml")).expect("right");
        let goal_of = |name: &str| {
            let gait = robot.gait(name).expect(name);
            Goal::of(gait, robot.ground()).map_err(|error| error.to_string())
        };
        assert_eq!(goal_of("walk"), Ok(Goal::Ahead(1.0)));
        assert_eq!(goal_of("back"), Ok(Goal::Ahead(-1.0)));
        assert_eq!(goal_of("left"), Ok(Goal::Turn(1.0)));
        assert_eq!(goal_of("right"), Ok(Goal::Turn(-1.0)));
        for (name, reason) in [
            ("stand", "goes nowhere"),
            ("arc-left", "goes ahead and turns"),
            ("look", "is undecided"),
        ] {
            assert!(goal_of(name).expect_err(name).contains(reason), "{name}");
        }
    }

    #[test]
    fn in_a_turn_to_the_left_the_left_legs_run_against_the_others() {
        let signs = [0, 1, 2, 3].map(|servo| Goal::Turn(1.0).sign(servo));
        assert_eq!(signs, [-1.0, 1.0, 1.0, -1.0], "as robot.toml's gain has it");
        let pairs = [0, 1, 2, 3].map(|servo| Goal::Turn(1.0).pair(servo));
        assert_eq!(pairs[0], pairs[2]);
        assert_eq!(pairs[1], pairs[3]);
        assert_eq!(pairs[3], 0);
    }
}
