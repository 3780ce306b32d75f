//! The robot as parts: every test takes files of robots/ and asks what is made of them.

use lizard_robot::Robot;

mod bill;
mod builder;
mod docs;
mod files;
mod fit;
mod mjcf;
mod order;
mod proof;
mod surface;

/// The files of robots/.
const ROBOTS: [&str; 4] = ["paper", "large", "unequal", "own-gaits"];

/// Legs on slotted struts.
const STRUT: &str = "[leg.drive]\nkind = \"strut\"";

/// The robot of a file of robots/, with more lines at the end.
fn with(name: &str, more: &str) -> Robot {
    let path = format!("{}/../../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect(&path);
    Robot::parse(&format!("{text}\n{more}"))
        .unwrap_or_else(|error| panic!("{name} with {more}: {error}"))
}

/// What is added where nothing says what drives the legs: slotted struts, which are wider.
fn driven(more: &str) -> String {
    match more.contains("[leg.drive]") {
        true => more.to_owned(),
        false => format!("{STRUT}\n{more}"),
    }
}
