//! Small robots for the search: the paper's robot with a few short gaits, so that states soon repeat. One gait leaves
//! the safe poses; no robot.toml can have such a gait.

use lizard_core::numbers::calibration::SweepRange;
use lizard_core::numbers::gaits::{Channel, Gait, Input, SAMPLES_PER_WAVE, Step, Wave};
use lizard_core::numbers::robot::Robot;
use lizard_core::numbers::section::Content;
use lizard_core::numbers::slew::Slew;
use lizard_core::numbers::units::Sweep;
use lizard_robot::keep_section;

/// The slew limit, 1/65536 turn per frame. This is a third of the paper's limit, so a servo that wakes in a wrong
/// position exceeds the limit.
const SLEW_LIMIT: u16 = 364;

/// The sweep to either side of neutral that the section declares as needed, 1/65536 turn. Only `stray` exceeds it.
const NEEDED_SWEEP: i16 = 1_000;

/// The Arduino number of the button's pin, A1.
pub const BUTTON_PIN: u8 = 15;
/// The Arduino number of the obstacle switch's pin, A2.
pub const NOSE_PIN: u8 = 16;

/// Returns the paper's robot with four gaits and two endless routines. The gait `stray` leaves the safe poses. The
/// routine `round` walks and stands; `patrol` waits for the button, walks up to a wall and turns away.
///
/// # Panics
/// If robots/paper.toml is not valid.
pub fn small_robot() -> Robot<'static> {
    open(&small_content())
}

/// Returns the small robot with the motion of `stray` in its gait `stand`, so that the guard holds the robot soon after
/// power-on.
///
/// # Panics
/// If robots/paper.toml is not valid.
pub fn straying_robot() -> Robot<'static> {
    let mut content = small_content();
    let (stand, stray) = (0, 3);
    content.gaits[stand].increment = content.gaits[stray].increment;
    content.gaits[stand].channels = content.gaits[stray].channels;
    open(&content)
}

fn open(content: &Content) -> Robot<'static> {
    Robot::open(keep_section(&content.section_bytes())).expect("the section is valid")
}

fn small_content() -> Content {
    let text = include_str!("../../../robots/paper.toml");
    let paper = lizard_robot::Robot::parse(text).expect("robots/paper.toml is valid");
    let to_rad = |sample: usize| sample as f64 / SAMPLES_PER_WAVE as f64 * std::f64::consts::TAU;
    // A height of 1 is 10 deg, in 1/65536 turn.
    let sample_wave = |height_at: &dyn Fn(f64) -> f64| -> Wave {
        std::array::from_fn(|sample| (height_at(to_rad(sample)) * 1820.0).round() as i16)
    };
    let mut content = Content {
        slew: Slew::new(SLEW_LIMIT),
        needed_travel: [SweepRange {
            min: Sweep(-NEEDED_SWEEP),
            max: Sweep(NEEDED_SWEEP),
        }; 4],
        gaits: Vec::new(),
        names: Vec::new(),
        waves: vec![
            sample_wave(&f64::sin),
            sample_wave(&|angle_rad: f64| 4.0 * (1.0 - angle_rad.cos())),
        ],
        ..paper.content().clone()
    };
    // A cycle takes sixteen frames.
    let increment = (1 << 24) / 16;
    add_gait(&mut content, "stand", increment, 0, [0; 4]);
    let walk_gains = [7_000, -6_000, 5_000, 4_000];
    add_gait(&mut content, "walk", increment, 0, walk_gains);
    let trot_gains = [-5_000, 6_000, 4_000, 7_000];
    add_gait(&mut content, "trot", -increment, 0, trot_gains);
    add_gait(&mut content, "stray", increment / 12, 1, [16_384, 0, 0, 0]);
    let (walk, trot) = (1, 2);
    let round = [(Step::CYCLES, walk, 1), (Step::FRAMES, 0, 10)];
    add_routine(&mut content, "round", &round);
    let patrol = [
        (Step::UNTIL, Input::button(BUTTON_PIN).byte(), 0),
        (Step::WAIT, 0, Step::ENDLESS),
        (Step::UNTIL, Input::nose(NOSE_PIN).byte(), 0),
        (Step::FRAMES, walk, Step::ENDLESS),
        (Step::CYCLES, trot, 1),
    ];
    add_routine(&mut content, "patrol", &patrol);
    content
}

/// Adds a gait whose four servos follow the same wave.
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
    let to_step = |(kind, gait_or_input, count): &(u8, u8, u16)| Step {
        kind: *kind,
        gait: *gait_or_input,
        count: *count,
    };
    content.steps.extend(steps.iter().map(to_step));
}
