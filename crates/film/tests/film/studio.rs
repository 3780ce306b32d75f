//! Films of a walk in a studio.

use fastrand::Rng;
use lizard_film::{Film, Setup};
use lizard_studio::render::{Pose, Studio};
use lizard_studio::walk::Walk;

/// The setup for a sheet that is printed at full scale (1:1).
pub const FULL_SCALE: Setup = Setup {
    print_scale: 1.0,
    deck_height: 83.0,
};

/// A studio with a fixed camera pose and a low resolution, in which the sheet fills the picture.
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
pub fn film_walk(studio: &Studio, walk: &Walk, picture_rate: f64, rng: &mut Rng) -> Film {
    film_robot(
        studio,
        walk.duration_s(),
        picture_rate,
        |time| walk.pose_at(time),
        rng,
    )
}

/// Films a robot whose pose at any time is given by `pose_at`.
pub fn film_robot(
    studio: &Studio,
    duration_s: f64,
    picture_rate: f64,
    pose_at: impl Fn(f64) -> Pose,
    rng: &mut Rng,
) -> Film {
    let background = studio.background(rng);
    let mut film = Film::default();
    for i in 0..(duration_s * picture_rate) as usize {
        let time_s = i as f64 / picture_rate;
        let picture = background.picture(time_s, &pose_at, rng);
        film.add(time_s, &picture)
            .expect("the picture fits the film");
    }
    film
}
