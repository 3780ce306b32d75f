//! `lizard pose --show singularities`: prints the matrices K and K*, the factors of det K*, and the nearest
//! singularities.

use lizard_kinematics::{End, FiveBar, SingularPose, Singularity, Solution, wrap};
use lizard_robot::Robot;
use nalgebra::SMatrix;
use serde::Serialize;

use crate::Failure;
use crate::shared::json;
use crate::shared::number::round_to_decimals;
use crate::shared::pose_args::ANGLE_NAMES;

/// Names of the passive joints and slider travels, in the order of the columns in K*.
const PASSIVE_NAMES: [&str; 8] = [
    "theta2",
    "theta3",
    "theta6",
    "theta7",
    "phi_left",
    "s_left",
    "phi_right",
    "s_right",
];

/// Names of the loop equations, in the order of the rows in K and K*.
const LOOP_NAMES: [&str; 8] = [
    "head x", "head y", "tail x", "tail y", "left x", "left y", "right x", "right y",
];

/// A matrix with the names of its rows and columns.
#[derive(Serialize)]
struct Matrix {
    rows: [&'static str; 8],
    columns: &'static [&'static str],
    values: Vec<Vec<f64>>,
}

impl Matrix {
    fn new<const N: usize>(columns: &'static [&'static str; N], values: [[f64; N]; 8]) -> Self {
        Self {
            rows: LOOP_NAMES,
            columns,
            // Adding 0.0 removes negative zeros.
            values: values
                .map(|row| row.map(|value| value + 0.0).to_vec())
                .into(),
        }
    }

    fn to_text(&self) -> String {
        let mut text = format!("{:9}", "");
        for column in self.columns {
            text += &format!(" {column:>9}");
        }
        for (name, row) in self.rows.iter().zip(&self.values) {
            text += &format!("\n  {name:7}");
            for value in row {
                // A value that is zero except for rounding errors is printed as a dot.
                text += &match value.abs() < 5e-7 {
                    true => format!(" {:>9}", "."),
                    false => format!(" {:9.2}", round_to_decimals(*value, 2)),
                };
            }
        }
        text + "\n"
    }
}

/// The output; the serialized field names are the JSON keys.
#[derive(Serialize)]
struct Report {
    /// Derivatives with respect to the servo angles, mm per radian.
    k: Matrix,
    /// Derivatives with respect to the passive joints, mm per radian; with respect to s, mm per mm.
    k_star: Matrix,
    /// det K* by elimination.
    determinant: f64,
    /// det K* as the product of the determinants of its diagonal blocks.
    #[serde(rename = "factored")]
    factored_determinant: f64,
    #[serde(rename = "blocks")]
    block_determinants: BlockReport,
    /// lg12 lg13 sin(theta_lg12 - theta_lg13) for each leg, in servo order, mm^2.
    leg_determinants: [f64; 4],
    nearest: Vec<NearestSingularity>,
}

/// The determinants of the diagonal blocks of K*: mm^2 for head and tail, mm for the sides.
#[derive(Serialize)]
struct BlockReport {
    head: f64,
    tail: f64,
    left: f64,
    right: f64,
}

/// The nearest singular pose of one kind.
#[derive(Serialize)]
struct NearestSingularity {
    #[serde(rename = "what")]
    description: String,
    /// Euclidean distance in servo angles, degrees.
    distance: f64,
    /// Each servo's turn to the singular pose, in servo order, degrees.
    #[serde(rename = "turn")]
    turns: [f64; 4],
}

/// Prints the matrices and the nearest singularities.
///
/// # Errors
/// Fails if the output cannot be written.
pub fn print(robot: &Robot, solution: &Solution, is_json: bool) -> Result<(), Failure> {
    let report = compute_report(robot, solution);
    json::print_json_or_text(is_json, &report, || format_text(&report))
}

