//! `lizard info ports`: this machine's serial ports, and the boards that may be connected to them.

use std::fmt::Write as _;

use serde::Serialize;

use super::console::port;
use super::console::usb_ports::{self, ARDUINO_VENDOR_IDS, UsbPort};
use crate::Failure;
use crate::shared::escape::escape_controls;
use crate::shared::json;

/// List the USB serial ports with their chips and your permissions
///
/// Opens none of the ports, because opening would reset the board. The chip indicates the kind
/// of board; only `lizard info` reads from the board itself.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Print one JSON array, empty if there is no port
    #[arg(long)]
    json: bool,
}

/// A serial port; the field names are the JSON keys.
#[derive(Debug, Serialize)]
struct PortReport {
    /// The port's name.
    port: String,
    /// The USB vendor ID as four hexadecimal digits, as lsusb prints it.
    vendor: String,
    /// The USB product ID as four hexadecimal digits.
    product: String,
    /// The product name that the chip reports.
    name: Option<String>,
    /// The kind of chip and board, if known.
    chip: Option<&'static str>,
    /// True if this user may open the port.
    may_open: bool,
    /// The program that has the port open, if the system shows it.
    open_in: Option<String>,
}

impl PortReport {
    fn from_port(port: UsbPort) -> Self {
        let [vendor, product] = port.chip_ids.map(|id| format!("{id:04x}"));
        Self {
            vendor,
            product,
            chip: describe_chip(port.chip_ids),
            may_open: port::may_open(&port.name),
            open_in: port::find_holder(&port.name),
            name: port
                .product_name
                .map(|name| escape_controls(&name.replace('_', " "))),
            port: port.name,
        }
    }
}

/// Describes a chip by its USB vendor ID and product ID; `None` if the chip is unknown.
fn describe_chip(ids: [u16; 2]) -> Option<&'static str> {
    Some(match ids {
        [vendor, 0x0001 | 0x0043 | 0x0243] if ARDUINO_VENDOR_IDS.contains(&vendor) => {
            "an Arduino UNO"
        }
        [vendor, _] if ARDUINO_VENDOR_IDS.contains(&vendor) => "an Arduino, but not a UNO R3",
        [0x1a86, 0x7523 | 0x5523] => "a CH340: a clone of a UNO or Nano",
        [0x1a86, _] => "a WCH chip: a clone of a UNO or Nano",
        [0x0403, 0x6001 | 0x6015] => "an FTDI: an older Nano, or an adapter",
        [0x10c4, 0xea60] => "a CP210x: an adapter, rarely a UNO",
        _ => return None,
    })
}

/// Lists the ports.
///
/// # Errors
/// Fails if standard output cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let reports = usb_ports::list().into_iter().map(PortReport::from_port);
    let reports: Vec<PortReport> = reports.collect();
    json::print_json_or_text(args.json, &reports, || format_ports(&reports))
}

fn format_ports(reports: &[PortReport]) -> String {
    if reports.is_empty() {
        return "this machine has no USB serial port. Connect the UNO with a cable that carries data \
                (some only charge). A virtual machine, a container or WSL needs the port passed \
                through. Without a board: lizard console --sim\n"
            .to_owned();
    }
    let mut text = String::new();
    for report in reports {
        let name = report.name.as_deref().unwrap_or("no name");
        let chip = report.chip.unwrap_or("not the chip of a UNO");
        let (port, vendor, product) = (&report.port, &report.vendor, &report.product);
        _ = write!(text, "{port}  {name} ({vendor}:{product}), {chip}");
        if let Some(program) = &report.open_in {
            _ = write!(text, "; open in {program}");
        }
        if !report.may_open {
            text += "; no permission to open it";
        }
        text.push('\n');
    }
    if let Some(report) = reports.iter().find(|report| !report.may_open) {
        let error = port::PortError::Forbidden(report.port.clone());
        _ = writeln!(text, "{error}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn port_report(chip_ids: [u16; 2], product_name: Option<&str>) -> PortReport {
        PortReport::from_port(UsbPort {
            name: "/dev/no-such-port".to_owned(),
            chip_ids,
            product_name: product_name.map(str::to_owned),
        })
    }

    #[test]
    fn the_list_shows_usb_ids_and_the_kind_of_board() {
        let uno = port_report([0x2341, 0x0043], Some("Arduino_Uno\u{1b}"));
        let clone = port_report([0x1a86, 0x7523], None);
        let output = format_ports(&[uno, clone]);
        let output: Vec<&str> = output.lines().collect();
        for (line, part) in [
            (output[0], "Arduino Uno"),
            (output[0], "(2341:0043), an Arduino UNO"),
            (output[1], "no name (1a86:7523), a CH340"),
        ] {
            assert!(line.contains(part), "{part}: {output:?}");
        }
        assert!(!output[0].contains('\u{1b}'), "{output:?}");
        assert!(
            describe_chip([0x0483, 0x5740]).is_none(),
            "a chip of another maker"
        );
    }

    #[test]
    fn the_list_shows_the_remedy_and_the_program_for_a_forbidden_port() {
        let mut forbidden_port = port_report([0x2341, 0x0043], None);
        forbidden_port.may_open = false;
        forbidden_port.open_in = Some("screen (process 7)".to_owned());
        let output = format_ports(&[forbidden_port]);
        assert!(
            output.contains("; open in screen (process 7); no permission to open it\n"),
            "{output}"
        );
        assert!(output.contains("usermod -aG dialout"), "{output}");
        let mut free_port = port_report([0x2341, 0x0043], None);
        free_port.may_open = true;
        assert!(!format_ports(&[free_port]).contains("dialout"));
    }

    #[test]
    fn the_message_without_a_port_names_the_remedies() {
        assert!(format_ports(&[]).contains("carries data") && format_ports(&[]).contains("--sim"));
    }
}
