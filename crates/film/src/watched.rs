//! A watched film: its camera and the robot's path are known, so that gaits can be measured.

use lizard_contact::Travel;

use crate::camera::Camera;
use crate::cycles::{self, Cycles};
use crate::frame::Frame;
use crate::gait::Gait;
use crate::likeness::{self, Likeness};
use crate::measured::Measured;
use crate::path::{PathPoint, unwind};
use crate::scene::Scene;
use crate::trouble::Trouble;
use crate::walk::{Walk, parts};
use crate::{walks, within};

/// Standard deviation of the user's measurement of the deck tag's height, mm.
const HEIGHT_SIGMA: f64 = 1.0;
/// Standard deviation of the user's measurement of the ruler, as a share.
const RULER_SIGMA: f64 = 0.001;

/// The camera of a watched film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// Focal length, px.
    pub focal: f64,
    /// Height above the floor in the first picture, mm.
    pub height: f64,
    /// Tilt from straight down in the first picture, deg.
    pub tilt: f64,
    /// Root-mean-square error of a floor tag's corner, px.
    pub error: f64,
    /// True if the camera moved during the film.
    pub has_camera_moved: bool,
    /// Height of the deck tag found by its size, mm.
    pub deck: f64,
}

/// A film whose camera and path are known.
#[derive(Debug, Clone)]
pub struct AnalysedFilm {
    /// The robot's path.
    pub path: Vec<PathPoint>,
    /// The camera.
    pub sight: Sight,
    scene: Scene,
    /// The tags of each picture of the path.
    frames: Vec<Frame>,
    /// Given height of the deck tag above the floor, mm.
    deck: f64,
}

impl AnalysedFilm {
    /// A film with a frame for each place of the path.
    pub(crate) fn new(
        path: Vec<PathPoint>,
        sight: Sight,
        scene: Scene,
        frames: Vec<Frame>,
        deck: f64,
    ) -> Self {
        Self {
            path,
            sight,
            scene,
            frames,
            deck,
        }
    }

    /// Measures a gait between two times, s, or in the entire film.
    ///
    /// # Errors
    /// Fails if the path in that time differs from the gait's predicted path, or is too short.
    pub fn measure(&self, gait: &Gait, interval: Option<[f64; 2]>) -> Result<Measured, Trouble> {
        let path = self.path_between(interval);
        let cycles = cycles::find(path, gait)?;
        let variances = self.scene_variances(&cycles);
        // A deck tag that is higher than given seems to move farther.
        let scale = (HEIGHT_SIGMA / (self.sight.height - self.deck)).hypot(RULER_SIGMA);
        let deviations = within::find_deviations(path, &cycles, gait);
        let walk = Walk {
            cycles,
            scene_variances: variances,
            scale,
            deviations,
        };
        Ok(Measured::of(vec![walk], gait))
    }

    /// Finds the walks, each as the times of its beginning and its end, s, extended by half of `rest`. The robot
    /// rests if it stands still for `rest` seconds; that should be no less than [`rest`](crate::rest) returns.
    pub fn walks(&self, rest: f64) -> Vec<[f64; 2]> {
        walks::find_walks(&self.path, rest)
    }

    /// Finds which of the gaits the robot walks between two times, s.
    pub fn likeness(&self, gaits: &[Gait], interval: [f64; 2]) -> Likeness {
        likeness::find_likeness(self.path_between(Some(interval)), gaits)
    }

    /// The camera in each picture of the path.
    pub(crate) fn cameras(&self) -> impl Iterator<Item = Camera> {
        let camera_of = |frame: &Frame| frame.camera(&self.scene, self.sight.has_camera_moved);
        self.frames.iter().filter_map(camera_of)
    }

    /// The path between two times, s, or all of it.
    fn path_between(&self, interval: Option<[f64; 2]>) -> &[PathPoint] {
        let [from, to] = interval.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let begin = self.path.partition_point(|point| point.seconds < from);
        let end = self.path.partition_point(|point| point.seconds <= to);
        &self.path[begin..end.max(begin)]
    }

    /// The variances of the mean cycle that result from the covariance of the scene: forward, left, turn.
    fn scene_variances(&self, cycles: &Cycles) -> [f64; 3] {
        // A camera that moves has its own pose in each picture, so only the five shared parameters count.
        let count = if self.sight.has_camera_moved { 5 } else { 11 };
        let scene = &self.scene;
        let nearest_frame = |time: &f64| {
            let frames = self.frames.iter();
            frames.min_by(|a, b| {
                (a.seconds - time)
                    .abs()
                    .total_cmp(&(b.seconds - time).abs())
            })
        };
        let frames: Vec<&Frame> = cycles.ends.iter().filter_map(nearest_frame).collect();
        let mean_movement = |scene: &Scene| -> [f64; 3] {
            let mut points: Vec<PathPoint> = frames
                .iter()
                .filter_map(|frame| {
                    Some(PathPoint {
                        seconds: 0.0,
                        place: frame.place(scene, self.sight.has_camera_moved)?,
                    })
                })
                .collect();
            unwind(&mut points);
            let travels: Vec<Travel> = points
                .windows(2)
                .map(|pair| pair[1].place.seen_from(pair[0].place))
                .collect();
            parts(&travels).map(|values| values.iter().sum::<f64>() / values.len().max(1) as f64)
        };
        let base = mean_movement(scene);
        let slopes: Vec<[f64; 3]> = (0..count)
            .map(|i| {
                let step = scene.covariance[(i, i)].sqrt().max(1e-12);
                let changed = mean_movement(&scene.with_parameter_changed(i, step));
                [0, 1, 2].map(|axis| (changed[axis] - base[axis]) / step)
            })
            .collect();
        [0, 1, 2].map(|axis| {
            let pairs = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
            let term_of = |(i, j): (usize, usize)| {
                slopes[i][axis] * scene.covariance[(i, j)] * slopes[j][axis]
            };
            pairs.map(term_of).sum::<f64>().max(0.0)
        })
    }
}
