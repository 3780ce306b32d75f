//! The accuracy of measurements in films of a robot whose path is known.

use fastrand::Rng;
use lizard_film::{Film, Gait, Mean, Measured, Sight, read};
use lizard_studio::render::{Studio, normal};
use lizard_studio::walk::{Variation, Walk, gait, truth};

use crate::studio::{TRUE_SIZE, film, small};

/// Films some cycles with a random camera and measures them.
fn measure_film(
    gait: &Gait,
    cycles: usize,
    rate: f64,
    variation: Variation,
    rng: &mut Rng,
) -> (Measured, Sight) {
    let mut studio = Studio::random(rng);
    // The errors of the user's ruler.
    studio.deck += variation.ruler * normal(rng);
    studio.print = [1.0 + variation.ruler / 1000.0 * normal(rng); 2];
    let distance = truth(gait).forward * cycles as f64;
    let start = [-distance / 2.0, 0.0, rng.f64() * 0.3 - 0.15];
    let walk = Walk::new(gait, start, cycles, variation, rng);
    watch_and_measure(&film(&studio, &walk, rate, rng), gait)
}

/// Measures a gait in a film; returns the result and the camera.
fn watch_and_measure(film: &Film, gait: &Gait) -> (Measured, Sight) {
    let watched = film.watch(TRUE_SIZE).expect("it is watched");
    let measured = watched.measure(gait, None).expect("it is measured");
    (measured, watched.sight)
}

/// Forward, left and turn of a measured cycle, each with its true value.
fn parts(measured: &Measured, gait: &Gait) -> [(Mean, f64); 3] {
    let truth = truth(gait);
    [
        (measured.forward, truth.forward),
        (measured.left, truth.left),
        (measured.turn, truth.turn),
    ]
}

#[test]
fn a_cycle_is_measured_to_a_fifth_of_a_millimetre_and_half_a_degree() {
    let mut rng = Rng::with_seed(1);
    for name in ["walk", "left"] {
        let gait = gait(name);
        let (measured, sight) = measure_film(&gait, 5, 12.0, Variation::default(), &mut rng);
        assert!(measured.cycles.len() >= 3, "{:?}", measured.ends);
        for (i, (mean, truth)) in parts(&measured, &gait).into_iter().enumerate() {
            let largest = [0.2, 0.2, 0.5][i];
            assert!(
                (mean.mean - truth).abs() < largest,
                "{name} {i}: {mean:?} {truth}"
            );
            assert!(mean.spread < largest, "{name} {i}: {mean:?}");
        }
        assert!(sight.error < 0.1 && !sight.has_camera_moved);
        assert!((sight.deck - TRUE_SIZE.height).abs() < 3.0);
    }
}

/// Reads a number from an environment variable; returns `default` if it is not set or is no number.
pub fn number(name: &str, default: usize) -> usize {
    let value = std::env::var(name).ok().and_then(|word| word.parse().ok());
    value.unwrap_or(default)
}

/// The mean and the standard deviation of values.
fn mean_and_deviation(values: &[f64]) -> [f64; 2] {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares = values.iter().map(|value| (value - mean).powi(2));
    [mean, (squares.sum::<f64>() / values.len() as f64).sqrt()]
}

/// Measures films of the gaits in turn, on all cores; each film has its own random numbers.
fn measure_films(
    films: usize,
    gaits: &[Gait],
    measure: impl Fn(&Gait, &mut Rng) -> Measured + Sync,
) -> Vec<[(Mean, f64); 3]> {
    let seed = number("SEED", 1) as u64;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let measure_one = |film: usize| {
        let gait = &gaits[film % gaits.len()];
        let mut rng = Rng::with_seed(1_000_000 * seed + film as u64);
        parts(&measure(gait, &mut rng), gait)
    };
    std::thread::scope(|scope| {
        let spawn_core = |core: usize| {
            scope.spawn(move || (core..films).step_by(cores).map(measure_one).collect())
        };
        let threads: Vec<_> = (0..cores).map(spawn_core).collect();
        let results = threads
            .into_iter()
            .map(|thread| thread.join().expect("it is measured"));
        results.collect::<Vec<Vec<_>>>().concat()
    })
}

/// The names of a movement's parts.
const NAMES: [&str; 3] = ["ahead, mm", "left, mm", "turn, deg"];

/// Run by `make measure-test`. The robot varies by more than the error of a tag's place, as real robots do, and the
/// user's ruler has an error, too.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn in_short_films_the_truth_lies_within_two_errors_in_93_to_97_percent() {
    let films = number("FILMS", 200);
    let variation = Variation {
        cycle: [0.2, 0.2, 0.3f64.to_radians()],
        clock: 0.003,
        ruler: 1.0,
    };
    let gaits = ["walk", "left", "crawl", "arc-left"].map(gait);
    let results = measure_films(films, &gaits, |gait, rng| {
        measure_film(gait, 6, 12.0, variation, rng).0
    });
    println!("{films} films of 6 cycles, of which 4 count; a cycle varies by 0.2 mm and 0.3 deg");
    let mut within_count = 0;
    for (i, name) in NAMES.into_iter().enumerate() {
        let errors: Vec<f64> = results
            .iter()
            .map(|parts| parts[i].0.mean - parts[i].1)
            .collect();
        let hits = results.iter().filter(|parts| {
            let (mean, truth) = parts[i];
            (mean.mean - truth).abs() < 2.0 * mean.error
        });
        let hits = hits.count();
        within_count += hits;
        let [bias, sd] = mean_and_deviation(&errors);
        let share = 100.0 * hits as f64 / films as f64;
        println!("{name:<10} within two errors {share:5.1} %, bias {bias:+.3}, sd {sd:.3}");
    }
    // Two standard deviations of a share of 95 % in 600 parts are 1.8 %.
    let share = within_count as f64 / (3 * films) as f64;
    println!("together   within two errors {:5.1} %", 100.0 * share);
    assert!((0.93..=0.97).contains(&share), "{share}");
}

