//! A sensitivity analysis of the prediction, which varies each assumption over its plausible range: a table of the
//! assumptions that change a gait's displacement by 10 % or more, and the extremes of a gait's displacement.

use std::fmt;

use lizard_contact::{GroundContact, JointFriction, Travel};

use crate::checks::CheckedGait;
use crate::config::ServoType;
use crate::robot::Robot;

/// Smallest change in displacement that has a row in the table, percent.
const MIN_CHANGE_PERCENT: f64 = 10.0;
/// Smallest noticeable distance per cycle, mm.
const MIN_DISTANCE_MM: f64 = 1.0;
/// Smallest noticeable turn per cycle, deg.
const MIN_TURN_DEG: f64 = 0.5;
/// Largest difference (mm or deg) between displacements that count as equal.
const DISPLACEMENT_TOLERANCE: f64 = 0.02;

/// The note about assumptions that the table does not vary.
const UNMODELLED_NOTE: &str = "\
The model does not cover edges and slopes of the floor, a missing pad, servos that drive in bursts, a centre of mass \
more than 15 mm from the middle, or other masses of the limbs.\n\
docs/limits.md lists the effect of these assumptions in MuJoCo, for the paper's robot.";

/// The inputs of the model that an assumption can vary.
#[derive(Clone, Copy)]
struct ModelInputs {
    ground: GroundContact,
    /// The type of all four servos, with their supply voltage.
    servo: ServoType,
    /// Friction of the pins and of the sliders.
    joint_friction: JointFriction,
    /// Angle that a servo turns, divided by the angle that the firmware sends.
    angle_scale: f64,
}

impl ModelInputs {
    /// Returns the inputs of a robot's prediction.
    fn for_robot(robot: &Robot) -> Self {
        Self {
            ground: *robot.ground(),
            servo: *robot.servo_type(),
            joint_friction: robot.motors().joint_friction,
            angle_scale: 1.0,
        }
    }

    /// Simulates a cycle of a gait and returns the displacement; `pace` is relative to the gait's nominal pace.
    fn simulate_cycle(&self, robot: &Robot, gait: &CheckedGait, pace: f64) -> Travel {
        let mut motors = robot.motors_with_type(&self.servo, self.servo.supply_volts);
        motors.joint_friction = self.joint_friction;
        gait.simulate_with_angle_scale(&self.ground, &motors, pace, self.angle_scale)
    }

    /// Finds the gaits that move the robot noticeably and predictably, each with its displacement. Of gaits whose
    /// distances forward and turns differ only in sign, such as mirror images or reverses of each other, only the first
    /// is included.
    fn find_distinct_gaits<'a>(&self, robot: &'a Robot) -> Vec<(&'a CheckedGait, Travel)> {
        let mut gaits: Vec<(&CheckedGait, Travel)> = Vec::new();
        let rigid_ground = robot.ground().with_rigid_drive();
        for gait in robot.gaits().iter().filter(|gait| gait.has_movement()) {
            if !gait.predict(&rigid_ground).is_determined() {
                continue;
            }
            let displacement = self.simulate_cycle(robot, gait, 1.0);
            let differs_only_in_sign = |(_, listed): &(_, Travel)| {
                let is_close = |a: f64, b: f64| (a.abs() - b.abs()).abs() < DISPLACEMENT_TOLERANCE;
                is_close(displacement.forward, listed.forward)
                    && is_close(displacement.turn, listed.turn)
            };
            let moves_noticeably = displacement.forward.abs() > MIN_DISTANCE_MM
                || displacement.turn.abs() > MIN_TURN_DEG;
            if moves_noticeably && !gaits.iter().any(differs_only_in_sign) {
                gaits.push((gait, displacement));
            }
        }
        gaits
    }
}

/// An assumption: its description, its unit, its range for the paper's robot, and the inputs that it varies.
struct Assumption {
    description: &'static str,
    unit: &'static str,
    paper_range: [f64; 2],
    variation: Variation,
}

impl Assumption {
    /// Returns the plausible range for a robot with this value. If the value is outside the range for the paper's
    /// robot, this range is scaled or, if it does not lie above 0, shifted until the value is in its middle.
    fn range_for(&self, value: f64) -> [f64; 2] {
        let [min, max] = self.paper_range;
        if (min..=max).contains(&value) {
            return self.paper_range;
        }
        let middle = f64::midpoint(min, max);
        self.paper_range.map(|bound| {
            let moved_bound = match min > 0.0 {
                true => bound * value / middle,
                false => bound + value - middle,
            };
            // Rounded to hundredths for the table.
            (100.0 * moved_bound).round() / 100.0
        })
    }
}