fn compute_report(robot: &Robot, solution: &Solution) -> Report {
    let k_star = solution.passive_matrix();
    let matrix = SMatrix::<f64, 8, 8>::from_fn(|row, column| k_star[row][column]);
    let blocks = solution.block_determinants();
    let leg = robot.lizard().leg;
    let amplitude = -leg.coupler * leg.follower;
    let leg_determinants = solution.legs.map(|pose| amplitude * pose.direction.y);
    let mut nearest = vec![];
    for end in End::ALL {
        let five_bar = robot.lizard().end(end);
        let servos = end.servos();
        let sign = end.sign();
        let angles = end.pick(solution.pose.into()).map(|angle| sign * angle);
        let describe_arm =
            |servo: usize| format!("{end} type 1, A{} arm straight or folded", servo + 1);
        for (kind, description) in [
            (
                Singularity::Couplers,
                format!("{end} type 2, the end point comes loose"),
            ),
            (Singularity::LeftArm, describe_arm(servos[0])),
            (Singularity::RightArm, describe_arm(servos[1])),
        ] {
            if let Some((distance, pose)) = find_nearest_singularity(&five_bar, kind, angles) {
                let mut turns = [0.0; 4];
                turns[servos[0]] = sign * wrap(pose.theta_left - angles[0]);
                turns[servos[1]] = sign * wrap(pose.theta_right - angles[1]);
                nearest.push(NearestSingularity {
                    description,
                    distance,
                    turns,
                });
            }
        }
    }
    for (servo, angle) in <[f64; 4]>::from(solution.pose).into_iter().enumerate() {
        // A leg's change points are at 0 and 180 degrees.
        let turn_deg = 180.0 * (angle / 180.0).round() - angle;
        let mut turns = [0.0; 4];
        turns[servo] = turn_deg;
        nearest.push(NearestSingularity {
            description: format!("leg on A{} flat, a change point", servo + 1),
            distance: turn_deg.abs(),
            turns,
        });
    }
    nearest.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    Report {
        k: Matrix::new(&ANGLE_NAMES, solution.active_matrix()),
        k_star: Matrix::new(&PASSIVE_NAMES, k_star),
        determinant: matrix.determinant(),
        factored_determinant: blocks.determinant(),
        block_determinants: BlockReport {
            head: blocks.head,
            tail: blocks.tail,
            left: blocks.left,
            right: blocks.right,
        },
        leg_determinants,
        nearest,
    }
}

/// Returns the singular pose of `kind` nearest to the crank angles `angles`, and its distance in degrees; `None` if
/// there is no such pose. Scans the singularity curves over all left crank angles, then repeats the scan around the
/// nearest pose with smaller steps.
fn find_nearest_singularity(
    five_bar: &FiveBar,
    kind: Singularity,
    angles: [f64; 2],
) -> Option<(f64, SingularPose)> {
    let add_distance = |pose: SingularPose| {
        let left = wrap(pose.theta_left - angles[0]);
        let right = wrap(pose.theta_right - angles[1]);
        (left.hypot(right), pose)
    };
    let choose_nearer =
        |a: (f64, SingularPose), b: (f64, SingularPose)| if b.0 < a.0 { b } else { a };
    let scan = |centre: f64, half_range: f64, step: f64| {
        let step_count = (half_range / step).round() as i32;
        (-step_count..=step_count)
            .flat_map(|i| five_bar.find_singular_poses(centre + f64::from(i) * step))
            .filter(|pose| pose.kind == kind)
            .map(add_distance)
            .reduce(choose_nearer)
    };
    let mut best = scan(0.0, 180.0, 0.25);
    let mut step = 0.25;
    for _ in 0..4 {
        if let Some((_, pose)) = best {
            let finer_best = scan(pose.theta_left, 2.0 * step, step / 20.0);
            best = best.into_iter().chain(finer_best).reduce(choose_nearer);
            step /= 20.0;
        }
    }
    let coinciding_poses = five_bar
        .find_coinciding_tip_poses()
        .filter(|_| kind == Singularity::Couplers);
    best.into_iter()
        .chain(coinciding_poses.map(add_distance))
        .reduce(choose_nearer)
}

fn format_text(report: &Report) -> String {
    let blocks = &report.block_determinants;
    let format_determinant = |det: f64| format!("{:+.1}", round_to_decimals(det, 1));
    let legs = report.leg_determinants.map(format_determinant).join(" ");
    let [head, tail, left, right] =
        [blocks.head, blocks.tail, blocks.left, blocks.right].map(|det| round_to_decimals(det, 2));
    let mut text = format!(
        "K: rows are the loop equations, columns the servos' angles (mm per radian)\n{}\n\
         K*: the same rows, columns are the passive joints (mm per radian; for s, mm per mm)\n{}\n\
         det K* by elimination        {:+.9e}\n\
         det K* as a product          {:+.9e}\n\
         \x20 head   l2 l3 sin(theta2 - theta3)  {head:+10.2} mm^2\n\
         \x20 tail   l7 l8 sin(theta6 - theta7)  {tail:+10.2} mm^2\n\
         \x20 left   -d                          {left:+10.2} mm\n\
         \x20 right  -d                          {right:+10.2} mm\n\
         legs, lg12 lg13 sin(theta_lg12 - theta_lg13), A1 to A4: {legs}\n\n",
        report.k.to_text(),
        report.k_star.to_text(),
        report.determinant,
        report.factored_determinant,
    );
    text += "nearest singularities, and the turns of A1, A2, A3, A4 that reach them\n";
    for singularity in &report.nearest {
        let format_turn = |angle: f64| format!("{:+8.2}", round_to_decimals(angle, 2));
        let turns = singularity.turns.map(format_turn).join(" ");
        let description = &singularity.description;
        text += &format!(
            "  {:7.2} deg  {turns}   {description}\n",
            singularity.distance
        );
    }
    text
}
