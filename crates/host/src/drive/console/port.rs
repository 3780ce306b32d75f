//! Opens a serial port and reports errors with their remedies.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use serialport::{ErrorKind, SerialPort, SerialPortBuilder};

use super::usb_ports;

/// The console's baud rate.
pub const BAUD_RATE: u32 = 115_200;
/// Longest wait for a byte; also the interval between two checks for another program at the port.
const READ_TIMEOUT: Duration = Duration::from_millis(5);
/// Longest wait for another program that is about to close the port.
const MAX_CLOSING_TIME: Duration = Duration::from_secs(1);

/// An error in opening a port.
#[derive(Debug, thiserror::Error)]
pub enum PortError {
    /// The port does not exist.
    #[error("{name} does not exist; USB serial ports of this machine: {ports}")]
    Missing {
        /// The port's name, as the user gave it.
        name: String,
        /// The USB serial ports that exist.
        ports: String,
    },
    /// Another program has the port open.
    #[error("{name} is open in {holder}; close that program and try again")]
    Busy {
        /// The busy port.
        name: String,
        /// The program that has it open.
        holder: String,
    },
    /// The user has no permission.
    #[error(
        "no permission to open {0}: join its group (on Debian, dialout). As root: \
         usermod -aG dialout <user>, then log in again"
    )]
    Forbidden(String),
    /// The file is not a serial port.
    #[error("{0} is not a serial port")]
    NotAPort(String),
    /// Any other error.
    #[error("cannot open {name}: {error}")]
    Other {
        /// The port's name, as the user gave it.
        name: String,
        /// The error of the serial port library.
        error: serialport::Error,
    },
}

impl From<PortError> for crate::Failure {
    fn from(error: PortError) -> Self {
        let message = error.to_string();
        match error {
            PortError::Missing { .. } | PortError::NotAPort(_) => Self::Input(message),
            _ => Self::Operation(message),
        }
    }
}

/// Opens a port for this program alone. This resets a UNO.
///
/// # Errors
/// Fails if the port is missing, busy, forbidden or not a serial port.
pub fn open(name: &str) -> Result<Box<dyn SerialPort>, PortError> {
    if cfg!(unix) && !Path::new(name).exists() {
        return Err(missing_port_error(name));
    }
    if is_memory_device(name) {
        return Err(PortError::NotAPort(name.to_owned()));
    }
    let busy_error = |holder: String| PortError::Busy {
        name: name.to_owned(),
        holder,
    };
    if let Some(holder) = find_persistent_holder(name) {
        return Err(busy_error(holder));
    }
    port_builder(name)
        .open()
        .map_err(|error| match error.kind() {
            ErrorKind::Io(io::ErrorKind::PermissionDenied) => PortError::Forbidden(name.to_owned()),
            ErrorKind::Io(io::ErrorKind::NotFound) => missing_port_error(name),
            // Windows reports a missing port and a busy port by the same error.
            ErrorKind::NoDevice if cfg!(windows) && !is_listed(name) => missing_port_error(name),
            ErrorKind::NoDevice => busy_error("another program".to_owned()),
            _ if cfg!(unix) && is_not_terminal(name) => PortError::NotAPort(name.to_owned()),
            _ => PortError::Other {
                name: name.to_owned(),
                error,
            },
        })
}

/// Returns the settings of a port. The line DTR, which resets a UNO, is set explicitly: Linux sets it when a port is
/// opened, but Windows does not. A port without this line, such as a pseudo terminal, opens, too.
fn port_builder(name: &str) -> SerialPortBuilder {
    let builder = serialport::new(name, BAUD_RATE).timeout(READ_TIMEOUT);
    builder.dtr_on_open(true)
}

/// True if this user may open a port. Does not open the port, which would reset a UNO.
#[cfg(target_os = "linux")]
pub(in crate::drive) fn may_open(name: &str) -> bool {
    use rustix::fs::{Access, access};
    access(name, Access::READ_OK | Access::WRITE_OK).is_ok()
}

/// Always true: other systems let every user open a port.
#[cfg(not(target_os = "linux"))]
pub(in crate::drive) fn may_open(_: &str) -> bool {
    true
}

