//! `lizard model`: writes a model of the robot for physics engines and ROS.

mod format;
mod long_foot;

use std::io::{self, Write};
use std::path::PathBuf;

use lizard_parts::{Assembly, Pieces, Scene, Trajectory};
use lizard_robot::Robot;

use crate::shared::files;
use crate::{Failure, RobotArgs};
use format::ModelFormat;
use long_foot::FootOffset;

/// Write a model for MuJoCo (.xml), ROS (.urdf) or Gazebo (.sdf): bodies, masses, joints, meshes
///
/// Each format has the shapes, masses and inertias of all parts, hinges and slides, and servos with
/// travel, torque and rate from `[servo]`. All joints are 0 at neutral.
///
/// A MuJoCo model is a single file, which also has a floor, motors, sensors, and constraints that
/// close the loops. With --drive, the firmware runs on the simulated UNO, and the file gets a keyframe
/// for each frame of its pulses, which `tools/physics/view.py` plays (docs/judges.md).
///
/// URDF and SDF refer to meshes, which are written to a folder beside the file, `robot-urdf-meshes`
/// for robot.urdf. SDF closes the loops with joints. URDF cannot: its legs follow the servos, its
/// couplers and sliders are free, and the frames `closing_..._1` and `closing_..._2` must coincide
/// (docs/models.md).
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard model out/robot.urdf
  lizard model out/robot.sdf --robot robots/large.toml
  lizard model urdf/robot.urdf --mesh-address package://my_robot/urdf/robot-urdf-meshes
  lizard model out/walk.xml --drive walk
  lizard model out/rocks.xml --drive walk --long-foot LF=0.6")]
pub struct Args {
    /// Output file: .xml, .urdf or .sdf; an existing file is replaced
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Address of the meshes' folder in the URDF or SDF, such as package://my_robot/meshes
    /// [default: relative to FILE]
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "ADDRESS")]
    mesh_address: Option<String>,
    /// Also write the servo angles of three cycles of this gait, from the firmware's pulses;
    /// only for MuJoCo
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "GAIT")]
    drive: Option<String>,
    /// The firmware for --drive, an ELF that contains this robot [default: the built-in firmware]
    #[arg(long, value_name = "FILE", requires = "drive")]
    elf: Option<PathBuf>,
    /// Lengthen the foot LF, RF, RH or LH by MM; a negative number shortens it
    #[arg(long, value_name = "LEG=MM")]
    long_foot: Vec<FootOffset>,
    #[command(flatten)]
    robot: RobotArgs,
}

/// Builds the model and writes it.
///
/// # Errors
/// Fails if robot.toml is invalid, if the robot cannot be built, if the file extension or the gait is unknown, if the
/// firmware is missing or contains another robot, or if a file cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let format = ModelFormat::from_path(&args.file)?;
    check_options(&args, format)?;
    let robot = args.robot.load()?;
    let assembly = Assembly::new(&robot);
    assembly.check_dimensions()?;
    let neutral = robot.lizard().solve(&robot.neutral_pose())?;
    let mut scene = Scene::for_assembly(&assembly);
    let foot_errors = long_foot::list_in_servo_order(&args.long_foot)?;
    for (excess, error) in scene.excess_lengths.iter_mut().zip(foot_errors) {
        *excess += error;
    }
    scene.trajectory = record_drive(&args, &robot)?;
    let pieces = Pieces::compute(&assembly, &scene)?;
    let stem = args.file.file_stem().unwrap_or_default();
    // The folder's name has the extension, because robot.urdf and robot.sdf may describe different robots.
    let extension = args.file.extension().unwrap_or_default();
    let [stem, extension] = [stem, extension].map(std::ffi::OsStr::to_string_lossy);
    let folder = format!("{stem}-{extension}-meshes");
    let address = args.mesh_address.as_ref().unwrap_or(&folder);
    let address = format!("{}/", address.trim_end_matches('/'));
    let text = match format {
        ModelFormat::Mjcf => pieces.format_mjcf(&neutral, &scene),
        ModelFormat::Urdf => pieces.format_urdf(&neutral, &scene, &address),
        ModelFormat::Sdf => pieces.format_sdf(&neutral, &scene, &address),
    };
    // The check comes before the meshes are written, because a later failure would leave meshes without a model.
    files::check_replaceable(&args.file)?;
    let mut summary_suffix = match &scene.trajectory {
        Some(trajectory) => {
            let frame_count = trajectory.frames.len();
            format!(", and {frame_count} frames of `{}`", trajectory.gait_name)
        }
        None => String::new(),
    };
    if format != ModelFormat::Mjcf {
        let meshes = pieces.make_meshes(&scene);
        let folder = args.file.with_file_name(folder);
        for mesh in &meshes {
            files::write(&folder.join(&mesh.path), &mesh.bytes)?;
        }
        summary_suffix = format!(", and {} meshes in {}", meshes.len(), folder.display());
    }
    files::write(&args.file, text.as_bytes())?;
    // A stream such as /dev/stdout must contain only the model, without the message.
    if files::is_standard_output(&args.file) || !args.file.is_file() {
        return Ok(());
    }
    let mut out = io::stdout().lock();
    writeln!(out, "{}: the robot{summary_suffix}", args.file.display())?;
    Ok(out.flush()?)
}

/// Refuses options that the format cannot use.
fn check_options(args: &Args, format: ModelFormat) -> Result<(), Failure> {
    let message = match (format, &args.drive, &args.mesh_address) {
        (ModelFormat::Mjcf, _, Some(_)) => {
            "--mesh-address requires .urdf or .sdf; a MuJoCo file contains the meshes"
        }
        (ModelFormat::Urdf | ModelFormat::Sdf, Some(_), _) => {
            "--drive requires a MuJoCo file (.xml); URDF and SDF have no keyframes"
        }
        _ => return Ok(()),
    };
    Err(Failure::Input(message.to_owned()))
}

/// Records the servo angles for `--drive`; `None` if this option is not given.
#[cfg(feature = "simulator")]
fn record_drive(args: &Args, robot: &Robot) -> Result<Option<Trajectory>, Failure> {
    let record = |gait: &str| {
        crate::simulate::trajectory::record(robot, &args.robot, gait, args.elf.as_deref())
    };
    args.drive.as_deref().map(record).transpose()
}

#[cfg(not(feature = "simulator"))]
fn record_drive(args: &Args, _: &Robot) -> Result<Option<Trajectory>, Failure> {
    match args.drive {
        None => Ok(None),
        Some(_) => Err(Failure::Input(
            "--drive is missing: this program was built without the simulator".to_owned(),
        )),
    }
}
