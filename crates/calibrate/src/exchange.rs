//! Reading of a robot's settings, and replacing them as a whole.

use lizard_robot::{Calibration, Transfer};

use crate::console::{BadReply, Console, ConsoleError, command};

/// Reads a robot's settings.
///
/// # Errors
/// Fails if there is no answer, or one that is not understood.
pub async fn read<C: Console>(console: &mut C) -> Result<Calibration, ConsoleError<C::Error>> {
    let reply = command(console, "cal").await?;
    Calibration::from_cal_answer(&reply.notes).ok_or_else(|| {
        let (line, answer) = ("cal".to_owned(), reply.notes.join(" / "));
        BadReply::Unclear { line, answer }.into()
    })
}

/// Sends settings, unsaved, in the order of a [`Transfer`].
///
/// # Errors
/// Fails if the connection breaks, or if lines are still refused in the last round: returns the first refusal of
/// that round. The robot then has a part of the settings.
pub async fn send<C: Console>(
    console: &mut C,
    calibration: &Calibration,
) -> Result<(), ConsoleError<C::Error>> {
    let mut transfer = Transfer::new(calibration);
    let mut refusal = None;
    while let Some(line) = transfer.next_line() {
        match command(console, &line).await {
            Ok(_) => {}
            Err(error) if error.is_refusal() => {
                if transfer.record_refusal() {
                    refusal = Some(error);
                }
            }
            Err(error) => return Err(error),
        }
    }
    let remaining = refusal.filter(|_| !transfer.is_done());
    remaining.map_or(Ok(()), Err)
}

/// The reason why a robot did not accept settings.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SendError<E> {
    /// The robot refused a value.
    #[error("{0}; nothing was saved, and the robot keeps its old settings")]
    Refused(ConsoleError<E>),
    /// Neither the new nor the old settings are in effect as a whole.
    #[error("{0}; nothing was saved; send `load` or `factory`, or press the board's reset button")]
    Mixed(ConsoleError<E>),
    /// The settings that the robot reports differ from those that were sent.
    #[error("the robot did not accept all of it; nothing was saved, and it keeps its old settings")]
    Differs,
}

/// Replaces a robot's settings `before` by others, unsaved, and reads them back; if that fails, sends the old ones.
///
/// # Errors
/// Fails if the robot refuses settings or reports other ones, or if the connection breaks.
pub async fn replace<C: Console>(
    console: &mut C,
    before: &Calibration,
    calibration: &Calibration,
) -> Result<(), SendError<C::Error>> {
    let error = match exchange(console, calibration).await {
        Ok(true) => return Ok(()),
        Ok(false) => SendError::Differs,
        Err(error) => SendError::Refused(error),
    };
    send(console, before).await.map_err(SendError::Mixed)?;
    Err(error)
}

/// Sends settings and reads them back; returns true if they are the same.
async fn exchange<C: Console>(
    console: &mut C,
    calibration: &Calibration,
) -> Result<bool, ConsoleError<C::Error>> {
    send(console, calibration).await?;
    Ok(read(console).await?.is_equivalent_to(calibration))
}
