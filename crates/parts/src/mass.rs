//! Mass and centre of mass from the bill of materials, for the contact model.

use lizard_robot::Body;

use crate::bill::Bill;

/// Offset from the plate's middle, both lengthwise and sideways, below which the centre of mass counts as centred, mm.
const CENTRED_TOLERANCE: f64 = 1.0;
/// Largest difference between the masses in robot.toml and in the bill, as a fraction of the bill's mass.
const MASS_TOLERANCE: f64 = 0.05;
/// Largest distance between the centres of mass in robot.toml and in the bill, mm.
const CENTRE_TOLERANCE: f64 = 3.0;

impl Bill {
    /// Returns the values for `[body]` in robot.toml: the mass in whole grams, and the centre of mass to 0.1 mm, or
    /// zeros if it counts as centred.
    pub fn body_values(&self) -> Body {
        let [forward, left, _] = self.centre_of_mass;
        let is_centred = forward.abs() < CENTRED_TOLERANCE && left.abs() < CENTRED_TOLERANCE;
        Body {
            mass: self.grams.round(),
            centre_of_mass: match is_centred {
                true => [0.0; 2],
                // Adding 0 turns -0 into 0.
                false => [forward, left].map(|x| (x * 10.0).round() / 10.0 + 0.0),
            },
        }
    }

    /// Formats [`Bill::body_values`] as the `[body]` table of robot.toml.
    pub fn format_body_toml(&self) -> String {
        let body = self.body_values();
        let mut text = format!("[body]\nmass = {:.1}\n", body.mass);
        let [forward, left] = body.centre_of_mass;
        if body.centre_of_mass != [0.0; 2] {
            text += &format!("centre = [{forward:.1}, {left:.1}]\n");
        }
        text
    }

    /// True if `[body]` in robot.toml differs from the bill by more than `MASS_TOLERANCE` or `CENTRE_TOLERANCE`.
    pub fn differs_from(&self, body: &Body) -> bool {
        let [forward, left, _] = self.centre_of_mass;
        let [body_forward, body_left] = body.centre_of_mass;
        let centre_distance = libm::hypot(body_forward - forward, body_left - left);
        (body.mass - self.grams).abs() > MASS_TOLERANCE * self.grams
            || centre_distance > CENTRE_TOLERANCE
    }

    /// Describes the centre of mass, such as "0.1 mm behind and 0.1 mm to the right of the plate's middle".
    pub fn describe_centre(&self) -> String {
        let [forward, left, _] = self.centre_of_mass;
        let describe_offset = |mm: f64, [positive, negative]: [&str; 2]| {
            let direction = if mm < 0.0 { negative } else { positive };
            format!("{:.1} mm {direction}", mm.abs())
        };
        format!(
            "{} and {} of the plate's middle",
            describe_offset(forward, ["ahead", "behind"]),
            describe_offset(left, ["to the left", "to the right"])
        )
    }
}
