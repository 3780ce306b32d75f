//! The scene: the camera's focal length, and the places of strips and camera, found from the tags' corners.
//!
//! The first strip defines the coordinate axes of the floor. The other strip may be anywhere: three unknowns. Light
//! and ink spread, so every black square is larger or smaller than designed, by the same small length: one more
//! unknown, which the distance between a strip's tags separates from the scale. If the tilt does not separate focal
//! length from distance, the size of the deck tag does, since its height is known.

use lizard_contact::Place;
use nalgebra::DMatrix;

use crate::camera::{Camera, Pose, pose_of};
use crate::homography::Homography;
use crate::least::{self, Fit};
use crate::picture::Pixel;
use crate::sheet::{self, DECK_TAG, FLOOR_TAGS, TAGS_ON_STRIP};
use crate::trouble::Trouble;

/// Number of parameters that all views share: focal length, spread, the second strip's place.
const SHARED: usize = 5;
/// Error of a corner of a floor tag, px, in the mean over a film: the pixel grid is the same in all pictures.
const FLOOR_SIGMA: f64 = 0.03;
/// Error of a corner of the deck tag in one picture, px.
const DECK_SIGMA: f64 = 0.08;
/// Ratios of the focal length to the picture's width from which the fit starts.
const STARTS: [f64; 3] = [0.8, 1.1, 1.6];
/// Largest root-mean-square error of a corner, px.
const LARGEST_ERROR: f64 = 1.5;
/// Largest spread of a tag's edge, mm.
const LARGEST_SPREAD: f64 = 0.6;

/// The corners of each floor tag, in one picture or as means over several.
pub(crate) type FloorCorners = [[Pixel; 4]; FLOOR_TAGS];

/// Pictures taken from one place of the camera.
pub(crate) struct View {
    /// The corners of the floor tags.
    pub floor: FloorCorners,
    /// The corners of the deck tag at each of its places.
    pub decks: Vec<[Pixel; 4]>,
}

/// The known measures of the scene.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measures {
    /// True length of a printed mm, mm.
    pub scale: f64,
    /// Height of the deck tag above the floor, mm.
    pub height: f64,
    /// Width and height of the pictures, px.
    pub size: [usize; 2],
}

/// The parameters that the views share, and the camera of the first view.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    measures: Measures,
    /// The shared parameters, then the first view's pose.
    parameters: Vec<f64>,
    /// The covariance of these parameters.
    pub covariance: DMatrix<f64>,
    /// Root-mean-square error of a floor tag's corner, px.
    pub error: f64,
}

impl Scene {
    /// Fits the scene to views.
    ///
    /// # Errors
    /// Fails if no camera fits the tags, or if their arrangement or size differs from the sheet's.
    pub(crate) fn of(views: &[View], measures: Measures) -> Result<Self, Trouble> {
        let width = measures.size[0] as f64;
        let fits = STARTS
            .iter()
            .filter_map(|start| fit(views, &measures, start * width));
        let best = fits.min_by(|a, b| a.squares.total_cmp(&b.squares));
        let best = best.ok_or(Trouble::NoCamera)?;
        let count = views.len() * FLOOR_TAGS * 4;
        let floor_errors = residuals(&best.at, views, &measures, false);
        let error =
            FLOOR_SIGMA * (floor_errors.iter().map(|r| r * r).sum::<f64>() / count as f64).sqrt();
        if !error.is_finite() || error > LARGEST_ERROR {
            return Err(Trouble::NotThisSheet { error });
        }
        let spread = best.at[1];
        if spread.abs() > LARGEST_SPREAD * measures.scale {
            return Err(Trouble::TagSize {
                edge: sheet::FLOOR_EDGE + 2.0 * spread / measures.scale,
            });
        }
        let kept_count = SHARED + 6;
        let freedom = (2 * count + views.iter().map(|view| 8 * view.decks.len()).sum::<usize>())
            .saturating_sub(best.at.len());
        let excess = (best.squares / freedom.max(1) as f64).max(1.0);
        Ok(Self {
            measures,
            parameters: best.at[..kept_count].to_vec(),
            covariance: best.covariance.view((0, 0), (kept_count, kept_count)) * excess,
            error,
        })
    }

    /// The scene with one parameter changed.
    pub(crate) fn with_parameter_changed(&self, parameter: usize, change: f64) -> Self {
        let mut changed = self.clone();
        changed.parameters[parameter] += change;
        changed
    }

    /// The focal length, px.
    pub(crate) fn focal(&self) -> f64 {
        self.parameters[0]
    }

