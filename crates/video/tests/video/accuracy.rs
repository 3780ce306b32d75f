//! Tests of the accuracy in videos of a robot whose path is known.

use fastrand::Rng;
use lizard_studio::render::{Studio, random_normal};
use lizard_studio::walk::{Variation, Walk, paper_gait, true_displacement};
use lizard_video::{CameraEstimate, Gait, Mean, MeasuredGait, Video, read_tags};

use crate::studio::{
    FULL_SCALE, analyse, low_resolution_studio, record_walk, record_walk_hand_held,
};

/// Records some cycles of a gait with a random camera, and measures them.
fn record_and_measure(
    gait: &Gait,
    cycle_count: usize,
    frame_rate: f64,
    variation: Variation,
    rng: &mut Rng,
) -> (MeasuredGait, CameraEstimate) {
    let mut studio = Studio::random(rng);
    // The user's ruler is inexact.
    studio.deck_tag_height += variation.ruler_deviation * random_normal(rng);
    studio.print_scale = [1.0 + variation.ruler_deviation / 1000.0 * random_normal(rng); 2];
    let distance = true_displacement(gait).forward * cycle_count as f64;
    let start = [-distance / 2.0, 0.0, rng.f64() * 0.3 - 0.15];
    let walk = Walk::new(gait, start, cycle_count, variation, rng);
    analyse_and_measure(&record_walk(&studio, &walk, frame_rate, rng), gait)
}

/// Measures a gait in a video; returns the result and the camera.
fn analyse_and_measure(video: &Video, gait: &Gait) -> (MeasuredGait, CameraEstimate) {
    let analysed_video = analyse(video);
    let measured = analysed_video.measure(gait, None);
    let measured = measured.expect("the gait can be measured");
    (measured, analysed_video.camera)
}

/// Returns the measured forward, left and turn components of a cycle, each with its true value.
pub fn means_and_truths(measured: &MeasuredGait, gait: &Gait) -> [(Mean, f64); 3] {
    let truth = true_displacement(gait);
    [
        (measured.forward, truth.forward),
        (measured.left, truth.left),
        (measured.turn, truth.turn),
    ]
}

/// Largest error of a mean cycle, and largest spread of single cycles: mm, mm, deg.
const MAX_ERRORS: [f64; 3] = [0.2, 0.2, 0.5];

/// Checks the error of the mean cycle and the spread of single cycles.
pub fn check_accuracy(case: &str, measured: &MeasuredGait, gait: &Gait) {
    for (i, (mean, truth)) in means_and_truths(measured, gait).into_iter().enumerate() {
        let error = (mean.value - truth).abs();
        assert!(
            error < MAX_ERRORS[i] && mean.standard_deviation < MAX_ERRORS[i],
            "{case}, component {i}: {mean:?}, truth {truth}"
        );
    }
}

#[test]
fn a_cycle_is_measured_to_a_fifth_of_a_millimetre_and_half_a_degree() {
    let mut rng = Rng::with_seed(1);
    for name in ["walk", "left"] {
        let gait = paper_gait(name);
        let (measured, camera) = record_and_measure(&gait, 5, 12.0, Variation::default(), &mut rng);
        assert!(measured.cycles.len() >= 3, "{:?}", measured.cycles);
        check_accuracy(name, &measured, &gait);
        assert!(camera.corner_error < 0.1 && !camera.has_camera_moved);
        assert!((camera.deck_height - FULL_SCALE.deck_height).abs() < 3.0);
    }
}

/// Reads a number from an environment variable; returns `default` if the variable is not set or not a number.
pub fn read_environment_number(name: &str, default: usize) -> usize {
    let value = std::env::var(name).ok().and_then(|word| word.parse().ok());
    value.unwrap_or(default)
}

/// Computes the mean and the standard deviation of values.
fn mean_and_deviation(values: &[f64]) -> [f64; 2] {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares = values.iter().map(|value| (value - mean).powi(2));
    [mean, (squares.sum::<f64>() / values.len() as f64).sqrt()]
}

/// Measures videos on all processor cores. The gaits alternate, and each video has its own random numbers.
fn measure_videos(
    video_count: usize,
    gaits: &[Gait],
    measure: impl Fn(&Gait, &mut Rng) -> MeasuredGait + Sync,
) -> Vec<[(Mean, f64); 3]> {
    let seed = read_environment_number("SEED", 1) as u64;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let measure_one = |index: usize| {
        let gait = &gaits[index % gaits.len()];
        let mut rng = Rng::with_seed(1_000_000 * seed + index as u64);
        means_and_truths(&measure(gait, &mut rng), gait)
    };
    std::thread::scope(|scope| {
        let spawn_thread = |core: usize| {
            let indices = (core..video_count).step_by(cores);
            scope.spawn(move || indices.map(measure_one).collect())
        };
        let threads: Vec<_> = (0..cores).map(spawn_thread).collect();
        let results = threads
            .into_iter()
            .map(|thread| thread.join().expect("no thread panics"));
        results.collect::<Vec<Vec<_>>>().concat()
    })
}

/// Computes the errors of a component's mean in all videos.
fn component_errors(results: &[[(Mean, f64); 3]], component: usize) -> Vec<f64> {
    let components = results.iter().map(|components| components[component]);
    components.map(|(mean, truth)| mean.value - truth).collect()
}

/// The components of a movement, with their units.
const COMPONENT_NAMES: [&str; 3] = ["forward, mm", "left, mm", "turn, deg"];

