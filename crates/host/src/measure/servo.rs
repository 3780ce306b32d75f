//! `lizard measure servo`: measures the travel, rate and torque of a servo in a jig.

use std::fmt::{Display, Write as _};
use std::path::{Path, PathBuf};

use lizard_measure::NamedVideo;
use lizard_robot::servo::SERVO_NAMES;
use lizard_robot::{GRAVITY, Robot, edit};
use lizard_video::{AnalysedVideo, Estimate, Jig, MeasuredServo};
use serde::Serialize;

use super::measured_key::{self, MeasuredKey};
use super::recording::{RecordingArgs, height_parser};
use super::steps::{self, parse_servo};
use super::video::video_failure;
use crate::shared::number::range_parser;
use crate::shared::progress::create_spinner;
use crate::shared::{files, json};
use crate::{Failure, RobotArgs};

/// N mm per kg cm.
const N_MM_PER_KG_CM: f64 = 10.0 * GRAVITY;

/// Measure a servo's travel, rate and torque in a video, for robot.toml
///
/// VIDEO shows the sheet's card on the servo's horn, between the two strips, while `lizard measure steps` turns it.
/// Prints the measured values of [servo] with their standard errors, the current values in robot.toml, and the lines
/// for robot.toml. The stall torque needs a second video, in which the servo lifts a weight by winding a thread onto a
/// drum.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:
  lizard measure steps --servo A1 --robot jig.toml | lizard console
  lizard measure servo video.mp4 --servo A1 --height 42 --robot jig.toml
  lizard measure servo video.mp4 --servo A1 --height 42 --robot jig.toml \\
      --load loaded.mp4 --grams 100 --arm 20 --output measured.toml")]
pub struct ServoArgs {
    /// A video, or a folder of frames (PNG or JPEG)
    video: PathBuf,
    /// The servo: A1, A2, A3 or A4
    #[arg(long, value_name = "NAME", value_parser = parse_servo)]
    servo: usize,
    /// Height of the card above the strips, mm
    #[arg(long, value_name = "MM", value_parser = height_parser())]
    height: f64,
    /// A video of the same steps while the servo lifts a weight
    #[arg(long = "load", value_name = "VIDEO", requires_all = ["grams", "arm"])]
    loaded_video: Option<PathBuf>,
    /// The weight, g
    #[arg(long, requires = "loaded_video", value_parser = range_parser(1.0, 10_000.0, " g"))]
    grams: Option<f64>,
    /// Distance from the servo's axis to the centre of the thread, mm
    #[arg(long, value_name = "MM", requires = "loaded_video",
          value_parser = range_parser(1.0, 200.0, " mm"))]
    arm: Option<f64>,
    /// Supply voltage at the servo while it moves, V [default: volts in robot.toml]
    #[arg(long, value_parser = range_parser(2.0, 9.0, " V"))]
    volts: Option<f64>,
    #[command(flatten)]
    recording: RecordingArgs,
    /// Write a robot.toml with the measured values of the keys that disagree
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotArgs,
}

/// The result, as `--json` prints it.
#[derive(Serialize)]
struct Report {
    servo: &'static str,
    /// Frames per second.
    #[serde(rename = "frames_per_second")]
    frame_rate: f64,
    /// Given height of the card above the strips, mm.
    height: f64,
    /// Height of the card above the strips, computed from its size in the frames, mm.
    #[serde(rename = "height_by_size")]
    estimated_height: f64,
    #[serde(rename = "figures")]
    keys: Vec<MeasuredKey>,
    /// Rates counter-clockwise and clockwise with their standard errors, deg/s.
    rates: [[f64; 2]; 2],
    /// Difference between the angles at which the horn stops when it comes from either side, and its standard error,
    /// deg.
    #[serde(rename = "sides")]
    hysteresis: [f64; 2],
    /// The largest step of the pulse width that did not move the servo, us.
    #[serde(rename = "still_us")]
    largest_ignored_step_us: f64,
    /// True if `keys` contains `spin_up_ms`.
    is_spin_up_known: bool,
    /// True if `keys` contains `dead_band_us`.
    is_dead_band_known: bool,
    /// True if the servo turns opposite to the direction that `us_per_degree` implies.
    #[serde(rename = "turns_the_other_way")]
    is_reversed: bool,
    /// Supply voltage for which the measured values are valid, V.
    volts: f64,
    /// True if the supply voltage was measured, false if it is taken from robot.toml.
    is_volts_measured: bool,
    /// The file of the new robot.toml; null without `--output`.
    #[serde(rename = "written")]
    output_name: Option<String>,
    /// Slew limit in the given robot.toml, deg/s.
    #[serde(skip)]
    slew: f64,
}

