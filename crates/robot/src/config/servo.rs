//! The four servos, in the order of every array of this project: A1, A2, A3, A4.

use std::collections::BTreeMap;

pub use lizard_contact::FORWARD_TURN_SIGN;
use lizard_kinematics::{Side, wrap};

use crate::file::{ReadResult, Table, format_number, read_for_each};
use crate::units::STEPS_PER_DEGREE;

/// The servos' names.
pub const SERVO_NAMES: [&str; 4] = ["A1", "A2", "A3", "A4"];

/// The names of the servos' legs: left (L) or right (R), front (F) or hind (H).
pub const LEG_NAMES: [&str; 4] = ["LF", "RF", "RH", "LH"];

/// The direction in which each servo's slider arm is turned from its crank: 1 for counter-clockwise, -1 for clockwise.
pub const ARM_TURN_SIGN: [f64; 4] = {
    let (left, right) = (Side::Left.sign(), Side::Right.sign());
    [left, right, -right, -left]
};

/// Range of the pulse widths that a hobby servo tolerates, us. Each width fits into a slot of 4 ms.
const PULSE_RANGE_US: (f64, f64) = (500.0, 2500.0);
/// Range of a gain's magnitude: that of the console's `scale`, so that every backup can be restored.
const GAIN_RANGE_US_PER_DEGREE: (f64, f64) = (5.0, 20.0);

/// For each servo, the index of its mirror image on the other side of the robot.
pub const OPPOSITE_SERVO: [usize; 4] = [1, 0, 3, 2];

/// A servo, as defined in robot.toml.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Servo {
    /// Arduino number of the servo's signal pin.
    pub pin: u8,
    /// Angle in the chassis frame at which the horn is fitted, deg.
    pub neutral: f64,
    /// Pulse width at the neutral angle, us.
    pub neutral_us: f64,
    /// Gain, us per degree; positive if a longer pulse turns the horn counter-clockwise.
    pub us_per_degree: f64,
    /// Shortest pulse allowed, us.
    pub min_us: f64,
    /// Longest pulse allowed, us.
    pub max_us: f64,
}

impl Servo {
    /// The travel: the smallest and the largest sweep from neutral, deg. Neither exceeds half a turn, even if the
    /// pulses allow more.
    pub fn travel(&self) -> (f64, f64) {
        let (sweep_at_min, sweep_at_max) = (self.sweep(self.min_us), self.sweep(self.max_us));
        (
            sweep_at_min.min(sweep_at_max).max(-HALF_TURN),
            sweep_at_min.max(sweep_at_max).min(HALF_TURN),
        )
    }

    /// True if the servo can turn to this angle in the chassis frame, deg.
    pub fn reaches(&self, angle: f64) -> bool {
        let (min, max) = self.travel();
        (min - ROUNDING_ALLOWANCE..=max + ROUNDING_ALLOWANCE).contains(&wrap(angle - self.neutral))
    }

    /// Converts a pulse width (us) to the sweep from neutral, deg, positive counter-clockwise.
    pub fn sweep(&self, pulse_us: f64) -> f64 {
        (pulse_us - self.neutral_us) / self.us_per_degree
    }

    /// Converts an angle in the chassis frame (deg) to the pulse width, us.
    pub fn pulse(&self, angle: f64) -> f64 {
        self.neutral_us + self.us_per_degree * wrap(angle - self.neutral)
    }
}

/// Rounding error allowed at a travel's limits, deg.
const ROUNDING_ALLOWANCE: f64 = 1e-9;
/// The largest sweep that the core can represent, deg.
const HALF_TURN: f64 = i16::MAX as f64 / STEPS_PER_DEGREE;

/// The highest speeds at which the servos may turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedLimits {
    /// Highest speed in a move from one pose to another, deg/s.
    pub slew: f64,
    /// Highest speed in a gait, deg/s.
    pub gait_slew: f64,
}

/// Converts the name of a pin on the board to the pin's Arduino number: D2 to D12, A0 to A5 (14 to 19); `None` for any
/// other name.
pub(crate) fn parse_pin(name: &str) -> Option<u8> {
    let (letter, number) = name.split_at_checked(1)?;
    // "+5" and "05" would be parsed as 5, but are not names of pins.
    let number: u8 = number
        .parse()
        .ok()
        .filter(|n: &u8| n.to_string() == number)?;
    match letter {
        "D" if (2..=12).contains(&number) => Some(number),
        "A" if number <= 5 => Some(14 + number),
        _ => None,
    }
}

/// Reads the key `pin`. Its value must be a name that [`parse_pin`] accepts.
pub(crate) fn read_pin(table: &Table) -> ReadResult<u8> {
    let text = table.text("pin")?;
    parse_pin(text).ok_or_else(|| {
        let message = format!(
            "is \"{text}\"; it must be one of D2 to D12 or A0 to A5 (D0 and D1 are the serial line, D13 is the LED)"
        );
        table.error("pin", message)
    })
}

