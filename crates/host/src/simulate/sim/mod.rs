//! `lizard sim`: runs the real firmware on a simulated UNO, and reports its output, the servo pulses, and the predicted
//! displacement.

pub mod analysis;
pub mod core_run;
pub(crate) mod dialogue;
pub mod footfall;
pub mod frame;
pub mod frame_log;
pub mod gait_choice;
pub mod lines;
pub mod press;
mod report;
pub mod script;
#[cfg(target_os = "linux")]
mod served;
pub mod session;
pub mod spans;
pub mod supplies;
pub(crate) mod timeline;

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use lizard_robot::Robot;
use simulated_uno::{FREQUENCY, Fidelity, State, Uno};
#[cfg(target_os = "linux")]
use simulated_uno::{Radio, RadioLink};

use crate::shared::firmware::{self, Firmware};
#[cfg(target_os = "linux")]
use crate::shared::number::whole_number_parser;
use crate::shared::progress::{create_progress_bar, create_spinner};
use crate::shared::robot_args::unknown_gait_failure;
use crate::shared::{files, json};
use crate::{Failure, RobotArgs};
use analysis::Run;
use dialogue::DialoguePrinter;
use press::{ContactChange, Press};
use report::{RamUse, Report};
use script::Script;
use session::{DialogueLine, Event, Recording};

/// Run the firmware on a simulated Arduino UNO
///
/// By default, the robot starts, performs its first moving gait and the gait that turns most,
/// stops and rests. Prints the dialogue, a table of the servos and the predicted displacement,
/// and draws servo angles and footfalls. Time is simulated: ten minutes take a few seconds.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The firmware, an ELF that contains this robot [default: the built-in firmware]
    #[arg(long, value_name = "FILE")]
    elf: Option<PathBuf>,
    /// Play one gait of robot.toml
    #[arg(long, value_hint = clap::ValueHint::Other, value_name = "NAME", conflicts_with = "script")]
    gait: Option<String>,
    /// Play a file with lines of the form `<ms since power-on> <command>`
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Simulated time in seconds [default: 12, or until a second after the script's last line]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    duration: Option<f64>,
    /// Press a robot's input for 0.2 s, or for a time span, in seconds since power-on:
    /// `button@2`, `nose@5.5-8`; may be repeated
    #[arg(long, value_name = "NAME@SECONDS")]
    press: Vec<Press>,
    /// Print every line of the dialogue, including long runs of `# t=` lines
    #[arg(long)]
    all: bool,
    /// Print everything as one JSON object, including the angles of each frame
    #[arg(long)]
    json: bool,
    /// Output file for the picture
    #[arg(long, value_name = "FILE", default_value = "out/lizard-sim.svg")]
    svg: PathBuf,
    /// Fidelity of the simulated chip
    #[arg(long, value_enum, default_value_t)]
    fidelity: FidelityArg,
    /// Simulate a board on USB instead: in real time at a pseudo terminal that other
    /// programs can open, until Ctrl-C. LINK becomes a symbolic link to it
    #[cfg(target_os = "linux")]
    #[arg(long, value_name = "LINK", num_args = 0..=1,
          conflicts_with_all = ["gait", "script", "duration", "all", "json", "svg"])]
    pty: Option<Option<PathBuf>>,
    /// With --pty: a new board with this boot loader (ELF or HEX) and no firmware, to try
    /// `lizard flash`
    #[cfg(target_os = "linux")]
    #[arg(long, value_name = "FILE", requires = "pty", conflicts_with = "elf")]
    boot_loader: Option<PathBuf>,
    /// With --pty: connect through a radio module with this baud rate, such as 9600: packets of
    /// 20 bytes are delayed, lost, or cut; opening the port does not reset the board
    #[cfg(target_os = "linux")]
    #[arg(long, value_name = "BAUD", requires = "pty", conflicts_with = "boot_loader",
          value_parser = whole_number_parser::<u32>(300, 1_000_000))]
    radio: Option<u32>,
    /// With --radio: the seed of the random numbers; the same seed disturbs the same packets
    #[cfg(target_os = "linux")]
    #[arg(long, value_name = "N", requires = "radio", default_value_t = 0,
          value_parser = whole_number_parser(0, u64::MAX))]
    seed: u64,
    #[command(flatten)]
    robot: RobotArgs,
}

