//! Detects the end of a movement by repeated `status` commands.

use std::time::Duration;

use lizard_robot::{STILL_FRAMES, Status};

use crate::console::{Console, ConsoleError, ReplyError, send_command};

/// Interval between two `status` commands.
const STATUS_INTERVAL: Duration = Duration::from_millis(50);
/// Largest number of `status` commands: a wait ends after five seconds plus the time that the answers take.
const MAX_STATUS_COUNT: u32 = 100;

/// Waits until the robot stands still or the time limit has passed. Returns its pose, degrees, and true if it was
/// reset: its frame count is then smaller than before. Updates `frame_count`, the count in the latest status.
///
/// # Errors
/// Fails if the robot does not answer, or if its answer cannot be read or has no pose.
pub(crate) async fn wait_until_still<C: Console>(
    console: &mut C,
    frame_count: &mut u64,
) -> crate::Result<([f64; 4], bool), C> {
    let mut was_reset = false;
    // The first frame that reported the current pose, and this pose.
    let mut still_since: Option<(u64, [f64; 4])> = None;
    for _ in 1..MAX_STATUS_COUNT {
        let (frames, pose) = read_pose(console).await?;
        was_reset |= frames < *frame_count;
        *frame_count = frames;
        match still_since {
            // After a reset, the frame count starts at 0 again.
            Some((first_frame, first_pose)) if first_pose == pose && frames >= first_frame => {
                if frames - first_frame >= STILL_FRAMES {
                    return Ok((pose, was_reset));
                }
            }
            _ => still_since = Some((frames, pose)),
        }
        let pause = console.pause(STATUS_INTERVAL).await;
        pause.map_err(ConsoleError::Link)?;
    }
    Ok((read_pose(console).await?.1, was_reset))
}

/// Reads the number of frames since the reset, and the pose, degrees, from the robot's status.
async fn read_pose<C: Console>(console: &mut C) -> crate::Result<(u64, [f64; 4]), C> {
    let reply = send_command(console, "status").await?;
    let status = Status::parse(&reply.answer);
    let state = status.and_then(|status| Some((status.frames, status.pose?)));
    state.ok_or_else(|| {
        let (line, answer) = ("status".to_owned(), reply.answer);
        ReplyError::UnknownFormat { line, answer }.into()
    })
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;
    use crate::console::Reply;

    /// A robot whose `status` answers have these frames and angles of A1; the last answer is repeated.
    struct ScriptedRobot(Vec<(u64, i32)>);

    impl Console for ScriptedRobot {
        type Error = Infallible;

        async fn ask(&mut self, _: &str) -> Result<Reply, Infallible> {
            let (frames, a1) = self.0[0];
            if self.0.len() > 1 {
                self.0.remove(0);
            }
            let answer = format!("ok gait=pose pose={a1}.00,0,0,0 margin=0.5 frames={frames}");
            let notes = Vec::new();
            Ok(Reply { notes, answer })
        }

        async fn pause(&mut self, _: Duration) -> Result<(), Infallible> {
            Ok(())
        }
    }

    #[test]
    fn a_robot_stands_still_once_its_pose_is_constant_for_long_enough_even_after_a_reset() {
        for (states, expected) in [
            (vec![(100, 1), (112, 1), (200, 2)], (1.0, false)),
            (
                vec![(100, 1), (111, 1), (114, 2), (127, 2), (300, 3)],
                (2.0, false),
            ),
            (
                vec![(900, 1), (3, 1), (14, 1), (14, 2), (26, 2), (90, 3)],
                (2.0, true),
            ),
            // The frame count stops, so the wait ends at the time limit.
            (vec![(100, 1), (105, 1)], (1.0, false)),
        ] {
            let mut robot = ScriptedRobot(states);
            let result = pollster::block_on(wait_until_still(&mut robot, &mut 0));
            let result = result.map(|([a1, ..], was_reset)| (a1, was_reset));
            assert_eq!(result, Ok(expected));
        }
    }
}
