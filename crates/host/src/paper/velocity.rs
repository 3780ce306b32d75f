//! `lizard pose --show rates`: computes the rates and accelerations of the passive joints from the servos' motion.

use lizard_kinematics::{Derivative, Derivatives, Lizard, Pose, ServoMotion, Solution, wrap};
use serde::Serialize;

use crate::Failure;
use crate::shared::json;
use crate::shared::number::round_to_decimals;
use crate::shared::quantity::Quantity;

/// Longest time step for finite differences, s.
const MAX_STEP_S: f64 = 2e-4;

/// Largest servo turn in one step for finite differences, deg. Larger turns make the differences inaccurate.
const MAX_STEP_TURN_DEG: f64 = 0.04;

/// The options for the rates and accelerations of the servos.
#[derive(clap::Args)]
#[command(next_help_heading = "Servos, for --show rates; all 0 unless given")]
pub struct ServoMotionArgs {
    /// Rate of theta1 (A1), deg/s
    #[arg(long, default_value_t = 0.0, hide_default_value = true, value_name = "DEG/S", value_parser = Quantity::RATE.parser())]
    omega1: f64,
    /// Rate of theta4 (A2), deg/s
    #[arg(long, default_value_t = 0.0, hide_default_value = true, value_name = "DEG/S", value_parser = Quantity::RATE.parser())]
    omega4: f64,
    /// Rate of theta8 (A3), deg/s
    #[arg(long, default_value_t = 0.0, hide_default_value = true, value_name = "DEG/S", value_parser = Quantity::RATE.parser())]
    omega8: f64,
    /// Rate of theta5 (A4), deg/s
    #[arg(long, default_value_t = 0.0, hide_default_value = true, value_name = "DEG/S", value_parser = Quantity::RATE.parser())]
    omega5: f64,
    /// Acceleration of theta1 (A1), deg/s^2
    #[arg(long, default_value_t = 0.0, hide_default_value = true, value_name = "DEG/S^2", value_parser = Quantity::ACCELERATION.parser())]
    alpha1: f64,
    /// Acceleration of theta4 (A2), deg/s^2
    #[arg(long, default_value_t = 0.0, hide_default_value = true, value_name = "DEG/S^2", value_parser = Quantity::ACCELERATION.parser())]
    alpha4: f64,
    /// Acceleration of theta8 (A3), deg/s^2
    #[arg(long, default_value_t = 0.0, hide_default_value = true, value_name = "DEG/S^2", value_parser = Quantity::ACCELERATION.parser())]
    alpha8: f64,
    /// Acceleration of theta5 (A4), deg/s^2
    #[arg(long, default_value_t = 0.0, hide_default_value = true, value_name = "DEG/S^2", value_parser = Quantity::ACCELERATION.parser())]
    alpha5: f64,
}

/// A joint or coordinate in the output; the field names are the JSON keys.
#[derive(Clone, Serialize)]
struct Row {
    joint: &'static str,
    /// Unit of `value`, `deg` or `mm`; `rate` is per s, `acceleration` per s^2.
    unit: &'static str,
    value: f64,
    rate: f64,
    acceleration: f64,
    /// Finite difference minus closed form; null if a neighbouring pose has no solution.
    rate_deviation: Option<f64>,
    /// The same for the acceleration.
    acceleration_deviation: Option<f64>,
}

impl From<ServoMotionArgs> for ServoMotion {
    fn from(args: ServoMotionArgs) -> Self {
        Self {
            rates: [args.omega1, args.omega4, args.omega8, args.omega5],
            accelerations: [args.alpha1, args.alpha4, args.alpha8, args.alpha5],
        }
    }
}

/// Prints the rate and the acceleration of each passive joint and of the head's, tail's and sliders' coordinates.
///
/// # Errors
/// Fails at a type-2 singularity, where the rates are undefined, or if the output cannot be written.
pub fn print(
    lizard: &Lizard,
    solution: &Solution,
    servo_motion: &ServoMotion,
    is_json: bool,
) -> Result<(), Failure> {
    let type2_margin = solution.margins.type2[0].min(solution.margins.type2[1]);
    if type2_margin < 1e-9 {
        return Err(Failure::Operation(
            "type-2 singularity: the couplers line up, so the rates are undefined".to_string(),
        ));
    }
    let rows = compute_rows(lizard, solution, servo_motion);
    json::print_json_or_text(is_json, &rows, || format_text(&rows))
}

