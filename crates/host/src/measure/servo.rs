//! `lizard measure servo`: measures the travel, rate and torque of a servo in a jig.

use std::fmt::{Display, Write as _};
use std::path::{Path, PathBuf};

use lizard_film::{AnalysedFilm, Figure, Jig, MeasuredServo};
use lizard_measure::NamedFilm;
use lizard_robot::servo::SERVO_NAMES;
use lizard_robot::{GRAVITY, Robot, edit};
use serde::Serialize;

use super::figures::{self, MeasuredKey};
use super::film::film_failure;
use super::filming::{Filming, parse_height, parse_number};
use super::steps::{self, parse_servo};
use crate::shared::progress::Spinner;
use crate::shared::{files, json};
use crate::{Failure, RobotFile};

/// The torque of 1 kg cm in N mm.
const N_MM_PER_KG_CM: f64 = 10.0 * GRAVITY;

/// Measure in a film how far and how fast a servo turns, for robot.toml
///
/// FILM shows the sheet's card on the servo's horn, between the two strips, while `lizard measure steps` turns it.
/// Prints the figures of [servo] in robot.toml with their standard errors, the file's own beside them, and the lines
/// to write. The stall torque needs a second film, in which the servo winds a thread with a weight on a drum.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard measure steps --servo A1 --robot jig.toml | lizard console
  lizard measure servo film.mp4 --servo A1 --height 42 --robot jig.toml
  lizard measure servo film.mp4 --servo A1 --height 42 --robot jig.toml \\
      --load loaded.mp4 --grams 100 --arm 20 --output measured.toml")]
pub struct ServoArgs {
    /// A folder of pictures (PNG or JPEG), or a film
    film: PathBuf,
    /// The servo: A1, A2, A3 or A4
    #[arg(long, value_name = "NAME", value_parser = parse_servo)]
    servo: usize,
    /// Height of the card above the strips, mm
    #[arg(long, value_name = "MM", value_parser = parse_height)]
    height: f64,
    /// A film of the same steps with a weight on a thread
    #[arg(long, value_name = "FILM", requires_all = ["grams", "arm"])]
    load: Option<PathBuf>,
    /// The weight, g
    #[arg(long, requires = "load", value_parser = parse_grams)]
    grams: Option<f64>,
    /// Distance of the thread's middle from the axis of the servo, mm
    #[arg(long, value_name = "MM", requires = "load", value_parser = parse_arm)]
    arm: Option<f64>,
    /// Supply at the servo while it moves, V [default: volts of robot.toml]
    #[arg(long, value_parser = parse_volts)]
    volts: Option<f64>,
    #[command(flatten)]
    filming: Filming,
    /// A file for the robot.toml with the keys that the film contradicts
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotFile,
}

fn parse_grams(text: &str) -> Result<f64, String> {
    parse_number(text, [1.0, 10_000.0], "it is the weight in g")
}

fn parse_arm(text: &str) -> Result<f64, String> {
    parse_number(text, [1.0, 200.0], "it is a distance in mm")
}

fn parse_volts(text: &str) -> Result<f64, String> {
    parse_number(text, [2.0, 9.0], "it is a voltage in V")
}

/// The result, with the field names of `--json`.
#[derive(Serialize)]
struct Report {
    servo: &'static str,
    /// Pictures per second.
    pictures: f64,
    /// Height of the card above the strips as given, mm.
    height: f64,
    /// Height of the card above the strips as estimated from its size in the pictures, mm.
    height_by_size: f64,
    figures: Vec<MeasuredKey>,
    /// Rates counter-clockwise and clockwise with their errors, deg/s.
    rates: [[f64; 2]; 2],
    /// Hysteresis: the difference between the angles at which the horn stops when it comes from either side, deg, and
    /// its error.
    sides: [f64; 2],
    /// The largest step of the pulse width that did not move the servo, us.
    still_us: f64,
    is_spin_up_known: bool,
    is_dead_band_known: bool,
    /// True if the servo turns opposite to the sign of its `us_per_degree`.
    turns_the_other_way: bool,
    /// Supply voltage for which the figures hold, V.
    volts: f64,
    /// True if the supply was measured, false if it is that of robot.toml.
    is_volts_measured: bool,
    /// The file of the new robot.toml; null without `--output`.
    written: Option<PathBuf>,
    /// Slew limit of the given robot.toml, deg/s.
    #[serde(skip)]
    slew: f64,
}

