//! MuJoCo, used through its Python package: `tools/physics/judge.py` walks the files of a
//! folder.

use std::collections::BTreeMap;
use std::io;
use std::process::{Child, Command, Stdio};

use lizard_parts::{Assembly, Course, Motor, Pieces, Pull, STALL, Scene};
use lizard_robot::Robot;
use lizard_twin::ServoModel;
use serde::Deserialize;
use tempfile::TempDir;

use crate::case::Legs;
use crate::figures::Displacement;
use crate::here;
use crate::row::Row;

/// The reason for which MuJoCo gives no answer.
#[derive(Debug, thiserror::Error)]
pub enum MujocoError {
    /// Python does not start.
    #[error("target/physics/bin/python does not start: {0}; `make physics` sets it up")]
    Start(io::Error),
    /// A file cannot be written, or the answer cannot be read.
    #[error("MuJoCo's files: {0}")]
    Files(#[from] io::Error),
    /// The judge ended early.
    #[error("tools/physics/judge.py ended with {0}")]
    Ended(std::process::ExitStatus),
    /// The judge printed something else than an answer.
    #[error("tools/physics/judge.py says {0}")]
    Words(String),
    /// MuJoCo warned of a walk.
    #[error("{file}: {trouble}")]
    Trouble {
        /// Robot, gait and case.
        file: String,
        /// The judge's sentence.
        trouble: String,
    },
    /// A part without a surface.
    #[error(transparent)]
    Unfit(#[from] lizard_parts::Unfit),
}

/// A line of the judge's answer.
#[derive(Deserialize)]
struct Line {
    file: String,
    way: Option<[f64; 3]>,
    trouble: Option<String>,
}

/// Files with walks for the judge.
pub struct Jobs {
    folder: TempDir,
    count: usize,
}

/// A running judge.
pub struct Walking {
    judge: Child,
    _folder: TempDir,
}

impl Jobs {
    /// Starts without a walk.
    ///
    /// # Errors
    /// The folder for the files cannot be made.
    pub fn new() -> Result<Self, MujocoError> {
        Ok(Self {
            folder: tempfile::tempdir()?,
            count: 0,
        })
    }

    /// The number of walks.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Adds the second cycle of each of a robot's gaits, each under a name.
    ///
    /// # Errors
    /// A file cannot be made or written.
    pub fn add<'a>(
        &mut self,
        robot: &Robot,
        rows: impl Iterator<Item = (String, &'a Row)>,
    ) -> Result<(), MujocoError> {
        let assembly = Assembly::new(robot);
        let neutral = robot.lizard().solve(&robot.neutral());
        let neutral = neutral.expect("every robot closes at neutral");
        let mut known: Vec<(Legs, Pieces)> = Vec::new();
        for (name, row) in rows {
            let scene = scene(&name, &assembly, row);
            let legs = row.case.legs;
            if known.iter().all(|(of, _)| *of != legs) {
                known.push((legs, Pieces::of(&assembly, &scene)?));
            }
            for (_, pieces) in known.iter().filter(|(of, _)| *of == legs) {
                let file = self.folder.path().join(format!("{name}.xml"));
                std::fs::write(file, pieces.mjcf(&neutral, &scene))?;
                self.count += 1;
            }
        }
        Ok(())
    }

    /// Starts the judge.
    ///
    /// # Errors
    /// Python does not start.
    pub fn start(self) -> Result<Walking, MujocoError> {
        let judge = Command::new(here().join("../../target/physics/bin/python"))
            .arg(here().join("judge.py"))
            .arg(self.folder.path())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(MujocoError::Start)?;
        Ok(Walking {
            judge,
            _folder: self.folder,
        })
    }
}

fn scene(name: &str, assembly: &Assembly, row: &Row) -> Scene {
    let (robot, case) = (assembly.robot(), row.case);
    let motor = Motor {
        rate: ServoModel::SG90.rate,
        stall: STALL,
    };
    let gait = robot.gait(&row.gait).expect("it is the robot's");
    let strut = robot.strut_of(&robot.parts().spring);
    Scene {
        name: name.to_owned(),
        long: [case.feet.long(), 0.0, 0.0, 0.0],
        stiffness: case.feet.stiffness(robot),
        pull: (case.legs == Legs::Strut).then_some(Pull {
            force: strut.force,
            rate: strut.rate,
        }),
        course: Some(Course::of(robot, gait, 2)),
        // They are only for pictures, and MuJoCo reads the file ten times as fast without them.
        shapes: false,
        ..Scene::of(assembly, motor)
    }
}

impl Walking {
    /// Waits for all walks; returns their displacements by name.
    ///
    /// # Errors
    /// The judge ended early, or MuJoCo warned of a walk.
    pub fn done(self) -> Result<BTreeMap<String, Displacement>, MujocoError> {
        let output = self.judge.wait_with_output()?;
        if !output.status.success() {
            return Err(MujocoError::Ended(output.status));
        }
        let mut ways = BTreeMap::new();
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            let answer: Line =
                serde_json::from_str(line).map_err(|_| MujocoError::Words(line.to_owned()))?;
            let Some(way) = answer.way else {
                return Err(MujocoError::Trouble {
                    file: answer.file,
                    trouble: answer.trouble.unwrap_or_default(),
                });
            };
            ways.insert(answer.file, way.into());
        }
        Ok(ways)
    }
}
