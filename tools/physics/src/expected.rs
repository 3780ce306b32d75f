//! The expected results of trials with a real robot, each with the key of robot.toml for the
//! measured result.

use std::fmt::Write as _;

use lizard_robot::{GRAVITY, Robot};
use lizard_twin::ServoModel;

/// The table of `docs/measure.md`.
#[must_use]
pub fn expected(robot: &Robot) -> String {
    let ground = robot.ground();
    let load = ground.body.mean_load();
    let grams = |newton: f64| 1000.0 * newton / GRAVITY;
    let stiffness = ground.stance.stiffness;
    let reach = ground.feet.reach;
    let strut = robot.strut_of(&robot.parts().spring);
    let rows = [
        (
            "1",
            "increase of the scale's reading for each mm that the foot is pressed down",
            format!(
                "{:.0} g, that is {stiffness:.1} N; {:.0} to {:.0} g will do",
                grams(stiffness),
                grams(0.8 * stiffness),
                grams(1.2 * stiffness)
            ),
            "[feet] stiffness",
        ),
        (
            "1",
            "pull along the floor at which a pad with a load of 100 g slides",
            format!("{:.0} g; 40 to 100 g will do", 100.0 * ground.friction),
            "[ground] friction",
        ),
        (
            "1",
            "the same pull backward over the pull forward",
            format!("{:.1}; 0.9 to 1.1 will do", ground.ratio),
            "[ground] friction_back_over_forward",
        ),
        (
            "2",
            "first column of the coupon into which everything can be pushed by hand",
            format!("{:.1} mm", robot.parts().fit),
            "[parts] fit",
        ),
        (
            "2",
            "free play of the foot to either side, with the link held still",
            format!(
                "{:.1} mm for each deg; 0 to 1 deg will do",
                reach * 1f64.to_radians()
            ),
            "[leg.drive] play",
        ),
        (
            "2",
            "pull of the spring in the strut, if there is one",
            format!("{:.0} g; 200 g or more will do", grams(strut.force)),
            "[leg.drive] force",
        ),
        (
            "3",
            "us of pulse for each deg that the horn turns, measured over at least 60 deg",
            format!(
                "{:.1}; 9 to 11 will do",
                robot.servos()[0].us_per_degree.abs()
            ),
            "[servo.A1] us_per_degree",
        ),
        (
            "3",
            "time for a turn of 60 deg, with the foot in the air",
            format!(
                "{:.2} s; up to {:.2} s will do",
                60.0 / ServoModel::SG90.rate,
                0.8 * 60.0 / robot.pace().gait_slew
            ),
            "[limits] gait_slew",
        ),
        (
            "3",
            "torque that the servo needs on the floor, from load and friction",
            format!(
                "{:.0} N mm of the {:.0} N mm at which an SG-90 stalls",
                ground.grip() * reach,
                lizard_parts::STALL
            ),
            "[body] mass, [ground] friction",
        ),
        (
            "built",
            "weight with wires",
            format!(
                "{:.0} g, {:.0} g on each foot",
                ground.body.mass,
                grams(load)
            ),
            "[body] mass",
        ),
        (
            "built",
            "load of LF and RH less that of RF and LH, divided by the g for each mm of the first line",
            format!("0 mm, to {:.1} mm either way", ground.stance.level),
            "[feet] twist",
        ),
    ];
    let mut text =
        "| trial | measured | expected | key of robot.toml |\n|---|---|---|---|\n".to_owned();
    for (trial, what, value, key) in rows {
        let keys: Vec<String> = key.split(", ").map(|key| format!("`{key}`")).collect();
        _ = writeln!(text, "| {trial} | {what} | {value} | {} |", keys.join(", "));
    }
    text
}
