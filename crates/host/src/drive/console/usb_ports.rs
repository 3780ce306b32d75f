//! Lists this machine's USB serial ports, and chooses the board's port if the user has not named it.

use serialport::{SerialPortInfo, SerialPortType};

/// USB vendor IDs of the chips on UNOs and their clones: Arduino's IDs, and the ID of WCH, the maker of the CH340.
const UNO_VENDOR_IDS: [u16; 3] = [ARDUINO_VENDOR_IDS[0], ARDUINO_VENDOR_IDS[1], 0x1a86];
/// Arduino's USB vendor IDs.
pub(in crate::drive) const ARDUINO_VENDOR_IDS: [u16; 2] = [0x2341, 0x2a03];

/// A USB serial port.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UsbPort {
    /// The port's name, such as /dev/ttyACM0 or COM3.
    pub name: String,
    /// The USB chip's vendor ID and product ID.
    pub chip_ids: [u16; 2],
    /// The product name that the chip reports.
    pub product_name: Option<String>,
}

/// An error in the choice of a port.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChoiceError {
    /// There is no port.
    #[error(
        "no board found: this machine has no USB serial port. Connect the UNO with a cable that \
         carries data (some only charge), or name its port: lizard {command} /dev/ttyACM0; \
         --sim uses a simulated UNO"
    )]
    NoPort {
        /// The subcommand, with the arguments before the port.
        command: &'static str,
    },
    /// More than one port may have the board.
    #[error("several ports may have the board: {}. Select one: lizard {command} {}", join_names(.ports), .ports[0].name)]
    SeveralPorts {
        /// The subcommand, with the arguments before the port.
        command: &'static str,
        /// The ports that may have the board.
        ports: Vec<UsbPort>,
    },
}

/// Returns this machine's USB serial ports, sorted by name. Other ports, such as a mainboard's, are used only if
/// the user names them.
pub fn list() -> Vec<UsbPort> {
    let ports = serialport::available_ports().unwrap_or_default();
    let mut ports: Vec<UsbPort> = ports.into_iter().filter_map(to_usb_port).collect();
    ports.sort_by(|a, b| a.name.cmp(&b.name));
    ports
}

fn to_usb_port(port: SerialPortInfo) -> Option<UsbPort> {
    let SerialPortType::UsbPort(usb) = port.port_type else {
        return None;
    };
    // macOS lists each port twice; opening the port called /dev/tty.* would wait for a modem's carrier.
    if port.port_name.starts_with("/dev/tty.") {
        return None;
    }
    Some(UsbPort {
        name: port.port_name,
        chip_ids: [usb.vid, usb.pid],
        product_name: usb.product,
    })
}

/// Keeps only the ports whose chip has these IDs; keeps all ports if `chip_ids` is `None`.
pub(super) fn retain_chip(ports: &mut Vec<UsbPort>, chip_ids: Option<&[u16; 2]>) {
    ports.retain(|port| chip_ids.is_none_or(|chip_ids| port.chip_ids == *chip_ids));
}

impl UsbPort {
    /// True if the chip has one of Arduino's vendor IDs.
    pub fn has_arduino_vendor_id(&self) -> bool {
        let [vendor_id, _] = self.chip_ids;
        ARDUINO_VENDOR_IDS.contains(&vendor_id)
    }
}

/// Chooses the only port with a UNO's USB chip; if no port has one, the only port.
///
/// # Errors
/// Fails if there is no such port, or more than one.
pub fn choose(ports: &[UsbPort], command: &'static str) -> Result<UsbPort, ChoiceError> {
    let mut candidates = ports.to_vec();
    candidates.retain(|UsbPort { chip_ids, .. }| UNO_VENDOR_IDS.contains(&chip_ids[0]));
    if candidates.is_empty() {
        candidates = ports.to_vec();
    }
    match candidates.as_slice() {
        [port] => Ok(port.clone()),
        [] => Err(ChoiceError::NoPort { command }),
        _ => Err(ChoiceError::SeveralPorts {
            command,
            ports: candidates,
        }),
    }
}

impl std::fmt::Display for UsbPort {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.product_name {
            Some(product) => write!(f, "{} ({})", self.name, product.replace('_', " ")),
            None => f.write_str(&self.name),
        }
    }
}

/// Lists the ports, separated by commas, each with its product name.
pub(super) fn join_names(ports: &[UsbPort]) -> String {
    let names: Vec<String> = ports.iter().map(ToString::to_string).collect();
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn port(name: &str, vendor_id: u16) -> UsbPort {
        UsbPort {
            name: format!("/dev/{name}"),
            chip_ids: [vendor_id, 0x43],
            product_name: (vendor_id == 0x2341).then(|| "Arduino_Uno".to_owned()),
        }
    }

    fn choose_from(ports: &[(&str, u16)]) -> Result<String, String> {
        let ports: Vec<UsbPort> = ports.iter().map(|(name, id)| port(name, *id)).collect();
        let port = choose(&ports, "console").map_err(|error| error.to_string())?;
        Ok(port.to_string())
    }

    #[test]
    fn the_only_uno_or_the_only_port_with_any_chip_is_chosen() {
        let other_port = ("ttyUSB0", 0x0403);
        for (ports, chosen) in [
            (
                &[other_port, ("ttyACM0", 0x2341), ("ttyACM1", 0x1546)][..],
                "ttyACM0 (Arduino Uno)",
            ),
            (&[other_port, ("ttyUSB1", 0x1a86)][..], "ttyUSB1"),
            (&[other_port][..], "ttyUSB0"),
        ] {
            assert_eq!(choose_from(ports), Ok(format!("/dev/{chosen}")));
        }
    }

    #[test]
    fn the_port_of_another_chip_does_not_replace_an_unplugged_board() {
        let [uno, adapter] = [port("ttyACM0", 0x2341), port("ttyUSB0", 0x0403)];
        let mut ports = vec![adapter.clone()];
        retain_chip(&mut ports, None);
        assert_eq!(ports, [adapter]);
        retain_chip(&mut ports, Some(&uno.chip_ids));
        assert!(ports.is_empty(), "{ports:?}");
    }

    #[test]
    fn errors_for_no_port_and_several_ports_name_the_remedy() {
        let message = choose_from(&[]).expect_err("the choice must fail without a port");
        for part in ["carries data", "lizard console /dev/ttyACM0"] {
            assert!(message.contains(part), "{message}");
        }
        let ports = [
            ("ttyACM0", 0x2341),
            ("ttyUSB0", 0x1a86),
            ("ttyUSB1", 0x0403),
        ];
        let message = "several ports may have the board: /dev/ttyACM0 (Arduino Uno), /dev/ttyUSB0. Select one: \
                       lizard console /dev/ttyACM0";
        assert_eq!(choose_from(&ports), Err(message.to_owned()));
        assert!(choose_from(&[("ttyUSB0", 1), ("ttyUSB1", 2)]).is_err());
    }
}
