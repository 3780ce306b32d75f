//! The supply voltages of the board and of the servos: their measurement, and the thresholds at which the robot slows
//! down, stops and rests.

use lizard_core::control::supply::HYSTERESIS_MV;
use lizard_core::numbers::supplies::{Supplies as CoreSupplies, Thresholds};

use crate::config::servo::{UsedPins, claim_pin, parse_pin};
use crate::file::{Error, ReadResult, Table};

/// The nominal voltage reference of an ATmega328P, V: data sheet, section 29.8.
const NOMINAL_REFERENCE: f64 = 1.1;
/// Range of the voltage reference, V.
const REFERENCE_RANGE: (f64, f64) = (1.0, 1.2);

/// Range of the board's thresholds, V: the brown-out detector resets the chip at 2.7 V, and the chip tolerates 5.5 V.
const BOARD_THRESHOLD_RANGE: (f64, f64) = (2.7, 5.5);

/// The highest voltage that an analogue pin measures: the board's supply, V.
const MAX_PIN_VOLTS: f64 = 5.0;

/// Default thresholds `slow`, `stop` and `rest`, V: gaits slow down below `slow`, the robot stops below `stop`, and the
/// pulses end below `rest`. If its reference differs from the nominal value, a healthy board may read only 4.3 V.
const DEFAULT_THRESHOLDS: [f64; 3] = [4.2, 4.0, 3.7];

/// Rating of the fuse, A. The fuse carries up to 2.8 A: to supply 3 A at 5 V with a loss of 15 %, the converter draws
/// this current from a nearly empty battery of 6.4 V. The fuse must blow before the switch is overloaded. Only half of
/// the switch's rating counts, because the rating is for alternating current, and direct current is harder to
/// interrupt.
pub const FUSE_RATING_A: u32 = 3;
/// The smallest rating of the switch, A. See [`FUSE_RATING_A`].
pub const MIN_SWITCH_RATING_A: u32 = 6;
const _: () = assert!(2 * FUSE_RATING_A <= MIN_SWITCH_RATING_A);

/// The Arduino numbers of the analogue pins A0 to A5.
const ANALOGUE_PINS: std::ops::RangeInclusive<u8> = 14..=19;

/// The chip's voltage reference, and the voltages (V) below which gaits slow down, the robot stops, and the pulses end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Supplies {
    /// Voltage of the chip's internal reference, V.
    pub reference_volts: f64,
    /// Thresholds of the board's supply in descending order: `slow`, `stop` and `rest`, V.
    pub board_thresholds: [f64; 3],
    /// The servos' rail; `None` if the rail is not measured.
    pub rail: Option<Rail>,
    /// Pace limit below the `slow` threshold, percent of a gait's nominal pace. It follows from the servos if their
    /// rail is measured; the board's supply does not determine the servos' torque.
    pub slow_pace_percent: u8,
}

/// A servo rail that is measured at an analogue pin through a divider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rail {
    /// Arduino number of the pin, 14 to 19.
    pub pin: u8,
    /// The rail's voltage divided by the pin's voltage.
    pub divider_ratio: f64,
    /// Thresholds of the rail in descending order: `slow`, `stop` and `rest`, V.
    pub thresholds: [f64; 3],
    /// True if robot.toml omits the `slow` threshold, which is then derived from the servos.
    pub has_derived_slow_threshold: bool,
}

/// Smallest distance of a derived `slow` threshold from `stop`, which is lower, and from the servos' supply, which is
/// higher, V. It exceeds [`HYSTERESIS_MV`].
const MIN_THRESHOLD_GAP: f64 = 0.25;

/// The pace limit at a low supply voltage if the servos' rail is not measured, percent.
const DEFAULT_SLOW_PACE_PERCENT: u8 = 50;
/// The slowest pace that the command `speed` accepts, percent.
const MIN_PACE_PERCENT: f64 = 10.0;

impl Rail {
    /// Sets the `slow` threshold if it is derived from the servos. `utilisation` is the most demanding gait's
    /// utilisation of the servos at the supply `volts`; below the threshold it would exceed `limit`.
    pub(crate) fn derive_slow_threshold(&mut self, utilisation: f64, limit: f64, volts: f64) {
        let [slow, stop, _] = &mut self.thresholds;
        let min = *stop + MIN_THRESHOLD_GAP;
        // Rounded to hundredths. The threshold stays below the supply itself; otherwise the robot would always be slow.
        let slow_volts = (100.0 * volts * utilisation / limit).round() / 100.0;
        if self.has_derived_slow_threshold {
            *slow = slow_volts.min(volts - MIN_THRESHOLD_GAP).max(min);
        }
    }
}