/// True if Windows lists a port of this name. Upper and lower case are equivalent.
fn is_listed(name: &str) -> bool {
    let name = name.trim_start_matches(r"\\.\");
    let ports = serialport::available_ports().unwrap_or_default();
    let mut ports = ports.iter();
    ports.any(|port| port.port_name.eq_ignore_ascii_case(name))
}

fn missing_port_error(name: &str) -> PortError {
    let ports = match usb_ports::list() {
        ports if ports.is_empty() => "none".to_owned(),
        ports => usb_ports::join_names(&ports),
    };
    let name = name.to_owned();
    PortError::Missing { name, ports }
}

/// Returns the program that keeps the port open. Waits up to [`MAX_CLOSING_TIME`] for a program that is about to close
/// the port, such as a quitting console or a simulated board that discards unread bytes.
fn find_persistent_holder(name: &str) -> Option<String> {
    let start = Instant::now();
    loop {
        let holder = find_holder(name)?;
        if start.elapsed() > MAX_CLOSING_TIME {
            return Some(holder);
        }
        std::thread::sleep(READ_TIMEOUT);
    }
}

/// Finds another program that has the port open: two programs that share a port would take bytes from each other.
/// `/proc` does not show which files the programs of other users have open.
pub(in crate::drive) fn find_holder(name: &str) -> Option<String> {
    let port = std::fs::canonicalize(name).ok()?;
    let own_id = std::process::id().to_string();
    let processes = std::fs::read_dir("/proc").ok()?;
    processes.flatten().find_map(|process| {
        let id = process.file_name().into_string().ok()?;
        if id == own_id || !id.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        let mut files = std::fs::read_dir(process.path().join("fd")).ok()?.flatten();
        files.find(|file| std::fs::read_link(file.path()).is_ok_and(|target| target == port))?;
        let program = std::fs::read_to_string(process.path().join("comm")).ok()?;
        Some(format!("{} (process {id})", program.trim()))
    })
}

/// True for /dev/null and similar devices, which many programs have open.
#[cfg(target_os = "linux")]
fn is_memory_device(name: &str) -> bool {
    use std::os::unix::fs::{FileTypeExt, MetadataExt};
    const MEMORY_MAJOR: u32 = 1;
    Path::new(name).metadata().is_ok_and(|metadata| {
        metadata.file_type().is_char_device() && rustix::fs::major(metadata.rdev()) == MEMORY_MAJOR
    })
}

#[cfg(not(target_os = "linux"))]
fn is_memory_device(_: &str) -> bool {
    false
}

/// True if the file is not a terminal. On Unix, every serial port is a terminal, which is a character device. Only such
/// a device is opened, because the opening of a FIFO would wait for a program that writes to it.
#[cfg(unix)]
fn is_not_terminal(name: &str) -> bool {
    use std::io::IsTerminal;
    use std::os::unix::fs::FileTypeExt;
    let is_device = |metadata: std::fs::Metadata| metadata.file_type().is_char_device();
    !Path::new(name).metadata().is_ok_and(is_device)
        || std::fs::File::open(name).is_ok_and(|file| !file.is_terminal())
}

#[cfg(not(unix))]
fn is_not_terminal(_: &str) -> bool {
    false
}

#[cfg(test)]
mod tests {
    #[cfg(target_os = "linux")]
    use lizard_time_limit::TIME_LIMIT;

    use super::*;

    fn open_error(name: &str) -> PortError {
        open(name).expect_err("the port must not open")
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_fifo_is_refused_although_no_program_writes_to_it() {
        use rustix::fs::{CWD, FileType, Mode, mknodat};
        let folder = tempfile::tempdir().expect("a temporary folder is created");
        let fifo = folder.path().join("fifo");
        let created = mknodat(CWD, &fifo, FileType::Fifo, Mode::RWXU, 0);
        created.expect("the FIFO is created");
        let name = fifo.display().to_string();
        let expected = format!("{name} is not a serial port");
        let message = TIME_LIMIT.run("a refusal", move || open_error(&name).to_string());
        assert_eq!(message, expected);
    }

    /// Creates a file, which is not a port; also returns its name.
    fn create_file() -> (tempfile::NamedTempFile, String) {
        let file = tempfile::NamedTempFile::new().expect("a temporary file can be created");
        let name = file.path().display().to_string();
        (file, name)
    }

    #[test]
    fn opening_a_port_sets_the_line_that_resets_a_uno_on_every_system() {
        let builder = port_builder("COM3");
        assert_eq!(builder, builder.clone().dtr_on_open(true));
    }

    #[test]
    fn a_missing_port_and_an_ordinary_file_have_different_errors() {
        let message = open_error("/dev/no-such-port").to_string();
        assert!(message.starts_with("/dev/no-such-port does not exist; USB serial ports"));
        let (_file, name) = create_file();
        let message = open_error(&name).to_string();
        assert_eq!(message, format!("{name} is not a serial port"));
        assert_eq!(crate::Failure::from(open_error(&name)).exit_code(), 2);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn dev_null_is_not_a_port_even_if_another_program_has_it_open() {
        let process = std::process::Command::new("sleep")
            .arg("60")
            .stdin(std::process::Stdio::null())
            .spawn();
        let mut process = process.expect("`sleep` starts");
        let message = open_error("/dev/null").to_string();
        process.kill().expect("the process can be killed");
        let exit = TIME_LIMIT.wait_for_exit(&mut process);
        exit.expect("the process ends");
        assert_eq!(message, "/dev/null is not a serial port");
    }

    /// Tries to open a file while another program has it open for some seconds; returns the file's name, that program
    /// and the error.
    #[cfg(target_os = "linux")]
    fn open_held(seconds: &str) -> (String, std::process::Child, String) {
        let (file, name) = create_file();
        let process = std::process::Command::new("sleep")
            .arg(seconds)
            .stdin(file.reopen().expect("the file can be reopened"))
            .spawn()
            .expect("`sleep` starts");
        let message = open_error(&name).to_string();
        (name, process, message)
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn open_waits_for_a_program_that_is_about_to_close_the_port() {
        let (name, mut process, message) = open_held("0.1");
        let exit = TIME_LIMIT.wait_for_exit(&mut process);
        exit.expect("the process ends");
        assert_eq!(message, format!("{name} is not a serial port"));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_error_names_the_program_that_has_the_port_open() {
        let (name, mut process, message) = open_held("60");
        process.kill().expect("the process can be killed");
        let exit = TIME_LIMIT.wait_for_exit(&mut process);
        exit.expect("the process ends");
        let holder = format!("sleep (process {})", process.id());
        let expected = format!("{name} is open in {holder}; close that program and try again");
        assert_eq!(message, expected);
    }
}
