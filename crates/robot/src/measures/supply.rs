//! The supply voltages of the board and of the servos: how they are measured, and the thresholds at which the robot
//! slows down, stops and rests.

use lizard_core::numbers::supplies::{Supplies as CoreSupplies, Thresholds};

use crate::file::{Checked, Section};
use crate::measures::servo::{NAMES, Servo, parse_pin};

/// The nominal voltage reference of an ATmega328P, V: data sheet, section 29.8.
const REFERENCE: f64 = 1.1;
/// Range of the voltage reference, V.
const REFERENCES: (f64, f64) = (1.0, 1.2);

/// Range of the thresholds of the board's supply, V: the brown-out detector resets the chip at 2.7, and the chip
/// tolerates 5.5.
const BOARD: (f64, f64) = (2.7, 5.5);

/// Default thresholds, V: low, too low to move, too low to hold. With an unmeasured reference, a healthy board may
/// be measured as 4.3 V.
const DEFAULTS: [f64; 3] = [4.2, 4.0, 3.7];

/// Rating of the fuse, A. It carries 2.8 A: the converter draws this current from an empty battery of 6.4 V for 3 A
/// at 5 V, with a loss of 15 %. The fuse must blow before the switch is overloaded. Half of the switch's rating
/// counts, because the rating is for alternating current, and direct current is harder to interrupt.
pub const FUSE: u32 = 3;
/// The smallest rating of the switch, A. See [`FUSE`].
pub const SWITCH: u32 = 6;
const _: () = assert!(2 * FUSE <= SWITCH);

/// The Arduino numbers of the analogue pins A0 to A5.
const ANALOGUE: std::ops::RangeInclusive<u8> = 14..=19;

/// The chip's voltage reference, and the falling voltages (V) below which gaits slow down, the robot stops, and its
/// pulses end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Supplies {
    /// Voltage of the chip's internal reference, V.
    pub reference: f64,
    /// Thresholds of the board's supply, V.
    pub board: [f64; 3],
    /// The servos' rail; `None` if it is not measured.
    pub rail: Option<Rail>,
    /// Percentage of their own pace to which gaits are limited below the first threshold. The percentage follows
    /// from the servos if their rail is measured; the board's supply says nothing about the servos' torque-speed
    /// line.
    pub slow_pace: u8,
}

/// A servo rail that is measured at an analogue pin through a divider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rail {
    /// Arduino number of the pin, 14 to 19.
    pub pin: u8,
    /// The rail's voltage divided by the pin's voltage.
    pub ratio: f64,
    /// Thresholds of the rail, V.
    pub thresholds: [f64; 3],
    /// True if the first threshold is left out, so that it follows from the servos.
    pub follows_servos: bool,
}

/// Smallest distance between the first threshold and the one below it, and between the supply and the first
/// threshold, V: more than the 0.15 V by which a supply must recover before the robot is fast again.
const MIN_THRESHOLD_GAP: f64 = 0.25;

/// The pace at a low supply if the servos' rail, and so their torque-speed line, is not measured, percent.
const DEFAULT_PACE: u8 = 50;
/// The slowest pace that the command `speed` accepts, percent.
const SLOWEST_PACE: f64 = 10.0;

impl Rail {
    /// Sets the first threshold, if robot.toml leaves it to the servos: the voltage below which the hardest gait
    /// would use more than `share` of the servos' torque-speed line. `used_share` is the share that this gait uses at
    /// `volts`.
    pub(crate) fn set_slow_threshold(&mut self, used_share: f64, share: f64, volts: f64) {
        let [slow, stop, _] = &mut self.thresholds;
        let min = *stop + MIN_THRESHOLD_GAP;
        // Rounded to hundredths. The threshold stays below the supply itself, or the robot would always be slow.
        let slow_volts = (100.0 * volts * used_share / share).round() / 100.0;
        if self.follows_servos {
            *slow = slow_volts.min(volts - MIN_THRESHOLD_GAP).max(min);
        }
    }
}

impl Supplies {
    /// Limits the pace of gaits at a low supply to `pace`, a share of their own pace.
    pub(crate) fn limit_pace(&mut self, pace: f64) {
        self.slow_pace = (100.0 * pace).floor().max(SLOWEST_PACE) as u8;
    }
}

impl Default for Supplies {
    fn default() -> Self {
        Self {
            reference: REFERENCE,
            board: DEFAULTS,
            rail: None,
            slow_pace: DEFAULT_PACE,
        }
    }
}

impl Supplies {
    /// Reads `[supply]`; every key is optional.
    pub(crate) fn read(root: &Section, servos: &[Servo; 4]) -> Checked<Self> {
        if !root.has("supply") {
            return Ok(Self::default());
        }
        let section = root.section("supply", &["reference", "slow", "stop", "rest", "rail"])?;
        let (min, max) = REFERENCES;
        Ok(Self {
            reference: section.number_or("reference", REFERENCE, min, max, "V")?,
            board: read_thresholds(&section, BOARD, DEFAULTS)?,
            rail: read_rail(&section, servos)?,
            slow_pace: DEFAULT_PACE,
        })
    }

