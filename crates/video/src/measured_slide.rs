//! The friction of the robot's pads, measured on a board that is tilted until the robot slides.
//!
//! The camera stands still, and the board with the strips is lifted at one end. In the first second the board is
//! level, so its normal in the camera's axes is vertical. In every later frame, the camera's pose relative to the board
//! gives the tilt. The coefficient of static friction is the tangent of the tilt at which the robot begins to slide.
//! The acceleration of the slide, `g (sin tilt - friction cos tilt)`, then gives the coefficient of sliding friction,
//! which the contact model uses.

use lizard_contact::GRAVITY;
use nalgebra::Vector3;

use crate::analysed_video::AnalysedVideo;
use crate::camera::Camera;
use crate::estimate::Estimate;
use crate::frame_tags::FrameTags;
use crate::least_squares;
use crate::mean::{self, small_sample_factor};
use crate::path::PathPoint;

/// Time at the start of the video during which the board is level, s.
const LEVEL_SECONDS: f64 = 1.0;
/// Largest tilt of the board while it should be level, relative to its mean direction, deg.
const MAX_LEVEL_TILT: f64 = 1.0;
/// Standard error of the vertical direction, measured while the board is level, deg.
const LEVEL_SIGMA: f64 = 0.3;
/// Standard error of a tilt due to the camera, deg.
const TILT_SIGMA: f64 = 0.2;
/// Smallest displacement that counts as a slide, mm.
const MIN_SLIDE: f64 = 15.0;
/// Range of the displacements from which the sliding friction is computed, mm.
const FIT_RANGE: [f64; 2] = [1.0, 60.0];
/// Smallest number of frames of a slide.
const MIN_FRAMES: usize = 6;
/// Largest angle between the slide or the robot and the downhill direction, deg.
const MAX_DIRECTION_ERROR: f64 = 30.0;
/// Largest rate at which the board is lifted, deg/s.
const MAX_LIFT_RATE: f64 = 15.0;
/// Half of the time over which a frame's tilt is smoothed, s.
const HALF_AVERAGING_TIME: f64 = 0.15;

/// A reason why a video of a tilted board cannot be measured.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SlideError {
    /// The board does not rest at the start of the video.
    #[error(
        "the board tilts by {angle:.1} deg in the first second: start the video with the board level and at rest"
    )]
    NotAtRest {
        /// Change of the board's tilt, deg.
        angle: f64,
    },
    /// The robot does not slide.
    #[error(
        "the robot slid by only {distance:.1} mm at a tilt of up to {tilt:.1} deg: lift the board farther, and do not \
         move the camera"
    )]
    NoSlide {
        /// Largest distance from the initial position, mm.
        distance: f64,
        /// Largest tilt, deg.
        tilt: f64,
    },
    /// The robot does not slide downhill.
    #[error(
        "the robot slides {angle:.0} deg away from the downhill direction: was it pushed, or did the camera move \
         instead of the board?"
    )]
    NotDownhill {
        /// Angle between the slide and the downhill direction, deg.
        angle: f64,
    },
    /// The robot lies across the slope.
    #[error(
        "the robot's head points {angle:.0} deg away from the downhill direction: point it straight uphill or downhill"
    )]
    AcrossSlope {
        /// Angle between the robot's forward direction and the downhill direction, deg.
        angle: f64,
    },
    /// The board is lifted too fast.
    #[error(
        "the board is lifted at {rate:.0} deg/s when the robot begins to slide: lift it at {MAX_LIFT_RATE} deg/s or \
         less"
    )]
    LiftedTooFast {
        /// Rate of the tilt, deg/s.
        rate: f64,
    },
    /// The video has too few frames of the slide.
    #[error(
        "only {frame_count} frames show the slide: record more frames per second, in more light"
    )]
    TooFewFrames {
        /// Number of frames.
        frame_count: usize,
    },
}

