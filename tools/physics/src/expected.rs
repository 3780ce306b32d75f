//! Table of the expected results of trials with a real robot. Each row has the robot.toml key for the measured result.

use std::fmt::Write as _;

use lizard_robot::{CheckedGait, Effort, GRAVITY, HIGH_UTILISATION, Robot, ServoType};

/// Returns the table of expected results for `docs/measure.md`.
pub fn format_expected_table(robot: &Robot) -> String {
    let ground = robot.ground();
    let (mass, load) = (ground.body.mass, ground.body.mean_load());
    let grams = |newton: f64| 1000.0 * newton / GRAVITY;
    let (stiffness, twist_error) = (ground.stance.stiffness, ground.stance.twist_error);
    let friction_grams = 100.0 * ground.friction_coefficient;
    let reach = ground.feet.reach;
    let mm_per_deg = reach * 1f64.to_radians();
    let strut = robot.strut_with_coil(&robot.parts().spring);
    let us_per_degree = robot.servos()[0].us_per_degree.abs();
    let (servo, hardest_gait) = (robot.servo_type(), HardestGait::find(robot));
    let rows = [
        (
            "1",
            "increase in the scale's reading per mm that the foot is pressed down",
            format!(
                "{:.0} g ({stiffness:.1} N); acceptable: {:.0} to {:.0} g",
                grams(stiffness),
                grams(0.8 * stiffness),
                grams(1.2 * stiffness)
            ),
            "[feet] stiffness",
        ),
        (
            "1",
            "pull along the floor at which a pad loaded with 100 g slides",
            format!("{friction_grams:.0} g; acceptable: 40 to 100 g"),
            "[ground] friction",
        ),
        (
            "1",
            "backward pull divided by forward pull",
            format!(
                "{:.1}; acceptable: 0.9 to 1.1; above, use `robots/grain.toml`",
                ground.friction_ratio
            ),
            "[ground] friction_back_over_forward",
        ),
        (
            "2",
            "first column of the coupon into which all parts can be pushed by hand",
            format!("{:.1} mm", robot.parts().fit),
            "[parts] fit",
        ),
        (
            "2",
            "free play of the foot to either side, with the link held still",
            format!("{mm_per_deg:.1} mm per deg; acceptable: 0 to 1 deg"),
            "[leg.drive] play",
        ),
        (
            "2",
            "pull of the spring in the strut, if there is one",
            format!("{:.0} g; acceptable: at least 200 g", grams(strut.preload)),
            "[leg.drive] force",
        ),
        (
            "3",
            "pulse width per deg of the horn's rotation, us, measured over at least 60 deg",
            format!("{us_per_degree:.1}; acceptable: 9 to 11"),
            "[servo.A1] us_per_degree",
        ),
        (
            "3",
            "time for a rotation of 60 deg, with the foot in the air",
            format!(
                "{} s; acceptable: at most {:.2} s, with the torque of the next row",
                servo.s_per_60_deg,
                hardest_gait.find_limit(|servo| &mut servo.s_per_60_deg)
            ),
            "[servo] s_per_60_deg",
        ),
        (
            "3",
            "stall torque of the servo",
            format!(
                "{} kg cm; acceptable: at least {:.1}, with the time of the row above",
                servo.stall_torque_kg_cm,
                hardest_gait.find_limit(|servo| &mut servo.stall_torque_kg_cm)
            ),
            "[servo] stall_kg_cm",
        ),
        (
            "3",
            "voltage at the servo while it moves",
            format!(
                "{} V; acceptable: at least {:.1} V",
                servo.supply_volts,
                servo.supply_volts * hardest_gait.utilisation / HIGH_UTILISATION
            ),
            "[servo] volts",
        ),
        (
            "3",
            "pull at the raised foot that turns a leg whose link is detached from its servo",
            format!("0 g; acceptable: at most {:.0} g", grams(20.0 / reach)),
            "[joints] drag",
        ),
        (
            "built",
            "weight with wires",
            format!("{mass:.0} g, {:.0} g on each foot", grams(load)),
            "[body] mass",
        ),
        (
            "built",
            "load of LF and RH minus load of RF and LH, divided by the g per mm of the first row",
            format!("0 mm; acceptable: at most {twist_error:.1} mm either way"),
            "[feet] twist",
        ),
    ];
    let mut text =
        "| trial | measured | expected | key of robot.toml |\n|---|---|---|---|\n".to_owned();
    for (trial, quantity, value, key) in rows {
        _ = writeln!(text, "| {trial} | {quantity} | {value} | `{key}` |");
    }
    text
}

/// The gait with the highest load on the servos.
struct HardestGait<'a> {
    robot: &'a Robot,
    gait: &'a CheckedGait,
    /// The largest fraction of a servo's torque-speed line that the gait uses.
    utilisation: f64,
}

impl<'a> HardestGait<'a> {
    fn find(robot: &'a Robot) -> Self {
        let utilisations = robot.gaits().iter().map(|gait| {
            let fraction = Self::compute_utilisation(robot, gait, robot.servo_type());
            (gait, fraction)
        });
        let hardest = utilisations.max_by(|(_, a), (_, b)| a.total_cmp(b));
        let (gait, utilisation) = hardest.expect("every robot stands");
        Self {
            robot,
            gait,
            utilisation,
        }
    }

    /// Returns the largest fraction of the torque-speed line of `servo` that a gait uses.
    fn compute_utilisation(robot: &Robot, gait: &CheckedGait, servo: &ServoType) -> f64 {
        let motors = robot.motors_with_type(servo, servo.supply_volts);
        Effort::simulate(gait, robot.ground(), &motors).utilisation(1.0, 1.0)
    }

    /// Finds the limit of a servo key: the value with which the gait uses [`HIGH_UTILISATION`] of the torque-speed
    /// line. The search stays within a factor of four of the value of the robot's servo. `field` returns the key's
    /// field.
    fn find_limit(&self, field: fn(&mut ServoType) -> &mut f64) -> f64 {
        let mut servo = *self.robot.servo_type();
        let own_value = *field(&mut servo);
        let mut is_enough = |value: f64| {
            *field(&mut servo) = value;
            Self::compute_utilisation(self.robot, self.gait, &servo) <= HIGH_UTILISATION
        };
        let mut good_value = own_value;
        let mut bad_value = match is_enough(2.0 * own_value) {
            true => own_value / 4.0,
            false => 4.0 * own_value,
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
