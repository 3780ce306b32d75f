//! The output of `lizard pose` for one pose: a JSON object, a table row, or a page of text.

use std::fmt::Write as _;

use lizard_kinematics::{InfeasiblePose, Margins, Pose, Solution};
use lizard_robot::{Robot, violations};
use serde::ser::{Serialize, Serializer};

use crate::paper::poses::TimedPose;
use crate::shared::number::round_to_decimals;

/// A line of `lizard pose --json`; the field names are the JSON keys. Angles are in degrees and points in
/// mm, both in the chassis frame; only a leg's coupler angle is relative to its ground link. If the pose has no
/// solution, the solution's fields are null. `seconds` is present only if the stream has this column.
#[derive(Default, serde::Serialize)]
pub struct PoseLine {
    #[serde(skip_serializing_if = "Option::is_none")]
    seconds: Option<f64>,
    theta2: Option<f64>,
    theta3: Option<f64>,
    theta6: Option<f64>,
    theta7: Option<f64>,
    head: Option<[f64; 2]>,
    tail: Option<[f64; 2]>,
    left: Option<SliderState>,
    right: Option<SliderState>,
    legs: Option<Legs>,
    margins: Option<MarginMap>,
    /// True if the pose is within the robot's limits and each servo's travel; otherwise, `why` has the reasons.
    safe: bool,
    why: Vec<String>,
}

/// A slider's passive joints: angle in degrees, travel in mm.
#[derive(serde::Serialize)]
struct SliderState {
    phi: f64,
    s: f64,
}

/// The passive angles of all legs.
#[derive(serde::Serialize)]
struct Legs {
    lf: LegAngles,
    rf: LegAngles,
    rh: LegAngles,
    lh: LegAngles,
}

/// A leg's passive angles, degrees.
#[derive(serde::Serialize)]
struct LegAngles {
    follower: f64,
    coupler: f64,
}

/// All margins, serialized as a map from margin names to values.
struct MarginMap(Margins);

impl Serialize for MarginMap {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let margins = self.0.iter();
        // Adding 0.0 turns -0.0 into 0.0.
        serializer.collect_map(margins.map(|(check, value)| (check.name(), value + 0.0)))
    }
}

impl PoseLine {
    /// Creates a pose's line, with or without a solution.
    pub fn new(
        robot: &Robot,
        seconds: Option<f64>,
        outcome: &Result<Solution, InfeasiblePose>,
    ) -> Self {
        let solution = match outcome {
            Ok(solution) => solution,
            Err(infeasible) => {
                return Self {
                    seconds,
                    why: vec![infeasible.to_string()],
                    ..Self::default()
                };
            }
        };
        let reasons = violations::describe_pose_violations(robot, solution);
        let (head, tail) = (solution.head_point(), solution.tail_point());
        let passive = solution.passive_joints();
        let slider_state = |phi: f64, s: f64| Some(SliderState { phi, s });
        let [lf, rf, rh, lh] = solution.legs.map(|leg| LegAngles {
            follower: leg.follower_angle(),
            coupler: leg.coupler_angle(),
        });
        Self {
            seconds,
            theta2: Some(passive.theta2),
            theta3: Some(passive.theta3),
            theta6: Some(passive.theta6),
            theta7: Some(passive.theta7),
            head: Some([head.x, head.y]),
            tail: Some([tail.x, tail.y]),
            left: slider_state(passive.phi_left, passive.s_left),
            right: slider_state(passive.phi_right, passive.s_right),
            legs: Some(Legs { lf, rf, rh, lh }),
            margins: Some(MarginMap(solution.margins)),
            safe: reasons.is_empty(),
            why: reasons,
        }
    }
}

/// Formats the table heading for the columns of [`format_row`].
pub fn format_heading(has_time: bool) -> String {
    let seconds = if has_time { " seconds |" } else { "" };
    format!(
        "{seconds}   theta1   theta4   theta8   theta5 |   theta2   theta3   theta6   theta7 \
         |      head x, y mm      tail x, y mm |  s left s right | least margin      | safe, or reason"
    )
}

