//! An image that was built for another robot than the one that is named.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use lizard_time_limit::LIMIT;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn release() -> PathBuf {
    root().join("target/avr-atmega328p/release")
}

/// The number of the image's robot, as the build of the firmware has written it.
fn hash_of_the_image() -> String {
    let gaits = std::fs::read_to_string(release().join("gaits.txt"));
    let gaits = gaits.expect("`make firmware` has been run");
    let first = gaits.lines().next().expect("a line");
    let (_, hash) = first.split_once("tables ").expect("the number");
    hash.to_owned()
}

/// A robot that the image was not built for, and its number by `lizard gaits`.
fn another() -> (String, String) {
    let robots = ["unequal.toml", "large.toml"].map(|name| root().join("robots").join(name));
    let numbered = robots.map(|path| {
        let path = path.display().to_string();
        let said = lizard(&["gaits", "--robot", &path]);
        let said = String::from_utf8_lossy(&said.stdout).into_owned();
        let first = said.lines().next().expect("a line").to_owned();
        let (_, hash) = first.split_once("tables ").expect("the number");
        (path, hash.to_owned())
    });
    let image = hash_of_the_image();
    let others = numbered.into_iter().find(|(_, hash)| *hash != image);
    others.expect("two robots have two numbers")
}

fn lizard(arguments: &[&str]) -> Output {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(arguments).current_dir(folder);
    LIMIT.output(&mut command, b"").expect("the program ends")
}

#[test]
fn every_command_that_runs_an_image_refuses_one_of_another_robot() {
    let (robot, wanted) = another();
    let image = hash_of_the_image();
    let elf = release().join("lizard.elf").display().to_string();
    for words in [
        &["sim"][..],
        &["sim", "--pty"],
        &["twin"],
        &["bench"],
        &["console", "--sim"],
        &["backup", "never.toml", "--sim"],
    ] {
        let with = ["--elf", &elf, "--robot", &robot];
        let output = lizard(&[words, &with].concat());
        assert_eq!(
            String::from_utf8_lossy(&output.stderr).trim(),
            format!(
                "lizard: {elf} is the firmware of another robot than {robot}: its tables are \
                 {image}, those of that robot {wanted}; `make firmware ROBOT={robot}` builds the \
                 right one, or --robot names the robot that it was built for"
            ),
            "{words:?}"
        );
        assert_eq!(output.status.code(), Some(2), "{words:?}");
        assert!(output.stdout.is_empty(), "{words:?}");
    }
}
