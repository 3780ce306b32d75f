//! The scene: the camera's focal length and the poses of camera and strips, computed from the tags' corners.
//!
//! The first strip defines the coordinate axes of the floor. The pose of the second strip adds three unknowns. Light
//! and ink spread, so every black square is larger or smaller than designed by the same small length. This length is
//! one more unknown; the distance between a strip's tags distinguishes it from the scale. The floor tags alone cannot
//! distinguish the focal length from the distance of a camera that looks nearly straight down. The deck tag can,
//! because its height is known.

use lizard_contact::BodyPose;
use nalgebra::DMatrix;

use crate::camera::{Camera, CameraPose, camera_pose_from_homography};
use crate::frame::Pixel;
use crate::homography::Homography;
use crate::least_squares::{self, Fit, squared_norm};
use crate::sheet::{self, DECK_TAG_ID, FLOOR_TAG_COUNT, TAGS_PER_STRIP};
use crate::video_error::VideoError;

/// Number of parameters that all views have in common: focal length, ink spread, and the second strip's pose.
pub(crate) const SHARED_PARAMETER_COUNT: usize = 5;
/// Number of parameters of a camera's pose.
pub(crate) const POSE_PARAMETER_COUNT: usize = 6;
/// Standard deviation of a floor tag's corner in the mean over a video, px. More frames do not reduce it, because the
/// pixel grid is the same in all frames.
const FLOOR_SIGMA: f64 = 0.03;
/// Standard deviation of a deck tag's corner in one frame, px.
const DECK_SIGMA: f64 = 0.08;
/// Ratios of the focal length to the frame's width with which the fit starts.
const START_FOCAL_RATIOS: [f64; 3] = [0.8, 1.1, 1.6];
/// Largest root-mean-square error of a corner, px.
const MAX_CORNER_ERROR: f64 = 1.5;
/// Largest displacement of a tag's edges by the spread of light and ink, in mm of the sheet's design.
const MAX_INK_SPREAD: f64 = 0.6;

/// The corners of each floor tag, in one frame or averaged over several.
pub(crate) type FloorCorners = [[Pixel; 4]; FLOOR_TAG_COUNT];

/// Frames taken from one camera position.
#[derive(Clone)]
pub(crate) struct View {
    /// The corners of the floor tags.
    pub floor_corners: FloorCorners,
    /// The corners of the deck tag at each of its poses.
    pub deck_corners: Vec<[Pixel; 4]>,
}

/// The known dimensions of the sheet, the robot and the frames.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dimensions {
    /// True length of a printed mm, mm.
    pub print_scale: f64,
    /// Height of the deck tag above the floor, mm.
    pub deck_height: f64,
    /// Width and height of the frames, px.
    pub frame_size: [usize; 2],
}

/// The parameters that all views have in common, and the camera of the first view.
#[derive(Debug, Clone)]
pub(crate) struct Scene {
    pub dimensions: Dimensions,
    /// True if the camera moved, so that each frame has its own pose of the camera.
    pub has_camera_moved: bool,
    /// The common parameters, then the first view's pose.
    parameters: Vec<f64>,
    /// The covariance of these parameters.
    pub covariance: DMatrix<f64>,
    /// Root-mean-square error of a floor tag's corner, px.
    pub corner_error: f64,
}