/// A measured slide and the friction coefficients that follow from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredSlide {
    /// True if the robot slides head first.
    pub is_head_first: bool,
    /// Time at which the slide begins, s.
    pub begin_seconds: f64,
    /// Tilt of the board when the slide begins, deg.
    pub tilt: Estimate,
    /// Coefficient of static friction.
    pub static_friction: Estimate,
    /// Coefficient of sliding friction.
    pub sliding_friction: Estimate,
}

/// The board and the robot in one frame.
struct Observation {
    /// Time of the frame, s.
    seconds: f64,
    /// Tilt of the board, rad.
    tilt: f64,
    /// Downhill direction on the board; its length is the sine of the tilt.
    downhill: [f64; 2],
    /// Position of the robot on the board, mm.
    position: [f64; 2],
    /// Heading of the robot on the board, rad.
    heading: f64,
}

/// The board's tilt and the robot's position along its slide, in one frame.
struct SlidePoint {
    /// Time of the frame, s.
    seconds: f64,
    /// Smoothed tilt of the board, rad.
    tilt: f64,
    /// Distance of the robot from its initial position, mm.
    distance: f64,
}

impl MeasuredSlide {
    /// Measures the first slide of a video.
    ///
    /// # Errors
    /// Fails if the video does not show a robot that slides down a board.
    pub fn from_video(video: &AnalysedVideo) -> Result<Self, SlideError> {
        let find_camera = |frame: &FrameTags| frame.find_camera(&video.scene);
        let cameras: Vec<Camera> = video.frames.iter().filter_map(find_camera).collect();
        let first_seconds = video.path.first().map_or(0.0, |point| point.seconds);
        let is_level = |point: &&PathPoint| point.seconds < first_seconds + LEVEL_SECONDS;
        let level_count = video.path.iter().take_while(is_level).count();
        let level_cameras = cameras[..level_count].iter();
        let up_directions = level_cameras.map(|camera| camera.up_direction());
        let vertical = up_directions.sum::<Vector3<f64>>().normalize();
        let observe = |(point, camera): (&PathPoint, &Camera)| {
            let up_direction = camera.to_floor_axes(&vertical);
            Observation {
                seconds: point.seconds,
                tilt: up_direction.x.hypot(up_direction.y).atan2(up_direction.z),
                downhill: [-up_direction.x, -up_direction.y],
                position: [point.pose.forward, point.pose.left],
                heading: point.pose.heading,
            }
        };
        let pairs = video.path.iter().zip(&cameras);
        let observations: Vec<Observation> = pairs.map(observe).collect();
        let max_tilt = |observations: &[Observation]| {
            let tilts = observations.iter().map(|observation| observation.tilt);
            tilts.fold(0.0, f64::max)
        };
        let angle = max_tilt(&observations[..level_count]).to_degrees();
        if angle > MAX_LEVEL_TILT {
            return Err(SlideError::NotAtRest { angle });
        }
        let rest_position = [0, 1].map(|i| {
            let positions = observations[..level_count].iter();
            let coordinates = positions.map(|observation| observation.position[i]);
            // The median, because somebody may still touch the robot.
            mean::median(coordinates.collect()).unwrap_or_default()
        });
        let distance = |observation: &Observation| {
            (observation.position[0] - rest_position[0])
                .hypot(observation.position[1] - rest_position[1])
        };
        let has_slid = |observation: &Observation| distance(observation) > MIN_SLIDE;
        let later = &observations[level_count..];
        let Some(later_index) = later.iter().position(has_slid) else {
            let distance = later.iter().map(distance).fold(0.0, f64::max);
            let tilt = max_tilt(&observations).to_degrees();
            return Err(SlideError::NoSlide { distance, tilt });
        };
        let sliding_index = level_count + later_index;
        let has_rested = |observation: &Observation| distance(observation) < FIT_RANGE[0];
        let last_rest = observations[..sliding_index].iter().rposition(has_rested);
        let first_index = last_rest.map_or(0, |index| index + 1);
        let sliding = &observations[sliding_index];
        let displacement = [0, 1].map(|i| sliding.position[i] - rest_position[i]);
        check_directions(sliding, displacement)?;
        let slide_distance = displacement[0].hypot(displacement[1]);
        let to_slide_point = |observation: &Observation| {
            let product = |i: usize| (observation.position[i] - rest_position[i]) * displacement[i];
            SlidePoint {
                seconds: observation.seconds,
                tilt: smooth_tilt(&observations, observation.seconds),
                distance: (0..2).map(product).sum::<f64>() / slide_distance,
            }
        };
        let points: Vec<SlidePoint> = observations.iter().map(to_slide_point).collect();
        // The slide ends when it is long enough or when something stops the robot.
        let mut last_index = sliding_index;
        let speed_at = |i: usize| {
            (points[i].distance - points[i - 1].distance)
                / (points[i].seconds - points[i - 1].seconds)
        };
        while last_index + 1 < points.len()
            && points[last_index].distance < FIT_RANGE[1]
            && speed_at(last_index + 1) > 0.8 * speed_at(last_index)
        {
            last_index += 1;
        }
        let slide = &points[first_index..=last_index];
        let sliding_friction = fit_sliding(slide)?;
        let previous_seconds = points[first_index.max(1) - 1].seconds;
        let (begin_seconds, begin_error) =
            extrapolate_begin(&slide[0], sliding_friction.value, previous_seconds);
        let index_near = |seconds: f64| {
            let index = points.partition_point(|point| point.seconds < seconds);
            index.min(points.len() - 1)
        };
        let begin = &points[index_near(begin_seconds)];
        let earlier_index = index_near(begin_seconds - 2.0 * HALF_AVERAGING_TIME);
        let earlier = &points[earlier_index.saturating_sub(1)];
        let tilt = begin.tilt.to_degrees();
        let interval = begin.seconds - earlier.seconds;
        let rate = (tilt - earlier.tilt.to_degrees()) / interval.max(HALF_AVERAGING_TIME);
        if rate > MAX_LIFT_RATE {
            return Err(SlideError::LiftedTooFast { rate });
        }
        let angle_error = LEVEL_SIGMA.hypot(TILT_SIGMA);
        let tilt = Estimate::new(tilt, angle_error.hypot(rate * begin_error));
        let static_friction = tilt.value.to_radians().tan();
        let tan_derivative = 1.0 + static_friction * static_friction;
        let static_error = tan_derivative * tilt.standard_error.to_radians();
        let tilt_error = tan_derivative * angle_error.to_radians();
        let sliding_error = sliding_friction.standard_error.hypot(tilt_error);
        Ok(Self {
            is_head_first: angle_between(sliding.heading, sliding.downhill) < 90.0,
            begin_seconds,
            tilt,
            static_friction: Estimate::new(static_friction, static_error),
            sliding_friction: Estimate::new(sliding_friction.value, sliding_error),
        })
    }
}

