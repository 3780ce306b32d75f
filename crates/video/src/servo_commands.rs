//! The commands that turn a servo in the jig; both the sender and the measurement use this list.
//!
//! A servo shows its rate only if its pulse width changes faster than the servo can turn. A move to a pose is too
//! smooth for that, but reversing the servo's direction (console command `dir`) moves the pulse to the other side of
//! neutral at the slew limit. Such reversals are the large steps. Then the servo visits the same angles from both
//! sides. At the end, small steps grow until the servo reacts.

use std::ops::Range;

/// Time from one command to the next, s.
pub const COMMAND_INTERVAL: f64 = 1.0;
/// The angle between neutral and each end of a large step, deg.
const HALF_LARGE_STEP: f64 = 30.0;
/// Number of commands before the large steps.
const START_COMMAND_COUNT: usize = 2;
/// Number of large steps.
const LARGE_STEP_COUNT: usize = 8;
/// The poses at which the servo's angle is measured: deg from neutral, and true if the direction is reversed. From
/// pose to pose, the servo turns twice from one side to the other and back, in steps of 15 deg. The direction is
/// reversed at neutral, where this does not move the servo.
#[rustfmt::skip]
const VISITED_POSES: [(f64, bool); 19] = [
    (15.0, false), (0.0, false),
    (0.0, true), (15.0, true), (30.0, true), (15.0, true), (0.0, true),
    (0.0, false), (15.0, false), (30.0, false), (15.0, false), (0.0, false),
    (0.0, true), (15.0, true), (30.0, true), (15.0, true), (0.0, true),
    (0.0, false), (15.0, false),
];
/// Sizes of the small steps, deg: each is a move from the last visited pose towards neutral, followed by the move back.
const SMALL_STEP_SIZES: [f64; 10] = [0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.0];

/// A command to the servo: a pose and a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoCommand {
    /// Angle of the pose from neutral, deg, counter-clockwise positive.
    pub sweep: f64,
    /// True while the servo's direction is the opposite of the direction in robot.toml.
    pub is_reversed: bool,
}

impl ServoCommand {
    /// Returns the angle that robot.toml assigns to the pulse width, deg from neutral.
    pub fn pulse_angle(&self) -> f64 {
        match self.is_reversed {
            true => -self.sweep,
            false => self.sweep,
        }
    }
}

/// Lists all commands. The poses are counter-clockwise from neutral if `side` is 1, clockwise if it is -1.
pub fn list_commands(side: f64) -> Vec<ServoCommand> {
    let command = |sweep: f64, is_reversed| ServoCommand {
        sweep: side * sweep,
        is_reversed,
    };
    let mut commands = vec![command(0.0, false), command(HALF_LARGE_STEP, false)];
    commands.extend((0..LARGE_STEP_COUNT).map(|i| command(HALF_LARGE_STEP, i % 2 == 0)));
    commands.extend(VISITED_POSES.map(|(sweep, is_reversed)| command(sweep, is_reversed)));
    let (last_sweep, _) = VISITED_POSES[VISITED_POSES.len() - 1];
    for step_size in SMALL_STEP_SIZES {
        commands.extend([
            command(last_sweep - step_size, false),
            command(last_sweep, false),
        ]);
    }
    commands
}

/// Returns the indices of the commands for the large steps.
pub(crate) fn large_step_indices() -> Range<usize> {
    START_COMMAND_COUNT..START_COMMAND_COUNT + LARGE_STEP_COUNT
}

/// Returns the indices of the commands for the visited poses.
pub(crate) fn visited_pose_indices() -> Range<usize> {
    large_step_indices().end..large_step_indices().end + VISITED_POSES.len()
}

/// Returns the indices of the commands for the small steps.
pub(crate) fn small_step_indices() -> Range<usize> {
    let begin = visited_pose_indices().end;
    begin..begin + 2 * SMALL_STEP_SIZES.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the change of the pulse angle by a command, deg.
    fn step_size(commands: &[ServoCommand], index: usize) -> f64 {
        commands[index].pulse_angle() - commands[index - 1].pulse_angle()
    }

    #[test]
    fn large_steps_turn_by_60_deg_to_alternating_sides_and_small_steps_return() {
        let commands = list_commands(-1.0);
        for i in large_step_indices() {
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let expected = 2.0 * HALF_LARGE_STEP * side;
            assert_eq!(step_size(&commands, i), expected, "command {i}");
        }
        assert_eq!(small_step_indices().end, commands.len());
        for i in small_step_indices().step_by(2) {
            let [step, return_step] = [i, i + 1].map(|index| step_size(&commands, index));
            let returns = (step + return_step).abs() < 1e-12;
            assert!(returns && step > 0.0, "command {i}");
        }
    }

    #[test]
    fn the_first_small_step_reverses_the_direction_of_the_last_visit() {
        let commands = list_commands(1.0);
        let first_small_step = small_step_indices().start;
        let [last_visit, small_step] =
            [first_small_step - 1, first_small_step].map(|index| step_size(&commands, index));
        assert!(last_visit * small_step < 0.0);
    }
}
