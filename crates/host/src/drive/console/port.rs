//! Opens a serial port, and explains why it cannot be opened.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use serialport::{ErrorKind, SerialPort};

use super::find;

/// Bit rate of the console, baud.
pub const BAUD: u32 = 115_200;
/// Longest time that a read waits for a byte; also the interval between two checks of whether a port is still in use.
const READ_TIMEOUT: Duration = Duration::from_millis(5);
/// Longest wait for another program that is about to close the port.
const MAX_CLOSING_TIME: Duration = Duration::from_secs(1);

/// The reason why a port cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum PortError {
    /// The port does not exist.
    #[error("there is no {name}; USB serial ports of this machine: {ports}")]
    Missing {
        /// The port's name, as the user gave it.
        name: String,
        /// The USB serial ports that exist.
        ports: String,
    },
    /// Another program has the port open.
    #[error("{name} is open in {holder}; close that program, then try again")]
    Busy {
        /// The port that is busy.
        name: String,
        /// The program that has it open.
        holder: String,
    },
    /// The user has no permission.
    #[error(
        "you may not open {0}: it belongs to a group, on Debian dialout. As root: \
         usermod -aG dialout <user>, then log in again"
    )]
    Forbidden(String),
    /// The file is not a serial port.
    #[error("{0} is not a serial port")]
    NotAPort(String),
    /// Any other error.
    #[error("{name} cannot be opened: {error}")]
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
            _ => Self::Impossible(message),
        }
    }
}

/// Opens a port for this program alone. Opening it resets a UNO.
///
/// # Errors
/// Fails if the port is missing, busy, forbidden or not a serial port.
pub fn open(name: &str) -> Result<Box<dyn SerialPort>, PortError> {
    if cfg!(unix) && !Path::new(name).exists() {
        return Err(missing_port_error(name));
    }
    let busy_error = |holder: String| PortError::Busy {
        name: name.to_owned(),
        holder,
    };
    if let Some(holder) = find_persistent_holder(name) {
        return Err(busy_error(holder));
    }
    let result = serialport::new(name, BAUD).timeout(READ_TIMEOUT).open();
    result.map_err(|error| match error.kind() {
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => PortError::Forbidden(name.to_owned()),
        ErrorKind::Io(io::ErrorKind::NotFound) => missing_port_error(name),
        ErrorKind::NoDevice => busy_error("another program".to_owned()),
        _ if cfg!(unix) && is_not_terminal(name) => PortError::NotAPort(name.to_owned()),
        _ => PortError::Other {
            name: name.to_owned(),
            error,
        },
    })
}

/// True if this user may open a port. Does not open it, since that would reset a UNO.
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

fn missing_port_error(name: &str) -> PortError {
    let ports = find::usb_ports();
    let ports: Vec<String> = ports.iter().map(ToString::to_string).collect();
    PortError::Missing {
        name: name.to_owned(),
        ports: if ports.is_empty() {
            "none".to_owned()
        } else {
            ports.join(", ")
        },
    }
}

/// Returns the program that keeps the port open. Waits up to [`MAX_CLOSING_TIME`] for a program that is about to close
/// it, such as a console that is quitting or a simulated board that discards unread bytes.
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

/// Returns another program that has the port open, as far as `/proc` shows: processes of other users are not visible.
/// Two programs that share a port take bytes from each other.
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

fn is_not_terminal(name: &str) -> bool {
    use std::io::IsTerminal;
    std::fs::File::open(name).is_ok_and(|file| !file.is_terminal())
}

#[cfg(test)]
mod tests {
    #[cfg(target_os = "linux")]
    use lizard_time_limit::LIMIT;

    use super::*;

    fn open_error(name: &str) -> PortError {
        open(name).expect_err("the port must not open")
    }

    #[test]
    fn a_missing_port_and_a_file_that_is_not_a_port_have_different_errors() {
        let message = open_error("/dev/no-such-port").to_string();
        assert!(message.starts_with("there is no /dev/no-such-port; USB serial ports"));
        let file = tempfile::NamedTempFile::new().expect("a temporary file can be created");
        let name = file.path().display().to_string();
        assert_eq!(
            open_error(&name).to_string(),
            format!("{name} is not a serial port")
        );
        assert_eq!(crate::Failure::from(open_error(&name)).exit_code(), 2);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn opening_waits_for_a_program_that_is_about_to_close_the_port() {
        let file = tempfile::NamedTempFile::new().expect("a temporary file can be created");
        let name = file.path().display().to_string();
        let mut process = std::process::Command::new("sleep")
            .arg("0.1")
            .stdin(file.reopen().expect("the file can be reopened"))
            .spawn()
            .expect("`sleep` starts");
        let message = open_error(&name).to_string();
        LIMIT.wait_for_exit(&mut process).expect("the process ends");
        assert_eq!(message, format!("{name} is not a serial port"));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_port_that_another_program_has_open_is_refused_with_that_programs_name() {
        let file = tempfile::NamedTempFile::new().expect("a temporary file can be created");
        let name = file.path().display().to_string();
        let mut process = std::process::Command::new("sleep")
            .arg("60")
            .stdin(file.reopen().expect("the file can be reopened"))
            .spawn()
            .expect("`sleep` starts");
        let message = open_error(&name).to_string();
        process.kill().expect("the process can be killed");
        LIMIT.wait_for_exit(&mut process).expect("the process ends");
        let id = process.id();
        assert_eq!(
            message,
            format!("{name} is open in sleep (process {id}); close that program, then try again")
        );
    }
}
