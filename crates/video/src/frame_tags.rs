//! The tags detected in a frame, and the robot's pose that follows from them.

use crate::camera::Camera;
use crate::frame::Pixel;
use crate::path::PathPoint;
use crate::scene::{FloorCorners, Scene};
use crate::sheet::{CODES, DECK_TAG_ID};

/// The corners of a frame's tags, indexed by the tags' ids.
pub(crate) type TagCorners = [Option<[Pixel; 4]>; CODES.len()];

/// The tags detected in a frame.
#[derive(Debug, Clone)]
pub(crate) struct FrameTags {
    /// Time of the frame, s.
    pub seconds: f64,
    /// The corners of the visible tags.
    pub corners: TagCorners,
}

impl FrameTags {
    /// Returns the corners of the floor tags; `None` unless all are visible.
    pub(crate) fn floor_corners(&self) -> Option<FloorCorners> {
        let [a, b, c, d, _] = self.corners;
        Some([a?, b?, c?, d?])
    }

    /// Returns the scene's camera, or finds it from the frame's floor tags if the camera moved; `None` if these do not
    /// determine it.
    pub(crate) fn find_camera(&self, scene: &Scene) -> Option<Camera> {
        match scene.has_camera_moved {
            false => Some(scene.camera()),
            true => Some(scene.camera_at(&scene.find_camera_pose(&self.floor_corners()?)?)),
        }
    }

    /// Finds the robot's pose at the time of the frame; `None` if the required tags are not visible or do not
    /// determine it.
    pub(crate) fn find_path_point(&self, scene: &Scene) -> Option<PathPoint> {
        let camera = self.find_camera(scene)?;
        let pose = scene.find_body_pose(&camera, self.corners[DECK_TAG_ID].as_ref()?)?;
        Some(PathPoint {
            seconds: self.seconds,
            pose,
        })
    }

    /// Finds the deck tag's height, mm, from its size; `None` if the visible tags do not determine it.
    pub(crate) fn find_deck_height(&self, scene: &Scene) -> Option<f64> {
        let camera = self.find_camera(scene)?;
        scene.find_deck_height(&camera, self.corners[DECK_TAG_ID].as_ref()?)
    }
}
