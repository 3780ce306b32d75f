//! The consequences that violated conditions have for the robot, in plain words, without keys of robot.toml and without
//! numbers.

use lizard_kinematics::{Check, Mechanism};

/// Describes what a violation of `check` would do to the robot.
pub(crate) fn describe_violation(check: Check) -> String {
    let description = match check {
        Check::Type2Head => "nothing would hold the head",
        Check::Type2Tail => "nothing would hold the tail",
        Check::Type1A1 => "the left elbow of the head could flip over",
        Check::Type1A2 => "the right elbow of the head could flip over",
        Check::Type1A3 => "the right elbow of the tail could flip over",
        Check::Type1A4 => "the left elbow of the tail could flip over",
        Check::LegLf => "the left front leg would lock",
        Check::LegRf => "the right front leg would lock",
        Check::LegRh => "the right hind leg would lock",
        Check::LegLh => "the left hind leg would lock",
        Check::StrokeLeft => "the left slider would hit its end stop",
        Check::StrokeRight => "the right slider would hit its end stop",
        Check::UncrossedHead => "the cranks of the head would cross",
        Check::UncrossedTail => "the cranks of the tail would cross",
    };
    description.to_string()
}

/// Describes the consequence of a pose in which this mechanism does not close.
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
    fn descriptions_name_the_affected_part() {
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
