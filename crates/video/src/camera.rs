//! The camera model: maps points on and above the floor to points of the frame.
//!
//! The model is a pinhole camera with square pixels, whose axis passes through the centre of the frame. Phones
//! correct their lens distortion to some tenths of a percent; the rest appears in the residuals of the fit.

use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::frame::Pixel;
use crate::homography::Homography;

/// Position and direction of a camera: the rotation vector from the floor's axes to the camera's axes, rad, and the
/// floor's origin in the camera's axes, mm.
pub(crate) type CameraPose = [f64; 6];

/// A camera model with its pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Camera {
    /// Focal length, px.
    focal_length: f64,
    /// The point of the frame through which the camera's axis passes.
    principal_point: Pixel,
    /// Rotation from the floor's axes to the camera's axes.
    rotation: Matrix3<f64>,
    /// The floor's origin in the camera's axes, mm.
    translation: Vector3<f64>,
}

impl Camera {
    /// Creates a camera from its focal length, px, the width and height of its frames, px, and its pose.
    pub(crate) fn new(focal_length: f64, frame_size: [usize; 2], pose: &[f64]) -> Self {
        Self {
            focal_length,
            principal_point: principal_point(frame_size),
            rotation: Rotation3::new(Vector3::new(pose[0], pose[1], pose[2])).into_inner(),
            translation: Vector3::new(pose[3], pose[4], pose[5]),
        }
    }

    /// Returns the image of a point: x and y along the floor and z up from it, mm.
    pub(crate) fn project(&self, [x, y]: [f64; 2], z: f64) -> Pixel {
        let in_camera = self.rotation * Vector3::new(x, y, z) + self.translation;
        [
            self.principal_point[0] + self.focal_length * in_camera.x / in_camera.z,
            self.principal_point[1] + self.focal_length * in_camera.y / in_camera.z,
        ]
    }

    /// Returns the direction away from the floor, in the camera's axes: right, down, forward.
    pub(crate) fn up_direction(&self) -> Vector3<f64> {
        self.rotation.column(2).into_owned()
    }

    /// Converts a direction from the camera's axes to the floor's axes.
    pub(crate) fn to_floor_axes(self, direction: &Vector3<f64>) -> Vector3<f64> {
        self.rotation.tr_mul(direction)
    }

    /// Returns the camera's height above the floor, mm, and its tilt from straight down, deg.
    pub(crate) fn height_and_tilt(&self) -> [f64; 2] {
        let position = -(self.rotation.transpose() * self.translation);
        let cos_tilt = -self.rotation[(2, 2)];
        [position.z, cos_tilt.clamp(-1.0, 1.0).acos().to_degrees()]
    }
}

/// Returns the principal point, which is the centre of a frame.
fn principal_point(frame_size: [usize; 2]) -> Pixel {
    frame_size.map(|length| (length as f64 - 1.0) / 2.0)
}

/// Returns the pose of a camera whose image of the floor has this homography; `None` if the homography is degenerate.
pub(crate) fn camera_pose_from_homography(
    homography: &Homography,
    focal_length: f64,
    frame_size: [usize; 2],
) -> Option<CameraPose> {
    let [cx, cy] = principal_point(frame_size);
    let calibration = Matrix3::new(focal_length, 0.0, cx, 0.0, focal_length, cy, 0.0, 0.0, 1.0);
    let columns = calibration.try_inverse()? * homography.0;
    let (first, second, third) = (columns.column(0), columns.column(1), columns.column(2));
    let mut scale = 2.0 / (first.norm() + second.norm());
    if third.z < 0.0 {
        // The floor must be in front of the camera.
        scale = -scale;
    }
    let x = (first * scale).normalize();
    let y = second * scale;
    let y = (y - x * x.dot(&y)).normalize();
    let rotation = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    let rotation_vector = Rotation3::from_matrix_unchecked(rotation).scaled_axis();
    let translation = third * scale;
    let mut pose = CameraPose::default();
    pose[..3].copy_from_slice(rotation_vector.as_slice());
    pose[3..].copy_from_slice(translation.as_slice());
    pose.iter().all(|value| value.is_finite()).then_some(pose)
}
