//! The output of `lizard pose` for one pose: a JSON object, a table row, or a page of text.

use std::fmt::Write as _;

use lizard_kinematics::{InfeasiblePose, Margins, Pose, Solution};
use lizard_robot::{Robot, violations};
use serde::ser::{Serialize, SerializeMap, Serializer};

use crate::paper::poses::TimedPose;
use crate::shared::number::round_to_decimals;

/// A line of `lizard pose --json`; the field names are the JSON keys. If the pose has no solution, the solution's
/// fields are null. `seconds` is present only if the stream has this column.
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
        let mut map = serializer.serialize_map(None)?;
        for (check, value) in self.0.iter() {
            // Adding 0.0 turns -0.0 into 0.0.
            map.serialize_entry(check.name(), &(value + 0.0))?;
        }
        map.end()
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
        let reasons = violations::find_pose_violations(robot, solution);
        let (head, tail) = (solution.head_point(), solution.tail_point());
        let passive = solution.passive_joints();
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
            left: Some(SliderState {
                phi: passive.phi_left,
                s: solution.left.s,
            }),
            right: Some(SliderState {
                phi: passive.phi_right,
                s: solution.right.s,
            }),
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
        "{seconds} {:>8} {:>8} {:>8} {:>8} | {:>8} {:>8} {:>8} {:>8} | {:>17} {:>17} | {:>7} {:>7} | {:17} | safe, or reason",
        "theta1",
        "theta4",
        "theta8",
        "theta5",
        "theta2",
        "theta3",
        "theta6",
        "theta7",
        "head x, y mm",
        "tail x, y mm",
        "s left",
        "s right",
        "least margin",
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
        Err(infeasible) => {
            let _ = write!(line, " | {infeasible}");
            return line;
        }
        Ok(solution) => solution,
    };
    let (head, tail) = (solution.head_point(), solution.tail_point());
    let (min_check, min_margin) = solution.margins.min();
    for values in [
        [
            solution.theta2(),
            solution.theta3(),
            solution.theta6(),
            solution.theta7(),
        ],
        [head.x, head.y, tail.x, tail.y],
    ] {
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
    match violations::find_pose_violations(robot, solution).first() {
        None => line.push_str("safe"),
        Some(reason) => line.push_str(reason),
    }
    line
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
        Err(infeasible) => {
            let _ = writeln!(page, "\nno solution: {infeasible}");
            return page;
        }
        Ok(solution) => solution,
    };
    let (head, tail) = (solution.head_point(), solution.tail_point());
    let legs = solution.legs.map(|leg| round_3(leg.follower_angle()));
    let round_4 = |margin: f64| round_to_decimals(margin, 4);
    let margins = &solution.margins;
    let _ = write!(
        page,
        "
head     ({:8.3}, {:8.3}) mm   theta2 {:8.3}   theta3 {:8.3} deg
tail     ({:8.3}, {:8.3}) mm   theta6 {:8.3}   theta7 {:8.3} deg
left     s {:+8.3} mm   phi {:8.3} deg
right    s {:+8.3} mm   phi {:8.3} deg
legs     followers  LF {:8.3}   RF {:8.3}   RH {:8.3}   LH {:8.3} deg

margins  (0 is singular, 1 is best)  limits {} {} {}
         type-2    head {:+.4}   tail {:+.4}
         type-1    A1   {:+.4}   A2   {:+.4}   A3 {:+.4}   A4 {:+.4}
         legs      LF   {:+.4}   RF   {:+.4}   RH {:+.4}   LH {:+.4}

",
        round_3(head.x),
        round_3(head.y),
        round_3(solution.theta2()),
        round_3(solution.theta3()),
        round_3(tail.x),
        round_3(tail.y),
        round_3(solution.theta6()),
        round_3(solution.theta7()),
        round_3(solution.left.s),
        round_3(solution.left.phi()),
        round_3(solution.right.s),
        round_3(solution.right.phi()),
        legs[0],
        legs[1],
        legs[2],
        legs[3],
        limits.type2,
        limits.type1,
        limits.leg,
        round_4(margins.type2[0]),
        round_4(margins.type2[1]),
        round_4(margins.type1[0]),
        round_4(margins.type1[1]),
        round_4(margins.type1[2]),
        round_4(margins.type1[3]),
        round_4(margins.leg[0]),
        round_4(margins.leg[1]),
        round_4(margins.leg[2]),
        round_4(margins.leg[3]),
    );
    let reasons = violations::find_pose_violations(robot, solution);
    if reasons.is_empty() {
        let (min_check, min_margin) = margins.min();
        let _ = writeln!(
            page,
            "safe     yes, the least margin is {min_check} {min_margin:.4}"
        );
    } else {
        for (i, reason) in reasons.iter().enumerate() {
            let prefix = if i == 0 {
                "safe     no, "
            } else {
                "             "
            };
            let _ = writeln!(page, "{prefix}{reason}");
        }
    }
    page
}
