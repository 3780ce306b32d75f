//! Timed presses of a robot's inputs, which are contacts.

use std::collections::BTreeMap;
use std::str::FromStr;

use lizard_robot::Robot;
use simulated_uno::{Pin, Uno};

use crate::Failure;

/// Duration of a press without a given end, ms.
const DEFAULT_PRESS_MS: u64 = 200;

/// A press of an input, which closes its contact for some time; written as `button@2` or `nose@5.5-8`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Press {
    /// Name of the input in robot.toml.
    input: String,
    /// Time at which the contact closes, ms since power-on.
    start_ms: u64,
    /// Time at which the contact opens, ms since power-on.
    end_ms: u64,
}

/// The closing or opening of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ContactChange {
    /// Time of the change, ms since power-on.
    pub time_ms: u64,
    /// Arduino number of the contact's pin.
    pub pin: u8,
    /// True if the contact closes, false if it opens.
    pub is_closed: bool,
}

impl ContactChange {
    /// Closes or opens the contact of a simulated UNO.
    pub fn apply(&self, uno: &mut Uno) {
        uno.set_contact(Pin::arduino(self.pin), self.is_closed);
    }
}

impl FromStr for Press {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form_error = || "expected NAME@SECONDS or NAME@START-END".to_owned();
        let (input, times) = text.split_once('@').ok_or_else(form_error)?;
        let parse_ms = |text| super::parse_seconds(text).map(|seconds| (1_000.0 * seconds) as u64);
        let (start_ms, end_ms) = match times.split_once('-') {
            Some((start, end)) => (parse_ms(start)?, parse_ms(end)?),
            None => (parse_ms(times)?, parse_ms(times)? + DEFAULT_PRESS_MS),
        };
        if end_ms <= start_ms {
            return Err("the end must be after the start".to_owned());
        }
        Ok(Self {
            input: input.to_owned(),
            start_ms,
            end_ms,
        })
    }
}

/// Lists the changes of a robot's contacts in order of time. Overlapping presses of an input are one longer press.
///
/// # Errors
/// Fails if the robot does not have the input of a press.
pub fn list_contact_changes(
    presses: &[Press],
    robot: &Robot,
) -> Result<Vec<ContactChange>, Failure> {
    let mut changes = Vec::new();
    for press in presses {
        let mut inputs = robot.inputs().named_pins();
        let Some((_, pin)) = inputs.find(|(name, _)| *name == press.input) else {
            let name = &press.input;
            let message = format!("robot.toml has no [input.{name}] for --press");
            return Err(Failure::Input(message));
        };
        for (time_ms, is_closed) in [(press.start_ms, true), (press.end_ms, false)] {
            changes.push(ContactChange {
                time_ms,
                pin,
                is_closed,
            });
        }
    }
    changes.sort_by_key(|change| (change.time_ms, change.is_closed));
    let mut active_press_counts = BTreeMap::new();
    changes.retain(|change| {
        let count = active_press_counts.entry(change.pin).or_insert(0);
        *count += if change.is_closed { 1 } else { -1 };
        *count == i32::from(change.is_closed)
    });
    Ok(changes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_press_is_parsed_from_a_name_and_a_time_or_time_span() {
        let press = |input: &str, start_ms, end_ms| Press {
            input: input.to_owned(),
            start_ms,
            end_ms,
        };
        assert_eq!("button@2".parse(), Ok(press("button", 2_000, 2_200)));
        assert_eq!("nose@5.5-8".parse(), Ok(press("nose", 5_500, 8_000)));
        for (invalid_text, reason) in [
            ("button", "expected NAME@SECONDS or NAME@START-END"),
            ("button@soon", "it is not a number"),
            ("button@3-2", "the end must be after the start"),
            ("button@-1-2", "it is not a number"),
        ] {
            let result = invalid_text.parse::<Press>();
            assert_eq!(result, Err(reason.to_owned()), "{invalid_text}");
        }
    }

    #[test]
    fn overlapping_presses_hold_the_contact_closed_until_the_last_one_ends() {
        let paper = include_str!("../../../../../robots/paper.toml");
        let inputs = "[input.button]\npin = \"A1\"\n[input.nose]\npin = \"A2\"\n";
        let robot = Robot::parse(&format!("{paper}\n{inputs}")).expect("the robot is valid");
        let texts = [
            "nose@1-3",
            "nose@2-5",
            "button@4",
            "button@4.2",
            "nose@6-8",
            "nose@6-7",
        ];
        let presses = texts.map(|text| text.parse().expect("the press is valid"));
        let changes = list_contact_changes(&presses, &robot).expect("the robot has both inputs");
        let [button_pin, nose_pin] = [15, 16];
        let change = |time_ms, pin, is_closed| ContactChange {
            time_ms,
            pin,
            is_closed,
        };
        let expected = [
            change(1_000, nose_pin, true),
            change(4_000, button_pin, true),
            change(4_200, button_pin, false),
            change(4_200, button_pin, true),
            change(4_400, button_pin, false),
            change(5_000, nose_pin, false),
            change(6_000, nose_pin, true),
            change(8_000, nose_pin, false),
        ];
        assert_eq!(changes, expected);
    }
}
