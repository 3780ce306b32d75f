//! Parses lines into commands.
//!
//! A line is one command: a word of the console, or the name of a gait in `robot.toml`.
//! This module only parses. A line that is not understood completely is an error and
//! changes nothing.

use lizard_avr::flash;

use crate::console::text::Text;
use crate::console::word::{Effect, RESERVED, Word};
use crate::control::order::{Order, Setting};
use crate::memory::settings::Boot;
use crate::numbers::gaits::{GaitId, Name};
use crate::numbers::part::Servo;
use crate::numbers::robot::Robot;
use crate::numbers::units::{Angle, Sweep, TURN_CENTIDEG};

/// A command whose arguments have passed the checks of syntax and range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// List the gaits and the words of the other commands.
    Help,
    /// Print the state of the robot.
    Status,
    /// Print all settings.
    Cal,
    /// Print the pose once every this many frames; 0 ends the reports.
    Watch(u16),
    /// An order to the robot.
    Order(Order),
}

/// The reason why a line is not a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misread {
    /// A byte of the line was garbled.
    Garbled,
    /// The line is too long.
    TooLong,
    /// The first word is not a command.
    UnknownCommand,
    /// A command that takes no argument has one.
    UnexpectedArgument,
    /// The first words of a gait's name, without the others.
    IncompleteName,
    /// An argument is missing, malformed or superfluous; the message describes the correct
    /// arguments.
    WrongArguments(Text),
    /// An argument is out of range; the message gives the range.
    OutOfRange(Text),
    /// The angle of this servo is more than a turn.
    AngleOutOfRange(Servo),
}

/// The longest interval of `watch`, frames: 200 s.
pub const MAX_WATCH_FRAMES: u16 = 10_000;

/// The largest count of cycles that a gait accepts.
pub const MAX_CYCLES: u16 = 999;

/// The longest time that `deadman` allows, ms: a minute.
pub const MAX_DEADMAN_MS: u16 = 60_000;

/// The largest angle: one turn in either direction. A larger one counts as a mistake.
const MAX_CENTIDEG: u16 = TURN_CENTIDEG as u16;

/// The syntax of an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Syntax {
    /// A whole number in decimal digits.
    Whole,
    /// Degrees with a sign and at most two decimals, read as an [`Angle`].
    Degrees,
    /// A number with at most two decimals, read as hundredths.
    Hundredths,
    /// `+`, read as 1, or `-`, read as 0.
    Sign,
}

/// The arguments of a command.
#[derive(Clone, Copy)]
struct Form {
    /// True if the first argument is a servo's number.
    takes_servo: bool,
    /// The number of arguments, without the servo.
    count: u8,
    /// The syntax of each argument except the servo.
    syntax: Syntax,
    /// The smallest and the largest magnitude of each argument except the servo.
    min: u16,
    max: u16,
    /// The message for arguments that do not match this form.
    usage: Text,
    /// The message for an argument out of range.
    range: Text,
}

flash! {
    /// All forms, in the order of [`form_index`].
    const FORMS: [Form; 8] = [
        Form { takes_servo: false, count: 4, syntax: Syntax::Degrees, min: 0, max: MAX_CENTIDEG, usage: Text::PoseWants, range: Text::Nothing },
        Form { takes_servo: false, count: 1, syntax: Syntax::Whole, min: 10, max: 100, usage: Text::SpeedWants, range: Text::SpeedRange },
        Form { takes_servo: false, count: 1, syntax: Syntax::Whole, min: 0, max: MAX_WATCH_FRAMES, usage: Text::WatchWants, range: Text::WatchRange },
        Form { takes_servo: true, count: 1, syntax: Syntax::Degrees, min: 0, max: 2000, usage: Text::TrimWants, range: Text::TrimRange },
        Form { takes_servo: true, count: 2, syntax: Syntax::Degrees, min: 0, max: MAX_CENTIDEG, usage: Text::LimitWants, range: Text::LimitRange },
        Form { takes_servo: true, count: 1, syntax: Syntax::Sign, min: 0, max: 1, usage: Text::DirWants, range: Text::Nothing },
        Form { takes_servo: true, count: 1, syntax: Syntax::Hundredths, min: 500, max: 2000, usage: Text::ScaleWants, range: Text::ScaleRange },
        Form { takes_servo: false, count: 1, syntax: Syntax::Whole, min: 0, max: MAX_DEADMAN_MS, usage: Text::DeadmanWants, range: Text::DeadmanRange },
    ];
}

