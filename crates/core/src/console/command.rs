//! Parses lines into commands.
//!
//! A line is one command: a command word with its arguments, or the name of a gait in `robot.toml`. A line that is not
//! completely valid is an error.

use lizard_avr::flash;

use crate::console::text::Text;
use crate::console::word::{Effect, RESERVED_COUNT, Word};
use crate::control::order::{Order, Setting};
use crate::memory::settings::Boot;
use crate::numbers::gaits::{GaitId, GaitName};
use crate::numbers::part::Servo;
use crate::numbers::robot::Robot;
use crate::numbers::units::{Angle, CENTIDEG_PER_TURN, Sweep};

/// A command whose arguments have passed the checks of syntax and range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// List the gaits and the other command words.
    Help,
    /// Print the state of the robot.
    Status,
    /// Print all settings.
    Cal,
    /// Print the pose at this interval in frames; 0 stops the reports.
    Watch(u16),
    /// Give an order to the robot.
    Order(Order),
}

/// The reason why a line is not a valid command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineError {
    /// A byte of the line was garbled.
    Garbled,
    /// The line is too long.
    TooLong,
    /// The line begins with neither a command word nor the name of a gait.
    UnknownCommand,
    /// A command that takes no argument has one.
    UnexpectedArgument,
    /// The line ends after the first words of a gait's name.
    IncompleteName,
    /// An argument is missing, malformed or superfluous; the text describes the correct arguments.
    WrongArguments(Text),
    /// An argument is out of range; the text gives the range.
    OutOfRange(Text),
    /// The angle for this servo in a `pose` command exceeds one turn.
    AngleOutOfRange(Servo),
}

/// The longest interval that `watch` accepts, in frames: 200 s.
pub const MAX_WATCH_FRAMES: u16 = 10_000;

/// The largest count of cycles that a gait's command accepts.
pub const MAX_CYCLES: u16 = 999;

/// The longest time that `deadman` accepts, in ms: one minute.
pub const MAX_DEADMAN_MS: u16 = 60_000;

/// The largest magnitude of an angle, one turn, in hundredths of a degree. A larger angle counts as a typing error.
const MAX_CENTIDEG: u16 = CENTIDEG_PER_TURN as u16;

/// The syntax of an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Syntax {
    /// A whole number in decimal digits.
    Whole,
    /// Degrees with an optional sign and at most two decimals, read as an [`Angle`].
    Degrees,
    /// A number with at most two decimals, read as hundredths.
    Hundredths,
    /// `+`, read as 1, or `-`, read as 0.
    Sign,
}

/// The form of a command's arguments: their number, syntax and range.
#[derive(Clone, Copy)]
struct ArgumentForm {
    /// True if the first argument is a servo's number.
    takes_servo: bool,
    /// The number of arguments after the servo; all of them are numbers in the same range.
    number_count: u8,
    /// The syntax of these numbers.
    syntax: Syntax,
    /// The smallest magnitude of these numbers, in hundredths unless they are whole numbers.
    min: u16,
    /// The largest magnitude of these numbers, in hundredths unless they are whole numbers.
    max: u16,
    /// The message for arguments that do not match this form.
    usage_message: Text,
    /// The message for an argument that is out of range.
    range_message: Text,
}

