//! `lizard pose --head X Y --tail X Y`: computes the servo angles that put head and tail at given points.

use lizard_kinematics::{AssemblyMode, Check, Elbow, End, InverseSolution, Pose, Vector};
use lizard_robot::{Robot, violations};
use serde::Serialize;

use crate::Failure;
use crate::shared::json;
use crate::shared::number::round_to_decimals;

/// The solutions for the given points of head and tail; the field names are the JSON keys.
#[derive(Serialize)]
struct Report {
    head: Option<FiveBarSolutions>,
    tail: Option<FiveBarSolutions>,
    /// The pose with all elbows outward; null if a point is out of reach. A head or tail without a given point is at
    /// neutral.
    pose: Option<Angles>,
    /// True if `pose` is within the robot's limits and each servo's travel; otherwise, `why` has the reasons.
    safe: bool,
    why: Vec<String>,
}

/// The servo angles of a pose in the chassis frame, degrees.
#[derive(Serialize)]
struct Angles {
    theta1: f64,
    theta4: f64,
    theta8: f64,
    theta5: f64,
}

/// The solutions of one five-bar.
#[derive(Serialize)]
struct FiveBarSolutions {
    point: [f64; 2],
    working_modes: Vec<ModeSolution>,
    why: Option<String>,
}

/// The solution in one of the four working modes (elbow of the left arm, elbow of the right arm).
#[derive(Serialize)]
struct ModeSolution {
    #[serde(rename = "left")]
    left_elbow: &'static str,
    #[serde(rename = "right")]
    right_elbow: &'static str,
    /// Position of the end point relative to the crank tips: `ahead` or `behind`.
    assembly_mode: &'static str,
    /// Angle of the left servo (A1 or A4) in the chassis frame, degrees.
    theta_left: f64,
    /// Angle of the right servo (A2 or A3) in the chassis frame, degrees.
    theta_right: f64,
    /// Distance between the forward solution and the point, mm.
    error_mm: f64,
    /// The five-bar's smallest margin.
    margin: f64,
    /// True if this robot can reach the point in this mode; otherwise, `why` has the reasons.
    reachable: bool,
    why: Vec<String>,
}

/// Prints the servo angles that put head and tail at `end_points`, mm in the chassis frame.
///
/// # Errors
/// Fails if a point is out of reach, or if the output cannot be written.
pub fn print(robot: &Robot, end_points: [Option<Vector>; 2], is_json: bool) -> Result<(), Failure> {
    let report = combine_ends(robot, end_points);
    json::print_json_or_text(is_json, &report, || format_text(&report))?;
    for (name, five_bar) in [("head", report.head), ("tail", report.tail)] {
        if let Some(reason) = five_bar.and_then(|five_bar| five_bar.why) {
            return Err(Failure::Operation(format!("{name}: {reason}")));
        }
    }
    Ok(())
}

/// Solves the five-bar of the head or tail for a point, in all working modes.
fn solve_end(robot: &Robot, end: End, point: Vector) -> FiveBarSolutions {
    let local_point = robot.lizard().to_end(end, point);
    let (working_modes, why) = match robot.lizard().end(end).inverse(local_point) {
        Ok(inverse_solutions) => {
            let check = |solution| check_solution(robot, end, local_point, solution);
            (inverse_solutions.into_iter().map(check).collect(), None)
        }
        Err(infeasible) => (Vec::new(), Some(infeasible.to_string())),
    };
    FiveBarSolutions {
        point: [point.x, point.y],
        working_modes,
        why,
    }
}

/// Checks an inverse solution: computes its error and margin, and lists the robot's limits that it violates.
fn check_solution(
    robot: &Robot,
    end: End,
    local_point: Vector,
    solution: InverseSolution,
) -> ModeSolution {
    let five_bar = robot.lizard().end(end);
    let [left, right] = [solution.theta_left, solution.theta_right];
    let pose = five_bar.forward_in_mode(solution.assembly_mode, left, right);
    let angles = [left, right].map(|theta| end.mirror_angle(theta));
    let mut reasons = Vec::new();
    for (servo, angle) in end.servos().into_iter().zip(angles) {
        reasons.extend(violations::describe_travel_violation(robot, servo, angle));
    }
    let is_behind = solution.assembly_mode == AssemblyMode::Behind;
    if is_behind {
        let reason = "another assembly mode: the end point would be behind the crank tips";
        reasons.push(reason.to_string());
    }
    let (error_mm, margin) = match &pose {
        Err(infeasible) => {
            reasons.push(infeasible.to_string());
            (0.0, 0.0)
        }
        Ok(pose) => {
            // Behind the crank tips, the type-2 margin is negative, which the reason above already states.
            let is_already_stated = |check| is_behind && Check::TYPE2.contains(&check);
            let violations = robot.limits().end_violations(end, pose);
            let violations = violations.filter(|violation| !is_already_stated(violation.check));
            reasons.extend(violations.map(|violation| violation.to_string()));
            ((pose.end_point - local_point).length(), pose.margin())
        }
    };
    ModeSolution {
        left_elbow: name_elbow(solution.working_mode.left),
        right_elbow: name_elbow(solution.working_mode.right),
        assembly_mode: if is_behind { "behind" } else { "ahead" },
        theta_left: angles[0],
        theta_right: angles[1],
        error_mm,
        margin,
        reachable: reasons.is_empty(),
        why: reasons,
    }
}