fn format_text(rows: &[Row]) -> String {
    let mut text =
        "joint        value          rate 1/s   acceleration 1/s^2   against finite differences\n"
            .to_owned();
    for row in rows {
        let is_small = |deviation: f64, value: f64| deviation.abs() < 1e-6 * (100.0 + value.abs());
        let verdict = match (row.rate_deviation, row.acceleration_deviation) {
            (Some(rate_deviation), Some(acceleration_deviation))
                if is_small(rate_deviation, row.rate)
                    && is_small(acceleration_deviation, row.acceleration) =>
            {
                "agree to 1e-6".to_string()
            }
            (Some(rate_deviation), Some(acceleration_deviation)) => {
                format!("off by {rate_deviation:+.0e}, {acceleration_deviation:+.0e}")
            }
            _ => "no neighbouring pose".to_string(),
        };
        text += &format!(
            "{:9} {:10.4} {:3} {:+12.4} {:+20.4}   {verdict}\n",
            row.joint,
            round_to_decimals(row.value, 4),
            row.unit,
            round_to_decimals(row.rate, 4),
            round_to_decimals(row.acceleration, 4)
        );
    }
    text
}

/// The name, unit, value and derivative of a joint angle or coordinate.
type Coordinate = (&'static str, &'static str, f64, Derivative<f64>);

/// Lists all joints and coordinates of a solution, with their derivatives.
fn list_joints(solution: &Solution, derivatives: &Derivatives) -> [Coordinate; 12] {
    let (head, tail) = (solution.head_point(), solution.tail_point());
    let (left, right) = (&solution.left, &solution.right);
    let ends = [derivatives.head, derivatives.tail];
    let [head_x, tail_x] = ends.map(|end| end.map(|vector| vector.x));
    let [head_y, tail_y] = ends.map(|end| end.map(|vector| vector.y));
    [
        ("theta2", "deg", solution.theta2(), derivatives.theta2),
        ("theta3", "deg", solution.theta3(), derivatives.theta3),
        ("theta6", "deg", solution.theta6(), derivatives.theta6),
        ("theta7", "deg", solution.theta7(), derivatives.theta7),
        ("head x", "mm", head.x, head_x),
        ("head y", "mm", head.y, head_y),
        ("tail x", "mm", tail.x, tail_x),
        ("tail y", "mm", tail.y, tail_y),
        ("phi left", "deg", left.phi(), derivatives.phi_left),
        ("s left", "mm", left.s, derivatives.s_left),
        ("phi right", "deg", right.phi(), derivatives.phi_right),
        ("s right", "mm", right.s, derivatives.s_right),
    ]
}

/// Computes rates and accelerations in closed form, and compares them with finite differences of neighbouring poses.
fn compute_rows(lizard: &Lizard, solution: &Solution, servo_motion: &ServoMotion) -> Vec<Row> {
    let derivatives = solution.derivatives(servo_motion);
    let start_angles = <[f64; 4]>::from(solution.pose);
    let largest_magnitude = |values: [f64; 4]| values.map(f64::abs).into_iter().fold(0.0, f64::max);
    // If the servos stand still, the quotients are infinite and do not limit the step.
    let step_s = MAX_STEP_S
        .min(MAX_STEP_TURN_DEG / largest_magnitude(servo_motion.rates))
        .min((MAX_STEP_TURN_DEG / largest_magnitude(servo_motion.accelerations)).sqrt());
    let compute_values = |steps: f64| {
        let t = steps * step_s;
        let angles: [f64; 4] = std::array::from_fn(|i| {
            start_angles[i]
                + servo_motion.rates[i] * t
                + servo_motion.accelerations[i] * t * t / 2.0
        });
        let neighbour = lizard.solve(&Pose::from(angles)).ok()?;
        // `list_joints` also needs derivatives; those of the start pose will do, because only the values are used.
        Some(list_joints(&neighbour, &derivatives).map(|(_, _, value, _)| value))
    };
    let neighbours = match [-2.0, -1.0, 1.0, 2.0].map(compute_values) {
        [Some(a), Some(b), Some(c), Some(d)] => Some([a, b, c, d]),
        _ => None,
    };
    list_joints(solution, &derivatives)
        .into_iter()
        .enumerate()
        .map(|(i, (joint, unit, value, derivative))| {
            let Derivative { rate, acceleration } = derivative;
            let differences = neighbours.as_ref().map(|neighbours| {
                let [a, b, c, d] = neighbours.each_ref().map(|neighbour| {
                    let change = neighbour[i] - value;
                    if unit == "deg" { wrap(change) } else { change }
                });
                // Five-point differences: the error is of the fourth order in the step.
                (
                    (a - 8.0 * b + 8.0 * c - d) / (12.0 * step_s),
                    (16.0 * (b + c) - a - d) / (12.0 * step_s * step_s),
                )
            });
            Row {
                joint,
                unit,
                // Adding 0.0 removes negative zeros.
                value: value + 0.0,
                rate: rate + 0.0,
                acceleration: acceleration + 0.0,
                rate_deviation: differences.map(|(rate_difference, _)| rate_difference - rate),
                acceleration_deviation: differences
                    .map(|(_, acceleration_difference)| acceleration_difference - acceleration),
            }
        })
        .collect()
}
