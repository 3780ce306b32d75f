//! Tests that compare the guard of every robot in this repository with floating point and with the robot's maps of
//! certified cells. They check one in 256 pairs of servo positions; `make prove` checks all pairs.
//!
//! In a narrow band around a limit, rounding may change the guard's decision. Both decisions are therefore allowed in
//! this band, whose width is [`lizard_proof::margin_band`] for a margin.

use std::iter::repeat;

use lizard_host_tests::{NamedRobot, load_robots_from_files, read_file, seed};
use lizard_proof::{PairSample, Proof};
use lizard_robot::Robot;

/// Number of pairs of servo positions for each pair that is checked.
const SAMPLE_ONE_IN: u32 = 256;

#[test]
fn the_guard_decides_correctly_for_every_sampled_pair_outside_the_bands_or_in_a_cell() {
    for (number, NamedRobot { name, robot }) in (0..).zip(load_robots_from_files()) {
        // Each robot and each seed gets a different sample of the pairs.
        let sample = PairSample {
            one_in: SAMPLE_ONE_IN,
            offset: (seed().wrapping_add(number) % u64::from(SAMPLE_ONE_IN)) as u32,
        };

        let proof = Proof::compute(&robot, robot.firmware(), sample, &|_| {});
        let findings = proof.findings.iter();
        let pair_counts = findings.map(|finding| finding.tally.pair_count);
        let pair_count: u64 = pair_counts.sum();
        assert!(pair_count > 250_000, "only {pair_count} pairs were checked");
        let certified_count = proof.certified_count();
        assert!(
            certified_count > pair_count / 50,
            "only {certified_count} of {pair_count} pairs are in certified cells"
        );
        for finding in &proof.findings {
            let (part, example) = (&finding.part, &finding.tally.example);
            let message = format!("{name}, {part} with {sample:?}: {example:?}");
            assert_eq!(finding.tally.wrong_count, 0, "{message}");
        }
    }
}

#[test]
fn a_guard_with_another_robots_lengths_fails_the_proof() {
    let text = read_file("robots/paper.toml");
    // Removes `look`, which is unsafe with the longer couplers, and all gaits after it.
    let text = text.split("[gait.look]").next().unwrap_or_default();
    let robot = Robot::parse(text).expect("the paper's robot is valid");
    let longer_text = text
        .replace("\nl2 = 50.0 ", "\nl2 = 51.0 ")
        .replace("\nl10 = 135.0 ", "\nl10 = 136.0 ")
        .replace("\nl15 = 135.0 ", "\nl15 = 136.0 ");
    let longer_robot = Robot::parse(&longer_text).expect("the longer robot is valid");
    let sample = PairSample {
        one_in: 4096,
        offset: 1,
    };
    let proof = Proof::compute(&robot, robot.firmware(), sample, &|_| {});
    assert_eq!(proof.wrong_count(), 0);
    let proof = Proof::compute(&robot, longer_robot.firmware(), sample, &|_| {});
    // The findings are for the two ends, the two sides, and the legs, whose margins do not depend on lengths.
    let has_longer_bars = [true, false, true, true].into_iter().chain(repeat(false));
    for (finding, has_longer_bars) in proof.findings.iter().zip(has_longer_bars) {
        let is_wrong = finding.tally.wrong_count > 0;
        assert_eq!(is_wrong, has_longer_bars, "{}", finding.part);
    }
}