fn name_elbow(elbow: Elbow) -> &'static str {
    match elbow {
        Elbow::Outward => "outward",
        Elbow::Inward => "inward",
    }
}

/// Solves head and tail for their points, combines the solutions into one pose and checks the pose.
fn combine_ends(robot: &Robot, [head, tail]: [Option<Vector>; 2]) -> Report {
    let head = head.map(|point| solve_end(robot, End::Head, point));
    let tail = tail.map(|point| solve_end(robot, End::Tail, point));
    let mut angles = robot.servos().map(|servo| servo.neutral);
    let mut is_complete = true;
    let mut reasons: Vec<String> = Vec::new();
    for (five_bar, end) in [(&head, End::Head), (&tail, End::Tail)] {
        let Some(five_bar) = five_bar else { continue };
        match five_bar.working_modes.first() {
            Some(outward_mode) => {
                let [left, right] = end.servos();
                angles[left] = outward_mode.theta_left;
                angles[right] = outward_mode.theta_right;
            }
            None => is_complete = false,
        }
        reasons.extend(five_bar.why.clone());
    }
    if is_complete {
        match robot.lizard().solve(&Pose::from(angles)) {
            Ok(solution) => reasons.extend(violations::describe_pose_violations(robot, &solution)),
            Err(infeasible) => reasons.push(infeasible.to_string()),
        }
    }
    let [theta1, theta4, theta8, theta5] = angles.map(|angle| angle.rem_euclid(360.0));
    Report {
        head,
        tail,
        pose: is_complete.then_some(Angles {
            theta1,
            theta4,
            theta8,
            theta5,
        }),
        safe: reasons.is_empty(),
        why: reasons,
    }
}

fn format_text(report: &Report) -> String {
    let mut text = String::new();
    // The columns are in servo order, A3 before A4. The tail's left servo is A4, so its left and right are swapped.
    let head_columns = "A1 arm   A2 arm    A1 theta1  A2 theta4";
    let tail_columns = "A3 arm   A4 arm    A3 theta8  A4 theta5";
    for (name, five_bar, columns, [first, second]) in [
        ("head", &report.head, head_columns, [0, 1]),
        ("tail", &report.tail, tail_columns, [1, 0]),
    ] {
        let Some(five_bar) = five_bar else { continue };
        let [x, y] = five_bar.point;
        let [x, y] = [x, y].map(|value| round_to_decimals(value, 3));
        text += &format!("{name} at ({x:.3}, {y:.3}) mm\n");
        if let Some(reason) = &five_bar.why {
            text += &format!("  {reason}\n\n");
            continue;
        }
        text += &format!("  {columns}  assembly  margin   error mm   this robot\n");
        for solution in &five_bar.working_modes {
            let verdict = match solution.why.as_slice() {
                [] => "yes".to_string(),
                [reason] => format!("no: {reason}"),
                [first_reason, other_reasons @ ..] => {
                    format!("no: {first_reason}; and {} more", other_reasons.len())
                }
            };
            let elbows = [solution.left_elbow, solution.right_elbow];
            let angles = [solution.theta_left, solution.theta_right];
            text += &format!(
                "  {:8} {:8} {:10.3} {:10.3}  {:8} {:+7.3}    {:>7}   {verdict}\n",
                elbows[first],
                elbows[second],
                round_to_decimals(angles[first], 3),
                round_to_decimals(angles[second], 3),
                solution.assembly_mode,
                round_to_decimals(solution.margin, 3),
                format_mm_error(solution.error_mm)
            );
        }
        text.push('\n');
    }
    if let Some(pose) = &report.pose {
        text += &format!(
            "pose {:.3} {:.3} {:.3} {:.3}   (A1 A2 A3 A4, as the console takes it)\n",
            pose.theta1, pose.theta4, pose.theta8, pose.theta5
        );
        text += &match report.safe {
            true => "safe yes\n".to_string(),
            false => format!("safe no: {}\n", report.why.join("; ")),
        };
    }
    text
}

/// Formats an error in mm. Errors below 1e-9 are rounding errors, so their values are not printed.
fn format_mm_error(mm: f64) -> String {
    if mm < 1e-9 {
        "< 1e-9".to_string()
    } else {
        format!("{mm:.0e}")
    }
}
