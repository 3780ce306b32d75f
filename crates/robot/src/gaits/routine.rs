//! Routines of robot.toml: sequences of gaits, rests and waits for a contact. Each gait lasts for a number of cycles,
//! for a time, or until a contact closes.

use lizard_core::console::command::MAX_CYCLES;
use lizard_core::numbers::gaits::{Gait as GaitRecord, MAX_GAITS, Step};

use crate::config::{INPUT_NAMES, Inputs};
use crate::file::{Error, ReadResult, Table, suggest};
use crate::gaits::define::{check_boot_keys, check_name};
use crate::gaits::to_command;
use crate::units::FRAMES_PER_SECOND;

/// The largest number of steps of a routine.
const MAX_STEPS: usize = 99;

/// The longest time of a step, s.
const MAX_STEP_SECONDS: f64 = 999.0;

/// The value of `repeat` for a routine that never ends.
const FOR_EVER: &str = "for ever";

/// A routine, all of whose steps have been checked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Routine {
    name: String,
    /// See [`Routine::step_records`].
    step_records: Vec<Step>,
    /// The number of rounds; 0 if the routine repeats for ever.
    round_count: u16,
    /// The index of the step record at which each round except the first starts.
    repeat_record_index: u16,
}

impl Routine {
    /// The routine's name in robot.toml.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The console command that starts the routine.
    pub fn command(&self) -> String {
        to_command(&self.name)
    }

    /// The routine's step records in the flash section: one for each step. If an input ends a step, a record of the
    /// input precedes the step's record.
    pub fn step_records(&self) -> &[Step] {
        &self.step_records
    }

    /// The number of steps.
    pub fn step_count(&self) -> usize {
        let is_step = |record: &&Step| record.kind != Step::UNTIL;
        self.step_records.iter().filter(is_step).count()
    }

    /// True if an input may end one of the routine's steps.
    pub fn has_inputs(&self) -> bool {
        self.step_count() < self.step_records.len()
    }

    /// The number of rounds; `None` if the routine repeats for ever.
    pub fn round_count(&self) -> Option<u16> {
        (self.round_count > 0).then_some(self.round_count)
    }

    /// Creates the routine's record in the flash section. `first_record_index` is the index of the first step record
    /// among the step records of all routines; `name_start` is the index at which the name starts in the table of
    /// names.
    pub(crate) fn to_record(&self, first_record_index: usize, name_start: usize) -> GaitRecord {
        let mut record = GaitRecord {
            name_start: name_start as u16,
            name_length: self.name.len() as u16,
            ..GaitRecord::routine(
                first_record_index as u16,
                self.step_records.len() as u16,
                self.round_count,
            )
        };
        record.channels[3].offset = self.repeat_record_index;
        record
    }
}

/// Reads the routines of a robot with these gaits and inputs, in the order of the file.
pub(crate) fn read_routines(
    root: &Table,
    gaits: &[&str],
    inputs: &Inputs,
) -> ReadResult<Vec<Routine>> {
    let table = root.optional_unchecked_table("routine")?;
    let names = table.key_names();
    for name in &names {
        check_name(name, "routine").map_err(|problem| table.error(name, problem))?;
        if gaits.contains(name) {
            return Err(table.error(name, "has the name of a gait; choose another name"));
        }
    }
    let all_names: Vec<&str> = gaits.iter().chain(&names).copied().collect();
    check_boot_keys(&table, &all_names)?;
    if all_names.len() > MAX_GAITS {
        let count = all_names.len();
        let message = format!(
            "and gait have {count} entries together; the firmware supports at most {MAX_GAITS}"
        );
        return Err(Error::new("routine", message));
    }
    let known = KnownNames {
        gaits,
        routines: &names,
        inputs,
    };
    let read_named_routine = |name: &&str| read_routine(&table, name, &known);
    names.iter().map(read_named_routine).collect()
}

/// The names by which a step is understood: gaits and inputs, which it may contain, and routines, which it must not.
struct KnownNames<'a> {
    gaits: &'a [&'a str],
    routines: &'a [&'a str],
    inputs: &'a Inputs,
}

/// Reads the routine with this name.
fn read_routine(routines: &Table, name: &str, known: &KnownNames) -> ReadResult<Routine> {
    let table = routines.table(name, &["steps", "repeat", "repeat_from"])?;
    let step_texts = table.strings("steps")?;
    if step_texts.is_empty() || step_texts.len() > MAX_STEPS {
        let count = step_texts.len();
        let message = format!("has {count} steps; it must have between 1 and {MAX_STEPS}");
        return Err(table.error("steps", message));
    }
    let parse_step_text = |(index, text): (usize, &&str)| {
        let step_error = |problem| {
            let message = format!("step {}, \"{text}\", {problem}", index + 1);
            Error::with_own_subject(table.full_key("steps"), message)
        };
        parse_records(text, name, known).map_err(step_error)
    };
    let steps = step_texts.iter().enumerate().map(parse_step_text);
    let steps = steps.collect::<ReadResult<Vec<_>>>()?;
    let unit = "(a step)";
    let first_repeated_step =
        table.number_or("repeat_from", 1.0, (1.0, steps.len() as f64), unit)?;
    if first_repeated_step.fract() != 0.0 {
        let message = format!("is {first_repeated_step}; it must be the number of a step");
        return Err(table.error("repeat_from", message));
    }
    Ok(Routine {
        name: name.to_string(),
        repeat_record_index: steps[..first_repeated_step as usize - 1].concat().len() as u16,
        step_records: steps.concat(),
        round_count: read_round_count(&table)?,
    })
}

