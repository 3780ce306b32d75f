//! Comparison of the simulated UNO with a second, independent simulator, avr8js.
//!
//! The simulated UNO is built on simavr, and an error of simavr can hide an error of the firmware. avr8js is written
//! in another language by other people. Both simulators get the same image and the same bytes at the same cycles, and
//! their outputs are compared: every pulse of every servo and every byte of the console.

use std::fmt;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::Command;

use lizard_host::sim::supplies;
use lizard_robot::Robot;
use lizard_time_limit::LIMIT;
use simulated_uno::{Edge, Image, Pin, SerialByte};

use crate::robots::root;

/// Cycles at the end of a run in which no pulses are compared: a pulse may have ended on one simulator, but not yet
/// on the other.
const IGNORED_END_CYCLES: u64 = 1_000;

/// Delay of avr8js relative to simavr, cycles. simavr's Timer1 counts from the first cycle of the instruction that
/// starts the timer; avr8js counts from the last cycle. The firmware's outputs have the same delay. The bytes are sent
/// to avr8js later by this delay, so that they arrive in the same state of the firmware. The outputs must then agree
/// to the cycle.
pub const AVR8JS_LAG_CYCLES: i64 = 1;

/// A pulse at a pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PinPulse {
    /// The pin.
    pub pin: Pin,
    /// Cycle of the rising edge.
    pub rise_cycle: u64,
    /// Cycles until the falling edge.
    pub width: u64,
}

impl fmt::Display for PinPulse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            pin,
            rise_cycle,
            width,
        } = self;
        write!(f, "{pin} rises at cycle {rise_cycle} for {width} cycles")
    }
}

/// The outputs of one simulator, recorded in a run from power-on.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Outputs {
    /// The complete pulses of all pins, in the order of their falling edges.
    pub pulses: Vec<PinPulse>,
    /// The bytes that the UNO sent, each with the cycle at which its stop bit ends.
    pub sent: Vec<SerialByte>,
    /// The cycle at which the run ended.
    pub end_cycle: u64,
}

impl Outputs {
    /// Collects the outputs of a simulated UNO from its records since power-on.
    pub fn new(edges: &[Edge], sent: &[SerialByte], end_cycle: u64) -> Self {
        // One entry for each Arduino pin number, 0 to 19.
        let mut rise_cycles = [None; 20];
        let mut pulses = Vec::new();
        for edge in edges {
            let rise_cycle = &mut rise_cycles[usize::from(edge.pin.number())];
            if edge.is_rising {
                *rise_cycle = Some(edge.cycle);
            } else if let Some(rise_cycle) = rise_cycle.take() {
                pulses.push(PinPulse {
                    pin: edge.pin,
                    rise_cycle,
                    width: edge.cycle - rise_cycle,
                });
            }
        }
        Self {
            pulses,
            sent: sent.to_vec(),
            end_cycle,
        }
    }
}

/// The result of a run on avr8js, and its cost.
#[derive(Debug, Clone, Default)]
pub struct Avr8jsRun {
    /// The firmware's outputs in the run.
    pub outputs: Outputs,
    /// The 1024 bytes of EEPROM at the end.
    pub eeprom: Vec<u8>,
    /// Processor time of the simulation, ms.
    pub cpu_ms: u64,
}

/// Runs an image on avr8js until `end_cycle`. `received` are the bytes sent to the UNO, each with the cycle at which
/// the byte is complete on simavr.
///
/// # Errors
/// Fails if a program is missing or fails, for example because avr8js cannot simulate a feature.
pub fn run_on_avr8js(
    image: &Image,
    received: &[SerialByte],
    end_cycle: u64,
    robot: &Robot,
) -> Result<Avr8jsRun, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let hex_path = folder.path().join("firmware.hex");
    let flash_path = folder.path().join("firmware.bin");
    std::fs::write(&flash_path, image.flash()).map_err(|error| error.to_string())?;
    let mut objcopy = Command::new("avr-objcopy");
    objcopy.args(["-I", "binary", "-O", "ihex"]);
    run_program(objcopy.args([&flash_path, &hex_path]), "binutils-avr", "")?;
    let mut script = String::new();
    if let Some((pin, mv)) = supplies::healthy_rail(robot) {
        script += &format!("analogue {} {mv}\n", pin.number());
    }
    for SerialByte { cycle, byte } in received {
        script += &format!(
            "{} {byte:02x}\n",
            cycle.saturating_add_signed(AVR8JS_LAG_CYCLES)
        );
    }
    script += &format!("end {end_cycle}\n");
    let output_text = run_program(
        node()?.arg(judge_folder().join("run.js")).arg(hex_path),
        "nodejs",
        &script,
    )?;
    let mut run = parse_run(&output_text)
        .ok_or_else(|| format!("the judge's output is malformed:\n{output_text}"))?;
    run.outputs.end_cycle = end_cycle;
    Ok(run)
}

