//! The robot as a model for physics engines and for ROS: MJCF, URDF and SDF.
//!
//! Every part of the assembly becomes part of a rigid body, with the mass and inertia of its own volume and its
//! placement in the assembly. Hinges and slides join the bodies as pins and sleeves do. MJCF and URDF require a tree,
//! so each closed loop is cut at one of its joints (`cut_joints.rs`); MJCF and SDF close the loop again. The files
//! contain no gait logic. MJCF, with which an independent engine makes the robot walk, also has motors and a floor.
//!
//! # Simplifications
//! - Only pads and floor have contact. A separate proof shows that no two parts collide ([`crate::Proof`]).
//! - A foot's post moves straight up and down on its leaf spring. Links do not bend.
//! - A servo is a motor with a rotor; the torque falls with the speed. The servo applies its full torque at the error
//!   stated in `[servo]`. It has no dead band.
//! - The friction of all pins that a servo moves acts at the servo's link.
//! - The pads' friction is equal in all directions, as in MuJoCo. The file has the pads' ratio of backward to forward
//!   friction, and `tools/physics/grain.py` applies this ratio.

mod cut_joints;
mod floor;
mod inertia;
mod joint;
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
pub use floor::{Block, Floor};
use pieces::Piece;
pub use scene::{Pads, Scene, StrutSpring, Trajectory};
use text::XmlWriter;
use writer::Writer;

/// The shapes and masses of a robot. Model files share them because they take far longer to compute than the rest.
pub struct Pieces<'a> {
    assembly: &'a Assembly,
    pieces: Vec<Piece>,
}

impl Pieces<'_> {
    /// Formats a scene as an MJCF file for MuJoCo, with the robot at `neutral`. The scene's kind of struts and its play
    /// must equal those of the scene given to [`Pieces::compute`].
    pub fn format_mjcf(&self, neutral: &Solution, scene: &Scene) -> String {
        self.writer(neutral, scene).write_mjcf()
    }

    /// Formats the robot of a scene as URDF, with the condition of [`Pieces::format_mjcf`]. The file refers to meshes
    /// ([`Pieces::make_meshes`]) in `folder`: a path or a URL that ends with a slash.
    pub fn format_urdf(&self, neutral: &Solution, scene: &Scene, folder: &str) -> String {
        self.writer(neutral, scene).write_urdf(folder)
    }

    /// Formats the robot of a scene as SDF, with `scene` and `folder` as in [`Pieces::format_urdf`].
    pub fn format_sdf(&self, neutral: &Solution, scene: &Scene, folder: &str) -> String {
        self.writer(neutral, scene).write_sdf(folder)
    }

    fn writer<'b>(&'b self, neutral: &'b Solution, scene: &'b Scene) -> Writer<'b> {
        Writer {
            assembly: self.assembly,
            neutral,
            scene,
            pieces: &self.pieces,
            xml: XmlWriter::default(),
        }
    }
}
