//! The supply voltages of the board and of the servos: their measurement, and the thresholds at which the robot slows
//! down, stops and rests.

use lizard_core::numbers::supplies::{Supplies as CoreSupplies, Thresholds};

use crate::file::{Checked, Section};
use crate::measures::servo::{SERVO_NAMES, Servo, parse_pin};

/// The nominal voltage reference of an ATmega328P, V: data sheet, section 29.8.
const NOMINAL_REFERENCE: f64 = 1.1;
/// Range of the voltage reference, V.
const REFERENCE_RANGE: (f64, f64) = (1.0, 1.2);

/// Range of the thresholds of the board's supply, V: the brown-out detector resets the chip at 2.7, and the chip
/// tolerates 5.5.
const BOARD_THRESHOLD_RANGE: (f64, f64) = (2.7, 5.5);

/// Default thresholds, V: below the first, gaits slow down; below the second, the robot stops; below the third, its
/// pulses end. A healthy board may be measured as only 4.3 V if its reference differs from the nominal one.
const DEFAULT_THRESHOLDS: [f64; 3] = [4.2, 4.0, 3.7];

/// Rating of the fuse, A. The fuse carries up to 2.8 A: for 3 A at 5 V and a loss of 15 %, the converter draws this
/// current from a nearly empty battery of 6.4 V. The fuse must blow before the switch is overloaded. Only half of the
/// switch's rating counts, because that rating is for alternating current, and direct current is harder to interrupt.
pub const FUSE_RATING_A: u32 = 3;
/// The smallest rating of the switch, A. See [`FUSE_RATING_A`].
pub const MIN_SWITCH_RATING_A: u32 = 6;
const _: () = assert!(2 * FUSE_RATING_A <= MIN_SWITCH_RATING_A);

/// The Arduino numbers of the analogue pins A0 to A5.
const ANALOGUE_PINS: std::ops::RangeInclusive<u8> = 14..=19;

/// The chip's voltage reference, and the falling voltages (V) below which gaits slow down, the robot stops, and its
/// pulses end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Supplies {
    /// Voltage of the chip's internal reference, V.
    pub reference: f64,
    /// Thresholds of the board's supply, V, in descending order.
    pub board: [f64; 3],
    /// The servos' rail; `None` if it is not measured.
    pub rail: Option<Rail>,
    /// The pace to which gaits are limited below the first threshold, percent of their own pace. It follows from the
    /// servos if their rail is measured; the board's supply says nothing about the servos' torque-speed line.
    pub slow_pace: u8,
}

/// A servo rail that is measured at an analogue pin through a divider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rail {
    /// Arduino number of the pin, 14 to 19.
    pub pin: u8,
    /// The rail's voltage divided by the pin's voltage.
    pub ratio: f64,
    /// Thresholds of the rail, V, in descending order.
    pub thresholds: [f64; 3],
    /// True if robot.toml leaves out the first threshold, so that it is derived from the servos.
    pub has_derived_slow_threshold: bool,
}

/// Smallest difference between the first threshold and the second, and between the supply and the first threshold, V.
/// It is more than the 0.15 V by which a supply must recover before the robot is fast again.
const MIN_THRESHOLD_GAP: f64 = 0.25;

/// The pace at a low supply if the servos' rail is not measured, percent.
const DEFAULT_SLOW_PACE_PERCENT: u8 = 50;
/// The slowest pace that the command `speed` accepts, percent.
const MIN_PACE_PERCENT: f64 = 10.0;

impl Rail {
    /// Sets the first threshold, if it is derived from the servos: the voltage below which the most demanding gait
    /// would use more than `allowed_share` of the servos' torque-speed line. `used_share` is the share that this gait
    /// uses at the supply `volts`.
    pub(crate) fn set_slow_threshold(&mut self, used_share: f64, allowed_share: f64, volts: f64) {
        let [slow, stop, _] = &mut self.thresholds;
        let min = *stop + MIN_THRESHOLD_GAP;
        // Rounded to hundredths. The threshold stays below the supply itself, or the robot would always be slow.
        let slow_volts = (100.0 * volts * used_share / allowed_share).round() / 100.0;
        if self.has_derived_slow_threshold {
            *slow = slow_volts.min(volts - MIN_THRESHOLD_GAP).max(min);
        }
    }
}

impl Supplies {
    /// Limits the pace of gaits at a low supply to `pace`, as a share of their own pace: 1 is full pace.
    pub(crate) fn limit_pace(&mut self, pace: f64) {
        self.slow_pace = (100.0 * pace).floor().max(MIN_PACE_PERCENT) as u8;
    }
}

