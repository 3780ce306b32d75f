//! `lizard flash` as a user meets it without a board.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use lizard_time_limit::LIMIT;

/// An image of 20 bytes, as avr-objcopy writes it.
const HEX: &str = "\
:100000000C9434000C943E000C943E000C943E0082\n\
:0400100001020304E2\n\
:00000001FF\n";

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
fn without_firmware_it_says_how_to_build_it() {
    let empty = tempfile::tempdir().expect("a folder");
    let (_, said, code) = lizard(empty.path(), &["flash", "COM1"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.ends_with("build it with `make firmware`\n"), "{said}");
}

#[cfg(unix)]
#[test]
fn a_port_that_is_not_there_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.hex"), HEX).expect("a file");
    let arguments = ["flash", "/dev/no-such-port", "--image", "a.hex"];
    let (_, said, code) = lizard(folder.path(), &arguments);
    assert_eq!(code, Some(2));
    let begin = "lizard: there is no /dev/no-such-port; USB serial ports of this machine: ";
    assert!(said.starts_with(begin), "{said}");
}

#[test]
fn a_file_that_is_no_image_is_refused_before_any_port_is_opened() {
    let folder = tempfile::tempdir().expect("a folder");
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
