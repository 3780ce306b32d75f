//! `lizard pose`: solves the whole robot forward with the paper's Algorithm 1.

use std::io::{self, BufRead, IsTerminal, Write};
use std::panic::resume_unwind;
use std::sync::mpsc;
use std::thread;

use lizard_kinematics::Pose;
use lizard_robot::Robot;
use rayon::prelude::*;

use crate::Failure;
use crate::paper::pose_output::{self, PoseLine};
use crate::paper::poses::{PoseReader, TimedPose};

/// Number of poses that are solved together, which limits memory use.
const BATCH_SIZE: usize = 8192;

/// Number of poses whose lines are formatted by one task, as a block.
const BLOCK_SIZE: usize = BATCH_SIZE / 16;

/// Number of blocks that may wait to be written.
const MAX_WAITING_BLOCKS: usize = 32;

/// Solves a pose and prints it. Without a pose, solves the poses from standard input.
///
/// # Errors
/// Fails if no pose is given and standard input is a terminal, if a line of the stream is invalid, or if the output
/// cannot be written.
pub fn print(robot: &Robot, pose: Option<&Pose>, is_json: bool) -> Result<(), Failure> {
    match pose {
        Some(pose) => Ok(io::stdout().write_all(&solve_pose(robot, pose, is_json)?)?),
        None if io::stdin().is_terminal() => Err(Failure::Input(
            "a pose is required: give --theta1, --theta4, --theta8 and --theta5, or poses as CSV on standard input"
                .to_string(),
        )),
        None => solve_stream(robot, is_json),
    }
}

/// Solves one pose and returns the output, as a page of text or a JSON object.
fn solve_pose(robot: &Robot, pose: &Pose, is_json: bool) -> Result<Vec<u8>, Failure> {
    let outcome = robot.lizard().solve(pose);
    if !is_json {
        return Ok(pose_output::format_page(robot, pose, &outcome).into_bytes());
    }
    let mut line = serde_json::to_vec(&PoseLine::new(robot, None, &outcome))?;
    line.push(b'\n');
    Ok(line)
}

/// Solves the poses from standard input in batches on all cores and writes them in order. One batch is written while
/// the next batch is solved. The poses before a malformed line are still solved and written.
fn solve_stream(robot: &Robot, is_json: bool) -> Result<(), Failure> {
    let mut poses = PoseReader::new(io::stdin().lock())?;
    let (sender, receiver) = mpsc::sync_channel::<Vec<u8>>(MAX_WAITING_BLOCKS);
    thread::scope(|scope| {
        let heading = (!is_json).then(|| pose_output::format_heading(poses.has_time()));
        let writer = scope.spawn(move || write_blocks(receiver, heading));
        let outcome = solve_all(robot, is_json, &mut poses, &sender);
        drop(sender);
        // A failure to write takes precedence over a failure to read.
        writer.join().unwrap_or_else(|panic| resume_unwind(panic))?;
        outcome
    })
}

/// Writes blocks until the channel is closed.
fn write_blocks(blocks: mpsc::Receiver<Vec<u8>>, heading: Option<String>) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    if let Some(heading) = heading {
        writeln!(out, "{heading}")?;
    }
    for block in blocks {
        out.write_all(&block)?;
    }
    Ok(out.flush()?)
}

/// Solves batch after batch and sends their lines to the writer. Ends early without an error if the writer has
/// stopped; the writer reports the reason.
fn solve_all(
    robot: &Robot,
    is_json: bool,
    poses: &mut PoseReader<impl BufRead>,
    sender: &mpsc::SyncSender<Vec<u8>>,
) -> Result<(), Failure> {
    let mut batch = Vec::with_capacity(BATCH_SIZE);
    loop {
        batch.clear();
        let mut read_failure = None;
        for pose in poses.by_ref().take(BATCH_SIZE) {
            match pose {
                Ok(pose) => batch.push(pose),
                Err(failure) => {
                    read_failure = Some(failure);
                    break;
                }
            }
        }
        let is_last = batch.len() < BATCH_SIZE;
        let blocks: Vec<_> = batch
            .par_chunks(BLOCK_SIZE)
            .map(|poses| format_lines(robot, poses, is_json))
            .collect();
        for block in blocks {
            if sender.send(block?).is_err() {
                return Ok(());
            }
        }
        match read_failure {
            Some(failure) => return Err(failure),
            None if is_last => return Ok(()),
            None => {}
        }
    }
}

/// Solves poses and returns their lines, as rows of the table or as JSON.
fn format_lines(robot: &Robot, poses: &[TimedPose], is_json: bool) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::with_capacity(poses.len() * if is_json { 1024 } else { 192 });
    for timed_pose in poses {
        let outcome = robot.lizard().solve(&timed_pose.pose);
        if is_json {
            serde_json::to_writer(
                &mut text,
                &PoseLine::new(robot, timed_pose.seconds, &outcome),
            )?;
        } else {
            text.extend_from_slice(pose_output::format_row(robot, timed_pose, &outcome).as_bytes());
        }
        text.push(b'\n');
    }
    Ok(text)
}