flash! {
    /// The forms of all commands with numbers, indexed by [`form_index`].
    const FORMS: [ArgumentForm; 8] = [
        ArgumentForm { takes_servo: false, number_count: 4, syntax: Syntax::Degrees, min: 0, max: MAX_CENTIDEG, usage_message: Text::PoseUsage, range_message: Text::Empty },
        ArgumentForm { takes_servo: false, number_count: 1, syntax: Syntax::Whole, min: 10, max: 100, usage_message: Text::SpeedUsage, range_message: Text::SpeedRange },
        ArgumentForm { takes_servo: false, number_count: 1, syntax: Syntax::Whole, min: 0, max: MAX_WATCH_FRAMES, usage_message: Text::WatchUsage, range_message: Text::WatchRange },
        ArgumentForm { takes_servo: true, number_count: 1, syntax: Syntax::Degrees, min: 0, max: 2000, usage_message: Text::TrimUsage, range_message: Text::TrimRange },
        ArgumentForm { takes_servo: true, number_count: 2, syntax: Syntax::Degrees, min: 0, max: MAX_CENTIDEG, usage_message: Text::LimitUsage, range_message: Text::LimitRange },
        ArgumentForm { takes_servo: true, number_count: 1, syntax: Syntax::Sign, min: 0, max: 1, usage_message: Text::DirUsage, range_message: Text::Empty },
        ArgumentForm { takes_servo: true, number_count: 1, syntax: Syntax::Hundredths, min: 500, max: 2000, usage_message: Text::ScaleUsage, range_message: Text::ScaleRange },
        ArgumentForm { takes_servo: false, number_count: 1, syntax: Syntax::Whole, min: 0, max: MAX_DEADMAN_MS, usage_message: Text::DeadmanUsage, range_message: Text::DeadmanRange },
    ];
}

/// Returns the index of a word's form in `FORMS`; `None` if the word takes no arguments, and for `boot`, whose argument
/// is a name.
const fn form_index(word: Word) -> Option<usize> {
    match word {
        Word::Pose => Some(0),
        Word::Speed => Some(1),
        Word::Watch => Some(2),
        Word::Trim => Some(3),
        Word::Limit => Some(4),
        Word::Dir => Some(5),
        Word::Scale => Some(6),
        Word::Deadman => Some(7),
        _ => None,
    }
}

/// Parses a line that is trimmed, not empty and in lower case.
///
/// # Errors
/// Returns the reason why the line is not a valid command.
pub fn parse(line: &[u8], robot: &Robot) -> Result<Command, LineError> {
    parse_with_priority::<RESERVED_COUNT>(line, robot)
}

/// Parses a line. A gait has priority over a word of the same name if the index of the word in [`Word::ALL`] is at
/// least `FIRST_YIELDING_INDEX`.
#[inline(never)]
fn parse_with_priority<const FIRST_YIELDING_INDEX: usize>(
    line: &[u8],
    robot: &Robot,
) -> Result<Command, LineError> {
    let mut words = Words(line);
    let word = Word::find(words.next()).filter(|word| {
        // Compiles to nothing while no word yields.
        FIRST_YIELDING_INDEX >= Word::ALL.len()
            || (*word as usize) < FIRST_YIELDING_INDEX
            || matches!(
                parse_gait(line, robot),
                Err(LineError::UnknownCommand | LineError::IncompleteName)
            )
    });
    let Some(word) = word else {
        let (gait, cycles) = parse_gait(line, robot)?;
        return Ok(Command::Order(Order::Gait(gait, cycles)));
    };
    let Arguments { servo, numbers } = match form_index(word) {
        Some(index) => Arguments::parse(word, words, &FORMS.at(index).load())?,
        None if word != Word::Boot && !words.is_exhausted() => {
            return Err(LineError::UnexpectedArgument);
        }
        None => Arguments::NONE,
    };
    let [first_number, second_number, ..] = numbers;
    let setting_order = |setting| Order::Set(servo, setting);
    Ok(Command::Order(match word {
        Word::Help | Word::QuestionMark => return Ok(Command::Help),
        Word::Status => return Ok(Command::Status),
        Word::Cal => return Ok(Command::Cal),
        Word::Watch => return Ok(Command::Watch(first_number)),
        Word::Stop => Order::Stop,
        Word::Rest => Order::Rest,
        Word::Pose => Order::Pose(numbers.map(Angle)),
        Word::Center => Order::Center,
        Word::Speed => Order::Speed(first_number as u8),
        Word::Trim => setting_order(Setting::Trim(Sweep(first_number as i16))),
        Word::Limit => setting_order(Setting::Limit(Angle(first_number), Angle(second_number))),
        Word::Dir => setting_order(Setting::Direction(first_number != 0)),
        Word::Scale => setting_order(Setting::Scale(first_number)),
        Word::Save => Order::Save,
        Word::Load => Order::Load,
        Word::Factory => Order::Factory,
        Word::Boot => Order::Boot(parse_boot(words.0.trim_ascii(), robot)?),
        Word::Deadman => Order::Deadman(first_number),
    }))
}

