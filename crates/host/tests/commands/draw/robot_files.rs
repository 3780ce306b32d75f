//! Reads the robot files in robots/, their values and the drawings of their robots.

use lizard_robot::Robot;

use crate::harness::{read_file, read_value, repo_root};

use super::drawing::Drawing;

/// Reads the files in robots/; returns their paths and texts.
pub fn read_robot_files() -> Vec<(String, String)> {
    let folder = std::fs::read_dir(repo_root().join("robots")).expect("robots/ is readable");
    let paths = folder.map(|entry| entry.expect("robots/ is readable").path());
    let paths = paths.filter(|path| path.extension() == Some("toml".as_ref()));
    let files = paths.map(|path| {
        let text = std::fs::read_to_string(&path).expect("the file is readable");
        (path.display().to_string(), text)
    });
    let files: Vec<(String, String)> = files.collect();
    assert!(files.len() >= 4);
    files
}

/// Returns the first value of `key` after the header `[servo.<servo>]`.
pub fn read_servo_value<'a>(text: &'a str, servo: &str, key: &str) -> &'a str {
    let table = text.split_once(&format!("[servo.{servo}]"));
    read_value(table.expect("the file has the servo's table").1, key)
}

/// Reads a servo's neutral angle, deg.
pub fn read_neutral_angle(text: &str, servo: &str) -> f64 {
    let value = read_servo_value(text, servo, "neutral");
    value.parse().expect("the value is a number")
}

pub fn paper_toml() -> String {
    read_file("robots/paper.toml")
}

/// Draws the robot of a robot file, and parses the drawing.
pub fn draw_robot(draw: fn(&Robot) -> String, robot_toml: &str) -> Drawing {
    let robot = Robot::parse(robot_toml).expect("the robot file is valid");
    Drawing::parse(&draw(&robot))
}