impl Supplies {
    /// Sets the pace limit at a low supply to `pace`, relative to a gait's nominal pace.
    pub(crate) fn set_slow_pace(&mut self, pace: f64) {
        self.slow_pace_percent = (100.0 * pace).floor().max(MIN_PACE_PERCENT) as u8;
    }

    /// Reads `[supply]`; every key is optional.
    pub(crate) fn read(root: &Table, used_pins: &mut UsedPins) -> ReadResult<Self> {
        let keys = ["reference", "slow", "stop", "rest", "rail"];
        let table = root.optional_table("supply", &keys)?;
        Ok(Self {
            reference_volts: table.number_or(
                "reference",
                NOMINAL_REFERENCE,
                REFERENCE_RANGE,
                "V",
            )?,
            board_thresholds: read_thresholds(&table, BOARD_THRESHOLD_RANGE, DEFAULT_THRESHOLDS)?,
            rail: read_rail(&table, used_pins)?,
            slow_pace_percent: DEFAULT_SLOW_PACE_PERCENT,
        })
    }

    /// Rejects a divider that passes on more of `servo_volts`, the servos' supply, than the rail's pin can measure.
    /// Also rejects thresholds so high that this supply would never recover from `slow`, or that leave no room for a
    /// derived `slow`.
    pub(crate) fn check_rail(&self, servo_volts: f64) -> ReadResult<()> {
        let Some(rail) = &self.rail else {
            return Ok(());
        };
        let ratio = rail.divider_ratio;
        // The subtraction keeps a rounding error from rejecting a ratio that is just sufficient.
        let min_ratio = servo_volts / MAX_PIN_VOLTS - 1e-9;
        if ratio < min_ratio {
            // Rounded up, so that the ratio in the message is sufficient.
            let min_ratio = (100.0 * min_ratio).ceil() / 100.0;
            let message = format!(
                "is {ratio}; for servo.volts = {servo_volts} it must be at least {min_ratio}, because the pin measures at most {MAX_PIN_VOLTS} V"
            );
            return Err(Error::new("supply.rail.ratio", message));
        }
        let [slow, stop, _] = rail.thresholds;
        let (key, volts, bound, reason) = match rail.has_derived_slow_threshold {
            // The derived threshold needs a gap on both sides.
            true => {
                let bound = servo_volts - 2.0 * MIN_THRESHOLD_GAP;
                (
                    "stop",
                    stop,
                    bound,
                    "there is no room for `slow` between them",
                )
            }
            false => {
                let bound = servo_volts - f64::from(HYSTERESIS_MV) / 1000.0;
                let reason = "the robot would never return to full pace after a dip";
                ("slow", slow, bound, reason)
            }
        };
        if volts < bound {
            return Ok(());
        }
        let message = format!(
            "is {volts}; for servo.volts = {servo_volts} it must be less than {bound:.2}, or {reason}"
        );
        Err(Error::new(format!("supply.rail.{key}"), message))
    }

    /// Converts the supplies to the core's form, in mV.
    pub(crate) fn to_core(self) -> CoreSupplies {
        CoreSupplies {
            reference_mv: to_millivolts(self.reference_volts),
            board: thresholds_to_mv(self.board_thresholds),
            rail_reference_mv: self.rail.map_or(0, |rail| {
                to_millivolts(self.reference_volts * rail.divider_ratio)
            }),
            // The thresholds of a rail that is not measured are 0.
            rail: thresholds_to_mv(self.rail.map_or([0.0; 3], |rail| rail.thresholds)),
        }
    }
}

/// The voltage at the pin that measures a healthy servo rail, mV; `None` if no rail is measured. Simulations apply this
/// voltage, because the firmware would end the pulses at a rail of 0 V. The rail is assumed to be at 5 V, or 0.5 V
/// above its `slow` threshold if that is higher.
pub fn healthy_rail_pin_mv(supplies: &CoreSupplies) -> Option<f64> {
    /// Assumed margin of the rail above its `slow` threshold.
    const HEADROOM_MV: f64 = 500.0;
    /// Supply of the board, and the lowest rail voltage that is assumed.
    const BOARD_MV: f64 = 5_000.0;
    let ratio = f64::from(supplies.rail_reference_mv) / f64::from(supplies.reference_mv);
    let rail_mv = f64::from(supplies.rail.slow_mv) + HEADROOM_MV;
    (supplies.rail_reference_mv != 0)
        .then(|| (rail_mv.max(BOARD_MV) / ratio).min(BOARD_MV - 1.0).floor())
}

