//! Keys that are changed on purpose are identified from the changed robot's movements, for each robot of `robots/`.

use std::path::{Path, PathBuf};
use std::thread;

use fastrand::Rng;
use lizard_identify::{Identified, KEYS, KeyResult, MeasuredMovement, Verdict, identify};
use lizard_robot::{CheckedGait, Ground, Robot, Travel};

/// Standard error of a measured mean, mm and deg: that of about eight cycles.
const ERROR: f64 = 0.03;
/// Number of gaits that are filmed.
const GAITS: usize = 8;
/// Possible change of each key, in the order of `KEYS`; a robot gets up to three of these changes.
const CHANGES: [f64; 7] = [2.0, 0.5, 6.0, -5.0, 0.5, 0.15, 0.08];

fn set(ground: &mut Ground, key: usize, change: f64) {
    let value = match key {
        0 => &mut ground.feet.mount,
        1 => &mut ground.drive.play,
        2 => &mut ground.body.centre[0],
        3 => &mut ground.body.centre[1],
        4 => &mut ground.stance.twist,
        5 => &mut ground.friction,
        _ => &mut ground.ratio,
    };
    *value += change;
}

/// A random number with an approximately normal distribution: mean 0, standard deviation 1.
fn normal(rng: &mut Rng) -> f64 {
    (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0
}

/// Runs the walks one after another.
fn in_turn(count: usize, walk: &(dyn Fn(usize) -> Travel + Sync)) -> Vec<Travel> {
    (0..count).map(walk).collect()
}

/// Movements of the fastest gaits of a robot on another ground, with the random errors of a film.
fn filmed_movements(robot: &Robot, ground: &Ground, rng: &mut Rng) -> Vec<MeasuredMovement> {
    let far = |gait: &CheckedGait| {
        let way = robot.predict(gait);
        let [ahead, turn] = [way.forward, way.turn].map(|part| part.unwrap_or(0.0).abs());
        (ahead + turn) / gait.period()
    };
    let mut gaits: Vec<&CheckedGait> = robot.gaits().iter().filter(|gait| gait.moves()).collect();
    gaits.sort_by(|a, b| far(b).total_cmp(&far(a)));
    gaits.truncate(GAITS);
    let motors = robot.motors();
    let way = |gait: &&CheckedGait| {
        let Travel {
            forward,
            left,
            turn,
        } = gait.simulate_driven_cycle(ground, &motors, 1.0);
        MeasuredMovement {
            gait: gait.name().to_owned(),
            pace: 1.0,
            mean: [forward, left, turn].map(|part| part + ERROR * normal(rng)),
            error: [ERROR; 3],
        }
    };
    gaits.iter().map(way).collect()
}

/// A robot with changed keys: the true changes, and the identification from its movements.
struct Trial {
    name: String,
    changes: [f64; 7],
    identified: Identified,
}

impl Trial {
    fn new(file: &Path, seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        let robot =
            Robot::parse(&std::fs::read_to_string(file).expect("a robot")).expect("it is right");
        let mut ground = *robot.ground();
        let mut changes = [0.0; 7];
        for _ in 0..3 {
            let key = rng.usize(..CHANGES.len());
            // Play cannot become negative.
            let sign = if key == 1 || rng.bool() { 1.0 } else { -1.0 };
            changes[key] = sign * CHANGES[key];
        }
        for (key, change) in changes.into_iter().enumerate() {
            set(&mut ground, key, change);
        }
        let ways = filmed_movements(&robot, &ground, &mut rng);
        Self {
            name: format!(
                "{} {seed}",
                file.file_stem().expect("a name").to_string_lossy()
            ),
            changes,
            identified: identify(&robot, &ways, &in_turn).expect("the ways tell something"),
        }
    }

    fn keys(&self) -> impl Iterator<Item = (f64, &KeyResult)> {
        self.changes.into_iter().zip(&self.identified.keys)
    }
}

/// Run by `make measure-test`.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn keys_that_were_changed_are_found_within_two_errors_and_right_ones_stay() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("the robots")
        .map(|file| file.expect("a file").path())
        .collect();
    files.sort();
    assert_eq!(files.len(), 5);
    // Two variants of each file; another SEED gives other variants.
    let seed = std::env::var("SEED")
        .ok()
        .and_then(|word| word.parse().ok());
    let first = 2 * seed.unwrap_or(1) - 1;
    let trials: Vec<Trial> = thread::scope(|scope| {
        let robots = files
            .iter()
            .flat_map(|file| [(file, first), (file, first + 1)]);
        let run = |(file, seed): (&PathBuf, u64)| {
            let file = file.clone();
            scope.spawn(move || Trial::new(&file, seed))
        };
        let threads: Vec<_> = robots.map(run).collect();
        let ended = threads.into_iter().map(|thread| thread.join());
        ended.map(|trial| trial.expect("a trial")).collect()
    });
    let (mut told, mut within, mut right, mut moved) = (0, 0, 0, 0);
    for trial in &trials {
        let goodness = &trial.identified.goodness;
        println!(
            "{}: chi-square {:.0} of {:.0}",
            trial.name, goodness.chi_square[1], goodness.chi_square_limit
        );
        for (change, found) in trial.keys() {
            let by = found.after - found.before;
            let is_near = (by - change).abs() < 2.0 * found.error;
            println!(
                "  {:<34} {change:+.3}: {by:+.3} +- {:.3} {:?}{}",
                found.key.full_name(),
                found.error,
                found.verdict,
                if is_near { "" } else { " !" }
            );
            if found.verdict == Verdict::Undetermined {
                continue;
            }
            match change == 0.0 {
                true => (right, moved) = (right + 1, moved + usize::from(by != 0.0)),
                false => (told, within) = (told + 1, within + usize::from(is_near)),
            }
        }
    }
    println!(
        "{within} of {told} changed keys within two errors, {moved} of {right} right ones moved"
    );
    assert!(told >= 12 && right >= 20, "{told} {right}");
    assert!(within as f64 >= 0.9 * f64::from(told), "{within} of {told}");
    assert!(moved as f64 <= 0.1 * f64::from(right), "{moved} of {right}");
    assert_eq!(KEYS.len(), CHANGES.len());
}