impl Scene {
    /// Fits the scene to views.
    ///
    /// # Errors
    /// Fails if no camera fits the tags, or if their arrangement or size differs from the sheet's.
    pub(crate) fn fit(
        views: &[View],
        dimensions: Dimensions,
        has_camera_moved: bool,
    ) -> Result<Self, VideoError> {
        let width = dimensions.frame_size[0] as f64;
        let fit_from = |start: &f64| fit_parameters(views, &dimensions, start * width);
        let fits = START_FOCAL_RATIOS.iter().filter_map(fit_from);
        let best_fit = fits.min_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
        let best_fit = best_fit.ok_or(VideoError::NoCamera)?;
        let corner_count = views.len() * FLOOR_TAG_COUNT * 4;
        let residuals = compute_residuals(&best_fit.parameters, views, &dimensions, false);
        let mean_square = squared_norm(&residuals) / corner_count as f64;
        let corner_error = FLOOR_SIGMA * mean_square.sqrt();
        if !corner_error.is_finite() || corner_error > MAX_CORNER_ERROR {
            return Err(VideoError::SheetMismatch {
                error: corner_error,
            });
        }
        let ink_spread = best_fit.parameters[1];
        if ink_spread.abs() > MAX_INK_SPREAD * dimensions.print_scale {
            let edge = sheet::FLOOR_TAG_EDGE + 2.0 * ink_spread / dimensions.print_scale;
            return Err(VideoError::WrongTagSize { edge });
        }
        let kept_parameter_count = SHARED_PARAMETER_COUNT + POSE_PARAMETER_COUNT;
        let deck_residual_counts = views.iter().map(|view| 8 * view.deck_corners.len());
        let residual_count = 2 * corner_count + deck_residual_counts.sum::<usize>();
        let degrees_of_freedom = residual_count.saturating_sub(best_fit.parameters.len());
        let reduced_chi_square =
            (best_fit.sum_of_squares / degrees_of_freedom.max(1) as f64).max(1.0);
        Ok(Self {
            dimensions,
            has_camera_moved,
            parameters: best_fit.parameters[..kept_parameter_count].to_vec(),
            covariance: best_fit
                .covariance
                .view((0, 0), (kept_parameter_count, kept_parameter_count))
                * reduced_chi_square,
            corner_error,
        })
    }

    /// Returns the scene with one parameter changed by `change`.
    pub(crate) fn with_parameter_changed(&self, index: usize, change: f64) -> Self {
        let mut changed = self.clone();
        changed.parameters[index] += change;
        changed
    }

    /// Returns the focal length, px.
    pub(crate) fn focal_length(&self) -> f64 {
        self.parameters[0]
    }

    /// Returns the first view's camera.
    pub(crate) fn camera(&self) -> Camera {
        self.camera_at(&self.parameters[SHARED_PARAMETER_COUNT..])
    }

    /// Returns the scene's camera in another pose.
    pub(crate) fn camera_at(&self, pose: &[f64]) -> Camera {
        Camera::new(self.focal_length(), self.dimensions.frame_size, pose)
    }

    /// Finds the camera's pose from a frame's floor tags; `None` if no pose fits them, for example because a tag is
    /// partly covered.
    pub(crate) fn find_camera_pose(&self, floor_corners: &FloorCorners) -> Option<CameraPose> {
        let start = estimate_camera_pose(floor_corners, &self.dimensions, self.focal_length())?;
        let model = |pose: &[f64]| {
            let camera = self.camera_at(pose);
            floor_residuals(&self.parameters, &camera, &self.dimensions, floor_corners)
        };
        let fit = least_squares::fit(&start, model)?;
        let corner_error = FLOOR_SIGMA * (fit.sum_of_squares / (4 * FLOOR_TAG_COUNT) as f64).sqrt();
        // A partly covered tag has wrong corners and would give a wrong pose.
        if corner_error > MAX_CORNER_ERROR {
            return None;
        }
        fit.parameters.try_into().ok()
    }

    /// Finds the robot's pose from the corners of its deck tag; `None` if they do not determine it.
    pub(crate) fn find_body_pose(&self, camera: &Camera, corners: &[Pixel; 4]) -> Option<BodyPose> {
        let start = estimate_deck_pose(camera, corners, self.dimensions.deck_height)?;
        let model = |pose: &[f64]| {
            deck_residuals(&self.parameters, camera, &self.dimensions, pose, corners)
        };
        let fit = least_squares::fit(&start, model)?;
        Some(to_body_pose(&fit.parameters))
    }

    /// Finds the deck tag's height, mm, from its size in the frame; `None` if its corners do not determine it.
    pub(crate) fn find_deck_height(&self, camera: &Camera, corners: &[Pixel; 4]) -> Option<f64> {
        let given_height = self.dimensions.deck_height;
        let [forward, left, heading] = estimate_deck_pose(camera, corners, given_height)?;
        let model = |parameters: &[f64]| {
            let dimensions = Dimensions {
                deck_height: parameters[3],
                ..self.dimensions
            };
            deck_residuals(&self.parameters, camera, &dimensions, parameters, corners)
        };
        let fit = least_squares::fit(&[forward, left, heading, given_height], model)?;
        Some(fit.parameters[3])
    }

