//! Tests that commands refuse an image that was built for a robot other than the selected one.

use std::path::PathBuf;

use crate::harness::{repo_root, robot_path, run};

fn release_folder() -> PathBuf {
    repo_root().join("target/avr-atmega328p/release")
}

/// Parses the robot's name and hash from the first line of a report of `lizard gaits` or of the firmware's build.
fn parse_name_and_hash(report: &str) -> String {
    let first_line = report.lines().next().expect("the report has a line");
    let parts = first_line.split_once("robot ");
    parts.expect("the line names a robot").1.to_owned()
}

/// Reads the name and hash of the robot in the image that `make firmware` has built.
fn read_image_robot() -> String {
    let report = std::fs::read_to_string(release_folder().join("gaits.txt"));
    parse_name_and_hash(&report.expect("`make firmware` has been run"))
}

/// Returns the path, and the name and hash, of a robot that is not in the image.
fn find_other_robot(image_robot: &str) -> (String, String) {
    let robots = ["unequal", "large"].map(|name| {
        let path = robot_path(name);
        let report = run(&["gaits", "--robot", &path]).expect_success();
        (path, parse_name_and_hash(&report))
    });
    let other_robot = robots.into_iter().find(|(_, robot)| robot != image_robot);
    other_robot.expect("at most one of two robots is in the image")
}

#[test]
fn every_command_that_runs_an_image_refuses_an_elf_of_another_robot() {
    let image_robot = read_image_robot();
    let (selected_path, selected_robot) = find_other_robot(&image_robot);
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
        let advice = match command {
            ["sim", "bench"] => "",
            _ => "; omit --elf to run the built-in firmware with any robot",
        };
        assert_eq!(
            run(&[command, &options].concat()).expect_refusal(),
            format!(
                "lizard: {elf} contains the robot {image_robot}, expected {selected_path}, which is \
                 {selected_robot}{advice}"
            ),
            "{command:?}"
        );
    }
}