/// The index into `FORMS` for a command that takes arguments.
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

/// Reads a line that is trimmed, not empty and in lower case.
///
/// # Errors
/// Returns the reason why the line is not a command.
pub fn parse(line: &[u8], robot: &Robot) -> Result<Command, Misread> {
    parse_among::<RESERVED>(line, robot)
}

/// Parses a line; a gait has priority over a word of the same name whose number is
/// `FIRST_YIELDING` or more.
#[inline(never)]
fn parse_among<const FIRST_YIELDING: usize>(
    line: &[u8],
    robot: &Robot,
) -> Result<Command, Misread> {
    let mut words = Words(line);
    let word = Word::find(words.next()).filter(|word| {
        // Costs no instruction as long as no word yields.
        FIRST_YIELDING >= Word::ALL.len()
            || (*word as usize) < FIRST_YIELDING
            || matches!(
                parse_gait(line, robot),
                Err(Misread::UnknownCommand | Misread::IncompleteName)
            )
    });
    let Some(word) = word else {
        let (gait, cycles) = parse_gait(line, robot)?;
        return Ok(Command::Order(Order::Gait(gait, cycles)));
    };
    let Arguments { servo, numbers } = match form_index(word) {
        Some(index) => Arguments::read(word, words, &FORMS.at(index).load())?,
        None if word != Word::Boot && !words.is_done() => return Err(Misread::UnexpectedArgument),
        None => Arguments::NONE,
    };
    let [number, second, ..] = numbers;
    let order_of = |setting| Order::Set(servo, setting);
    Ok(Command::Order(match word {
        Word::Help | Word::QuestionMark => return Ok(Command::Help),
        Word::Status => return Ok(Command::Status),
        Word::Cal => return Ok(Command::Cal),
        Word::Watch => return Ok(Command::Watch(number)),
        Word::Stop => Order::Stop,
        Word::Rest => Order::Rest,
        Word::Pose => Order::Pose(numbers.map(Angle)),
        Word::Center => Order::Center,
        Word::Speed => Order::Speed(number as u8),
        Word::Trim => order_of(Setting::Trim(Sweep(number as i16))),
        Word::Limit => order_of(Setting::Limit(Angle(number), Angle(second))),
        Word::Dir => order_of(Setting::Direction(number != 0)),
        Word::Scale => order_of(Setting::Scale(number)),
        Word::Save => Order::Save,
        Word::Load => Order::Load,
        Word::Factory => Order::Factory,
        Word::Boot => Order::Boot(parse_boot(words.0.trim_ascii(), robot)?),
        Word::Deadman => Order::Deadman(number),
    }))
}

/// The effect of a line on the servos: the effect of its word; [`Effect::Moves`] for a gait;
/// [`Effect::None`] for a line that is not a command.
pub fn effect(line: &str, robot: &Robot) -> Effect {
    let line = line.as_bytes();
    match parse(line, robot) {
        Err(_) => Effect::None,
        Ok(Command::Order(Order::Gait(..))) => Effect::Moves,
        Ok(_) => Word::find(Words(line).next()).map_or(Effect::None, Word::effect),
    }
}

/// Reads the argument of `boot`.
fn parse_boot(argument: &[u8], robot: &Robot) -> Result<Boot, Misread> {
    if Word::find(argument) == Some(Word::Rest) {
        return Ok(Boot::Rest);
    }
    match parse_gait(argument, robot) {
        Ok((gait, 0)) => Ok(Boot::Gait(gait)),
        _ => Err(Misread::WrongArguments(Text::BootWants)),
    }
}

/// The arguments of a command, read and checked.
struct Arguments {
    /// The servo that is to be set.
    servo: Servo,
    /// The numbers: percentages, frames, milliseconds and hundredths unchanged; `+` as 1 and
    /// `-` as 0; degrees as an [`Angle`].
    numbers: [u16; 4],
}

impl Arguments {
    /// No arguments.
    const NONE: Self = Self {
        servo: Servo::A1,
        numbers: [0; 4],
    };

