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

/// A file of robots/.
fn text(name: &str) -> String {
    let path = format!("{}/../robots/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).expect(&path)
}

/// Its robot with more lines at the end.
fn with(name: &str, more: &str) -> Robot {
    Robot::parse(&format!("{}\n{more}", text(name)))
        .unwrap_or_else(|error| panic!("{name} with {more}: {error}"))
}

/// What is added where nothing says what drives the legs: slotted struts, which are wider.
fn driven(more: &str) -> String {
    match more.contains("[leg.drive]") {
        true => more.to_owned(),
        false => format!("{STRUT}\n{more}"),
    }
}
