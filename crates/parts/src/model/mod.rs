//! The robot as a model for physics engines and for ROS: MJCF, URDF and SDF.
//!
//! Every part of the assembly becomes part of a rigid body, with the mass and the inertia
//! of its own volume, at its place in the assembly. Hinges and slides join the bodies as
//! pins and sleeves do. MJCF and URDF want a tree, so each closed loop is cut at one of its
//! joints (`closed.rs`), which MJCF and SDF close again. The files know nothing of walking. MJCF,
//! by which an independent engine lets the robot walk, has motors and a floor, too.
//!
//! # Simplifications
//! - Only pads and floor touch each other. A separate proof shows that no two parts meet
//!   ([`crate::Proof`]).
//! - A foot's leaf lets its post move straight up and down on a spring. Links do not bend.
//! - A servo is a motor whose torque falls with its speed, with a rotor, and with a gain that
//!   applies the full torque at a few degrees of error, as `[servo]` has them. It has no dead band.
//! - The friction of all pins that a servo turns acts at its link.
//! - The friction of the pads is equal in all directions, as MuJoCo has it. Its file says by how much
//!   that of the robot's pads is larger backward, and `tools/physics/grain.py` sees to it.

mod closed;
mod floor;
mod inertia;
mod joint;
mod looks;
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
use crate::files::File;
use crate::unfit::Unfit;
pub use floor::{Block, Floor};
use node::Node;
use pieces::{Piece, pieces};
pub use scene::{Course, Pads, Pull, Scene};
use text::Xml;
use writer::Writer;

/// The file of a scene for MuJoCo.
///
/// # Errors
/// Returns [`Unfit::Surface`] for a part whose layers do not make a body.
pub fn mjcf(assembly: &Assembly, neutral: &Solution, scene: &Scene) -> Result<String, Unfit> {
    Ok(Pieces::of(assembly, scene)?.mjcf(neutral, scene))
}

/// The shapes and masses of a robot, shared by several files because they take far longer
/// to make than the rest.
pub struct Pieces<'a> {
    assembly: &'a Assembly,
    pieces: Vec<Piece>,
}

impl<'a> Pieces<'a> {
    /// Makes the shapes and masses for a scene.
    ///
    /// # Errors
    /// Fails as [`mjcf`] does.
    pub fn of(assembly: &'a Assembly, scene: &Scene) -> Result<Self, Unfit> {
        let pieces = pieces(assembly, scene)?;
        Ok(Self { assembly, pieces })
    }

    /// The file for MuJoCo of a scene whose struts and play equal those of the scene that was given
    /// to [`Pieces::of`].
    #[must_use]
    pub fn mjcf(&self, neutral: &Solution, scene: &Scene) -> String {
        self.write_with(neutral, scene, |writer| writer.write_mjcf())
    }

    /// The robot of such a scene as URDF, whose meshes ([`Pieces::meshes`]) lie in `folder`: a path
    /// or an address with a slash at its end.
    #[must_use]
    pub fn urdf(&self, neutral: &Solution, scene: &Scene, folder: &str) -> String {
        self.write_with(neutral, scene, |writer| writer.write_urdf(folder))
    }

    /// The robot of such a scene as SDF, with meshes as in [`Pieces::urdf`].
    #[must_use]
    pub fn sdf(&self, neutral: &Solution, scene: &Scene, folder: &str) -> String {
        self.write_with(neutral, scene, |writer| writer.write_sdf(folder))
    }

    /// The meshes that URDF and SDF name, by the names that they have in their folder.
    #[must_use]
    pub fn meshes(&self, scene: &Scene) -> Vec<File> {
        let nodes = Node::all(scene.pull.is_some(), scene.play > 0.0);
        meshes::files(&self.pieces, &nodes)
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
