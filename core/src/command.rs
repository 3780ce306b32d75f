//! Lines into commands.
//!
//! A line is one command: a word of the console, or the name of a gait in
//! `robot.toml`. Nothing here acts; a line that is not wholly understood is an
//! error and changes nothing.

use lizard_avr::flash;

use crate::gait::{GaitId, Name};
use crate::part::Servo;
use crate::robot::Robot;
use crate::settings::Boot;
use crate::text::Text;
use crate::units::{Angle, Sweep, TURN_CENTIDEG};

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
    /// Set something of a servo.
    Adjust(Servo, Change),
    /// Print all that is set.
    Cal,
    /// Go to where every servo has its neutral pulse, trims left out.
    Center,
    /// Keep what is set in the EEPROM.
    Save,
    /// Take what the EEPROM keeps.
    Load,
    /// Take what robot.toml says.
    Factory,
    /// What to do after power-on.
    Boot(Boot),
    /// Milliseconds without a line after which a gait ends; 0 for never.
    Deadman(u16),
}

/// What is set of a servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// How far its horn is to turn from where it sits.
    Trim(Sweep),
    /// The chassis angles at which its travel ends, clockwise and counter-clockwise.
    Limit([Angle; 2]),
    /// Whether a longer pulse turns it counter-clockwise.
    Dir(bool),
    /// Hundredths of a microsecond per degree, 500..=2000.
    Scale(u16),
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
    /// An argument is missing, malformed or too much: the sentence says what is
    /// wanted.
    Wants(Text),
    /// An argument is out of the range that the sentence tells.
    Range(Text),
    /// The angle of this servo is more than a turn.
    PoseRange(Servo),
}

/// The rarest report: every 200 s.
pub const WATCH_MOST: u16 = 10_000;

/// The longest silence that `deadman` bears, a minute.
pub const DEADMAN_MOST: u16 = 60_000;

/// Larger angles are taken for mistakes; a turn either way is enough.
const LARGEST_ANGLE: i32 = TURN_CENTIDEG;

flash! {
    /// The words that the console takes for its own; no gait's name may begin with
    /// one.
    pub const WORDS: [Text; 19] = [
        Text::Help,
        Text::QuestionMark,
        Text::Stop,
        Text::Rest,
        Text::Status,
        Text::Pose,
        Text::Speed,
        Text::Watch,
        Text::Trim,
        Text::Limit,
        Text::Dir,
        Text::Scale,
        Text::Cal,
        Text::Center,
        Text::Save,
        Text::Load,
        Text::Factory,
        Text::Boot,
        Text::Deadman,
    ];
}

/// One of [`WORDS`].
pub fn own_word(word: &[u8]) -> Option<Text> {
    (0..WORDS.as_slice().len())
        .map(|place| WORDS.at(place).load())
        .find(|text| text.is(word))
}

/// Reads a line that is trimmed, not empty and in lower case.
///
/// # Errors
/// What keeps the line from being a command.
pub fn parse<R: Robot>(line: &[u8], robot: &R) -> Result<Command, Misread> {
    let mut words = Words(line);
    let Some(word) = own_word(words.next()) else {
        return gait(line, robot);
    };
    let alone = match word {
        Text::Stop => Command::Stop,
        Text::Rest => Command::Rest,
        Text::Status => Command::Status,
        Text::Cal => Command::Cal,
        Text::Center => Command::Center,
        Text::Save => Command::Save,
        Text::Load => Command::Load,
        Text::Factory => Command::Factory,
        Text::Pose => return pose(words),
        Text::Trim => return adjust(words, word, Text::TrimWants),
        Text::Limit => return adjust(words, word, Text::LimitWants),
        Text::Dir => return adjust(words, word, Text::DirWants),
        Text::Scale => return adjust(words, word, Text::ScaleWants),
        Text::Boot => return boot(words, robot),
        Text::Speed => {
            return match whole(words).ok_or(Misread::Wants(Text::SpeedWants))? {
                percent @ 10..=100 => Ok(Command::Speed(percent as u8)),
                _ => Err(Misread::Range(Text::SpeedRange)),
            };
        }
        Text::Watch => {
            return match whole(words).ok_or(Misread::Wants(Text::WatchWants))? {
                frames @ 0..=WATCH_MOST => Ok(Command::Watch(frames)),
                _ => Err(Misread::Range(Text::WatchRange)),
            };
        }
        Text::Deadman => {
            return match whole(words).ok_or(Misread::Wants(Text::DeadmanWants))? {
                ms @ 0..=DEADMAN_MOST => Ok(Command::Deadman(ms)),
                _ => Err(Misread::Range(Text::DeadmanRange)),
            };
        }
        // Help and the question mark.
        _ => Command::Help,
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
        let centideg = centideg(words.next()).ok_or(Misread::Wants(Text::PoseWants))?;
        if centideg.abs() > LARGEST_ANGLE {
            beyond = beyond.or(Some(Servo::at(place)));
        } else {
            *angle = Angle::from_centideg(centideg);
        }
    }
    match beyond {
        _ if !words.is_done() => Err(Misread::Wants(Text::PoseWants)),
        Some(servo) => Err(Misread::PoseRange(servo)),
        None => Ok(Command::Pose(angles)),
    }
}

