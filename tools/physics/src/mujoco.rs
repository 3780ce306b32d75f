//! Interface to MuJoCo's Python package. The judge, `tools/physics/judge.py`, simulates the walks in a folder's files.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::io;
use std::process::{Command, Stdio};

use lizard_parts::{Assembly, Pieces, Scene, StrutSpring, Trajectory};
use serde::Deserialize;
use tempfile::TempDir;

use crate::case::{Case, LegDrive};
use crate::crate_dir;
use crate::results::Displacement;

/// A reason why there is no result from MuJoCo.
#[derive(Debug, thiserror::Error)]
pub enum MujocoError {
    /// Python does not start.
    #[error("cannot start target/physics/bin/python: {0}; `make physics` installs it")]
    PythonStart(io::Error),
    /// A file cannot be written, or the result cannot be read.
    #[error("cannot exchange files with MuJoCo: {0}")]
    Files(#[from] io::Error),
    /// The judge failed.
    #[error("tools/physics/judge.py failed with {0}")]
    JudgeExit(std::process::ExitStatus),
    /// The judge printed something other than a result.
    #[error("unexpected output of tools/physics/judge.py: {0}")]
    InvalidOutput(String),
    /// The judge could not simulate a walk, or MuJoCo warned during it.
    #[error("{name}: {message}")]
    FailedWalk {
        /// The walk's name.
        name: String,
        /// The judge's message.
        message: String,
    },
    /// A part of the robot cannot be built.
    #[error(transparent)]
    Build(#[from] lizard_parts::BuildError),
}

/// The judge's result for a walk, a line of its output.
#[derive(Deserialize)]
struct JudgeResult {
    file: String,
    displacement: Option<[f64; 3]>,
    error: Option<String>,
}

/// Walks for the judge, as files in a folder.
pub struct WalkBatch {
    folder: TempDir,
    walk_count: usize,
}

impl WalkBatch {
    /// Creates an empty batch.
    ///
    /// # Errors
    /// Fails if the folder for the files cannot be created.
    pub fn new() -> Result<Self, MujocoError> {
        Ok(Self {
            folder: tempfile::tempdir()?,
            walk_count: 0,
        })
    }

    /// Returns the number of walks.
    pub fn walk_count(&self) -> usize {
        self.walk_count
    }

    /// Adds a robot's walks, each as its scene. The names of all scenes must differ.
    ///
    /// # Errors
    /// Fails if a file cannot be generated or written.
    pub fn add(
        &mut self,
        assembly: &Assembly,
        scenes: impl IntoIterator<Item = Scene>,
    ) -> Result<(), MujocoError> {
        let robot = assembly.robot();
        let neutral = robot.lizard().solve(&robot.neutral_pose());
        let neutral = neutral.expect("every loop closes in the neutral pose");
        // The pieces of the robot with rigid struts, and with slotted struts.
        let mut known_pieces: BTreeMap<bool, Pieces> = BTreeMap::new();
        for scene in scenes {
            let pieces = match known_pieces.entry(scene.strut_spring.is_some()) {
                Entry::Vacant(entry) => entry.insert(Pieces::compute(assembly, &scene)?),
                Entry::Occupied(entry) => entry.into_mut(),
            };
            let file = self.folder.path().join(format!("{}.xml", scene.name));
            std::fs::write(file, pieces.format_mjcf(&neutral, &scene))?;
            self.walk_count += 1;
        }
        Ok(())
    }

    /// Simulates all walks with the judge and returns their displacements by name.
    ///
    /// # Errors
    /// Fails if Python does not start, if the judge failed or could not simulate a walk, or if MuJoCo warned during a
    /// walk.
    pub fn simulate(self) -> Result<BTreeMap<String, Displacement>, MujocoError> {
        let judge = Command::new(crate_dir().join("../../target/physics/bin/python"))
            .arg(crate_dir().join("judge.py"))
            .arg(self.folder.path())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(MujocoError::PythonStart)?;
        let output = judge.wait_with_output()?;
        let mut displacements = BTreeMap::new();
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            let result: JudgeResult = serde_json::from_str(line)
                .map_err(|_| MujocoError::InvalidOutput(line.to_owned()))?;
            let Some(displacement) = result.displacement else {
                return Err(MujocoError::FailedWalk {
                    name: result.file,
                    message: result.error.unwrap_or_default(),
                });
            };
            displacements.insert(result.file, displacement.into());
        }
        // After the lines, since one of them may have the reason.
        match output.status.success() {
            true => Ok(displacements),
            false => Err(MujocoError::JudgeExit(output.status)),
        }
    }
}

/// Returns the scene of a gait's walk over two cycles, of which the second is measured.
pub(crate) fn make_two_cycle_scene(
    name: &str,
    assembly: &Assembly,
    gait: &str,
    case: Case,
) -> Scene {
    let robot = assembly.robot();
    let gait = robot.gait(gait).expect("the robot has this gait");
    let strut = robot.own_strut();
    Scene {
        name: name.to_owned(),
        excess_lengths: [case.feet.excess_length_mm(), 0.0, 0.0, 0.0],
        leaf_stiffness: case.feet.leaf_stiffness(robot),
        // Friction is equal in all directions, as in `Case::ground`; `grains.rs` covers other pads.
        friction_ratio: 1.0,
        strut_spring: (case.legs == LegDrive::Strut).then_some(StrutSpring {
            preload: strut.preload,
            rate: strut.spring_rate,
        }),
        trajectory: Some(Trajectory::for_gait(robot, gait, 2, 1)),
        // Only pictures need shapes; without shapes, MuJoCo reads the file ten times faster.
        has_shapes: false,
        ..Scene::for_assembly(assembly)
    }
}
