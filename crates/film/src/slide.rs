//! The friction of the robot's pads, measured on a board that is tilted until the robot slides.
//!
//! The camera stands still, and the board with the strips is lifted at one end. In the first second the board is
//! level, so its normal in the camera's axes is the vertical. In every later picture, the camera's pose relative to
//! the board gives the tilt. The tangent of the tilt at which the robot begins to slide is the coefficient of static
//! friction. The acceleration of the slide, `g (sin tilt - friction cos tilt)`, then gives the coefficient of sliding
//! friction, which the contact model uses.

use lizard_contact::GRAVITY;
use nalgebra::Vector3;

use crate::analysed_film::AnalysedFilm;
use crate::figure::Figure;
use crate::least_squares;
use crate::mean::small_sample_factor;
use crate::path::PathPoint;

/// Time at the beginning of the film during which the board is level, s.
const LEVEL_SECONDS: f64 = 1.0;
/// Largest tilt of the board in that time, relative to its mean direction, deg.
const MAX_LEVEL_TILT: f64 = 1.0;
/// Standard error of the vertical found while the board is level, deg.
const LEVEL_SIGMA: f64 = 0.3;
/// Standard error of a tilt found by the camera, deg.
const TILT_SIGMA: f64 = 0.2;
/// Smallest displacement that counts as a slide, mm.
const MIN_SLIDE: f64 = 15.0;
/// Range of displacements to which the sliding friction is fitted, mm.
const FIT_RANGE: [f64; 2] = [1.0, 60.0];
/// Smallest number of pictures of a slide.
const MIN_PICTURES: usize = 6;
/// Largest angle between the slide and the downhill direction, and between the robot and that direction, deg.
const MAX_DIRECTION_ERROR: f64 = 30.0;
/// Largest rate at which the board is lifted, deg/s.
const MAX_LIFT_RATE: f64 = 15.0;
/// Half of the time over which a picture's tilt is smoothed, s.
const HALF_AVERAGING_TIME: f64 = 0.15;

/// A reason why a film of a tilted board cannot be measured.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SlideTrouble {
    /// The board does not rest at the beginning.
    #[error(
        "the board tilts by {angle:.1} deg in the first second: begin the film with the board level and at rest"
    )]
    NotAtRest {
        /// Change of the board's tilt, deg.
        angle: f64,
    },
    /// The robot does not slide.
    #[error(
        "the robot did not slide: {distance:.1} mm at a tilt of up to {tilt:.1} deg; lift the board farther, and keep the \
         camera where it is"
    )]
    NoSlide {
        /// Largest distance from the place of rest, mm.
        distance: f64,
        /// Largest tilt, deg.
        tilt: f64,
    },
    /// The robot does not slide downhill.
    #[error(
        "the robot slides {angle:.0} deg away from the downhill direction: was it pushed, or did the camera move instead of \
         the board?"
    )]
    NotDownhill {
        /// Angle between the slide and the downhill direction, deg.
        angle: f64,
    },
    /// The robot lies across the slope.
    #[error(
        "the robot's head points {angle:.0} deg away from the downhill direction: put its head straight uphill or downhill"
    )]
    AcrossSlope {
        /// Angle between the robot's forward direction and the downhill direction, deg.
        angle: f64,
    },
    /// The board is lifted too fast.
    #[error("the board is lifted at {rate:.0} deg/s as the robot begins to slide: lift it slowly")]
    LiftedTooFast {
        /// Rate of the tilt, deg/s.
        rate: f64,
    },
    /// The film has too few pictures of the slide.
    #[error(
        "the slide is in only {picture_count} pictures: film more pictures a second, in more light"
    )]
    TooFewPictures {
        /// Number of pictures.
        picture_count: usize,
    },
}

/// A measured slide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slide {
    /// True if the robot slides head first.
    pub is_head_first: bool,
    /// Time at which the slide begins, s.
    pub begin_seconds: f64,
    /// Tilt of the board at that time, deg.
    pub tilt: Figure,
    /// Coefficient of static friction.
    pub static_friction: Figure,
    /// Coefficient of friction while the robot slides.
    pub sliding_friction: Figure,
}

