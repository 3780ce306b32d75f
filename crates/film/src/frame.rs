//! The tags of a picture, and the place of the robot that they show.

use lizard_contact::Place;

use crate::camera::Camera;
use crate::picture::Pixel;
use crate::scene::{FloorCorners, Scene};
use crate::sheet::{CODES, DECK_TAG};

/// The tags of a picture.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    /// Time of the picture, s.
    pub seconds: f64,
    /// The corners of each visible tag, by its id.
    pub tags: [Option<[Pixel; 4]>; CODES.len()],
}

impl Frame {
    /// The corners of the floor tags, if all are visible.
    pub(crate) fn floor(&self) -> Option<FloorCorners> {
        let [a, b, c, d, _] = self.tags;
        Some([a?, b?, c?, d?])
    }

    /// The camera of the picture: the scene's camera, or, if the camera moved, the one found by the picture's floor
    /// tags; `None` if these do not determine it.
    pub(crate) fn camera(&self, scene: &Scene, is_moved: bool) -> Option<Camera> {
        match is_moved {
            false => Some(scene.camera()),
            true => Some(scene.camera_at(&scene.pose(&self.floor()?)?)),
        }
    }

    /// The robot's place; `None` if the needed tags are not visible or do not determine it.
    pub(crate) fn place(&self, scene: &Scene, is_moved: bool) -> Option<Place> {
        let camera = self.camera(scene, is_moved)?;
        scene.place(&camera, self.tags[DECK_TAG].as_ref()?)
    }
}
