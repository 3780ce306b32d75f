//! The keys of robot.toml that measured movements can determine.

use lizard_robot::{Ground, plausible_range};

/// A number of robot.toml that changes the movement of the gaits.
#[derive(Debug)]
pub struct Key {
    /// Full name in robot.toml.
    pub name: &'static str,
    /// Index of the number in the key's list; `None` if the key is a single number.
    pub(crate) list_index: Option<usize>,
    /// Meaning of the number, in words.
    pub meaning: &'static str,
    /// Unit, empty for a ratio.
    pub unit: &'static str,
    /// Another method to measure the number, in words.
    pub other_method: &'static str,
    /// Name of the assumption in `lizard_robot` whose plausible range is that of the key.
    assumption_name: &'static str,
    /// Step of the numerical derivative: large compared with the roughness of the model, and small compared with its
    /// curvature.
    pub(crate) derivative_step: f64,
    /// Smallest possible value.
    pub(crate) min_value: f64,
    /// The number's place in the ground of a robot.
    field: fn(&mut Ground) -> &mut f64,
}

/// Number of keys.
pub(crate) const KEY_COUNT: usize = 7;

/// The keys, in the order of robot.toml. Other numbers of the ground cannot be distinguished from these: a stiffer
/// foot acts like a longer one, and more mass like more friction.
pub const KEYS: [Key; KEY_COUNT] = [
    Key {
        name: "leg.mount",
        list_index: None,
        meaning: "mounting of the legs",
        unit: "deg",
        other_method: "a photo from above shows it",
        assumption_name: "mounting of the legs",
        derivative_step: 1.0,
        min_value: f64::NEG_INFINITY,
        field: |ground| &mut ground.feet.mount_angle,
    },
    Key {
        name: "leg.drive.play",
        list_index: None,
        meaning: "play of a leg",
        unit: "deg",
        other_method: "trial 2 of docs/measure.md measures it",
        assumption_name: "play of a leg",
        derivative_step: 0.1,
        min_value: 0.0,
        field: |ground| &mut ground.drive.play,
    },
    Key {
        name: "body.centre",
        list_index: Some(0),
        meaning: "mass centre ahead",
        unit: "mm",
        other_method: "balance the robot on an edge",
        assumption_name: "mass centre ahead",
        derivative_step: 1.0,
        min_value: f64::NEG_INFINITY,
        field: |ground| &mut ground.body.mass_centre[0],
    },
    Key {
        name: "body.centre",
        list_index: Some(1),
        meaning: "mass centre to the left",
        unit: "mm",
        other_method: "balance the robot on an edge",
        assumption_name: "mass centre ahead",
        derivative_step: 1.0,
        min_value: f64::NEG_INFINITY,
        field: |ground| &mut ground.body.mass_centre[1],
    },
    Key {
        name: "feet.twist",
        list_index: None,
        meaning: "front left foot too long",
        unit: "mm",
        other_method: "a scale under each foot tells it, by docs/measure.md",
        assumption_name: "front left foot too long",
        derivative_step: 0.2,
        min_value: f64::NEG_INFINITY,
        field: |ground| &mut ground.stance.twist,
    },
    Key {
        name: "ground.friction",
        list_index: None,
        meaning: "friction of a pad",
        unit: "",
        other_method: "it cancels, but for the load of the servos; a board that is tilted until the robot slides gives it",
        assumption_name: "friction of a pad",
        derivative_step: 0.05,
        min_value: 0.05,
        field: |ground| &mut ground.friction_coefficient,
    },
    Key {
        name: "ground.friction_back_over_forward",
        list_index: None,
        meaning: "friction backward over forward",
        unit: "",
        other_method: "trial 1 of docs/measure.md measures it",
        assumption_name: "friction backward over forward",
        derivative_step: 0.03,
        min_value: 0.1,
        field: |ground| &mut ground.friction_ratio,
    },
];

/// Index in [`KEYS`] of the play of a leg.
pub(crate) const PLAY_INDEX: usize = 1;
/// Index in [`KEYS`] of the excess length of the front left foot.
pub(crate) const TWIST_INDEX: usize = 4;
/// Index in [`KEYS`] of the ratio of the friction backward to the friction forward.
pub(crate) const FRICTION_RATIO_INDEX: usize = 6;

impl Key {
    /// The name with its index, such as `body.centre[0]`.
    pub fn full_name(&self) -> String {
        match self.list_index {
            Some(index) => format!("{}[{index}]", self.name),
            None => self.name.to_owned(),
        }
    }

    /// The key's value in the ground of a robot.
    pub fn value_in(&self, ground: &Ground) -> f64 {
        *(self.field)(&mut { *ground })
    }

    pub(crate) fn set(&self, ground: &mut Ground, value: f64) {
        *(self.field)(ground) = value;
    }

    /// Standard deviation of the value before anything is measured: half of the width of its plausible range.
    pub fn prior_error(&self) -> f64 {
        let [low, high] =
            plausible_range(self.assumption_name).expect("a test checks that each key has a range");
        (high - low) / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_has_a_plausible_range_much_wider_than_its_derivative_step() {
        for key in KEYS {
            assert!(
                key.prior_error() >= 5.0 * key.derivative_step,
                "{} {}",
                key.name,
                key.prior_error()
            );
        }
        let names = [PLAY_INDEX, TWIST_INDEX, FRICTION_RATIO_INDEX].map(|index| KEYS[index].name);
        assert_eq!(
            names,
            [
                "leg.drive.play",
                "feet.twist",
                "ground.friction_back_over_forward"
            ]
        );
    }
}
