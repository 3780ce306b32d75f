//! `lizard flash` and `lizard image` as a user meets them without a board.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use lizard_time_limit::LIMIT;

/// Code of 20 bytes and a robot of two, as avr-objcopy writes them.
const HEX: &str = "\
:100000000C9434000C943E000C943E000C943E0082\n\
:0400100001020304E2\n\
:026A0000AABB2F\n\
:00000001FF\n";

/// A folder where `make firmware` has left [`HEX`].
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let built = folder.path().join("target/avr-atmega328p/release");
    fs::create_dir_all(&built).expect("folders");
    fs::write(built.join("lizard.hex"), HEX).expect("a file");
    folder
}

/// Standard output, standard error, exit code.
fn lizard(folder: &Path, arguments: &[&str]) -> (String, String, Option<i32>) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(arguments).current_dir(folder);
    let Output {
        status,
        stdout,
        stderr,
    } = LIMIT.output(&mut command, b"").expect("the program ends");
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    (text(stdout), text(stderr), status.code())
}

#[test]
fn an_image_is_written_as_intel_hex_and_as_bytes() {
    let folder = folder();
    let (said, _, code) = lizard(folder.path(), &["image", "--output", "a.hex"]);
    assert_eq!(code, Some(0));
    assert_eq!(said, "a.hex: an image of 27138 bytes of flash\n");
    let hex = fs::read_to_string(folder.path().join("a.hex")).expect("it is there");
    assert_eq!(hex, HEX);
    let (_, _, code) = lizard(folder.path(), &["image", "-o", "a.bin"]);
    assert_eq!(code, Some(0));
    let bytes = fs::read(folder.path().join("a.bin")).expect("it is there");
    assert_eq!(bytes[..4], [0x0c, 0x94, 0x34, 0x00]);
    assert_eq!(bytes[0x6a00..], [0xaa, 0xbb]);
}

#[cfg(unix)]
#[test]
fn an_image_does_not_take_the_place_of_a_device() {
    let folder = folder();
    let device = folder.path().join("device.hex");
    std::os::unix::fs::symlink("/dev/null", &device).expect("a link");
    let (_, said, code) = lizard(folder.path(), &["image", "-o", "device.hex"]);
    assert_eq!(code, Some(1));
    assert_eq!(
        said,
        "lizard: cannot write device.hex: it is there already and no ordinary file\n"
    );
    assert!(device.is_symlink());
}

#[test]
fn without_firmware_it_says_how_to_build_it() {
    let empty = tempfile::tempdir().expect("a folder");
    for arguments in [["image", "-o", "a.hex"], ["flash", "--only-robot", "COM1"]] {
        let (_, said, code) = lizard(empty.path(), &arguments);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.ends_with("build it with `make firmware`\n"), "{said}");
    }
}

#[cfg(unix)]
#[test]
fn a_port_that_is_not_there_is_named() {
    let (_, said, code) = lizard(folder().path(), &["flash", "/dev/no-such-port"]);
    assert_eq!(code, Some(2));
    let begin = "lizard: there is no /dev/no-such-port; USB serial ports of this machine: ";
    assert!(said.starts_with(begin), "{said}");
}

#[test]
fn a_file_that_is_no_image_is_refused_before_any_port_is_opened() {
    let folder = folder();
    fs::write(folder.path().join("half.hex"), &HEX[..60]).expect("a file");
    let arguments = ["flash", "/dev/no-such-port", "--image", "half.hex"];
    let (_, said, code) = lizard(folder.path(), &arguments);
    assert_eq!(code, Some(2));
    assert!(
        said.starts_with("lizard: half.hex: line 2 is no Intel HEX"),
        "{said}"
    );
    let both = [&arguments[..], &["--robot", "robot.toml"]].concat();
    let (_, said, code) = lizard(folder.path(), &both);
    assert_eq!(code, Some(2));
    assert!(said.contains("cannot be used with"), "{said}");
}
