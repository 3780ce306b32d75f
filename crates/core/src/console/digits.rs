//! Prints numbers without division, which is slow on an AVR.

use lizard_avr::flash;

use crate::console::output::Output;
use crate::console::text::Text;
use crate::numbers::part::Servo;
use crate::numbers::pose::Pose;
use crate::numbers::robot::Robot;
use crate::numbers::units::Sine;

/// Prints bytes as ASCII: the highest bit of each is cleared.
pub fn print_ascii(out: &mut impl Output, bytes: impl Iterator<Item = u8>) {
    for byte in bytes {
        out.write_byte(byte & 0x7f);
    }
}

/// Prints the four chassis angles of a pose in degrees, with commas between them.
pub fn print_angles(out: &mut impl Output, pose: &Pose, robot: &Robot) {
    for servo in Servo::iter() {
        if servo != Servo::A1 {
            out.write_byte(b',');
        }
        let angle = robot
            .servo_neutral_angle(servo)
            .offset_by(*servo.pick(&pose.0));
        print_number(out, angle.centideg().into(), 2);
    }
}

/// Prints a number with a decimal point before its last `decimals` digits, or without a decimal point if `decimals` is
/// 0.
pub fn print_number(out: &mut impl Output, value: u32, decimals: usize) {
    let mut remainder = value;
    let mut has_begun = false;
    let mut position = POWERS_OF_TEN.as_slice().len();
    while position > 0 {
        position -= 1;
        let unit = POWERS_OF_TEN.at(position).load();
        let mut digit = b'0';
        while remainder >= unit {
            remainder -= unit;
            digit += 1;
        }
        has_begun |= digit != b'0' || position <= decimals;
        if has_begun {
            out.write_byte(digit);
            if position == decimals && position > 0 {
                out.write_byte(b'.');
            }
        }
    }
}

flash! {
    /// The powers of ten, indexed by their exponent.
    const POWERS_OF_TEN: [u32; 10] = [
        1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000, 1_000_000_000,
    ];
}

/// Prints a text, followed by a number of hundredths with two decimals.
#[inline(never)]
pub fn print_hundredths(out: &mut impl Output, text: Text, hundredths: u16) {
    text.print(out);
    print_number(out, hundredths.into(), 2)
}

/// Prints a text, followed by a whole number.
#[inline(never)]
pub fn print_count(out: &mut impl Output, text: Text, count: u32) {
    text.print(out);
    print_number(out, count, 0)
}

/// Prints a number that may be negative, with a decimal point as in [`print_number`].
pub fn print_signed(out: &mut impl Output, value: i32, decimals: usize) {
    if value < 0 {
        out.write_byte(b'-');
    }
    print_number(out, value.unsigned_abs(), decimals)
}

/// Prints a sine, such as a margin, with three decimals.
pub fn print_sine(out: &mut impl Output, sine: Sine) {
    print_signed(out, sine.thousandths().into(), 3)
}

#[cfg(test)]
mod tests {
    use std::format;
    use std::string::{String, ToString};

    use super::*;
    use crate::numbers::units::Angle;
    use crate::sample::Sample;

    fn print_to_string(value: u32, decimals: usize) -> String {
        let mut text = String::new();
        print_number(&mut text, value, decimals);
        text
    }

    /// Formats a number with the standard library.
    fn format_with_std(value: u32, decimals: usize) -> String {
        let digits = format!("{value:0>width$}", width = decimals + 1);
        let (integer, fraction) = digits.split_at(digits.len() - decimals);
        if decimals == 0 {
            integer.to_string()
        } else {
            format!("{integer}.{fraction}")
        }
    }

    #[test]
    fn numbers_of_every_length_match_the_standard_library() {
        let values = (0..10).flat_map(|n| {
            let power = 10u32.pow(n);
            [power - 1, power, power + 1]
        });
        let spread_values = (0..u32::MAX).step_by(1_234_577);
        for value in values.chain(spread_values).chain([u32::MAX - 1, u32::MAX]) {
            for decimals in 0..=3 {
                let expected = format_with_std(value, decimals);
                assert_eq!(print_to_string(value, decimals), expected);
            }
        }
    }

    #[test]
    fn only_a_negative_number_is_printed_with_a_sign() {
        for value in (-33_000..33_000).chain([i32::MIN, i32::MAX]) {
            let mut text = String::new();
            print_signed(&mut text, value, 3);
            let sign = if value < 0 { "-" } else { "" };
            let magnitude = format_with_std(value.unsigned_abs(), 3);
            assert_eq!(text, format!("{sign}{magnitude}"));
        }
    }

    #[test]
    fn angles_are_printed_with_two_decimals_and_separated_by_commas() {
        let mut text = String::new();
        let centideg = [0, 4_141, 31_860, 35_999];
        let robot = Sample::asymmetric();
        let pose = Pose::from_angles(&centideg.map(Angle::from_centideg), &robot.neutral_angles());
        print_angles(&mut text, &pose, &robot);
        assert_eq!(text, "0.00,41.41,318.60,359.99");
    }
}