/// Checks that the robot slides downhill, head first or tail first.
fn check_directions(observation: &Observation, displacement: [f64; 2]) -> Result<(), SlideError> {
    let slide_angle = angle_between(displacement[1].atan2(displacement[0]), observation.downhill);
    if slide_angle > MAX_DIRECTION_ERROR {
        return Err(SlideError::NotDownhill { angle: slide_angle });
    }
    let head_angle = angle_between(observation.heading, observation.downhill);
    match head_angle.min(180.0 - head_angle) > MAX_DIRECTION_ERROR {
        true => Err(SlideError::AcrossSlope { angle: head_angle }),
        false => Ok(()),
    }
}

/// Returns the unsigned angle between a heading, rad, and a direction vector, deg.
fn angle_between(heading: f64, [x, y]: [f64; 2]) -> f64 {
    let (sin, cos) = (heading - y.atan2(x)).sin_cos();
    sin.atan2(cos).to_degrees().abs()
}

/// Computes the tilt at a time, rad, from a straight line fitted to the frames around it.
fn smooth_tilt(observations: &[Observation], seconds: f64) -> f64 {
    let [begin, end] = [-HALF_AVERAGING_TIME, HALF_AVERAGING_TIME]
        .map(|shift| observations.partition_point(|frame| frame.seconds < seconds + shift));
    let nearby = &observations[begin..end];
    let count = nearby.len() as f64;
    let (mut mean_time, mut mean_tilt) = (0.0, 0.0);
    for neighbour in nearby {
        mean_time += (neighbour.seconds - seconds) / count;
        mean_tilt += neighbour.tilt / count;
    }
    let (mut products, mut squares) = (0.0, 1e-12);
    for neighbour in nearby {
        let offset = neighbour.seconds - seconds - mean_time;
        products += offset * (neighbour.tilt - mean_tilt);
        squares += offset * offset;
    }
    mean_tilt - mean_time * products / squares
}

