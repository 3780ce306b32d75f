//! `lizard parts`: writes the files for building the robot.

pub mod fit;

use std::io::{self, Write};
use std::path::PathBuf;

use lizard_parts::{Assembly, Bill, BuildError, build_coupon, make_documents, make_part_files};
use lizard_robot::Robot;
use serde::Serialize;

use crate::shared::files;
use crate::shared::progress::create_progress_bar;
use crate::{Failure, RobotArgs};

/// Write the robot's part files for printing and cutting, its bill of materials and its guide
///
/// Writes to DIR: step/ (solids for CAD programs), stl/ (parts in their printing
/// orientation), cut/ (DXF and SVG, 1:1 in mm, of the parts that can be cut from a sheet),
/// guide/ (the building guide as HTML and Markdown; placements.json has each part's
/// placement) and bill.json (the bill of materials). Links, servos, screws and fits come
/// from robot.toml. A robot whose parts would collide is refused.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard parts out/parts
  lizard parts out/large --robot robots/large.toml
  lizard parts out/fit --coupon
  lizard parts out/corner --corner

Print the coupon first: the first column into which you can push every part by hand has
the `fit` of your printer; enter it under [parts] in robot.toml. Then print one corner: a
seat for A1, its link, leg, strut and foot.")]
pub struct Args {
    /// Output folder; it is created if it does not exist
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
    robot: RobotArgs,
}

/// A part in the `--json` output; the field names are the JSON keys.
#[derive(Serialize)]
struct PartEntry {
    part: String,
    count: usize,
    /// The part that this part may replace; null for a part of the standard robot.
    instead_of: Option<String>,
    /// Names of the part's bodies in the assembly.
    bodies: Vec<String>,
    /// The volume of one piece, mm^3.
    volume: f64,
    files: Vec<String>,
}

impl From<BuildError> for Failure {
    fn from(error: BuildError) -> Self {
        Self::Operation(error.to_string())
    }
}

/// Builds all files and writes them.
///
/// # Errors
/// Fails if robot.toml is invalid, if parts would collide, or if a file cannot be written. Writes nothing before all
/// files are built.
pub fn run(args: Args) -> Result<(), Failure> {
    files::check_folder(&args.folder)?;
    let robot = args.robot.load()?;
    let kerf = robot.parts().kerf;
    let assembly = Assembly::new(&robot);
    let mut parts = Vec::new();
    if !args.corner {
        parts.extend(build_coupon(robot.parts()));
    }
    if !args.coupon {
        assembly.check_dimensions()?;
        fit::prove(&assembly).check().map_err(BuildError::from)?;
        parts.extend(match args.corner {
            true => assembly.collect_corner_parts(),
            false => assembly.collect_parts(),
        });
    }
    let progress_bar = create_progress_bar(parts.len(), "{wide_bar} {pos}/{len} {msg}");
    let mut files = Vec::new();
    let mut entries = Vec::new();
    for part in &parts {
        progress_bar.set_message(part.name.clone());
        let new_files = make_part_files(part, kerf)?;
        entries.push(PartEntry {
            part: part.name.clone(),
            count: part.count(),
            instead_of: part.replaces.clone(),
            bodies: part.body_names.clone(),
            volume: part.volume(),
            files: new_files.iter().map(|file| file.path.clone()).collect(),
        });
        files.extend(new_files);
        progress_bar.inc(1);
    }
    progress_bar.finish_and_clear();
    let mut weight_note = None;
    if !args.coupon && !args.corner {
        let pose = robot.lizard().solve(&robot.neutral_pose())?;
        let bill = Bill::compute(&assembly, &assembly.collect_parts(), &pose);
        files.extend(make_documents(&assembly, &bill, &pose)?);
        let differs = bill.differs_from(&robot.ground().body);
        weight_note = differs.then(|| format_weight_note(&bill, &robot));
    }
    for file in &files {
        files::write(&args.folder.join(&file.path), &file.bytes)?;
    }
    let mut out = io::stdout().lock();
    if args.json {
        serde_json::to_writer_pretty(&mut out, &entries)?;
        writeln!(out)?;
    } else {
        let needed_entries = entries.iter().filter(|entry| entry.instead_of.is_none());
        let piece_count: usize = needed_entries.map(|entry| entry.count).sum();
        writeln!(
            out,
            "{} parts, {piece_count} pieces, {} files in {}",
            entries.len(),
            files.len(),
            args.folder.display()
        )?;
        if let Some(weight_note) = weight_note {
            write!(out, "\n{weight_note}")?;
        }
    }
    Ok(out.flush()?)
}

/// Formats a note that robot.toml has another mass or centre of mass than the parts.
fn format_weight_note(bill: &Bill, robot: &Robot) -> String {
    let body = &robot.ground().body;
    let (mass, centre) = (body.mass, body.centre_of_mass);
    format!(
        "The parts weigh {:.0} g, and their centre of mass is {}; robot.toml has {mass} g and \
         {centre:?} mm. For predictions with these parts, change robot.toml to:\n\n{}",
        bill.grams,
        bill.describe_centre(),
        bill.format_body_toml()
    )
}