    /// The first view's camera.
    pub(crate) fn camera(&self) -> Camera {
        self.camera_at(&self.parameters[SHARED..])
    }

    /// A camera of the scene in another pose.
    pub(crate) fn camera_at(&self, pose: &[f64]) -> Camera {
        Camera::new(self.focal(), self.measures.size, pose)
    }

    /// Finds the camera's pose from the floor tags of a picture; `None` if it does not fit them, as when one is
    /// covered.
    pub(crate) fn pose(&self, floor: &FloorCorners) -> Option<Pose> {
        let start = start_pose(floor, &self.measures, self.focal())?;
        let model = |pose: &[f64]| {
            let camera = self.camera_at(pose);
            floor_residuals(&self.parameters, &camera, &self.measures, floor)
        };
        let fit = least::fit(&start, model)?;
        let error = FLOOR_SIGMA * (fit.squares / (4 * FLOOR_TAGS) as f64).sqrt();
        // A partly covered tag has wrong corners, and would give a wrong camera.
        if error > LARGEST_ERROR {
            return None;
        }
        fit.at.try_into().ok()
    }

    /// Finds the robot's place from the corners of its deck tag; `None` if they do not determine it.
    pub(crate) fn place(&self, camera: &Camera, corners: &[Pixel; 4]) -> Option<Place> {
        let start = deck_start(camera, corners, self.measures.height)?;
        let model = |place: &[f64]| {
            deck_residuals(
                &self.parameters,
                camera,
                &self.measures,
                place,
                self.measures.height,
                corners,
            )
        };
        let [forward, left, heading]: [f64; 3] = least::fit(&start, model)?.at.try_into().ok()?;
        Some(Place {
            forward,
            left,
            heading,
        })
    }

    /// Finds the height of the deck tag from its size in the picture, mm; `None` if its corners do not determine
    /// it.
    pub(crate) fn height(&self, camera: &Camera, corners: &[Pixel; 4]) -> Option<f64> {
        let [a, b, c] = deck_start(camera, corners, self.measures.height)?;
        let model = |parameters: &[f64]| {
            deck_residuals(
                &self.parameters,
                camera,
                &self.measures,
                parameters,
                parameters[3],
                corners,
            )
        };
        Some(least::fit(&[a, b, c, self.measures.height], model)?.at[3])
    }

    /// The middles of the floor tags on the floor, mm.
    pub(crate) fn floor_tags(&self) -> [[f64; 2]; FLOOR_TAGS] {
        std::array::from_fn(|id| {
            on_floor(
                &self.parameters,
                self.measures.scale,
                id,
                sheet::middle_on_strip(id),
            )
        })
    }
}

/// Converts a point of a strip, in designed mm, to a place on the floor, mm.
fn on_floor(shared: &[f64], scale: f64, id: usize, point: [f64; 2]) -> [f64; 2] {
    let point = point.map(|coordinate| scale * coordinate);
    if sheet::strip_of(id) == 0 {
        return point;
    }
    let strip = Place {
        forward: shared[2],
        left: shared[3],
        heading: shared[4],
    };
    strip.on_floor(point)
}

/// The corners of a tag as printed, with the spread of its ink: relative to its middle, in designed mm.
fn printed_corners(shared: &[f64], scale: f64, id: usize) -> [[f64; 2]; 4] {
    sheet::corners(sheet::edge(id) + 2.0 * shared[1] / scale)
}

/// The errors of the floor tags' corners, divided by their sigma.
fn floor_residuals(
    shared: &[f64],
    camera: &Camera,
    measures: &Measures,
    floor: &FloorCorners,
) -> Vec<f64> {
    let mut residuals = Vec::with_capacity(8 * FLOOR_TAGS);
    for (id, corners) in floor.iter().enumerate() {
        let [x, y] = sheet::middle_on_strip(id);
        for ([u, v], corner) in printed_corners(shared, measures.scale, id)
            .iter()
            .zip(corners)
        {
            let point = on_floor(shared, measures.scale, id, [x + u, y + v]);
            let image = camera.project(point, 0.0);
            residuals.extend([0, 1].map(|i| (image[i] - corner[i]) / FLOOR_SIGMA));
        }
    }
    residuals
}

