//! Table of the expected results of trials with a real robot. Each row has the robot.toml key for the measured result.

use lizard_robot::{CheckedGait, Effort, GRAVITY, HIGH_UTILISATION, Robot, ServoType};

/// Returns the table of expected results for `docs/measure.md`.
pub fn format_expected_results_table(robot: &Robot) -> String {
    let ground = robot.ground();
    let (mass, stiffness) = (ground.body.mass, ground.stance.stiffness);
    let grams = |newton: f64| 1000.0 * newton / GRAVITY;
    let [min_stiffness_g, max_stiffness_g] = [0.8, 1.2].map(|factor| grams(factor * stiffness));
    let (stiffness_g, load_g) = (grams(stiffness), grams(ground.body.mean_load()));
    let preload_g = grams(robot.own_strut().preload);
    let drag_g = grams(20.0 / ground.legs.reach);
    let friction_g = 100.0 * ground.friction_coefficient;
    let friction_ratio = ground.friction_ratio;
    let fit = robot.parts().fit;
    let mm_per_deg = ground.legs.reach * 1f64.to_radians();
    let us_per_degree = robot.servos()[0].us_per_degree.abs();
    let twist_error = ground.stance.twist_error;
    let servo = robot.servo_type();
    let (s_per_60_deg, volts) = (servo.s_per_60_deg, servo.supply_volts);
    let stall_torque_kg_cm = servo.stall_torque_kg_cm;
    let (gait, utilisation) = find_hardest_gait(robot);
    let max_s_per_60_deg = find_limit(robot, gait, |servo| &mut servo.s_per_60_deg);
    let min_stall_torque_kg_cm = find_limit(robot, gait, |servo| &mut servo.stall_torque_kg_cm);
    let min_volts = volts * utilisation / HIGH_UTILISATION;
    format!(
        "\
| trial | measured | expected | key of robot.toml |
|---|---|---|---|
| 1 | increase in the scale's reading per mm that the foot is pressed down | {stiffness_g:.0} g ({stiffness:.1} N); \
acceptable: {min_stiffness_g:.0} to {max_stiffness_g:.0} g | `[feet] stiffness` |
| 1 | pull along the floor at which a pad loaded with 100 g slides | {friction_g:.0} g; \
acceptable: 40 to 100 g | `[ground] friction` |
| 1 | backward pull divided by forward pull | {friction_ratio:.1}; \
acceptable: 0.9 to 1.1; above, use `robots/grain.toml` | `[ground] friction_back_over_forward` |
| 2 | first column of the coupon into which all parts can be pushed by hand | {fit:.1} mm | `[parts] fit` |
| 2 | free play of the foot to either side, with the link held still | {mm_per_deg:.1} mm per deg; \
acceptable: 0 to 1 deg | `[leg.drive] play` |
| 2 | pull of the spring in the strut, if there is one | {preload_g:.0} g; \
acceptable: at least 200 g | `[leg.drive] force` |
| 3 | pulse width per deg of the horn's rotation, us, measured over at least 60 deg | {us_per_degree:.1}; \
acceptable: 9 to 11 | `[servo.A1] us_per_degree` |
| 3 | time for a rotation of 60 deg, with the foot in the air | {s_per_60_deg} s; \
acceptable: at most {max_s_per_60_deg:.2} s, with the torque of the next row | `[servo] s_per_60_deg` |
| 3 | stall torque of the servo | {stall_torque_kg_cm} kg cm; \
acceptable: at least {min_stall_torque_kg_cm:.1}, with the time of the row above | `[servo] stall_kg_cm` |
| 3 | voltage at the servo while it moves | {volts} V; \
acceptable: at least {min_volts:.1} V | `[servo] volts` |
| 3 | pull at the raised foot that turns a leg whose link is detached from its servo | 0 g; \
acceptable: at most {drag_g:.0} g | `[joints] drag` |
| built | weight with wires | {mass:.0} g, {load_g:.0} g on each foot | `[body] mass` |
| built | load of LF and RH minus load of RF and LH, divided by the g per mm of the first row | 0 mm; \
acceptable: at most {twist_error:.1} mm either way | `[feet] twist` |
"
    )
}

/// Finds the gait with the highest load on the servos, and the largest fraction of a servo's torque-speed line that it
/// uses.
fn find_hardest_gait(robot: &Robot) -> (&CheckedGait, f64) {
    let utilisations = robot.gaits().iter().map(|gait| {
        let fraction = compute_utilisation(robot, gait, robot.servo_type());
        (gait, fraction)
    });
    let hardest = utilisations.max_by(|(_, a), (_, b)| a.total_cmp(b));
    hardest.expect("every robot has the gait `stand`")
}

/// Returns the largest fraction of the torque-speed line of `servo` that a gait uses.
fn compute_utilisation(robot: &Robot, gait: &CheckedGait, servo: &ServoType) -> f64 {
    let motors = robot.motors_with_type(servo, servo.supply_volts);
    Effort::simulate(gait, robot.ground(), &motors).utilisation(1.0, 1.0)
}

/// Finds the limit of a servo key: the value with which the gait uses [`HIGH_UTILISATION`] of the torque-speed line.
/// The search stays within a factor of four of the value of the robot's servo. `field` returns the key's field.
fn find_limit(robot: &Robot, gait: &CheckedGait, field: fn(&mut ServoType) -> &mut f64) -> f64 {
    let mut servo = *robot.servo_type();
    let own_value = *field(&mut servo);
    let mut is_enough = |value: f64| {
        *field(&mut servo) = value;
        compute_utilisation(robot, gait, &servo) <= HIGH_UTILISATION
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