/// Returns the effect of a line on the servos: that of its command word, [`Effect::Motion`] for a gait, or
/// [`Effect::None`] for a line that is not a valid command.
pub fn effect(line: &str, robot: &Robot) -> Effect {
    let line = line.as_bytes();
    match parse(line, robot) {
        Err(_) => Effect::None,
        Ok(Command::Order(Order::Gait(..))) => Effect::Motion,
        Ok(_) => Word::find(Words(line).next()).map_or(Effect::None, Word::effect),
    }
}

/// Parses the argument of `boot`.
fn parse_boot(argument: &[u8], robot: &Robot) -> Result<Boot, LineError> {
    if Word::find(argument) == Some(Word::Rest) {
        return Ok(Boot::Rest);
    }
    match parse_gait(argument, robot) {
        Ok((gait, 0)) => Ok(Boot::Gait(gait)),
        _ => Err(LineError::WrongArguments(Text::BootUsage)),
    }
}

/// The arguments of a command, parsed and checked.
struct Arguments {
    /// The servo to which a setting applies.
    servo: Servo,
    /// The other arguments: whole numbers as written, numbers with decimals in hundredths, `+` as 1, `-` as 0, degrees
    /// as steps of an [`Angle`].
    numbers: [u16; 4],
}

impl Arguments {
    /// No arguments.
    const NONE: Self = Self {
        servo: Servo::A1,
        numbers: [0; 4],
    };

    /// Parses the arguments that follow `word`.
    #[inline(never)]
    fn parse(word: Word, mut words: Words, form: &ArgumentForm) -> Result<Self, LineError> {
        let usage_error = Err(LineError::WrongArguments(form.usage_message));
        let mut arguments = Self::NONE;
        if form.takes_servo {
            arguments.servo = match words.next() {
                [digit @ b'1'..=b'4'] => Servo::at(usize::from(digit - b'1')),
                _ => return usage_error,
            };
        }
        let mut out_of_range_index = None;
        for (index, number) in (0..form.number_count).zip(&mut arguments.numbers) {
            let Some((magnitude, is_negative)) = parse_number(words.next(), form.syntax) else {
                return usage_error;
            };
            *number = magnitude;
            let mut is_in_range = form.min <= magnitude && magnitude <= form.max;
            if form.syntax == Syntax::Degrees {
                let magnitude = i32::from(magnitude);
                *number = Angle::from_centideg(if is_negative { -magnitude } else { magnitude }).0;
            } else {
                is_in_range &= !is_negative;
            }
            if !is_in_range {
                out_of_range_index = out_of_range_index.or(Some(index));
            }
        }
        match out_of_range_index {
            _ if !words.is_exhausted() => usage_error,
            Some(index) if word == Word::Pose => {
                Err(LineError::AngleOutOfRange(Servo::at(usize::from(index))))
            }
            Some(_) => Err(LineError::OutOfRange(form.range_message)),
            None => Ok(arguments),
        }
    }
}

/// The rest of a line, from which words are taken one by one.
#[derive(Clone, Copy)]
struct Words<'a>(&'a [u8]);

impl<'a> Words<'a> {
    /// Takes the next word, which is empty at the end of the line.
    fn next(&mut self) -> &'a [u8] {
        let rest = self.0.trim_ascii_start();
        let length = rest
            .iter()
            .take_while(|byte| !byte.is_ascii_whitespace())
            .count();
        let (word, rest) = rest.split_at_checked(length).unwrap_or((rest, &[]));
        self.0 = rest;
        word
    }

    /// True if no word is left.
    fn is_exhausted(mut self) -> bool {
        self.next().is_empty()
    }
}

