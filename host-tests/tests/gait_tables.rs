//! The gaits as the firmware's core reads them from flash, against the tables
//! that were written for it and against floating point: every phase of every
//! gait.

use lizard::clearance::Clearance;
use lizard::gait::GaitId;
use lizard_robot::{Robot, STEPS_PER_DEGREE};

/// The core's phase has 24 bits, of which the tables see the first 16.
const PHASES: u32 = 65_536;
/// A gait's own pace, in 1/1024.
const FULL_PACE: u16 = 1024;

fn robot() -> Robot {
    Robot::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../robot.toml")).expect("robot.toml")
}

#[test]
fn the_core_has_the_gaits_of_the_file_in_its_order() {
    let robot = robot();
    assert_eq!(lizard::robot::TABLES_HASH, robot.tables_hash());
    let names: Vec<String> = GaitId::all()
        .map(|id| {
            String::from_utf8(id.load().name.to_vec())
                .expect("ASCII")
                .trim_end()
                .replace(' ', "-")
        })
        .collect();
    let expected: Vec<&str> = robot.gaits.iter().map(|gait| gait.name.as_str()).collect();
    assert_eq!(names, expected);
}

#[test]
fn the_core_reads_every_table_bit_for_bit_at_every_phase() {
    let robot = robot();
    for (index, id) in GaitId::all().enumerate() {
        let gait = id.load();
        for phase in 0..PHASES {
            // The eight bits that the tables do not see make no difference.
            for below in [0, 0xff] {
                let sweeps = gait.pose(phase << 8 | below).0;
                let expected = robot.tables.sweeps(index, phase as u16);
                assert_eq!(sweeps, expected, "{} at {phase}", robot.gaits[index].name);
            }
        }
    }
}

#[test]
fn the_core_is_within_a_tenth_of_a_degree_of_every_gait_at_every_phase() {
    let robot = robot();
    for (float, id) in robot.gaits.iter().zip(GaitId::all()) {
        let gait = id.load();
        let (mut worst, mut squares) = (0.0f64, 0.0);
        for phase in 0..PHASES {
            let sweeps = gait.pose(phase << 8).0;
            let angles = float.angles(f64::from(phase) / f64::from(PHASES));
            for servo in 0..4 {
                let angle = float.neutral[servo] + f64::from(sweeps[servo]) / STEPS_PER_DEGREE;
                let off = (angle - angles[servo]).abs();
                worst = worst.max(off);
                squares += off * off;
            }
        }
        let rms = (squares / f64::from(4 * PHASES)).sqrt();
        println!("{:<12} max {worst:.4} deg, rms {rms:.4} deg", float.name);
        assert!(worst <= 0.10, "{}: {worst} deg", float.name);
    }
}

#[test]
fn the_guard_lets_every_gait_pass_at_every_phase() {
    for id in GaitId::all() {
        let gait = id.load();
        for phase in 0..PHASES {
            let hazard = Clearance::of(&gait.pose(phase << 8)).hazard();
            assert!(hazard.is_none(), "{:?} at {phase}: {hazard:?}", gait.name);
        }
    }
}

#[test]
fn a_hundred_cycles_take_a_hundred_periods_in_the_core() {
    let robot = robot();
    for (float, id) in robot.gaits.iter().zip(GaitId::all()) {
        let gait = id.load();
        let frames = (100.0 * float.period * lizard_robot::FRAMES_PER_SECOND).round() as u32;
        let phase = (0..frames).fold(0, |phase, _| gait.advance(phase, FULL_PACE));
        // The advance is rounded to 1/2^24 cycle, so each frame may be half off.
        let off = phase.min((1 << 24) - phase);
        assert!(
            off <= frames / 2,
            "{} is {off} of 2^24 off after {frames} frames",
            float.name
        );
    }
}
