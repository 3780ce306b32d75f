//! The effect of pads, mounting, feet and play on the gaits, if the floor or the print differs
//! from robot.toml.

use std::fmt;

use lizard_contact::{Drive, Feet, Ground, Prediction, Stance};

use crate::reports::report::{UNDECIDED, known, widest};
use crate::robot::Robot;

/// Friction backward over forward: even pads, pads that grip when pushed back,
/// and pads that are mounted in reverse.
pub const RATIOS: [f64; 6] = [0.8, 1.0, 1.1, 1.25, 1.5, 2.0];
/// Outward sweep of the legs at neutral, deg; 41.4 is a leg in line with its
/// servo's horn.
pub const MOUNTS: [f64; 5] = [0.0, 20.0, 41.4, 49.0, -41.4];

/// Excess lengths of the front left foot, mm, on the feet of robot.toml.
pub const TWISTS: [f64; 4] = [0.5, 1.0, 1.5, 2.0];
/// Stiffness of other feet, N/mm, the front left one too long by [`LONG`]; the last are leaves of
/// 2 mm.
pub const LEAVES: [f64; 3] = [1.0, 2.0, 3.3];
/// Excess length of the front left foot on each of [`LEAVES`], mm.
pub const LONG: f64 = 0.6;
/// Play of the legs to either side, deg.
pub const PLAYS: [f64; 2] = [1.0, 2.0];

/// Predictions for one gait.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitive {
    /// Name of the gait.
    pub name: String,
    /// A cycle for each of [`RATIOS`], with the mounting of robot.toml.
    pub ratios: [Prediction; RATIOS.len()],
    /// A cycle for each of [`MOUNTS`], with the pads of robot.toml.
    pub mounts: [Prediction; MOUNTS.len()],
    /// A cycle for each of [`TWISTS`].
    pub twists: [Prediction; TWISTS.len()],
    /// A cycle for each of [`LEAVES`].
    pub leaves: [Prediction; LEAVES.len()],
    /// A cycle for each of [`PLAYS`].
    pub plays: [Prediction; PLAYS.len()],
}

/// Predictions for all gaits that move.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// Rows of the tables, in the order of the file.
    pub rows: Vec<Sensitive>,
    /// Stiffness of the robot's own feet, N/mm.
    pub leaf: f64,
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
                let standing = |stiffness: f64, twist: f64| Ground {
                    stance: Stance {
                        stiffness,
                        twist,
                        ..ground.stance
                    },
                    ..ground
                };
                let own = ground.stance.stiffness;
                let playing = |play: f64| Ground {
                    drive: Drive {
                        play,
                        ..ground.drive
                    },
                    ..ground
                };
                Sensitive {
                    name: gait.name().to_string(),
                    ratios: RATIOS.map(|ratio| gait.predict(&Ground { ratio, ..ground })),
                    mounts: MOUNTS.map(|mount| gait.predict(&mounted(mount))),
                    twists: TWISTS.map(|twist| gait.predict(&standing(own, twist))),
                    leaves: LEAVES.map(|leaf| gait.predict(&standing(leaf, LONG))),
                    plays: PLAYS.map(|play| gait.predict(&playing(play))),
                }
            });
        Self {
            rows: rows.collect(),
            leaf: ground.stance.stiffness,
        }
    }
}

impl fmt::Display for Sensitivity {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("One cycle: mm ahead, and deg counter-clockwise where it turns.\n\n")?;
        let width = widest(self.rows.iter().map(|row| row.name.as_str()));
        self.table(f, width, "friction", &RATIOS, |row| &row.ratios)?;
        f.write_str("\n")?;
        self.table(f, width, "mount, deg", &MOUNTS, |row| &row.mounts)?;
        writeln!(
            f,
            "\nThe front left foot too long, on feet of {} N/mm:",
            self.leaf
        )?;
        self.table(f, width, "too long, mm", &TWISTS, |row| &row.twists)?;
        writeln!(f, "\nToo long by {LONG} mm, on other feet:")?;
        self.table(f, width, "feet, N/mm", &LEAVES, |row| &row.leaves)?;
        f.write_str("\n")?;
        self.table(f, width, "play, +-deg", &PLAYS, |row| &row.plays)?;
        let mut all = self
            .rows
            .iter()
            .flat_map(|row| {
                [
                    &row.ratios[..],
                    &row.mounts,
                    &row.twists,
                    &row.leaves,
                    &row.plays,
                ]
            })
            .flatten();
        if all.any(|way| way.forward.is_none() || way.turn.is_none()) {
            write!(f, "\n{UNDECIDED}")?;
        }
        Ok(())
    }
}

impl Sensitivity {
    /// Writes a row of values, and for each gait a row of its movements with them.
    fn table(
        &self,
        f: &mut fmt::Formatter,
        width: usize,
        head: &str,
        values: &[f64],
        ways: impl Fn(&Sensitive) -> &[Prediction],
    ) -> fmt::Result {
        write!(f, "{head:<width$}")?;
        values
            .iter()
            .try_for_each(|value| write!(f, "{value:>15}"))?;
        f.write_str("\n")?;
        let mut rows = self.rows.iter();
        rows.try_for_each(|row| line(f, width, &row.name, ways(row)))
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
