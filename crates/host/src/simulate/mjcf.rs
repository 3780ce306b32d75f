//! `lizard mjcf`: the robot as a model for MuJoCo, a physics engine that others wrote.

use std::io::{self, Write};
use std::path::PathBuf;
use std::str::FromStr;

use lizard_parts::{Assembly, Course, Scene, mjcf};
use lizard_robot::servo::LEGS;
use lizard_robot::{CheckedGait, Robot};
use lizard_twin::FRAME;
use simulated_uno::{CYCLES_PER_US, Fidelity, Uno};

use crate::shared::{files, firmware};
use crate::simulate::sim::frame_log::FrameLog;
use crate::simulate::twin;
use crate::{Failure, RobotFile};

/// The largest length error of a foot, mm; beyond it, its screw or its leaf ends.
const MAX_FOOT_ERROR_MM: f64 = 5.0;

/// Write the robot for MuJoCo, a physics engine: bodies, masses, joints, feet, servos
///
/// The file holds everything: the shapes of all parts, their masses and inertias, hinges
/// and slides, the loops that they close, the springs of struts and feet, a floor, and
/// servos with the torque, the rate and the rotor of `[servo]`. With --drive the firmware runs on the
/// simulated UNO, and the file gets a keyframe for each frame of its pulses. The program
/// `tools/physics/view.py` plays them in MuJoCo's window (docs/judges.md).
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard mjcf out/lizard.xml
  lizard mjcf out/walk.xml --drive walk
  lizard mjcf out/rocks.xml --drive walk --long-foot LF=0.6
  lizard mjcf out/large.xml --robot robots/large.toml")]
pub struct Args {
    /// The file to write; an existing file is replaced
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Also write the servo angles of three cycles of this gait, from the firmware's
    /// pulses
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "GAIT")]
    drive: Option<String>,
    /// The firmware for --drive: an ELF that has this robot in it [default: the one inside this
    /// program]
    #[arg(long, value_name = "FILE", requires = "drive")]
    elf: Option<PathBuf>,
    /// Make the foot LF, RF, RH or LH longer by this many mm; a negative number makes it
    /// shorter
    #[arg(long, value_name = "LEG=MM")]
    long_foot: Vec<LongFoot>,
    #[command(flatten)]
    robot: RobotFile,
}

/// A foot that is not as long as it should be.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LongFoot {
    leg: usize,
    mm: f64,
}

/// The reason why `--long-foot` is refused.
#[derive(Debug, thiserror::Error)]
enum LongFootError {
    #[error("write the leg and by how many mm its foot is too long, such as LF=0.6")]
    Form,
    #[error("there is no leg `{0}`; the legs are LF, RF, RH and LH")]
    Leg(String),
    #[error("`{0}` is not a number of mm")]
    Number(String),
    #[error("a foot may be off by at most {MAX_FOOT_ERROR_MM} mm either way, and {0} mm is more")]
    Far(f64),
}

impl FromStr for LongFoot {
    type Err = LongFootError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (leg, mm) = text.split_once('=').ok_or(LongFootError::Form)?;
        let leg_index = LEGS.iter().position(|name| name.eq_ignore_ascii_case(leg));
        let leg = leg_index.ok_or_else(|| LongFootError::Leg(leg.to_owned()))?;
        let number = mm.parse().ok().filter(|mm: &f64| mm.is_finite());
        let mm = number.ok_or_else(|| LongFootError::Number(mm.to_owned()))?;
        match mm.abs() <= MAX_FOOT_ERROR_MM {
            true => Ok(Self { leg, mm }),
            false => Err(LongFootError::Far(mm)),
        }
    }
}

/// Makes the model and writes it.
///
/// # Errors
/// Fails for a wrong robot.toml, a robot that cannot be built, no such gait, no firmware or another
/// robot's, a file that cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let assembly = Assembly::new(&robot);
    assembly.measures_fit()?;
    let neutral = robot.lizard().solve(&robot.neutral())?;
    let mut scene = Scene::of(&assembly);
    for (long, more) in scene.long.iter_mut().zip(lengths(&args.long_foot)?) {
        *long += more;
    }
    if let Some(name) = &args.drive {
        let gait = twin::moving_gait(&robot, name)?;
        scene.course = Some(course(&args, &robot, gait)?);
    }
    let text = mjcf(&assembly, &neutral, &scene)?;
    files::write(&args.file, text.as_bytes())?;
    // Where the file is a stream, such as /dev/stdout, it alone is to be in it.
    if !args.file.is_file() {
        return Ok(());
    }
    let mut out = io::stdout().lock();
    match &scene.course {
        Some(course) => writeln!(
            out,
            "{}: the robot, and {} frames of `{}`",
            args.file.display(),
            course.frames.len(),
            course.gait
        )?,
        None => writeln!(out, "{}: the robot", args.file.display())?,
    }
    Ok(out.flush()?)
}

