//! Generator of random robots for `make other-robots`. The program writes files like robot.toml, and the tests of the
//! running firmware are repeated with each of these robots.
//!
//! The arguments are a folder, a seed and a count. The same seed gives the same robots. If the count is ten or more,
//! each feature that is rare in the files of `robots/` must occur in one of the robots. Otherwise the program fails and
//! writes no file.

use std::path::Path;
use std::process::ExitCode;

use fastrand::Rng;
use lizard_host_tests::random_robot::random_robot;
use lizard_robot::Robot;

/// The Arduino number of A0, the first pin of port C.
const FIRST_PORT_C_PIN: u8 = 14;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("other-robots: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Generates the robots and writes their files.
fn run(arguments: &[String]) -> Result<(), String> {
    let [folder, seed, count] = arguments else {
        return Err("expected three arguments: a folder, a seed and a count".into());
    };
    let parse_number = |text: &String, name: &str| {
        let number = text.parse::<u64>();
        number.map_err(|_| format!("{name} must be a whole number, but is {text:?}"))
    };
    let (seed, count) = (parse_number(seed, "SEED")?, parse_number(count, "COUNT")?);
    if count == 0 {
        return Err("COUNT must be at least 1, but is 0".into());
    }
    let robots: Vec<(String, Robot)> = (0..count)
        .map(|n| {
            let robot_seed = seed.wrapping_mul(1_000_003).wrapping_add(1000 + n);
            random_robot(&mut Rng::with_seed(robot_seed))
        })
        .collect();
    // A few random robots are unlikely to have all rare features.
    if count >= 10 {
        check_features(&robots)?;
    }
    let folder = Path::new(folder);
    let to_message = |error: std::io::Error| format!("{}: {error}", folder.display());
    std::fs::create_dir_all(folder).map_err(to_message)?;
    for (number, (toml, _)) in robots.iter().enumerate() {
        std::fs::write(folder.join(format!("{number}.toml")), toml).map_err(to_message)?;
    }
    Ok(())
}

/// A function that returns true if a robot has a feature.
type FeatureTest = fn(&Robot) -> bool;

/// Checks that each rare feature occurs in one of the robots. The error names the first missing feature.
fn check_features(robots: &[(String, Robot)]) -> Result<(), String> {
    let rare_features: [(&str, FeatureTest); 5] = [
        ("with a reversed servo", |robot| {
            robot.servos().iter().any(|servo| servo.us_per_degree < 0.0)
        }),
        ("with a servo on port C", |robot| {
            robot
                .servos()
                .iter()
                .any(|servo| servo.pin >= FIRST_PORT_C_PIN)
        }),
        ("with a measured rail", |robot| {
            robot.supplies().rail.is_some()
        }),
        ("without a rail", |robot| robot.supplies().rail.is_none()),
        ("with a gait other than stand", |robot| {
            robot.gaits().len() > 1
        }),
    ];
    for (feature, has_feature) in rare_features {
        if !robots.iter().any(|(_, robot)| has_feature(robot)) {
            return Err(format!("no random robot {feature}; choose another seed"));
        }
    }
    Ok(())
}