/// The way in which an assumption changes the inputs.
enum Variation {
    /// One input is set to each value.
    Value(fn(&mut ModelInputs) -> &mut f64),
    /// A change is made for the value 1, but not for 0, which is the value in the prediction.
    Switch(fn(&mut ModelInputs)),
    /// One input is set to each value after another change, without which the input has no effect.
    ValueAfterChange(fn(&mut ModelInputs), fn(&mut ModelInputs) -> &mut f64),
}

impl Variation {
    /// The value in the prediction.
    fn nominal_value(&self, mut inputs: ModelInputs) -> f64 {
        match self {
            Self::Value(field) | Self::ValueAfterChange(_, field) => *field(&mut inputs),
            Self::Switch(_) => 0.0,
        }
    }

    /// Returns the inputs with this value of the assumption.
    fn apply(&self, mut inputs: ModelInputs, value: f64) -> ModelInputs {
        match self {
            Self::Value(field) => *field(&mut inputs) = value,
            Self::Switch(change) if value > 0.0 => change(&mut inputs),
            Self::Switch(_) => {}
            Self::ValueAfterChange(change, field) => {
                change(&mut inputs);
                *field(&mut inputs) = value;
            }
        }
        inputs
    }
}

/// Creates the table of assumptions. A row has the description, the unit, the range for the paper's robot, and the
/// [`Variation`].
macro_rules! assumptions {
    ($($description:literal, $unit:literal, $from:literal to $to:literal, $kind:ident($($of:tt)+);)+) => {
        [$(Assumption {
            description: $description,
            unit: $unit,
            paper_range: [$from, $to],
            variation: assumptions!(@$kind $($of)+),
        }),+]
    };
    (@value $($field:tt)+) => { Variation::Value(|inputs| &mut inputs.$($field)+) };
    (@switch $change:expr) => { Variation::Switch($change) };
    (@value_after $change:expr, $($field:tt)+) => {
        Variation::ValueAfterChange($change, |inputs| &mut inputs.$($field)+)
    };
}

/// The assumptions about servos, joints, body, floor, legs and feet, and at the end about several of these together.
const ASSUMPTIONS: [Assumption; 21] = assumptions! {
    "servo stall torque", "kg cm", 1.2 to 2.2, value(servo.stall_torque_kg_cm);
    "servo time per 60 deg", "s", 0.1 to 0.15, value(servo.s_per_60_deg);
    "servo supply voltage", "V", 4.0 to 5.2, value(servo.supply_volts);
    "rotor time constant", "ms", 2.0 to 40.0, value(servo.rotor_time_constant_ms);
    "error at full torque", "deg", 1.0 to 6.0, value(servo.full_torque_deg);
    "servo dead band", "us", 2.0 to 20.0, value(servo.dead_band_us);
    // The range that trial 3 of docs/measure.md accepts: 11 or 9 us per deg instead of 10.
    "servo angle over commanded angle", "", 0.91 to 1.11, value(angle_scale);
    "digital servos", "(0 no, 1 yes)", 0.0 to 1.0, switch(|inputs| {
        inputs.servo = ServoType {
            supply_volts: inputs.servo.supply_volts,
            ..ServoType::DIGITAL
        };
    });
    "rotor 2 ms, full torque at 1 deg", "(0 no, 1 yes)", 0.0 to 1.0, switch(|inputs| {
        inputs.servo.rotor_time_constant_ms = 2.0;
        inputs.servo.full_torque_deg = 1.0;
    });
    "pin friction", "N mm", 0.0 to 20.0, value(joint_friction.pin_torque);
    "slider friction", "N", 0.0 to 1.0, value(joint_friction.slider_force);
    "mass", "g", 350.0 to 500.0, value(ground.body.mass);
    "centre of mass ahead", "mm", -15.0 to 15.0, value(ground.body.centre_of_mass[0]);
    "pad friction", "", 0.4 to 1.2, value(ground.friction_coefficient);
    "backward over forward friction", "", 0.67 to 1.5, value(ground.friction_ratio);
    "hips ahead of the middle", "mm", 50.0 to 60.0, value(ground.legs.hip_forward);
    "mounting of the legs", "deg", -10.0 to 41.4, value(ground.legs.mount_angle);
    "leg play", "deg", 0.0 to 2.0, value(ground.drive.play);
    "front left foot too long", "mm", -1.0 to 1.0, value(ground.stance.twist);
    "foot stiffness, front left foot 0.5 mm too long", "N/mm", 0.3 to 3.3, value_after(
        |inputs| inputs.ground.stance.twist = 0.5,
        ground.stance.stiffness
    );
    "SG-90 copies, stiff joints, friction 1, 50 g heavier", "(0 no, 1 yes)", 0.0 to 1.0, switch(|inputs| {
        inputs.servo.stall_torque_kg_cm = 1.2;
        inputs.servo.s_per_60_deg = 0.15;
        inputs.joint_friction.pin_torque = 17.0;
        inputs.joint_friction.slider_force = 0.5;
        inputs.ground.friction_coefficient = 1.0;
        inputs.ground.body.mass += 50.0;
    });
};