/// Fits the coefficient of sliding friction to the points of a slide.
fn fit_sliding(points: &[SlidePoint]) -> Result<Estimate, SlideError> {
    let frame_count = points.len();
    let too_few_frames = SlideError::TooFewFrames { frame_count };
    if frame_count < MIN_FRAMES {
        return Err(too_few_frames);
    }
    // The distances without friction, and the amounts by which a friction coefficient of 1 would reduce them. The
    // acceleration is integrated by the trapezoidal rule.
    let mut distances = vec![[0.0; 2]];
    let mut speeds = [0.0; 2];
    for pair in points.windows(2) {
        let interval = pair[1].seconds - pair[0].seconds;
        let previous = distances[distances.len() - 1];
        let functions: [fn(f64) -> f64; 2] = [f64::sin, f64::cos];
        let next = [0, 1].map(|i| {
            let mean = (functions[i](pair[0].tilt) + functions[i](pair[1].tilt)) / 2.0;
            let speed_gain = 1000.0 * GRAVITY * mean * interval;
            let distance = previous[i] + (speeds[i] + speed_gain / 2.0) * interval;
            speeds[i] += speed_gain;
            distance
        });
        distances.push(next);
    }
    let first_seconds = points[0].seconds;
    // The parameters: the first point's distance, mm, and its speed in units of 100 mm/s; the friction coefficient.
    let model = |parameters: &[f64]| -> Vec<f64> {
        let residual =
            |(point, [frictionless_distance, friction_distance]): (&SlidePoint, &[f64; 2])| {
                parameters[0]
                    + parameters[1] * 100.0 * (point.seconds - first_seconds)
                    + frictionless_distance
                    - parameters[2] * friction_distance
                    - point.distance
            };
        points.iter().zip(&distances).map(residual).collect()
    };
    let fit = least_squares::fit(&[points[0].distance, 0.0, points[0].tilt.tan()], model)
        .ok_or(too_few_frames)?;
    let degrees_of_freedom = frame_count - 3;
    let variance = fit.sum_of_squares / degrees_of_freedom as f64 * fit.covariance[(2, 2)];
    let standard_error = small_sample_factor(degrees_of_freedom) * variance.sqrt();
    Ok(Estimate::new(fit.parameters[2], standard_error))
}

/// Extrapolates the start of a slide backward from the first frame that shows a movement. Returns the time of the start
/// and its standard error, s. `previous_seconds` is the time of the frame before the movement.
fn extrapolate_begin(first: &SlidePoint, friction: f64, previous_seconds: f64) -> (f64, f64) {
    let acceleration = 1000.0 * GRAVITY * (first.tilt.sin() - friction * first.tilt.cos());
    let elapsed_seconds = (2.0 * first.distance / acceleration.max(1.0)).sqrt();
    let gap = first.seconds - previous_seconds;
    let begin = (first.seconds - elapsed_seconds).max(previous_seconds - gap - 1.0);
    // If the acceleration grows from zero, the slide began earlier, so half of `elapsed_seconds` counts as error.
    (begin, (gap / 2.0).hypot(elapsed_seconds / 2.0))
}