    /// Returns the centres of the floor tags on the floor, mm.
    pub(crate) fn floor_tag_centres(&self) -> [[f64; 2]; FLOOR_TAG_COUNT] {
        std::array::from_fn(|id| {
            let centre = sheet::centre_on_strip(id);
            strip_to_floor(&self.parameters, self.dimensions.print_scale, id, centre)
        })
    }
}

/// Converts a point on a floor tag's strip, in mm of the sheet's design, to a point on the floor, mm. `shared` starts
/// with the parameters that all views have in common.
fn strip_to_floor(shared: &[f64], print_scale: f64, id: usize, point: [f64; 2]) -> [f64; 2] {
    let point = point.map(|coordinate| print_scale * coordinate);
    if sheet::strip_index(id) == 0 {
        return point;
    }
    to_body_pose(&shared[2..]).to_floor(point)
}

/// Returns the pose on the floor that the first three parameters describe.
fn to_body_pose(parameters: &[f64]) -> BodyPose {
    BodyPose {
        forward: parameters[0],
        left: parameters[1],
        heading: parameters[2],
    }
}

/// Returns the corners of a printed tag, including the ink spread, relative to its centre, in mm of the sheet's
/// design.
fn printed_corners(shared: &[f64], print_scale: f64, id: usize) -> [[f64; 2]; 4] {
    sheet::tag_corners(sheet::tag_edge(id) + 2.0 * shared[1] / print_scale)
}

/// Computes the errors of the floor tags' corners, divided by their standard deviation.
fn floor_residuals(
    shared: &[f64],
    camera: &Camera,
    dimensions: &Dimensions,
    floor_corners: &FloorCorners,
) -> Vec<f64> {
    let mut residuals = Vec::with_capacity(8 * FLOOR_TAG_COUNT);
    for (id, corners) in floor_corners.iter().enumerate() {
        let [x, y] = sheet::centre_on_strip(id);
        let printed_corners = printed_corners(shared, dimensions.print_scale, id);
        for ([u, v], corner) in printed_corners.iter().zip(corners) {
            let point = strip_to_floor(shared, dimensions.print_scale, id, [x + u, y + v]);
            let image = camera.project(point, 0.0);
            residuals.extend([0, 1].map(|i| (image[i] - corner[i]) / FLOOR_SIGMA));
        }
    }
    residuals
}

/// Computes the errors of the deck tag's corners, divided by their standard deviation. `parameters` starts with the
/// tag's pose.
fn deck_residuals(
    shared: &[f64],
    camera: &Camera,
    dimensions: &Dimensions,
    parameters: &[f64],
    corners: &[Pixel; 4],
) -> Vec<f64> {
    let pose = to_body_pose(parameters);
    let points = printed_corners(shared, dimensions.print_scale, DECK_TAG_ID);
    let pairs = points.iter().zip(corners);
    pairs
        .flat_map(|(&[x, y], corner)| {
            // The tag's upper edge faces forward, so its left edge is on the left.
            let floor_point =
                pose.to_floor([dimensions.print_scale * y, -dimensions.print_scale * x]);
            let image = camera.project(floor_point, dimensions.deck_height);
            [0, 1].map(|i| (image[i] - corner[i]) / DECK_SIGMA)
        })
        .collect()
}

/// Estimates the deck tag's pose from the intersections of the rays through its corners with the plane at its height;
/// `None` if they do not intersect.
fn estimate_deck_pose(camera: &Camera, corners: &[Pixel; 4], deck_height: f64) -> Option<[f64; 3]> {
    // The corners of any square in that plane give the homography from the frame to the plane.
    let square = [
        [-100.0, -100.0],
        [100.0, -100.0],
        [100.0, 100.0],
        [-100.0, 100.0],
    ];
    let images = square.map(|point| camera.project(point, deck_height));
    let map = Homography::from_points(&images, &square)?;
    let [a, b, c, d] = corners.map(|corner| map.map(corner));
    let mean = |i: usize| (a[i] + b[i] + c[i] + d[i]) / 4.0;
    let upper_minus_lower = |i: usize| a[i] + b[i] - c[i] - d[i];
    let heading = upper_minus_lower(1).atan2(upper_minus_lower(0));
    Some([mean(0), mean(1), heading])
}

