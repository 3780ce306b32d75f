//! The gaits as the servos get them, against the gaits in floating point, and
//! where they lead.

use lizard_host::sim::analysis::instants;
use lizard_host_tests::robot;
use lizard_robot::CheckedGait;
use simulated_uno::Fidelity;

use crate::{SECOND, awake, for_each};

/// Between the tables and floating point, deg: the project's promise.
const TABLES: f64 = 0.10;
/// Half a cycle of 62.5 ns at 10 us per degree.
const HALF_CYCLE: f64 = 0.5 / 160.0;
/// A gait gathers its pace in seven frames, by this share of it in each.
const GATHERS: (usize, f64) = (7, 147.0 / 1024.0);

/// Where each gait leads in a cycle, mm and deg, by a separate implementation of
/// the contact model.
const LEADS: [(&str, f64, f64); 9] = [
    ("stand", 0.0, 0.0),
    ("walk", 34.16, 0.0),
    ("trot", 26.66, 0.0),
    ("crawl", 30.78, 0.0),
    ("back", -34.16, 0.0),
    ("left", 0.0, 15.34),
    ("right", 0.0, -15.34),
    ("arc-left", 17.71, 5.27),
    ("arc-right", 17.71, -5.27),
];

/// Servo angles frame by frame, deg, from a second after power-on, when the gait
/// is asked for.
fn decoded(gait: &CheckedGait, fidelity: Fidelity) -> Vec<[f64; 4]> {
    let mut bench = awake(fidelity);
    let line = gait.name().replace('-', " ");
    assert_eq!(bench.say(&line), format!("ok {line}"));
    let frames = bench.run_for_frames((3.0 * gait.period()) as u64 * SECOND + 2 * SECOND);
    let angles = |at: lizard_host::sim::analysis::Instant| at.angles.expect("four pulses");
    instants(robot(), &frames).into_iter().map(angles).collect()
}

/// The phase so many frames after a gait has begun.
fn phase(gait: &CheckedGait, frames: usize) -> f64 {
    let gone = |frame: usize| (frame as f64 * GATHERS.1).min(1.0);
    let full: f64 = (1..=frames).map(gone).sum();
    gait.phase(full / SECOND as f64)
}

/// The largest deviation of a servo from the gait that begins at frame `begin`.
fn worst(gait: &CheckedGait, frames: &[[f64; 4]], begin: usize) -> f64 {
    let off = |(n, angles): (usize, &[f64; 4])| {
        let float = gait.angles(phase(gait, n));
        (0..4)
            .map(|i| (angles[i] - float[i]).abs())
            .fold(0.0, f64::max)
    };
    frames[begin..]
        .iter()
        .enumerate()
        .map(off)
        .fold(0.0, f64::max)
}

/// The frame at which the gait begins: the one unknown of the comparison.
fn begins(gait: &CheckedGait, frames: &[[f64; 4]]) -> usize {
    let by_worst =
        |a: &usize, b: &usize| worst(gait, frames, *a).total_cmp(&worst(gait, frames, *b));
    // At most a second of stroke to the first pose, and it is past the answer.
    let begin = (0..SECOND as usize).min_by(by_worst);
    begin.expect("a second has frames")
}

#[test]
fn the_pulses_of_every_gait_follow_it_frame_by_frame() {
    for_each(&[Fidelity::Stock, Fidelity::DataSheet], |fidelity| {
        for gait in robot().gaits() {
            let frames = decoded(gait, *fidelity);
            let begin = begins(gait, &frames);
            let off = worst(gait, &frames, begin);
            println!(
                "{:<10} {} frames, max {off:.4} deg",
                gait.name(),
                frames.len() - begin
            );
            assert!(off <= TABLES + HALF_CYCLE, "{}: {off} deg", gait.name());
            // A frame sooner or later would not do, so frames are told apart.
            if gait.name() != "stand" {
                for other in [begin + 1, begin.wrapping_sub(1)] {
                    assert!(other >= frames.len() || worst(gait, &frames, other) > 2.0 * off);
                }
            }
        }
    });
}

#[test]
fn the_pulses_of_every_gait_lead_where_the_contact_model_says() {
    for_each(&LEADS, |&(name, forward, turn)| {
        let gait = robot().gait(name).expect("it is in robot.toml");
        let frames = decoded(gait, Fidelity::DataSheet);
        let begin = begins(gait, &frames);
        // From the first frame at full pace that begins a cycle, whole cycles: two
        // of those that are no whole number of frames.
        let cycles = if (gait.period() * SECOND as f64).fract() == 0.0 {
            1
        } else {
            2
        };
        let length = (f64::from(cycles) * gait.period() * SECOND as f64) as usize;
        let step = 1.0 / (gait.period() * SECOND as f64);
        let from = (begin + GATHERS.0..frames.len())
            .find(|frame| {
                let phase = phase(gait, frame - begin);
                if gait.is_reversed() {
                    1.0 - phase <= step
                } else {
                    phase < step
                }
            })
            .expect("a cycle begins");
        let way = robot().travel(frames[from..=from + length].iter().copied());
        let (ahead, turned) = (
            way.forward / f64::from(cycles),
            way.turn / f64::from(cycles),
        );
        println!("{name:<10} {ahead:7.2} mm {turned:7.2} deg");
        let most = 0.3f64.max(forward.abs() * 0.01);
        assert!((ahead - forward).abs() <= most, "{name}: {way:?}");
        assert!((turned - turn).abs() <= 0.2, "{name}: {way:?}");
        // Within a cycle the body sways; what it faces when one begins is not
        // promised to a degree.
        if turn == 0.0 {
            assert!(way.left.abs() <= 1.0, "{name}: {way:?}");
        }
    });
}
