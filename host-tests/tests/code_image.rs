//! Tests that the program `lizard` contains the firmware code built from the source.
//!
//! The program contains `firmware/code.hex` for users without a compiler. If the source changes but this file does not,
//! these users write outdated firmware to their boards.

use std::io::Write as _;
use std::process::Command;

use lizard_core::numbers::section::START_ADDRESS;
use lizard_host::firmware::CODE_HEX;
use lizard_host::sim::script::{Script, Step};
use lizard_host::sim::session::{Recording, play};
use lizard_host_tests::{FirmwareBench, read_file, robot, root};
use lizard_upload::BOOT_ADDRESS;
use simulated_uno::{Fidelity, Image, State, Uno};

/// The error message if `firmware/code.hex` is outdated.
const OUTDATED_MESSAGE: &str = "firmware/code.hex differs from the code built from the source: run `make code-image`, and commit this file and firmware/tools.txt";

/// Returns the code of an image, from address 0 to the robot's section. Unused bytes are 0xff.
fn extract_code(image: &Image) -> Vec<u8> {
    let mut code = image.flash();
    code.resize(START_ADDRESS.into(), 0xff);
    code
}

/// Returns the image that the program `lizard` contains: the code without a section.
fn embedded_code() -> Image {
    Image::parse_hex(CODE_HEX).expect("code.hex is Intel HEX")
}

/// Replaces the robot's section of an image.
fn with_section(mut image: Image, section: &[u8]) -> Image {
    let result = image.replace(u32::from(START_ADDRESS)..BOOT_ADDRESS as u32, section);
    result.expect("the section fits");
    image
}

/// Returns the code that the program `lizard` contains, with the section of the robot under test.
fn embedded_code_with_robot() -> Image {
    with_section(embedded_code(), &robot().section())
}

/// Reads the versions of the compiler that built the ELF file and of the installed linker, one per line.
fn read_tool_versions() -> String {
    let script = root().join("scripts/code-image");
    let output = Command::new(script)
        .arg("--tools")
        .arg(FirmwareBench::elf_path())
        .output();
    let output = output.expect("scripts/code-image runs");
    let output_text = String::from_utf8(output.stdout).expect("the output is UTF-8");
    assert!(output_text.starts_with("rustc version "), "{output_text}");
    output_text
}

/// Runs an image for a minute of walking, other commands and rest, and returns the recording.
fn record_minute(image: Image) -> Recording {
    let commands = [
        (1000, "status"),
        (2003, "walk"),
        (21_007, "speed 40"),
        (35_011, "stop"),
        (38_017, "pose 90 90 318.59 221.41"),
        (45_019, "no such thing"),
        (48_023, "stand"),
        (55_027, "rest"),
    ];
    let steps = commands.map(|(ms, command)| Step::new(ms, command));
    let script = Script::new(steps.to_vec(), 60_000);
    let mut uno = Uno::with_image(image, Fidelity::DataSheet);
    let recording = play(&mut uno, robot(), &script, |_| Ok(()));
    let recording = recording.expect("the event handler never fails");
    assert_eq!(recording.state, State::Alive);
    recording
}

#[test]
fn the_program_contains_the_code_built_from_the_source() {
    let code_images = [embedded_code(), with_section(FirmwareBench::image(), &[])];
    let [embedded_bytes, built_bytes] = code_images.map(|image| extract_code(&image));
    let recorded_versions = read_file("firmware/tools.txt");
    if recorded_versions == read_tool_versions() {
        let mut pairs = embedded_bytes.iter().zip(&built_bytes);
        let first_difference = pairs.position(|(embedded, built)| embedded != built);
        assert_eq!(
            first_difference, None,
            "{OUTDATED_MESSAGE} (address of the first differing byte)"
        );
        return;
    }
    // Writes to stderr directly, because the test harness hides the output of `eprintln!` if the test passes.
    let note = format!(
        "code_image: the installed tools differ from the tools that built firmware/code.hex, so the test compares a \
         minute of behaviour instead of the bytes. Recorded:\n{recorded_versions}Installed:\n{}",
        read_tool_versions()
    );
    let result = std::io::stderr().write_all(note.as_bytes());
    result.expect("stderr works");
    let [embedded_recording, built_recording] =
        [embedded_code_with_robot(), FirmwareBench::image()].map(record_minute);
    assert_eq!(
        embedded_recording.banner, built_recording.banner,
        "{OUTDATED_MESSAGE} (the banners differ)"
    );
    assert_eq!(
        embedded_recording.answers, built_recording.answers,
        "{OUTDATED_MESSAGE} (the answers differ)"
    );
    let [embedded_widths, built_widths] =
        [embedded_recording, built_recording].map(|recording| recording.frames.widths);
    assert_eq!(embedded_widths.len(), built_widths.len());
    let mut pairs = embedded_widths.iter().zip(&built_widths);
    assert_eq!(
        pairs.position(|(embedded, built)| embedded != built),
        None,
        "{OUTDATED_MESSAGE} (index of the first frame whose pulses differ)"
    );
}

#[test]
fn the_code_in_the_program_walks_after_a_robot_is_added() {
    let recording = record_minute(embedded_code_with_robot());
    let banner = recording.banner.expect("the firmware prints its banner");
    let robot_label = lizard_host::firmware::format_robot_label(robot().firmware());
    let robot_text = format!(" robot {robot_label}");
    assert!(banner.contains(&robot_text), "{banner}");
    assert!(recording.frames.widths.len() > 2700);
    let byte_count = embedded_code().flash().len();
    let allowed_counts = 20_000..=usize::from(START_ADDRESS);
    assert!(allowed_counts.contains(&byte_count), "{byte_count} bytes");
}
