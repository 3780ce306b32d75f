//! Tests of the robot's parts, with the robot files in robots/.

use lizard_kinematics::Solution;
use lizard_parts::{Assembly, Bill, Body};
use lizard_robot::Robot;

mod bill;
mod details;
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

/// The robot files except [`GRAIN_ROBOT`].
const ROBOTS: [&str; 4] = ["paper", "large", "unequal", "own-gaits"];

/// The robot file whose parts equal the paper's except for the pads, as a test in `proof.rs` shows.
const GRAIN_ROBOT: &str = "grain";

/// The lines of robot.toml for slotted struts.
const SLOTTED_STRUTS_TOML: &str = "[leg.drive]\nkind = \"strut\"";

/// Parses a robot file with more lines of TOML appended.
fn read_robot_with(name: &str, more_toml: &str) -> Robot {
    let path = format!("{}/../../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect(&path);
    Robot::parse(&format!("{text}\n{more_toml}"))
        .unwrap_or_else(|error| panic!("{name} with {more_toml}: {error}"))
}

/// Builds the assembly of a robot file with more lines of TOML appended.
fn build_assembly(name: &str, more_toml: &str) -> Assembly {
    Assembly::new(&read_robot_with(name, more_toml))
}

/// Builds the assembly of a robot file with slotted struts, which are wider than the default, and more lines of TOML.
fn build_slotted_assembly(name: &str, more_toml: &str) -> Assembly {
    build_assembly(name, &format!("{SLOTTED_STRUTS_TOML}\n{more_toml}"))
}

/// Builds the paper's robot with slotted struts and changes its body with this name.
fn build_assembly_with_changed_body(name: &str, change: impl FnOnce(&mut Body)) -> Assembly {
    build_slotted_assembly("paper", "").with_changed_bodies(|bodies| {
        let body = bodies.iter_mut().find(|body| body.name == name);
        change(body.expect(name));
    })
}

/// Solves the robot's linkages at neutral.
fn solve_at_neutral(robot: &Robot) -> Solution {
    let solution = robot.lizard().solve(&robot.neutral_pose());
    solution.expect("the linkages close at neutral")
}

/// Computes the bill of a robot, with its centre of mass at neutral.
fn compute_bill(assembly: &Assembly) -> Bill {
    let (parts, pose) = (assembly.collect_parts(), solve_at_neutral(assembly.robot()));
    Bill::compute(assembly, &parts, &pose)
}

/// Finds the body with this name.
#[track_caller]
fn find_body<'a>(assembly: &'a Assembly, name: &str) -> &'a Body {
    assembly.body(name).expect(name)
}