/// Estimates the camera's pose from the first strip; `None` if the strip's tags do not determine it.
fn estimate_camera_pose(
    floor_corners: &FloorCorners,
    dimensions: &Dimensions,
    focal_length: f64,
) -> Option<CameraPose> {
    let homography = strip_homography(floor_corners, dimensions)?;
    camera_pose_from_homography(&homography, focal_length, dimensions.frame_size)
}

/// Computes the homography from the first strip, with its centre as the origin, to the frame; `None` if it is
/// degenerate.
fn strip_homography(floor_corners: &FloorCorners, dimensions: &Dimensions) -> Option<Homography> {
    let mut points = Vec::new();
    for id in 0..TAGS_PER_STRIP {
        let [x, y] = sheet::centre_on_strip(id);
        let corners = sheet::tag_corners(sheet::tag_edge(id)).map(|[u, v]| [x + u, y + v]);
        points.extend(corners.map(|corner| corner.map(|value| dimensions.print_scale * value)));
    }
    Homography::from_points(&points, &floor_corners[..TAGS_PER_STRIP].concat())
}

/// Computes the errors of the floor tags' corners in all views, and those of the deck tags' corners if
/// `includes_deck_tags`. Each error is divided by its standard deviation.
fn compute_residuals(
    parameters: &[f64],
    views: &[View],
    dimensions: &Dimensions,
    includes_deck_tags: bool,
) -> Vec<f64> {
    let (shared, mut rest) = parameters.split_at(SHARED_PARAMETER_COUNT);
    let mut all_residuals = Vec::new();
    let mut next_parameters = |count: usize| {
        let (next, remaining) = rest.split_at(count);
        rest = remaining;
        next
    };
    let mut cameras = Vec::with_capacity(views.len());
    for _ in views {
        let pose = next_parameters(POSE_PARAMETER_COUNT);
        cameras.push(Camera::new(shared[0], dimensions.frame_size, pose));
    }
    for (view, camera) in views.iter().zip(&cameras) {
        let corners = &view.floor_corners;
        all_residuals.extend(floor_residuals(shared, camera, dimensions, corners));
        for corners in view.deck_corners.iter().filter(|_| includes_deck_tags) {
            let pose = next_parameters(3);
            all_residuals.extend(deck_residuals(shared, camera, dimensions, pose, corners));
        }
    }
    all_residuals
}

/// Fits all parameters, starting with the given focal length; `None` if the tags do not determine them.
fn fit_parameters(views: &[View], dimensions: &Dimensions, start_focal_length: f64) -> Option<Fit> {
    let first_view = views.first()?;
    let to_floor = strip_homography(&first_view.floor_corners, dimensions)?.inverse()?;
    let find_centre = |id: usize| {
        let corners = first_view.floor_corners[id].map(|corner| to_floor.map(corner));
        [0, 1].map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 4.0)
    };
    let [first_centre, second_centre] = [TAGS_PER_STRIP, TAGS_PER_STRIP + 1].map(find_centre);
    let heading = (second_centre[1] - first_centre[1]).atan2(second_centre[0] - first_centre[0]);
    let [x, y] = [0, 1].map(|i| (first_centre[i] + second_centre[i]) / 2.0);
    let mut start = vec![start_focal_length, 0.0, x, y, heading];
    let mut deck_poses = Vec::new();
    for view in views {
        let pose = estimate_camera_pose(&view.floor_corners, dimensions, start_focal_length)?;
        let camera = Camera::new(start_focal_length, dimensions.frame_size, &pose);
        start.extend(pose);
        for corners in &view.deck_corners {
            let pose = estimate_deck_pose(&camera, corners, dimensions.deck_height)?;
            deck_poses.extend(pose);
        }
    }
    start.extend(deck_poses);
    let model = |parameters: &[f64]| compute_residuals(parameters, views, dimensions, true);
    least_squares::fit(&start, model)
}
