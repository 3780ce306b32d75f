//! Adds a routine with a button, a nose contact and up to nine gaits, for measurements and random tests.

use lizard_robot::{Error, Robot, to_command};

use super::sim::gait_choice;

/// The name of the routine.
pub const PATROL: &str = "patrol";

/// The largest number of gaits that follow the first gait of a patrol.
const MAX_OTHER_GAITS: usize = 8;

/// The candidate Arduino pins for a missing input, in order. A1 to A4 are analogue pins here, not servos.
const CANDIDATE_PINS: [&str; 8] = ["A1", "A2", "A3", "A4", "A5", "D12", "D8", "D7"];

/// Adds a button, a nose contact and the routine [`PATROL`] to the robot file `text`. The routine waits for the button,
/// walks with the first gait until the nose touches something, continues with up to eight other gaits and `last_steps`,
/// and repeats all steps after the first for ever. A robot that already has a routine with this name is returned
/// unchanged.
///
/// # Errors
/// Fails if the text is not a valid robot file, or has no room for the inputs or the routine.
pub fn add_patrol(text: &str, last_steps: &[&str]) -> Result<Robot, Error> {
    let robot = Robot::parse(text)?;
    if robot.routine(PATROL).is_some() {
        return Ok(robot);
    }
    let mut text = text.to_owned();
    for name in ["button", "nose"] {
        let mut inputs = robot.inputs().named_pins();
        if inputs.any(|(input_name, _)| input_name == name) {
            continue;
        }
        let add_input = |pin: &str| format!("{text}\n[input.{name}]\npin = \"{pin}\"\n");
        let mut pins = CANDIDATE_PINS.iter();
        let free_pin = pins.find(|pin| Robot::parse(&add_input(pin)).is_ok());
        // If no pin is free, the occupied first pin is used, so that the last `parse` reports the error.
        text = add_input(free_pin.unwrap_or(&CANDIDATE_PINS[0]));
    }
    let gaits = gait_choice::list_moving_gaits(&robot).into_iter();
    let gaits: Vec<String> = gaits.map(to_command).collect();
    let first_gait = gaits.first().map_or("stand 1 s", String::as_str);
    let mut steps = vec!["wait button".to_owned(), format!("{first_gait} until nose")];
    let other_gaits = gaits.iter().skip(1).take(MAX_OTHER_GAITS);
    steps.extend(other_gaits.map(|gait| format!("{gait} 1 until button")));
    steps.extend(last_steps.iter().map(|step| (*step).to_owned()));
    Robot::parse(&format!(
        "{text}\n[routine.{PATROL}]\nsteps = {steps:?}\nrepeat = \"for ever\"\nrepeat_from = 2\n"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::robot_args;

    #[test]
    fn a_patrol_adds_a_button_and_a_nose_for_its_routine() {
        let robot = add_patrol(robot_args::DEFAULT_ROBOT_TOML, &[])
            .expect("the built-in robot has room for a patrol");
        let inputs: Vec<&str> = robot.inputs().named_pins().map(|(name, _)| name).collect();
        assert_eq!(inputs, ["button", "nose"]);
        let patrol = robot.routine(PATROL).expect("the routine has been added");
        assert!(patrol.has_inputs());
    }
}
