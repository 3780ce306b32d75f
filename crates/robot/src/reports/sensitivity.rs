//! The change of the gaits' predictions with the pads' friction, the legs' mounting, the feet and the play.

use std::fmt;

use lizard_contact::{GroundContact, Prediction};

use crate::reports::report::{UNDETERMINED_NOTE, column_width, format_component, format_turn};
use crate::robot::Robot;

/// Excess length of the front left foot in the table that varies the stiffness of the feet, mm.
const EXCESS_LENGTH_MM: f64 = 0.6;

/// A parameter that the analysis varies.
struct Parameter {
    /// The heading of the parameter's table.
    title: &'static str,
    /// The values that the parameter takes.
    values: &'static [f64],
    /// Sets the parameter of the ground to one of the values.
    apply: fn(&mut GroundContact, f64),
}

/// The varied parameters in the order of the report.
const PARAMETERS: [Parameter; 5] = [
    // Ratio of a pad's backward friction to its forward friction: below 1 for pads mounted in reverse, 1 for equal
    // friction.
    Parameter {
        title: "back/forward",
        values: &[0.8, 1.0, 1.1, 1.25, 1.5, 2.0],
        apply: |ground, ratio| ground.friction_ratio = ratio,
    },
    // A leg that is mounted 41.4 deg outward is in line with its servo's horn.
    Parameter {
        title: "mount, deg",
        values: &[0.0, 20.0, 41.4, 49.0, -41.4],
        apply: |ground, mount| ground.legs.mount_angle = mount,
    },
    Parameter {
        title: "too long, mm",
        values: &[0.5, 1.0, 1.5, 2.0],
        apply: |ground, excess_length| ground.stance.twist = excess_length,
    },
    // The last value is the stiffness of leaf springs that are 2 mm thick.
    Parameter {
        title: "feet, N/mm",
        values: &[1.0, 2.0, 3.3],
        apply: |ground, stiffness| {
            ground.stance.stiffness = stiffness;
            ground.stance.twist = EXCESS_LENGTH_MM;
        },
    },
    Parameter {
        title: "play, +-deg",
        values: &[1.0, 2.0],
        apply: |ground, play| ground.drive.play = play,
    },
];

/// Predictions of all gaits that move, for each value of each parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// For each gait: its name, and the predictions of a cycle for each value of each parameter in [`PARAMETERS`].
    rows: Vec<(String, [Vec<Prediction>; PARAMETERS.len()])>,
    /// Stiffness of the robot's own feet, N/mm.
    foot_stiffness: f64,
}

impl Sensitivity {
    /// Predicts a robot's gaits for each value of each parameter.
    pub fn compute(robot: &Robot) -> Self {
        let ground = robot.ground();
        let moving_gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
        let rows = moving_gaits.map(|gait| {
            let predictions = PARAMETERS.map(|parameter| {
                let predict = |value: &f64| {
                    let mut ground = *ground;
                    (parameter.apply)(&mut ground, *value);
                    gait.predict(&ground)
                };
                parameter.values.iter().map(predict).collect()
            });
            (gait.name().to_string(), predictions)
        });
        Self {
            rows: rows.collect(),
            foot_stiffness: ground.stance.stiffness,
        }
    }
}

impl fmt::Display for Sensitivity {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(
            "One cycle with ideal servos: mm forward, and deg of counter-clockwise turn if not zero.\n",
        )?;
        let width = column_width(self.rows.iter().map(|(name, _)| name.as_str()));
        let mut is_every_prediction_determined = true;
        for (index, Parameter { title, values, .. }) in PARAMETERS.iter().enumerate() {
            f.write_str("\n")?;
            match *title {
                "too long, mm" => {
                    let stiffness = self.foot_stiffness;
                    writeln!(f, "Front left foot too long, feet of {stiffness} N/mm:")?;
                }
                "feet, N/mm" => writeln!(
                    f,
                    "Front left foot {EXCESS_LENGTH_MM} mm too long, feet of another stiffness:"
                )?,
                _ => {}
            }
            write!(f, "{title:<width$}")?;
            for value in *values {
                write!(f, "{value:>15}")?;
            }
            f.write_str("\n")?;
            for (name, predictions) in &self.rows {
                let predictions = &predictions[index];
                is_every_prediction_determined &= predictions
                    .iter()
                    .all(|prediction| prediction.forward.is_some() && prediction.turn.is_some());
                let cells: String = predictions.iter().map(format_cell).collect();
                writeln!(f, "{}", format!("{name:<width$}{cells}").trim_end())?;
            }
        }
        match is_every_prediction_determined {
            true => Ok(()),
            false => write!(f, "\n{UNDETERMINED_NOTE}"),
        }
    }
}

/// Formats a prediction. A turn that rounds to zero is omitted.
fn format_cell(prediction: &Prediction) -> String {
    let turn = format_turn(prediction.turn);
    format!("{:>9}{turn:>6}", format_component(prediction.forward, 1))
}