impl Default for Supplies {
    fn default() -> Self {
        Self {
            reference: NOMINAL_REFERENCE,
            board: DEFAULT_THRESHOLDS,
            rail: None,
            slow_pace: DEFAULT_SLOW_PACE_PERCENT,
        }
    }
}

impl Supplies {
    /// Reads `[supply]`; every key is optional.
    pub(crate) fn read(root: &Section, servos: &[Servo; 4]) -> Checked<Self> {
        if !root.has_key("supply") {
            return Ok(Self::default());
        }
        let section = root.section("supply", &["reference", "slow", "stop", "rest", "rail"])?;
        let (min, max) = REFERENCE_RANGE;
        Ok(Self {
            reference: section.number_or("reference", NOMINAL_REFERENCE, min, max, "V")?,
            board: read_thresholds(&section, BOARD_THRESHOLD_RANGE, DEFAULT_THRESHOLDS)?,
            rail: read_rail(&section, servos)?,
            slow_pace: DEFAULT_SLOW_PACE_PERCENT,
        })
    }

    /// The voltages in the core's integers.
    pub(crate) fn core_supplies(&self) -> CoreSupplies {
        CoreSupplies {
            reference_mv: to_millivolts(self.reference),
            board: thresholds_in_mv(self.board),
            rail_reference_mv: self
                .rail
                .map_or(0, |rail| to_millivolts(self.reference * rail.ratio)),
            rail: self
                .rail
                .map_or(NO_RAIL, |rail| thresholds_in_mv(rail.thresholds)),
        }
    }
}

/// The thresholds of a rail that is not measured.
const NO_RAIL: Thresholds = Thresholds {
    slow_mv: 0,
    stop_mv: 0,
    rest_mv: 0,
};

/// The voltage at the pin that measures a healthy servo rail, mV; `None` if no rail is measured. Simulations apply it,
/// because the pulses end at a rail of 0 V. The rail is assumed to be at 5 V, or at 0.5 V above its first threshold if
/// that is more.
pub fn healthy_rail_mv(supplies: &CoreSupplies) -> Option<f64> {
    /// Excess of the rail over its first threshold.
    const RESERVE_MV: f64 = 500.0;
    /// Supply of the board, and the lowest voltage of the rail.
    const BOARD_MV: f64 = 5_000.0;
    let ratio = f64::from(supplies.rail_reference_mv) / f64::from(supplies.reference_mv);
    let mv = f64::from(supplies.rail.slow_mv) + RESERVE_MV;
    (supplies.rail_reference_mv != 0)
        .then(|| (mv.max(BOARD_MV) / ratio).min(BOARD_MV - 1.0).floor())
}

/// Reads `[supply.rail]`; `None` if the table is left out.
fn read_rail(supply: &Section, servos: &[Servo; 4]) -> Checked<Option<Rail>> {
    if !supply.has_key("rail") {
        return Ok(None);
    }
    let section = supply.section("rail", &["pin", "ratio", "slow", "stop", "rest"])?;
    let pin_name = section.text("pin")?;
    let error_of = |reason: String| section.error("pin", format!("is \"{pin_name}\"{reason}"));
    let pin = parse_pin(pin_name)
        .filter(|pin| ANALOGUE_PINS.contains(pin))
        .ok_or_else(|| error_of("; it must be one of A0 to A5".to_string()))?;
    if let Some(servo) = servos.iter().position(|servo| servo.pin == pin) {
        let owner = SERVO_NAMES[servo];
        return Err(error_of(format!(", which servo.{owner} already has")));
    }
    // Up to a battery of two lithium cells, 8.4 V, through a divider of two or more.
    let ratio = section.number("ratio", 1.0, 6.0, "(rail over pin)")?;
    let has_derived_slow_threshold = !section.has_key("slow");
    let mut defaults = DEFAULT_THRESHOLDS;
    if has_derived_slow_threshold && section.has_key("stop") {
        // A placeholder until the servos are known.
        defaults[0] = f64::INFINITY;
    }
    Ok(Some(Rail {
        pin,
        ratio,
        thresholds: read_thresholds(&section, (1.0, 5.0 * ratio), defaults)?,
        has_derived_slow_threshold,
    }))
}