/// Measures a servo and prints the result.
///
/// # Errors
/// Fails if a video cannot be read or does not show the servo's steps, or if the output cannot be written.
pub fn measure_servo(args: ServoArgs) -> Result<(), Failure> {
    let robot_toml = args.robot.text()?;
    let robot = args.robot.load()?;
    let is_own_output = |text: &str| measured_key::is_earlier_output(text, robot_toml);
    if let Some(output) = &args.output {
        files::check_replaceable_robot(output, is_own_output)?;
    }
    let jig = Jig {
        side: steps::find_free_direction(&robot, args.servo)?,
        slew: robot.speed_limits().slew,
        rotor_time_constant: robot.servo_type().rotor_time_constant_ms / 1000.0,
    };
    let setup = args.recording.setup(args.height);
    let spinner = create_spinner("reading the frames");
    let analyse_video = |path: &Path| -> Result<(AnalysedVideo, MeasuredServo), Failure> {
        let NamedVideo { name, analysis } = args.recording.analyse(path, setup)?;
        let measured_servo = MeasuredServo::from_path(&analysis.path, jig)
            .map_err(|error| video_failure(&name, &error))?;
        Ok((analysis, measured_servo))
    };
    let (analysis, free_servo) = analyse_video(&args.video)?;
    let stall_torque = match (&args.loaded_video, args.grams, args.arm) {
        (Some(path), Some(grams), Some(arm)) => {
            let (_, loaded_servo) = analyse_video(path)?;
            let torque_n_mm = grams / 1000.0 * GRAVITY * arm;
            let stall_torque = free_servo.compute_stall_torque(&loaded_servo, torque_n_mm);
            Some(stall_torque.map_err(|error| Failure::Input(error.to_string()))?)
        }
        _ => None,
    };
    drop(spinner);
    let report = Report::new(&robot, &args, &analysis, &free_servo, stall_torque);
    if let Some(output) = &args.output {
        let updated_toml = report.update_robot_toml(robot_toml)?;
        files::write_robot(output, updated_toml.as_bytes(), is_own_output)?;
    }
    json::print_json_or_text(args.json, &report, || report.format_text())
}

impl Report {
    fn new(
        robot: &Robot,
        args: &ServoArgs,
        analysis: &AnalysedVideo,
        measured_servo: &MeasuredServo,
        stall_torque_n_mm: Option<Estimate>,
    ) -> Self {
        let (name, servo) = (SERVO_NAMES[args.servo], &robot.servos()[args.servo]);
        let servo_type = robot.servo_type();
        let volts = args.volts.unwrap_or(servo_type.supply_volts);
        let supply_ratio = volts / servo_type.rated_volts;
        let scale_estimate = |estimate: Estimate, scale: f64| {
            Estimate::new(
                estimate.value * scale,
                estimate.standard_error * scale.abs(),
            )
        };
        let divide_by_estimate = |numerator: f64, estimate: Estimate| {
            let value = numerator / estimate.value;
            let error = value / estimate.value * estimate.standard_error;
            Estimate::new(value, error.abs())
        };
        let us_per_degree = servo.us_per_degree;
        let mut keys = Vec::new();
        let mut push_key = |name, decimals, estimate, file_value, scale| {
            let key = MeasuredKey::new("servo", name, decimals, estimate, file_value, scale);
            keys.push(key);
        };
        let seconds_per_60_deg = divide_by_estimate(60.0, measured_servo.rate);
        let file_value = servo_type.s_per_60_deg;
        let scale = 1.0 / supply_ratio;
        push_key("s_per_60_deg", 4, seconds_per_60_deg, file_value, scale);
        if let Some(stall_torque) = stall_torque_n_mm {
            let stall_kg_cm = scale_estimate(stall_torque, 1.0 / N_MM_PER_KG_CM);
            let file_value = servo_type.stall_torque_kg_cm;
            push_key("stall_kg_cm", 2, stall_kg_cm, file_value, supply_ratio);
        }
        if let Some(width) = measured_servo.dead_band.width {
            let width_us = scale_estimate(width, us_per_degree.abs());
            push_key("dead_band_us", 1, width_us, servo_type.dead_band_us, 1.0);
        }
        if let Some(rotor_time_constant) = measured_servo.rotor_time_constant {
            let spin_up_ms = scale_estimate(rotor_time_constant, 1000.0);
            let file_value = servo_type.rotor_time_constant_ms;
            push_key("spin_up_ms", 1, spin_up_ms, file_value, 1.0);
        }
        let table = format!("servo.{name}");
        let gain = divide_by_estimate(us_per_degree, measured_servo.gain);
        let gain_key = MeasuredKey::new(&table, "us_per_degree", 2, gain, us_per_degree, 1.0);
        keys.push(gain_key);
        let value_and_error = |estimate: Estimate| [estimate.value, estimate.standard_error];
        let dead_band = &measured_servo.dead_band;
        Self {
            servo: name,
            frame_rate: measured_servo.frame_rate,
            height: args.height,
            estimated_height: analysis.camera.deck_height,
            keys,
            rates: measured_servo.rates.map(value_and_error),
            hysteresis: value_and_error(measured_servo.hysteresis),
            largest_ignored_step_us: dead_band.largest_ignored_step * us_per_degree.abs(),
            is_spin_up_known: measured_servo.rotor_time_constant.is_some(),
            is_dead_band_known: dead_band.width.is_some(),
            is_reversed: measured_servo.gain.value < 0.0,
            volts,
            is_volts_measured: args.volts.is_some(),
            // A path that is not UTF-8 cannot be serialized.
            output_name: args.output.as_ref().map(|path| path.display().to_string()),
            slew: robot.speed_limits().slew,
        }
    }

