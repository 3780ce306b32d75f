//! Films of a walk in a studio.

use fastrand::Rng;
use lizard_film::{Film, Setup};
use lizard_studio::render::{Spot, Studio};
use lizard_studio::walk::Walk;

/// The setup of a sheet that is printed in true size.
pub const TRUE_SIZE: Setup = Setup {
    scale: 1.0,
    height: 83.0,
};

/// A studio with a known camera and few pixels; the sheet fills its picture.
pub fn small(seed: u64, tilt: f64) -> Studio {
    let mut studio = Studio::random(&mut Rng::with_seed(seed));
    (studio.size, studio.focal) = ([640, 360], 1.0);
    (studio.height, studio.tilt, studio.direction) = (800.0, tilt, 90.0);
    (studio.roll, studio.aim) = (0.0, [0.0; 2]);
    studio
}

/// Films a walk with the camera on a tripod.
pub fn film(studio: &Studio, walk: &Walk, rate: f64, rng: &mut Rng) -> Film {
    film_of(studio, walk.seconds(), rate, |time| walk.at(time), rng)
}

/// Films a robot whose place at any time is given by `robot`.
pub fn film_of(
    studio: &Studio,
    seconds: f64,
    rate: f64,
    robot: impl Fn(f64) -> Spot,
    rng: &mut Rng,
) -> Film {
    let background = studio.background(rng);
    let mut film = Film::default();
    for i in 0..(seconds * rate) as usize {
        let seconds = i as f64 / rate;
        let picture = background.picture(seconds, &robot, rng);
        film.add(seconds, &picture).expect("a picture");
    }
    film
}
