//! Prints errors and refusals as a code and a reason.
//!
//! The codes are part of the protocol, and their meaning never changes.

use crate::console::command::LineError;
use crate::console::digits::{print_hundredths, print_number, print_signed, print_sine};
use crate::console::output::Output;
use crate::console::text::Text;
use crate::control::refusal::Refusal;
use crate::guard::hazard::{Hazard, Margin};
use crate::motion::Motion;
use crate::numbers::calibration::{Calibration, SweepRange};
use crate::numbers::part::{End, Servo, Side};
use crate::numbers::robot::Robot;
use crate::numbers::slider::Slider;

impl LineError {
    /// Prints the protocol's code for this error, and the reason.
    #[inline(never)]
    pub fn print(self, motion: &Motion, out: &mut impl Output) {
        let (code, text) = match self {
            Self::UnknownCommand => (1, Text::UnknownCommand),
            Self::Garbled => (1, Text::Garbled),
            Self::UnexpectedArgument => (2, Text::UnexpectedArgument),
            Self::IncompleteName => (2, Text::IncompleteName),
            Self::WrongArguments(text) => (2, text),
            Self::OutOfRange(text) => (3, text),
            Self::AngleOutOfRange(servo) => {
                print_code(3, out);
                return print_travel_limits(servo, motion, out);
            }
            Self::TooLong => (6, Text::TooLong),
        };
        print_code(code, out);
        text.print(out)
    }
}

impl Refusal {
    /// The protocol's code for this refusal.
    const fn code(self) -> u8 {
        match self {
            Self::Unsafe(Hazard::Travel(_))
            | Self::TravelTooNarrow(_)
            | Self::PoseOutsideTravel(_) => 3,
            Self::Unsafe(Hazard::Margin { .. }) => 4,
            Self::Unsafe(Hazard::Stroke { .. }) => 5,
            Self::Resting => 7,
            Self::SupplyTooLow => 8,
            Self::WriteFailed | Self::NothingSaved => 9,
            Self::NoRobot => 10,
        }
    }

    /// Prints the protocol's code for this refusal, and the reason.
    pub fn print(self, motion: &Motion, out: &mut impl Output) {
        print_code(self.code(), out);
        match self {
            Self::Unsafe(hazard) => print_hazard(hazard, motion, out),
            Self::TravelTooNarrow(servo) => {
                print_servo(servo, out);
                Text::TooNarrowForGaits.print(out);
                let needed_travel = motion.robot().needed_travel(servo);
                print_range(servo, &needed_travel, motion, out)
            }
            Self::PoseOutsideTravel(servo) => {
                print_servo(servo, out);
                Text::TooNarrowForPose.print(out)
            }
            Self::Resting => Text::Resting.print(out),
            Self::SupplyTooLow => Text::SupplyTooLow.print(out),
            Self::WriteFailed => Text::WriteFailed.print(out),
            Self::NothingSaved => Text::NothingSaved.print(out),
            Self::NoRobot => Text::NoRobot.print(out),
        }
    }
}

/// Prints an error code and a space.
fn print_code(code: u8, out: &mut impl Output) {
    print_number(out, code.into(), 0);
    out.write_byte(b' ')
}

/// Prints `A2 must be 311.41..131.41`.
fn print_travel_limits(servo: Servo, motion: &Motion, out: &mut impl Output) {
    print_servo(servo, out);
    Text::MustBe.print(out);
    let Calibration {
        travel_min: min,
        travel_max: max,
        ..
    } = *servo.pick(motion.calibration());
    print_range(servo, &SweepRange { min, max }, motion, out)
}

/// Prints a servo's range of sweeps as two chassis angles, such as `311.41..131.41`.
fn print_range(servo: Servo, range: &SweepRange, motion: &Motion, out: &mut impl Output) {
    let neutral = motion.robot().servo_neutral_angle(servo);
    print_hundredths(out, Text::Empty, neutral.offset_by(range.min).centideg());
    print_hundredths(
        out,
        Text::RangeSeparator,
        neutral.offset_by(range.max).centideg(),
    )
}

/// Prints a hazard: the violated travel, margin or stroke, with its limits.
#[inline(never)]
pub fn print_hazard(hazard: Hazard, motion: &Motion, out: &mut impl Output) {
    let robot = motion.robot();
    match hazard {
        Hazard::Travel(servo) => print_travel_limits(servo, motion, out),
        Hazard::Margin { margin, value } => {
            let limits = robot.limits();
            let min_value = match margin {
                Margin::Type2(End::Head) => {
                    Text::Type2MarginHead.print(out);
                    limits.type2
                }
                Margin::Type2(End::Tail) => {
                    Text::Type2MarginTail.print(out);
                    limits.type2
                }
                Margin::Type1(servo) => {
                    Text::Type1Margin.print(out);
                    print_servo(servo, out);
                    limits.type1
                }
                Margin::Leg(servo) => {
                    Text::LegMargin.print(out);
                    print_servo(servo, out);
                    limits.leg
                }
            };
            if margin.is_known(value) {
                Text::MarginIs.print(out);
                print_sine(out, value);
            } else {
                Text::MarginIsBelow.print(out);
            }
            Text::MarginLimit.print(out);
            print_sine(out, min_value)
        }
        Hazard::Stroke { side, length } => {
            match side {
                Side::Left => Text::Left,
                Side::Right => Text::Right,
            }
            .print(out);
            let Slider {
                stroke_min: min,
                stroke_max: max,
                ..
            } = robot.slider(side);
            print_displacement(Text::SliderPosition, length, side, robot, out);
            print_displacement(Text::StrokeRange, min, side, robot, out);
            print_displacement(Text::RangeSeparator, max, side, robot, out)
        }
    }
}

