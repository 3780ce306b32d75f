//! `lizard info`: reports a board's firmware, robot, calibration and fault.

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::time::Duration;

use lizard_calibrate::{ReplyError, read_settings};
use lizard_robot::servo::SERVO_NAMES;
use lizard_robot::{Banner, Calibration, RobotIdentity, ServoSettings, Status};
use pollster::block_on;
use serde::Serialize;

use super::connect::ConnectionArgs;
use super::link::{BANNER_START, Link, LinkError};
use crate::Failure;
use crate::shared::json;

/// Report a board's firmware, robot, calibration and fault
///
/// Does not change the board. Opening the port resets a UNO, which ends its gait.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    connection: ConnectionArgs,
}

/// A board's answers; the field names are the JSON keys.
#[derive(Debug, Serialize)]
struct BoardInfo {
    port: String,
    /// The firmware's version; null if the board was not reset and sent no banner.
    firmware: Option<String>,
    /// The robot's name and hash; null if the board has no robot or sent no banner.
    robot: Option<RobotIdentity>,
    gait: String,
    fault: Option<String>,
    /// The board's supply voltage, V; null if it is not measured.
    vcc: Option<f64>,
    /// The voltage of the servo rail, V; null if it is not measured.
    rail: Option<f64>,
    /// The calibration; null on a board without a robot.
    calibration: Option<CalibrationInfo>,
}

/// A calibration; the field names are the keys of its file.
#[derive(Debug, Serialize)]
struct CalibrationInfo {
    boot: String,
    /// The time without a line after which the robot ends its gait, ms; 0 for never.
    deadman: u16,
    /// Each servo's settings, by servo name.
    servo: BTreeMap<&'static str, ServoSettings>,
}

impl From<Calibration> for CalibrationInfo {
    fn from(calibration: Calibration) -> Self {
        Self {
            boot: calibration.boot,
            deadman: calibration.deadman,
            servo: SERVO_NAMES.into_iter().zip(calibration.servos).collect(),
        }
    }
}

/// Runs `lizard info`.
///
/// # Errors
/// Fails if there is no board, or if its answers are not those of the firmware.
pub fn run(args: Args) -> Result<(), Failure> {
    let finder = args.connection.into_finder("info")?;
    let (mut board, banner) = finder.connect()?;
    let result = BoardInfo::read(board.name.clone(), banner.as_deref(), &mut board.link);
    let info = result.map_err(|error| board.to_failure(error))?;
    json::print_json_or_text(args.json, &info, || info.to_text())
}

impl BoardInfo {
    fn read<P: Read + Write>(
        port: String,
        banner: Option<&str>,
        link: &mut Link<P>,
    ) -> Result<Self, LinkError> {
        let status = read_status_with_voltages(link)?;
        let calibration = match block_on(read_settings(link)) {
            Ok(calibration) => Some(calibration.into()),
            Err(error) if error.is_refusal() => None,
            Err(error) => return Err(error.into()),
        };
        let (firmware, robot) = banner.map_or((None, None), parse_firmware_and_robot);
        Ok(Self {
            port,
            firmware,
            robot,
            gait: status.gait,
            fault: status.fault,
            vcc: status.vcc,
            rail: status.rail,
            calibration,
        })
    }

