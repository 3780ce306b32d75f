//! Random commands, and the random settings that a scenario makes before its fault. The settings are saved or unsaved
//! trims, scales and directions of servos, the gait after power-on, the `deadman` time, or a servo's travel.

use fastrand::Rng;
use lizard_host::patrol::PATROL;
use lizard_host::sim::gait_choice;
use lizard_robot::{Robot, to_command};

use super::record::MS;
use super::step::Step;

/// Returns the command for a random gait that moves, or `stand` if no gait moves.
pub fn random_gait(rng: &mut Rng, robot: &Robot) -> String {
    let gaits = gait_choice::list_moving_gaits(robot);
    to_command(rng.choice(&gaits).unwrap_or(&"stand"))
}

/// Returns the command for a random pose in which each servo is within 9 degrees of neutral.
pub fn random_pose(rng: &mut Rng, robot: &Robot) -> String {
    format_pose(robot.servos().each_ref().map(|servo| {
        let sweep = f64::from(rng.i32(-900..900)) / 100.0;
        (servo.neutral + sweep).rem_euclid(360.0)
    }))
}

/// Returns the command for the pose with these angles, deg.
fn format_pose(angles: [f64; 4]) -> String {
    let angles = angles.map(|angle| format!("{angle:.2}"));
    format!("pose {}", angles.join(" "))
}

/// Returns the command for a random trim of a random servo.
pub fn random_trim(rng: &mut Rng) -> String {
    let servo = rng.u8(1..=4);
    let degrees = f64::from(rng.i32(-1_500..1_500)) / 100.0;
    format!("trim {servo} {degrees:.2}")
}

fn say(line: impl Into<String>) -> Step {
    Step::Say(line.into())
}

/// A servo scale that is larger than any in robot.toml, us per degree, as text for the console.
pub const LARGE_SCALE: &str = "17.77";

/// Returns a random command that makes the main loop apply the servos' settings again.
pub fn random_adjustment(rng: &mut Rng) -> String {
    match rng.u8(0..5) {
        0 => "load".into(),
        1 => "factory".into(),
        2 => format!("scale {} {LARGE_SCALE}", rng.u8(1..=4)),
        3 => {
            let servo = rng.u8(1..=4);
            let sign = if rng.bool() { '+' } else { '-' };
            format!("dir {servo} {sign}")
        }
        _ => random_trim(rng),
    }
}

/// Returns steps that change random settings; in about half of the cases, no steps.
pub fn random_settings(rng: &mut Rng, robot: &Robot) -> Vec<Step> {
    let wait = |ms: u64| Step::Wait(ms * MS);
    match rng.u8(0..16) {
        // Unsaved settings, which a reset discards.
        0 | 1 => vec![say(random_trim(rng)), wait(150)],
        2 => vec![say(format!("dir {} -", rng.u8(1..=4))), wait(150)],
        // Saved settings.
        3 => vec![say(random_trim(rng)), wait(150), say("save")],
        4 => {
            let boot_gait = if rng.bool() { "walk" } else { PATROL };
            vec![say(format!("boot {boot_gait}")), say("save")]
        }
        5 => vec![say("boot rest"), say("save")],
        6 => vec![say(format!("deadman {}", rng.u16(100..2_000)))],
        // The saved travel is narrower than the travel in use.
        7 => {
            let servo_index = rng.usize(0..4);
            let mut angles = robot.servos().map(|servo| servo.neutral);
            let neutral = angles[servo_index];
            // The gaits need 23 degrees of travel. Beyond 23.9 degrees, the margin of a leg is too small.
            let [min, max] = [-23.2, 23.2].map(|sweep| (neutral + sweep).rem_euclid(360.0));
            let sweep = if rng.bool() { 23.7 } else { -23.7 };
            angles[servo_index] = (neutral + sweep).rem_euclid(360.0);
            vec![
                say(format!("limit {} {min:.2} {max:.2}", servo_index + 1)),
                say("save"),
                say("factory"),
                wait(200),
                say(format_pose(angles)),
                wait(400),
            ]
        }
        // Changes the scale and the trim of every servo.
        8 => {
            let scales = (1..=4).map(|servo| say(format!("scale {servo} {LARGE_SCALE}")));
            let trims = (1..=4).map(|servo| say(format!("trim {servo} 3.3")));
            let mut steps: Vec<Step> = scales.chain(trims).collect();
            steps.extend([wait(300), say("save"), wait(50)]);
            steps
        }
        _ => Vec::new(),
    }
}
