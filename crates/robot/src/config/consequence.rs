//! The consequences that violated conditions have for the robot, in plain words, without keys of robot.toml and without
//! numbers.

use lizard_kinematics::{Check, End, Mechanism, Side};

/// The names of the legs in messages, in servo order.
const LEG_DISPLAY_NAMES: [&str; 4] = ["left front", "right front", "right hind", "left hind"];

/// Describes what a violation of `check` would do to the robot.
pub(crate) fn describe_violation(check: Check) -> String {
    let index_in = |checks: &[Check]| checks.iter().position(|candidate| *candidate == check);
    if let Some(end) = index_in(&Check::TYPE2) {
        return format!("nothing would hold the {}", End::ALL[end]);
    }
    if let Some(servo) = index_in(&Check::TYPE1) {
        let end = End::from_servo(servo);
        let is_left = end.servos()[0] == servo;
        let side_name = if is_left { "left" } else { "right" };
        return format!("the {side_name} elbow of the {end} could flip over");
    }
    if let Some(leg) = index_in(&Check::LEG) {
        return format!("the {} leg would lock", LEG_DISPLAY_NAMES[leg]);
    }
    if let Some(side) = index_in(&Check::STROKE) {
        return format!("the {} slider would hit its end stop", Side::ALL[side]);
    }
    let end_name = index_in(&Check::UNCROSSED).map_or("end", |end| End::ALL[end].name());
    format!("the cranks of the {end_name} would cross")
}

/// Describes what a pose in which this mechanism does not close would do to the robot.
pub(crate) fn describe_open_loop(mechanism: Mechanism) -> String {
    match mechanism {
        Mechanism::End(end) => format!("the links of the {end} would not reach each other"),
        Mechanism::Side(side) => format!("the arm tips of the {side} slider would coincide"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_description_names_the_affected_part() {
        for (check, expected) in [
            (Check::Type2Tail, "nothing would hold the tail"),
            (Check::Type1A1, "the left elbow of the head could flip over"),
            (
                Check::Type1A2,
                "the right elbow of the head could flip over",
            ),
            (
                Check::Type1A3,
                "the right elbow of the tail could flip over",
            ),
            (Check::Type1A4, "the left elbow of the tail could flip over"),
            (Check::LegRf, "the right front leg would lock"),
            (Check::LegRh, "the right hind leg would lock"),
            (Check::StrokeLeft, "the left slider would hit its end stop"),
            (Check::UncrossedHead, "the cranks of the head would cross"),
        ] {
            assert_eq!(describe_violation(check), expected);
        }
    }
}
