//! What must hold in every scenario: one sentence each, and a function that judges a
//! record by it. A function that finds nothing to judge holds.

mod begin;
mod hang;
mod memory;
mod orders;
mod pulses;
mod told;

use lizard_robot::Robot;

use super::record::Record;
use super::scenario::Scenario;
use super::setup::WIDE;

/// What may be seen, by the robot and the scenario.
#[derive(Debug)]
pub struct Rules {
    /// By how many cycles a servo's pulse may change in a frame.
    pub way: [u64; 4],
    /// The shortest and the longest pulse of each servo, cycles.
    pub widths: [(u64, u64); 4],
    /// Where the supply forbids writing, moving and pulses, mV.
    pub slow: f64,
    /// See `slow`.
    pub stop: f64,
    /// See `slow`.
    pub rest: f64,
    /// Whether `boot` ends the pulses, so that it begins none.
    pub boots_to_rest: bool,
    /// Whether a narrower travel is saved than the one in use.
    pub narrowed: bool,
}

impl Rules {
    /// Those of a scenario.
    #[must_use]
    pub fn of(robot: &Robot, scenario: &Scenario) -> Self {
        let cycles = |us: f64| (us * 16.0).round() as u64;
        let pace = robot.pace();
        let fastest = pace.slew.max(pace.gait_slew);
        let servos = robot.servos();
        let [slow, stop, rest] = robot.supplies().board.map(|volts| 1_000.0 * volts);
        let says = |text: &str| {
            scenario
                .steps
                .iter()
                .any(|step| step.to_string().contains(text))
        };
        // Other numbers of a servo: the largest of both.
        let widest = |gain: f64| {
            let wide = if says("scale ") {
                WIDE.parse().expect("a number")
            } else {
                0.0
            };
            gain.abs().max(wide)
        };
        Self {
            // A cycle of rounding at each end, and half a step of an angle.
            way: servos
                .each_ref()
                .map(|servo| cycles(fastest / 50.0 * widest(servo.us_per_degree)) + 4),
            widths: servos
                .each_ref()
                .map(|servo| (cycles(servo.min_us) - 1, cycles(servo.max_us) + 1)),
            slow,
            stop,
            rest,
            boots_to_rest: says("boot rest"),
            narrowed: says("say limit ") && says("say factory"),
        }
    }
}

/// Judges a record: what was seen, where the sentence does not hold.
pub type Holds = fn(&Record, &Rules) -> Result<(), String>;

/// Every invariant.
pub const INVARIANTS: [(&str, Holds); 25] = [
    ("the program neither crashes nor halts", told::it_lives),
    ("every line has an answer", told::every_line_is_answered),
    (
        "pulses begin only by an order, by boot three seconds after a start, or at power-on",
        begin::only_by_order,
    ),
    (
        "servos never begin in one frame, but for those that a hang interrupted",
        begin::one_after_another,
    ),
    (
        "after a hang the servos are held where they were",
        hang::held_where_it_was,
    ),
    (
        "a hang that ends the pulses ends in a reset",
        hang::silence_has_a_reason,
    ),
    (
        "a hang without which the pulses go on ends in no reset",
        hang::no_reset_without_need,
    ),
    (
        "a robot without pulses does not answer ok to a motion",
        orders::done_means_pulses,
    ),
    (
        "status says rest or a fault where there are no pulses",
        orders::status_says_why,
    ),
    (
        "status says rest only where there are no pulses",
        orders::rest_is_rest,
    ),
    (
        "rest ends the pulses within a frame",
        orders::rest_ends_pulses,
    ),
    ("stand stands, whatever came before", orders::stand_stands),
    (
        "a refused command changes nothing",
        orders::refused_changes_nothing,
    ),
    (
        "what is no command, or no good one, is refused",
        orders::wrong_is_refused,
    ),
    (
        "deadman stops a gait no earlier than it says",
        told::deadman_is_not_early,
    ),
    (
        "rest writes nothing while the robot rests",
        memory::rest_again_writes_nothing,
    ),
    ("no pulse is cut short or too long", pulses::within_travel),
    (
        "no pulse is farther from the one before than the slew limit",
        pulses::no_leap,
    ),
    (
        "no reset of a held robot makes a servo leap",
        pulses::no_leap_by_a_reset,
    ),
    (
        "a robot that has rested wakes in the pose of its rest, whatever reset it",
        pulses::rest_pose_is_kept,
    ),
    (
        "what stopped the robot is in status and on the console until it is told to move",
        told::stops_are_told,
    ),
    (
        "the LED shows the fault that status tells",
        told::led_shows_the_fault,
    ),
    (
        "a weak supply does not restart the robot for ever",
        memory::brown_outs_end,
    ),
    (
        "a supply stops or rests the robot only by six frames below its voltage",
        memory::supply_acts_on_six_frames,
    ),
    (
        "the EEPROM is written only above its voltage and after the first reading",
        memory::written_only_when_allowed,
    ),
];
