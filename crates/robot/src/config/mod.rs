//! The dimensions and parameters in robot.toml, with the valid range of each.
//!
//! A wrong number could break the robot: its linkage would not close, a servo would press against its stop, or the
//! chassis would fall over. Therefore every value is checked against a range, the lengths must fit into the core's
//! integers, and the neutral pose must be safe. [`RobotConfig`] holds the checked values: linkage, servos, legs, parts,
//! supplies and the ground of the contact model.

mod coil;
mod consequence;
mod drive;
mod ground;
mod hips;
mod input;
mod legs;
mod limits;
mod motor;
mod parts;
mod plate;
pub(crate) mod scale;
pub mod servo;
mod strut;
mod supply;
#[cfg(test)]
mod tests;

pub use coil::Coil;
pub(crate) use consequence::{describe_open_loop, describe_violation};
pub use input::{INPUT_NAMES, Inputs};
pub use legs::{LegPlan, LegPoints};
pub use motor::ServoType;
pub use parts::{Horn, Pad, Parts, Screw, ServoBody};
pub use plate::Plate;
pub use servo::{Servo, SpeedLimits};
pub(crate) use strut::{mounted_spring_length, own_strut};
pub use supply::{FUSE_RATING_A, MIN_SWITCH_RATING_A, Rail, Supplies, healthy_rail_pin_mv};

use lizard_contact::{GroundContact, JointFriction};
use lizard_core::numbers::link_lengths::MIN_COUPLER_STEPS;
use lizard_kinematics::{End, Leg, Limits, Links, Lizard, Side};

use crate::file::{Error, ReadResult, Table};
use hips::Hips;
use scale::MAX_LINK_LENGTH_MM;

/// Range of a link's length, mm.
const LENGTH_RANGE_MM: (f64, f64) = (1.0, MAX_LINK_LENGTH_MM);

/// The replacement for the removed keys `spring` and `preload` of `[leg]`, for the message about these keys.
const SPRING_REPLACEMENT: &str =
    "[leg.drive] with kind = \"strut\" and the force and rate of its spring";

/// The keys of `[links]`.
const LINK_NAMES: [&str; 20] = [
    "l0", "l1", "l2", "l3", "l4", "l5", "l6", "l7", "l8", "l9", "l10", "l11", "l12", "l13", "l14",
    "l15", "l16", "l17", "l18", "l19",
];

/// The contents of robot.toml except the name, the gaits and the routines.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RobotConfig {
    /// The lengths of all links.
    pub lizard: Lizard,
    /// The servos A1, A2, A3, A4.
    pub servos: [Servo; 4],
    /// The type of all four servos.
    pub servo_type: ServoType,
    /// Friction of the joints.
    pub joint_friction: JointFriction,
    /// Limits of margins and strokes.
    pub limits: Limits,
    /// Limits of the servos' speed.
    pub speed_limits: SpeedLimits,
    /// The parameters of the contact model.
    pub ground: GroundContact,
    /// The power supplies of the board and the servos.
    pub supplies: Supplies,
    /// The pins of the inputs.
    pub inputs: Inputs,
    /// The dimensions of the parts to print and to buy.
    pub parts: Parts,
    /// The legs in servo order.
    pub legs: [LegPlan; 4],
}

impl RobotConfig {
    /// Reads and checks all values and the neutral pose.
    pub fn read(root: &Table) -> ReadResult<Self> {
        let links = read_links(root)?;
        let (leg, hips, mount_angle) = read_leg(root)?;
        let mut used_pins = servo::UsedPins::new();
        let servos = servo::read(root, &mut used_pins)?;
        let (limits, speed_limits) = limits::read(root)?;
        let parts = Parts::read(root)?;
        let lizard = Lizard { links, leg };
        let leg_geometry = hips.compute_leg_geometry(&lizard, &parts, mount_angle)?;
        let neutral_angles = servos.map(|servo| servo.neutral);
        let legs = std::array::from_fn(|servo| {
            LegPlan::new(servo, neutral_angles[servo], &lizard, &parts, &leg_geometry)
        });
        let drive = drive::read(&root.unchecked_table("leg")?, &legs, neutral_angles, &parts)?;
        let config = Self {
            supplies: Supplies::read(root, &mut used_pins)?,
            inputs: Inputs::read(root, &mut used_pins)?,
            servos,
            servo_type: ServoType::read(root)?,
            joint_friction: motor::read_joints(root, &lizard, &servos)?,
            limits,
            speed_limits,
            ground: ground::read(root, leg_geometry, drive)?,
            legs,
            lizard,
            parts,
        };
        config.check_lengths()?;
        config.check_neutral()?;
        let servo_volts = config.servo_type.supply_volts;
        config.supplies.check_rail(servo_volts)?;
        Ok(config)
    }

    /// The servos' neutral angles, deg, chassis frame, servo order.
    pub fn neutral_angles(&self) -> [f64; 4] {
        self.servos.map(|servo| servo.neutral)
    }

