//! Lines into commands.
//!
//! A line is one command: a word of the console, or the name of a gait in
//! `robot.toml`. Nothing here acts; a line that is not wholly understood is an
//! error and changes nothing.

use crate::gait::{GaitId, Name};
use crate::part::Servo;
use crate::robot::Robot;
use crate::text::Text;
use crate::units::{Angle, TURN_CENTIDEG};

/// A command, with its arguments checked as far as syntax and range go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// List the commands.
    Help,
    /// Begin a gait; `stand` is one.
    Gait(GaitId),
    /// Freeze.
    Stop,
    /// End the pulses.
    Rest,
    /// Pace of gaits in percent, 10..=100.
    Speed(u8),
    /// Go to chassis angles, A1 to A4.
    Pose([Angle; 4]),
    /// Print the state.
    Status,
    /// Report the pose every so many frames; 0 ends it.
    Watch(u16),
}

/// Why a line is no command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misread {
    /// The first word is no command.
    Unknown,
    /// A command that takes no argument has one.
    Surplus,
    /// The first words of a gait's name, without the others.
    Incomplete,
    /// `speed` wants one whole number.
    SpeedWants,
    /// `speed` must be 10..=100.
    SpeedRange,
    /// `watch` wants one whole number.
    WatchWants,
    /// `watch` must be at most 10000.
    WatchRange,
    /// `pose` wants four angles of at most two decimals.
    PoseWants,
    /// The angle of this servo is more than a turn.
    PoseRange(Servo),
}

/// The rarest report: every 200 s.
pub const WATCH_MOST: u16 = 10_000;

/// Larger angles are taken for mistakes; a turn either way is enough.
const LARGEST_ANGLE: i32 = TURN_CENTIDEG;

/// The words that the console takes for its own; no gait's name may begin with
/// one.
pub const WORDS: [Text; 8] = [
    Text::Help,
    Text::QuestionMark,
    Text::Stop,
    Text::Rest,
    Text::Status,
    Text::Pose,
    Text::Speed,
    Text::Watch,
];

/// Reads a line that is trimmed, not empty and in lower case.
///
/// # Errors
/// What keeps the line from being a command.
pub fn parse<R: Robot>(line: &[u8], robot: &R) -> Result<Command, Misread> {
    let mut words = Words(line);
    let first = words.next();
    let is = |text: Text| text.is(first);
    let alone = if is(Text::Help) || is(Text::QuestionMark) {
        Command::Help
    } else if is(Text::Stop) {
        Command::Stop
    } else if is(Text::Rest) {
        Command::Rest
    } else if is(Text::Status) {
        Command::Status
    } else if is(Text::Pose) {
        return pose(words);
    } else if is(Text::Speed) {
        return match whole(words).ok_or(Misread::SpeedWants)? {
            percent @ 10..=100 => Ok(Command::Speed(percent as u8)),
            _ => Err(Misread::SpeedRange),
        };
    } else if is(Text::Watch) {
        return match whole(words).ok_or(Misread::WatchWants)? {
            frames @ 0..=WATCH_MOST => Ok(Command::Watch(frames)),
            _ => Err(Misread::WatchRange),
        };
    } else {
        return gait(line, robot);
    };
    if words.is_done() {
        Ok(alone)
    } else {
        Err(Misread::Surplus)
    }
}

/// What is left of a line, to be taken word by word.
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

fn pose(mut words: Words) -> Result<Command, Misread> {
    let mut angles = [Angle(0); 4];
    let mut beyond = None;
    for (place, angle) in angles.iter_mut().enumerate() {
        let centideg = centideg(words.next()).ok_or(Misread::PoseWants)?;
        if centideg.abs() > LARGEST_ANGLE {
            beyond = beyond.or(Some(Servo::at(place)));
        } else {
            *angle = Angle::from_centideg(centideg);
        }
    }
    match beyond {
        _ if !words.is_done() => Err(Misread::PoseWants),
        Some(servo) => Err(Misread::PoseRange(servo)),
        None => Ok(Command::Pose(angles)),
    }
}

/// A gait's name, or what is wrong with it. Any blanks between words will do.
fn gait<R: Robot>(line: &[u8], robot: &R) -> Result<Command, Misread> {
    let mut misread = Misread::Unknown;
    for id in GaitId::all(robot.gaits().len()) {
        match compare(Words(line), robot.name(id)) {
            Some(Misread::Unknown) => {}
            Some(other) => misread = other,
            None => return Ok(Command::Gait(id)),
        }
    }
    Err(misread)
}

/// What keeps the words of a line from being a name.
fn compare(mut words: Words, name: Name) -> Option<Misread> {
    let mut word = words.next();
    for byte in name {
        match word {
            [] if byte == b' ' => {
                word = words.next();
                if word.is_empty() {
                    return Some(Misread::Incomplete);
                }
            }
            [first, rest @ ..] if *first == byte => word = rest,
            _ => return Some(Misread::Unknown),
        }
    }
    if !word.is_empty() {
        Some(Misread::Unknown)
    } else if words.is_done() {
        None
    } else {
        Some(Misread::Surplus)
    }
}

/// The one whole number that is all there is; 65535 stands for more than that.
fn whole(mut words: Words) -> Option<u16> {
    let (digits, rest) = number(words.next());
    if rest.is_empty() && words.is_done() {
        digits
    } else {
        None
    }
}

/// An angle with at most two decimals, in hundredths.
fn centideg(word: &[u8]) -> Option<i32> {
    let (negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    let (degrees, rest) = number(digits);
    let (tenths, hundredths) = match rest {
        [] | [b'.'] => (0, 0),
        [b'.', tenths] => (digit(*tenths)?, 0),
        [b'.', tenths, hundredths] => (digit(*tenths)?, digit(*hundredths)?),
        _ => return None,
    };
    let size = i32::from(degrees?) * 100 + i32::from(tenths * 10 + hundredths);
    Some(if negative { -size } else { size })
}

/// Leading digits as a number, saturating, and what follows them.
fn number(word: &[u8]) -> (Option<u16>, &[u8]) {
    let (mut value, mut rest) = (None, word);
    while let [first, others @ ..] = rest
        && let Some(digit) = digit(*first)
    {
        let so_far = value.unwrap_or(0);
        // 6553 and one more digit is where sixteen bits may end.
        value = Some(if so_far < 6553 {
            so_far * 10 + digit
        } else {
            u16::MAX
        });
        rest = others;
    }
    (value, rest)
}

fn digit(byte: u8) -> Option<u16> {
    byte.is_ascii_digit().then(|| u16::from(byte - b'0'))
}

#[cfg(test)]
mod tests;