/// The fidelity of the simulated chip, as named on the command line.
#[derive(clap::ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
enum FidelityArg {
    /// Corrected according to the ATmega328P's data sheet
    #[default]
    DataSheet,
    /// simavr 1.6, unchanged
    Stock,
}

/// Longest simulated time, s: a day.
const MAX_SECONDS: f64 = 86_400.0;

/// Parses a time in seconds, which must be greater than 0 and at most [`MAX_SECONDS`].
fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= MAX_SECONDS => Ok(value),
        Ok(_) => Err(format!("must be greater than 0 and at most {MAX_SECONDS}")),
        Err(_) => Err("it is not a number".to_owned()),
    }
}

/// Runs the firmware and prints the results.
///
/// # Errors
/// Fails if robot.toml or the script is invalid, if the firmware is missing, contains another robot or crashes, if a
/// gait or an input is unknown, or if a file cannot be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let (fidelity, fidelity_name) = match args.fidelity {
        FidelityArg::DataSheet => (Fidelity::DataSheet, "data-sheet"),
        FidelityArg::Stock => (Fidelity::Stock, "stock"),
    };
    let robot = args.robot.load()?;
    let contact_changes = press::list_contact_changes(&args.press, &robot)?;
    #[cfg(target_os = "linux")]
    if let Some(link) = &args.pty {
        let mut uno = match &args.boot_loader {
            Some(boot_loader) => served::new_board(boot_loader, fidelity)?,
            None => {
                let image =
                    firmware::select_firmware(args.elf.as_deref(), &args.robot, &robot)?.image;
                Uno::with_image(image, fidelity)
            }
        };
        supplies::connect_healthy_robot(&mut uno, &robot);
        let radio = args.radio.map(|baud| {
            Radio::new(RadioLink {
                baud: f64::from(baud),
                seed: args.seed,
                ..RadioLink::default()
            })
        });
        return served::serve_until_interrupted(uno, link.as_deref(), radio, &contact_changes);
    }
    let mut script = choose_script(&args, &robot)?;
    files::check_replaceable(&args.svg)?;
    script.contact_changes = contact_changes;
    let Firmware { name, image } =
        firmware::select_firmware(args.elf.as_deref(), &args.robot, &robot)?;
    let mut uno = Uno::with_image(image, fidelity);
    let (recording, dialogue) = record(&mut uno, &robot, &script, &args)?;

    let spinner = create_spinner("analysing every frame");
    let spans = spans::list_command_spans(&script, &recording.answers);
    let commanded_widths = compute_commanded_widths(&robot, &recording, &script.contact_changes);
    let run = Run::new(&robot, &recording.frames);
    let picture = timeline::draw(run, &spans, &timeline::SIMULATED_CAPTION);
    files::write(&args.svg, picture.as_bytes())?;
    let report = Report {
        firmware_name: name,
        fidelity: fidelity_name,
        seconds: recording.cycles as f64 / FREQUENCY as f64,
        wall_seconds: recording.wall_time.as_secs_f64(),
        servos: analysis::compute_servo_reports(run, commanded_widths.as_deref()),
        safety: analysis::check_safety(run),
        displacements: analysis::compute_command_displacements(run, &spans),
        max_pins_high: run.log.max_pins_high,
        asleep_percent: 100.0 * uno.sleep_cycles() as f64 / uno.cycle().max(1) as f64,
        flash: firmware::count_code_bytes(uno.image(), &robot) + robot.section().len() as u32,
        ram: RamUse::measure(&uno),
        overruns: uno.overrun_count(),
        resets: uno.watchdog_reset_count(),
        ended: describe_firmware_state(&recording.state),
        svg: args.svg.display().to_string(),
        dialogue,
        frames: run,
    };
    drop(spinner);
    let mut out = io::stdout().lock();
    if args.json {
        json::write_line(&mut out, &report)?;
    } else {
        report.print(&mut out)?;
    }
    match recording.state {
        State::Alive => Ok(()),
        _ => Err(Failure::Operation(report.ended)),
    }
}

