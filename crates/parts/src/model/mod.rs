//! The robot as a model for physics engines and for ROS: MJCF, URDF and SDF.
//!
//! Every part of the assembly becomes part of a rigid body, with the mass and the inertia of its own volume, at its
//! place in the assembly. Hinges and slides join the bodies as pins and sleeves do. MJCF and URDF require a tree,
//! so each closed loop is cut at one of its joints (`loops.rs`); MJCF and SDF close it again. The files contain no
//! gait logic. MJCF, with which an independent engine lets the robot walk, also has motors and a floor.
//!
//! # Simplifications
//! - Only pads and floor touch each other. A separate proof shows that no two parts collide ([`crate::Proof`]).
//! - A foot's leaf spring lets its post move straight up and down. Links do not bend.
//! - A servo is a motor with a rotor, whose torque falls with its speed. Its gain applies the full torque at a few
//!   degrees of error, as `[servo]` states. It has no dead band.
//! - The friction of all pins that a servo moves acts at the servo's link.
//! - The pads' friction is equal in all directions, as in MuJoCo. The file states the ratio of backward to forward
//!   friction of the robot's pads, and `tools/physics/grain.py` applies it.

mod floor;
mod inertia;
mod joint;
mod loops;
mod material;
mod meshes;
mod mjcf;
mod node;
mod pieces;
mod scene;
mod sdf;
mod text;
mod urdf;
mod writer;

use lizard_kinematics::Solution;

use crate::bodies::assembly::Assembly;
use crate::build_problem::BuildProblem;
use crate::files::File;
pub use floor::{Block, Floor};
use node::Node;
use pieces::{Piece, compute_pieces};
pub use scene::{Course, Pads, Scene, StrutSpring};
use text::Xml;
use writer::Writer;

/// Returns a scene as an MJCF file for MuJoCo.
///
/// # Errors
/// Returns [`BuildProblem::OpenSurface`] for a part whose layers do not form a closed surface.
pub fn mjcf(
    assembly: &Assembly,
    neutral: &Solution,
    scene: &Scene,
) -> Result<String, BuildProblem> {
    Ok(Pieces::of(assembly, scene)?.mjcf(neutral, scene))
}

/// The shapes and masses of a robot. Several model files share them, because they take far longer to compute than
/// the rest of a file.
pub struct Pieces<'a> {
    assembly: &'a Assembly,
    pieces: Vec<Piece>,
}

impl<'a> Pieces<'a> {
    /// Computes the shapes and masses for a scene.
    ///
    /// # Errors
    /// Returns [`BuildProblem::OpenSurface`] for a part whose layers do not form a closed surface.
    pub fn of(assembly: &'a Assembly, scene: &Scene) -> Result<Self, BuildProblem> {
        let pieces = compute_pieces(assembly, scene)?;
        Ok(Self { assembly, pieces })
    }

    /// Returns a scene as an MJCF file for MuJoCo. Its struts and play must equal those of the scene given to
    /// [`Pieces::of`].
    #[must_use]
    pub fn mjcf(&self, neutral: &Solution, scene: &Scene) -> String {
        self.write_with(neutral, scene, |writer| writer.write_mjcf())
    }

    /// Returns the robot of a scene as URDF; the scene must fit as in [`Pieces::mjcf`]. The file refers to meshes
    /// ([`Pieces::meshes`]) in `folder`: a path or a URL that ends with a slash.
    #[must_use]
    pub fn urdf(&self, neutral: &Solution, scene: &Scene, folder: &str) -> String {
        self.write_with(neutral, scene, |writer| writer.write_urdf(folder))
    }

    /// Returns the robot of a scene as SDF; the scene must fit as in [`Pieces::mjcf`], and `folder` is that of
    /// [`Pieces::urdf`].
    #[must_use]
    pub fn sdf(&self, neutral: &Solution, scene: &Scene, folder: &str) -> String {
        self.write_with(neutral, scene, |writer| writer.write_sdf(folder))
    }

    /// The meshes to which URDF and SDF refer, each with its file name in the mesh folder.
    #[must_use]
    pub fn meshes(&self, scene: &Scene) -> Vec<File> {
        let nodes = Node::all(scene.strut_spring.is_some(), scene.play > 0.0);
        meshes::mesh_files(&self.pieces, &nodes)
    }

    fn write_with(
        &self,
        neutral: &Solution,
        scene: &Scene,
        write: impl FnOnce(&mut Writer<'_>),
    ) -> String {
        let mut writer = Writer {
            assembly: self.assembly,
            neutral,
            scene,
            pieces: &self.pieces,
            xml: Xml::default(),
        };
        write(&mut writer);
        writer.xml.finish()
    }
}
