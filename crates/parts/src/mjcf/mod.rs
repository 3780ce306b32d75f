//! The robot as a model for MuJoCo, so that an independent physics engine can let it walk.
//!
//! Every part of the assembly becomes part of a rigid body, with the mass and the inertia
//! of its own volume, at its place in the assembly. Hinges and slides join the bodies as
//! pins and sleeves do; a constraint closes each loop. The file knows nothing of walking:
//! it has servos, pads and a floor.
//!
//! # Simplifications
//! - Only pads and floor touch each other. A separate proof shows that no two parts meet
//!   ([`crate::Proof`]).
//! - A foot's leaf lets its post move straight up and down on a spring. Links do not bend.
//! - A servo is a motor whose torque falls with its speed, with a rotor, and with a gain that
//!   applies the full torque at a few degrees of error, as `[servo]` has them. It has no dead band.
//! - The friction of all pins that a servo turns acts at its link.
//! - The friction of the pads is equal in all directions, as MuJoCo has it. The file says by how much
//!   that of the robot's pads is larger backward, and `tools/physics/grain.py` sees to it.

mod closed;
mod drives;
mod floor;
mod footing;
mod inertia;
mod node;
mod pieces;
mod scene;
mod text;
mod tree;
mod writer;

use lizard_kinematics::Solution;

use crate::bodies::assembly::Assembly;
use crate::unfit::Unfit;
pub use floor::{Block, Floor};
use pieces::{Piece, pieces};
pub use scene::{Course, Pull, Scene};
use text::Xml;
use writer::Writer;

/// The file of a scene.
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

    /// The file of a scene whose struts and play equal those of the scene that was given
    /// to [`Pieces::of`].
    #[must_use]
    pub fn mjcf(&self, neutral: &Solution, scene: &Scene) -> String {
        let mut writer = Writer {
            assembly: self.assembly,
            neutral,
            scene,
            pieces: &self.pieces,
            xml: Xml::default(),
        };
        writer.document();
        writer.xml.finish()
    }
}
