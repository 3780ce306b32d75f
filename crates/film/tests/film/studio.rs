//! Films of a walk in a studio.

use fastrand::Rng;
use lizard_film::{Film, Setup};
use lizard_studio::render::{Pose, Studio};
use lizard_studio::walk::Walk;

/// The setup for a sheet that is printed in true size.
pub const TRUE_SIZE: Setup = Setup {
    print_scale: 1.0,
    deck_height: 83.0,
};

/// A studio with a known camera and few pixels, whose picture the sheet fills.
pub fn small_studio(seed: u64, tilt: f64) -> Studio {
    let mut studio = Studio::random(&mut Rng::with_seed(seed));
    (studio.size, studio.focal_length) = ([640, 360], 1.0);
    (
        studio.camera_height,
        studio.camera_tilt,
        studio.camera_direction,
    ) = (800.0, tilt, 90.0);
    (studio.camera_roll, studio.aim) = (0.0, [0.0; 2]);
    studio
}

/// Films a walk with the camera on a tripod.
pub fn film_walk(studio: &Studio, walk: &Walk, rate: f64, rng: &mut Rng) -> Film {
    film_robot(
        studio,
        walk.duration_s(),
        rate,
        |time| walk.pose_at(time),
        rng,
    )
}

/// Films a robot whose place at any time is given by `robot`.
pub fn film_robot(
    studio: &Studio,
    seconds: f64,
    rate: f64,
    robot: impl Fn(f64) -> Pose,
    rng: &mut Rng,
) -> Film {
    let background = studio.background(rng);
    let mut film = Film::default();
    for i in 0..(seconds * rate) as usize {
        let seconds = i as f64 / rate;
        let picture = background.picture(seconds, &robot, rng);
        film.add(seconds, &picture)
            .expect("the picture fits the film");
    }
    film
}