/// Plays the script. Prints the dialogue as it happens; with `--json`, returns the dialogue's lines instead.
fn record(
    uno: &mut Uno,
    robot: &Robot,
    script: &Script,
    args: &Args,
) -> io::Result<(Recording, Vec<DialogueLine>)> {
    let mut printer = DialoguePrinter::new(args.all);
    let mut dialogue_lines = Vec::new();
    let mut out = io::stdout();
    let recording = play_with_progress(uno, robot, script, |line| {
        if !args.json {
            return printer.print(&line, &mut out);
        }
        dialogue_lines.push(line);
        Ok(())
    })?;
    if !args.json {
        printer.finish(&mut out)?;
        writeln!(out)?;
    }
    Ok((recording, dialogue_lines))
}

/// Plays a script with a progress bar. Calls `on_line` for each line of the dialogue.
///
/// # Errors
/// Returns the errors of `on_line`, which end the run.
pub(crate) fn play_with_progress(
    uno: &mut Uno,
    robot: &Robot,
    script: &Script,
    mut on_line: impl FnMut(DialogueLine) -> io::Result<()>,
) -> io::Result<Recording> {
    let template = "{bar:40} {pos}/{len} ms simulated, {elapsed}";
    let time_bar = create_progress_bar(script.end_ms as usize, template);
    // The bar is hidden and drawn again only once for the lines of each time slice.
    let mut new_lines = Vec::new();
    let recording = session::play(uno, robot, script, |event| {
        match event {
            Event::Line(line) => new_lines.push(line),
            Event::Time(ms) => {
                time_bar.set_position(ms);
                if !new_lines.is_empty() {
                    time_bar.suspend(|| new_lines.drain(..).try_for_each(&mut on_line))?;
                }
            }
        }
        Ok(())
    })?;
    time_bar.finish_and_clear();
    Ok(recording)
}

/// Computes the pulse widths, in cycles, that the firmware's core commands in each frame; `None` unless the firmware's
/// banner shows that the firmware and this program have the same core and tables.
fn compute_commanded_widths(
    robot: &Robot,
    recording: &Recording,
    contact_changes: &[ContactChange],
) -> Option<Vec<[u16; 4]>> {
    let log = &recording.frames;
    let output = core_run::play(
        *robot.firmware(),
        &recording.received_by_uno,
        contact_changes,
        log.first_start,
        log.widths.len(),
    );
    let has_same_core = recording.banner.as_deref()? == output.text.lines().next()?;
    has_same_core.then_some(output.widths)
}

/// Describes a state of the firmware.
fn describe_firmware_state(state: &State) -> String {
    match state {
        State::Alive => "the firmware is alive".to_owned(),
        State::Halted => "the firmware sleeps with interrupts off, forever".to_owned(),
        State::Crashed { pc, message } => {
            // simavr gives only the name of its function.
            let reason = match message.as_str() {
                "avr_sadly_crashed" => "no such instruction or address",
                known_reason => known_reason,
            };
            format!("the firmware crashed at {pc:#06x}: {reason}")
        }
        State::Off => "the board has no power".to_owned(),
    }
}

/// Returns the script that the command-line options select.
fn choose_script(args: &Args, robot: &Robot) -> Result<Script, Failure> {
    let duration_ms = args.duration.map(|seconds| (seconds * 1000.0) as u64);
    if let Some(path) = &args.script {
        let mut script = read_script(path)?;
        script.end_ms = duration_ms.unwrap_or(script.end_ms);
        return Ok(script);
    }
    if let Some(gait) = &args.gait
        && robot.gait(gait).is_none()
    {
        let problem = format!("the robot has no gait `{gait}`");
        return Err(unknown_gait_failure(&problem, gait, robot.gaits().iter()));
    }
    let ms = duration_ms.unwrap_or(12_000);
    if ms < Script::MIN_MS {
        let min_s = Script::MIN_MS / 1000;
        return Err(Failure::Input(format!(
            "--duration must be at least {min_s} s without --script"
        )));
    }
    Ok(args.gait.as_deref().map_or_else(
        || Script::from_gaits(&gait_choice::choose_demonstration_gaits(robot), ms),
        |gait| Script::from_gaits(&[gait], ms),
    ))
}

/// Reads a script from its file.
pub(crate) fn read_script(path: &Path) -> Result<Script, Failure> {
    let name = path.display();
    let text = files::read_text(path)?;
    Script::parse(&text).map_err(|error| Failure::Input(format!("{name}: {error}")))
}
