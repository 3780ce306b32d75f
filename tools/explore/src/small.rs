//! A small robot: the paper's robot with few and short gaits, so that the states of a walk
//! soon repeat. One of its gaits is unsafe, which would be refused in a robot.toml.

use lizard_core::numbers::calibration::NeededTravel;
use lizard_core::numbers::gaits::{Channel, Gait, Input, SAMPLES_PER_WAVE, Step, Wave};
use lizard_core::numbers::robot::Robot;
use lizard_core::numbers::section::Content;
use lizard_core::numbers::slew::Slew;
use lizard_core::numbers::units::Sweep;
use lizard_robot::flash;

/// The slew limit, 1/65536 turn in a frame: a third of the paper's, so that a servo that starts with
/// a pulse for a wrong position jumps by more than the limit.
const SLEW_PER_FRAME: u16 = 364;

/// The sweep to either side of neutral that the gaits declare, 1/65536 turn; only `stray` exceeds it.
const DECLARED_REACH: i16 = 1_000;

/// Arduino number of the button's pin, A1.
pub const BUTTON: u8 = 15;
/// Arduino number of the pin of the nose contact, A2.
pub const NOSE: u8 = 16;

/// Returns the paper's robot with the gaits `stand`, `walk`, `trot` and `stray`, which leaves the safe
/// poses, and two endless routines: `round` walks and stands, `patrol` waits for a button, walks up to a
/// wall, and turns away.
///
/// # Panics
/// If robots/paper.toml is not valid.
pub fn small_robot() -> Robot<'static> {
    let text = include_str!("../../../robots/paper.toml");
    let paper = lizard_robot::Robot::parse(text).expect("robots/paper.toml is right");
    let angle_rad = |n: usize| n as f64 / SAMPLES_PER_WAVE as f64 * std::f64::consts::TAU;
    let wave_of = |height_at: &dyn Fn(usize) -> f64| -> Wave {
        std::array::from_fn(|n| (height_at(n) * 1820.0).round() as i16)
    };
    let mut content = Content {
        slew: Slew::new(SLEW_PER_FRAME),
        needed_travel: [NeededTravel {
            min: Sweep(-DECLARED_REACH),
            max: Sweep(DECLARED_REACH),
        }; 4],
        gaits: Vec::new(),
        names: Vec::new(),
        waves: vec![
            wave_of(&|n| angle_rad(n).sin()),
            wave_of(&|n| 4.0 * (1.0 - angle_rad(n).cos())),
        ],
        ..paper.content().clone()
    };
    // A cycle of sixteen frames.
    let increment = (1 << 24) / 16;
    add_gait(&mut content, "stand", increment, 0, [0; 4]);
    add_gait(
        &mut content,
        "walk",
        increment,
        0,
        [7_000, -6_000, 5_000, 4_000],
    );
    add_gait(
        &mut content,
        "trot",
        -increment,
        0,
        [-5_000, 6_000, 4_000, 7_000],
    );
    add_gait(&mut content, "stray", increment / 12, 1, [16_384, 0, 0, 0]);
    let (walk, trot) = (1, 2);
    add_routine(
        &mut content,
        "round",
        &[(Step::CYCLES, walk, 1), (Step::FRAMES, 0, 10)],
    );
    let (button, nose) = (Input::button(BUTTON).byte(), Input::nose(NOSE).byte());
    let patrol = [
        (Step::UNTIL, button, 0),
        (Step::WAIT, 0, Step::ENDLESS),
        (Step::UNTIL, nose, 0),
        (Step::FRAMES, walk, Step::ENDLESS),
        (Step::CYCLES, trot, 1),
    ];
    add_routine(&mut content, "patrol", &patrol);
    Robot::open(flash(&content.section_bytes())).expect("whole")
}

fn add_gait(content: &mut Content, name: &str, increment: i32, wave: u16, gains: [i16; 4]) {
    content.gaits.push(Gait {
        name_start: content.names.len() as u16,
        name_length: name.len() as u16,
        increment,
        channels: gains.map(|gain| Channel {
            wave,
            offset: 0,
            gain,
        }),
    });
    content.names.extend(name.bytes());
}

/// Adds an endless routine.
fn add_routine(content: &mut Content, name: &str, steps: &[(u8, u8, u16)]) {
    content.gaits.push(Gait {
        name_start: content.names.len() as u16,
        name_length: name.len() as u16,
        ..Gait::routine(content.steps.len() as u16, steps.len() as u16, 0)
    });
    content.names.extend(name.bytes());
    let step_of = |(kind, gait, count): &(u8, u8, u16)| Step {
        kind: *kind,
        gait: *gait,
        count: *count,
    };
    content.steps.extend(steps.iter().map(step_of));
}
