//! Random commands, and the random settings of a scenario before its fault. The settings are saved or unsaved trims,
//! scales and directions of servos, the gait after power-on, the `deadman` time, or a servo's travel.

use fastrand::Rng;
use lizard_host::patrol::PATROL;
use lizard_robot::Robot;

use super::record::MS;
use super::step::Step;

/// Returns the command for a random pose in which each servo is within 9 degrees of neutral.
pub fn random_pose(rng: &mut Rng, robot: &Robot) -> String {
    let angles = robot.servos().each_ref().map(|servo| {
        let sweep = f64::from(rng.i32(-900..900)) / 100.0;
        format!("{:.2}", (servo.neutral + sweep).rem_euclid(360.0))
    });
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

/// Returns the command that limits a servo's travel to this many degrees on either side of neutral.
fn limit_command(servo: usize, degrees: f64, robot: &Robot) -> String {
    let neutral = robot.servos()[servo].neutral;
    let [min, max] = [-degrees, degrees].map(|sweep| (neutral + sweep).rem_euclid(360.0));
    format!("limit {} {min:.2} {max:.2}", servo + 1)
}

/// A servo scale that is larger than any in robot.toml, us per degree, as text for the console.
pub const LARGE_SCALE: &str = "17.77";

/// Returns a random command that makes the main loop apply the servos' settings again.
pub fn random_adjustment(rng: &mut Rng) -> String {
    match rng.u8(0..5) {
        0 => "load".into(),
        1 => "factory".into(),
        2 => format!("scale {} {LARGE_SCALE}", rng.u8(1..=4)),
        3 => format!(
            "dir {} {}",
            rng.u8(1..=4),
            if rng.bool() { '+' } else { '-' }
        ),
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
            let servo = rng.usize(0..4);
            // The gaits need 23 degrees of travel. Beyond 23.9 degrees, the margin of a leg is too small.
            let degrees = 23.2;
            let limit_line = limit_command(servo, degrees, robot);
            let neutral = robot.servos().map(|servo| servo.neutral);
            let mut pose = neutral;
            pose[servo] = (pose[servo] + if rng.bool() { 23.7 } else { -23.7 }).rem_euclid(360.0);
            let pose = pose.map(|angle| format!("{angle:.2}")).join(" ");
            vec![
                say(limit_line),
                say("save"),
                say("factory"),
                wait(200),
                say(format!("pose {pose}")),
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
