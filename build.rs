//! Converts robot.toml, or the file named by LIZARD_ROBOT, to the robot's section of flash.
//!
//! An invalid value or gait ends the build with a message. The report on the gaits is written to `gaits.txt`, in the
//! folder into which Cargo puts the compiled firmware.

use std::path::{Path, PathBuf};
use std::process::exit;
use std::{env, fs};

use lizard_core::numbers::section::{REGION_BYTES, START_ADDRESS};
use lizard_robot::{Report, Robot};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=LIZARD_ROBOT");
    // This script does not use the linker, but the image must be built again whenever the linker changes.
    println!("cargo::rerun-if-changed=tools/linker/src");
    let configured_path = env::var_os("LIZARD_ROBOT").filter(|path| !path.is_empty());
    let robot_path = configured_path.map_or_else(|| PathBuf::from("robot.toml"), PathBuf::from);
    println!("cargo::rerun-if-changed={}", robot_path.display());
    let robot = Robot::load(&robot_path).unwrap_or_else(|error| fail_build(&error.to_string()));
    // Cargo sets OUT_DIR for every build script.
    let out_dir = env::var_os("OUT_DIR").unwrap_or_else(|| fail_build("OUT_DIR is not set"));
    let out_dir = PathBuf::from(out_dir);
    write_file(&out_dir.join("robot.bin"), &robot.section());
    // The linker script lays out the flash. The address of the robot's section comes from
    // lizard_core::numbers::section::START_ADDRESS.
    let linker_script = Path::new(env!("CARGO_MANIFEST_DIR")).join("avr-specs/atmega328p.ld");
    let linker_script = linker_script.display();
    println!("cargo::rerun-if-changed={linker_script}");
    println!("cargo::rustc-link-arg-bins=-Wl,-T,{linker_script}");
    println!("cargo::rustc-link-arg-bins=-Wl,--defsym=__robot_start={START_ADDRESS:#x}");
    let end_address = START_ADDRESS + REGION_BYTES;
    println!("cargo::rustc-link-arg-bins=-Wl,--defsym=__robot_end={end_address:#x}");
    // No instruction refers to the robot's section, to the mark of the firmware (src/mark.rs) or to the section for
    // simavr (src/simavr.rs). Without this option, the linker would discard them.
    for name in ["ROBOT", "MARK", "MMCU"] {
        println!("cargo::rustc-link-arg-bins=-Wl,--undefined={name}");
    }
    // OUT_DIR is build/<package>/out in the folder of the compiled firmware.
    if let Some(firmware_folder) = out_dir.ancestors().nth(3) {
        let report = Report::compute(&robot).to_string();
        write_file(&firmware_folder.join("gaits.txt"), report.as_bytes());
    }
}

fn write_file(path: &Path, bytes: &[u8]) {
    if let Err(error) = fs::write(path, bytes) {
        fail_build(&format!("{}: {error}", path.display()));
    }
}

/// Ends the build with a message. Cargo prints a `cargo::error` before the script's other output.
fn fail_build(message: &str) -> ! {
    println!("cargo::error={message}");
    exit(1)
}
