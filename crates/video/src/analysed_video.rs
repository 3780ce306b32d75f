//! An analysed video: its camera and the robot's path are known, so gaits can be measured.

use lizard_contact::Travel;

use crate::cycles::{self, Cycles};
use crate::frame_tags::FrameTags;
use crate::gait::Gait;
use crate::gait_match::{self, GaitMatch};
use crate::least_squares::propagate_variance;
use crate::measured_gait::MeasuredGait;
use crate::path::{self, PathPoint, unwrap_headings};
use crate::scene::{POSE_PARAMETER_COUNT, SHARED_PARAMETER_COUNT, Scene};
use crate::video_error::VideoError;
use crate::walk::{Walk, mean_components};
use crate::{cycle_path, walks};

/// Standard deviation of the user's measurement of the deck tag's height, mm.
const HEIGHT_SIGMA: f64 = 1.0;
/// Standard deviation of the user's measurement of the ruler, as a fraction of its length.
const RULER_SIGMA: f64 = 0.001;

/// The camera of an analysed video, estimated from the tags.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraEstimate {
    /// Focal length, px.
    pub focal_length: f64,
    /// Height above the floor in the first frame, mm.
    pub height: f64,
    /// Tilt from straight down in the first frame, deg.
    pub tilt: f64,
    /// Root-mean-square error of a floor tag's corner, px.
    pub corner_error: f64,
    /// True if the camera moved during the video.
    pub has_camera_moved: bool,
    /// Height of the deck tag above the floor, computed from its size in the frames, mm.
    pub deck_height: f64,
}

/// A video whose camera and path are known.
#[derive(Debug, Clone)]
pub struct AnalysedVideo {
    /// The robot's path.
    pub path: Vec<PathPoint>,
    /// The camera that took the video.
    pub camera: CameraEstimate,
    pub(crate) scene: Scene,
    /// The tags of each frame of the path.
    pub(crate) frames: Vec<FrameTags>,
}

impl AnalysedVideo {
    /// Measures a gait between two times, s, or in the entire video.
    ///
    /// # Errors
    /// Fails if the path in that time differs from the gait's predicted path, or is too short.
    pub fn measure(
        &self,
        gait: &Gait,
        interval: Option<[f64; 2]>,
    ) -> Result<MeasuredGait, VideoError> {
        let path = interval.map_or(&self.path[..], |interval| {
            path::between(&self.path, interval)
        });
        let cycles = cycles::find_cycles(path, gait)?;
        // A deck tag that is higher than given seems to move farther.
        let camera_to_deck = self.camera.height - self.scene.dimensions.deck_height;
        let scale_error = (HEIGHT_SIGMA / camera_to_deck).hypot(RULER_SIGMA);
        let deviations = cycle_path::compute_deviations(path, &cycles, gait);
        let walk = Walk {
            scene_variances: self.compute_scene_variances(&cycles),
            cycles,
            scale_error,
            deviations,
        };
        Ok(MeasuredGait::from_walks(vec![walk], gait))
    }

    /// Finds the walks. Returns the start and the end of each walk, s, extended at both ends by half of
    /// `min_rest_duration`. The robot rests if it stands still for at least `min_rest_duration` seconds;
    /// [`min_rest_duration`](crate::min_rest_duration) returns the smallest suitable value for given gaits.
    pub fn find_walks(&self, min_rest_duration: f64) -> Vec<[f64; 2]> {
        walks::find_walks(&self.path, min_rest_duration)
    }

    /// Finds the gait that the robot's path shows between two times, s.
    pub fn match_gait(&self, gaits: &[Gait], interval: [f64; 2]) -> GaitMatch {
        gait_match::match_gait(path::between(&self.path, interval), gaits)
    }

    /// Computes the variances of the mean cycle that result from the scene's covariance: forward and left, mm^2, and
    /// turn, deg^2.
    fn compute_scene_variances(&self, cycles: &Cycles) -> [f64; 3] {
        // A moving camera has its own pose in each frame, so only the shared parameters count.
        let parameter_count = match self.camera.has_camera_moved {
            true => SHARED_PARAMETER_COUNT,
            false => SHARED_PARAMETER_COUNT + POSE_PARAMETER_COUNT,
        };
        let scene = &self.scene;
        let find_nearest_frame = |time: &f64| {
            let distance = |frame: &FrameTags| (frame.seconds - time).abs();
            let frames = self.frames.iter();
            frames.min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let boundaries = cycles.boundaries.iter();
        let frames: Vec<&FrameTags> = boundaries.filter_map(find_nearest_frame).collect();
        let mean_movement = |scene: &Scene| -> [f64; 3] {
            let to_point = |frame: &&FrameTags| frame.find_path_point(scene);
            let mut points: Vec<PathPoint> = frames.iter().filter_map(to_point).collect();
            unwrap_headings(&mut points);
            let travel = |pair: &[PathPoint]| pair[1].pose.travel_from(pair[0].pose);
            let travels: Vec<Travel> = points.windows(2).map(travel).collect();
            mean_components(&travels)
        };
        let base_movement = mean_movement(scene);
        let jacobian: Vec<[f64; 3]> = (0..parameter_count)
            .map(|i| {
                let step = scene.covariance[(i, i)].sqrt().max(1e-12);
                let changed_movement = mean_movement(&scene.with_parameter_changed(i, step));
                [0, 1, 2].map(|axis| (changed_movement[axis] - base_movement[axis]) / step)
            })
            .collect();
        [0, 1, 2].map(|axis| {
            let gradient: Vec<f64> = jacobian.iter().map(|slopes| slopes[axis]).collect();
            propagate_variance(&gradient, &scene.covariance)
        })
    }
}
