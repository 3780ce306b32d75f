//! A test of one walk that is recorded by many cameras; each differs from a good camera in one or two properties.

use fastrand::Rng;
use lizard_studio::render::Studio;
use lizard_studio::walk::{Variation, Walk, paper_gait, true_displacement};

use crate::accuracy::{means_and_truths, read_environment_number};
use crate::studio::{FULL_SCALE, record_hand_held, record_walk};

/// Number of cycles in a video.
const CYCLE_COUNT: usize = 6;
/// Largest error of a mean cycle, and largest spread of single cycles: mm, mm, deg.
const MAX_ERRORS: [f64; 3] = [0.2, 0.2, 0.5];

/// A camera as a user may have it.
struct Camera {
    name: &'static str,
    studio: Studio,
    /// Frames per second.
    frame_rate: f64,
    /// Standard deviation of a hand-held camera's position, mm; one tenth of it is the standard deviation of the
    /// camera's angles, deg.
    shake: f64,
}

/// Returns a studio with a good camera: 720p, on a tripod.
fn good_studio() -> Studio {
    let mut studio = Studio::random(&mut Rng::with_seed(5));
    (studio.camera_height, studio.camera_tilt) = (780.0, 20.0);
    (studio.camera_direction, studio.focal_length) = (90.0, 0.78);
    (studio.camera_roll, studio.aim) = (3.0, [0.0; 2]);
    studio
}

/// Lists all cameras of the test.
fn list_cameras() -> Vec<Camera> {
    let camera = |name, change: &dyn Fn(&mut Studio), frame_rate, shake| {
        let mut studio = good_studio();
        change(&mut studio);
        Camera {
            name,
            studio,
            frame_rate,
            shake,
        }
    };
    let on_tripod = |name, change: &dyn Fn(&mut Studio)| camera(name, change, 30.0, 0.0);
    vec![
        on_tripod("720p, 30 frames per second", &|_| {}),
        on_tripod("640 x 360", &|studio| studio.size = [640, 360]),
        on_tripod("1920 x 1080", &|studio| studio.size = [1920, 1080]),
        camera("12 frames per second", &|_| {}, 12.0, 0.0),
        camera("60 frames per second", &|_| {}, 60.0, 0.0),
        on_tripod("straight down", &|studio| studio.camera_tilt = 2.0),
        on_tripod("tilt 40 deg", &|studio| studio.camera_tilt = 40.0),
        on_tripod("600 mm above, wide lens", &|studio| {
            (studio.camera_height, studio.focal_length) = (600.0, 0.6);
        }),
        on_tripod("1100 mm above", &|studio| {
            (studio.camera_height, studio.focal_length) = (1100.0, 1.1);
        }),
        on_tripod("rolling shutter of 30 ms", &|studio| {
            studio.readout_s = 0.03
        }),
        on_tripod("rolling shutter upside down", &|studio| {
            (studio.readout_s, studio.camera_roll) = (0.03, 177.0);
        }),
        on_tripod("shutter open for 1/30 s", &|studio| {
            studio.exposure_s = 1.0 / 30.0;
        }),
        on_tripod("evening: 40 % of the light, noise of 10", &|studio| {
            (studio.light, studio.noise) = (0.4, 10.0);
        }),
        on_tripod("glare between the tags", &|studio| {
            studio.discs = vec![[0.0, 150.0, 40.0, 255.0]];
        }),
        camera("hand-held", &|_| {}, 12.0, 3.0),
        camera(
            "hand-held, rolling shutter",
            &|studio| studio.readout_s = 0.02,
            12.0,
            3.0,
        ),
    ]
}

/// Run by `make measure-test`.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn every_camera_measures_a_cycle_to_a_fifth_of_a_millimetre_and_half_a_degree() {
    let seed = read_environment_number("SEED", 1) as u64;
    let gait = paper_gait("walk");
    println!("error of the mean and one cycle's sd: forward, left, turn (mm, mm, deg)");
    for camera in list_cameras() {
        let mut rng = Rng::with_seed(seed);
        let start = -true_displacement(&gait).forward * CYCLE_COUNT as f64 / 2.0;
        let (start, variation) = ([start, 0.0, 0.05], Variation::default());
        let walk = Walk::new(&gait, start, CYCLE_COUNT, variation, &mut rng);
        let (studio, frame_rate) = (&camera.studio, camera.frame_rate);
        let video = match camera.shake {
            0.0 => record_walk(studio, &walk, frame_rate, &mut rng),
            shake => record_hand_held(studio, &walk, frame_rate, shake, &mut rng),
        };
        let measured = video
            .measure(FULL_SCALE, &gait)
            .unwrap_or_else(|error| panic!("{}: {error}", camera.name));
        let [forward, left, turn] = means_and_truths(&measured, &gait)
            .map(|(mean, truth)| (mean.value - truth, mean.standard_deviation));
        println!(
            "{:<42} {:+.3} {:.3}   {:+.3} {:.3}   {:+.3} {:.3}",
            camera.name, forward.0, forward.1, left.0, left.1, turn.0, turn.1
        );
        for ((error, cycle_sd), max_error) in [forward, left, turn].into_iter().zip(MAX_ERRORS) {
            let is_small = error.abs() < max_error && cycle_sd < max_error;
            assert!(is_small, "{}: error {error}, sd {cycle_sd}", camera.name);
        }
    }
}