    /// Reads the arguments that follow `word`.
    #[inline(never)]
    fn read(word: Word, mut words: Words, form: &Form) -> Result<Self, Misread> {
        let usage_error = Err(Misread::WrongArguments(form.usage));
        let mut arguments = Self::NONE;
        if form.takes_servo {
            arguments.servo = match words.next() {
                [digit @ b'1'..=b'4'] => Servo::at(usize::from(digit - b'1')),
                _ => return usage_error,
            };
        }
        let mut wrong_index = None;
        for (index, number) in (0..form.count).zip(&mut arguments.numbers) {
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
                wrong_index = wrong_index.or(Some(index));
            }
        }
        match wrong_index {
            _ if !words.is_done() => usage_error,
            Some(index) if word == Word::Pose => {
                Err(Misread::AngleOutOfRange(Servo::at(usize::from(index))))
            }
            Some(_) => Err(Misread::OutOfRange(form.range)),
            None => Ok(arguments),
        }
    }
}

/// The rest of a line, split into words one by one.
#[derive(Clone, Copy)]
struct Words<'a>(&'a [u8]);

impl<'a> Words<'a> {
    /// The next word; empty at the end of the line.
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

    fn is_done(mut self) -> bool {
        self.next().is_empty()
    }
}

/// Finds the gait whose name begins the line, and reads the number of cycles after the name; 0 if there is none.
/// Any blanks between words are accepted. If a gait's name is that of another gait and a number, the longer name
/// has priority.
#[inline(never)]
fn parse_gait(line: &[u8], robot: &Robot) -> Result<(GaitId, u16), Misread> {
    let line = line.trim_ascii_start();
    let mut parsed = Err(Misread::UnknownCommand);
    for id in GaitId::all(robot.gait_count()) {
        match match_gait_name(line, robot.name(id)) {
            Err(Misread::UnknownCommand) => {}
            Ok(0) => return Ok((id, 0)),
            result if parsed.is_err() => parsed = result.map(|cycles| (id, cycles)),
            _ => {}
        }
    }
    parsed
}

/// Compares a line with a name, and reads the number of cycles after the name; 0 if there is none.
/// Stops at the first byte that differs: there may be many names, and a frame may be due.
#[inline(never)]
fn match_gait_name(line: &[u8], name: Name) -> Result<u16, Misread> {
    let mut rest = line;
    for byte in name {
        match rest {
            [] if byte == b' ' => return Err(Misread::IncompleteName),
            [first, ..] if byte == b' ' && first.is_ascii_whitespace() => {
                rest = rest.trim_ascii_start();
            }
            [first, tail @ ..] if *first == byte => rest = tail,
            _ => return Err(Misread::UnknownCommand),
        }
    }
    match rest {
        [] => return Ok(0),
        [first, ..] if !first.is_ascii_whitespace() => return Err(Misread::UnknownCommand),
        _ => {}
    }
    let mut words = Words(rest);
    let number = parse_number(words.next(), Syntax::Whole);
    match number {
        Some((cycles @ 1..=MAX_CYCLES, _)) if words.is_done() => Ok(cycles),
        _ => Err(Misread::WrongArguments(Text::CountWants)),
    }
}

/// Number of decimals of hundredths.
const DECIMALS: u8 = 2;

/// Reads a word as a magnitude and a bool that is true for a minus sign. A magnitude of more than
/// sixteen bits becomes 65535. Returns `None` if the word does not have this syntax.
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
    let mut decimals = None;
    for byte in digits {
        match byte {
            b'0'..=b'9' => magnitude = Some(append_digit(magnitude.unwrap_or(0), byte - b'0')),
            b'.' if syntax != Syntax::Whole && magnitude.is_some() && decimals.is_none() => {
                decimals = Some(0);
                continue;
            }
            _ => return None,
        }
        if let Some(decimals) = &mut decimals {
            *decimals += 1;
        }
    }
    let mut magnitude = magnitude?;
    if syntax != Syntax::Whole {
        // Zeros in place of the missing decimals.
        for _ in 0..DECIMALS.checked_sub(decimals.unwrap_or(0))? {
            magnitude = append_digit(magnitude, 0);
        }
    }
    Some((magnitude, is_negative))
}

/// Appends a digit to a number; saturates at 65535.
#[inline(never)]
fn append_digit(number: u16, digit: u8) -> u16 {
    // 6553 followed by a digit may exceed sixteen bits.
    if number < 6553 {
        number * 10 + u16::from(digit)
    } else {
        u16::MAX
    }
}

#[cfg(test)]
mod tests;
