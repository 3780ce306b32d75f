//! Reads and replaces all settings of a robot.

use lizard_robot::{Calibration, Transfer};

use crate::console::{Console, ConsoleError, ReplyError, send_command};

/// Reads a robot's settings.
///
/// # Errors
/// Fails if the robot does not answer, or if its answer has an unknown format.
pub async fn read_settings<C: Console>(console: &mut C) -> crate::Result<Calibration, C> {
    let reply = send_command(console, "cal").await?;
    Calibration::from_cal_answer(&reply.notes).ok_or_else(|| {
        let (line, answer) = ("cal".to_owned(), reply.notes.join(" / "));
        ReplyError::UnknownFormat { line, answer }.into()
    })
}

/// Sends settings in the order of a [`Transfer`], without saving them.
///
/// # Errors
/// Fails if the connection breaks, or if the robot refuses lines in the last round; the error is then the first refusal
/// of that round. After an error, the robot has only some of the settings.
pub async fn send_settings<C: Console>(
    console: &mut C,
    calibration: &Calibration,
) -> crate::Result<(), C> {
    let mut transfer = Transfer::new(calibration);
    let mut refusal = None;
    while let Some(line) = transfer.next_line() {
        match send_command(console, &line).await {
            Ok(_) => {}
            Err(error) if error.is_refusal() => {
                if transfer.record_refusal() {
                    refusal = Some(error);
                }
            }
            Err(error) => return Err(error),
        }
    }
    let last_refusal = refusal.filter(|_| !transfer.is_done());
    last_refusal.map_or(Ok(()), Err)
}

/// The error of a failed replacement of settings.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReplaceError<E> {
    /// The robot refused a value, did not answer, or sent an answer that cannot be read; it has its old settings.
    #[error("{0}; nothing was saved, and the robot keeps its old settings")]
    Refused(ConsoleError<E>),
    /// Neither the new nor the old settings are completely in effect.
    #[error("{0}; nothing was saved; send `load` or `factory`, or press the board's reset button")]
    Mixed(ConsoleError<E>),
    /// The settings that the robot reports differ from those that were sent.
    #[error(
        "the robot did not accept all values; nothing was saved, and the robot keeps its old settings"
    )]
    Differs,
}

/// Sends new settings without saving them, and reads them back. If the robot refuses them or reports other values,
/// sends the old settings again.
///
/// # Errors
/// Fails if the robot refuses settings or reports other values, or if the connection breaks.
pub async fn replace_settings<C: Console>(
    console: &mut C,
    old: &Calibration,
    new: &Calibration,
) -> Result<(), ReplaceError<C::Error>> {
    let error = match send_and_compare(console, new).await {
        Ok(true) => return Ok(()),
        Ok(false) => ReplaceError::Differs,
        Err(error) => ReplaceError::Refused(error),
    };
    let restored = send_settings(console, old).await;
    restored.map_err(ReplaceError::Mixed)?;
    Err(error)
}

/// Sends settings and reads them back; returns true if the robot reports the same settings.
async fn send_and_compare<C: Console>(
    console: &mut C,
    calibration: &Calibration,
) -> crate::Result<bool, C> {
    send_settings(console, calibration).await?;
    Ok(read_settings(console).await?.is_equivalent_to(calibration))
}
