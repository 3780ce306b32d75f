//! `lizard singularity`: K and K*, their factors, and the way to the nearest
//! singular pose.

use std::io::{self, Write};

use lizard_kinematics::{Blocks, End, FiveBar, Pose, SingularPose, Singularity, Solution, wrap};
use lizard_robot::Robot;
use nalgebra::SMatrix;
use serde::Serialize;

use crate::json;
use crate::paper::tidy::tidy;
use crate::paper::verdict;
use crate::pose_args::ANGLES;
use crate::{Failure, PoseArgs, RobotFile};

/// The velocity matrices of a pose and its nearest singularities, or a map of the margins
///
/// K (8x4) holds the derivatives of the loop equations by the servo angles theta1,
/// theta4, theta8, theta5, K* (8x8) those by the passive joints; text and JSON name the
/// rows and columns. The default pose is the neutral one.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lizard singularity
  lizard singularity --map 5")]
pub struct Args {
    #[command(flatten)]
    pose: PoseArgs,
    /// Print the head's margins for theta1 and theta4 from 0 to 180, in steps of this
    /// many degrees
    #[arg(long, value_name = "STEP", value_parser = step)]
    map: Option<f64>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    robot: RobotFile,
}

fn step(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(step) if (0.1..=45.0).contains(&step) => Ok(step),
        _ => Err("it must be 0.1 to 45 degrees".to_string()),
    }
}

/// The unknown rates, in the order of the columns of K*.
const PASSIVE: [&str; 8] = [
    "theta2",
    "theta3",
    "theta6",
    "theta7",
    "phi_left",
    "s_left",
    "phi_right",
    "s_right",
];

/// The loop equations, in the order of the rows of both matrices.
const LOOPS: [&str; 8] = [
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
            rows: LOOPS,
            columns,
            // Without negative zeros.
            values: values
                .map(|row| row.map(|value| value + 0.0).to_vec())
                .into(),
        }
    }

    fn text(&self) -> String {
        let mut text = format!("{:9}", "");
        for column in self.columns {
            text += &format!(" {column:>9}");
        }
        for (name, row) in self.rows.iter().zip(&self.values) {
            text += &format!("\n  {name:7}");
            for value in row {
                // What is nothing but rounding is left out.
                text += &match value.abs() < 5e-7 {
                    true => format!(" {:>9}", "."),
                    false => format!(" {:9.2}", tidy(*value, 2)),
                };
            }
        }
        text + "\n"
    }
}

#[derive(Serialize)]
struct Report {
    /// Derivatives by the servo angles, mm per radian.
    k: Matrix,
    /// Derivatives by the passive joints: mm per radian, and by s mm per mm.
    k_star: Matrix,
    determinant: f64,
    factored: f64,
    blocks: Factors,
    leg_determinants: [f64; 4],
    nearest: Vec<Nearest>,
}

#[derive(Serialize)]
struct Factors {
    head: f64,
    tail: f64,
    left: f64,
    right: f64,
}

/// The nearest pose at which something is singular.
#[derive(Serialize)]
struct Nearest {
    what: String,
    /// Distance in the servos' angles, degrees.
    distance: f64,
    /// How each servo would have to turn, servo order, degrees.
    turn: [f64; 4],
}

/// Computes and prints matrices or map.
///
/// # Errors
/// A wrong robot.toml, a pose in which a loop does not close, an output that cannot
/// be written.
pub fn run(args: Args) -> Result<(), Failure> {
    let robot = args.robot.load()?;
    let mut out = io::stdout().lock();
    if let Some(step) = args.map {
        return map(&robot, step, args.json, &mut out);
    }
    let pose = args.pose.get().unwrap_or_else(|| robot.neutral());
    let solution = robot
        .lizard()
        .solve(&pose)
        .map_err(|infeasible| Failure::Impossible(infeasible.to_string()))?;
    let report = report(&robot, &solution);
    if args.json {
        json::line(&mut out, &report)?;
    } else {
        out.write_all(text(&report).as_bytes())?;
    }
    Ok(())
}

