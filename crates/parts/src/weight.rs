//! Mass and mass centre from the bill, for the contact model.

use lizard_robot::Body;

use crate::bill::Bill;

/// Distance from the plate's middle, along x and along y, below which the mass centre counts as in the middle, mm.
const MIDDLE_TOLERANCE: f64 = 1.0;
/// Largest difference of the mass between robot.toml and the bill, as a share of the bill's mass.
const MASS_TOLERANCE: f64 = 0.05;
/// Largest distance between the mass centres of robot.toml and of the bill, mm.
const CENTRE_TOLERANCE: f64 = 3.0;

impl Bill {
    /// The values for `[body]` in robot.toml: the mass in whole grams, and the mass centre to 0.1 mm, or zeros if it
    /// is in the plate's middle.
    pub fn body_values(&self) -> Body {
        let [ahead, left, _] = self.centre;
        let centre = match ahead.abs() < MIDDLE_TOLERANCE && left.abs() < MIDDLE_TOLERANCE {
            true => [0.0; 2],
            false => [ahead, left].map(|coordinate| (coordinate * 10.0).round() / 10.0 + 0.0),
        };
        Body {
            mass: self.grams.round(),
            mass_centre: centre,
        }
    }

    /// Formats [`Bill::body_values`] as a table of robot.toml.
    pub fn body_toml(&self) -> String {
        let Body {
            mass,
            mass_centre: centre,
        } = self.body_values();
        match centre {
            [0.0, 0.0] => format!("[body]\nmass = {mass:.1}\n"),
            [ahead, left] => {
                format!("[body]\nmass = {mass:.1}\ncentre = [{ahead:.1}, {left:.1}]\n")
            }
        }
    }

    /// True if the `[body]` of a robot.toml differs from the bill by more than 5 % or 3 mm.
    pub fn differs_from(&self, body: &Body) -> bool {
        let [ahead, left, _] = self.centre;
        let error = libm::hypot(body.mass_centre[0] - ahead, body.mass_centre[1] - left);
        (body.mass - self.grams).abs() > MASS_TOLERANCE * self.grams || error > CENTRE_TOLERANCE
    }

    /// The position of the mass centre relative to the plate's middle, such as "0.1 mm behind and 0.1 mm to the
    /// right of".
    pub fn centre_in_words(&self) -> String {
        let [ahead, left, _] = self.centre;
        let distance_text = |value: f64, [positive, negative]: [&str; 2]| {
            let word = if value < 0.0 { negative } else { positive };
            format!("{:.1} mm {word}", value.abs())
        };
        format!(
            "{} and {} of",
            distance_text(ahead, ["ahead", "behind"]),
            distance_text(left, ["to the left", "to the right"])
        )
    }
}
