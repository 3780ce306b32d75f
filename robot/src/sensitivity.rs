//! What pads and mounting do to the gaits: where a cycle leads when the floor
//! or the print is not as robot.toml says.

use std::fmt;

use crate::feet::Feet;
use crate::ground::Ground;
use crate::report::{UNDECIDED, known, widest};
use crate::robot::Robot;
use crate::travel::Prediction;

/// Friction backward over forward: even pads, pads that grip when pushed back,
/// and pads that are on the wrong way round.
pub const RATIOS: [f64; 6] = [0.8, 1.0, 1.1, 1.25, 1.5, 2.0];
/// Outward sweep of the legs at neutral, deg; 41.4 is a leg in line with its
/// servo's horn.
pub const MOUNTS: [f64; 5] = [0.0, 20.0, 41.4, 49.0, -41.4];

/// Predictions for one gait.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitive {
    /// The gait's name.
    pub name: String,
    /// A cycle for each of [`RATIOS`], legs mounted as robot.toml says.
    pub ratios: [Prediction; RATIOS.len()],
    /// A cycle for each of [`MOUNTS`], pads as robot.toml says.
    pub mounts: [Prediction; MOUNTS.len()],
}

/// Predictions for all gaits that move.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// In the order of the file.
    pub rows: Vec<Sensitive>,
}

impl Sensitivity {
    /// Predicts the gaits of a robot on other floors and with other mountings.
    pub fn of(robot: &Robot) -> Self {
        let ground = *robot.ground();
        let rows = robot
            .gaits()
            .iter()
            .filter(|gait| gait.moves())
            .map(|gait| {
                let mounted = |mount: f64| Ground {
                    feet: Feet {
                        mount,
                        ..ground.feet
                    },
                    ..ground
                };
                Sensitive {
                    name: gait.name().to_string(),
                    ratios: RATIOS.map(|ratio| gait.predict(&Ground { ratio, ..ground })),
                    mounts: MOUNTS.map(|mount| gait.predict(&mounted(mount))),
                }
            });
        Self {
            rows: rows.collect(),
        }
    }
}

impl fmt::Display for Sensitivity {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("One cycle: mm ahead, and deg counter-clockwise where it turns.\n\n")?;
        let width = widest(self.rows.iter().map(|row| row.name.as_str()));
        write!(f, "{:<width$}", "friction")?;
        RATIOS
            .iter()
            .try_for_each(|ratio| write!(f, "{ratio:>15}"))?;
        f.write_str("\n")?;
        for row in &self.rows {
            line(f, width, &row.name, &row.ratios)?;
        }
        write!(f, "\n{:<width$}", "mount, deg")?;
        MOUNTS
            .iter()
            .try_for_each(|mount| write!(f, "{mount:>15}"))?;
        f.write_str("\n")?;
        for row in &self.rows {
            line(f, width, &row.name, &row.mounts)?;
        }
        let mut all = self
            .rows
            .iter()
            .flat_map(|row| row.ratios.iter().chain(&row.mounts));
        if all.any(|way| way.forward.is_none() || way.turn.is_none()) {
            write!(f, "\n{UNDECIDED}")?;
        }
        Ok(())
    }
}

fn line(f: &mut fmt::Formatter, width: usize, name: &str, ways: &[Prediction]) -> fmt::Result {
    let mut line = format!("{name:<width$}");
    for way in ways {
        let turn = match way.turn {
            Some(turn) if turn.abs() < 0.05 => String::new(),
            turn => known(turn, 1),
        };
        line += &format!("{:>9}{turn:>6}", known(way.forward, 1));
    }
    writeln!(f, "{}", line.trim_end())
}
