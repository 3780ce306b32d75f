//! Interface to MuJoCo through its Python package. The judge, the program `tools/physics/judge.py`, simulates the walks
//! in the files of a folder.

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
    UnknownAnswer(String),
    /// The judge could not simulate a walk, or MuJoCo warned during it.
    #[error("{file}: {problem}")]
    FailedWalk {
        /// Robot, gait and case.
        file: String,
        /// The judge's message.
        problem: String,
    },
    /// A part of the robot cannot be built.
    #[error(transparent)]
    Build(#[from] lizard_parts::BuildProblem),
}

/// The judge's answer for a walk: a line of its output.
#[derive(Deserialize)]
struct JudgeAnswer {
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
    /// Creates an empty list of walks.
    ///
    /// # Errors
    /// Fails if the folder for the files cannot be created.
    pub fn new() -> Result<Self, MujocoError> {
        Ok(Self {
            folder: tempfile::tempdir()?,
            count: 0,
        })
    }

    /// Returns the number of walks.
    pub fn walk_count(&self) -> usize {
        self.count
    }

    /// Adds a robot's walks, each with its legs and its scene. The names of all scenes must differ.
    ///
    /// # Errors
    /// Fails if a file cannot be generated or written.
    pub fn add(
        &mut self,
        assembly: &Assembly,
        walks: impl Iterator<Item = (Legs, Scene)>,
    ) -> Result<(), MujocoError> {
        let robot = assembly.robot();
        let neutral = robot.lizard().solve(&robot.neutral_pose());
        let neutral = neutral.expect("every loop closes in the neutral pose");
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
    let gait = robot.gait(gait).expect("the robot has this gait");
    let strut = robot.strut_with_coil(&robot.parts().spring);
    Scene {
        name: name.to_owned(),
        excess_lengths: [case.feet.excess_length_mm(), 0.0, 0.0, 0.0],
        leaf_stiffness: case.feet.stiffness(robot),
        // Friction is equal in all directions, as in `Case::ground`; `grains.rs` is for other pads.
        friction_ratio: 1.0,
        strut_spring: (case.legs == Legs::Strut).then_some(StrutSpring {
            preload: strut.force,
            rate: strut.rate,
        }),
        course: Some(Course::of(robot, gait, 2, 1)),
        // Only pictures need shapes; without them MuJoCo reads the file ten times as fast.
        has_shapes: false,
        ..Scene::of(assembly)
    }
}

impl RunningJudge {
    /// Waits for all walks and returns their displacements by name.
    ///
    /// # Errors
    /// Fails if the judge ended early or could not simulate a walk, or if MuJoCo warned during a walk.
    pub fn wait(self) -> Result<BTreeMap<String, Displacement>, MujocoError> {
        let output = self.judge.wait_with_output()?;
        if !output.status.success() {
            return Err(MujocoError::Ended(output.status));
        }
        let mut displacements = BTreeMap::new();
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            let answer: JudgeAnswer = serde_json::from_str(line)
                .map_err(|_| MujocoError::UnknownAnswer(line.to_owned()))?;
            let Some(displacement) = answer.way else {
                return Err(MujocoError::FailedWalk {
                    file: answer.file,
                    problem: answer.trouble.unwrap_or_default(),
                });
            };
            displacements.insert(answer.file, displacement.into());
        }
        Ok(displacements)
    }
}
