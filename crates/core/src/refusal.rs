//! Refusals: why a command is not executed, as the user reads it.
//!
//! The codes are part of the protocol and never change their meaning.

use ufmt::uWrite;

use crate::adjustment::Reach;
use crate::calibration::Calibration;
use crate::command::Misread;
use crate::digits::{field, signed, sine};
use crate::hazard::{Hazard, Margin};
use crate::motion::Motion;
use crate::part::{End, Servo, Side};
use crate::robot::Robot;
use crate::slider::Slider;
use crate::text::Text;

/// Why a command is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// Codes 1, 2, 3: not a command.
    Misread(Misread),
    /// Codes 3, 4 and 5: a servo does not reach the pose, or it is not safe.
    Unsafe(Hazard),
    /// Code 1: a byte of the line came garbled.
    Garbled,
    /// Code 6: the line is too long.
    TooLong,
    /// Code 7: the servos have no pulses.
    Resting,
    /// Code 3: with this calibration, a servo could not do what the gaits need.
    Unfit(Servo),
    /// Code 3: with this calibration, a servo could not stay where it is, or go
    /// where it goes.
    Elsewhere(Servo),
    /// Code 8: the supply is too low for this.
    Supply,
    /// Code 9: the memory does not keep what is written.
    NotKept,
    /// Code 9: the memory holds no settings to load.
    NothingSaved,
    /// Code 10: there is no robot in the flash.
    NoRobot,
}

impl Refusal {
    /// The protocol's number for this refusal.
    pub const fn code(&self) -> u8 {
        match self {
            Self::Misread(Misread::Unknown) | Self::Garbled => 1,
            Self::Misread(Misread::Range(_) | Misread::PoseRange(_))
            | Self::Unsafe(Hazard::Travel(_))
            | Self::Unfit(_)
            | Self::Elsewhere(_) => 3,
            Self::Misread(_) => 2,
            Self::Unsafe(Hazard::Margin { .. }) => 4,
            Self::Unsafe(Hazard::Stroke { .. }) => 5,
            Self::TooLong => 6,
            Self::Resting => 7,
            Self::Supply => 8,
            Self::NotKept | Self::NothingSaved => 9,
            Self::NoRobot => 10,
        }
    }

    /// Prints the reason.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn print<W>(&self, motion: &Motion, out: &mut W) -> Result<(), W::Error>
    where
        W: uWrite + ?Sized,
    {
        match self {
            Self::Misread(misread) => print_misread(*misread, motion, out),
            Self::Unsafe(hazard) => print_hazard(*hazard, motion, out),
            Self::Garbled => Text::Garbled.print(out),
            Self::TooLong => Text::TooLong.print(out),
            Self::Resting => Text::Resting.print(out),
            Self::Unfit(servo) => {
                print_servo(*servo, out)?;
                Text::Needed.print(out)?;
                let needed = motion.robot().reach(*servo);
                print_range(*servo, &needed, motion, out)
            }
            Self::Elsewhere(servo) => {
                print_servo(*servo, out)?;
                Text::NotHere.print(out)
            }
            Self::Supply => Text::LowSupply.print(out),
            Self::NotKept => Text::NotKept.print(out),
            Self::NothingSaved => Text::NothingSaved.print(out),
            Self::NoRobot => Text::NoRobot.print(out),
        }
    }
}

#[inline(never)]
fn print_misread<W>(misread: Misread, motion: &Motion, out: &mut W) -> Result<(), W::Error>
where
    W: uWrite + ?Sized,
{
    let text = match misread {
        Misread::Unknown => Text::Unknown,
        Misread::Surplus => Text::Surplus,
        Misread::Incomplete => Text::Incomplete,
        Misread::Wants(text) | Misread::Range(text) => text,
        Misread::PoseRange(servo) => return print_travel(servo, motion, out),
    };
    text.print(out)
}

/// `A2 reaches 311.41..131.41`.
fn print_travel<W>(servo: Servo, motion: &Motion, out: &mut W) -> Result<(), W::Error>
where
    W: uWrite + ?Sized,
{
    print_servo(servo, out)?;
    Text::Beyond.print(out)?;
    let Calibration { min, max, .. } = *servo.of(motion.calibration());
    print_range(servo, &Reach { min, max }, motion, out)
}

fn print_range<W>(servo: Servo, reach: &Reach, motion: &Motion, out: &mut W) -> Result<(), W::Error>
where
    W: uWrite + ?Sized,
{
    let neutral = motion.robot().neutral_of(servo);
    field(out, Text::Nothing, neutral.swept(reach.min).centideg())?;
    field(out, Text::Dots, neutral.swept(reach.max).centideg())
}

/// Prints what is wrong with a pose: the margin or the travel, and its limit.
///
/// # Errors
/// Those of `out`.
#[inline(never)]
pub fn print_hazard<W>(hazard: Hazard, motion: &Motion, out: &mut W) -> Result<(), W::Error>
where
    W: uWrite + ?Sized,
{
    let robot = motion.robot();
    match hazard {
        Hazard::Travel(servo) => print_travel(servo, motion, out),
        Hazard::Margin { margin, value } => {
            let limits = robot.limits();
            let least = match margin {
                Margin::Type2(End::Head) => {
                    Text::Type2Head.print(out)?;
                    limits.type2
                }
                Margin::Type2(End::Tail) => {
                    Text::Type2Tail.print(out)?;
                    limits.type2
                }
                Margin::Type1(servo) => {
                    Text::Type1.print(out)?;
                    print_servo(servo, out)?;
                    limits.type1
                }
                Margin::Leg(servo) => {
                    Text::Leg.print(out)?;
                    print_servo(servo, out)?;
                    limits.leg
                }
            };
            if margin.is_known(value) {
                Text::Is.print(out)?;
                sine(out, value)?;
            } else {
                Text::IsBelow.print(out)?;
            }
            Text::Least.print(out)?;
            sine(out, least)
        }
        Hazard::Stroke { side, length } => {
            match side {
                Side::Left => Text::Left,
                Side::Right => Text::Right,
            }
            .print(out)?;
            let Slider { min, max, .. } = robot.side(side);
            print_stroke(Text::Slider, length, side, robot, out)?;
            print_stroke(Text::Within, min, side, robot, out)?;
            print_stroke(Text::Dots, max, side, robot, out)
        }
    }
}

