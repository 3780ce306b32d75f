//! A board that is lifted until the robot on it slides, with static and sliding friction.

use std::f64::consts::PI;

use fastrand::Rng;
use lizard_film::Picture;

use crate::render::Studio;

/// Acceleration of free fall, mm/s^2.
const GRAVITY: f64 = 9806.65;
/// Time step of the simulation, s.
const STEP: f64 = 0.0005;
/// Distance downhill after which a hand stops the robot, mm.
const STOP_DISTANCE: f64 = 110.0;

/// A board that is lifted, with a robot on it.
#[derive(Clone, Copy)]
pub struct Board {
    /// Coefficient of static friction.
    pub resting: f64,
    /// Coefficient of friction while the robot slides.
    pub sliding: f64,
    /// Rate of the lift, deg/s.
    pub lift: f64,
    /// Time at which the lift begins, s.
    pub from: f64,
    /// Tilt before the lift, deg.
    pub begin: f64,
    /// Tilt at which the lift ends, deg.
    pub end: f64,
    /// Direction of the head, relative to downhill, deg.
    pub head: f64,
    /// Direction of the slide, relative to downhill, deg.
    pub aside: f64,
}

/// A board that is lifted evenly, with a robot that faces downhill and slides straight down.
pub const BOARD: Board = Board {
    resting: 0.75,
    sliding: 0.68,
    lift: 6.0,
    from: 1.2,
    begin: 0.0,
    end: 50.0,
    head: 0.0,
    aside: 0.0,
};

impl Board {
    /// The board's tilt at a time, deg.
    fn tilt(&self, seconds: f64) -> f64 {
        (self.begin + self.lift * (seconds - self.from).max(0.0)).min(self.end)
    }

    /// The robot's distance downhill, mm, at every [`STEP`] up to a time in seconds.
    fn distances(&self, seconds: f64) -> Vec<f64> {
        let (mut distance, mut speed) = (0.0, 0.0);
        let advance = |i: usize| {
            let (sin, cos) = self.tilt(i as f64 * STEP).to_radians().sin_cos();
            let friction = if speed > 0.0 {
                self.sliding
            } else {
                self.resting
            };
            speed = f64::max(0.0, speed + GRAVITY * (sin - friction * cos) * STEP);
            distance = f64::min(STOP_DISTANCE, distance + speed * STEP);
            distance
        };
        (0..(seconds / STEP) as usize).map(advance).collect()
    }

    /// Takes pictures of the board, at the full rate only around the slide, and passes them on with their times.
    pub fn pictures(&self, studio: &Studio, rate: f64, mut take: impl FnMut(f64, &Picture)) {
        let mut rng = Rng::with_seed(11);
        let duration = self.from + (self.end.min(45.0) - self.begin) / self.lift + 0.5;
        let distances = self.distances(duration);
        let distance_at =
            |seconds: f64| distances[((seconds.max(0.0) / STEP) as usize).min(distances.len() - 1)];
        let mut seconds = 0.0;
        while seconds < duration && distance_at(seconds - 0.1) < STOP_DISTANCE {
            let mut tilted = studio.clone();
            tilted.board = self.tilt(seconds);
            // Downhill is to the left in the scene.
            let heading = PI + self.head.to_radians();
            let (sin, cos) = (PI + self.aside.to_radians()).sin_cos();
            let robot = |time: f64| {
                [
                    55.0 + distance_at(time) * cos,
                    5.0 + distance_at(time) * sin,
                    heading,
                ]
            };
            let background = tilted.background(&mut rng);
            take(seconds, &background.picture(seconds, robot, &mut rng));
            seconds += if distance_at(seconds + 0.25) > 0.5 {
                1.0 / rate
            } else {
                0.2
            };
        }
    }
}

/// A studio with few pixels, whose picture the sheet fills.
pub fn studio() -> Studio {
    let mut studio = Studio::random(&mut Rng::with_seed(5));
    (studio.size, studio.focal) = ([640, 480], 0.85);
    (studio.height, studio.tilt, studio.direction) = (850.0, 12.0, 90.0);
    (studio.roll, studio.aim) = (0.0, [0.0; 2]);
    // A robot that is not aligned with the strips needs more room between them.
    studio.strips = [[5.0, -180.0, 0.03], [-5.0, 180.0, PI - 0.02]];
    studio.shutter = 1.0 / 250.0;
    studio
}
