//! Films of a walk in a studio.

use fastrand::Rng;
use lizard_film::{Film, Picture, Setup};
use lizard_studio::render::{Pose, Studio, random_normal};
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
    (studio.camera_height, studio.camera_tilt) = (800.0, tilt);
    (studio.camera_direction, studio.camera_roll, studio.aim) = (90.0, 0.0, [0.0; 2]);
    studio
}

/// Films a walk with the camera on a tripod.
pub fn film_walk(studio: &Studio, walk: &Walk, picture_rate: f64, rng: &mut Rng) -> Film {
    let pose_at = |time| walk.pose_at(time);
    film_robot(studio, walk.duration_s(), picture_rate, pose_at, rng)
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
    film_pictures(duration_s, picture_rate, |seconds| {
        background.picture(seconds, &pose_at, rng)
    })
}

/// Makes a film of pictures that are taken at regular times, s.
pub fn film_pictures(
    duration_s: f64,
    picture_rate: f64,
    mut picture_at: impl FnMut(f64) -> Picture,
) -> Film {
    let mut film = Film::default();
    for i in 0..(duration_s * picture_rate) as usize {
        let seconds = i as f64 / picture_rate;
        let result = film.add(seconds, &picture_at(seconds));
        result.expect("the picture fits the film");
    }
    film
}

/// Films a walk from the hand, which shakes the camera: by `shake` mm, and by a tenth of that in deg.
pub fn film_from_hand(
    studio: &Studio,
    walk: &Walk,
    picture_rate: f64,
    shake: f64,
    rng: &mut Rng,
) -> Film {
    film_pictures(walk.duration_s(), picture_rate, |seconds| {
        let mut shaken_studio = studio.clone();
        shaken_studio.camera_height += shake * random_normal(rng);
        shaken_studio.aim = studio.aim.map(|value| value + shake * random_normal(rng));
        shaken_studio.camera_tilt += shake / 10.0 * random_normal(rng);
        shaken_studio.camera_roll += shake / 10.0 * random_normal(rng);
        let background = shaken_studio.background(rng);
        background.picture(seconds, |time| walk.pose_at(time), rng)
    })
}
