//! The tags detected in a frame, and the robot's place that follows from them.

use lizard_contact::Place;

use crate::camera::Camera;
use crate::frame::Pixel;
use crate::scene::{FloorCorners, Scene};
use crate::sheet::{CODES, DECK_TAG_ID};

/// The tags detected in a frame.
#[derive(Debug, Clone)]
pub(crate) struct FrameTags {
    /// Time of the frame, s.
    pub seconds: f64,
    /// The corners of each visible tag, indexed by the tag's id.
    pub tags: [Option<[Pixel; 4]>; CODES.len()],
}

impl FrameTags {
    /// The corners of the floor tags, if all are visible.
    pub(crate) fn floor_corners(&self) -> Option<FloorCorners> {
        let [a, b, c, d, _] = self.tags;
        Some([a?, b?, c?, d?])
    }

    /// Returns the scene's camera, or finds it from the frame's floor tags if `has_camera_moved`; `None` if these do
    /// not determine it.
    pub(crate) fn find_camera(&self, scene: &Scene, has_camera_moved: bool) -> Option<Camera> {
        match has_camera_moved {
            false => Some(scene.camera()),
            true => Some(scene.camera_at(&scene.find_pose(&self.floor_corners()?)?)),
        }
    }

    /// Finds the robot's place; `None` if the required tags are not visible or do not determine it.
    pub(crate) fn find_place(&self, scene: &Scene, has_camera_moved: bool) -> Option<Place> {
        let camera = self.find_camera(scene, has_camera_moved)?;
        scene.find_place(&camera, self.tags[DECK_TAG_ID].as_ref()?)
    }
}
