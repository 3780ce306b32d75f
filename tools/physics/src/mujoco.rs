//! Interface to MuJoCo through its Python package: the judge, `tools/physics/judge.py`, simulates the
//! walks in the files of a folder.

use std::collections::BTreeMap;
use std::io;
use std::process::{Child, Command, Stdio};

use lizard_parts::{Assembly, Course, Pieces, Scene, StrutSpring};
use serde::Deserialize;
use tempfile::TempDir;

use crate::case::{Case, Legs};
use crate::crate_folder;
use crate::figures::Displacement;

/// The reason why MuJoCo gives no answer.
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
    /// The judge printed something other than an answer.
    #[error("tools/physics/judge.py says {0}")]
    Words(String),
    /// MuJoCo warned during a walk.
    #[error("{file}: {trouble}")]
    Trouble {
        /// Robot, gait and case.
        file: String,
        /// The judge's message.
        trouble: String,
    },
    /// A part has no surface.
    #[error(transparent)]
    Unfit(#[from] lizard_parts::BuildProblem),
}

/// A line of the judge's answer.
#[derive(Deserialize)]
struct Line {
    file: String,
    way: Option<[f64; 3]>,
    trouble: Option<String>,
}

/// A folder of files with walks for the judge.
pub struct Jobs {
    folder: TempDir,
    count: usize,
}

/// A running judge.
pub struct RunningJudge {
    judge: Child,
    _folder: TempDir,
}

impl Jobs {
    /// Makes an empty list of walks.
    ///
    /// # Errors
    /// Fails if the folder for the files cannot be made.
    pub fn new() -> Result<Self, MujocoError> {
        Ok(Self {
            folder: tempfile::tempdir()?,
            count: 0,
        })
    }

    /// Returns the number of walks.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Adds a robot's walks, each with its legs and a scene under a name of its own.
    ///
    /// # Errors
    /// Fails if a file cannot be made or written.
    pub fn add(
        &mut self,
        assembly: &Assembly,
        walks: impl Iterator<Item = (Legs, Scene)>,
    ) -> Result<(), MujocoError> {
        let robot = assembly.robot();
        let neutral = robot.lizard().solve(&robot.neutral_pose());
        let neutral = neutral.expect("every robot closes at neutral");
        let mut known_pieces: Vec<(Legs, Pieces)> = Vec::new();
        for (legs, scene) in walks {
            if known_pieces
                .iter()
                .all(|(known_legs, _)| *known_legs != legs)
            {
                known_pieces.push((legs, Pieces::of(assembly, &scene)?));
            }
            for (_, pieces) in known_pieces
                .iter()
                .filter(|(known_legs, _)| *known_legs == legs)
            {
                let file = self.folder.path().join(format!("{}.xml", scene.name));
                std::fs::write(file, pieces.mjcf(&neutral, &scene))?;
                self.count += 1;
            }
        }
        Ok(())
    }

    /// Starts the judge.
    ///
    /// # Errors
    /// Fails if Python does not start.
    pub fn start(self) -> Result<RunningJudge, MujocoError> {
        let judge = Command::new(crate_folder().join("../../target/physics/bin/python"))
            .arg(crate_folder().join("judge.py"))
            .arg(self.folder.path())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(MujocoError::Start)?;
        Ok(RunningJudge {
            judge,
            _folder: self.folder,
        })
    }
}

/// Returns the scene of two cycles of a gait, of which the second is measured.
pub(crate) fn scene_of(name: &str, assembly: &Assembly, gait: &str, case: Case) -> Scene {
    let robot = assembly.robot();
    let gait = robot.gait(gait).expect("it is the robot's");
    let strut = robot.strut_with_coil(&robot.parts().spring);
    Scene {
        name: name.to_owned(),
        excess_lengths: [case.feet.excess_length(), 0.0, 0.0, 0.0],
        leaf_stiffness: case.feet.stiffness(robot),
        // Friction is equal in all directions, as in `Case::ground`; `grains.rs` is for other pads.
        friction_ratio: 1.0,
        strut_spring: (case.legs == Legs::Strut).then_some(StrutSpring {
            preload: strut.force,
            rate: strut.rate,
        }),
        course: Some(Course::of(robot, gait, 2, 1)),
        // Shapes are only for pictures; MuJoCo reads the file ten times as fast without them.
        has_shapes: false,
        ..Scene::of(assembly)
    }
}

impl RunningJudge {
    /// Waits for all walks and returns their displacements by name.
    ///
    /// # Errors
    /// Fails if the judge ended early, or MuJoCo warned of a walk.
    pub fn wait(self) -> Result<BTreeMap<String, Displacement>, MujocoError> {
        let output = self.judge.wait_with_output()?;
        if !output.status.success() {
            return Err(MujocoError::Ended(output.status));
        }
        let mut displacements = BTreeMap::new();
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            let answer: Line =
                serde_json::from_str(line).map_err(|_| MujocoError::Words(line.to_owned()))?;
            let Some(displacement) = answer.way else {
                return Err(MujocoError::Trouble {
                    file: answer.file,
                    trouble: answer.trouble.unwrap_or_default(),
                });
            };
            displacements.insert(answer.file, displacement.into());
        }
        Ok(displacements)
    }
}