/// Reads the number of rounds; 0 if the routine repeats for ever.
fn read_round_count(table: &Table) -> ReadResult<u16> {
    if table.text("repeat").is_ok_and(|text| text == FOR_EVER) {
        return Ok(0);
    }
    let max = f64::from(MAX_CYCLES);
    let unit = format!("or \"{FOR_EVER}\"");
    let round_count = table.number_or("repeat", 1.0, (1.0, max), &unit)?;
    if round_count.fract() != 0.0 {
        let message = format!("is {round_count}; it must be a whole number {unit}");
        return Err(table.error("repeat", message));
    }
    Ok(round_count as u16)
}

/// Parses a step with its input, such as `wait button` or `walk 10 until nose`, as one or two records.
fn parse_records(text: &str, own_name: &str, known: &KnownNames) -> Result<Vec<Step>, String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let until_record = |name: &str| match known.inputs.find_input(name) {
        Some(input) => Ok(Step {
            kind: Step::UNTIL,
            gait: input.byte(),
            count: 0,
        }),
        None => Err(format_missing_input(name)),
    };
    match words.as_slice() {
        ["wait"] => Err("must name an input, for example \"wait button\"".to_string()),
        ["wait", name] if name.parse::<f64>().is_err() => {
            let wait = Step {
                kind: Step::WAIT,
                gait: 0,
                count: Step::ENDLESS,
            };
            Ok(vec![until_record(name)?, wait])
        }
        [.., "until"] => {
            Err("must name an input after until, for example \"walk until nose\"".to_string())
        }
        [words @ .., "until", name] if !words.is_empty() => Ok(vec![
            until_record(name)?,
            parse_step(words, own_name, known, true)?,
        ]),
        words => Ok(vec![parse_step(words, own_name, known, false)?]),
    }
}

/// Formats the message about a step with an input that robot.toml does not define.
fn format_missing_input(name: &str) -> String {
    if INPUT_NAMES.contains(&name) {
        return format!(
            "names the input \"{name}\", which has no pin; set one in [input.{name}], for example pin = \"A1\""
        );
    }
    let suggestion = suggest(name, &INPUT_NAMES);
    format!("names the input \"{name}\", which does not exist; {suggestion}")
}

/// Parses a step such as `walk 4`, `stand 1 s`, `rest` or `rest 2.5 s`. A step that an input ends needs neither a
/// number nor a time.
fn parse_step(
    words: &[&str],
    own_name: &str,
    known: &KnownNames,
    has_input: bool,
) -> Result<Step, String> {
    let (name_words, frames, cycles) = match words {
        [name_words @ .., time, "s"] => (name_words, Some(parse_frames(time)?), None),
        [name_words @ .., count] if count.parse::<f64>().is_ok() => {
            (name_words, None, Some(*count))
        }
        name_words => (name_words, None, None),
    };
    if name_words == ["rest"] && cycles.is_none() {
        let default_count = if has_input { Step::ENDLESS } else { 1 };
        return Ok(Step {
            kind: Step::REST,
            gait: 0,
            count: frames.unwrap_or(default_count),
        });
    }
    let name = name_words.join("-");
    let Some(gait) = known.gaits.iter().position(|gait| *gait == name) else {
        return Err(if name == own_name {
            "is the routine itself, which would never end".to_string()
        } else if known.routines.contains(&&*name) {
            "is a routine; a step must be a gait".to_string()
        } else {
            let suggestion = suggest(&name, known.gaits);
            format!("names the gait \"{name}\", which does not exist; {suggestion}")
        });
    };
    let gait = gait as u8;
    let endless_count = (has_input && cycles.is_none()).then_some(Step::ENDLESS);
    if let Some(count) = frames.or(endless_count) {
        let kind = Step::FRAMES;
        return Ok(Step { kind, gait, count });
    }
    let kind = Step::CYCLES;
    match cycles.unwrap_or_default().parse() {
        Ok(count @ 1..=MAX_CYCLES) => Ok(Step { kind, gait, count }),
        _ => Err(format!(
            "needs a length: 1 to {MAX_CYCLES} cycles, for example \"{name} 3\", or a time, for example \"{name} 2 s\""
        )),
    }
}

/// Parses the time of a step, s, and converts it to frames.
fn parse_frames(time: &str) -> Result<u16, String> {
    let seconds: f64 = time.parse().unwrap_or(f64::NAN);
    let min = 1.0 / FRAMES_PER_SECOND;
    if (min..=MAX_STEP_SECONDS).contains(&seconds) {
        Ok((seconds * FRAMES_PER_SECOND).round() as u16)
    } else {
        Err(format!(
            "has a time that is not between {min} and {MAX_STEP_SECONDS} s"
        ))
    }
}
