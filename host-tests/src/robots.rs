//! Robots under test: those of the repository's files, and random ones.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use fastrand::Rng;
use lizard_host::patrol::add_patrol;
use lizard_robot::{CheckedGait, Robot, edit::without_gait};

use crate::random_robot::random_robot;

/// Number of random robots in a test run.
const RANDOM_ROBOT_COUNT: u64 = 8;

/// A robot under test and its name in messages.
#[derive(Debug)]
pub struct NamedRobot {
    /// The name in messages: the robot's file, or the number of a random robot.
    pub name: String,
    /// The robot under test.
    pub robot: Robot,
}

/// The root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Reads a text file. The path is relative to the root of the repository.
///
/// # Panics
/// If the file is not readable. The message names the file.
pub fn read_file(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The robot under test. `LIZARD_ROBOT` names its file, relative to the root of the repository; the default is
/// robot.toml. `make test ROBOT=...` sets the variable and builds the firmware from the same file.
///
/// # Panics
/// If the file is missing or invalid.
pub fn robot() -> &'static Robot {
    static ROBOT: LazyLock<Robot> = LazyLock::new(|| load(&robot_file()));
    &ROBOT
}

/// The robot under test with two inputs and a routine added. Gaits are removed if flash has no room for the routine.
///
/// # Panics
/// If there is no room even with one gait.
pub fn patrolling_robot() -> &'static Robot {
    static ROBOT: LazyLock<Robot> = LazyLock::new(|| {
        robot_with_patrol(&read_file(robot_file())).unwrap_or_else(|error| panic!("{error}"))
    });
    &ROBOT
}

/// Parses the text of a robot.toml, with two inputs and a routine added. The last gaits are removed one by one until
/// flash has room for the routine.
///
/// # Errors
/// Fails if there is no room even with one gait, or if the text is not a valid robot.
pub fn robot_with_patrol(toml: &str) -> Result<Robot, lizard_robot::Error> {
    const REST: &str = "rest 1 s";
    add_patrol(toml, &[REST]).or_else(|error| {
        let robot = Robot::parse(toml)?;
        let names = robot.gaits().iter().skip(1).map(|gait| gait.name());
        // A gait to which another gait or a routine refers cannot be removed.
        let mut shorter_tomls = names.rev().map(|name| without_gait(toml, name));
        let shorter_toml = shorter_tomls.find(|toml| Robot::parse(toml).is_ok());
        robot_with_patrol(&shorter_toml.ok_or(error)?)
    })
}

fn robot_file() -> PathBuf {
    let named_path = std::env::var_os("LIZARD_ROBOT").filter(|path| !path.is_empty());
    root().join(named_path.unwrap_or_else(|| "robot.toml".into()))
}

/// The paper's robot, for tests that check the paper's values.
///
/// # Panics
/// If robots/paper.toml is missing or invalid.
pub fn paper_robot() -> &'static Robot {
    static ROBOT: LazyLock<Robot> = LazyLock::new(|| load_named_robot("paper"));
    &ROBOT
}

/// Loads the robot from the file `name`.toml in robots/.
///
/// # Panics
/// If the file is missing or invalid.
pub fn load_named_robot(name: &str) -> Robot {
    load(&root().join(format!("robots/{name}.toml")))
}

/// The console commands that start the gaits of the robot under test.
pub fn gait_commands() -> Vec<String> {
    robot().gaits().iter().map(CheckedGait::command).collect()
}

/// The robot under test, every robot in robots/, and random robots. The random robots are the same in every run with
/// the same [`seed`].
///
/// # Panics
/// If a file is invalid. The message names the file.
pub fn robots() -> &'static [NamedRobot] {
    static ROBOTS: LazyLock<Vec<NamedRobot>> = LazyLock::new(|| {
        let mut robots = load_robots_from_files();
        robots.extend((0..RANDOM_ROBOT_COUNT).map(|number| NamedRobot {
            name: format!("random robot {number} of seed {}", seed()),
            robot: random_robot(&mut rng(number)).1,
        }));
        robots
    });
    &ROBOTS
}

/// Loads the robot under test and every robot in robots/.
///
/// # Panics
/// If a file is invalid. The message names the file.
pub fn load_robots_from_files() -> Vec<NamedRobot> {
    let folder = std::fs::read_dir(root().join("robots")).expect("the folder robots/ is readable");
    let files = folder.map(|entry| entry.expect("the folder entry is readable").path());
    let is_toml = |path: &PathBuf| path.extension() == Some("toml".as_ref());
    let mut files: Vec<PathBuf> = files.filter(is_toml).collect();
    files.sort();
    assert!(!files.is_empty(), "robots/ contains no robots");
    let mut robots = vec![NamedRobot {
        name: "the robot under test".into(),
        robot: robot().clone(),
    }];
    for path in files {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        robots.push(NamedRobot {
            name: name.into(),
            robot: load(&path),
        });
    }
    robots
}

/// The seed of all random numbers, from the environment variable `PROPTEST_RNG_SEED` (default 1).
///
/// # Panics
/// If the variable is not a whole number.
pub fn seed() -> u64 {
    let value = std::env::var("PROPTEST_RNG_SEED").ok();
    value.map_or(1, |seed| {
        seed.parse().expect("PROPTEST_RNG_SEED is a whole number")
    })
}

/// Returns a random number generator. Each `stream` has its own sequence, which is the same in every run with the same
/// [`seed`].
pub fn rng(stream: u64) -> Rng {
    Rng::with_seed(seed().wrapping_mul(1_000_003).wrapping_add(stream))
}

fn load(path: &Path) -> Robot {
    Robot::load(path).unwrap_or_else(|error| panic!("{error}"))
}
