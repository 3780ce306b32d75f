//! Answers: what the robot says to a line, and how it is written.
//!
//! Every line gets exactly one final line, `ok ...` or `err <code> <reason>`.
//! The codes are part of the protocol and never change their meaning.

use lizard_avr::flash;
use ufmt::uWrite;

use crate::command::Misread;
use crate::hazard::{Hazard, Kind};
use crate::pose::Pose;
use crate::robot::{LEFT, LIMITS, RIGHT, SERVOS};
use crate::text::Text;
use crate::units::{centideg_from_angle, hundredths_from_length, thousandths_from_q15};

/// Why a command is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// Codes 1, 2, 3: not a command.
    Misread(Misread),
    /// Codes 4 and 5: the pose is not safe.
    Unsafe(Hazard),
    /// Code 6: the line is too long.
    TooLong,
    /// Code 7: the servos have no pulses.
    Resting,
}

/// A final line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// `ok` and the line as it was understood.
    Done,
    /// The list of commands, then `ok help`.
    Help,
    /// `ok` and the state.
    Status,
    /// `err`; nothing was changed.
    Refused(Refusal),
}

/// Prints bytes of seven bits as they are.
pub fn ascii<W: uWrite + ?Sized>(out: &mut W, bytes: &[u8]) -> Result<(), W::Error> {
    for byte in bytes {
        out.write_char(char::from(byte & 0x7f))?;
    }
    Ok(())
}

/// Prints four chassis angles in degrees, with a separator between them.
pub fn pose<W: uWrite + ?Sized>(out: &mut W, pose: &Pose, between: char) -> Result<(), W::Error> {
    for servo in 0..4 {
        if servo > 0 {
            out.write_char(between)?;
        }
        number(out, pose.centideg(servo).into(), 2)?;
    }
    Ok(())
}

/// Prints a number, the last `decimals` of its digits behind a point.
pub fn number<W>(out: &mut W, value: u32, decimals: usize) -> Result<(), W::Error>
where
    W: uWrite + ?Sized,
{
    let mut rest = value;
    let mut begun = false;
    let mut place = DECADES.len();
    while place > 0 {
        place -= 1;
        let unit = DECADES.at(place).load();
        let mut digit = b'0';
        while rest >= unit {
            rest -= unit;
            digit += 1;
        }
        begun |= digit != b'0' || place <= decimals;
        if begun {
            out.write_char(char::from(digit & 0x7f))?;
            if place == decimals && place > 0 {
                out.write_char('.')?;
            }
        }
    }
    Ok(())
}

flash! {
    const DECADES: [u32; 10] = [
        1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000, 1_000_000_000,
    ];
}

/// Prints a number that may be negative, `decimals` behind the point.
pub fn signed<W: uWrite + ?Sized>(
    out: &mut W,
    value: i16,
    decimals: usize,
) -> Result<(), W::Error> {
    if value < 0 {
        out.write_char('-')?;
    }
    number(out, value.unsigned_abs().into(), decimals)
}

impl Refusal {
    /// The protocol's number for this refusal.
    pub const fn code(&self) -> u8 {
        match self {
            Self::Misread(Misread::Unknown) => 1,
            Self::Misread(Misread::SpeedRange | Misread::WatchRange | Misread::PoseRange(_)) => 3,
            Self::Misread(_) => 2,
            Self::Unsafe(hazard) => match hazard.check.kind() {
                Kind::Stroke => 5,
                _ => 4,
            },
            Self::TooLong => 6,
            Self::Resting => 7,
        }
    }

    /// Prints the reason.
    pub fn print<W: uWrite + ?Sized>(&self, out: &mut W) -> Result<(), W::Error> {
        match self {
            Self::Misread(misread) => print_misread(*misread, out),
            Self::Unsafe(hazard) => print_hazard(*hazard, out),
            Self::TooLong => Text::TooLong.print(out),
            Self::Resting => Text::Resting.print(out),
        }
    }
}

fn print_misread<W: uWrite + ?Sized>(misread: Misread, out: &mut W) -> Result<(), W::Error> {
    let text = match misread {
        Misread::Unknown => Text::Unknown,
        Misread::Surplus => Text::Surplus,
        Misread::Incomplete => Text::Incomplete,
        Misread::SpeedWants => Text::SpeedWants,
        Misread::SpeedRange => Text::SpeedRange,
        Misread::WatchWants => Text::WatchWants,
        Misread::WatchRange => Text::WatchRange,
        Misread::PoseWants => Text::PoseWants,
        Misread::PoseRange(index) => return print_travel(index, out),
    };
    text.print(out)
}

/// `A2 must be within its travel, 311.41..131.41`.
fn print_travel<W: uWrite + ?Sized>(index: u8, out: &mut W) -> Result<(), W::Error> {
    servo(out, index)?;
    Text::Beyond.print(out)?;
    let servo = &SERVOS[usize::from(index & 3)];
    number(
        out,
        centideg_from_angle(servo.angle_at(servo.min_sweep)).into(),
        2,
    )?;
    dots(out)?;
    number(
        out,
        centideg_from_angle(servo.angle_at(servo.max_sweep)).into(),
        2,
    )
}

/// Prints what is wrong with a pose: the margin, its value and its limit.
pub fn print_hazard<W: uWrite + ?Sized>(hazard: Hazard, out: &mut W) -> Result<(), W::Error> {
    let which = hazard.check.which();
    let kind = hazard.check.kind();
    if kind == Kind::Stroke {
        let (side, slider) = if which == 0 {
            (Text::Left, &LEFT)
        } else {
            (Text::Right, &RIGHT)
        };
        side.print(out)?;
        Text::Slider.print(out)?;
        signed(out, hundredths_from_length(hazard.value), 2)?;
        Text::Within.print(out)?;
        let [least, most] = slider.stroke();
        signed(out, hundredths_from_length(least), 2)?;
        dots(out)?;
        return signed(out, hundredths_from_length(most), 2);
    }
    match kind {
        Kind::Type2 if which == 0 => Text::Type2Head,
        Kind::Type2 => Text::Type2Tail,
        Kind::Type1 => Text::Type1,
        Kind::Leg | Kind::Stroke => Text::Leg,
    }
    .print(out)?;
    if kind != Kind::Type2 {
        servo(out, which)?;
    }
    Text::Is.print(out)?;
    signed(out, thousandths_from_q15(hazard.value), 3)?;
    Text::Least.print(out)?;
    signed(out, thousandths_from_q15(LIMITS.least(kind)), 3)
}

fn dots<W: uWrite + ?Sized>(out: &mut W) -> Result<(), W::Error> {
    out.write_char('.')?;
    out.write_char('.')
}

fn servo<W: uWrite + ?Sized>(out: &mut W, index: u8) -> Result<(), W::Error> {
    out.write_char('A')?;
    out.write_char(char::from(b'1' + (index & 3)))
}
