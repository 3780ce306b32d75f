//! The sensitivity of the gaits to friction, mounting, feet and play, for a robot or a floor that differs from
//! robot.toml.

use std::fmt;

use lizard_contact::{Drive, Feet, Ground, Prediction, Stance};

use crate::reports::report::{UNDECIDED_NOTE, column_width, format_component};
use crate::robot::Robot;

/// Excess length of the front left foot in the table that varies the stiffness of the feet, mm.
const EXCESS_LENGTH_MM: f64 = 0.6;

/// A parameter that is varied: its name, its values, and the function that returns the ground with one of them.
type Change = (&'static str, &'static [f64], fn(&Ground, f64) -> Ground);

/// The varied parameters in the order of the report.
const CHANGES: [Change; 5] = [
    // Friction of a pad that slides backward over that of a pad that slides forward: below 1 for pads mounted in
    // reverse, 1 for equal friction.
    (
        "friction",
        &[0.8, 1.0, 1.1, 1.25, 1.5, 2.0],
        |ground, ratio| Ground {
            friction_ratio: ratio,
            ..*ground
        },
    ),
    // A leg mounted 41.4 deg outward is in line with its servo's horn.
    (
        "mount, deg",
        &[0.0, 20.0, 41.4, 49.0, -41.4],
        |ground, mount| Ground {
            feet: Feet {
                mount_angle: mount,
                ..ground.feet
            },
            ..*ground
        },
    ),
    ("too long, mm", &[0.5, 1.0, 1.5, 2.0], |ground, twist| {
        ground_with_stance(ground, ground.stance.stiffness, twist)
    }),
    // The last value is the stiffness of leaf springs that are 2 mm thick.
    ("feet, N/mm", &[1.0, 2.0, 3.3], |ground, stiffness| {
        ground_with_stance(ground, stiffness, EXCESS_LENGTH_MM)
    }),
    ("play, +-deg", &[1.0, 2.0], |ground, play| Ground {
        drive: Drive {
            play,
            ..ground.drive
        },
        ..*ground
    }),
];

/// The ground with feet of this stiffness, and the front left foot too long by `twist` mm.
fn ground_with_stance(ground: &Ground, stiffness: f64, twist: f64) -> Ground {
    Ground {
        stance: Stance {
            stiffness,
            twist,
            ..ground.stance
        },
        ..*ground
    }
}

/// Predictions with changed parameters for all gaits that move.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// For each gait: its name, and the predictions of a cycle for each value of each parameter in [`CHANGES`].
    rows: Vec<(String, [Vec<Prediction>; CHANGES.len()])>,
    /// Stiffness of the robot's own feet, N/mm.
    foot_stiffness: f64,
}

impl Sensitivity {
    /// Predicts the gaits of a robot with each changed parameter.
    pub fn of(robot: &Robot) -> Self {
        let ground = robot.ground();
        let moving_gaits = robot.gaits().iter().filter(|gait| gait.has_movement());
        let rows = moving_gaits.map(|gait| {
            let cells = CHANGES.map(|(_, values, change)| {
                let predict = |value: &f64| gait.predict(&change(ground, *value));
                values.iter().map(predict).collect()
            });
            (gait.name().to_string(), cells)
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
            "One cycle with ideal servos: mm ahead, and deg counter-clockwise where it turns.\n",
        )?;
        let width = column_width(self.rows.iter().map(|(name, _)| name.as_str()));
        let mut is_every_prediction_decided = true;
        for (change_index, (title, values, _)) in CHANGES.iter().enumerate() {
            f.write_str("\n")?;
            match *title {
                "too long, mm" => {
                    let stiffness = self.foot_stiffness;
                    writeln!(
                        f,
                        "The front left foot too long, on feet of {stiffness} N/mm:"
                    )?;
                }
                "feet, N/mm" => writeln!(f, "Too long by {EXCESS_LENGTH_MM} mm, on other feet:")?,
                _ => {}
            }
            write!(f, "{title:<width$}")?;
            for value in *values {
                write!(f, "{value:>15}")?;
            }
            f.write_str("\n")?;
            for (name, cells) in &self.rows {
                let cells = &cells[change_index];
                is_every_prediction_decided &= cells
                    .iter()
                    .all(|movement| movement.forward.is_some() && movement.turn.is_some());
                let cells: String = cells.iter().map(format_cell).collect();
                writeln!(f, "{}", format!("{name:<width$}{cells}").trim_end())?;
            }
        }
        match is_every_prediction_decided {
            true => Ok(()),
            false => write!(f, "\n{UNDECIDED_NOTE}"),
        }
    }
}

/// Formats a prediction. A turn that rounds to zero is left out.
fn format_cell(movement: &Prediction) -> String {
    let turn = match movement.turn {
        Some(turn) if turn.abs() < 0.05 => String::new(),
        turn => format_component(turn, 1),
    };
    format!("{:>9}{turn:>6}", format_component(movement.forward, 1))
}
