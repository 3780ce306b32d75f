//! The friction of the robot's pads, measured on a board that is tilted until the robot slides.
//!
//! The camera stands still, and the board with the strips is lifted at one end. In the first second the board is
//! level, so its normal in the camera's frame is the vertical. In every later picture, the camera's pose relative to
//! the board gives the tilt. A robot that begins to slide shows its static friction, the tangent of the tilt. Its
//! acceleration then shows the friction of sliding pads, which the contact model uses: it is
//! `g (sin tilt - friction cos tilt)`.

use lizard_contact::GRAVITY;
use nalgebra::Vector3;

use crate::figure::Figure;
use crate::least;
use crate::mean::widening;
use crate::path::PathPoint;
use crate::watched::AnalysedFilm;

/// Time at the beginning during which the board is level, s.
const LEVEL_SECONDS: f64 = 1.0;
/// Largest tilt of the board in that time, relative to its mean, deg.
const MAX_LEVEL_TILT: f64 = 1.0;
/// Standard error of the vertical found while the board is level, deg.
const LEVEL_SIGMA: f64 = 0.3;
/// Standard error of a tilt found by the camera, deg.
const TILT_SIGMA: f64 = 0.2;
/// Smallest displacement that counts as a slide, mm.
const MIN_SLIDE: f64 = 15.0;
/// Range of displacements from which the friction is found, mm.
const SLIDE_RANGE: [f64; 2] = [1.0, 60.0];
/// Smallest number of pictures of a slide.
const MIN_PICTURES: usize = 6;
/// Largest angle between the slide and the downhill direction, and between the robot and that direction, deg.
const MAX_ASIDE: f64 = 30.0;
/// Largest rate at which the board is lifted, deg/s.
const MAX_LIFT_RATE: f64 = 15.0;
/// Half of the time over which a picture's tilt is averaged, s.
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
        "the robot did not slide: {slid:.1} mm at a tilt of up to {tilt:.1} deg; lift the board farther, and keep the \
         camera where it is"
    )]
    NotSlid {
        /// Largest distance, mm.
        slid: f64,
        /// Largest tilt, deg.
        tilt: f64,
    },
    /// The robot does not slide downhill.
    #[error(
        "the robot slides {aside:.0} deg beside the way down: was it pushed, or the camera moved instead of the board?"
    )]
    NotDown {
        /// Angle between the slide and the downhill direction, deg.
        aside: f64,
    },
    /// The robot lies across the slope.
    #[error(
        "the robot's head shows {aside:.0} deg away from the way down: put its head straight uphill or downhill"
    )]
    Across {
        /// Angle between the robot's forward direction and the downhill direction, deg.
        aside: f64,
    },
    /// The board is lifted too fast.
    #[error("the board is lifted at {rate:.0} deg/s as the robot begins to slide: lift it slowly")]
    Fast {
        /// Rate of the tilt, deg/s.
        rate: f64,
    },
    /// Too few pictures of the slide.
    #[error("the slide is in {pictures} pictures only: film more pictures a second, in more light")]
    FewPictures {
        /// Number of pictures.
        pictures: usize,
    },
}

/// A measured slide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slide {
    /// True if the robot slides head first.
    pub is_head_first: bool,
    /// Time at which the slide begins, s.
    pub begin: f64,
    /// Tilt at that time, deg.
    pub tilt: Figure,
    /// Coefficient of static friction.
    pub resting: Figure,
    /// Coefficient of friction while the robot slides.
    pub sliding: Figure,
}

/// The values of one picture: time in s, tilt in rad, downhill direction on the board, the robot's place on it in mm,
/// and its heading in rad.
struct Moment {
    seconds: f64,
    tilt: f64,
    down: [f64; 2],
    at: [f64; 2],
    heading: f64,
}

