//! Comparison of the simulated UNO with a second, independent simulator, avr8js.
//!
//! The simulated UNO is built on simavr, and an error in simavr can hide an error in the firmware. avr8js is written in
//! another language by other people. Both simulators get the same image and the same bytes at the same cycles. Their
//! outputs are compared: every pulse of every servo and every byte of the console.

use std::fmt;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::process::Command;

use lizard_host::sim::supplies;
use lizard_robot::Robot;
use lizard_time_limit::TIME_LIMIT;
use simulated_uno::{Edge, Image, Pin, SerialByte};

use crate::helpers::decode_text;
use crate::robots::root;

/// Cycles at the end of a run in which no pulses are compared, because a pulse may have ended on only one simulator.
const IGNORED_END_CYCLES: u64 = 1_000;

/// Delay of avr8js relative to simavr, cycles. simavr's Timer1 counts from the first cycle of the instruction that
/// starts the timer; avr8js's counts from the last. The firmware's outputs have the same delay. Bytes are sent to
/// avr8js later by this delay, so that they find the firmware in the same state. The outputs must then agree to the
/// cycle.
pub const AVR8JS_LAG_CYCLES: i64 = 1;

/// A pulse at a pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PinPulse {
    /// The pin that has the pulse.
    pub pin: Pin,
    /// The cycle of the rising edge.
    pub rise_cycle: u64,
    /// The number of cycles from the rising edge to the falling edge.
    pub width: u64,
}

impl fmt::Display for PinPulse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (pin, cycle, width) = (self.pin, self.rise_cycle, self.width);
        write!(f, "{pin} rises at cycle {cycle} for {width} cycles")
    }
}

/// The outputs of one simulator, recorded in a run from power-on.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Outputs {
    /// The complete pulses of all pins, in the order of their falling edges.
    pub pulses: Vec<PinPulse>,
    /// The bytes that the UNO sent, each with the cycle at which its stop bit ends.
    pub sent_bytes: Vec<SerialByte>,
    /// The cycle at which the run ended.
    pub end_cycle: u64,
}

impl Outputs {
    /// Collects the outputs of a simulated UNO from its records since power-on.
    pub fn new(edges: &[Edge], sent_bytes: &[SerialByte], end_cycle: u64) -> Self {
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
            sent_bytes: sent_bytes.to_vec(),
            end_cycle,
        }
    }
}

/// The result of a run on avr8js, and its processor time.
#[derive(Debug, Clone, Default)]
pub struct Avr8jsRun {
    /// The firmware's outputs in the run.
    pub outputs: Outputs,
    /// The 1024 bytes of EEPROM at the end.
    pub eeprom: Vec<u8>,
    /// The simulation's processor time, ms.
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
    if let Some((pin, mv)) = supplies::find_healthy_rail_input(robot) {
        script += &format!("analogue {} {mv}\n", pin.number());
    }
    for SerialByte { cycle, value } in received {
        let cycle = cycle.saturating_add_signed(AVR8JS_LAG_CYCLES);
        script += &format!("{cycle} {value:02x}\n");
    }
    script += &format!("end {end_cycle}\n");
    let mut node = node_command()?;
    node.arg(judge_folder().join("run.js")).arg(hex_path);
    let output_text = run_program(&mut node, "nodejs", &script)?;
    let mut run = parse_run(&output_text)
        .ok_or_else(|| format!("malformed output of the judge:\n{output_text}"))?;
    run.outputs.end_cycle = end_cycle;
    Ok(run)
}

/// Runs the tests of tools/judge, which reproduce each error of avr8js and check its correction. Returns their output.
///
/// # Errors
/// Fails if a program is missing or a test fails.
pub fn run_judge_tests() -> Result<String, String> {
    let folder = judge_folder().join("test");
    let files = std::fs::read_dir(&folder).map_err(|error| error.to_string())?;
    let paths = files.filter_map(|file| Some(file.ok()?.path()));
    // Names each file, because versions of Node treat a folder differently.
    let is_test = |path: &PathBuf| path.to_string_lossy().ends_with(".test.js");
    let tests: Vec<PathBuf> = paths.filter(is_test).collect();
    if tests.is_empty() {
        return Err(format!("no tests in {}", folder.display()));
    }
    run_program(node_command()?.arg("--test").args(tests), "nodejs", "")
}

fn judge_folder() -> PathBuf {
    root().join("tools/judge")
}

/// Returns the command that starts Node. Fails if the package avr8js is not installed.
fn node_command() -> Result<Command, String> {
    let package = judge_folder().join("node_modules/avr8js/package.json");
    if !package.exists() {
        return Err("the package avr8js is missing: run scripts/setup-judge to install it".into());
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
    let output = TIME_LIMIT.run_command(command, input_text.as_bytes());
    let output = output.map_err(|error| match error.kind() {
        ErrorKind::NotFound => format!(
            "{program} is missing: run scripts/setup and scripts/setup-judge to install it \
             (Debian package {debian_package})"
        ),
        _ => format!("{program}: {error}"),
    })?;
    let output_text = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(output_text);
    }
    let error_text = String::from_utf8_lossy(&output.stderr);
    let error_text = error_text.trim();
    Err(format!("{program} failed: {error_text}\n{output_text}"))
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
            ["sent", cycle, value] => run.outputs.sent_bytes.push(SerialByte {
                cycle: cycle.parse().ok()?,
                value: u8::from_str_radix(value, 16).ok()?,
            }),
            ["eeprom", bytes] => {
                let parse_byte = |index| u8::from_str_radix(bytes.get(index..index + 2)?, 16).ok();
                let contents = (0..bytes.len()).step_by(2).map(parse_byte);
                run.eeprom = contents.collect::<Option<_>>()?;
            }
            ["cpu", ms] => run.cpu_ms = ms.parse().ok()?,
            _ => return None,
        }
    }
    (run.eeprom.len() == 1024).then_some(run)
}