/// Runs the tests of tools/judge, which show each error of avr8js and its correction. Returns their output.
///
/// # Errors
/// Fails if a program is missing or a test fails.
pub fn run_judge_tests() -> Result<String, String> {
    let folder = judge_folder().join("test");
    let files = std::fs::read_dir(&folder).map_err(|error| error.to_string())?;
    let paths = files.filter_map(|file| Some(file.ok()?.path()));
    // The files are named one by one, because different versions of Node treat a folder differently.
    let tests = paths.filter(|path| path.to_string_lossy().ends_with(".test.js"));
    run_program(node()?.arg("--test").args(tests), "nodejs", "")
}

fn judge_folder() -> PathBuf {
    root().join("tools/judge")
}

/// Returns the command that starts Node. Fails if the package avr8js is not installed.
fn node() -> Result<Command, String> {
    let package = judge_folder().join("node_modules/avr8js/package.json");
    if !package.exists() {
        return Err("the package avr8js is missing: scripts/setup-judge fetches it".into());
    }
    Ok(Command::new("node"))
}

/// Runs a program with `input_text` as its standard input and returns its output. `debian_package` names the Debian
/// package that contains the program, for the error message.
fn run_program(
    command: &mut Command,
    debian_package: &str,
    input_text: &str,
) -> Result<String, String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = LIMIT.output(command, input_text.as_bytes());
    let output = output.map_err(|error| match error.kind() {
        ErrorKind::NotFound => format!(
            "{program} is missing: scripts/setup and scripts/setup-judge install it \
             (Debian package {debian_package})"
        ),
        _ => format!("{program}: {error}"),
    })?;
    let output_text = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(output_text);
    }
    let error_text = String::from_utf8_lossy(&output.stderr);
    Err(format!(
        "{program} fails: {}\n{output_text}",
        error_text.trim()
    ))
}

/// Parses the output of tools/judge/run.js; the comment at the top of that file describes the lines. Returns `None`
/// if the output is malformed.
fn parse_run(output_text: &str) -> Option<Avr8jsRun> {
    let mut run = Avr8jsRun::default();
    for line in output_text.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        match words[..] {
            ["pulse", pin, rise_cycle, width] => run.outputs.pulses.push(PinPulse {
                pin: Pin::arduino(pin.parse().ok()?),
                rise_cycle: rise_cycle.parse().ok()?,
                width: width.parse().ok()?,
            }),
            ["sent", cycle, byte] => run.outputs.sent.push(SerialByte {
                cycle: cycle.parse().ok()?,
                byte: u8::from_str_radix(byte, 16).ok()?,
            }),
            ["eeprom", bytes] => {
                let byte_at = |index| u8::from_str_radix(bytes.get(index..index + 2)?, 16).ok();
                run.eeprom = (0..bytes.len())
                    .step_by(2)
                    .map(byte_at)
                    .collect::<Option<_>>()?;
            }
            ["cpu", ms] => run.cpu_ms = ms.parse().ok()?,
            _ => return None,
        }
    }
    (run.eeprom.len() == 1024).then_some(run)
}

/// The result of a comparison of two simulators whose outputs agree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Agreement {
    /// The kind of records compared: pulses or bytes.
    pub record_kind: &'static str,
    /// The number of records.
    pub count: usize,
    /// Cycles by which avr8js's first record is later than simavr's.
    pub offset_cycles: i64,
    /// The largest deviation of a record's delay from `offset_cycles`, cycles.
    pub jitter_cycles: u64,
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            record_kind,
            count,
            offset_cycles,
            jitter_cycles,
        } = self;
        write!(
            f,
            "{count} {record_kind}, {offset_cycles} cycles later, with a jitter of {jitter_cycles} cycles"
        )
    }
}

