//! `lizard flash`: writes the firmware to a UNO or a Nano through the board's own boot loader.
//!
//! [`lizard_upload`] writes the pages in an order that keeps the robot safe if the cable is pulled; this module chooses
//! the port, builds the image and reports to the user.

pub mod image_source;
mod serial_board;

use std::io::{self, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use lizard_robot::RobotIdentity;
use lizard_upload::{
    Event, Image, Loader, Model, PAGE_BYTES, PageCounts, Step, Target, UploadError, upload,
};
use pollster::block_on;
use serde::Serialize;

use crate::drive::console::info;
use crate::drive::console::link::Link;
use crate::drive::console::port::BAUD_RATE;
use crate::drive::console::usb_ports::{self, ChoiceError, UsbPort};
use crate::shared::json;
use crate::shared::progress::create_progress_bar;
use crate::{Failure, RobotArgs};
use serial_board::SerialBoard;

/// Write the firmware with your robot to a UNO or a Nano on USB
///
/// Writes the built-in firmware, which needs no compiler, and the robot from robot.toml.
/// Reports the board's contents, writes the pages that differ, verifies them, starts the
/// firmware and prints its first line. The EEPROM with the calibration stays unchanged.
/// A new board takes about ten seconds; with --only-robot, about one.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The board's serial port [default: the port with a UNO, or the only port]
    port: Option<String>,
    /// The board's model [default: detected from its boot loader and its USB chip]
    #[arg(long, value_enum)]
    board: Option<Model>,
    /// Write only the robot, for example with a new gait; the board's firmware must be able to
    /// read it
    #[arg(long)]
    only_robot: bool,
    /// Write this Intel HEX file instead, with any contents
    #[arg(long, value_name = "FILE", conflicts_with_all = ["path", "only_robot"])]
    image: Option<PathBuf>,
    /// Print one JSON object when the firmware has answered; everything else goes to standard error
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotArgs,
}

/// The result of an upload; the field names are the JSON keys.
#[derive(Serialize)]
struct FlashReport {
    /// The port's name.
    port: String,
    bytes_written: usize,
    /// Bytes that were already correct.
    bytes_kept: usize,
    /// The firmware's version; null if the firmware answered without its first line.
    firmware: Option<String>,
    /// Null if the board has no robot.
    robot: Option<RobotIdentity>,
}

/// Runs `lizard flash`.
///
/// # Errors
/// Fails if the image cannot be built or read, no board is found, the upload fails, or the firmware does not answer
/// afterwards. After a failed upload, the message says what the flash now contains.
pub fn run(args: Args) -> Result<(), Failure> {
    let image = match &args.image {
        Some(path) => image_source::read_hex_image(path)?,
        None => image_source::build_image(&args.robot.load()?, args.only_robot)?,
    };
    let source = match &args.image {
        Some(path) => path.display().to_string(),
        None => args.robot.name()?,
    };
    let ports = usb_ports::list();
    let (port, board_name) = match args.port {
        Some(port) => (port.clone(), port),
        None => {
            let port = choose_port(&ports)?;
            (port.name.clone(), port.to_string())
        }
    };
    let target = Target {
        model: args.board,
        may_be_nano: may_be_nano(&ports, &port),
    };
    let board = SerialBoard::open(&port)?;
    print_error(&format!("lizard: writing {source}"));
    print_error(&format!(
        "lizard: contacting the boot loader of the board at {board_name}"
    ));
    let port_failure = |message: String| Failure::Operation(format!("{board_name}: {message}"));
    let (board, page_counts) = write_image(board, &image, target, args.json)
        .map_err(|error| port_failure(error.to_string()))?;
    let banner = Link::new(board).wait_for_robot().map_err(|error| {
        port_failure(format!(
            "the flash is written and verified, but the firmware does not answer: {error}"
        ))
    })?;
    let banner = banner.unwrap_or_else(|| "the robot answers".to_owned());
    let (firmware, robot) = info::parse_firmware_and_robot(&banner);
    let report = FlashReport {
        port,
        bytes_written: page_counts.written * PAGE_BYTES,
        bytes_kept: page_counts.kept * PAGE_BYTES,
        firmware,
        robot,
    };
    json::print_json_or_text(args.json, &report, || format!("{banner}\n"))
}

