//! An image that was built for another robot than the one that is named.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use lizard_time_limit::LIMIT;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn release() -> PathBuf {
    root().join("target/avr-atmega328p/release")
}

/// The name and the number of a robot, as `lizard gaits` and the firmware's build write them.
fn robot_in(report: &str) -> String {
    let first = report.lines().next().expect("a line");
    let (_, robot) = first.split_once("robot ").expect("its name");
    robot.to_owned()
}

/// The robot of the image that was built.
fn of_the_image() -> String {
    let gaits = std::fs::read_to_string(release().join("gaits.txt"));
    robot_in(&gaits.expect("`make firmware` has been run"))
}

/// The file of a robot that is not in the image, and its name and number.
fn another() -> (String, String) {
    let robots = ["unequal.toml", "large.toml"].map(|name| root().join("robots").join(name));
    let named = robots.map(|path| {
        let path = path.display().to_string();
        let said = lizard(&["gaits", "--robot", &path]);
        (path, robot_in(&String::from_utf8_lossy(&said.stdout)))
    });
    let image = of_the_image();
    let others = named.into_iter().find(|(_, robot)| *robot != image);
    others.expect("two robots have two numbers")
}

fn lizard(arguments: &[&str]) -> Output {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    command.args(arguments).current_dir(folder);
    LIMIT.output(&mut command, b"").expect("the program ends")
}

#[test]
fn every_command_that_runs_an_image_refuses_an_elf_of_another_robot() {
    let (robot, wanted) = another();
    let image = of_the_image();
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
                "lizard: {elf} has the robot {image} in it, and not {robot}, which is {wanted}; \
                 without --elf, the firmware inside this program runs with any robot"
            ),
            "{words:?}"
        );
        assert_eq!(output.status.code(), Some(2), "{words:?}");
        assert!(output.stdout.is_empty(), "{words:?}");
    }
}