/// Measures a servo and prints the result.
///
/// # Errors
/// Fails if a film cannot be read or does not show the servo's steps, or if the output cannot be written.
pub fn measure_servo(args: ServoArgs) -> Result<(), Failure> {
    let text = args.robot.text()?;
    let robot = args.robot.load()?;
    if let Some(output) = &args.output {
        files::check_replaceable(output)?;
    }
    let jig = Jig {
        side: steps::free_direction(&robot, args.servo)?,
        slew: robot.speed_limits().slew,
        spin_up: robot.servo_type().spin_up_ms / 1000.0,
    };
    let setup = args.filming.setup(args.height);
    let spinner = Spinner::new("reading the pictures");
    let analyse_film = |path: &Path| -> Result<(AnalysedFilm, MeasuredServo), Failure> {
        let NamedFilm { name, analysis } = args.filming.analyse(path, setup)?;
        let measured_servo =
            MeasuredServo::of(&analysis.path, jig).map_err(|error| film_failure(&name, &error))?;
        Ok((analysis, measured_servo))
    };
    let (analysis, free_servo) = analyse_film(&args.film)?;
    let stall = match (&args.load, args.grams, args.arm) {
        (Some(path), Some(grams), Some(arm)) => {
            let (_, loaded_servo) = analyse_film(path)?;
            let torque_n_mm = grams / 1000.0 * GRAVITY * arm;
            let stall = free_servo.stall_torque(&loaded_servo, torque_n_mm);
            Some(stall.map_err(|error| Failure::Input(error.to_string()))?)
        }
        _ => None,
    };
    drop(spinner);
    let report = Report::new(&robot, &args, &analysis, &free_servo, stall);
    if let Some(output) = &args.output {
        let new_text = report.new_robot_text(&text)?;
        files::write(output, new_text.as_bytes())?;
    }
    json::print_json_or_text(args.json, &report, || report.text())
}

impl Report {
    fn new(
        robot: &Robot,
        args: &ServoArgs,
        analysis: &AnalysedFilm,
        measured_servo: &MeasuredServo,
        stall: Option<Figure>,
    ) -> Self {
        let (name, servo) = (SERVO_NAMES[args.servo], &robot.servos()[args.servo]);
        let servo_type = robot.servo_type();
        let volts = args.volts.unwrap_or(servo_type.volts);
        let supply_ratio = volts / servo_type.at_volts;
        let scale_figure = |figure: Figure, scale: f64| Figure {
            value: figure.value * scale,
            error: figure.error * scale.abs(),
        };
        let quotient_of = |numerator: f64, figure: Figure| {
            let value = numerator / figure.value;
            let error = (value / figure.value * figure.error).abs();
            Figure { value, error }
        };
        let us_per_degree = servo.us_per_degree;
        let mut figures = Vec::new();
        let mut push_key = |key, decimals, figure: Figure, robot_value: f64, scale: f64| {
            figures.push(
                MeasuredKey::new("servo", key, decimals, figure, robot_value * scale)
                    .with_scale(1.0 / scale),
            );
        };
        let seconds_per_60_deg = quotient_of(60.0, measured_servo.rate);
        push_key(
            "s_per_60_deg",
            4,
            seconds_per_60_deg,
            servo_type.s_per_60_deg,
            1.0 / supply_ratio,
        );
        if let Some(stall) = stall {
            let stall = scale_figure(stall, 1.0 / N_MM_PER_KG_CM);
            push_key(
                "stall_kg_cm",
                2,
                stall,
                servo_type.stall_kg_cm,
                supply_ratio,
            );
        }
        if let Some(width) = measured_servo.dead_band.width {
            push_key(
                "dead_band_us",
                1,
                scale_figure(width, us_per_degree.abs()),
                servo_type.dead_band_us,
                1.0,
            );
        }
        if let Some(spin_up) = measured_servo.spin_up {
            push_key(
                "spin_up_ms",
                1,
                scale_figure(spin_up, 1000.0),
                servo_type.spin_up_ms,
                1.0,
            );
        }
        let table = format!("servo.{name}");
        figures.push(MeasuredKey::new(
            &table,
            "us_per_degree",
            2,
            quotient_of(us_per_degree, measured_servo.gain),
            us_per_degree,
        ));
        let value_and_error = |figure: Figure| [figure.value, figure.error];
        Self {
            servo: name,
            pictures: measured_servo.picture_rate,
            height: args.height,
            height_by_size: analysis.camera.deck_height,
            figures,
            rates: measured_servo.rates.map(value_and_error),
            sides: value_and_error(measured_servo.hysteresis),
            still_us: measured_servo.dead_band.largest_ignored_step * us_per_degree.abs(),
            is_spin_up_known: measured_servo.spin_up.is_some(),
            is_dead_band_known: measured_servo.dead_band.width.is_some(),
            turns_the_other_way: measured_servo.gain.value < 0.0,
            volts,
            is_volts_measured: args.volts.is_some(),
            written: args.output.clone(),
            slew: robot.speed_limits().slew,
        }
    }

