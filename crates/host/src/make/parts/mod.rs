//! `lizard parts`: everything that is needed to build the robot, as files.

pub mod fit;

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use lizard_parts::{Assembly, Bill, BuildProblem, File, coupon, documents, part_files};
use lizard_robot::{Body, Robot};
use serde::Serialize;

use crate::shared::files;
use crate::shared::progress::progress_bar;
use crate::{Failure, RobotFile};

/// Make the parts of the robot: files to print and to cut, what to buy, how to build it
///
/// Writes into DIR: step/ (solids for a drawing program), stl/ (lying as they are
/// printed), cut/ (DXF and SVG, 1:1 in mm, of the parts that can be cut from a sheet),
/// guide/ (how to build the robot, as HTML and Markdown; placements.json says where each
/// part is) and bill.json (what to print and to buy). Links, servos, screws and fits come
/// from robot.toml. A robot whose parts would meet is refused.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard parts out/parts
  lizard parts out/large --robot robots/large.toml
  lizard parts out/fit --coupon
  lizard parts out/corner --corner

Print the coupon first: the first column into which everything goes by hand is the `fit`
of your printer, and belongs under [parts] in robot.toml. Then print one corner: a seat
for A1, its link, leg, strut and foot.")]
pub struct Args {
    /// Folder for the files; it is created if it does not exist
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Make only the fit coupon
    #[arg(long)]
    coupon: bool,
    /// Make only one corner, to try before you print everything
    #[arg(long, conflicts_with = "coupon")]
    corner: bool,
    /// Print the list of parts as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotFile,
}

/// A part as `--json` prints it.
#[derive(Serialize)]
struct PartEntry {
    part: String,
    count: usize,
    /// The part that this one may replace; null for a part of the standard robot.
    instead_of: Option<String>,
    /// The bodies that this part is made for, by their names in the assembly.
    bodies: Vec<String>,
    /// The volume of one piece, mm^3.
    volume: f64,
    files: Vec<String>,
}

impl From<BuildProblem> for Failure {
    fn from(problem: BuildProblem) -> Self {
        Self::Impossible(problem.to_string())
    }
}

/// Makes all files and writes them.
///
/// # Errors
/// Fails for an invalid robot.toml, parts that do not fit, or a file that cannot be written.
/// Writes nothing before all files are made.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let kerf = robot.parts().kerf;
    let assembly = Assembly::new(&robot);
    let is_whole_robot = !args.coupon && !args.corner;
    let mut parts = Vec::new();
    if !args.corner {
        parts.extend(coupon(robot.parts()));
    }
    if !args.coupon {
        assembly.check_dimensions()?;
        fit::prove(&assembly).judge().map_err(BuildProblem::from)?;
        parts.extend(match args.corner {
            true => assembly.corner_parts(),
            false => assembly.parts(),
        });
    }
    let bar = progress_bar(parts.len(), "{wide_bar} {pos}/{len} {msg}");
    let mut files = Vec::new();
    let mut entries = Vec::new();
    for part in &parts {
        bar.set_message(part.name.clone());
        let new_files = part_files(part, kerf)?;
        entries.push(PartEntry {
            part: part.name.clone(),
            count: part.count(),
            instead_of: part.instead_of.clone(),
            bodies: part.body_names.clone(),
            volume: part.volume(),
            files: new_files.iter().map(|file| file.path.clone()).collect(),
        });
        files.extend(new_files);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let mut weight_text = None;
    if is_whole_robot {
        let pose = robot.lizard().solve(&robot.neutral_pose())?;
        let bill = Bill::of(&assembly, &assembly.parts(), &pose);
        files.extend(documents(&assembly, &bill, &pose)?);
        weight_text = bill
            .differs_from(&robot.ground().body)
            .then(|| weight_note(&bill, &robot));
    }
    write_files(&args.folder, &files)?;
    let mut out = io::stdout().lock();
    if args.json {
        serde_json::to_writer_pretty(&mut out, &entries)?;
        writeln!(out)?;
    } else {
        let needed_entries = entries.iter().filter(|part| part.instead_of.is_none());
        let piece_count: usize = needed_entries.map(|part| part.count).sum();
        writeln!(
            out,
            "{} parts, {piece_count} pieces, {} files in {}",
            entries.len(),
            files.len(),
            args.folder.display()
        )?;
        if let Some(weight_text) = weight_text {
            write!(out, "\n{weight_text}")?;
        }
    }
    Ok(out.flush()?)
}

/// The note that robot.toml gives a mass or a mass centre that differs from that of the parts.
fn weight_note(bill: &Bill, robot: &Robot) -> String {
    let Body {
        mass,
        mass_centre: centre,
    } = robot.ground().body;
    format!(
        "The parts weigh {:.0} g, and their mass centre is {} the middle of the plate; robot.toml has {mass} g and \
         {centre:?} mm. For predictions with these parts, put into robot.toml:\n\n{}",
        bill.grams,
        bill.centre_in_words(),
        bill.body_toml()
    )
}

/// Writes all files below `folder`.
fn write_files(folder: &Path, files: &[File]) -> Result<(), Failure> {
    for file in files {
        let path = folder.join(&file.path);
        files::write(&path, &file.bytes)?;
    }
    Ok(())
}
