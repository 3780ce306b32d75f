//! The inputs: switches between a pin and ground that can end a step of a routine.

use lizard_core::numbers::gaits::Input;

use crate::config::servo::{self, Servo, read_pin};
use crate::config::supply::Supplies;
use crate::file::{ReadResult, Section};

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
    pub(crate) fn read(
        root: &Section,
        servos: &[Servo; 4],
        supplies: &Supplies,
    ) -> ReadResult<Self> {
        if !root.has_key("input") {
            return Ok(Self::default());
        }
        let section = root.section("input", &INPUT_NAMES)?;
        let pins = servos.map(|servo| servo.pin);
        let named_pins = pins.into_iter().zip(servo::SERVO_NAMES);
        let mut used_pins: Vec<(u8, String)> = named_pins
            .map(|(pin, name)| (pin, format!("servo.{name}")))
            .collect();
        let rail_pin = supplies.rail.map(|rail| rail.pin);
        used_pins.extend(rail_pin.map(|pin| (pin, "supply.rail".to_string())));
        let mut read_input = |name: &str| -> ReadResult<Option<u8>> {
            if !section.has_key(name) {
                return Ok(None);
            }
            let input_section = section.section(name, &["pin"])?;
            let pin = read_pin(&input_section)?;
            if let Some((_, owner)) = used_pins.iter().find(|(used_pin, _)| *used_pin == pin) {
                let pin_name = input_section.text("pin")?;
                let message = format!("is \"{pin_name}\", which {owner} already uses");
                return Err(input_section.error("pin", message));
            }
            used_pins.push((pin, format!("input.{name}")));
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