impl Slide {
    /// Measures the first slide of a film.
    ///
    /// # Errors
    /// Fails if the film does not show a robot that slides down a board.
    pub fn of(film: &AnalysedFilm) -> Result<Self, SlideTrouble> {
        let cameras: Vec<_> = film.cameras().collect();
        let first = film.path.first().map_or(0.0, |point| point.seconds);
        let is_level = |point: &PathPoint| point.seconds < first + LEVEL_SECONDS;
        let level = film.path.iter().take_while(|point| is_level(point)).count();
        let up_directions = cameras[..level].iter().map(|camera| camera.up());
        let vertical = up_directions.sum::<Vector3<f64>>().normalize();
        let moments: Vec<Moment> = film
            .path
            .iter()
            .zip(&cameras)
            .map(|(point, camera)| {
                let up_direction = camera.on_floor(&vertical);
                Moment {
                    seconds: point.seconds,
                    tilt: up_direction.x.hypot(up_direction.y).atan2(up_direction.z),
                    down: [-up_direction.x, -up_direction.y],
                    at: [point.place.forward, point.place.left],
                    heading: point.place.heading,
                }
            })
            .collect();
        let largest_tilt =
            |moments: &[Moment]| moments.iter().map(|moment| moment.tilt).fold(0.0, f64::max);
        let angle = largest_tilt(&moments[..level]).to_degrees();
        if angle > MAX_LEVEL_TILT {
            return Err(SlideTrouble::NotAtRest { angle });
        }
        let rest_place = mean_position(&moments[..level]);
        let distance_of =
            |moment: &Moment| (moment.at[0] - rest_place[0]).hypot(moment.at[1] - rest_place[1]);
        let Some(slid_index) = moments
            .iter()
            .position(|moment| distance_of(moment) > MIN_SLIDE)
        else {
            return Err(SlideTrouble::NotSlid {
                slid: moments.iter().map(distance_of).fold(0.0, f64::max),
                tilt: largest_tilt(&moments).to_degrees(),
            });
        };
        let from = moments[..slid_index]
            .iter()
            .rposition(|moment| distance_of(moment) < SLIDE_RANGE[0]);
        let from = from.map_or(0, |index| index + 1);
        let displacement = [0, 1].map(|i| moments[slid_index].at[i] - rest_place[i]);
        check_directions(&moments[slid_index], displacement)?;
        let length = displacement[0].hypot(displacement[1]);
        let distance_along = |moment: &Moment| {
            (0..2)
                .map(|i| (moment.at[i] - rest_place[i]) * displacement[i])
                .sum::<f64>()
                / length
        };
        let tilts = smooth(&moments);
        // The slide ends when it is long enough or when something stops it.
        let mut to = slid_index;
        let speed_at = |i: usize| {
            (distance_along(&moments[i]) - distance_along(&moments[i - 1]))
                / (moments[i].seconds - moments[i - 1].seconds)
        };
        while to + 1 < moments.len()
            && distance_along(&moments[to]) < SLIDE_RANGE[1]
            && speed_at(to + 1) > 0.8 * speed_at(to)
        {
            to += 1;
        }
        let points: Vec<[f64; 3]> = (from..=to)
            .map(|i| [moments[i].seconds, tilts[i], distance_along(&moments[i])])
            .collect();
        let sliding = fit_sliding(&points)?;
        let (begin, error) =
            extrapolate_begin(&points, sliding.value, moments[from.max(1) - 1].seconds);
        let index_near = |seconds: f64| {
            let index = moments.partition_point(|moment| moment.seconds < seconds);
            index.min(moments.len() - 1)
        };
        let (begin_index, earlier_index) = (
            index_near(begin),
            index_near(begin - 2.0 * HALF_AVERAGING_TIME).saturating_sub(1),
        );
        let tilt = tilts[begin_index].to_degrees();
        let interval = moments[begin_index].seconds - moments[earlier_index].seconds;
        let rate = (tilt - tilts[earlier_index].to_degrees()) / interval.max(HALF_AVERAGING_TIME);
        if rate > MAX_LIFT_RATE {
            return Err(SlideTrouble::Fast { rate });
        }
        let angle_error = LEVEL_SIGMA.hypot(TILT_SIGMA);
        let tilt = Figure {
            value: tilt,
            error: angle_error.hypot(rate * error),
        };
        let resting = tilt.value.to_radians().tan();
        let slope = 1.0 + resting * resting;
        Ok(Self {
            is_head_first: angle_between(moments[slid_index].heading, moments[slid_index].down)
                < 90.0,
            begin,
            tilt,
            resting: Figure {
                value: resting,
                error: slope * tilt.error.to_radians(),
            },
            sliding: Figure {
                value: sliding.value,
                error: sliding.error.hypot(slope * angle_error.to_radians()),
            },
        })
    }
}

/// Checks that the robot slides downhill, head first or tail first.
fn check_directions(moment: &Moment, displacement: [f64; 2]) -> Result<(), SlideTrouble> {
    let slide_aside = angle_between(displacement[1].atan2(displacement[0]), moment.down);
    if slide_aside > MAX_ASIDE {
        return Err(SlideTrouble::NotDown { aside: slide_aside });
    }
    let head_aside = angle_between(moment.heading, moment.down);
    match head_aside.min(180.0 - head_aside) > MAX_ASIDE {
        true => Err(SlideTrouble::Across { aside: head_aside }),
        false => Ok(()),
    }
}

