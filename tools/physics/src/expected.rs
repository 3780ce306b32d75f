//! Table of the expected results of trials with a real robot, each with the key of robot.toml for the measured
//! result.

use std::fmt::Write as _;

use lizard_robot::{CheckedGait, Effort, GRAVITY, HIGH_LINE_SHARE, Robot, ServoType};

/// Returns the table of expected results for `docs/measure.md`.
pub fn expected_table(robot: &Robot) -> String {
    let ground = robot.ground();
    let load = ground.body.mean_load();
    let grams = |newton: f64| 1000.0 * newton / GRAVITY;
    let stiffness = ground.stance.stiffness;
    let reach = ground.feet.reach;
    let strut = robot.strut_with_coil(&robot.parts().spring);
    let (servo, hardest_gait) = (*robot.servo_type(), HardestGait::of(robot));
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
            format!(
                "{:.0} g; 40 to 100 g will do",
                100.0 * ground.friction_coefficient
            ),
            "[ground] friction",
        ),
        (
            "1",
            "the same pull backward over the pull forward",
            format!(
                "{:.1}; 0.9 to 1.1 will do; above it, `robots/grain.toml`",
                ground.friction_ratio
            ),
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
                "{} s; up to {:.2} s will do with the torque of the next line",
                servo.s_per_60_deg,
                hardest_gait.limit(servo.s_per_60_deg, |s_per_60_deg| ServoType {
                    s_per_60_deg,
                    ..servo
                })
            ),
            "[servo] s_per_60_deg",
        ),
        (
            "3",
            "torque at which the servo stalls",
            format!(
                "{} kg cm; {:.1} or more will do with the time of the line above",
                servo.stall_kg_cm,
                hardest_gait.limit(servo.stall_kg_cm, |stall_kg_cm| ServoType {
                    stall_kg_cm,
                    ..servo
                })
            ),
            "[servo] stall_kg_cm",
        ),
        (
            "3",
            "voltage at the servo while it moves",
            format!(
                "{} V; {:.1} V or more will do",
                servo.volts,
                servo.volts * hardest_gait.line_share / HIGH_LINE_SHARE
            ),
            "[servo] volts",
        ),
        (
            "3",
            "pull at the foot, in the air, that turns a leg whose link is off its servo",
            format!("0 g; up to {:.0} g will do", grams(20.0 / reach)),
            "[joints] drag",
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
            format!("0 mm, to {:.1} mm either way", ground.stance.twist_error),
            "[feet] twist",
        ),
    ];
    let mut text =
        "| trial | measured | expected | key of robot.toml |\n|---|---|---|---|\n".to_owned();
    for (trial, quantity, value, key) in rows {
        let keys: Vec<String> = key.split(", ").map(|key| format!("`{key}`")).collect();
        _ = writeln!(
            text,
            "| {trial} | {quantity} | {value} | {} |",
            keys.join(", ")
        );
    }
    text
}

/// The gait with the highest load on the servos.
struct HardestGait<'a> {
    robot: &'a Robot,
    gait: &'a CheckedGait,
    /// The largest share of a servo's torque-speed line that the gait uses.
    line_share: f64,
}

impl<'a> HardestGait<'a> {
    fn of(robot: &'a Robot) -> Self {
        let line_share_of = |gait| Self::line_share(robot, gait, robot.servo_type());
        let line_shares = robot.gaits().iter().map(|gait| (gait, line_share_of(gait)));
        let hardest = line_shares.max_by(|(_, a), (_, b)| a.total_cmp(b));
        let (gait, line_share) = hardest.expect("every robot stands");
        Self {
            robot,
            gait,
            line_share,
        }
    }

    /// Returns the largest share of the torque-speed line of `servo` that a gait uses.
    fn line_share(robot: &Robot, gait: &CheckedGait, servo: &ServoType) -> f64 {
        let motors = robot.motors_of_type(servo, servo.volts);
        Effort::of(gait, robot.ground(), &motors).line_share(1.0, 1.0)
    }

    /// Returns the limit of a key of the servo: the value with which the gait uses [`HIGH_LINE_SHARE`] of the
    /// torque-speed line. The search stays within a factor of four of `own_value`, the value of the robot's servo.
    /// `servo_with` returns the servo with another value.
    fn limit(&self, own_value: f64, servo_with: impl Fn(f64) -> ServoType) -> f64 {
        let is_enough = |value: f64| {
            Self::line_share(self.robot, self.gait, &servo_with(value)) <= HIGH_LINE_SHARE
        };
        let mut good_value = own_value;
        let mut bad_value = if is_enough(2.0 * own_value) {
            own_value / 4.0
        } else {
            4.0 * own_value
        };
        for _ in 0..10 {
            let middle = f64::midpoint(good_value, bad_value);
            match is_enough(middle) {
                true => good_value = middle,
                false => bad_value = middle,
            }
        }
        good_value
    }
}