    fn to_text(&self) -> String {
        let unknown = || "unknown: the board was not reset".to_owned();
        let firmware = self.firmware.as_ref();
        let firmware = firmware.map_or_else(unknown, |version| format!("lizard {version}"));
        let robot = match (&self.robot, &self.firmware) {
            (Some(robot), _) => format!("{} {}", robot.name, robot.hash),
            (None, Some(_)) => "none: lizard flash --only-robot writes one".to_owned(),
            (None, None) => unknown(),
        };
        let mut rows = vec![
            ("port", self.port.clone()),
            ("firmware", firmware),
            ("robot", robot),
            ("gait", self.gait.clone()),
            ("fault", self.fault.as_deref().unwrap_or("none").to_owned()),
        ];
        for (name, volts) in [("supply", self.vcc), ("servos", self.rail)] {
            rows.extend(volts.map(|volts| (name, format!("{volts:.2} V"))));
        }
        if let Some(calibration) = &self.calibration {
            rows.push(("boot", calibration.boot.clone()));
            rows.push(("deadman", format!("{} ms", calibration.deadman)));
            for (name, servo) in &calibration.servo {
                let [min, max] = servo.limit;
                let settings = format!(
                    "trim {:.2} deg, limits {min:.2} to {max:.2} deg, direction {}, {:.2} us/deg",
                    servo.trim, servo.dir, servo.scale
                );
                rows.push((*name, settings));
            }
        }
        let lines = rows
            .iter()
            .map(|(name, value)| format!("{name:<12}{value}\n"));
        lines.collect()
    }
}

/// Reads the status. A board that was just reset reports no voltage until its analogue-to-digital converter has run;
/// the request is therefore repeated for up to a second. A board without a robot has no pose and is asked only once.
fn read_status_with_voltages<P: Read + Write>(link: &mut Link<P>) -> Result<Status, LinkError> {
    for _ in 0..9 {
        let status = read_status(link)?;
        if status.vcc.is_some() || status.pose.is_none() {
            return Ok(status);
        }
        link.pause(Duration::from_millis(100))?;
    }
    read_status(link)
}

fn read_status<P: Read + Write>(link: &mut Link<P>) -> Result<Status, LinkError> {
    let answer = link.command("status")?.answer;
    Status::parse(&answer).ok_or_else(|| {
        let line = "status".to_owned();
        ReplyError::UnknownFormat { line, answer }.into()
    })
}

/// Parses the firmware's version and the robot in a banner; the robot is `None` on a board without a robot, and for
/// older firmware, which does not name the robot compiled into it.
pub(in crate::drive) fn parse_firmware_and_robot(
    line: &str,
) -> (Option<String>, Option<RobotIdentity>) {
    match Banner::parse(line) {
        Some(Banner { version, robot }) => (Some(version), robot),
        None => {
            let rest = line.strip_prefix(BANNER_START);
            let version = rest.and_then(|rest| rest.split([' ', ',']).next());
            (version.map(str::to_owned), None)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_double::{PAPER_TOML, connect_paper_robot, read_calibration};
    use super::*;

    #[test]
    fn the_report_shows_the_board_and_changes_nothing() {
        let mut link = connect_paper_robot();
        link.command("trim 3 -4.25").expect("the line is accepted");
        let before = read_calibration(&mut link);
        let paper = lizard_robot::Robot::parse(PAPER_TOML).expect("paper.toml is valid");
        let hash = format!("{:08x}", paper.firmware().hash());
        let banner = format!("# lizard 1.2.3 robot paper {hash}, send help for the commands");
        let board = BoardInfo::read("COM3".to_owned(), Some(&banner), &mut link)
            .expect("the board answers");
        let text = board.to_text();
        for line in [
            "port        COM3\n".to_owned(),
            "firmware    lizard 1.2.3\n".to_owned(),
            format!("robot       paper {hash}\n"),
            "fault       none\n".to_owned(),
            "boot        stand\n".to_owned(),
            "A3          trim -4.25 deg, limits ".to_owned(),
        ] {
            assert!(text.contains(&line), "{line:?} in {text}");
        }
        let after = read_calibration(&mut link);
        assert!(after.is_equivalent_to(&before), "nothing was changed");
    }

    #[test]
    fn the_banner_of_old_firmware_has_a_version_and_no_robot() {
        let old_banner = parse_firmware_and_robot("# lizard 0.1.0, send help for the commands");
        assert_eq!(old_banner, (Some("0.1.0".to_owned()), None));
        assert_eq!(parse_firmware_and_robot("hello"), (None, None));
    }
}