/// The unsigned angle between a heading in rad and a direction, deg.
fn angle_between(heading: f64, [x, y]: [f64; 2]) -> f64 {
    let (sin, cos) = (heading - y.atan2(x)).sin_cos();
    sin.atan2(cos).to_degrees().abs()
}

/// The mean position of the robot on the board, mm.
fn mean_position(moments: &[Moment]) -> [f64; 2] {
    [0, 1].map(|i| moments.iter().map(|moment| moment.at[i]).sum::<f64>() / moments.len() as f64)
}

/// The tilt in each picture, rad, by a straight line fitted to the pictures around it.
fn smooth(moments: &[Moment]) -> Vec<f64> {
    let index_at = |seconds: f64| moments.partition_point(|moment| moment.seconds < seconds);
    let tilt_at = |moment: &Moment| {
        let nearby = &moments[index_at(moment.seconds - HALF_AVERAGING_TIME)
            ..index_at(moment.seconds + HALF_AVERAGING_TIME)];
        let count = nearby.len() as f64;
        let (mut mean_time, mut mean_tilt) = (0.0, 0.0);
        for neighbour in nearby {
            mean_time += (neighbour.seconds - moment.seconds) / count;
            mean_tilt += neighbour.tilt / count;
        }
        let (mut products, mut squares) = (0.0, 1e-12);
        for neighbour in nearby {
            let offset = neighbour.seconds - moment.seconds - mean_time;
            products += offset * (neighbour.tilt - mean_tilt);
            squares += offset * offset;
        }
        mean_tilt - mean_time * products / squares
    };
    moments.iter().map(tilt_at).collect()
}

/// The coefficient of sliding friction, fitted to the points of a slide: each is a time in s, a tilt in rad and a
/// displacement in mm.
fn fit_sliding(points: &[[f64; 3]]) -> Result<Figure, SlideTrouble> {
    let too_few = SlideTrouble::FewPictures {
        pictures: points.len(),
    };
    if points.len() < MIN_PICTURES {
        return Err(too_few);
    }
    // Distances without friction, and distances that a friction of 1 would take away; both are integrated by
    // trapezoids of the speed.
    let mut distances = vec![[0.0; 2]];
    let mut speeds = [0.0; 2];
    for pair in points.windows(2) {
        let interval = pair[1][0] - pair[0][0];
        let previous = distances[distances.len() - 1];
        let functions: [fn(f64) -> f64; 2] = [f64::sin, f64::cos];
        let next = [0, 1].map(|i| {
            let mean = (functions[i](pair[0][1]) + functions[i](pair[1][1])) / 2.0;
            let speed_gain = 1000.0 * GRAVITY * mean * interval;
            let distance = previous[i] + (speeds[i] + speed_gain / 2.0) * interval;
            speeds[i] += speed_gain;
            distance
        });
        distances.push(next);
    }
    let begin = points[0][0];
    let model = |parameters: &[f64]| -> Vec<f64> {
        let residual_of = |([seconds, _, measured], [driven, held]): (&[f64; 3], &[f64; 2])| {
            parameters[0] + parameters[1] * 100.0 * (seconds - begin) + driven
                - parameters[2] * held
                - measured
        };
        points.iter().zip(&distances).map(residual_of).collect()
    };
    let fit = least::fit(&[points[0][2], 0.0, points[0][1].tan()], model).ok_or(too_few)?;
    let freedom = points.len() - 3;
    let variance = fit.squares / freedom as f64 * fit.covariance[(2, 2)];
    Ok(Figure {
        value: fit.at[2],
        error: widening(freedom) * variance.sqrt(),
    })
}

/// The time at which a slide begins, with its standard error, s: extrapolated backward, by the acceleration, from
/// the first picture that shows a movement. `previous_seconds` is the time of the previous picture.
fn extrapolate_begin(points: &[[f64; 3]], friction: f64, previous_seconds: f64) -> (f64, f64) {
    let [seconds, tilt, displacement] = points[0];
    let acceleration = 1000.0 * GRAVITY * (tilt.sin() - friction * tilt.cos());
    let back_seconds = (2.0 * displacement / acceleration.max(1.0)).sqrt();
    let gap = seconds - previous_seconds;
    let begin = (seconds - back_seconds).max(previous_seconds - gap - 1.0);
    // If the acceleration grows from zero, the true beginning is earlier, so half of `back_seconds` counts as error.
    (begin, (gap / 2.0).hypot(back_seconds / 2.0))
}
