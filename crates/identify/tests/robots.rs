//! A test of the identification of deliberately changed keys from simulated movements, for each robot of `robots/`.

use std::path::{Path, PathBuf};
use std::thread;

use fastrand::Rng;
use lizard_identify::{Identified, KEYS, KeyResult, MeasuredMovement, Verdict, identify};
use lizard_robot::{CheckedGait, Ground, Robot, Travel};

/// Standard error of a mean of about eight cycles, mm and deg.
const MEAN_ERROR: f64 = 0.03;
/// Number of gaits that are filmed.
const GAIT_COUNT: usize = 8;
/// Size of the change of each key, in the order of `KEYS`. A robot gets up to three of these changes, up or down.
const CHANGE_SIZES: [f64; 7] = [2.0, 0.5, 6.0, -5.0, 0.5, 0.15, 0.08];

fn change_key(ground: &mut Ground, key: usize, change: f64) {
    let value = match key {
        0 => &mut ground.feet.mount_angle,
        1 => &mut ground.drive.play,
        2 => &mut ground.body.mass_centre[0],
        3 => &mut ground.body.mass_centre[1],
        4 => &mut ground.stance.twist,
        5 => &mut ground.friction_coefficient,
        _ => &mut ground.friction_ratio,
    };
    *value += change;
}

/// A random number with an approximately normal distribution: mean 0, standard deviation 1.
fn normal_deviate(rng: &mut Rng) -> f64 {
    (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0
}

/// Runs the simulations one after another.
fn run_sequentially(count: usize, simulate: &(dyn Fn(usize) -> Travel + Sync)) -> Vec<Travel> {
    (0..count).map(simulate).collect()
}

/// Movements of a robot's fastest gaits on a changed ground, with the random errors of a film.
fn filmed_movements(robot: &Robot, ground: &Ground, rng: &mut Rng) -> Vec<MeasuredMovement> {
    let speed_of = |gait: &CheckedGait| {
        let prediction = robot.predict(gait);
        let [forward, turn] =
            [prediction.forward, prediction.turn].map(|component| component.unwrap_or(0.0).abs());
        // A rough measure: mm and deg count the same.
        (forward + turn) / gait.period()
    };
    let mut gaits: Vec<&CheckedGait> = robot
        .gaits()
        .iter()
        .filter(|gait| gait.has_movement())
        .collect();
    gaits.sort_by(|a, b| speed_of(b).total_cmp(&speed_of(a)));
    gaits.truncate(GAIT_COUNT);
    let motors = robot.motors();
    let movement_of = |gait: &&CheckedGait| {
        let Travel {
            forward,
            left,
            turn,
        } = gait.simulate_driven_cycle(ground, &motors, 1.0);
        MeasuredMovement {
            gait: gait.name().to_owned(),
            pace: 1.0,
            mean: [forward, left, turn]
                .map(|component| component + MEAN_ERROR * normal_deviate(rng)),
            error: [MEAN_ERROR; 3],
        }
    };
    gaits.iter().map(movement_of).collect()
}

/// The true changes of a robot's keys, and the keys that are identified from the robot's movements.
struct Trial {
    name: String,
    changes: [f64; 7],
    identified: Identified,
}

impl Trial {
    fn new(path: &Path, seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        let robot =
            Robot::parse(&std::fs::read_to_string(path).expect("the robot file is readable"))
                .expect("the robot file is valid");
        let mut ground = *robot.ground();
        let mut changes = [0.0; 7];
        for _ in 0..3 {
            let key = rng.usize(..CHANGE_SIZES.len());
            // Play cannot become negative.
            let sign = if key == 1 || rng.bool() { 1.0 } else { -1.0 };
            changes[key] = sign * CHANGE_SIZES[key];
        }
        for (key, change) in changes.into_iter().enumerate() {
            change_key(&mut ground, key, change);
        }
        let movements = filmed_movements(&robot, &ground, &mut rng);
        Self {
            name: format!(
                "{} {seed}",
                path.file_stem()
                    .expect("the path has a file name")
                    .to_string_lossy()
            ),
            changes,
            identified: identify(&robot, &movements, &run_sequentially)
                .expect("the movements determine the keys"),
        }
    }

    fn changes_and_results(&self) -> impl Iterator<Item = (f64, &KeyResult)> {
        self.changes.into_iter().zip(&self.identified.keys)
    }
}

/// Run by `make measure-test`.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn changed_keys_are_found_within_two_standard_errors_and_correct_keys_stay() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("the folder robots/ is readable")
        .map(|file| file.expect("the folder entry is readable").path())
        .collect();
    files.sort();
    assert_eq!(files.len(), 5);
    // Two variants of each file; another SEED gives other variants.
    let seed = std::env::var("SEED")
        .ok()
        .and_then(|text| text.parse().ok());
    let first_seed = 2 * seed.unwrap_or(1) - 1;
    let trials: Vec<Trial> = thread::scope(|scope| {
        let variants = files
            .iter()
            .flat_map(|file| [(file, first_seed), (file, first_seed + 1)]);
        let start_trial = |(file, seed): (&PathBuf, u64)| {
            let file = file.clone();
            scope.spawn(move || Trial::new(&file, seed))
        };
        let threads: Vec<_> = variants.map(start_trial).collect();
        let trials = threads.into_iter().map(|thread| thread.join());
        trials
            .map(|trial| trial.expect("the trial does not panic"))
            .collect()
    });
    let (mut changed_count, mut hit_count, mut unchanged_count, mut false_change_count) =
        (0, 0, 0, 0);
    for trial in &trials {
        let goodness = &trial.identified.goodness;
        println!(
            "{}: chi-square {:.0} of {:.0}",
            trial.name, goodness.chi_squares[1], goodness.chi_square_limit
        );
        for (change, result) in trial.changes_and_results() {
            let shift = result.new_value - result.file_value;
            let is_hit = (shift - change).abs() < 2.0 * result.error;
            println!(
                "  {:<34} {change:+.3}: {shift:+.3} +- {:.3} {:?}{}",
                result.key.full_name(),
                result.error,
                result.verdict,
                if is_hit { "" } else { " !" }
            );
            if result.verdict == Verdict::Undetermined {
                continue;
            }
            match change == 0.0 {
                true => {
                    (unchanged_count, false_change_count) = (
                        unchanged_count + 1,
                        false_change_count + usize::from(shift != 0.0),
                    )
                }
                false => {
                    (changed_count, hit_count) =
                        (changed_count + 1, hit_count + usize::from(is_hit))
                }
            }
        }
    }
    println!(
        "{hit_count} of {changed_count} changed keys within two standard errors, {false_change_count} of {unchanged_count} correct keys changed"
    );
    assert!(
        changed_count >= 12 && unchanged_count >= 20,
        "{changed_count} {unchanged_count}"
    );
    assert!(
        hit_count as f64 >= 0.9 * f64::from(changed_count),
        "{hit_count} of {changed_count}"
    );
    assert!(
        false_change_count as f64 <= 0.1 * f64::from(unchanged_count),
        "{false_change_count} of {unchanged_count}"
    );
    assert_eq!(KEYS.len(), CHANGE_SIZES.len());
}