/// Reads three voltages, each less than the previous one.
fn read_thresholds(
    section: &Section,
    (min, max): (f64, f64),
    defaults: [f64; 3],
) -> Checked<[f64; 3]> {
    let read_voltage = |name, default| section.number_or(name, default, min, max, "V");
    let [slow, stop, rest] = defaults;
    let [slow, stop, rest] = [
        read_voltage("slow", slow)?,
        read_voltage("stop", stop)?,
        read_voltage("rest", rest)?,
    ];
    section.require_less("rest", rest, "stop", stop)?;
    section.require_less("stop", stop, "slow", slow)?;
    Ok([slow, stop, rest])
}

/// Converts thresholds from volts to millivolts.
fn thresholds_in_mv([slow, stop, rest]: [f64; 3]) -> Thresholds {
    Thresholds {
        slow_mv: to_millivolts(slow),
        stop_mv: to_millivolts(stop),
        rest_mv: to_millivolts(rest),
    }
}

fn to_millivolts(volts: f64) -> u16 {
    (1000.0 * volts).round() as u16
}

#[cfg(test)]
mod tests {
    use lizard_core::numbers::supplies::{Supplies, Thresholds};

    use crate::testing::robot_with;

    /// The header before which a test inserts its lines.
    const NEXT_TABLE: &str = "[ground]";

    /// Reads the paper's robot with these lines before `[ground]`.
    fn robot_with_supply(table: &str) -> Result<crate::Robot, crate::Error> {
        robot_with("paper", &[(NEXT_TABLE, &format!("{table}\n{NEXT_TABLE}"))])
    }

    /// Reads the paper's robot with these keys of its servos and of its rail, on this friction.
    fn robot_with_servo_and_rail(servo: &str, rail: &str, friction: &str) -> crate::Robot {
        let tables = format!(
            "[supply.rail]\npin = \"A3\"\nratio = 2.0\n{rail}\n{NEXT_TABLE}\nfriction = {friction}"
        );
        let servo = format!("[servo]\n{servo}\n[servo.A1]");
        robot_with("paper", &[("[servo.A1]", &servo), (NEXT_TABLE, &tables)]).expect(rail)
    }

    #[test]
    fn without_a_table_the_board_is_measured_by_a_reference_of_1100_mv() {
        let robot = robot_with("paper", &[]).expect("the paper's robot is valid");
        let expected = Supplies {
            reference_mv: 1100,
            board: Thresholds {
                slow_mv: 4200,
                stop_mv: 4000,
                rest_mv: 3700,
            },
            rail_reference_mv: 0,
            ..robot.firmware().supplies()
        };
        assert_eq!(robot.firmware().supplies(), expected);
    }

    #[test]
    fn a_rails_reference_is_the_chips_reference_times_the_ratio_of_the_divider() {
        let robot = robot_with_supply(
            "[supply]\nreference = 1.08\nslow = 4.5\n[supply.rail]\npin = \"A3\"\nratio = 2.5\nslow = 6.6\nstop = 6.2\nrest = 6.0\n",
        )
        .expect("the rail is valid");
        let supplies = robot.firmware().supplies();
        assert_eq!(
            (supplies.reference_mv, supplies.board.slow_mv),
            (1080, 4500)
        );
        let rail = Thresholds {
            slow_mv: 6600,
            stop_mv: 6200,
            rest_mv: 6000,
        };
        assert_eq!((supplies.rail_reference_mv, supplies.rail), (2700, rail));
        assert_eq!(robot.firmware().rail_pin(), Some(17));
    }

