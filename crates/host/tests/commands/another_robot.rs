//! Tests that commands refuse an image that was built for a robot other than the selected one.

use std::path::PathBuf;

use crate::program::{repo_root, robot_path, run};

fn release_folder() -> PathBuf {
    repo_root().join("target/avr-atmega328p/release")
}

/// Returns the robot's name and hash from the first line of a report of `lizard gaits` or of the firmware's build.
fn name_and_hash_in(report: &str) -> String {
    let first_line = report.lines().next().expect("the report has a line");
    let parts = first_line.split_once("robot ");
    parts.expect("the line names a robot").1.to_owned()
}

/// The name and hash of the robot in the image that `make firmware` built.
fn robot_of_image() -> String {
    let gaits = std::fs::read_to_string(release_folder().join("gaits.txt"));
    name_and_hash_in(&gaits.expect("`make firmware` has been run"))
}

/// The path of a robot that is not in the image, and that robot's name and hash.
fn robot_outside_image() -> (String, String) {
    let robots = ["unequal", "large"].map(|name| {
        let path = robot_path(name);
        let report = run(&["gaits", "--robot", &path]).expect_success();
        (path, name_and_hash_in(&report))
    });
    let image_robot = robot_of_image();
    let other_robot = robots.into_iter().find(|(_, robot)| *robot != image_robot);
    other_robot.expect("at most one of two robots is in the image")
}

#[test]
fn every_command_that_runs_an_image_refuses_an_elf_of_another_robot() {
    let (selected_path, selected_robot) = robot_outside_image();
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
        let options = ["--elf", &elf, "--robot", &selected_path];
        assert_eq!(
            run(&[command, &options].concat()).expect_refusal(),
            format!(
                "lizard: {elf} has the robot {image_robot} in it, and not {selected_path}, which is {selected_robot}; \
                 without --elf, the firmware inside this program runs with any robot"
            ),
            "{command:?}"
        );
    }
}
