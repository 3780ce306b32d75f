//! The goal of a gait: to walk straight, or to turn on the spot.

use lizard_robot::servo::LEG_NAMES;
use lizard_robot::{CheckedGait, GroundContact, Travel};
use thiserror::Error;

/// Smallest distance per cycle that counts as a movement.
const MIN_DISTANCE_MM: f64 = 1.0;
/// Smallest turn per cycle that counts as a movement.
const MIN_TURN_DEG: f64 = 0.5;

fn is_left(servo: usize) -> bool {
    LEG_NAMES[servo].starts_with('L')
}

fn is_front(servo: usize) -> bool {
    LEG_NAMES[servo].ends_with('F')
}

/// The reason why a gait has no goal. Each variant holds the gait's name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum GoalError {
    /// Two feet pull against the other two, so the movement depends on unknown differences between the pads.
    #[error(
        "the direction of the gait `{0}` is undetermined, since two feet pull against the other two; tune another gait"
    )]
    Undetermined(String),
    /// The gait stands, or returns the robot to its start in each cycle.
    #[error("the gait `{0}` does not move the robot; tune another gait")]
    Stationary(String),
    /// The gait walks along a curve.
    #[error(
        "the gait `{0}` walks along a curve; tune a straight gait or a turn on the spot, and derive an arc from the \
         result with `like` and `gain`"
    )]
    Arc(String),
}

/// The direction of a gait's movement, with a sign: positive for forward and for a turn to the left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// A walk straight forward or backward.
    Straight(f64),
    /// A turn on the spot.
    Turn(f64),
}

impl Goal {
    /// Derives a gait's goal from its movement on rigid legs.
    ///
    /// # Errors
    /// Fails if the gait stands or walks along a curve, or if its movement depends on unknown differences between the
    /// pads.
    pub fn from_gait(gait: &CheckedGait, ground: &GroundContact) -> Result<Self, GoalError> {
        let gait_name = || gait.name().to_owned();
        let movement = gait.predict(&ground.with_rigid_drive());
        let (Some(forward), Some(turn)) = (movement.forward, movement.turn) else {
            return Err(GoalError::Undetermined(gait_name()));
        };
        match (forward.abs() >= MIN_DISTANCE_MM, turn.abs() >= MIN_TURN_DEG) {
            (true, false) => Ok(Self::Straight(forward.signum())),
            (false, true) => Ok(Self::Turn(turn.signum())),
            (false, false) => Err(GoalError::Stationary(gait_name())),
            (true, true) => Err(GoalError::Arc(gait_name())),
        }
    }

    /// Returns the movement's component towards this goal, mm or deg.
    pub fn progress(self, movement: &Travel) -> f64 {
        match self {
            Self::Straight(sign) => sign * movement.forward,
            Self::Turn(sign) => sign * movement.turn,
        }
    }

    /// True if the movement has almost no component other than the goal's; the sign is not checked.
    pub fn is_free_of_drift(self, movement: &Travel) -> bool {
        match self {
            Self::Straight(_) => {
                movement.turn.abs() < MIN_TURN_DEG && movement.left.abs() < MIN_DISTANCE_MM
            }
            Self::Turn(_) => movement.forward.hypot(movement.left) < MIN_DISTANCE_MM,
        }
    }

    /// Returns the sign of a leg's stroke: 1 if the leg moves backward in stance, -1 if the leg moves forward.
    pub fn stroke_sign(self, servo: usize) -> f64 {
        match self {
            Self::Straight(sign) => sign,
            // In a turn to the left, the left feet push forward.
            Self::Turn(sign) if is_left(servo) => -sign,
            Self::Turn(sign) => sign,
        }
    }

    /// Returns the index of a leg's pair: the front or the hind legs in a straight walk, diagonal legs in a turn. The
    /// pair with the left hind leg (LH) has index 0, the other 1.
    pub fn pair_index(self, servo: usize) -> usize {
        match self {
            Self::Straight(_) => usize::from(is_front(servo)),
            Self::Turn(_) => usize::from(is_front(servo) == is_left(servo)),
        }
    }

    /// Returns the unit of the speed towards this goal.
    pub const fn speed_unit(self) -> &'static str {
        match self {
            Self::Straight(_) => "mm/s",
            Self::Turn(_) => "deg/s",
        }
    }
}

#[cfg(test)]
mod tests {
    use lizard_robot::Robot;

    use super::*;

    #[test]
    fn a_goal_has_the_direction_of_its_gaits_movement() {
        let robot =
            Robot::parse(include_str!("../../../robots/paper.toml")).expect("paper.toml is valid");
        let find_goal = |name: &str| {
            let gait = robot.gait(name).expect("paper.toml has the gait");
            Goal::from_gait(gait, robot.ground()).map_err(|error| error.to_string())
        };
        assert_eq!(find_goal("walk"), Ok(Goal::Straight(1.0)));
        assert_eq!(find_goal("back"), Ok(Goal::Straight(-1.0)));
        assert_eq!(find_goal("left"), Ok(Goal::Turn(1.0)));
        assert_eq!(find_goal("right"), Ok(Goal::Turn(-1.0)));
        for (name, reason) in [
            ("stand", "does not move the robot"),
            ("arc-left", "walks along a curve"),
            ("look", "is undetermined"),
        ] {
            let error = find_goal(name).expect_err("the gait has no goal");
            assert!(error.contains(reason), "{name}: {error}");
        }
    }

    #[test]
    fn in_a_turn_left_and_right_legs_push_in_opposite_directions_and_diagonal_legs_are_pairs() {
        let signs = [0, 1, 2, 3].map(|servo| Goal::Turn(1.0).stroke_sign(servo));
        assert_eq!(
            signs,
            [-1.0, 1.0, 1.0, -1.0],
            "as in the `gain` of robot.toml"
        );
        let pairs = [0, 1, 2, 3].map(|servo| Goal::Turn(1.0).pair_index(servo));
        assert_eq!(pairs[0], pairs[2]);
        assert_eq!(pairs[1], pairs[3]);
        assert_eq!(pairs[3], 0);
    }
}