    #[test]
    fn the_slow_threshold_is_where_the_servos_are_near_their_torque_speed_line() {
        let slow_volts_with = |servo: &str, rail: &str, friction: &str| {
            let robot = robot_with_servo_and_rail(servo, rail, friction);
            f64::from(robot.firmware().supplies().rail.slow_mv) / 1000.0
        };
        let sg90_volts = slow_volts_with("", "", "0.6");
        let robot = robot_with("paper", &[(NEXT_TABLE, "[ground]\nfriction = 0.6")])
            .expect("the robot is valid");
        let effort_of = |gait| crate::Effort::of(gait, robot.ground(), &robot.motors());
        let largest_share = |supply| {
            let shares = robot
                .gaits()
                .iter()
                .map(|gait| effort_of(gait).line_share(1.0, supply));
            shares.fold(0.0, f64::max)
        };
        // On this floor the servos would allow slightly less than stop + 0.25 V, so that minimum is the threshold.
        let expected = (4.8 * largest_share(1.0) / crate::HIGH_LINE_SHARE).max(4.25);
        assert!(
            (sg90_volts - expected).abs() < 0.01,
            "{sg90_volts} {expected}"
        );
        // More friction requires a higher threshold; a given threshold stays.
        let rough_volts = slow_volts_with("", "", "0.8");
        let supply_share = rough_volts / 4.8;
        assert!(rough_volts > sg90_volts + 0.1, "{rough_volts}");
        let rough_robot = robot_with("paper", &[(NEXT_TABLE, "[ground]\nfriction = 0.8")])
            .expect("the robot is valid");
        let shares = rough_robot.gaits().iter().map(|gait| {
            let effort = crate::Effort::of(gait, rough_robot.ground(), &rough_robot.motors());
            effort.line_share(1.0, supply_share)
        });
        let largest_share = shares.fold(0.0, f64::max);
        assert!(
            (largest_share - crate::HIGH_LINE_SHARE).abs() < 0.005,
            "{largest_share}"
        );
        assert_eq!(slow_volts_with("", "slow = 4.3", "0.8"), 4.3);
        // If a servo exceeds its line even at its own supply, the threshold still stays below that supply.
        assert_eq!(slow_volts_with("model = \"copy\"", "", "1.2"), 4.55);
        // A battery of two lithium cells, and servos for that voltage.
        let two_cells_volts = slow_volts_with("at_volts = 8.0", "stop = 6.4\nrest = 6.0", "0.7");
        assert!((6.65..7.75).contains(&two_cells_volts), "{two_cells_volts}");
    }

    /// Returns two paces of the paper's robot with changed servos, thresholds and friction, percent: its slow pace, and
    /// the highest pace at which no gait exceeds the allowed share of the torque-speed line, found by a search.
    fn slow_paces(servo: &str, rail: &str, friction: &str) -> [u8; 2] {
        let robot = robot_with_servo_and_rail(servo, rail, friction);
        let rail = robot.supplies().rail.expect("the rail is measured");
        let [_, stop, _] = rail.thresholds;
        let servo_volts = robot.servo_type().volts;
        let effort_of = |gait| crate::Effort::of(gait, robot.ground(), &robot.motors());
        let efforts: Vec<_> = robot.gaits().iter().map(effort_of).collect();
        let is_sustainable = |percent: &u8| {
            let share_of = |effort: &crate::Effort| {
                effort.line_share(f64::from(*percent) / 100.0, stop / servo_volts)
            };
            efforts
                .iter()
                .all(|effort| share_of(effort) <= crate::HIGH_LINE_SHARE)
        };
        let searched_pace = (10..=100).rev().find(is_sustainable).unwrap_or(10);
        [robot.firmware().slow_pace(), searched_pace]
    }

    #[test]
    fn the_slow_pace_is_the_fastest_that_the_servos_sustain_at_the_stop_voltage() {
        let [default_pace, searched_pace] = slow_paces("", "", "0.7");
        assert_eq!(default_pace, searched_pace);
        let [rough_pace, searched_pace] = slow_paces("", "", "0.9");
        assert_eq!(rough_pace, searched_pace);
        assert!(
            (11..default_pace).contains(&rough_pace) && default_pace < 100,
            "{rough_pace} {default_pace}"
        );
        // The same is true if the threshold is given. A robot that stops at a higher voltage may walk faster.
        let [given_pace, searched_pace] = slow_paces("", "slow = 4.7\nstop = 4.5", "0.9");
        assert_eq!(given_pace, searched_pace);
        assert!(given_pace > rough_pace, "{given_pace} {rough_pace}");
        // The first servos sustain no pace, the second sustain every pace.
        let slowest_paces = slow_paces("model = \"copy\"", "stop = 3.0\nrest = 2.8", "1.2");
        assert_eq!(slowest_paces, [10, 10]);
        assert_eq!(slow_paces("model = \"MG90S\"", "", "0.2"), [100, 100]);
    }

    #[test]
    fn without_a_rail_a_low_supply_halves_the_pace() {
        let robot = robot_with("paper", &[]).expect("the paper's robot is valid");
        assert_eq!(robot.firmware().slow_pace(), 50);
    }

    #[test]
    fn a_servos_pin_is_refused_for_the_rail() {
        let refusal = robot_with(
            "paper",
            &[
                ("pin = \"D9\"", "pin = \"A2\""),
                (
                    NEXT_TABLE,
                    "[supply.rail]\npin = \"A2\"\nratio = 2.0\n[ground]",
                ),
            ],
        );
        let refusal = refusal.expect_err("the pin belongs to a servo").to_string();
        assert!(refusal.contains("which servo.A1 already has"), "{refusal}");
    }
}
