//! `lizard console replay`: prints, summarises and draws a recorded session.

mod session;
mod summary;

use std::io::{self, Write};
use std::path::PathBuf;

use crate::simulate::sim::analysis::Run;
use crate::simulate::sim::dialogue::DialoguePrinter;
use crate::simulate::sim::session::{DialogueLine, Sender};
use crate::simulate::sim::timeline::{self, Caption};
use crate::{Failure, RobotArgs};

use super::recorder::Event;
use session::RecordedSession;

/// Draw a session that `lizard console --record` has recorded
///
/// Prints the dialogue and a summary, and draws servo angles and footfalls over
/// time, at most of the first 24 hours.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The recorded session
    file: PathBuf,
    /// Output file for the picture
    #[arg(long, value_name = "FILE", default_value = "out/lizard-replay.svg")]
    svg: PathBuf,
    #[command(flatten)]
    robot: RobotArgs,
}

const CAPTION: Caption = Caption {
    title: "Servo angles and footfalls of a session",
    note: "degrees in the chassis frame, as the robot reported them; dashed: the neutral angle",
    axis_label: "time since the session began (s)",
};

/// Runs `lizard console replay`.
///
/// # Errors
/// Fails if robot.toml is invalid, the file is not a session, or the picture cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let name = args.file.display();
    let text = crate::shared::files::read_text(&args.file)?;
    let session = RecordedSession::parse(&text)
        .map_err(|error| Failure::Input(format!("{name}: {error}")))?;

    let mut out = io::stdout().lock();
    let mut printer = DialoguePrinter::new(true);
    for entry in &session.entries {
        let (from, text) = match &entry.event {
            Event::Sent(line) => (Sender::User, line.clone()),
            Event::Answer(line) | Event::Note(line) => (Sender::Robot, line.clone()),
            Event::Gone => (Sender::Robot, "(the port disappeared)".to_owned()),
            Event::Begin { .. } | Event::Status(_) | Event::Pose { .. } => continue,
        };
        let ms = entry.ms as f64;
        printer.print(&DialogueLine { ms, from, text }, &mut out)?;
    }
    writeln!(out)?;
    summary::print(&session, &mut out)?;

    let hash_text = format!(" {:08x},", robot.firmware().hash());
    let banner = session.banner();
    if banner.is_some_and(|banner| !banner.contains(&hash_text)) {
        writeln!(
            out,
            "picture     the session's robot differs from robot.toml: the angles are correct, but \
             the footfalls may be wrong"
        )?;
    }
    let log = session.build_frame_log(&robot);
    let run = Run::new(&robot, &log);
    let picture = timeline::draw(run, &session.compute_spans(), &CAPTION);
    crate::shared::files::write(&args.svg, picture.as_bytes())?;
    writeln!(out, "picture     {}", args.svg.display())?;
    Ok(())
}