/// Prints the travel from nominal of a slider's length, after `text`.
#[inline(never)]
fn print_stroke<W>(
    text: Text,
    length: u16,
    side: Side,
    robot: &Robot,
    out: &mut W,
) -> Result<(), W::Error>
where
    W: uWrite + ?Sized,
{
    text.print(out)?;
    signed(out, robot.side(side).travel(length), 2)
}

fn print_servo<W: uWrite + ?Sized>(servo: Servo, out: &mut W) -> Result<(), W::Error> {
    out.write_char('A')?;
    out.write_char(char::from(b'1' + servo.index() as u8))
}

#[cfg(test)]
mod tests {
    use std::format;
    use std::string::String;

    use super::*;
    use crate::sample::Sample;
    use crate::units::Sine;

    /// A refusal as the console of the odd robot prints it, with its code.
    fn told(refusal: Refusal) -> String {
        let motion = Motion::new(*Sample::odd());
        let mut text = format!("{} ", refusal.code());
        let Ok(()) = refusal.print(&motion, &mut text);
        text
    }

    #[test]
    fn every_refusal_has_its_code_and_its_sentence() {
        use Servo::{A1, A2, A3, A4};
        // The ends of the travel, in whole steps within it: A1 turns 71 deg clockwise of
        // 132.37 and 83 the other way; the servo of A2 is reversed.
        for (refusal, sentence) in [
            (
                Refusal::Misread(Misread::Unknown),
                "1 unknown command, send help for the list",
            ),
            (
                Refusal::Misread(Misread::Surplus),
                "2 this command takes no argument",
            ),
            (
                Refusal::Misread(Misread::Incomplete),
                "2 this command wants one more word",
            ),
            (
                Refusal::Misread(Misread::Wants(Text::SpeedWants)),
                "2 speed wants a whole number, 10..100",
            ),
            (
                Refusal::Misread(Misread::Range(Text::SpeedRange)),
                "3 speed must be 10..100",
            ),
            (
                Refusal::Misread(Misread::Wants(Text::WatchWants)),
                "2 watch wants a whole number, 0..10000",
            ),
            (
                Refusal::Misread(Misread::Range(Text::WatchRange)),
                "3 watch must be 0..10000",
            ),
            (
                Refusal::Misread(Misread::Wants(Text::PoseWants)),
                "2 pose wants four angles in degrees, at most two decimals",
            ),
            (
                Refusal::Misread(Misread::PoseRange(A1)),
                "3 A1 reaches 61.37..215.36",
            ),
            (
                Refusal::Unsafe(Hazard::Travel(A2)),
                "3 A2 reaches 341.92..135.91",
            ),
            (
                Refusal::Unsafe(Hazard::Travel(A3)),
                "3 A3 reaches 235.64..18.64",
            ),
            (
                Refusal::Unsafe(Hazard::Travel(A4)),
                "3 A4 reaches 134.18..307.18",
            ),
            (Refusal::TooLong, "6 a line has at most 63 characters"),
            (Refusal::Resting, "7 servos are resting, send stand first"),
        ] {
            assert_eq!(told(refusal), sentence);
        }
    }

    #[test]
    fn every_hazard_is_told_with_its_value_and_its_own_limit() {
        let margin = |margin, value| Hazard::Margin {
            margin,
            value: Sine(value),
        };
        let stroke = |side, length| Hazard::Stroke { side, length };
        let robot = Sample::odd();
        // Nominal 91 mm on the left and 98 mm on the right, 256 steps each.
        assert_eq!(robot.content.sides.map(|side| side.scale.bits), [8, 8]);
        for (hazard, sentence) in [
            (
                margin(Margin::Type2(End::Head), 1000),
                "4 type-2 margin of the head is 0.031, at least 0.340",
            ),
            (
                margin(Margin::Type2(End::Tail), -33),
                "4 type-2 margin of the tail is -0.001, at least 0.340",
            ),
            (
                margin(Margin::Type2(End::Tail), 0),
                "4 type-2 margin of the tail is below 0.1, at least 0.340",
            ),
            (
                margin(Margin::Type1(Servo::A1), 0),
                "4 type-1 margin of A1 is 0.000, at least 0.220",
            ),
            (
                margin(Margin::Type1(Servo::A3), -9830),
                "4 type-1 margin of A3 is -0.300, at least 0.220",
            ),
            (
                margin(Margin::Leg(Servo::A2), 2000),
                "4 leg margin of A2 is 0.061, at least 0.130",
            ),
            (
                margin(Margin::Leg(Servo::A4), -32_767),
                "4 leg margin of A4 is -1.000, at least 0.130",
            ),
            (
                stroke(Side::Left, 256 * 131),
                "5 left slider is at 40.00 mm, stroke -21.00..38.00",
            ),
            (
                stroke(Side::Right, 256 * 70),
                "5 right slider is at -28.00 mm, stroke -21.00..38.00",
            ),
        ] {
            assert_eq!(told(Refusal::Unsafe(hazard)), sentence);
        }
    }
}
