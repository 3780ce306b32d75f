//! Turns robot.toml into the numbers that the firmware carries. A value or a
//! gait that will not do ends the build with the sentence that says why.

use std::path::Path;
use std::process::exit;
use std::{env, fs};

use lizard_robot::Robot;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=robot.toml");
    let robot = Robot::load("robot.toml").unwrap_or_else(|error| stop(&error.to_string()));
    // Cargo sets OUT_DIR for every build script.
    let out = env::var("OUT_DIR").unwrap_or_else(|_| stop("OUT_DIR is not set"));
    if let Err(error) = fs::write(Path::new(&out).join("robot.rs"), robot.source()) {
        stop(&format!("{out}/robot.rs: {error}"));
    }
}

/// Ends the build. `cargo::error` shows the sentence alone, without the rest of
/// the script's output.
fn stop(sentence: &str) -> ! {
    println!("cargo::error={sentence}");
    exit(1)
}