/// Compares the servos' pulses to the cycle: their pins, order, widths and rising edges. The rising edges may have a
/// constant offset, because the data sheet does not specify in which cycle of an instruction a peripheral receives a
/// write.
///
/// # Errors
/// Returns a message about the first difference.
pub fn compare_pulses(
    simavr: &Outputs,
    avr8js: &Outputs,
    servos: &[Pin],
) -> Result<Agreement, String> {
    let pulses_of_servos = |outputs: &Outputs| -> Vec<PinPulse> {
        let pulses = outputs.pulses.iter().copied();
        pulses.filter(|pulse| servos.contains(&pulse.pin)).collect()
    };
    let (simavr_pulses, avr8js_pulses) = (pulses_of_servos(simavr), pulses_of_servos(avr8js));
    let (Some(first_simavr), Some(first_avr8js)) = (simavr_pulses.first(), avr8js_pulses.first())
    else {
        return Err("on one simulator no servo gets a pulse".into());
    };
    let offset_cycles = first_avr8js.rise_cycle as i64 - first_simavr.rise_cycle as i64;
    let avr8js_pulses: Vec<PinPulse> = avr8js_pulses
        .iter()
        .map(|pulse| PinPulse {
            rise_cycle: pulse.rise_cycle.saturating_add_signed(-offset_cycles),
            ..*pulse
        })
        .collect();
    let limit_cycle = simavr.end_cycle.min(avr8js.end_cycle) - IGNORED_END_CYCLES;
    let (simavr_pulses, avr8js_pulses) = (
        ended_pulses(&simavr_pulses, limit_cycle),
        ended_pulses(&avr8js_pulses, limit_cycle),
    );
    let pairs = simavr_pulses.iter().zip(&avr8js_pulses).enumerate();
    if let Some((index, (simavr_pulse, avr8js_pulse))) = pairs
        .into_iter()
        .find(|(_, (simavr_pulse, avr8js_pulse))| simavr_pulse != avr8js_pulse)
    {
        return Err(format!(
            "pulse {index}: on simavr {simavr_pulse}, on avr8js {avr8js_pulse}, \
             less the constant delay of {offset_cycles} cycles"
        ));
    }
    let count = simavr_pulses.len().min(avr8js_pulses.len());
    for (name, pulses) in [("simavr", &simavr_pulses), ("avr8js", &avr8js_pulses)] {
        if let Some(extra_pulse) = pulses.get(count) {
            return Err(format!("pulse {count} is on {name} alone: {extra_pulse}"));
        }
    }
    Ok(Agreement {
        record_kind: "pulses",
        count,
        offset_cycles,
        jitter_cycles: 0,
    })
}

/// Compares the bytes that the console has sent, and measures by how much their delay varies.
///
/// # Errors
/// Returns a message about the first difference.
pub fn compare_console(simavr: &Outputs, avr8js: &Outputs) -> Result<Agreement, String> {
    let (Some(first_simavr), Some(first_avr8js)) = (simavr.sent.first(), avr8js.sent.first())
    else {
        return Err("the console of one simulator is silent".into());
    };
    let offset_cycles = first_avr8js.cycle as i64 - first_simavr.cycle as i64;
    let pairs = simavr.sent.iter().zip(&avr8js.sent);
    let mut jitter_cycles = 0;
    for (index, (simavr_byte, avr8js_byte)) in pairs.enumerate() {
        if simavr_byte.byte != avr8js_byte.byte {
            return Err(format!(
                "byte {index} of the console, cycle {}: simavr has {:?}, avr8js {:?}",
                simavr_byte.cycle,
                tail(&simavr.sent, index),
                tail(&avr8js.sent, index)
            ));
        }
        jitter_cycles = jitter_cycles.max(
            avr8js_byte
                .cycle
                .saturating_add_signed(-offset_cycles)
                .abs_diff(simavr_byte.cycle),
        );
    }
    let count = simavr.sent.len().min(avr8js.sent.len());
    for (name, outputs) in [("simavr", simavr), ("avr8js", avr8js)] {
        if outputs.sent.len() > count {
            let text = tail(&outputs.sent, count);
            return Err(format!(
                "byte {count} of the console is on {name} alone: {text:?}"
            ));
        }
    }
    Ok(Agreement {
        record_kind: "bytes",
        count,
        offset_cycles,
        jitter_cycles,
    })
}

/// Returns the pulses that have ended by `limit_cycle`.
fn ended_pulses(pulses: &[PinPulse], limit_cycle: u64) -> Vec<PinPulse> {
    let pulses = pulses.iter().copied();
    pulses
        .filter(|pulse| pulse.rise_cycle + pulse.width <= limit_cycle)
        .collect()
}

/// Returns the 60 bytes, about a line, that end with byte `index`.
fn tail(bytes: &[SerialByte], index: usize) -> String {
    let end = bytes.len().min(index + 1);
    let bytes: Vec<u8> = bytes[end.saturating_sub(60)..end]
        .iter()
        .map(|byte| byte.byte)
        .collect();
    String::from_utf8_lossy(&bytes).into_owned()
}