    /// Returns the text of robot.toml with the measured values of the keys that the film contradicts, and with the
    /// supply voltage if it was measured.
    fn new_robot_text(&self, text: &str) -> Result<String, Failure> {
        let failure_of = |error: &dyn Display| Failure::Input(error.to_string());
        let mut new_text =
            figures::with_measured_keys(text, &self.figures).map_err(|error| failure_of(&error))?;
        if self.is_volts_measured {
            new_text = edit::with_number(&new_text, "servo.volts", self.volts)
                .and_then(|new_text| {
                    edit::with_comment(&new_text, "servo.volts", "measured:", "by hand")
                })
                .map_err(|error| failure_of(&error))?;
        }
        Robot::parse(&new_text).map_err(|error| failure_of(&error))?;
        Ok(new_text)
    }

    fn text(&self) -> String {
        let [[ccw_rate, _], [cw_rate, _]] = self.rates;
        let mut text = format!(
            "{} at {} V, {:.0} pictures a second; card {:.0} mm above the strips, by its size {:.0} mm\n\n{}\n",
            self.servo,
            self.volts,
            self.pictures,
            self.height,
            self.height_by_size,
            figures::table_text(&self.figures),
        );
        let _ = writeln!(
            text,
            "counter-clockwise {ccw_rate:.0} deg/s, clockwise {cw_rate:.0} deg/s; a step of {:.1} us moved nothing",
            self.still_us
        );
        let [difference, error] = self.sides;
        let _ = writeln!(
            text,
            "as it comes from either side, it stops {:.2} deg {}, to {error:.2} deg",
            difference.abs(),
            if difference < 0.0 { "too far" } else { "apart" },
        );
        if self.turns_the_other_way {
            text +=
                "It turns the other way than robot.toml says: the sign of us_per_degree changes.\n";
        }
        let _ = write!(text, "\n{}", figures::toml_lines(&self.figures));
        let volts = self.volts;
        let _ = match self.is_volts_measured {
            true => writeln!(
                text,
                "and under [servo]: at_volts = {volts}, volts = {volts}"
            ),
            false => writeln!(
                text,
                "and under [servo]: at_volts = {volts}, if that is the supply at the servo while it moves: measure it \
                 (--volts)"
            ),
        };
        if !self.is_spin_up_known {
            text += "Not told: spin_up_ms, which takes 120 pictures a second or more.\n";
        }
        if !self.is_dead_band_known {
            text += "Not told: dead_band_us, which is wider than the largest small step.\n";
        }
        if self.figures.iter().all(|key| key.name() != "stall_kg_cm") {
            text += "Not told: stall_kg_cm, which takes a second film with a weight (--load).\n";
        }
        if let Some(path) = &self.written {
            let _ = writeln!(
                text,
                "Written: {}, where [limits] slew is still {} deg/s, as the jig needs it.",
                path.display(),
                self.slew
            );
        }
        text + "Never told by such a film: full_torque_deg, and neutral_us, which `lizard calibrate` sets.\n"
    }
}