/// The values of one picture.
struct Observation {
    /// Time of the picture, s.
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

/// A point of a slide.
struct SlidePoint {
    /// Time of the picture, s.
    seconds: f64,
    /// Smoothed tilt of the board, rad.
    tilt: f64,
    /// Distance of the robot from its place of rest, mm.
    distance: f64,
}

impl Slide {
    /// Measures the first slide of a film.
    ///
    /// # Errors
    /// Fails if the film does not show a robot that slides down a board.
    pub fn of(film: &AnalysedFilm) -> Result<Self, SlideTrouble> {
        let cameras: Vec<_> = film.frame_cameras().collect();
        let first_seconds = film.path.first().map_or(0.0, |point| point.seconds);
        let is_level = |point: &PathPoint| point.seconds < first_seconds + LEVEL_SECONDS;
        let level_count = film.path.iter().take_while(|point| is_level(point)).count();
        let up_directions = cameras[..level_count]
            .iter()
            .map(|camera| camera.up_direction());
        let vertical = up_directions.sum::<Vector3<f64>>().normalize();
        let observations: Vec<Observation> = film
            .path
            .iter()
            .zip(&cameras)
            .map(|(point, camera)| {
                let up_direction = camera.to_floor_axes(&vertical);
                Observation {
                    seconds: point.seconds,
                    tilt: up_direction.x.hypot(up_direction.y).atan2(up_direction.z),
                    downhill: [-up_direction.x, -up_direction.y],
                    position: [point.place.forward, point.place.left],
                    heading: point.place.heading,
                }
            })
            .collect();
        let max_tilt = |observations: &[Observation]| {
            observations
                .iter()
                .map(|observation| observation.tilt)
                .fold(0.0, f64::max)
        };
        let angle = max_tilt(&observations[..level_count]).to_degrees();
        if angle > MAX_LEVEL_TILT {
            return Err(SlideTrouble::NotAtRest { angle });
        }
        let rest_position = mean_position(&observations[..level_count]);
        let distance_of = |observation: &Observation| {
            (observation.position[0] - rest_position[0])
                .hypot(observation.position[1] - rest_position[1])
        };
        let Some(sliding_index) = observations
            .iter()
            .position(|observation| distance_of(observation) > MIN_SLIDE)
        else {
            return Err(SlideTrouble::NoSlide {
                distance: observations.iter().map(distance_of).fold(0.0, f64::max),
                tilt: max_tilt(&observations).to_degrees(),
            });
        };
        let first_index = observations[..sliding_index]
            .iter()
            .rposition(|observation| distance_of(observation) < FIT_RANGE[0]);
        let first_index = first_index.map_or(0, |index| index + 1);
        let displacement =
            [0, 1].map(|i| observations[sliding_index].position[i] - rest_position[i]);
        check_directions(&observations[sliding_index], displacement)?;
        let slide_distance = displacement[0].hypot(displacement[1]);
        let distance_along = |observation: &Observation| {
            (0..2)
                .map(|i| (observation.position[i] - rest_position[i]) * displacement[i])
                .sum::<f64>()
                / slide_distance
        };
        let smoothed_tilts = smooth_tilts(&observations);
        // The slide ends when it is long enough or when something stops it.
        let mut last_index = sliding_index;
        let speed_at = |i: usize| {
            (distance_along(&observations[i]) - distance_along(&observations[i - 1]))
                / (observations[i].seconds - observations[i - 1].seconds)
        };
        while last_index + 1 < observations.len()
            && distance_along(&observations[last_index]) < FIT_RANGE[1]
            && speed_at(last_index + 1) > 0.8 * speed_at(last_index)
        {
            last_index += 1;
        }
        let points: Vec<SlidePoint> = (first_index..=last_index)
            .map(|i| SlidePoint {
                seconds: observations[i].seconds,
                tilt: smoothed_tilts[i],
                distance: distance_along(&observations[i]),
            })
            .collect();
        let sliding_friction = fit_sliding(&points)?;
        let (begin_seconds, begin_error) = extrapolate_begin(
            &points,
            sliding_friction.value,
            observations[first_index.max(1) - 1].seconds,
        );
        let index_near = |seconds: f64| {
            let index = observations.partition_point(|observation| observation.seconds < seconds);
            index.min(observations.len() - 1)
        };
        let (begin_index, earlier_index) = (
            index_near(begin_seconds),
            index_near(begin_seconds - 2.0 * HALF_AVERAGING_TIME).saturating_sub(1),
        );
        let tilt = smoothed_tilts[begin_index].to_degrees();
        let interval = observations[begin_index].seconds - observations[earlier_index].seconds;
        let rate =
            (tilt - smoothed_tilts[earlier_index].to_degrees()) / interval.max(HALF_AVERAGING_TIME);
        if rate > MAX_LIFT_RATE {
            return Err(SlideTrouble::LiftedTooFast { rate });
        }
        let angle_error = LEVEL_SIGMA.hypot(TILT_SIGMA);
        let tilt = Figure {
            value: tilt,
            error: angle_error.hypot(rate * begin_error),
        };
        let static_friction = tilt.value.to_radians().tan();
        let tan_derivative = 1.0 + static_friction * static_friction;
        Ok(Self {
            is_head_first: angle_between(
                observations[sliding_index].heading,
                observations[sliding_index].downhill,
            ) < 90.0,
            begin_seconds,
            tilt,
            static_friction: Figure {
                value: static_friction,
                error: tan_derivative * tilt.error.to_radians(),
            },
            sliding_friction: Figure {
                value: sliding_friction.value,
                error: sliding_friction
                    .error
                    .hypot(tan_derivative * angle_error.to_radians()),
            },
        })
    }
}

/// Checks that the robot slides downhill, head first or tail first.
fn check_directions(observation: &Observation, displacement: [f64; 2]) -> Result<(), SlideTrouble> {
    let slide_angle = angle_between(displacement[1].atan2(displacement[0]), observation.downhill);
    if slide_angle > MAX_DIRECTION_ERROR {
        return Err(SlideTrouble::NotDownhill { angle: slide_angle });
    }
    let head_angle = angle_between(observation.heading, observation.downhill);
    match head_angle.min(180.0 - head_angle) > MAX_DIRECTION_ERROR {
        true => Err(SlideTrouble::AcrossSlope { angle: head_angle }),
        false => Ok(()),
    }
}

/// The unsigned angle between a heading, rad, and a direction, deg.
fn angle_between(heading: f64, [x, y]: [f64; 2]) -> f64 {
    let (sin, cos) = (heading - y.atan2(x)).sin_cos();
    sin.atan2(cos).to_degrees().abs()
}

/// The mean position of the robot on the board, mm.
fn mean_position(observations: &[Observation]) -> [f64; 2] {
    [0, 1].map(|i| {
        observations
            .iter()
            .map(|observation| observation.position[i])
            .sum::<f64>()
            / observations.len() as f64
    })
}

/// Computes the tilt in each picture, rad, from a straight line fitted to the pictures around it.
fn smooth_tilts(observations: &[Observation]) -> Vec<f64> {
    let index_at =
        |seconds: f64| observations.partition_point(|observation| observation.seconds < seconds);
    let tilt_at = |observation: &Observation| {
        let nearby = &observations[index_at(observation.seconds - HALF_AVERAGING_TIME)
            ..index_at(observation.seconds + HALF_AVERAGING_TIME)];
        let count = nearby.len() as f64;
        let (mut mean_time, mut mean_tilt) = (0.0, 0.0);
        for neighbour in nearby {
            mean_time += (neighbour.seconds - observation.seconds) / count;
            mean_tilt += neighbour.tilt / count;
        }
        let (mut products, mut squares) = (0.0, 1e-12);
        for neighbour in nearby {
            let offset = neighbour.seconds - observation.seconds - mean_time;
            products += offset * (neighbour.tilt - mean_tilt);
            squares += offset * offset;
        }
        mean_tilt - mean_time * products / squares
    };
    observations.iter().map(tilt_at).collect()
}

/// Fits the coefficient of sliding friction to the points of a slide.
fn fit_sliding(points: &[SlidePoint]) -> Result<Figure, SlideTrouble> {
    let too_few_pictures = SlideTrouble::TooFewPictures {
        picture_count: points.len(),
    };
    if points.len() < MIN_PICTURES {
        return Err(too_few_pictures);
    }
    // The distances without friction, and the distances by which a coefficient of friction of 1 would reduce them. The
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
    let model = |parameters: &[f64]| -> Vec<f64> {
        let residual_of =
            |(point, [frictionless_distance, friction_distance]): (&SlidePoint, &[f64; 2])| {
                parameters[0]
                    + parameters[1] * 100.0 * (point.seconds - first_seconds)
                    + frictionless_distance
                    - parameters[2] * friction_distance
                    - point.distance
            };
        points.iter().zip(&distances).map(residual_of).collect()
    };
    let fit = least_squares::fit(&[points[0].distance, 0.0, points[0].tilt.tan()], model)
        .ok_or(too_few_pictures)?;
    let degrees_of_freedom = points.len() - 3;
    let variance = fit.sum_of_squares / degrees_of_freedom as f64 * fit.covariance[(2, 2)];
    Ok(Figure {
        value: fit.parameters[2],
        error: small_sample_factor(degrees_of_freedom) * variance.sqrt(),
    })
}

/// Extrapolates the time at which a slide begins, s, backward from the first picture that shows a movement, and returns
/// it with its standard error, s. `previous_seconds` is the time of the picture before that one.
fn extrapolate_begin(points: &[SlidePoint], friction: f64, previous_seconds: f64) -> (f64, f64) {
    let SlidePoint {
        seconds,
        tilt,
        distance,
    } = points[0];
    let acceleration = 1000.0 * GRAVITY * (tilt.sin() - friction * tilt.cos());
    let elapsed_seconds = (2.0 * distance / acceleration.max(1.0)).sqrt();
    let gap = seconds - previous_seconds;
    let begin = (seconds - elapsed_seconds).max(previous_seconds - gap - 1.0);
    // If the acceleration grows from zero, the slide began earlier, so half of `elapsed_seconds` counts as error.
    (begin, (gap / 2.0).hypot(elapsed_seconds / 2.0))
}
