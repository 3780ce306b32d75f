//! The servos' motors and the friction of the joints: `[servo]` and `[joints]` in robot.toml.
//!
//! A data sheet specifies a servo's stall torque and its no-load time per 60 deg, at one voltage. Between stall and no
//! load the torque falls linearly with the speed, and both grow with the voltage. No data sheet specifies the rotor's
//! inertia or the error at which the full torque is applied; both are assumed.

use lizard_contact::{GRAVITY, JointFriction, Motor};
use lizard_kinematics::{Lizard, Side};

use crate::config::servo::{ARM_TURN_SIGN, Servo};
use crate::file::{ReadResult, Table, suggest};

/// Torque of 1 kg cm, N mm.
const N_MM_PER_KG_CM: f64 = 10.0 * GRAVITY;

/// A type of servo, in the units of its data sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoType {
    /// Name of the type that supplies the values missing from robot.toml.
    pub model: &'static str,
    /// Source of the type's values.
    pub source: &'static str,
    /// Stall torque, kg cm.
    pub stall_torque_kg_cm: f64,
    /// No-load time per 60 deg, s.
    pub s_per_60_deg: f64,
    /// Supply voltage at which torque and time are specified, V.
    pub rated_volts: f64,
    /// Supply voltage of this robot's servos, V.
    pub supply_volts: f64,
    /// Width of the dead band, us.
    pub dead_band_us: f64,
    /// Time constant with which the unloaded rotor spins up, ms.
    pub rotor_time_constant_ms: f64,
    /// Error beyond the dead band at which the full torque is applied, deg.
    pub full_torque_deg: f64,
}

/// The default: an SG-90 as specified in Tower Pro's data sheet, except for the longer time that sellers state (0.12 s
/// instead of 0.1 s).
const SG90: ServoType = ServoType {
    model: "SG-90",
    source: "Tower Pro's data sheet, time from sellers; rotor and full-torque error assumed",
    stall_torque_kg_cm: 1.8,
    s_per_60_deg: 0.12,
    rated_volts: 4.8,
    supply_volts: 4.8,
    dead_band_us: 10.0,
    rotor_time_constant_ms: 20.0,
    full_torque_deg: 3.0,
};

impl ServoType {
    /// The lowest and the highest allowed supply voltage, V.
    pub const VOLTS_RANGE: (f64, f64) = (2.0, 9.0);

    /// A servo of an SG-90's size with a digital controller: Hitec's HS-5065MG.
    pub(crate) const DIGITAL: Self = Self {
        model: "digital",
        source: "Hitec's list for the HS-5065MG; dead band, rotor and full-torque error assumed",
        s_per_60_deg: 0.14,
        dead_band_us: 2.0,
        rotor_time_constant_ms: 10.0,
        full_torque_deg: 1.0,
        ..SG90
    };

    /// The types that robot.toml can name.
    pub const ALL: [Self; 4] = [
        SG90,
        Self {
            model: "MG90S",
            source: "Tower Pro's data sheet; rotor and full-torque error assumed",
            s_per_60_deg: 0.1,
            dead_band_us: 5.0,
            ..SG90
        },
        Self {
            model: "copy",
            source: "lowest torque that sellers state for an SG-90; speed assumed to be four fifths of the SG-90's; dead band, rotor and full-torque error assumed",
            stall_torque_kg_cm: 1.2,
            s_per_60_deg: 0.15,
            ..SG90
        },
        Self::DIGITAL,
    ];

    /// Reads the keys of `[servo]` except its four tables; all are optional.
    pub(crate) fn read(root: &Table) -> ReadResult<Self> {
        let table = root.unchecked_table("servo")?;
        let base = read_model(&table)?;
        let read_number = |name, default, range, unit| table.number_or(name, default, range, unit);
        let rated_volts = read_number("at_volts", base.rated_volts, Self::VOLTS_RANGE, "V")?;
        Ok(Self {
            stall_torque_kg_cm: read_number(
                "stall_kg_cm",
                base.stall_torque_kg_cm,
                (0.1, 100.0),
                "kg cm",
            )?,
            s_per_60_deg: read_number("s_per_60_deg", base.s_per_60_deg, (0.02, 2.0), "s")?,
            rated_volts,
            supply_volts: read_number("volts", rated_volts, Self::VOLTS_RANGE, "V")?,
            dead_band_us: read_number("dead_band_us", base.dead_band_us, (0.0, 100.0), "us")?,
            rotor_time_constant_ms: read_number(
                "spin_up_ms",
                base.rotor_time_constant_ms,
                (0.5, 200.0),
                "ms",
            )?,
            full_torque_deg: read_number(
                "full_torque_deg",
                base.full_torque_deg,
                (0.1, 45.0),
                "deg",
            )?,
            ..base
        })
    }

    /// The servo's motor at a supply voltage (V), for a servo with this gain (us per degree).
    pub fn motor(&self, volts: f64, us_per_degree: f64) -> Motor {
        let motor = Motor {
            stall_torque: self.stall_torque_kg_cm * N_MM_PER_KG_CM,
            no_load_speed: 60.0 / self.s_per_60_deg,
            rotor_time_constant: self.rotor_time_constant_ms / 1000.0,
            full_torque_error: self.full_torque_deg,
            half_dead_band: self.dead_band_us / 2.0 / us_per_degree.abs(),
        };
        motor.with_supply_ratio(volts / self.rated_volts)
    }
}

