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
const LEVEL: f64 = 1.0;
/// Largest tilt of the board in that time, relative to its mean, deg.
const MOVED: f64 = 1.0;
/// Standard error of the vertical found while the board is level, deg.
const LEVEL_SIGMA: f64 = 0.3;
/// Standard error of a tilt found by the camera, deg.
const TILT_SIGMA: f64 = 0.2;
/// Smallest displacement that counts as a slide, mm.
const SLID: f64 = 15.0;
/// Range of displacements from which the friction is found, mm.
const PART: [f64; 2] = [1.0, 60.0];
/// Smallest number of pictures of a slide.
const LEAST: usize = 6;
/// Largest angle between the slide and the downhill direction, and between the robot and that direction, deg.
const ASIDE: f64 = 30.0;
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
    pub fn of(watched: &AnalysedFilm) -> Result<Self, SlideTrouble> {
        let cameras: Vec<_> = watched.cameras().collect();
        let first = watched.path.first().map_or(0.0, |seen| seen.seconds);
        let is_level = |seen: &PathPoint| seen.seconds < first + LEVEL;
        let level = watched
            .path
            .iter()
            .take_while(|seen| is_level(seen))
            .count();
        let up = cameras[..level].iter().map(|camera| camera.up());
        let vertical = up.sum::<Vector3<f64>>().normalize();
        let moments: Vec<Moment> = watched
            .path
            .iter()
            .zip(&cameras)
            .map(|(seen, camera)| {
                let up = camera.on_floor(&vertical);
                Moment {
                    seconds: seen.seconds,
                    tilt: up.x.hypot(up.y).atan2(up.z),
                    down: [-up.x, -up.y],
                    at: [seen.place.forward, seen.place.left],
                    heading: seen.place.heading,
                }
            })
            .collect();
        let most =
            |moments: &[Moment]| moments.iter().map(|moment| moment.tilt).fold(0.0, f64::max);
        let angle = most(&moments[..level]).to_degrees();
        if angle > MOVED {
            return Err(SlideTrouble::NotAtRest { angle });
        }
        let rest = mean(&moments[..level]);
        let away = |moment: &Moment| (moment.at[0] - rest[0]).hypot(moment.at[1] - rest[1]);
        let Some(slid) = moments.iter().position(|moment| away(moment) > SLID) else {
            return Err(SlideTrouble::NotSlid {
                slid: moments.iter().map(away).fold(0.0, f64::max),
                tilt: most(&moments).to_degrees(),
            });
        };
        let from = moments[..slid]
            .iter()
            .rposition(|moment| away(moment) < PART[0]);
        let from = from.map_or(0, |at| at + 1);
        let way = [0, 1].map(|i| moments[slid].at[i] - rest[i]);
        check_ways(&moments[slid], way)?;
        let length = way[0].hypot(way[1]);
        let along = |moment: &Moment| {
            (0..2)
                .map(|i| (moment.at[i] - rest[i]) * way[i])
                .sum::<f64>()
                / length
        };
        let tilts = smooth(&moments);
        // The slide ends when it is long enough or when something stops it.
        let mut to = slid;
        let pace = |i: usize| {
            (along(&moments[i]) - along(&moments[i - 1]))
                / (moments[i].seconds - moments[i - 1].seconds)
        };
        while to + 1 < moments.len()
            && along(&moments[to]) < PART[1]
            && pace(to + 1) > 0.8 * pace(to)
        {
            to += 1;
        }
        let points: Vec<[f64; 3]> = (from..=to)
            .map(|i| [moments[i].seconds, tilts[i], along(&moments[i])])
            .collect();
        let sliding = sliding(&points)?;
        let (begin, error) = begin(&points, sliding.value, moments[from.max(1) - 1].seconds);
        let near = |seconds: f64| {
            let at = moments.partition_point(|moment| moment.seconds < seconds);
            at.min(moments.len() - 1)
        };
        let (now, before) = (
            near(begin),
            near(begin - 2.0 * HALF_AVERAGING_TIME).saturating_sub(1),
        );
        let tilt = tilts[now].to_degrees();
        let apart = moments[now].seconds - moments[before].seconds;
        let rate = (tilt - tilts[before].to_degrees()) / apart.max(HALF_AVERAGING_TIME);
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
            is_head_first: angle_between(moments[slid].heading, moments[slid].down) < 90.0,
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
fn check_ways(moment: &Moment, way: [f64; 2]) -> Result<(), SlideTrouble> {
    let beside = angle_between(way[1].atan2(way[0]), moment.down);
    if beside > ASIDE {
        return Err(SlideTrouble::NotDown { aside: beside });
    }
    let head = angle_between(moment.heading, moment.down);
    match head.min(180.0 - head) > ASIDE {
        true => Err(SlideTrouble::Across { aside: head }),
        false => Ok(()),
    }
}

/// The unsigned angle between a heading in rad and a direction, deg.
fn angle_between(heading: f64, [x, y]: [f64; 2]) -> f64 {
    let (sin, cos) = (heading - y.atan2(x)).sin_cos();
    sin.atan2(cos).to_degrees().abs()
}

/// The mean position of the robot on the board, mm.
fn mean(moments: &[Moment]) -> [f64; 2] {
    [0, 1].map(|i| moments.iter().map(|moment| moment.at[i]).sum::<f64>() / moments.len() as f64)
}

/// The tilt in each picture, rad, by a straight line fitted to the pictures around it.
fn smooth(moments: &[Moment]) -> Vec<f64> {
    let at = |seconds: f64| moments.partition_point(|moment| moment.seconds < seconds);
    let one = |moment: &Moment| {
        let near = &moments
            [at(moment.seconds - HALF_AVERAGING_TIME)..at(moment.seconds + HALF_AVERAGING_TIME)];
        let count = near.len() as f64;
        let (mut time, mut tilt) = (0.0, 0.0);
        for other in near {
            time += (other.seconds - moment.seconds) / count;
            tilt += other.tilt / count;
        }
        let (mut with, mut squares) = (0.0, 1e-12);
        for other in near {
            let apart = other.seconds - moment.seconds - time;
            with += apart * (other.tilt - tilt);
            squares += apart * apart;
        }
        tilt - time * with / squares
    };
    moments.iter().map(one).collect()
}

/// The coefficient of sliding friction, fitted to the points of a slide: each is a time in s, a tilt in rad and a
/// displacement in mm.
fn sliding(points: &[[f64; 3]]) -> Result<Figure, SlideTrouble> {
    let few = SlideTrouble::FewPictures {
        pictures: points.len(),
    };
    if points.len() < LEAST {
        return Err(few);
    }
    // Distances without friction, and distances that a friction of 1 would take away; both are integrated by
    // trapezoids of the speed.
    let mut ways = vec![[0.0; 2]];
    let mut speeds = [0.0; 2];
    for pair in points.windows(2) {
        let apart = pair[1][0] - pair[0][0];
        let before = ways[ways.len() - 1];
        let parts: [fn(f64) -> f64; 2] = [f64::sin, f64::cos];
        let next = [0, 1].map(|i| {
            let mean = (parts[i](pair[0][1]) + parts[i](pair[1][1])) / 2.0;
            let gained = 1000.0 * GRAVITY * mean * apart;
            let way = before[i] + (speeds[i] + gained / 2.0) * apart;
            speeds[i] += gained;
            way
        });
        ways.push(next);
    }
    let begin = points[0][0];
    let model = |at: &[f64]| -> Vec<f64> {
        let residual = |([seconds, _, place], [down, held]): (&[f64; 3], &[f64; 2])| {
            at[0] + at[1] * 100.0 * (seconds - begin) + down - at[2] * held - place
        };
        points.iter().zip(&ways).map(residual).collect()
    };
    let fit = least::fit(&[points[0][2], 0.0, points[0][1].tan()], model).ok_or(few)?;
    let freedom = points.len() - 3;
    let variance = fit.squares / freedom as f64 * fit.covariance[(2, 2)];
    Ok(Figure {
        value: fit.at[2],
        error: widening(freedom) * variance.sqrt(),
    })
}

/// The time at which a slide begins, with its standard error, s: extrapolated backward, by the acceleration, from
/// the first picture that shows a movement. `before` is the time of the previous picture.
fn begin(points: &[[f64; 3]], friction: f64, before: f64) -> (f64, f64) {
    let [seconds, tilt, slid] = points[0];
    let acceleration = 1000.0 * GRAVITY * (tilt.sin() - friction * tilt.cos());
    let back = (2.0 * slid / acceleration.max(1.0)).sqrt();
    let gap = seconds - before;
    let begin = (seconds - back).max(before - gap - 1.0);
    // If the acceleration grows from zero, the true beginning is earlier, so half of `back` counts as error.
    (begin, (gap / 2.0).hypot(back / 2.0))
}