/// Finds the gait whose name begins the line. Returns the gait and the count of cycles after the name, 0 if there
/// is none. Any blanks may separate the words. If a gait's name is that of another gait followed by a number, the
/// longer name has priority.
#[inline(never)]
fn parse_gait(line: &[u8], robot: &Robot) -> Result<(GaitId, u16), LineError> {
    let line = line.trim_ascii_start();
    let mut best_result = Err(LineError::UnknownCommand);
    for id in GaitId::all(robot.gait_count()) {
        match match_gait_name(line, robot.gait_name(id)) {
            Err(LineError::UnknownCommand) => {}
            Ok(0) => return Ok((id, 0)),
            result if best_result.is_err() => best_result = result.map(|cycles| (id, cycles)),
            _ => {}
        }
    }
    best_result
}

/// Compares a line with a gait's name. Returns the count of cycles after the name, 0 if there is none. Stops at the
/// first byte that differs, because there may be many names, and a frame may be waiting.
#[inline(never)]
fn match_gait_name(line: &[u8], name: GaitName) -> Result<u16, LineError> {
    let mut rest = line;
    for byte in name {
        match rest {
            [] if byte == b' ' => return Err(LineError::IncompleteName),
            [first, ..] if byte == b' ' && first.is_ascii_whitespace() => {
                rest = rest.trim_ascii_start();
            }
            [first, tail @ ..] if *first == byte => rest = tail,
            _ => return Err(LineError::UnknownCommand),
        }
    }
    match rest {
        [] => return Ok(0),
        [first, ..] if !first.is_ascii_whitespace() => return Err(LineError::UnknownCommand),
        _ => {}
    }
    let mut words = Words(rest);
    let number = parse_number(words.next(), Syntax::Whole);
    match number {
        Some((cycles @ 1..=MAX_CYCLES, _)) if words.is_exhausted() => Ok(cycles),
        _ => Err(LineError::WrongArguments(Text::CountUsage)),
    }
}

/// The number of decimals in hundredths.
const DECIMAL_COUNT: u8 = 2;

/// Parses a word as a number: returns its magnitude and true for a minus sign, or `None` if the word does not have this
/// syntax. A magnitude of 65530 or more becomes 65535.
#[inline(never)]
fn parse_number(word: &[u8], syntax: Syntax) -> Option<(u16, bool)> {
    let (mut sign, mut digits) = (b'+', word);
    if syntax != Syntax::Whole
        && let [first @ (b'+' | b'-'), rest @ ..] = word
    {
        (sign, digits) = (*first, rest);
    }
    let is_negative = sign == b'-';
    if syntax == Syntax::Sign {
        return (word.len() == 1 && digits.is_empty()).then_some((u16::from(!is_negative), false));
    }
    let mut magnitude = None;
    let mut decimal_count = None;
    for byte in digits {
        match byte {
            b'0'..=b'9' => magnitude = Some(append_digit(magnitude.unwrap_or(0), byte - b'0')),
            b'.' if syntax != Syntax::Whole && magnitude.is_some() && decimal_count.is_none() => {
                decimal_count = Some(0);
                continue;
            }
            _ => return None,
        }
        if let Some(decimal_count) = &mut decimal_count {
            *decimal_count += 1;
        }
    }
    let mut magnitude = magnitude?;
    if syntax != Syntax::Whole {
        // Zeros in place of the missing decimals.
        for _ in 0..DECIMAL_COUNT.checked_sub(decimal_count.unwrap_or(0))? {
            magnitude = append_digit(magnitude, 0);
        }
    }
    Some((magnitude, is_negative))
}

/// Appends a decimal digit to a number; returns 65535 if the result is 65530 or more.
#[inline(never)]
fn append_digit(number: u16, digit: u8) -> u16 {
    // 6553 followed by a digit from 6 to 9 exceeds sixteen bits.
    if number < 6553 {
        number * 10 + u16::from(digit)
    } else {
        u16::MAX
    }
}

#[cfg(test)]
mod tests;