    /// Rejects couplers that are too short, relative to the rest of their loop, for the firmware's 16-bit integers.
    /// Also rejects stroke limits at which a slider's length could be negative.
    fn check_lengths(&self) -> ReadResult<()> {
        for (end, names) in [
            (End::Head, ["links.l2", "links.l3"]),
            (End::Tail, ["links.l7", "links.l8"]),
        ] {
            let five_bar = self.lizard.end(end);
            let steps_per_mm = scale::steps_per_mm(scale::find_five_bar_scale(&five_bar));
            let min_mm = f64::from(MIN_COUPLER_STEPS) / steps_per_mm;
            let couplers = [five_bar.left_coupler_length, five_bar.right_coupler_length];
            for (key, value) in names.into_iter().zip(couplers) {
                if value < min_mm {
                    // Rounded up, so that the length in the message is sufficient.
                    let min_mm = (10.0 * min_mm).ceil() / 10.0;
                    let message = format!(
                        "is {value} mm, which is too short relative to the rest of its loop; the firmware's 16-bit lengths require at least {min_mm:.1} mm, or shorter cranks and a shorter base"
                    );
                    return Err(Error::new(key, message));
                }
            }
        }
        let nominal_lengths = Side::ALL.map(|side| self.lizard.side(side).nominal_length);
        let min_nominal_length = nominal_lengths[0].min(nominal_lengths[1]);
        for (key, value) in [
            ("limits.stroke_min", self.limits.stroke_min),
            ("limits.stroke_max", self.limits.stroke_max),
        ] {
            let (min, max) = (-min_nominal_length, MAX_LINK_LENGTH_MM);
            if !(min..=max).contains(&value) {
                let unit = "mm, so that the slider's length stays positive";
                return Err(Error::out_of_range(key, value, (min, max), unit));
            }
        }
        Ok(())
    }

    /// Rejects a robot whose neutral pose violates a limit.
    fn check_neutral(&self) -> ReadResult<()> {
        let neutral_error = |consequence: String, problem: String| {
            let consequence = format!("in the neutral pose {consequence}");
            Error::with_consequence("servo", consequence, problem)
        };
        let solution = self.lizard.solve(&self.neutral_angles().into());
        let solution = solution.map_err(|infeasible| {
            neutral_error(
                describe_open_loop(infeasible.mechanism),
                infeasible.to_string(),
            )
        })?;
        match self.limits.violations(&solution).next() {
            Some(violation) => {
                let consequence = describe_violation(violation.check);
                Err(neutral_error(consequence, violation.to_string()))
            }
            None => Ok(()),
        }
    }
}

/// Reads the links of the body.
fn read_links(root: &Table) -> ReadResult<Links> {
    let table = root.table("links", &LINK_NAMES)?;
    let mut lengths = [0.0; 20];
    for (length, name) in lengths.iter_mut().zip(LINK_NAMES) {
        *length = table.number(name, LENGTH_RANGE_MM, "mm")?;
    }
    let links = Links::from(lengths);
    let reason = "the chassis is a rectangle, so its two sides are equally long";
    require_equal("links.l15", links.l15, "links.l10", links.l10, reason)?;
    Ok(links)
}

/// Reads the legs: their links, their hips, and the mount angle, which is the legs' sweep in the neutral pose, deg.
fn read_leg(root: &Table) -> ReadResult<(Leg, Hips, f64)> {
    let keys = [
        "ground",
        "crank",
        "coupler",
        "follower",
        "hip_forward",
        "hip_side",
        "mount",
        "drive",
    ];
    let table = root.unchecked_table("leg")?;
    table.reject_removed_keys(&["spring", "preload"], SPRING_REPLACEMENT)?;
    let table = table.require_known_keys(&keys)?;
    let read_length = |name| table.number(name, LENGTH_RANGE_MM, "mm");
    let leg = Leg {
        ground: read_length("ground")?,
        crank: read_length("crank")?,
        coupler: read_length("coupler")?,
        follower: read_length("follower")?,
    };
    let reason = "a leg is a parallelogram, so its opposite links are equally long";
    require_equal("leg.coupler", leg.coupler, "leg.ground", leg.ground, reason)?;
    require_equal("leg.follower", leg.follower, "leg.crank", leg.crank, reason)?;
    let hips = Hips::read(&table)?;
    let mount_angle = table.number("mount", (-90.0, 90.0), "deg")?;
    Ok((leg, hips, mount_angle))
}

/// Rejects a key whose value differs from the value of another key; `reason` explains the requirement.
fn require_equal(
    key: &str,
    value: f64,
    other_key: &str,
    other_value: f64,
    reason: &str,
) -> ReadResult<()> {
    if value == other_value {
        return Ok(());
    }
    let message = format!("is {value}, but {other_key} is {other_value}; {reason}");
    Err(Error::new(key, message))
}
