//! A test of one walk that is recorded by many cameras; each differs from a good camera in one or two properties.

use fastrand::Rng;
use lizard_studio::render::Studio;
use lizard_studio::walk::{Variation, Walk, paper_gait, true_displacement};

use crate::accuracy::{check_accuracy, means_and_truths, read_environment_number};
use crate::studio::{FULL_SCALE, record_walk, record_walk_hand_held};

/// Number of cycles in a video.
const CYCLE_COUNT: usize = 6;

/// A camera as a user may have it.
struct Camera {
    name: &'static str,
    /// Changes the good camera into this one.
    change: fn(&mut Studio),
    /// Frames per second.
    frame_rate: f64,
    /// Standard deviation of a hand-held camera's position, mm; one tenth of it is the standard deviation of the
    /// camera's angles, deg.
    shake: f64,
}

/// Returns a camera on a tripod that takes 30 frames per second.
const fn on_tripod(name: &'static str, change: fn(&mut Studio)) -> Camera {
    Camera {
        name,
        change,
        frame_rate: 30.0,
        shake: 0.0,
    }
}

/// Returns a studio with a good camera: 720p, on a tripod.
fn good_studio() -> Studio {
    let mut studio = Studio::random(&mut Rng::with_seed(5));
    studio.aim_camera(780.0, 20.0);
    (studio.focal_length, studio.camera_roll) = (0.78, 3.0);
    studio
}

/// All cameras of the test.
const CAMERAS: [Camera; 16] = [
    on_tripod("720p, 30 frames per second", |_| {}),
    on_tripod("640 x 360", |studio| studio.size = [640, 360]),
    on_tripod("1920 x 1080", |studio| studio.size = [1920, 1080]),
    Camera {
        frame_rate: 12.0,
        ..on_tripod("12 frames per second", |_| {})
    },
    Camera {
        frame_rate: 60.0,
        ..on_tripod("60 frames per second", |_| {})
    },
    on_tripod("straight down", |studio| studio.camera_tilt = 2.0),
    on_tripod("tilt 40 deg", |studio| studio.camera_tilt = 40.0),
    on_tripod("600 mm above, wide lens", |studio| {
        (studio.camera_height, studio.focal_length) = (600.0, 0.6);
    }),
    on_tripod("1100 mm above", |studio| {
        (studio.camera_height, studio.focal_length) = (1100.0, 1.1);
    }),
    on_tripod("rolling shutter of 30 ms", |studio| studio.readout_s = 0.03),
    on_tripod("rolling shutter upside down", |studio| {
        (studio.readout_s, studio.camera_roll) = (0.03, 177.0);
    }),
    on_tripod("shutter open for 1/30 s", |studio| {
        studio.exposure_s = 1.0 / 30.0;
    }),
    on_tripod("evening: 40 % of the light, noise of 10", |studio| {
        (studio.light, studio.noise) = (0.4, 10.0);
    }),
    on_tripod("glare between the tags", |studio| {
        studio.discs = vec![[0.0, 150.0, 40.0, 255.0]];
    }),
    Camera {
        frame_rate: 12.0,
        shake: 3.0,
        ..on_tripod("hand-held", |_| {})
    },
    Camera {
        frame_rate: 12.0,
        shake: 3.0,
        ..on_tripod("hand-held, rolling shutter", |studio| {
            studio.readout_s = 0.02;
        })
    },
];

/// Run by `make measure-test`.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn every_camera_measures_a_cycle_to_a_fifth_of_a_millimetre_and_half_a_degree() {
    let seed = read_environment_number("SEED", 1) as u64;
    let gait = paper_gait("walk");
    println!("error of the mean and one cycle's sd: forward, left, turn (mm, mm, deg)");
    for camera in CAMERAS {
        let (name, frame_rate) = (camera.name, camera.frame_rate);
        let mut studio = good_studio();
        (camera.change)(&mut studio);
        let mut rng = Rng::with_seed(seed);
        let start = -true_displacement(&gait).forward * CYCLE_COUNT as f64 / 2.0;
        let (start, variation) = ([start, 0.0, 0.05], Variation::default());
        let walk = Walk::new(&gait, start, CYCLE_COUNT, variation, &mut rng);
        let video = match camera.shake {
            0.0 => record_walk(&studio, &walk, frame_rate, &mut rng),
            shake => record_walk_hand_held(&studio, &walk, frame_rate, shake, &mut rng),
        };
        let measured = video
            .measure(FULL_SCALE, &gait)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let [forward, left, turn] = means_and_truths(&measured, &gait)
            .map(|(mean, truth)| (mean.value - truth, mean.standard_deviation));
        println!(
            "{name:<42} {:+.3} {:.3}   {:+.3} {:.3}   {:+.3} {:.3}",
            forward.0, forward.1, left.0, left.1, turn.0, turn.1
        );
        check_accuracy(name, &measured, &gait);
    }
}