/// Finds the assumption with this description.
fn find_assumption(description: &str) -> Option<&'static Assumption> {
    let mut assumptions = ASSUMPTIONS.iter();
    assumptions.find(|assumption| assumption.description == description)
}

/// The plausible range, for the paper's robot, of the assumption with this description; `None` if there is no such
/// assumption.
pub fn plausible_range(description: &str) -> Option<[f64; 2]> {
    find_assumption(description).map(|assumption| assumption.paper_range)
}

/// The effect of an assumption on each gait.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    description: &'static str,
    unit: &'static str,
    /// The value in the prediction.
    nominal: f64,
    /// The lowest and the highest plausible value.
    range: [f64; 2],
    /// Change in each gait's displacement at the lowest and the highest value of the range, percent.
    changes: Vec<[f64; 2]>,
}

/// The effects of all assumptions on gaits that move the robot noticeably.
#[derive(Debug, Clone, PartialEq)]
pub struct Assumptions {
    gaits: Vec<String>,
    /// Rows in the order of their effect, the largest first.
    rows: Vec<Row>,
}

impl Assumptions {
    /// Simulates a robot's gaits with its servos, at the lowest and the highest value of each assumption. Takes a few
    /// seconds.
    pub fn compute(robot: &Robot) -> Self {
        let nominal = ModelInputs::for_robot(robot);
        let gaits = nominal.find_distinct_gaits(robot);
        let compute_row = |assumption: &Assumption| {
            let nominal_value = assumption.variation.nominal_value(nominal);
            let range = assumption.range_for(nominal_value);
            let compute_changes = |(gait, displacement): &(&CheckedGait, Travel)| {
                let component = principal_component(displacement);
                range.map(|value| {
                    let inputs = assumption.variation.apply(nominal, value);
                    let changed_displacement = inputs.simulate_cycle(robot, gait, 1.0);
                    100.0 * (component(&changed_displacement) / component(displacement) - 1.0)
                })
            };
            Row {
                description: assumption.description,
                unit: assumption.unit,
                nominal: nominal_value,
                range,
                changes: gaits.iter().map(compute_changes).collect(),
            }
        };
        let mut rows: Vec<Row> = ASSUMPTIONS.iter().map(compute_row).collect();
        rows.sort_by(|a, b| b.max_change().total_cmp(&a.max_change()));
        let names = gaits.iter().map(|(gait, _)| gait.name().to_string());
        Self {
            gaits: names.collect(),
            rows,
        }
    }
}

/// The displacement over a cycle with one assumption changed, and the changed assumption.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The displacement: mm forward, or deg of turn.
    pub displacement: f64,
    /// The description of the assumption; `None` if all assumptions have the values of robot.toml.
    pub assumption: Option<&'static str>,
}

/// The smallest and the largest displacement of a gait if one assumption at a time is set to the lowest or the highest
/// value of its plausible range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplacementRange {
    /// True if the gait turns on the spot, so that the displacement is its turn; false if the displacement is its
    /// forward distance.
    pub is_turn: bool,
    /// The smallest displacement, with its sign.
    pub min: Extreme,
    /// The largest displacement, with its sign.
    pub max: Extreme,
}