/// Reads `[supply.rail]`; `None` if the table is missing.
fn read_rail(supply: &Table, used_pins: &mut UsedPins) -> ReadResult<Option<Rail>> {
    if !supply.has_key("rail") {
        return Ok(None);
    }
    let table = supply.table("rail", &["pin", "ratio", "slow", "stop", "rest"])?;
    let pin_name = table.text("pin")?;
    let Some(pin) = parse_pin(pin_name).filter(|pin| ANALOGUE_PINS.contains(pin)) else {
        let message = format!("is \"{pin_name}\"; it must be one of A0 to A5");
        return Err(table.error("pin", message));
    };
    claim_pin(&table, pin, used_pins)?;
    // Covers a battery of two lithium cells, 8.4 V, which needs a ratio of at least 1.68.
    let divider_ratio = table.number("ratio", (1.0, 6.0), "(rail voltage / pin voltage)")?;
    let has_derived_slow_threshold = !table.has_key("slow");
    let mut defaults = DEFAULT_THRESHOLDS;
    if has_derived_slow_threshold && table.has_key("stop") {
        // A placeholder above every `stop`, until the servos are known.
        defaults[0] = f64::INFINITY;
    }
    Ok(Some(Rail {
        pin,
        divider_ratio,
        thresholds: read_thresholds(&table, (1.0, MAX_PIN_VOLTS * divider_ratio), defaults)?,
        has_derived_slow_threshold,
    }))
}

/// Reads three voltages, each less than the previous one.
fn read_thresholds(table: &Table, range: (f64, f64), defaults: [f64; 3]) -> ReadResult<[f64; 3]> {
    let read_voltage = |name, default| table.number_or(name, default, range, "V");
    let slow = read_voltage("slow", defaults[0])?;
    let stop = read_voltage("stop", defaults[1])?;
    let rest = read_voltage("rest", defaults[2])?;
    table.require_less("rest", rest, "stop", stop)?;
    table.require_less("stop", stop, "slow", slow)?;
    Ok([slow, stop, rest])
}