/// Run by `make measure-test`. All cycles of the robot are identical, so the errors are those of the camera.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn ten_cycles_at_720p_on_a_tripod_have_no_bias_and_little_spread() {
    let films = number("FILMS", 200) / 10;
    let gaits = ["walk", "left", "crawl", "arc-left", "back"].map(gait);
    let no_variation = Variation::default();
    let results = measure_films(films, &gaits, |gait, rng| {
        measure_film(gait, 10, 30.0, no_variation, rng).0
    });
    println!("{films} films of 10 cycles, 1280 x 720, 30 pictures in a second");
    for (i, name) in NAMES.into_iter().enumerate() {
        let errors: Vec<f64> = results
            .iter()
            .map(|parts| parts[i].0.mean - parts[i].1)
            .collect();
        let sds: Vec<f64> = results.iter().map(|parts| parts[i].0.spread).collect();
        let ([bias, sd], [cycle_sd, _]) = (mean_and_deviation(&errors), mean_and_deviation(&sds));
        let largest = errors
            .iter()
            .fold(0.0f64, |largest, error| largest.max(error.abs()));
        println!(
            "{name:<10} one cycle's sd {cycle_sd:.3}, mean of a film: bias {bias:+.3}, sd {sd:.3}, largest {largest:.3}"
        );
        assert!(cycle_sd < [0.2, 0.2, 0.5][i], "{name}");
        assert!(largest < 0.3, "{name}");
    }
}

/// Run by `make measure-test`. Each picture is taken from another place, with standard deviations of 3 mm and 0.3
/// deg.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn a_camera_in_the_hand_measures_a_cycle_to_a_fifth_of_a_millimetre() {
    let mut rng = Rng::with_seed(number("SEED", 1) as u64);
    let gait = gait("walk");
    let mut studio = Studio::random(&mut rng);
    (studio.height, studio.tilt, studio.focal) = (750.0, 20.0, 0.75);
    (studio.direction, studio.roll, studio.aim) = (90.0, 0.0, [0.0; 2]);
    let start = [-2.5 * truth(&gait).forward, 0.0, 0.0];
    let walk = Walk::new(&gait, start, 5, Variation::default(), &mut rng);
    let mut film = Film::default();
    for i in 0..(walk.seconds() * 12.0) as usize {
        let mut shaken = studio.clone();
        shaken.height += 3.0 * normal(&mut rng);
        shaken.aim = shaken.aim.map(|value| value + 3.0 * normal(&mut rng));
        shaken.tilt += 0.3 * normal(&mut rng);
        shaken.roll += 0.3 * normal(&mut rng);
        let seconds = i as f64 / 12.0;
        let background = shaken.background(&mut rng);
        let picture = background.picture(seconds, |time| walk.at(time), &mut rng);
        film.add(seconds, &picture).expect("a picture");
    }
    let (measured, sight) = watch_and_measure(&film, &gait);
    assert!(sight.has_camera_moved);
    for (i, (mean, truth)) in parts(&measured, &gait).into_iter().enumerate() {
        println!(
            "in the hand, {}: off by {:+.3}, one cycle's sd {:.3}",
            NAMES[i],
            mean.mean - truth,
            mean.spread
        );
        let largest = [0.2, 0.2, 0.5][i];
        assert!(
            (mean.mean - truth).abs() < largest && mean.spread < largest,
            "{mean:?}"
        );
    }
}

#[test]
fn tags_near_their_last_places_are_found_as_in_the_whole_picture_and_so_is_one_that_leaps() {
    let mut rng = Rng::with_seed(9);
    let mut studio = small(9, 25.0);
    let mut film = Film::default();
    for i in 0..12 {
        let distance = f64::from(i) * 4.0;
        // In the middle of the film, someone puts the robot elsewhere and turns it. The camera is in a hand, too.
        let robot = if i < 6 {
            [distance, 0.0, 0.0]
        } else {
            [-distance, 15.0, 0.4]
        };
        studio.aim = [2.0 * normal(&mut rng), 2.0 * normal(&mut rng)];
        let background = studio.background(&mut rng);
        let picture = background.picture(f64::from(i), |_| robot, &mut rng);
        let (mut found, mut expected) = (film.find_tags(&picture), read(&picture));
        for tags in [&mut found, &mut expected] {
            tags.sort_by_key(|tag| tag.id);
        }
        assert_eq!(found, expected, "picture {i}");
        assert_eq!(found.len(), 5, "picture {i}");
    }
}