/// Formats a pose as one table row.
pub fn format_row(
    robot: &Robot,
    timed_pose: &TimedPose,
    outcome: &Result<Solution, InfeasiblePose>,
) -> String {
    let angles = <[f64; 4]>::from(timed_pose.pose);
    let mut line = String::with_capacity(192);
    if let Some(seconds) = timed_pose.seconds {
        let _ = write!(line, "{seconds:8.2} |");
    }
    for angle in angles {
        let _ = write!(line, " {:8.3}", round_to_decimals(angle, 3));
    }
    let solution = match outcome {
        Err(infeasible) => return line + &format!(" | {infeasible}"),
        Ok(solution) => solution,
    };
    let (min_check, min_margin) = solution.margins.min();
    for values in [passive_angles(solution), end_coordinates(solution)] {
        line.push_str(" |");
        for value in values {
            let _ = write!(line, " {:8.3}", round_to_decimals(value, 3));
        }
    }
    let _ = write!(
        line,
        " | {:+7.2} {:+7.2} | {min_check:9} {:+7.4} | ",
        round_to_decimals(solution.left.s, 2),
        round_to_decimals(solution.right.s, 2),
        round_to_decimals(min_margin, 4),
    );
    let reasons = violations::describe_pose_violations(robot, solution);
    line + reasons.first().map_or("safe", String::as_str)
}

/// Returns theta2, theta3, theta6 and theta7, degrees.
fn passive_angles(solution: &Solution) -> [f64; 4] {
    [
        solution.theta2(),
        solution.theta3(),
        solution.theta6(),
        solution.theta7(),
    ]
}

/// Returns x and y of the head point and the tail point, mm.
fn end_coordinates(solution: &Solution) -> [f64; 4] {
    let (head, tail) = (solution.head_point(), solution.tail_point());
    [head.x, head.y, tail.x, tail.y]
}

/// Formats a pose as a page of text.
pub fn format_page(
    robot: &Robot,
    pose: &Pose,
    outcome: &Result<Solution, InfeasiblePose>,
) -> String {
    let limits = robot.limits();
    let round_3 = |value: f64| round_to_decimals(value, 3);
    let [a1, a2, a3, a4] = <[f64; 4]>::from(*pose).map(round_3);
    let mut page = format!(
        "servos   A1 theta1 {a1:9.3}   A2 theta4 {a2:9.3}   A3 theta8 {a3:9.3}   A4 theta5 {a4:9.3}  deg\n"
    );
    let solution = match outcome {
        Err(infeasible) => return page + &format!("\nno solution: {infeasible}\n"),
        Ok(solution) => solution,
    };
    let [theta2, theta3, theta6, theta7] = passive_angles(solution).map(round_3);
    let [head_x, head_y, tail_x, tail_y] = end_coordinates(solution).map(round_3);
    let [left_s, right_s] = [&solution.left, &solution.right].map(|slider| round_3(slider.s));
    let [left_phi, right_phi] =
        [&solution.left, &solution.right].map(|slider| round_3(slider.phi()));
    let [lf, rf, rh, lh] = solution.legs.map(|leg| round_3(leg.follower_angle()));
    let round_4 = |margin: f64| round_to_decimals(margin, 4);
    let margins = &solution.margins;
    let [head_margin, tail_margin] = margins.type2.map(round_4);
    let [margin_a1, margin_a2, margin_a3, margin_a4] = margins.type1.map(round_4);
    let [margin_lf, margin_rf, margin_rh, margin_lh] = margins.leg.map(round_4);
    let _ = write!(
        page,
        "
head     ({head_x:8.3}, {head_y:8.3}) mm   theta2 {theta2:8.3}   theta3 {theta3:8.3} deg
tail     ({tail_x:8.3}, {tail_y:8.3}) mm   theta6 {theta6:8.3}   theta7 {theta7:8.3} deg
left     s {left_s:+8.3} mm   phi {left_phi:8.3} deg
right    s {right_s:+8.3} mm   phi {right_phi:8.3} deg
legs     followers  LF {lf:8.3}   RF {rf:8.3}   RH {rh:8.3}   LH {lh:8.3} deg

margins  (0 is singular, 1 is best)  limits {} {} {}
         type-2    head {head_margin:+.4}   tail {tail_margin:+.4}
         type-1    A1   {margin_a1:+.4}   A2   {margin_a2:+.4}   A3 {margin_a3:+.4}   A4 {margin_a4:+.4}
         legs      LF   {margin_lf:+.4}   RF   {margin_rf:+.4}   RH {margin_rh:+.4}   LH {margin_lh:+.4}

",
        limits.type2, limits.type1, limits.leg
    );
    let reasons = violations::describe_pose_violations(robot, solution);
    if reasons.is_empty() {
        let (min_check, min_margin) = margins.min();
        let _ = writeln!(
            page,
            "safe     yes, the least margin is {min_check} {min_margin:.4}"
        );
    } else {
        let reasons = reasons.join("\n             ");
        let _ = writeln!(page, "safe     no, {reasons}");
    }
    page
}
