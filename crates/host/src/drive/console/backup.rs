//! `lizard calibrate backup` and `lizard calibrate restore`: keep a calibration in a file.

use std::error::Error;
use std::io::{self, Read, Write};
use std::path::PathBuf;

use lizard_calibrate::{
    ReplaceError, read_settings, replace_settings, send_command, send_settings,
};
use lizard_robot::Calibration;
use pollster::block_on;

use super::connect::ConnectionArgs;
use super::link::{Link, LinkError};
use crate::Failure;
use crate::shared::files;

/// Save the robot's calibration to a file
///
/// Writes the servos' trims, limits, signs and scales, `boot` and `deadman` as TOML.
/// Opening a USB port resets the board, so these are the last saved values. By radio they
/// are the active values, saved or not.
#[derive(clap::Args, Debug)]
pub struct BackupArgs {
    /// The file to write; an existing file is replaced
    file: PathBuf,
    #[command(flatten)]
    connection: ConnectionArgs,
}

/// Send a calibration from a file to the robot, and save it in the board
///
/// The robot checks the calibration. If it refuses any value, nothing is saved and the robot
/// keeps its old calibration.
#[derive(clap::Args, Debug)]
pub struct RestoreArgs {
    /// A file that `lizard calibrate backup` wrote
    file: PathBuf,
    #[command(flatten)]
    connection: ConnectionArgs,
}

/// Runs `lizard calibrate backup`.
///
/// # Errors
/// Fails if there is no board, the board does not answer, or the file cannot be written.
pub fn backup(args: BackupArgs) -> Result<(), Failure> {
    let finder = args.connection.into_finder("calibrate backup FILE")?;
    let (mut board, _) = finder.connect()?;
    let calibration = block_on(read_settings(&mut board.link))
        .map_err(|error| board.to_failure(LinkError::from(error)))?;
    files::write(&args.file, calibration.to_toml().as_bytes())?;
    if files::is_standard_output(&args.file) {
        return Ok(());
    }
    Ok(writeln!(
        io::stdout(),
        "saved the calibration of {} to {}",
        board.name,
        args.file.display()
    )?)
}

/// Runs `lizard calibrate restore`.
///
/// # Errors
/// Fails if the file is not a calibration, there is no board, or the robot refuses the calibration.
pub fn restore(args: RestoreArgs) -> Result<(), Failure> {
    let text = files::read_text(&args.file)?;
    let calibration = Calibration::parse(&text, &args.file.display().to_string())
        .map_err(|error| Failure::Input(error.to_string()))?;
    let finder = args.connection.into_finder("calibrate restore FILE")?;
    let (mut board, _) = finder.connect()?;
    send_calibration(&calibration, &mut board.link)
        .map_err(|error| Failure::Operation(format!("{}: {error}", args.file.display())))?;
    Ok(writeln!(
        io::stdout(),
        "{} has accepted and saved the calibration from {}",
        board.name,
        args.file.display()
    )?)
}

/// Sends a calibration to a robot, reads it back and saves it; if the robot refuses to save, restores its old settings.
///
/// # Errors
/// Fails if the robot refuses the calibration or reports a different one, or if the connection breaks. The message says
/// what the robot has saved.
pub fn send_calibration<P: Read + Write>(
    calibration: &Calibration,
    link: &mut Link<P>,
) -> Result<(), Box<dyn Error>> {
    let old_settings = block_on(read_settings(link)).map_err(ReplaceError::Refused)?;
    block_on(replace_settings(link, &old_settings, calibration))?;
    match block_on(send_command(link, "save")) {
        Ok(_) => Ok(()),
        Err(error) if error.is_refusal() => {
            block_on(send_settings(link, &old_settings)).map_err(ReplaceError::Mixed)?;
            Err(ReplaceError::Refused(error).into())
        }
        Err(error) => {
            let advice = "the robot may have saved the calibration: restore it once more";
            Err(format!("{error}; {advice}").into())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_double::{
        connect_paper_robot, connect_paper_robot_unplugged_at, read_calibration,
    };
    use super::*;

    #[test]
    fn a_restored_backup_is_active_after_load() {
        let mut link = connect_paper_robot();
        link.command("trim 3 -4.25").expect("the line is accepted");
        link.command("boot walk").expect("the line is accepted");
        let saved = read_calibration(&mut link);
        let saved = Calibration::parse(&saved.to_toml(), "a.toml").expect("the backup is valid");
        link.command("factory").expect("the line is accepted");
        send_calibration(&saved, &mut link).expect("the calibration is accepted and saved");
        link.command("factory").expect("the line is accepted");
        link.command("load").expect("a calibration was saved");
        assert!(read_calibration(&mut link).is_equivalent_to(&saved));
    }

    #[test]
    fn a_robot_that_does_not_answer_save_may_have_saved() {
        let mut link = connect_paper_robot_unplugged_at("save");
        let calibration = read_calibration(&mut link);
        let error = send_calibration(&calibration, &mut link).expect_err("the port is gone");
        let expected = "; the robot may have saved the calibration: restore it once more";
        assert!(error.to_string().ends_with(expected), "{error}");
    }

    #[test]
    fn a_refused_calibration_changes_and_saves_nothing() {
        let mut link = connect_paper_robot();
        link.command("trim 3 -4.25").expect("the line is accepted");
        let before = read_calibration(&mut link);
        let mut calibration = before.clone();
        calibration.servos[0].trim = 5.0;
        calibration.servos[2].scale = 99.0;
        let error =
            send_calibration(&calibration, &mut link).expect_err("the scale must be refused");
        assert_eq!(
            error.to_string(),
            "the robot refuses `scale 3 99.00`: err 3 scale must be 5..20; nothing was saved, and \
             the robot keeps its old settings"
        );
        assert!(read_calibration(&mut link).is_equivalent_to(&before));
        let load = link.ask("load").expect("the robot answers").answer;
        assert!(load.starts_with("err 9"), "{load}");
    }
}
