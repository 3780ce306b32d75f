//! The end of a motion, as `status` shows it.

use std::time::Duration;

use lizard_robot::{STILL_FRAMES, Status};

use crate::console::{Console, ConsoleError, command};

/// Interval between two `status` commands.
const INTERVAL: Duration = Duration::from_millis(50);
/// The longest wait is five seconds, and the time of the answers.
const MAX_ANSWERS: u32 = 100;

/// Waits until the robot stands still, but not for ever, and returns its pose, degrees.
///
/// # Errors
/// Fails if the robot does not answer, or has no pose.
pub(crate) async fn wait_until_still<C: Console>(
    console: &mut C,
) -> Result<[f64; 4], ConsoleError<C::Error>> {
    // The first frame of the pose that is shown now.
    let mut since: Option<(u64, [f64; 4])> = None;
    for _ in 1..MAX_ANSWERS {
        let (frames, pose) = ask_pose(console).await?;
        match since {
            // After a restart, frames are counted from the beginning.
            Some((first, before)) if before == pose && frames >= first => {
                if frames - first >= STILL_FRAMES {
                    return Ok(pose);
                }
            }
            _ => since = Some((frames, pose)),
        }
        console.pause(INTERVAL).await.map_err(ConsoleError::Link)?;
    }
    Ok(ask_pose(console).await?.1)
}

/// The frames since power-on, and the pose.
async fn ask_pose<C: Console>(console: &mut C) -> Result<(u64, [f64; 4]), ConsoleError<C::Error>> {
    let reply = command(console, "status").await?;
    let status = Status::parse(&reply.answer);
    let state = status.and_then(|status| Some((status.frames, status.pose?)));
    state.ok_or(ConsoleError::Unclear {
        line: "status".to_owned(),
        answer: reply.answer,
    })
}