/// The errors of the deck tag's corners at a place and a height, divided by their sigma.
fn deck_residuals(
    shared: &[f64],
    camera: &Camera,
    measures: &Measures,
    parameters: &[f64],
    height: f64,
    corners: &[Pixel; 4],
) -> Vec<f64> {
    let place = Place {
        forward: parameters[0],
        left: parameters[1],
        heading: parameters[2],
    };
    let points = printed_corners(shared, measures.scale, DECK_TAG);
    let pairs = points.iter().zip(corners);
    pairs
        .flat_map(|(&[x, y], corner)| {
            // The upper edge of the tag is ahead, so its left edge is on the left.
            let floor_point = place.on_floor([measures.scale * y, -measures.scale * x]);
            let image = camera.project(floor_point, height);
            [0, 1].map(|i| (image[i] - corner[i]) / DECK_SIGMA)
        })
        .collect()
}

/// A first estimate of the deck tag's place: the intersection of the rays through its corners with the plane at its
/// height. `None` if there is no such intersection.
fn deck_start(camera: &Camera, corners: &[Pixel; 4], height: f64) -> Option<[f64; 3]> {
    // The corners of any square in that plane give the homography from the picture to the plane.
    let square = [
        [-100.0, -100.0],
        [100.0, -100.0],
        [100.0, 100.0],
        [-100.0, 100.0],
    ];
    let images = square.map(|point| camera.project(point, height));
    let map = Homography::of_four(images, square)?;
    let [a, b, c, d] = corners.map(|corner| map.map(corner));
    let mean_of = |i: usize| (a[i] + b[i] + c[i] + d[i]) / 4.0;
    let ahead_sum = |i: usize| a[i] + b[i] - c[i] - d[i];
    Some([mean_of(0), mean_of(1), ahead_sum(1).atan2(ahead_sum(0))])
}

/// A first estimate of the camera's pose, from the first strip.
fn start_pose(floor: &FloorCorners, measures: &Measures, focal: f64) -> Option<Pose> {
    pose_of(&strip_map(floor, measures, 0)?, focal, measures.size)
}

/// The homography from a strip's own frame to the picture.
fn strip_map(floor: &FloorCorners, measures: &Measures, strip: usize) -> Option<Homography> {
    let ids = strip * TAGS_ON_STRIP..(strip + 1) * TAGS_ON_STRIP;
    let mut points = Vec::new();
    for id in ids.clone() {
        let [x, y] = sheet::middle_on_strip(id);
        let corners = sheet::corners(sheet::edge(id));
        points.extend(
            corners.map(|[u, v]| [x + u, y + v].map(|coordinate| measures.scale * coordinate)),
        );
    }
    Homography::of_points(&points, &floor[ids].concat())
}

/// The errors of all tags' corners in all views, divided by their sigma; only of the floor tags if `has_decks` is
/// false.
fn residuals(parameters: &[f64], views: &[View], measures: &Measures, has_decks: bool) -> Vec<f64> {
    let (shared, mut rest) = parameters.split_at(SHARED);
    let mut errors = Vec::new();
    let mut take = |count: usize| {
        let (taken, remaining) = rest.split_at(count);
        rest = remaining;
        taken
    };
    let cameras: Vec<Camera> = views
        .iter()
        .map(|_| Camera::new(shared[0], measures.size, take(6)))
        .collect();
    for (view, camera) in views.iter().zip(&cameras) {
        errors.extend(floor_residuals(shared, camera, measures, &view.floor));
        for corners in view.decks.iter().filter(|_| has_decks) {
            errors.extend(deck_residuals(
                shared,
                camera,
                measures,
                take(3),
                measures.height,
                corners,
            ));
        }
    }
    errors
}

/// Fits all parameters, starting with this focal length; `None` if the tags do not determine them.
fn fit(views: &[View], measures: &Measures, focal: f64) -> Option<Fit> {
    let first_view = views.first()?;
    let to_floor = strip_map(&first_view.floor, measures, 0)?.inverse()?;
    let middle_of = |id: usize| {
        let corners = first_view.floor[id].map(|corner| to_floor.map(corner));
        [0, 1].map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 4.0)
    };
    let middles = [middle_of(TAGS_ON_STRIP), middle_of(TAGS_ON_STRIP + 1)];
    let heading = (middles[1][1] - middles[0][1]).atan2(middles[1][0] - middles[0][0]);
    let mut start = vec![
        focal,
        0.0,
        (middles[0][0] + middles[1][0]) / 2.0,
        (middles[0][1] + middles[1][1]) / 2.0,
        heading,
    ];
    let mut decks = Vec::new();
    for view in views {
        let pose = start_pose(&view.floor, measures, focal)?;
        let camera = Camera::new(focal, measures.size, &pose);
        start.extend(pose);
        for corners in &view.decks {
            decks.extend(deck_start(&camera, corners, measures.height)?);
        }
    }
    start.extend(decks);
    least::fit(&start, |parameters| {
        residuals(parameters, views, measures, true)
    })
}
