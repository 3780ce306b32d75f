//! `lizard solve`: the forward solution of everything, by Algorithm 1.

use std::io::{self, BufWriter, IsTerminal, Write};

use lizard_kinematics::Pose;
use lizard_robot::Robot;
use rayon::prelude::*;

use crate::paper::poses::Poses;
use crate::paper::record::{self, Record};
use crate::{Failure, PoseArgs, RobotFile};

/// Poses that are solved together; memory is bounded by it.
const BATCH: usize = 8192;

/// Where every joint is, for one pose or a stream of them.
///
/// Give one pose with the four flags, or many as CSV on standard input with the
/// header theta1,theta4,theta5,theta8 (degrees, chassis frame, any order). A
/// pose that is singular or cannot be reached gets its reason; a malformed line
/// ends the run with its line and column and exit code 2.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lizard solve --theta1 138.59 --theta4 41.41 --theta5 221.41 --theta8 318.59
  lizard solve --json < poses.csv > solutions.jsonl")]
pub struct Args {
    #[command(flatten)]
    pose: PoseArgs,
    /// One JSON object a line
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// Solves what was asked for.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let mut out = BufWriter::new(io::stdout().lock());
    match args.pose.get() {
        Some(pose) => out.write_all(&one(&robot, &pose, args.json)?)?,
        None if io::stdin().is_terminal() => {
            return Err(Failure::Input(
                "give a pose with --theta1 --theta4 --theta5 --theta8, or poses as CSV on standard input"
                    .to_string(),
            ));
        }
        None => stream(&robot, args.json, &mut out)?,
    }
    Ok(out.flush()?)
}

/// One pose, as a page or an object.
fn one(robot: &Robot, pose: &Pose, json: bool) -> Result<Vec<u8>, Failure> {
    let solved = robot.lizard.solve(pose);
    if !json {
        return Ok(record::page(pose, &solved, &robot.limits).into_bytes());
    }
    let mut line = serde_json::to_vec(&Record::new(&solved, &robot.limits))?;
    line.push(b'\n');
    Ok(line)
}

/// Solves batches on all cores and writes them in order. Poses before a
/// malformed line are still answered, each in a whole line.
fn stream(robot: &Robot, json: bool, out: &mut impl Write) -> Result<(), Failure> {
    let mut poses = Poses::new(io::stdin().lock())?;
    if !json {
        writeln!(out, "{}", record::HEADING)?;
    }
    let mut batch = Vec::with_capacity(BATCH);
    loop {
        batch.clear();
        let mut fault = None;
        for pose in poses.by_ref().take(BATCH) {
            match pose {
                Ok(pose) => batch.push(pose),
                Err(failure) => {
                    fault = Some(failure);
                    break;
                }
            }
        }
        let blocks: Vec<_> = batch
            .par_chunks(BATCH / 16)
            .map(|poses| lines(robot, poses, json))
            .collect();
        for block in blocks {
            out.write_all(&block?)?;
        }
        match fault {
            Some(failure) => {
                out.flush()?;
                return Err(failure);
            }
            None if batch.len() < BATCH => return Ok(()),
            None => {}
        }
    }
}

fn lines(robot: &Robot, poses: &[Pose], json: bool) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::with_capacity(poses.len() * if json { 1024 } else { 192 });
    for pose in poses {
        let solved = robot.lizard.solve(pose);
        if json {
            serde_json::to_writer(&mut text, &Record::new(&solved, &robot.limits))?;
        } else {
            text.extend_from_slice(record::row(pose, &solved, &robot.limits).as_bytes());
        }
        text.push(b'\n');
    }
    Ok(text)
}