/// Prints `text`, followed by a slider's displacement from its nominal length, mm.
#[inline(never)]
fn print_displacement(text: Text, length: u16, side: Side, robot: &Robot, out: &mut impl Output) {
    text.print(out);
    print_signed(out, robot.slider(side).displacement_hundredths(length), 2)
}

/// Prints a servo's name, such as `A2`.
fn print_servo(servo: Servo, out: &mut impl Output) {
    out.write_byte(b'A');
    out.write_byte(b'1' + servo.index() as u8)
}

#[cfg(test)]
mod tests {
    use std::format;
    use std::string::String;

    use super::*;
    use crate::numbers::units::Sine;
    use crate::sample::Sample;

    /// Returns the text that `print` writes for the asymmetric robot.
    fn print_to_string(print: impl FnOnce(&Motion, &mut String)) -> String {
        let mut text = String::new();
        print(&Motion::new(*Sample::asymmetric()), &mut text);
        text
    }

    fn format_refusal(refusal: Refusal) -> String {
        print_to_string(|motion, out| refusal.print(motion, out))
    }

    #[test]
    fn errors_are_printed_with_their_code_and_message() {
        use LineError::{
            AngleOutOfRange, IncompleteName, OutOfRange, UnexpectedArgument, UnknownCommand,
            WrongArguments,
        };
        for (line_error, message) in [
            (UnknownCommand, "1 unknown command; send help for the list"),
            (LineError::Garbled, "1 the line was garbled; send it again"),
            (UnexpectedArgument, "2 this command takes no argument"),
            (IncompleteName, "2 this command needs another word"),
            (
                WrongArguments(Text::SpeedUsage),
                "2 speed takes a whole number, 10..100",
            ),
            (OutOfRange(Text::SpeedRange), "3 speed must be 10..100"),
            (
                WrongArguments(Text::WatchUsage),
                "2 watch takes a whole number, 0..10000",
            ),
            (OutOfRange(Text::WatchRange), "3 watch must be 0..10000"),
            (
                WrongArguments(Text::PoseUsage),
                "2 pose takes four angles in degrees, with at most two decimals",
            ),
            (
                WrongArguments(Text::BootUsage),
                "2 boot takes a gait, a routine or rest",
            ),
            (AngleOutOfRange(Servo::A1), "3 A1 must be 61.37..215.36"),
            (LineError::TooLong, "6 a line has at most 63 characters"),
        ] {
            let text = print_to_string(|motion, out| line_error.print(motion, out));
            assert_eq!(text, message);
        }
        let resting_text = format_refusal(Refusal::Resting);
        assert_eq!(resting_text, "7 the servos are resting; send stand first");
        // The limits of the travel are rounded inwards to whole steps. From its neutral angle of 47.91 deg, A2 turns 66
        // deg clockwise and 88 deg counter-clockwise.
        for (servo, message) in [
            (Servo::A2, "3 A2 must be 341.92..135.91"),
            (Servo::A3, "3 A3 must be 235.64..18.64"),
            (Servo::A4, "3 A4 must be 134.18..307.18"),
        ] {
            let text = format_refusal(Refusal::Unsafe(Hazard::Travel(servo)));
            assert_eq!(text, message);
        }
    }

    #[test]
    fn margin_and_stroke_hazards_are_printed_with_their_value_and_limit() {
        use End::{Head, Tail};
        use Margin::{Leg, Type1, Type2};
        for (margin, value, kind, statement, limit) in [
            (Type2(Head), 1000, "type-2", "the head is 0.031", "0.340"),
            (Type2(Tail), -33, "type-2", "the tail is -0.001", "0.340"),
            (Type2(Tail), 0, "type-2", "the tail is below 0.1", "0.340"),
            (Type1(Servo::A1), 0, "type-1", "A1 is 0.000", "0.220"),
            (Type1(Servo::A3), -9830, "type-1", "A3 is -0.300", "0.220"),
            (Leg(Servo::A2), 2000, "leg", "A2 is 0.061", "0.130"),
            (Leg(Servo::A4), -32_767, "leg", "A4 is -1.000", "0.130"),
        ] {
            let value = Sine(value);
            let text = format_refusal(Refusal::Unsafe(Hazard::Margin { margin, value }));
            let message = format!("4 {kind} margin of {statement}, must be at least {limit}");
            assert_eq!(text, message);
        }
        // The nominal length is 91 mm on the left and 98 mm on the right; a millimetre has 256 steps.
        let sliders = Sample::asymmetric().content.sliders;
        assert_eq!(sliders.map(|side| side.scale.bits), [8, 8]);
        for (side, mm, statement) in [
            (Side::Left, 131, "left slider is at 40.00 mm"),
            (Side::Right, 70, "right slider is at -28.00 mm"),
        ] {
            let length = 256 * mm;
            let text = format_refusal(Refusal::Unsafe(Hazard::Stroke { side, length }));
            assert_eq!(text, format!("5 {statement}, must be -21.00..38.00"));
        }
    }
}