/// The pins in use: the Arduino number of each pin, and the table that names it.
pub(crate) type UsedPins = BTreeMap<u8, String>;

/// Adds the pin that a table names to the pins in use; rejects a pin that an earlier table uses.
pub(crate) fn claim_pin(table: &Table, pin: u8, used_pins: &mut UsedPins) -> ReadResult<()> {
    match used_pins.insert(pin, table.key.clone()) {
        Some(owner) => {
            let name = table.text("pin")?;
            Err(table.error("pin", format!("is \"{name}\", which {owner} already uses")))
        }
        None => Ok(()),
    }
}

/// The keys of `[servo]` that describe the motors of all four servos.
const MOTOR_KEYS: [&str; 8] = [
    "model",
    "stall_kg_cm",
    "s_per_60_deg",
    "at_volts",
    "volts",
    "dead_band_us",
    "spin_up_ms",
    "full_torque_deg",
];

/// The keys of one servo's table.
const SERVO_KEYS: [&str; 6] = [
    "pin",
    "neutral",
    "neutral_us",
    "us_per_degree",
    "min_us",
    "max_us",
];

/// Reads `[servo.A1]` to `[servo.A4]`.
pub(crate) fn read(root: &Table, used_pins: &mut UsedPins) -> ReadResult<[Servo; 4]> {
    let keys: Vec<&str> = SERVO_NAMES.into_iter().chain(MOTOR_KEYS).collect();
    let table = root.table("servo", &keys)?;
    read_for_each(SERVO_NAMES, |name| {
        let servo_table = table.table(name, &SERVO_KEYS)?;
        let servo = read_servo(&servo_table)?;
        claim_pin(&servo_table, servo.pin, used_pins)?;
        Ok(servo)
    })
}

/// Reads the table of one servo.
fn read_servo(table: &Table) -> ReadResult<Servo> {
    let read_width = |name| table.number(name, PULSE_RANGE_US, "us");
    let pin = read_pin(table)?;
    let us_per_degree = table.number("us_per_degree", (-f64::MAX, f64::MAX), "us")?;
    let (min, max) = GAIN_RANGE_US_PER_DEGREE;
    if !(min..=max).contains(&us_per_degree.abs()) {
        let message = format!(
            "is {}; it must be between {min} and {max} us, or between -{max} and -{min} us if a longer pulse turns the horn clockwise",
            format_number(us_per_degree)
        );
        return Err(table.error("us_per_degree", message));
    }
    let servo = Servo {
        pin,
        neutral: table.number("neutral", (0.0, 360.0), "deg")?,
        neutral_us: read_width("neutral_us")?,
        us_per_degree,
        min_us: read_width("min_us")?,
        max_us: read_width("max_us")?,
    };
    table.require_less("min_us", servo.min_us, "neutral_us", servo.neutral_us)?;
    table.require_less("neutral_us", servo.neutral_us, "max_us", servo.max_us)?;
    Ok(servo)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A servo that turns clockwise with a longer pulse.
    const SERVO: Servo = Servo {
        pin: 9,
        neutral: 47.0,
        neutral_us: 1535.0,
        us_per_degree: -11.0,
        min_us: 560.0,
        max_us: 2420.0,
    };

    #[test]
    fn a_reversed_servo_turns_clockwise_with_a_longer_pulse() {
        let (min, max) = SERVO.travel();
        assert_eq!((min, max), (-885.0 / 11.0, 975.0 / 11.0));
        assert_eq!(SERVO.pulse(57.0), 1425.0);
        assert_eq!(SERVO.sweep(1425.0), 10.0);
        let pulse = SERVO.pulse(47.0 - 350.0);
        assert_eq!(pulse, 1425.0, "the servo turns in the shorter direction");
    }

    #[test]
    fn no_travel_exceeds_half_a_turn() {
        let wide_servo = Servo {
            us_per_degree: 1.0,
            ..SERVO
        };
        let (min, max) = wide_servo.travel();
        assert!(-180.0 < min && min < -179.9 && 179.9 < max && max < 180.0);
    }

    #[test]
    fn slider_arms_are_turned_in_the_same_direction_as_in_the_kinematics() {
        use lizard_kinematics::Vector;
        let crank = Vector::new(1.0, 0.0);
        for side in Side::ALL {
            let [front, rear] = side.servos();
            let arms = [side.front_arm(crank), side.rear_arm(crank)];
            let expected = [front, rear].map(|servo| Vector::new(0.0, ARM_TURN_SIGN[servo]));
            assert_eq!(arms, expected);
        }
    }
}
