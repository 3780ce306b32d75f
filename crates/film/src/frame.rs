//! The tags of a picture, and the place of the robot that they show.

use lizard_contact::Place;

use crate::camera::Camera;
use crate::picture::Pixel;
use crate::scene::{FloorCorners, Scene};
use crate::sheet::{CODES, DECK_TAG_ID};

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
    pub(crate) fn floor_corners(&self) -> Option<FloorCorners> {
        let [a, b, c, d, _] = self.tags;
        Some([a?, b?, c?, d?])
    }

    /// The camera of the picture: the scene's camera, or, if the camera moved, the one that is found from the
    /// picture's floor tags; `None` if these do not determine it.
    pub(crate) fn camera(&self, scene: &Scene, has_camera_moved: bool) -> Option<Camera> {
        match has_camera_moved {
            false => Some(scene.camera()),
            true => Some(scene.camera_at(&scene.find_pose(&self.floor_corners()?)?)),
        }
    }

    /// The robot's place; `None` if the needed tags are not visible or do not determine it.
    pub(crate) fn place(&self, scene: &Scene, has_camera_moved: bool) -> Option<Place> {
        let camera = self.camera(scene, has_camera_moved)?;
        scene.find_place(&camera, self.tags[DECK_TAG_ID].as_ref()?)
    }
}