/// Chooses the board's port, for a user who has not named it.
fn choose_port(ports: &[UsbPort]) -> Result<UsbPort, Failure> {
    usb_ports::choose(ports, "flash").map_err(|error| {
        Failure::Operation(match error {
            // The usual message suggests a simulated board; `flash` needs a real one.
            ChoiceError::NoPort { .. } => "no board found: this machine has no USB serial port. \
                 Connect the UNO with a cable that carries data (some only charge), or name its \
                 port: lizard flash /dev/ttyACM0"
                .to_owned(),
            error => error.to_string(),
        })
    })
}

/// True if the port may be a Nano's port: unlike UNOs, Nanos never have one of Arduino's own USB chips.
fn may_be_nano(ports: &[UsbPort], name: &str) -> bool {
    // The name may be a symbolic link, for example in /dev/serial/by-id.
    let real_name = std::fs::canonicalize(name).unwrap_or_else(|_| name.into());
    // macOS has two names for a port, of which the list contains one. Windows ignores the case and a prefix.
    let real_name = real_name.to_string_lossy().replace("/dev/tty.", "/dev/cu.");
    let real_name = real_name.trim_start_matches(r"\\.\");
    let mut ports = ports.iter();
    let port = ports.find(|port| real_name.eq_ignore_ascii_case(&port.name));
    port.is_some_and(|port| !port.has_arduino_vendor_id())
}

/// Writes an image to the board, with a progress bar and a summary; if `prints_json` is true, the summary goes to
/// standard error. Returns the board, whose firmware is now starting, and the numbers of pages written and kept.
fn write_image(
    board: SerialBoard,
    image: &Image,
    target: Target,
    prints_json: bool,
) -> Result<(SerialBoard, PageCounts), Failure> {
    let print_line = |line: &str| match prints_json {
        true => print_error(line),
        false => _ = writeln!(io::stdout(), "{line}"),
    };
    let bar = create_progress_bar(0, "{msg} {wide_bar} {percent} %");
    let mut loader = Loader::new(board);
    let start = Instant::now();
    let mut report = |event: Event<'_>| match event {
        Event::Found(found_board) => bar.suspend(|| print_line(&found_board.to_string())),
        Event::Retry {
            error,
            tried_kind,
            next_kind,
        } => bar.suspend(|| match (tried_kind.baud(), next_kind.baud()) {
            (old_baud, new_baud) if old_baud != new_baud => {
                print_error(&format!(
                    "lizard: no answer at {old_baud} baud; retrying at {new_baud} baud"
                ));
            }
            _ => print_error(&format!(
                "lizard: {error}; resetting the board for another attempt"
            )),
        }),
        Event::Progress(step, done_count, total) => {
            bar.set_message(match step {
                Step::Reading => "reading  ",
                Step::Writing => "writing  ",
                Step::Verifying => "verifying",
            });
            bar.set_length(total as u64);
            bar.set_position(done_count as u64);
        }
    };
    let result = block_on(upload(&mut loader, image, target, &mut report));
    bar.finish_and_clear();
    let page_counts = result.map_err(to_failure)?;
    print_line(&format_summary(page_counts, start.elapsed()));
    let mut board = loader.into_board();
    prepare_for_console(&mut board)?;
    Ok((board, page_counts))
}