    /// Converts the voltages to the integers of the core.
    pub(crate) fn numbers(&self) -> CoreSupplies {
        CoreSupplies {
            reference: to_millivolts(self.reference),
            board: thresholds_in_mv(self.board),
            rail_reference: self
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
    slow: 0,
    stop: 0,
    rest: 0,
};

/// The voltage at the pin that measures a healthy servo rail, mV; `None` if no rail is measured. Simulations need it,
/// since a rail of 0 V ends the pulses. The rail is taken to be at 5 V, or at 0.5 V above its first threshold if that
/// is more.
pub fn healthy_rail_mv(supplies: &CoreSupplies) -> Option<f64> {
    const RESERVE: f64 = 500.0;
    const BOARD: f64 = 5_000.0;
    let ratio = f64::from(supplies.rail_reference) / f64::from(supplies.reference);
    let mv = f64::from(supplies.rail.slow) + RESERVE;
    (supplies.rail_reference != 0).then(|| (mv.max(BOARD) / ratio).min(BOARD - 1.0).floor())
}

fn read_rail(supply: &Section, servos: &[Servo; 4]) -> Checked<Option<Rail>> {
    if !supply.has("rail") {
        return Ok(None);
    }
    let section = supply.section("rail", &["pin", "ratio", "slow", "stop", "rest"])?;
    let text = section.text("pin")?;
    let fault_of = |reason: String| section.fault("pin", format!("is \"{text}\"{reason}"));
    let pin = parse_pin(text)
        .filter(|pin| ANALOGUE.contains(pin))
        .ok_or_else(|| fault_of("; it must be one of A0 to A5".to_string()))?;
    if let Some(servo) = servos.iter().position(|servo| servo.pin == pin) {
        let owner = NAMES[servo];
        return Err(fault_of(format!(", which servo.{owner} already has")));
    }
    // Up to a battery of two lithium cells, 8.4 V, through a divider of two or more.
    let ratio = section.number("ratio", 1.0, 6.0, "(rail over pin)")?;
    let follows_servos = !section.has("slow");
    let mut defaults = DEFAULTS;
    if follows_servos && section.has("stop") {
        // A placeholder until the servos are known.
        defaults[0] = f64::INFINITY;
    }
    Ok(Some(Rail {
        pin,
        ratio,
        thresholds: read_thresholds(&section, (1.0, 5.0 * ratio), defaults)?,
        follows_servos,
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

fn thresholds_in_mv([slow, stop, rest]: [f64; 3]) -> Thresholds {
    Thresholds {
        slow: to_millivolts(slow),
        stop: to_millivolts(stop),
        rest: to_millivolts(rest),
    }
}

fn to_millivolts(volts: f64) -> u16 {
    (1000.0 * volts).round() as u16
}

#[cfg(test)]
mod tests {
    use lizard_core::numbers::supplies::{Supplies, Thresholds};

    use crate::testing::with;

    const NEXT_TABLE: &str = "[ground]";

    fn robot_with_supply(table: &str) -> Result<crate::Robot, crate::Error> {
        with("paper", &[(NEXT_TABLE, &format!("{table}\n{NEXT_TABLE}"))])
    }

    #[test]
    fn without_a_table_the_board_is_measured_by_a_reference_of_1100_mv() {
        let robot = with("paper", &[]).expect("the paper's");
        let expected = Supplies {
            reference: 1100,
            board: Thresholds {
                slow: 4200,
                stop: 4000,
                rest: 3700,
            },
            rail_reference: 0,
            ..robot.firmware().supplies()
        };
        assert_eq!(robot.firmware().supplies(), expected);
    }

    #[test]
    fn a_rail_has_the_divider_in_its_reference() {
        let robot = robot_with_supply(
            "[supply]\nreference = 1.08\nslow = 4.5\n[supply.rail]\npin = \"A3\"\nratio = 2.5\nslow = 6.6\nstop = 6.2\nrest = 6.0\n",
        )
        .expect("a rail");
        let supplies = robot.firmware().supplies();
        assert_eq!((supplies.reference, supplies.board.slow), (1080, 4500));
        let rail = Thresholds {
            slow: 6600,
            stop: 6200,
            rest: 6000,
        };
        assert_eq!((supplies.rail_reference, supplies.rail), (2700, rail));
        assert_eq!(robot.firmware().rail_pin(), Some(17));
    }

    #[test]
    fn a_rail_slows_the_robot_down_where_its_servos_would_be_near_their_line() {
        let slow_volts_with = |servo: &str, rail: &str, friction: &str| {
            let tables = format!(
                "[supply.rail]\npin = \"A3\"\nratio = 2.0\n{rail}\n{NEXT_TABLE}\nfriction = {friction}"
            );
            let servo = format!("[servo]\n{servo}\n[servo.A1]");
            let robot =
                with("paper", &[("[servo.A1]", &servo), (NEXT_TABLE, &tables)]).expect(rail);
            f64::from(robot.firmware().supplies().rail.slow) / 1000.0
        };
        let sg90_volts = slow_volts_with("", "", "0.6");
        let robot = with("paper", &[(NEXT_TABLE, "[ground]\nfriction = 0.6")]).expect("right");
        let effort_of = |gait| crate::Effort::of(gait, robot.ground(), &robot.motors());
        let largest_share = |supply| {
            let shares = robot
                .gaits()
                .iter()
                .map(|gait| effort_of(gait).line_share(1.0, supply));
            shares.fold(0.0, f64::max)
        };
        // On this floor the servos would allow slightly less than stop + 0.25 V, so this minimum is the threshold.
        let expected = (4.8 * largest_share(1.0) / crate::HIGH_LINE_SHARE).max(4.25);
        assert!(
            (sg90_volts - expected).abs() < 0.01,
            "{sg90_volts} {expected}"
        );
        // More friction requires a higher threshold; a given threshold stays.
        let rough_volts = slow_volts_with("", "", "0.8");
        let supply_share = rough_volts / 4.8;
        assert!(rough_volts > sg90_volts + 0.1, "{rough_volts}");
        let gripping_robot =
            with("paper", &[(NEXT_TABLE, "[ground]\nfriction = 0.8")]).expect("right");
        let shares = gripping_robot.gaits().iter().map(|gait| {
            let effort = crate::Effort::of(gait, gripping_robot.ground(), &gripping_robot.motors());
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

    /// The slow pace, percent, of the paper's robot with changed servos, thresholds and friction, and the pace that a
    /// search finds independently: the highest percentage at which no gait exceeds the allowed share of the
    /// torque-speed line.
    fn slow_paces(servo: &str, rail: &str, friction: f64) -> [u8; 2] {
        let tables = format!(
            "[supply.rail]\npin = \"A3\"\nratio = 2.0\n{rail}\n{NEXT_TABLE}\nfriction = {friction}"
        );
        let servo = format!("[servo]\n{servo}\n[servo.A1]");
        let robot = with("paper", &[("[servo.A1]", &servo), (NEXT_TABLE, &tables)]).expect(rail);
        let [_, stop, _] = robot.supplies().rail.expect("a rail").thresholds;
        let own_volts = robot.servo_type().volts;
        let effort_of = |gait| crate::Effort::of(gait, robot.ground(), &robot.motors());
        let efforts: Vec<_> = robot.gaits().iter().map(effort_of).collect();
        let is_followed = |percent: &u8| {
            let share_of = |effort: &crate::Effort| {
                effort.line_share(f64::from(*percent) / 100.0, stop / own_volts)
            };
            efforts
                .iter()
                .all(|effort| share_of(effort) <= crate::HIGH_LINE_SHARE)
        };
        let searched = (10..=100).rev().find(is_followed).unwrap_or(10);
        [robot.firmware().slow_pace(), searched]
    }

    #[test]
    fn below_its_threshold_a_robot_is_as_fast_as_its_servos_line_allows_where_it_stops() {
        let [even_pace, searched] = slow_paces("", "", 0.7);
        assert_eq!(even_pace, searched);
        let [rough_pace, searched] = slow_paces("", "", 0.9);
        assert_eq!(rough_pace, searched);
        assert!(
            (11..even_pace).contains(&rough_pace) && even_pace < 100,
            "{rough_pace} {even_pace}"
        );
        // This also holds if the threshold is given. A robot that stops at a higher voltage may go faster.
        let [given_pace, searched] = slow_paces("", "slow = 4.7\nstop = 4.5", 0.9);
        assert_eq!(given_pace, searched);
        assert!(given_pace > rough_pace, "{given_pace} {rough_pace}");
        // In one robot no pace is slow enough, in the other no pace is too fast.
        assert_eq!(
            slow_paces("model = \"copy\"", "stop = 3.0\nrest = 2.8", 1.2),
            [10, 10]
        );
        assert_eq!(slow_paces("model = \"MG90S\"", "", 0.2), [100, 100]);
    }

    #[test]
    fn without_a_rail_a_low_supply_halves_the_pace() {
        let robot = with("paper", &[]).expect("the paper's");
        assert_eq!(robot.firmware().slow_pace(), 50);
    }

    #[test]
    fn a_pin_of_a_servo_measures_no_rail() {
        let refusal = with(
            "paper",
            &[
                ("pin = \"D9\"", "pin = \"A2\""),
                (
                    NEXT_TABLE,
                    "[supply.rail]\npin = \"A2\"\nratio = 2.0\n[ground]",
                ),
            ],
        );
        let refusal = refusal.expect_err("a pin of a servo").to_string();
        assert!(refusal.contains("which servo.A1 already has"), "{refusal}");
    }
}