/// The length error of each foot, mm, servo order.
fn lengths(given: &[LongFoot]) -> Result<[f64; 4], Failure> {
    let mut long = [None; 4];
    for LongFoot { leg, mm } in given {
        if long[*leg].replace(*mm).is_some() {
            let leg = LEGS[*leg];
            return Err(Failure::Input(format!("--long-foot {leg} is given twice")));
        }
    }
    Ok(long.map(Option::unwrap_or_default))
}

/// Three cycles of a gait by the firmware on the simulated UNO.
fn course(args: &Args, robot: &Robot, gait: &CheckedGait) -> Result<Course, Failure> {
    let image = firmware::of_robot(args.elf.as_deref(), &args.robot, robot)?.image;
    let mut uno = Uno::with_image(image, Fidelity::DataSheet);
    let script = twin::walk_script(robot, &[gait.name()]);
    let recording = twin::record(&mut uno, robot, &script)?;
    let log = &recording.frames;
    let stop = script.steps.last().map_or(script.end_ms, |step| step.ms);
    let end = log.index(stop as f64 / 1000.0) as f64 * FRAME;
    Ok(Course {
        gait: gait.name().to_owned(),
        frames: targets(robot, log),
        begin: end - gait.period(),
        period: gait.period(),
        count: 1,
    })
}

/// The servos' targets from their pulses: sweeps from neutral, deg. A servo without a pulse
/// keeps its previous target.
fn targets(robot: &Robot, log: &FrameLog) -> Vec<[f64; 4]> {
    let mut angles = [0.0; 4];
    let frames = log.widths.iter().map(|widths| {
        for (servo, width) in widths.iter().enumerate() {
            if *width > 0 {
                let us = f64::from(*width) / CYCLES_PER_US as f64;
                angles[servo] = robot.servos()[servo].sweep(us);
            }
        }
        angles
    });
    frames.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_foot_is_a_leg_and_its_mm() {
        let read = |text: &str| text.parse::<LongFoot>().expect(text);
        assert_eq!(read("LF=0.6"), LongFoot { leg: 0, mm: 0.6 });
        assert_eq!(read("rh=-5"), LongFoot { leg: 2, mm: -5.0 });
    }

    #[test]
    fn an_invalid_long_foot_is_refused_with_a_message() {
        let refused = |text: &str| text.parse::<LongFoot>().expect_err(text).to_string();
        assert_eq!(
            refused("0.6"),
            "write the leg and by how many mm its foot is too long, such as LF=0.6"
        );
        assert_eq!(
            refused("FL=1"),
            "there is no leg `FL`; the legs are LF, RF, RH and LH"
        );
        assert_eq!(refused("LF="), "`` is not a number of mm");
        assert_eq!(refused("LF=nan"), "`nan` is not a number of mm");
        assert_eq!(
            refused("LF=6"),
            "a foot may be off by at most 5 mm either way, and 6 mm is more"
        );
    }

    #[test]
    fn a_foot_has_one_length() {
        let foot = |leg, mm| LongFoot { leg, mm };
        let all = lengths(&[foot(3, 0.5), foot(1, -1.0)]).expect("two feet");
        assert_eq!(all, [0.0, -1.0, 0.0, 0.5]);
        let twice = lengths(&[foot(0, 0.0), foot(0, 1.0)]).expect_err("one foot");
        assert_eq!(twice.to_string(), "--long-foot LF is given twice");
    }

    #[test]
    fn a_servo_without_a_pulse_is_asked_for_what_it_was_asked_before() {
        let robot = crate::shared::robot_file::named("unequal");
        let log = FrameLog {
            widths: vec![
                [0; 4],
                [1470 * 16, 1535 * 16, 0, 0],
                [1562 * 16, 0, 1500 * 16, 0],
            ],
            ..FrameLog::default()
        };
        let found = targets(&robot, &log);
        assert_eq!(found[0], [0.0; 4]);
        assert_eq!(found[1], [0.0; 4]);
        assert!(
            (found[2][0] - 10.0).abs() < 1e-9,
            "92 us are 10 deg: {found:?}"
        );
        assert_eq!(found[2][1..], [0.0; 3]);
    }
}