fn report(robot: &Robot, solution: &Solution) -> Report {
    let k_star = solution.passive_matrix();
    let matrix = SMatrix::<f64, 8, 8>::from_fn(|row, column| k_star[row][column]);
    let blocks @ Blocks {
        head,
        tail,
        left,
        right,
    } = solution.blocks();
    let leg = robot.lizard().leg;
    let mut nearest = vec![];
    for end in End::ALL {
        let (bars, servos, sign) = (robot.lizard().end(end), end.servos(), end.sign());
        let angles = end.pick(solution.pose.into()).map(|angle| sign * angle);
        for kind in [
            Singularity::Couplers,
            Singularity::LeftArm,
            Singularity::RightArm,
        ] {
            if let Some((distance, pose)) = nearest_of(&bars, kind, angles) {
                let mut turn = [0.0; 4];
                turn[servos[0]] = sign * wrap(pose.theta_left - angles[0]);
                turn[servos[1]] = sign * wrap(pose.theta_right - angles[1]);
                let what = match kind {
                    Singularity::Couplers => format!("{end} type 2, the end point comes loose"),
                    Singularity::LeftArm => {
                        format!("{end} type 1, A{} arm straight or folded", servos[0] + 1)
                    }
                    Singularity::RightArm => {
                        format!("{end} type 1, A{} arm straight or folded", servos[1] + 1)
                    }
                };
                nearest.push(Nearest {
                    what,
                    distance,
                    turn,
                });
            }
        }
    }
    for (servo, angle) in <[f64; 4]>::from(solution.pose).into_iter().enumerate() {
        // Change points at 0 and 180 degrees.
        let turn_by = 180.0 * (angle / 180.0).round() - angle;
        let mut turn = [0.0; 4];
        turn[servo] = turn_by;
        nearest.push(Nearest {
            what: format!("leg on A{} flat, a change point", servo + 1),
            distance: turn_by.abs(),
            turn,
        });
    }
    nearest.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    Report {
        k: Matrix::new(&ANGLES, solution.active_matrix()),
        k_star: Matrix::new(&PASSIVE, k_star),
        determinant: matrix.determinant(),
        factored: blocks.determinant(),
        blocks: Factors {
            head,
            tail,
            left,
            right,
        },
        // lg12 lg13 sin(theta_lg12 - theta_lg13)
        leg_determinants: solution
            .legs
            .map(|pose| -leg.coupler * leg.follower * pose.direction.y),
        nearest,
    }
}

/// The nearest singular crank angles of one kind, by scanning the curves for
/// every left crank angle and narrowing the step around the best.
pub fn nearest_of(
    bars: &FiveBar,
    kind: Singularity,
    from: [f64; 2],
) -> Option<(f64, SingularPose)> {
    let measured = |pose: SingularPose| {
        let (left, right) = (
            wrap(pose.theta_left - from[0]),
            wrap(pose.theta_right - from[1]),
        );
        (left.hypot(right), pose)
    };
    let closest = |a: (f64, SingularPose), b: (f64, SingularPose)| if b.0 < a.0 { b } else { a };
    let along = |centre: f64, half: f64, step: f64| {
        let steps = (half / step).round() as i32;
        (-steps..=steps)
            .flat_map(|i| bars.singular_with(centre + f64::from(i) * step))
            .filter(|pose| pose.kind == kind)
            .map(measured)
            .reduce(closest)
    };
    let mut best = along(0.0, 180.0, 0.25);
    let mut step = 0.25;
    for _ in 0..4 {
        if let Some((_, pose)) = best {
            let finer = along(pose.theta_left, 2.0 * step, step / 20.0);
            best = best.into_iter().chain(finer).reduce(closest);
            step /= 20.0;
        }
    }
    let points = bars
        .coinciding_tips()
        .filter(|_| kind == Singularity::Couplers);
    best.into_iter().chain(points.map(measured)).reduce(closest)
}

