//! Tests of the robot's parts; each test uses some of the robot files in robots/.

use lizard_kinematics::Solution;
use lizard_parts::{Assembly, Body};
use lizard_robot::Robot;

mod bill;
mod builder;
mod docs;
mod files;
mod fit;
mod fittings;
mod mjcf;
mod mjcf_masses;
mod mjcf_reader;
mod models;
mod order;
mod pads;
mod proof;
mod surface;

/// The files of robots/ except [`GRAIN_ROBOT`].
const ROBOTS: [&str; 4] = ["paper", "large", "unequal", "own-gaits"];

/// The file of robots/ whose parts equal the paper's except for the pads, as a test shows.
const GRAIN_ROBOT: &str = "grain";

/// The lines of robot.toml for slotted struts of the legs.
const SLOTTED_STRUTS_TOML: &str = "[leg.drive]\nkind = \"strut\"";

/// The robot of a file of robots/, with more lines of TOML appended.
fn robot_with(name: &str, more_toml: &str) -> Robot {
    let path = format!("{}/../../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect(&path);
    Robot::parse(&format!("{text}\n{more_toml}"))
        .unwrap_or_else(|error| panic!("{name} with {more_toml}: {error}"))
}

/// The assembly of a file of robots/, with more lines of TOML appended.
fn assembly(name: &str, more_toml: &str) -> Assembly {
    Assembly::new(&robot_with(name, more_toml))
}

/// The assembly of a file of robots/ with slotted struts, which are wider than the default, and more lines of TOML.
fn slotted_assembly(name: &str, more_toml: &str) -> Assembly {
    assembly(name, &format!("{SLOTTED_STRUTS_TOML}\n{more_toml}"))
}

/// The positions of the robot's joints at neutral.
fn neutral_solution(assembly: &Assembly) -> Solution {
    mjcf_reader::neutral_solution(assembly.robot())
}

/// The body with a given name.
#[track_caller]
fn body<'a>(assembly: &'a Assembly, name: &str) -> &'a Body {
    assembly.body(name).expect(name)
}
