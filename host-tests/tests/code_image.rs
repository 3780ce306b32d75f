//! Tests that the firmware's code inside the program `lizard` is the code that the source builds.
//!
//! Users without a compiler get `firmware/code.hex`. If the source were changed but not this file, nobody would
//! notice until a board behaves differently from the source.

use std::io::Write as _;
use std::process::Command;

use lizard_core::numbers::section::START_ADDRESS;
use lizard_host::firmware::CODE;
use lizard_host::sim::frame::servo_pins;
use lizard_host::sim::script::{Script, Step};
use lizard_host::sim::session::{Recording, play};
use lizard_host::sim::supplies;
use lizard_host_tests::{FirmwareBench, robot, root};
use simulated_uno::{Fidelity, Image, State, Uno};

/// The failure message if `firmware/code.hex` is out of date.
const RENEW: &str =
    "firmware/code.hex is not what the source builds: run `make code-image` and commit it";

/// Returns the code of an image, from address 0 to the robot's section; 0xff in unused bytes.
fn code_of(image: &Image) -> Vec<u8> {
    let mut flash = image.flash();
    flash.resize(START_ADDRESS.into(), 0xff);
    flash
}

/// Returns the image inside the program `lizard`, with the section of the robot under test added.
fn embedded_image() -> Image {
    let mut image = Image::parse_hex(CODE).expect("it is Intel HEX");
    let space = u32::from(START_ADDRESS)..0x7e00;
    image
        .replace(space, &robot().section())
        .expect("the section fits");
    image
}

/// Returns the versions of the installed compiler and linker, one per line.
fn installed_tools() -> String {
    let script = root().join("scripts/code-image");
    let output = Command::new(script)
        .arg("--tools")
        .arg(FirmwareBench::elf())
        .output();
    let output = output.expect("scripts/code-image runs");
    let output_text = String::from_utf8(output.stdout).expect("it is text");
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
    let script = Script {
        steps: commands
            .map(|(ms, command)| Step {
                ms,
                command: command.to_owned(),
            })
            .to_vec(),
        end_ms: 60_000,
        ..Script::default()
    };
    let mut uno = Uno::with_image(image, Fidelity::DataSheet);
    supplies::connect(&mut uno, robot());
    let pins = servo_pins(robot());
    let recording = play(&mut uno, pins, &script, |_| Ok(())).expect("it is not written");
    assert_eq!(recording.state, State::Alive);
    recording
}

#[test]
fn the_code_inside_the_program_is_what_the_source_builds() {
    let inside_code = code_of(&Image::parse_hex(CODE).expect("it is Intel HEX"));
    let mut built_image = FirmwareBench::image();
    built_image
        .replace(u32::from(START_ADDRESS)..0x7e00, &[])
        .expect("the robot is taken out");
    let built_code = code_of(&built_image);
    let recorded_tools = std::fs::read_to_string(root().join("firmware/tools.txt"));
    let recorded_tools = recorded_tools.expect("firmware/tools.txt");
    if recorded_tools == installed_tools() {
        let first_difference =
            (0..START_ADDRESS.into()).find(|&index| inside_code[index] != built_code[index]);
        assert_eq!(
            first_difference, None,
            "{RENEW} (the first byte that differs)"
        );
        return;
    }
    // The test harness would hide the output of `eprintln!` if the test passes, so this writes to stderr directly.
    let note = format!(
        "code_image: firmware/code.hex was made by other tools than those here, so its bytes are \
         not compared, but what both do in a minute. It was made by\n{recorded_tools}and here are\n{}",
        installed_tools()
    );
    std::io::stderr()
        .write_all(note.as_bytes())
        .expect("it is said");
    let [inside_recording, built_recording] =
        [embedded_image(), FirmwareBench::image()].map(record_minute);
    assert_eq!(
        inside_recording.banner, built_recording.banner,
        "{RENEW} (its banner)"
    );
    assert_eq!(
        inside_recording.answers, built_recording.answers,
        "{RENEW} (its answers)"
    );
    assert_eq!(
        inside_recording.frames.widths.len(),
        built_recording.frames.widths.len()
    );
    for (index, (inside_widths, built_widths)) in inside_recording
        .frames
        .widths
        .iter()
        .zip(&built_recording.frames.widths)
        .enumerate()
    {
        assert_eq!(
            inside_widths, built_widths,
            "{RENEW} (the pulses of frame {index})"
        );
    }
}

#[test]
fn the_code_inside_the_program_is_code_alone_and_walks_with_a_robot_after_it() {
    let recording = record_minute(embedded_image());
    let banner = recording.banner.expect("a banner");
    let robot_label = lizard_host::firmware::robot_label(robot().firmware());
    assert!(
        banner.contains(&format!(" robot {robot_label}")),
        "{banner}"
    );
    assert!(recording.frames.widths.len() > 2700);
    let code = Image::parse_hex(CODE).expect("it is Intel HEX").flash();
    assert!(
        (20_000..=usize::from(START_ADDRESS)).contains(&code.len()),
        "{} bytes",
        code.len()
    );
}
