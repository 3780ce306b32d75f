//! An analysed film: its camera and the robot's path are known, so that gaits can be measured.

use lizard_contact::Travel;

use crate::camera::Camera;
use crate::cycles::{self, Cycles};
use crate::frame::Frame;
use crate::gait::Gait;
use crate::gait_match::{self, GaitMatch};
use crate::measured_gait::MeasuredGait;
use crate::path::{PathPoint, unwrap_headings};
use crate::scene::{POSE_PARAMETER_COUNT, SHARED_PARAMETER_COUNT, Scene};
use crate::trouble::Trouble;
use crate::walk::{Walk, travel_components};
use crate::{cycle_path, walks};

/// Standard deviation of the user's measurement of the deck tag's height, mm.
const HEIGHT_SIGMA: f64 = 1.0;
/// Standard deviation of the user's measurement of the ruler, as a share of its length.
const RULER_SIGMA: f64 = 0.001;

/// The camera of an analysed film, as the tags show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraEstimate {
    /// Focal length, px.
    pub focal_length: f64,
    /// Height above the floor in the first picture, mm.
    pub height: f64,
    /// Tilt from straight down in the first picture, deg.
    pub tilt: f64,
    /// Root-mean-square error of a floor tag's corner, px.
    pub corner_error: f64,
    /// True if the camera moved during the film.
    pub has_camera_moved: bool,
    /// Height of the deck tag above the floor, computed from its size in the pictures, mm.
    pub deck_height: f64,
}

/// A film whose camera and path are known.
#[derive(Debug, Clone)]
pub struct AnalysedFilm {
    /// The robot's path.
    pub path: Vec<PathPoint>,
    /// The camera.
    pub camera: CameraEstimate,
    pub(crate) scene: Scene,
    /// The tags of each picture of the path.
    pub(crate) frames: Vec<Frame>,
    /// Given height of the deck tag above the floor, mm.
    pub(crate) given_deck_height: f64,
}

impl AnalysedFilm {
    /// Measures a gait between two times, s, or in the entire film.
    ///
    /// # Errors
    /// Fails if the path in that time differs from the gait's predicted path, or is too short.
    pub fn measure(
        &self,
        gait: &Gait,
        interval: Option<[f64; 2]>,
    ) -> Result<MeasuredGait, Trouble> {
        let path = self.path_between(interval);
        let cycles = cycles::find_cycles(path, gait)?;
        // A deck tag that is higher than given seems to move farther.
        let scale_error =
            (HEIGHT_SIGMA / (self.camera.height - self.given_deck_height)).hypot(RULER_SIGMA);
        let deviations = cycle_path::compute_deviations(path, &cycles, gait);
        let walk = Walk {
            scene_variances: self.scene_variances(&cycles),
            cycles,
            scale_error,
            deviations,
        };
        Ok(MeasuredGait::from_walks(vec![walk], gait))
    }

    /// The walks, each as the times of its beginning and its end, s, extended at both ends by half of `shortest_rest`.
    /// The robot rests if it stands still for `shortest_rest` seconds, which should be at least the result of
    /// [`shortest_rest`](crate::shortest_rest).
    pub fn walks(&self, shortest_rest: f64) -> Vec<[f64; 2]> {
        walks::find_walks(&self.path, shortest_rest)
    }

    /// Finds which of the gaits the robot's path between two times, s, shows.
    pub fn match_gait(&self, gaits: &[Gait], interval: [f64; 2]) -> GaitMatch {
        gait_match::match_gait(self.path_between(Some(interval)), gaits)
    }

    /// The camera in each picture of the path.
    pub(crate) fn frame_cameras(&self) -> impl Iterator<Item = Camera> {
        let camera_of = |frame: &Frame| frame.camera(&self.scene, self.camera.has_camera_moved);
        self.frames.iter().filter_map(camera_of)
    }

    /// The path between two times, s, or all of it.
    fn path_between(&self, interval: Option<[f64; 2]>) -> &[PathPoint] {
        let [from, to] = interval.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let begin = self.path.partition_point(|point| point.seconds < from);
        let end = self.path.partition_point(|point| point.seconds <= to);
        &self.path[begin..end.max(begin)]
    }

    /// The variances of the mean cycle that result from the covariance of the scene: forward and left, mm^2, and turn,
    /// deg^2.
    fn scene_variances(&self, cycles: &Cycles) -> [f64; 3] {
        // A camera that moves has its own pose in each picture, so only the shared parameters count.
        let parameter_count = match self.camera.has_camera_moved {
            true => SHARED_PARAMETER_COUNT,
            false => SHARED_PARAMETER_COUNT + POSE_PARAMETER_COUNT,
        };
        let scene = &self.scene;
        let nearest_frame = |time: &f64| {
            let frames = self.frames.iter();
            frames.min_by(|a, b| {
                (a.seconds - time)
                    .abs()
                    .total_cmp(&(b.seconds - time).abs())
            })
        };
        let frames: Vec<&Frame> = cycles.boundaries.iter().filter_map(nearest_frame).collect();
        let mean_movement = |scene: &Scene| -> [f64; 3] {
            let mut points: Vec<PathPoint> = frames
                .iter()
                .filter_map(|frame| {
                    Some(PathPoint {
                        seconds: 0.0,
                        place: frame.place(scene, self.camera.has_camera_moved)?,
                    })
                })
                .collect();
            unwrap_headings(&mut points);
            let travels: Vec<Travel> = points
                .windows(2)
                .map(|pair| pair[1].place.travel_from(pair[0].place))
                .collect();
            travel_components(&travels)
                .map(|values| values.iter().sum::<f64>() / values.len().max(1) as f64)
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
            let pairs =
                (0..parameter_count).flat_map(|i| (0..parameter_count).map(move |j| (i, j)));
            let term_of = |(i, j): (usize, usize)| {
                jacobian[i][axis] * scene.covariance[(i, j)] * jacobian[j][axis]
            };
            pairs.map(term_of).sum::<f64>().max(0.0)
        })
    }
}