/// Run by `make measure-test`. As with a real robot, the cycles differ by more than the error of a tag's position, and
/// the user's ruler is inexact, too.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn in_short_videos_93_to_97_percent_of_true_values_lie_within_two_standard_errors() {
    let video_count = read_environment_number("VIDEOS", 200);
    let variation = Variation {
        cycle_deviation: [0.2, 0.2, 0.3f64.to_radians()],
        clock_deviation: 0.003,
        ruler_deviation: 1.0,
    };
    let gaits = ["walk", "left", "crawl", "arc-left"].map(paper_gait);
    let results = measure_videos(video_count, &gaits, |gait, rng| {
        record_and_measure(gait, 6, 12.0, variation, rng).0
    });
    println!(
        "{video_count} videos of 6 cycles, 4 of which count; cycles vary by 0.2 mm and 0.3 deg"
    );
    let mut total_hit_count = 0;
    for (i, name) in COMPONENT_NAMES.into_iter().enumerate() {
        let hit_videos = results.iter().filter(|components| {
            let (mean, truth) = components[i];
            (mean.value - truth).abs() < 2.0 * mean.standard_error
        });
        let hit_count = hit_videos.count();
        total_hit_count += hit_count;
        let [bias, sd] = mean_and_deviation(&component_errors(&results, i));
        let hit_percent = 100.0 * hit_count as f64 / video_count as f64;
        println!("{name:<11} within two errors {hit_percent:5.1} %, bias {bias:+.3}, sd {sd:.3}");
    }
    // For 600 values, a fraction of 95 % has a standard deviation of 0.9 %.
    let hit_fraction = total_hit_count as f64 / (3 * video_count) as f64;
    let hit_percent = 100.0 * hit_fraction;
    println!("all         within two errors {hit_percent:5.1} %");
    assert!((0.93..=0.97).contains(&hit_fraction), "{hit_fraction}");
}

/// Run by `make measure-test`. All cycles of the robot are identical, so only the camera causes errors.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn ten_cycles_at_720p_on_a_tripod_have_small_errors_and_little_spread() {
    let video_count = read_environment_number("VIDEOS", 200) / 10;
    let gaits = ["walk", "left", "crawl", "arc-left", "back"].map(paper_gait);
    let no_variation = Variation::default();
    let results = measure_videos(video_count, &gaits, |gait, rng| {
        record_and_measure(gait, 10, 30.0, no_variation, rng).0
    });
    println!("{video_count} videos of 10 cycles, 1280 x 720, 30 frames per second");
    for (i, name) in COMPONENT_NAMES.into_iter().enumerate() {
        let errors = component_errors(&results, i);
        let cycle_sds = results
            .iter()
            .map(|components| components[i].0.standard_deviation);
        let [bias, sd] = mean_and_deviation(&errors);
        let [cycle_sd, _] = mean_and_deviation(&cycle_sds.collect::<Vec<_>>());
        let max_error = errors.iter().map(|error| error.abs()).fold(0.0, f64::max);
        println!(
            "{name:<11} one cycle's sd {cycle_sd:.3}, mean of a video: bias {bias:+.3}, sd {sd:.3}, \
             largest {max_error:.3}"
        );
        assert!(cycle_sd < MAX_ERRORS[i], "{name}");
        assert!(max_error < 0.3, "{name}");
    }
}

/// Run by `make measure-test`. The camera moves between frames, with standard deviations of 3 mm and 0.3 deg.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn a_hand_held_camera_measures_a_cycle_to_a_fifth_of_a_millimetre_and_half_a_degree() {
    let mut rng = Rng::with_seed(read_environment_number("SEED", 1) as u64);
    let gait = paper_gait("walk");
    let mut studio = Studio::random(&mut rng);
    studio.aim_camera(750.0, 20.0);
    studio.focal_length = 0.75;
    let start = [-2.5 * true_displacement(&gait).forward, 0.0, 0.0];
    let walk = Walk::new(&gait, start, 5, Variation::default(), &mut rng);
    let video = record_walk_hand_held(&studio, &walk, 12.0, 3.0, &mut rng);
    let (measured, camera) = analyse_and_measure(&video, &gait);
    assert!(camera.has_camera_moved);
    for (i, (mean, truth)) in means_and_truths(&measured, &gait).into_iter().enumerate() {
        println!(
            "hand-held, {}: error {:+.3}, one cycle's sd {:.3}",
            COMPONENT_NAMES[i],
            mean.value - truth,
            mean.standard_deviation
        );
    }
    check_accuracy("hand-held", &measured, &gait);
}

#[test]
fn tags_found_near_their_last_positions_equal_those_of_a_full_search_even_after_a_jump() {
    let mut rng = Rng::with_seed(9);
    let mut studio = low_resolution_studio(9, 25.0);
    let mut video = Video::default();
    for i in 0..12 {
        let distance = f64::from(i) * 4.0;
        // In the middle of the video, someone moves and turns the robot. The camera is hand-held.
        let pose = match i {
            ..6 => [distance, 0.0, 0.0],
            _ => [-distance, 15.0, 0.4],
        };
        studio.aim = [2.0 * random_normal(&mut rng), 2.0 * random_normal(&mut rng)];
        let background = studio.render_background(&mut rng);
        let frame = background.render_frame(f64::from(i), |_| pose, &mut rng);
        let (mut found_tags, mut expected_tags) = (video.find_tags(&frame), read_tags(&frame));
        for tags in [&mut found_tags, &mut expected_tags] {
            tags.sort_by_key(|tag| tag.id);
        }
        assert_eq!(found_tags, expected_tags, "frame {i}");
        assert_eq!(found_tags.len(), 5, "frame {i}");
    }
}
