//! Which firmware a command runs on the simulated UNO, and that it is the robot's.
//!
//! A firmware has the numbers of one robot compiled into it: its pins, its pulses,
//! its gaits. Run for another one, it moves other pins, so that all tables come out
//! empty or wrong, and nothing looks like a fault. So each image is started once and
//! asked: the first line that it says names the robot by a number, `tables 5265f050`.

use std::path::{Path, PathBuf};

use lizard_robot::Robot;
use simulated_uno::Fidelity;

use crate::board::{BANNER_MS, SimulatedBoard};
use crate::{Failure, RobotFile};

/// Where `make firmware` leaves it.
const BUILT: &str = "target/avr-atmega328p/release/lizard.elf";

/// Why an image is not run.
#[derive(Debug, thiserror::Error)]
enum FirmwareError {
    #[error("there is no firmware at {0}; build it with `make firmware`")]
    Missing(String),
    #[error(
        "{} is the firmware of another robot than {robot}: its tables are {its}, those of that \
         robot {wanted}; `make firmware{and_robot}` builds the right one, or --robot names \
         the robot that it was built for",
        elf.display()
    )]
    OtherRobot {
        elf: PathBuf,
        robot: String,
        its: String,
        wanted: String,
        /// ` ROBOT=...`, or nothing for the robot that is built without.
        and_robot: String,
    },
}

impl From<FirmwareError> for Failure {
    fn from(error: FirmwareError) -> Self {
        Self::Input(error.to_string())
    }
}

/// The firmware to run for a robot: the ELF file given, or the one that `make
/// firmware` leaves in this folder or one above it. `file` is where the robot was
/// read from.
///
/// A program that says no such first line is no lizard's and is let through: what it
/// does is seen when it runs.
///
/// # Errors
/// There is none, it is no program of an AVR, or it is the firmware of another robot.
pub(crate) fn of_robot(
    elf: Option<&Path>,
    file: &RobotFile,
    robot: &Robot,
) -> Result<PathBuf, Failure> {
    let elf = find(elf)?;
    let mut board = SimulatedBoard::power_on(&elf, Fidelity::DataSheet, robot)?;
    let banner = board.next_line(BANNER_MS).unwrap_or_default();
    let wanted = format!("{:08x}", robot.firmware().hash());
    match tables(&banner) {
        Some(its) if its != wanted => Err(FirmwareError::OtherRobot {
            robot: file.name()?,
            its: its.to_owned(),
            wanted,
            and_robot: file
                .given()
                .map(|path| format!(" ROBOT={}", path.display()))
                .unwrap_or_default(),
            elf,
        }
        .into()),
        _ => Ok(elf),
    }
}

/// The number of a robot in a firmware's first line, `# lizard 0.2.0 tables 5265f050, ...`.
fn tables(banner: &str) -> Option<&str> {
    let (_, after) = banner.strip_prefix("# lizard ")?.split_once(" tables ")?;
    let end = after.find(|c: char| !c.is_ascii_hexdigit());
    Some(&after[..end.unwrap_or(after.len())])
}

fn find(given: Option<&Path>) -> Result<PathBuf, Failure> {
    let missing = |path: &Path| FirmwareError::Missing(path.display().to_string()).into();
    if let Some(path) = given {
        return if path.is_file() {
            Ok(path.to_owned())
        } else {
            Err(missing(path))
        };
    }
    let here = crate::robot_file::here()?;
    let mut folders = here.ancestors().map(|folder| folder.join(BUILT));
    folders
        .find(|path| path.is_file())
        .ok_or_else(|| missing(Path::new(BUILT)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_the_robot_is_read_from_the_first_line() {
        let banner = "# lizard 0.2.0 tables 5265f050, send help for the commands";
        assert_eq!(tables(banner), Some("5265f050"));
        assert_eq!(tables("# lizard 0.2.0 tables 00ff"), Some("00ff"));
        assert_eq!(tables("# lizard 0.2.0"), None);
        assert_eq!(tables("hello tables 5265f050"), None);
        assert_eq!(tables(""), None);
    }
}