/// Prints a line to standard error. A closed stream does not stop the upload.
fn print_error(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Sets the console's baud rate after an upload.
fn prepare_for_console(board: &mut SerialBoard) -> Result<(), Failure> {
    board.set_baud_rate(BAUD_RATE).map_err(|error| {
        Failure::Operation(format!(
            "the flash is written and verified, but the port no longer works: {error}; if the cable is unplugged, \
             connect it again"
        ))
    })
}

/// Converts an upload's error to a failure that also names the option that helps.
fn to_failure(error: UploadError) -> Failure {
    let remedy = match &error {
        UploadError::NoLizard(_) | UploadError::Format { .. } => {
            ". Omit --only-robot to write both"
        }
        UploadError::TooLong(error) if error.is_model_uncertain => {
            ". If the board is a UNO, pass --board uno"
        }
        _ => "",
    };
    Failure::Operation(format!("{error}{remedy}"))
}

/// Formats the message about a finished upload.
fn format_summary(counts: PageCounts, duration: Duration) -> String {
    let [written, kept] = [counts.written, counts.kept].map(|pages| pages * PAGE_BYTES);
    let seconds = duration.as_secs_f64();
    let text = match written {
        0 => format!("nothing to write: all {kept} bytes are correct"),
        _ => format!("{written} bytes written and verified, {kept} already correct"),
    };
    format!("{text}; {seconds:.1} s")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_counts_bytes() {
        let summarise = |written, kept| {
            let duration = Duration::from_millis(1240);
            format_summary(PageCounts { written, kept }, duration)
        };
        let partial_text = "256 bytes written and verified, 26880 already correct; 1.2 s";
        assert_eq!(summarise(2, 210), partial_text);
        let unchanged_text = "nothing to write: all 27136 bytes are correct; 1.2 s";
        assert_eq!(summarise(0, 212), unchanged_text);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn the_error_for_a_cable_that_is_pulled_after_the_upload_says_that_the_flash_is_written() {
        use rustix::pty::{OpenptFlags, openpt, ptsname, unlockpt};
        let device = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY);
        let device = device.expect("a pseudo terminal can be opened");
        unlockpt(&device).expect("the pseudo terminal can be unlocked");
        let name = ptsname(&device, Vec::new()).expect("the pseudo terminal has a name");
        let name = name.to_str().expect("the name is ASCII");
        let mut board = SerialBoard::open(name).expect("the port opens");
        prepare_for_console(&mut board).expect("the port works");
        drop(device);
        let failure = prepare_for_console(&mut board).expect_err("the port is gone");
        assert_eq!(failure.exit_code(), 1);
        let start = "the flash is written and verified, but the port no longer works: ";
        let message = failure.to_string();
        assert!(message.starts_with(start), "{message}");
    }

    fn port(name: &str, vendor_id: u16) -> UsbPort {
        UsbPort {
            name: name.to_owned(),
            chip_ids: [vendor_id, 0x43],
            product_name: None,
        }
    }

    #[test]
    fn only_a_board_without_arduinos_usb_chip_may_be_a_nano() {
        let ports = [port("/dev/ttyACM7", 0x2341), port("/dev/ttyUSB7", 0x1a86)];
        assert!(!may_be_nano(&ports, "/dev/ttyACM7"));
        assert!(may_be_nano(&ports, "/dev/ttyUSB7"));
        assert!(!may_be_nano(&ports, "/dev/pts/7"), "it is not a USB port");
        for (listed_name, name) in [
            ("COM7", "com7"),
            ("COM7", r"\\.\COM7"),
            ("/dev/cu.usbserial-7", "/dev/tty.usbserial-7"),
        ] {
            assert!(may_be_nano(&[port(listed_name, 0x1a86)], name), "{name}");
        }
    }

    #[test]
    fn no_port_and_several_ports_are_errors_that_name_the_remedy() {
        let choice_error = |ports: &[UsbPort]| {
            let failure = choose_port(ports).expect_err("the choice must fail");
            failure.to_string()
        };
        assert!(choice_error(&[]).ends_with("lizard flash /dev/ttyACM0"));
        let ports = ["COM3", "COM4"].map(|name| port(name, 0x2341));
        let message = "several ports may have the board: COM3, COM4. Select one: lizard flash COM3";
        assert_eq!(choice_error(&ports), message);
    }
}
