//! The robot.toml keys that measured movements can determine.

use lizard_robot::{GroundContact, plausible_range};

/// A number in robot.toml that affects the gaits' movements.
#[derive(Debug)]
pub struct Key {
    /// Full name in robot.toml.
    pub name: &'static str,
    /// Index of the number in the key's list; `None` if the key is a single number.
    pub(crate) list_index: Option<usize>,
    /// Unit, empty for a ratio.
    pub unit: &'static str,
    /// Instruction for measuring the number in another way.
    pub other_method: &'static str,
    /// Name of the assumption in `lizard_robot` that has the key's plausible range. Both coordinates of the centre of
    /// mass use the range of the forward coordinate.
    assumption_name: &'static str,
    /// Step of the numerical derivative, in the key's unit: large enough to average over the roughness of the model,
    /// and small enough that its curvature does not matter.
    pub(crate) derivative_step: f64,
    /// Smallest possible value, in the key's unit.
    pub(crate) min_value: f64,
    /// Returns the number's field in a robot's ground.
    field: fn(&mut GroundContact) -> &mut f64,
}

/// Number of keys.
pub(crate) const KEY_COUNT: usize = 7;

/// The keys, in the order of robot.toml. Other numbers of the ground cannot be distinguished from these keys: a stiffer
/// foot acts like a longer foot, and more mass acts like more friction.
pub const KEYS: [Key; KEY_COUNT] = [
    Key {
        name: "leg.mount",
        list_index: None,
        unit: "deg",
        other_method: "measure it on a photo from above",
        assumption_name: "mounting of the legs",
        derivative_step: 1.0,
        min_value: f64::NEG_INFINITY,
        field: |ground| &mut ground.legs.mount_angle,
    },
    Key {
        name: "leg.drive.play",
        list_index: None,
        unit: "deg",
        other_method: "use trial 2 in docs/measure.md",
        assumption_name: "leg play",
        derivative_step: 0.1,
        min_value: 0.0,
        field: |ground| &mut ground.drive.play,
    },
    Key {
        name: "body.centre",
        list_index: Some(0),
        unit: "mm",
        other_method: "balance the robot on an edge",
        assumption_name: "centre of mass ahead",
        derivative_step: 1.0,
        min_value: f64::NEG_INFINITY,
        field: |ground| &mut ground.body.centre_of_mass[0],
    },
    Key {
        name: "body.centre",
        list_index: Some(1),
        unit: "mm",
        other_method: "balance the robot on an edge",
        assumption_name: "centre of mass ahead",
        derivative_step: 1.0,
        min_value: f64::NEG_INFINITY,
        field: |ground| &mut ground.body.centre_of_mass[1],
    },
    Key {
        name: "feet.twist",
        list_index: None,
        unit: "mm",
        other_method: "put a scale under each foot, as in docs/measure.md",
        assumption_name: "front left foot too long",
        derivative_step: 0.2,
        min_value: f64::NEG_INFINITY,
        field: |ground| &mut ground.stance.twist,
    },
    Key {
        name: "ground.friction",
        list_index: None,
        unit: "",
        other_method: "tilt a board until the robot slides; friction affects gaits only through the servo loads",
        assumption_name: "pad friction",
        derivative_step: 0.05,
        min_value: 0.05,
        field: |ground| &mut ground.friction_coefficient,
    },
    Key {
        name: "ground.friction_back_over_forward",
        list_index: None,
        unit: "",
        other_method: "use trial 1 in docs/measure.md",
        assumption_name: "backward over forward friction",
        derivative_step: 0.03,
        min_value: 0.1,
        field: |ground| &mut ground.friction_ratio,
    },
];

/// Index in [`KEYS`] of a leg's play.
pub(crate) const PLAY_INDEX: usize = 1;
/// Index in [`KEYS`] of the excess length of the front left foot.
pub(crate) const TWIST_INDEX: usize = 4;
/// Index in [`KEYS`] of the friction ratio, backward over forward.
pub(crate) const FRICTION_RATIO_INDEX: usize = 6;

impl Key {
    /// The name with its index, such as `body.centre[0]`.
    pub fn full_name(&self) -> String {
        match self.list_index {
            Some(index) => format!("{}[{index}]", self.name),
            None => self.name.to_owned(),
        }
    }

    /// Reads the key's value from a robot's ground.
    pub fn read_value(&self, ground: &GroundContact) -> f64 {
        *(self.field)(&mut { *ground })
    }

    /// Writes the key's value into a robot's ground.
    pub(crate) fn write_value(&self, ground: &mut GroundContact, value: f64) {
        *(self.field)(ground) = value;
    }

    /// Standard deviation of the value before any measurement: half the width of the plausible range.
    pub fn prior_error(&self) -> f64 {
        let [min, max] =
            plausible_range(self.assumption_name).expect("a test checks that each key has a range");
        (max - min) / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plausible_range_of_every_key_is_much_wider_than_its_derivative_step() {
        for key in KEYS {
            let (name, prior_error) = (key.name, key.prior_error());
            let is_wide = prior_error >= 5.0 * key.derivative_step;
            assert!(is_wide, "{name}: prior error {prior_error}");
        }
        for (index, name) in [
            (PLAY_INDEX, "leg.drive.play"),
            (TWIST_INDEX, "feet.twist"),
            (FRICTION_RATIO_INDEX, "ground.friction_back_over_forward"),
        ] {
            assert_eq!(KEYS[index].name, name);
        }
    }
}