/// Converts thresholds from volts to millivolts.
fn thresholds_to_mv([slow, stop, rest]: [f64; 3]) -> Thresholds {
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
    use lizard_core::numbers::supplies::Thresholds;

    use crate::testing::{
        assert_contains, assert_near, error_with, paper_with_tables, robot, robot_with,
        valid_robot_with,
    };

    /// The header before which a test inserts its lines.
    const NEXT_TABLE: &str = "[ground]";

    /// Reads the paper's robot with these servo and rail keys, and with this friction coefficient.
    fn robot_with_servo_and_rail(servo: &str, rail: &str, friction: &str) -> crate::Robot {
        let tables = format!(
            "[supply.rail]\npin = \"A3\"\nratio = 2.0\n{rail}\n{NEXT_TABLE}\nfriction = {friction}"
        );
        let servo = format!("[servo]\n{servo}\n[servo.A1]");
        robot_with("paper", &[("[servo.A1]", &servo), (NEXT_TABLE, &tables)]).expect(rail)
    }

    #[test]
    fn the_defaults_are_a_1100_mv_reference_three_thresholds_and_no_rail() {
        let supplies = robot("paper").firmware().supplies();
        let board = supplies.board;
        let board_mv = [board.slow_mv, board.stop_mv, board.rest_mv];
        assert_eq!(board_mv, [4200, 4000, 3700]);
        assert_eq!(supplies.reference_mv, 1100);
        assert_eq!(supplies.rail_reference_mv, 0);
    }

    #[test]
    fn a_rails_reference_is_the_chips_reference_times_the_divider_ratio() {
        let tables = "[servo]\nvolts = 7.4\n[supply]\nreference = 1.08\nslow = 4.5\n[supply.rail]\npin = \"A3\"\nratio = 2.5\nslow = 6.6\nstop = 6.2\nrest = 6.0\n";
        let robot = paper_with_tables(tables).expect("the rail is valid");
        let supplies = robot.firmware().supplies();
        let board_mv = (supplies.reference_mv, supplies.board.slow_mv);
        assert_eq!(board_mv, (1080, 4500));
        let rail = Thresholds {
            slow_mv: 6600,
            stop_mv: 6200,
            rest_mv: 6000,
        };
        assert_eq!((supplies.rail_reference_mv, supplies.rail), (2700, rail));
        assert_eq!(robot.firmware().rail_pin(), Some(17));
    }

    #[test]
    fn the_slow_threshold_is_the_voltage_at_which_the_servos_reach_the_allowed_utilisation() {
        let slow_volts_with = |servo: &str, rail: &str, friction: &str| {
            let robot = robot_with_servo_and_rail(servo, rail, friction);
            f64::from(robot.firmware().supplies().rail.slow_mv) / 1000.0
        };
        let sg90_volts = slow_volts_with("", "", "0.6");
        let find_max_utilisation = |friction: &str, relative_supply: f64| {
            let table = format!("[ground]\nfriction = {friction}");
            let robot = valid_robot_with("paper", &[(NEXT_TABLE, &table)]);
            let simulate = |gait| crate::Effort::simulate(gait, robot.ground(), &robot.motors());
            let efforts = robot.gaits().iter().map(simulate);
            let utilisations = efforts.map(|effort| effort.utilisation(1.0, relative_supply));
            utilisations.fold(0.0, f64::max)
        };
        let max_utilisation = find_max_utilisation("0.6", 1.0);
        // On this floor the servos would allow slightly less than stop + 0.25 V, so the minimum gap sets the threshold.
        let expected = (4.8 * max_utilisation / crate::HIGH_UTILISATION).max(4.25);
        assert_near(sg90_volts, expected, 0.01);
        // More friction requires a higher threshold; an explicit threshold is kept.
        let rough_volts = slow_volts_with("", "", "0.8");
        assert!(rough_volts > sg90_volts + 0.1, "{rough_volts} V");
        let max_utilisation = find_max_utilisation("0.8", rough_volts / 4.8);
        assert_near(max_utilisation, crate::HIGH_UTILISATION, 0.005);
        assert_eq!(slow_volts_with("", "slow = 4.3", "0.8"), 4.3);
        // Even if a servo exceeds its torque-speed line at its own supply, the threshold stays below this supply.
        assert_eq!(slow_volts_with("model = \"copy\"", "", "1.2"), 4.55);
        // A battery of two lithium cells, and servos for that voltage.
        let two_cells_volts = slow_volts_with("at_volts = 8.0", "stop = 6.4\nrest = 6.0", "0.7");
        assert!(
            (6.65..7.75).contains(&two_cells_volts),
            "{two_cells_volts} V"
        );
    }

    /// Returns two paces of the paper's robot with changed servos, thresholds and friction, percent: its slow pace, and
    /// the highest pace at which no gait exceeds the allowed utilisation, found by a search.
    fn find_slow_paces(servo: &str, rail: &str, friction: &str) -> [u8; 2] {
        let robot = robot_with_servo_and_rail(servo, rail, friction);
        let rail = robot.supplies().rail.expect("the rail is measured");
        let [_, stop, _] = rail.thresholds;
        let servo_volts = robot.servo_type().supply_volts;
        let simulate = |gait| crate::Effort::simulate(gait, robot.ground(), &robot.motors());
        let efforts: Vec<_> = robot.gaits().iter().map(simulate).collect();
        let is_sustainable = |percent: &u8| {
            efforts.iter().all(|effort| {
                let pace = f64::from(*percent) / 100.0;
                effort.utilisation(pace, stop / servo_volts) <= crate::HIGH_UTILISATION
            })
        };
        let expected_pace = (10..=100).rev().find(is_sustainable).unwrap_or(10);
        [robot.firmware().slow_pace(), expected_pace]
    }

    #[test]
    fn the_slow_pace_is_the_highest_that_the_servos_sustain_at_the_stop_voltage() {
        let [default_pace, expected_pace] = find_slow_paces("", "", "0.7");
        assert_eq!(default_pace, expected_pace);
        let [rough_pace, expected_pace] = find_slow_paces("", "", "0.9");
        assert_eq!(rough_pace, expected_pace);
        assert!(
            (11..default_pace).contains(&rough_pace) && default_pace < 100,
            "rough floor {rough_pace} %, default {default_pace} %"
        );
        // The same holds with an explicit threshold. A robot that stops at a higher voltage may walk faster.
        let [explicit_threshold_pace, expected_pace] =
            find_slow_paces("", "slow = 4.6\nstop = 4.4", "0.9");
        assert_eq!(explicit_threshold_pace, expected_pace);
        assert!(
            explicit_threshold_pace > rough_pace,
            "explicit threshold {explicit_threshold_pace} %, derived threshold {rough_pace} %"
        );
        // The `copy` servos sustain no pace, the MG90S sustain every pace.
        let slowest_paces = find_slow_paces("model = \"copy\"", "stop = 3.0\nrest = 2.8", "1.2");
        assert_eq!(slowest_paces, [10, 10]);
        assert_eq!(find_slow_paces("model = \"MG90S\"", "", "0.2"), [100, 100]);
    }

    #[test]
    fn a_low_supply_halves_the_pace_if_the_rail_is_not_measured() {
        assert_eq!(robot("paper").firmware().slow_pace(), 50);
    }

    #[test]
    fn the_rail_rejects_a_pin_used_by_a_servo() {
        let tables = "[supply.rail]\npin = \"A2\"\nratio = 2.0\n[ground]";
        let changes = [("pin = \"D9\"", "pin = \"A2\""), (NEXT_TABLE, tables)];
        let message = error_with("paper", &changes);
        assert_contains(&message, "which servo.A1 already uses");
    }
}
