//! The inputs: switches between a pin and ground that can end a step of a routine.

use lizard_core::numbers::gaits::Input;

use crate::config::servo::{UsedPins, claim_pin, read_pin};
use crate::file::{ReadResult, Table};

/// The names of the inputs in robot.toml, in the order of the fields of [`Inputs`].
pub const INPUT_NAMES: [&str; 2] = ["button", "nose"];

/// The Arduino pin numbers of a robot's inputs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Inputs {
    /// The pin of the push button; `None` if the robot has no button.
    pub button: Option<u8>,
    /// The pin of the switch on the robot's nose, which an obstacle closes; `None` if the robot has no such switch.
    pub nose: Option<u8>,
}

impl Inputs {
    /// Reads `[input]`; every input is optional.
    pub(crate) fn read(root: &Table, used_pins: &mut UsedPins) -> ReadResult<Self> {
        let table = root.optional_table("input", &INPUT_NAMES)?;
        let mut read_input = |name: &str| -> ReadResult<Option<u8>> {
            if !table.has_key(name) {
                return Ok(None);
            }
            let input_table = table.table(name, &["pin"])?;
            let pin = read_pin(&input_table)?;
            claim_pin(&input_table, pin, used_pins)?;
            Ok(Some(pin))
        };
        let [button, nose] = INPUT_NAMES;
        Ok(Self {
            button: read_input(button)?,
            nose: read_input(nose)?,
        })
    }

    /// The name and the Arduino pin number of each input that the robot has.
    pub fn named_pins(&self) -> impl Iterator<Item = (&'static str, u8)> {
        let pins = INPUT_NAMES.into_iter().zip([self.button, self.nose]);
        pins.filter_map(|(name, pin)| Some((name, pin?)))
    }

    /// Returns the core's [`Input`] with this name; `None` if the robot does not have this input.
    pub(crate) fn find_input(&self, name: &str) -> Option<Input> {
        match name {
            "button" => self.button.map(Input::button),
            "nose" => self.nose.map(Input::nose),
            _ => None,
        }
    }
}