/// A servo's number, then what `word` sets of it; anything else is what `wants`
/// says.
fn adjust(mut words: Words, word: Text, wants: Text) -> Result<Command, Misread> {
    let servo = match words.next() {
        [digit @ b'1'..=b'4'] => Servo::at(usize::from(digit - b'1')),
        _ => return Err(Misread::Wants(wants)),
    };
    let change = match word {
        Text::Trim => trim(&mut words),
        Text::Limit => limit(&mut words),
        Text::Dir => dir(&mut words),
        _ => scale(&mut words),
    };
    if words.is_done() {
        Ok(Command::Adjust(servo, change?))
    } else {
        Err(Misread::Wants(wants))
    }
}

fn trim(words: &mut Words) -> Result<Change, Misread> {
    match centideg(words.next()).ok_or(Misread::Wants(Text::TrimWants))? {
        angle @ -2000..=2000 => Ok(Change::Trim(Sweep(Angle::from_centideg(angle).0 as i16))),
        _ => Err(Misread::Range(Text::TrimRange)),
    }
}

fn limit(words: &mut Words) -> Result<Change, Misread> {
    let mut ends = [Angle(0); 2];
    let mut within = true;
    for end in &mut ends {
        let angle = centideg(words.next()).ok_or(Misread::Wants(Text::LimitWants))?;
        within &= angle.abs() <= LARGEST_ANGLE;
        *end = Angle::from_centideg(angle);
    }
    if within {
        Ok(Change::Limit(ends))
    } else {
        Err(Misread::Range(Text::LimitRange))
    }
}

#[inline(never)]
fn dir(words: &mut Words) -> Result<Change, Misread> {
    match words.next() {
        b"+" => Ok(Change::Dir(true)),
        b"-" => Ok(Change::Dir(false)),
        _ => Err(Misread::Wants(Text::DirWants)),
    }
}

#[inline(never)]
fn scale(words: &mut Words) -> Result<Change, Misread> {
    match centideg(words.next()).ok_or(Misread::Wants(Text::ScaleWants))? {
        scale @ 500..=2000 => Ok(Change::Scale(scale as u16)),
        _ => Err(Misread::Range(Text::ScaleRange)),
    }
}

fn boot<R: Robot>(words: Words, robot: &R) -> Result<Command, Misread> {
    let rest = words.0.trim_ascii();
    let boot = if Text::Rest.is(rest) {
        Boot::Rest
    } else {
        match gait(rest, robot) {
            Ok(Command::Gait(id)) => Boot::Gait(id),
            _ => return Err(Misread::Wants(Text::BootWants)),
        }
    };
    Ok(Command::Boot(boot))
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

/// An angle with at most two decimals, in hundredths; a larger one than sixteen bits
/// hold stays at that.
#[inline(never)]
fn centideg(word: &[u8]) -> Option<i32> {
    let (sign, digits) = match word {
        [sign @ (b'-' | b'+'), digits @ ..] => (*sign, digits),
        digits => (b'+', digits),
    };
    let (degrees, mut rest) = number(digits);
    let mut size = degrees?;
    if let [b'.', decimals @ ..] = rest {
        rest = decimals;
    } else if !rest.is_empty() {
        return None;
    }
    // As many decimals as there may be, zeros in the place of those that are not there.
    for _ in 0..2 {
        let mut decimal = 0;
        if let [first, others @ ..] = rest {
            decimal = digit(*first)?;
            rest = others;
        }
        size = append(size, decimal);
    }
    let size = i32::from(size);
    match (rest, sign) {
        ([], b'-') => Some(-size),
        ([], _) => Some(size),
        _ => None,
    }
}

/// A number with one more digit; 65535 stands for more than sixteen bits hold.
#[inline(never)]
fn append(number: u16, digit: u16) -> u16 {
    // 6553 and one more digit is where sixteen bits may end.
    if number < 6553 {
        number * 10 + digit
    } else {
        u16::MAX
    }
}

/// Leading digits as a number, saturating, and what follows them.
fn number(word: &[u8]) -> (Option<u16>, &[u8]) {
    let (mut value, mut rest) = (None, word);
    while let [first, others @ ..] = rest
        && let Some(digit) = digit(*first)
    {
        value = Some(append(value.unwrap_or(0), digit));
        rest = others;
    }
    (value, rest)
}

fn digit(byte: u8) -> Option<u16> {
    byte.is_ascii_digit().then(|| u16::from(byte - b'0'))
}

#[cfg(test)]
mod tests;