    /// Returns robot.toml with the disagreeing keys replaced by the measured values, and with the supply voltage if it
    /// was measured.
    fn update_robot_toml(&self, robot_toml: &str) -> Result<String, Failure> {
        let to_failure = |error: &dyn Display| Failure::Input(error.to_string());
        let mut updated_toml = measured_key::with_measured_keys(robot_toml, &self.keys)
            .map_err(|error| to_failure(&error))?;
        if self.is_volts_measured {
            updated_toml = edit::with_number(&updated_toml, "servo.volts", self.volts)
                .and_then(|toml| edit::with_comment(&toml, "servo.volts", "measured:", "by hand"))
                .map_err(|error| to_failure(&error))?;
        }
        Robot::parse(&updated_toml).map_err(|error| to_failure(&error))?;
        Ok(updated_toml)
    }

    fn format_text(&self) -> String {
        let [[ccw_rate, _], [cw_rate, _]] = self.rates;
        let [hysteresis, hysteresis_error] = self.hysteresis;
        let cause = match hysteresis < 0.0 {
            true => " by overshoot",
            false => "",
        };
        let still_us = self.largest_ignored_step_us;
        let hysteresis = hysteresis.abs();
        let table = measured_key::format_table(&self.keys);
        let mut text = format!(
            "{} at {} V, {:.0} frames per second; card {:.0} mm above the strips, {:.0} mm according to its size\n\n\
             {table}\n\
             counter-clockwise {ccw_rate:.0} deg/s, clockwise {cw_rate:.0} deg/s; a step of {still_us:.1} us did not move the \
             servo\n\
             hysteresis {hysteresis:.2} +- {hysteresis_error:.2} deg{cause}\n",
            self.servo, self.volts, self.frame_rate, self.height, self.estimated_height
        );
        if self.is_reversed {
            text +=
                "The servo turns in the opposite direction: the sign of us_per_degree changes.\n";
        }
        let toml_lines = measured_key::format_toml_lines(&self.keys);
        let _ = write!(text, "\n{toml_lines}");
        let _ = match self.is_volts_measured {
            true => writeln!(text, "Also under [servo]: volts = {}", self.volts),
            false => writeln!(
                text,
                "Measure the supply voltage at the servo while it moves, and give it with --volts."
            ),
        };
        if !self.is_spin_up_known {
            text += "Not measured: spin_up_ms (needs at least 120 frames per second).\n";
        }
        if !self.is_dead_band_known {
            text += "Not measured: dead_band_us (wider than the largest small step).\n";
        }
        if self.keys.iter().all(|key| key.name != "stall_kg_cm") {
            text += "Not measured: stall_kg_cm (needs a second video with a weight, --load).\n";
        }
        if let Some(name) = &self.output_name {
            let _ = writeln!(
                text,
                "Written: {name}; its [limits] slew is still {} deg/s for the jig.",
                self.slew
            );
        }
        text + "A video cannot show full_torque_deg, nor neutral_us, which `lizard calibrate` sets.\n"
    }
}