/// Finds the servo type that the key `model` names, by default the SG-90; ignores case, hyphens and spaces.
fn read_model(table: &Table) -> ReadResult<ServoType> {
    let simplify = |name: &str| name.to_ascii_lowercase().replace(['-', ' '], "");
    let model_name = table.text_or("model", SG90.model)?;
    let model = ServoType::ALL
        .iter()
        .find(|known| simplify(known.model) == simplify(model_name));
    model.copied().ok_or_else(|| {
        let suggestion = suggest(model_name, &ServoType::ALL.map(|known| known.model));
        let message = format!(
            "is \"{model_name}\"; for a servo that is not listed, set stall_kg_cm and s_per_60_deg from its data sheet; {suggestion}"
        );
        table.error("model", message)
    })
}

/// Reads `[joints]`; every key is optional. The positions of the sliders' arms come from the links and the servos.
pub(crate) fn read_joints(
    root: &Table,
    lizard: &Lizard,
    servos: &[Servo; 4],
) -> ReadResult<JointFriction> {
    let links = &lizard.links;
    let arm_lengths = [links.l14, links.l19, links.l16, links.l11];
    let table = root.optional_table("joints", &["drag", "slider"])?;
    Ok(JointFriction {
        pin_torque: table.number_or("drag", 0.0, (0.0, 1000.0), "N mm")?,
        slider_force: table.number_or("slider", 0.0, (0.0, 20.0), "N")?,
        slider_arms: std::array::from_fn(|i| {
            let (sin, cos) = (servos[i].neutral + ARM_TURN_SIGN[i] * 90.0)
                .to_radians()
                .sin_cos();
            // Forward is y of the chassis frame; left is -x.
            [arm_lengths[i] * sin, -arm_lengths[i] * cos]
        }),
        shaft_spans: Side::ALL.map(|side| {
            let slider = lizard.side(side);
            [slider.base, -slider.front_offset]
        }),
    })
}

#[cfg(test)]
mod tests {
    use super::Side;
    use crate::testing::{all_robots, assert_near, paper_with_tables, robot};

    /// Returns half the dead band, the full-torque error and the rotor time constant.
    fn dead_band_torque_error_and_time(motor: super::Motor) -> [f64; 3] {
        [
            motor.half_dead_band,
            motor.full_torque_error,
            motor.rotor_time_constant,
        ]
    }

    #[test]
    fn servos_default_to_the_sg90() {
        let motors = robot("paper").motors();
        for motor in motors.per_servo {
            // 1.8 kg cm; 60 deg in 0.12 s; half of a dead band of 10 us, at 10 us per deg.
            assert!((motor.stall_torque - 176.5197).abs() < 1e-9 && motor.no_load_speed == 500.0);
            assert_eq!(dead_band_torque_error_and_time(motor), [0.5, 3.0, 0.02]);
        }
        let friction = motors.joint_friction;
        assert_eq!((friction.pin_torque, friction.slider_force), (0.0, 0.0));
    }

    #[test]
    fn every_key_overrides_the_value_of_the_model() {
        let keys = "[servo]\nmodel = \"mg90s\"\ns_per_60_deg = 0.2\nvolts = 6.0\nspin_up_ms = 5\n\
                    full_torque_deg = 1.5\ndead_band_us = 2\n[joints]\nslider = 0.3";
        let robot = paper_with_tables(keys).expect("the robot is valid");
        let motors = robot.motors();
        let motor = motors.per_servo[3];
        assert!((motor.no_load_speed - 300.0 * 6.0 / 4.8).abs() < 1e-9);
        // The stall torque is that of the model.
        assert_near(motor.stall_torque, 176.5197 * 6.0 / 4.8, 1e-9);
        assert_eq!(dead_band_torque_error_and_time(motor), [0.1, 1.5, 0.005]);
        let friction = motors.joint_friction;
        assert_eq!((friction.pin_torque, friction.slider_force), (0.0, 0.3));
    }

    #[test]
    fn slider_arms_and_shaft_spans_give_the_sliders_of_the_kinematics() {
        for (name, robot) in all_robots() {
            let solution = robot.lizard().solve(&robot.neutral_pose());
            let solution = solution.expect("the neutral pose closes");
            let friction = robot.motors().joint_friction;
            for (side, span) in Side::ALL.into_iter().zip(friction.shaft_spans) {
                let [front, rear] = side.servos();
                let slider = solution.side(side);
                // The tips are given relative to the rear shaft.
                for (servo, tip, [shaft_forward, shaft_left]) in [
                    (front, slider.front_tip, span),
                    (rear, slider.rear_tip, [0.0; 2]),
                ] {
                    let arm @ [forward, left] = friction.slider_arms[servo];
                    let error = (tip.y - shaft_forward - forward).hypot(tip.x + shaft_left + left);
                    assert!(
                        error < 1e-6,
                        "{name}, servo {servo}: the tip is {tip:?}, the arm {arm:?}"
                    );
                }
            }
        }
    }
}