/// The result of comparing two simulators whose outputs agree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Agreement {
    /// The number of records compared: pulses or bytes.
    pub count: usize,
    /// Cycles by which avr8js's first record is later than simavr's.
    pub offset_cycles: i64,
    /// The largest deviation of a record's delay from `offset_cycles`, cycles.
    pub jitter_cycles: u64,
}

/// Compares the servos' pulses to the cycle: their pins, order, widths and rising edges. The rising edges may have a
/// constant offset, because the data sheet does not specify the cycle of an instruction in which a peripheral receives
/// a write.
///
/// # Errors
/// Returns a message about the first difference.
pub fn compare_pulses(
    simavr: &Outputs,
    avr8js: &Outputs,
    servo_pins: &[Pin],
) -> Result<Agreement, String> {
    let select_servo_pulses = |outputs: &Outputs| -> Vec<PinPulse> {
        let is_servo = |pulse: &PinPulse| servo_pins.contains(&pulse.pin);
        outputs.pulses.iter().copied().filter(is_servo).collect()
    };
    let [mut simavr_pulses, mut avr8js_pulses] = [simavr, avr8js].map(select_servo_pulses);
    let (Some(first_simavr), Some(first_avr8js)) = (simavr_pulses.first(), avr8js_pulses.first())
    else {
        return Err("no servo gets a pulse on one simulator".into());
    };
    let offset_cycles = first_avr8js.rise_cycle as i64 - first_simavr.rise_cycle as i64;
    for pulse in &mut avr8js_pulses {
        pulse.rise_cycle = pulse.rise_cycle.saturating_add_signed(-offset_cycles);
    }
    let end_cycle = simavr.end_cycle.min(avr8js.end_cycle) - IGNORED_END_CYCLES;
    for pulses in [&mut simavr_pulses, &mut avr8js_pulses] {
        pulses.retain(|pulse| pulse.rise_cycle + pulse.width <= end_cycle);
    }
    let pairs = simavr_pulses.iter().zip(&avr8js_pulses);
    for (index, (simavr_pulse, avr8js_pulse)) in pairs.enumerate() {
        if simavr_pulse != avr8js_pulse {
            return Err(format!(
                "pulse {index}: on simavr {simavr_pulse}; on avr8js {avr8js_pulse}, \
                 after subtracting the constant delay of {offset_cycles} cycles"
            ));
        }
    }
    let count = simavr_pulses.len().min(avr8js_pulses.len());
    for (name, pulses) in [("simavr", &simavr_pulses), ("avr8js", &avr8js_pulses)] {
        if let Some(extra_pulse) = pulses.get(count) {
            return Err(format!(
                "pulse {count} occurs only on {name}: {extra_pulse}"
            ));
        }
    }
    Ok(Agreement {
        count,
        offset_cycles,
        jitter_cycles: 0,
    })
}

/// Compares the bytes that the console has sent, and measures the variation of their delay.
///
/// # Errors
/// Returns a message about the first difference.
pub fn compare_console(simavr: &Outputs, avr8js: &Outputs) -> Result<Agreement, String> {
    let (Some(first_simavr), Some(first_avr8js)) =
        (simavr.sent_bytes.first(), avr8js.sent_bytes.first())
    else {
        return Err("the console sends no bytes on one simulator".into());
    };
    let offset_cycles = first_avr8js.cycle as i64 - first_simavr.cycle as i64;
    let pairs = simavr.sent_bytes.iter().zip(&avr8js.sent_bytes);
    let mut jitter_cycles = 0;
    for (index, (simavr_byte, avr8js_byte)) in pairs.enumerate() {
        if simavr_byte.value != avr8js_byte.value {
            return Err(format!(
                "byte {index} of the console, cycle {}: simavr sends {:?}, avr8js {:?}",
                simavr_byte.cycle,
                excerpt(&simavr.sent_bytes, index),
                excerpt(&avr8js.sent_bytes, index)
            ));
        }
        let cycle = avr8js_byte.cycle.saturating_add_signed(-offset_cycles);
        jitter_cycles = jitter_cycles.max(cycle.abs_diff(simavr_byte.cycle));
    }
    let count = simavr.sent_bytes.len().min(avr8js.sent_bytes.len());
    for (name, outputs) in [("simavr", simavr), ("avr8js", avr8js)] {
        if outputs.sent_bytes.len() > count {
            let text = excerpt(&outputs.sent_bytes, count);
            return Err(format!(
                "byte {count} of the console occurs only on {name}: {text:?}"
            ));
        }
    }
    Ok(Agreement {
        count,
        offset_cycles,
        jitter_cycles,
    })
}

/// Returns an excerpt of 60 bytes, about a line, that ends with byte `index`.
fn excerpt(bytes: &[SerialByte], index: usize) -> String {
    let end = bytes.len().min(index + 1);
    decode_text(&bytes[end.saturating_sub(60)..end])
}