fn text(report: &Report) -> String {
    let b = &report.blocks;
    let mut page = format!(
        "K: rows are the loop equations, columns the servos' angles (mm per radian)\n{}\n\
         K*: the same rows, columns are the passive joints (mm per radian; by s, mm per mm)\n{}\n\
         det K* by elimination        {:+.9e}\n\
         det K* as a product          {:+.9e}\n\
         \x20 head   l2 l3 sin(theta2 - theta3)  {:+10.2} mm^2\n\
         \x20 tail   l7 l8 sin(theta6 - theta7)  {:+10.2} mm^2\n\
         \x20 left   -d                          {:+10.2} mm\n\
         \x20 right  -d                          {:+10.2} mm\n\
         legs, lg12 lg13 sin(theta_lg12 - theta_lg13), A1 to A4: {}\n\n",
        report.k.text(),
        report.k_star.text(),
        report.determinant,
        report.factored,
        tidy(b.head, 2),
        tidy(b.tail, 2),
        tidy(b.left, 2),
        tidy(b.right, 2),
        report
            .leg_determinants
            .map(|det| format!("{:+.1}", tidy(det, 1)))
            .join(" "),
    );
    page += "nearest singularities, and how A1, A2, A3, A4 would have to turn to them\n";
    for near in &report.nearest {
        let turn = near
            .turn
            .map(|angle| format!("{:+8.2}", tidy(angle, 2)))
            .join(" ");
        page += &format!("  {:7.2} deg  {turn}   {}\n", near.distance, near.what);
    }
    page
}

#[derive(Serialize)]
struct Cell {
    theta1: f64,
    theta4: f64,
    type2: Option<f64>,
    type1_a1: Option<f64>,
    type1_a2: Option<f64>,
    safe: bool,
}

/// Margins of the head over its plane.
fn map(robot: &Robot, step: f64, json: bool, out: &mut impl Write) -> Result<(), Failure> {
    let count = (180.0 / step + 1e-9).floor() as usize;
    let axis = |i: usize| i as f64 * step;
    let cells: Vec<Vec<Cell>> = (0..=count)
        .map(|row| {
            (0..=count)
                .map(|column| cell(robot, axis(column), axis(row)))
                .collect()
        })
        .collect();
    if json {
        return Ok(json::line(
            out,
            &cells.into_iter().flatten().collect::<Vec<_>>(),
        )?);
    }
    writeln!(
        out,
        "least margin of the head in tenths (9 is .9 or more), . below the robot's limits or out of a servo's travel; type-2, type-1, legs"
    )?;
    for row in cells.iter().rev() {
        let theta4 = row[0].theta4;
        let marks: String = row
            .iter()
            .map(|cell| match cell {
                Cell {
                    safe: true,
                    type2: Some(a),
                    type1_a1: Some(b),
                    type1_a2: Some(c),
                    ..
                } => {
                    let leg = cell
                        .theta1
                        .to_radians()
                        .sin()
                        .abs()
                        .min(cell.theta4.to_radians().sin().abs());
                    let least = a.min(*b).min(*c).min(leg);
                    char::from_digit((least * 10.0) as u32 % 10, 10).unwrap_or('9')
                }
                _ => '.',
            })
            .collect();
        writeln!(out, "{theta4:6.1} {marks}")?;
    }
    writeln!(out, "theta4 / theta1 from 0.0 to {:.1}", axis(count))?;
    Ok(())
}

fn cell(robot: &Robot, theta1: f64, theta4: f64) -> Cell {
    // The tail stays at neutral, mirrored so that it limits nothing here.
    let neutral = robot.neutral();
    let pose = Pose {
        theta1,
        theta4,
        ..neutral
    };
    let solved = robot.lizard().solve(&pose).ok();
    let head = solved.as_ref().map(|s| s.head);
    let safe = solved.is_some_and(|s| {
        robot.limits().violations(&s).all(|v| {
            use lizard_kinematics::Check::{StrokeLeft, StrokeRight};
            matches!(v.what, StrokeLeft | StrokeRight)
        }) && verdict::out_of_travel(robot, &pose).next().is_none()
    });
    Cell {
        theta1,
        theta4,
        type2: head.map(|h| h.type2),
        type1_a1: head.map(|h| h.type1_left()),
        type1_a2: head.map(|h| h.type1_right()),
        safe,
    }
}
