//! Commands refuse an image that was built for another robot than the selected one.

use std::path::PathBuf;

use crate::program::{robot, root, run};

fn release_folder() -> PathBuf {
    root().join("target/avr-atmega328p/release")
}

/// Extracts the robot's name and hash from the first line that `lizard gaits` or the
/// firmware's build writes.
fn robot_in(report: &str) -> String {
    let first_line = report.lines().next().expect("a line");
    let (_, robot) = first_line.split_once("robot ").expect("its name");
    robot.to_owned()
}

/// The name and hash of the robot in the image that `make firmware` built.
fn robot_of_image() -> String {
    let gaits = std::fs::read_to_string(release_folder().join("gaits.txt"));
    robot_in(&gaits.expect("`make firmware` has been run"))
}

/// The file of a robot that is not in the image, and the robot's name and hash.
fn robot_outside_image() -> (String, String) {
    let robots = ["unequal", "large"].map(|name| {
        let path = robot(name);
        let report = run(&["gaits", "--robot", &path]).expect_success();
        (path, robot_in(&report))
    });
    let image_robot = robot_of_image();
    let other_robot = robots.into_iter().find(|(_, robot)| *robot != image_robot);
    other_robot.expect("two robots have two numbers")
}

#[test]
fn every_command_that_runs_an_image_refuses_an_elf_of_another_robot() {
    let (robot_path, wanted_robot) = robot_outside_image();
    let image_robot = robot_of_image();
    let elf = release_folder().join("lizard.elf").display().to_string();
    for command in [
        &["sim"][..],
        &["sim", "--pty"],
        &["twin"],
        &["sim", "bench"],
        &["console", "--sim"],
        &["calibrate", "backup", "never.toml", "--sim"],
    ] {
        let options = ["--elf", &elf, "--robot", &robot_path];
        assert_eq!(
            run(&[command, &options].concat()).expect_refusal(),
            format!(
                "lizard: {elf} has the robot {image_robot} in it, and not {robot_path}, which is {wanted_robot}; \
                 without --elf, the firmware inside this program runs with any robot"
            ),
            "{command:?}"
        );
    }
}