impl DisplacementRange {
    /// Simulates a gait with the robot's servos, at the lowest and the highest value of every range; `pace` is relative
    /// to the gait's nominal pace.
    pub fn compute(robot: &Robot, gait: &CheckedGait, pace: f64) -> Self {
        let nominal = ModelInputs::for_robot(robot);
        let displacement = nominal.simulate_cycle(robot, gait, pace);
        let component = principal_component(&displacement);
        let nominal_extreme = Extreme {
            displacement: component(&displacement),
            assumption: None,
        };
        let mut range = Self {
            is_turn: is_turn(&displacement),
            min: nominal_extreme,
            max: nominal_extreme,
        };
        for assumption in &ASSUMPTIONS {
            for value in assumption.range_for(assumption.variation.nominal_value(nominal)) {
                let inputs = assumption.variation.apply(nominal, value);
                let extreme = Extreme {
                    displacement: component(&inputs.simulate_cycle(robot, gait, pace)),
                    assumption: Some(assumption.description),
                };
                if extreme.displacement < range.min.displacement {
                    range.min = extreme;
                }
                if extreme.displacement > range.max.displacement {
                    range.max = extreme;
                }
            }
        }
        range
    }
}

/// True if a gait turns on the spot: its turn in deg is at least its distance in mm.
fn is_turn(displacement: &Travel) -> bool {
    displacement.turn.abs() >= displacement.forward.abs()
}

/// Returns the component that is the gait's purpose: the forward distance, or the turn of a gait that turns on the
/// spot.
fn principal_component(displacement: &Travel) -> fn(&Travel) -> f64 {
    match is_turn(displacement) {
        true => |displacement| displacement.turn,
        false => |displacement| displacement.forward,
    }
}

impl Row {
    /// The largest change in displacement, percent.
    fn max_change(&self) -> f64 {
        let changes = self.changes.as_flattened().iter();
        changes.map(|change| change.abs()).fold(0.0, f64::max)
    }
}

impl fmt::Display for Assumptions {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.gaits.is_empty() {
            return f.write_str("no gait moves the robot noticeably and predictably\n");
        }
        writeln!(
            f,
            "Change in displacement per cycle, in percent, at the lowest and the highest value of each assumption.\n"
        )?;
        let widths = self.rows.iter().map(|row| row.description.len());
        let width = widths.fold(0, usize::max);
        write!(f, "{:width$}  assumed        from to         ", "")?;
        for gait in &self.gaits {
            write!(f, "{gait:>13}")?;
        }
        writeln!(f)?;
        let (listed_rows, other_rows): (Vec<&Row>, Vec<&Row>) = self
            .rows
            .iter()
            .partition(|row| row.max_change() >= MIN_CHANGE_PERCENT);
        for row in listed_rows {
            let [min, max] = row.range;
            let range = format!("{min} to {max} {}", row.unit);
            write!(
                f,
                "{:<width$} {:>8} {range:>19}",
                row.description, row.nominal
            )?;
            for [low, high] in &row.changes {
                // Adding +0.0 turns -0.0 into 0.0.
                let [low, high] = [low, high].map(|change| change.round() + 0.0);
                write!(f, "{:>13}", format!("{low:+.0} {high:+.0}"))?;
            }
            writeln!(f)?;
        }
        let format_line = |row: &Row| {
            let [min, max] = row.range;
            format!("  {}, {min} to {max} {}", row.description, row.unit)
                .trim_end()
                .to_string()
        };
        let other_lines: Vec<String> = other_rows.into_iter().map(format_line).collect();
        if !other_lines.is_empty() {
            writeln!(
                f,
                "\nLess than {MIN_CHANGE_PERCENT:.0} %:\n{}",
                other_lines.join("\n")
            )?;
        }
        writeln!(f, "\n{UNMODELLED_NOTE}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{assert_starts_with, text_before_gaits};

    #[test]
    fn a_robot_without_a_moving_gait_has_no_table() {
        let stand = "[gait.stand]\nperiod = 1.0\nwaveform = \"still\"\n";
        let text = text_before_gaits("paper") + stand;
        let robot = Robot::parse(&text).expect("the robot is valid");
        assert_starts_with(&Assumptions::compute(&robot).to_string(), "no gait moves");
    }

    #[test]
    fn a_value_outside_the_range_for_the_papers_robot_is_in_the_middle_of_its_own_range() {
        for (description, value, range) in [
            ("hips ahead of the middle", 51.0, [50.0, 60.0]),
            ("hips ahead of the middle", 82.5, [75.0, 90.0]),
            ("front left foot too long", 1.5, [0.5, 2.5]),
        ] {
            let assumption = find_assumption(description).expect(description);
            assert_eq!(assumption.range_for(value), range, "{description}");
        }
    }
}
