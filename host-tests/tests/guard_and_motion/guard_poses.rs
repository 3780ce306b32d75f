//! Tests of the guard's decisions for poses in the entire travel of the servos.

use fastrand::Rng;
use lizard_core::guard::clearance::Clearance;
use lizard_core::guard::hazard::Hazard;
use lizard_core::numbers::part::Side;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::units::Sweep;
use lizard_host_tests::NamedRobot;
use lizard_proof::LENGTH_BAND_STEPS;
use lizard_robot::Robot;

use crate::reference::{
    ErrorStatistics, MARGIN_FIVE_BARS, MARGINS, MIN_TYPE2_LIMIT, Reference, is_safe, random_pose,
    random_pose_within, robots_with_rngs, steps_per_mm, to_sine, unclosed_five_bar_index,
};

/// Number of poses tested for each robot.
const POSE_COUNT: usize = 40_000;
/// Number of pairs of neighbouring poses, one on each side of a limit, tested for each robot.
const PAIR_COUNT: usize = 1500;

/// The guard's errors and decisions for many poses of one robot.
#[derive(Default)]
struct Findings {
    type2: ErrorStatistics,
    type1: ErrorStatistics,
    leg: ErrorStatistics,
    /// The errors of the strokes, in steps of the side's scale.
    stroke: ErrorStatistics,
    /// The largest error of each margin, in units of its tolerance.
    max_margin_errors: [f64; 10],
    safe_count: usize,
    refused_count: usize,
    /// The number of poses for which the guard and floating point decide differently.
    disagreement_count: usize,
    /// The largest distance of a pose with a disagreement from its nearest limit, in tolerances.
    max_disagreement: f64,
    /// The number of refusals for each of the twelve conditions.
    hazard_counts: [usize; 12],
}

impl Findings {
    /// Adds the guard's errors and decision for a pose, and asserts that the decision is correct outside the
    /// tolerances.
    fn add_pose(&mut self, robot: &Robot, pose: &Pose) {
        let firmware = robot.firmware();
        let clearance = Clearance::measure(firmware, pose);
        let hazard = clearance.first_hazard(firmware);
        let hazard_index = hazard.map(condition_index);
        match hazard_index {
            None => self.safe_count += 1,
            Some(index) => {
                self.refused_count += 1;
                self.hazard_counts[index] += 1;
            }
        }
        let reference = match Reference::compute(robot, pose) {
            Ok(reference) => reference,
            Err(error) => {
                // Index 0 is the head's type-2 margin, and index 1 is the tail's. If the tail does not close, the guard
                // may name the head.
                let unclosed_index = unclosed_five_bar_index(&error)
                    .expect("the sides of these robots always close");
                assert!(
                    hazard_index.is_some_and(|index| index <= unclosed_index),
                    "{pose:?}: {error}, {hazard:?}"
                );
                return;
            }
        };
        self.compare_values(robot, &clearance, &reference);
        let distances = reference.distances_from_limits();
        for (distance, is_violated) in distances.into_iter().zip(reference.violated) {
            assert!(
                distance.abs() <= 1.0 || is_violated == (distance < 0.0),
                "{reference:?}"
            );
        }
        let min_distance = reference.min_distance();
        if hazard.is_none() != (min_distance >= 0.0) {
            self.disagreement_count += 1;
            self.max_disagreement = self.max_disagreement.max(min_distance.abs());
        }
        assert!(
            min_distance.abs() <= 1.0 || hazard.is_none() == (min_distance > 0.0),
            "{pose:?} is {min_distance} tolerances from the nearest limit, but the guard reports {hazard:?}"
        );
        let Some(hazard_index) = hazard_index else {
            return;
        };
        // The named condition is violated, and all conditions that the guard checks earlier are satisfied.
        assert!(
            distances[hazard_index] <= 1.0,
            "{pose:?}: {hazard:?}, {reference:?}"
        );
        let mut earlier_distances = distances[..hazard_index].iter();
        assert!(
            earlier_distances.all(|distance| *distance >= -1.0),
            "{pose:?}: {hazard:?} is not the first violated condition, {reference:?}"
        );
    }

    /// Compares the guard's margins and strokes with floating point, and records the errors.
    fn compare_values(&mut self, robot: &Robot, clearance: &Clearance, reference: &Reference) {
        for (index, (value, exact)) in clearance.margins.iter().zip(reference.margins).enumerate() {
            if let Some(&five_bar) = MARGIN_FIVE_BARS.get(index)
                && (reference.margins[five_bar] < MIN_TYPE2_LIMIT
                    || reference.is_at_crossing(five_bar))
            {
                // This close to a type-2 singularity, the guard must only detect that the margin is small.
                let max_margin = MIN_TYPE2_LIMIT + reference.tolerances.margins[five_bar];
                assert!(
                    reference.is_at_crossing(five_bar)
                        || to_sine(clearance.margins[five_bar]) < max_margin,
                    "{reference:?}"
                );
                continue;
            }
            let statistics = match index {
                0..2 => &mut self.type2,
                2..6 => &mut self.type1,
                _ => &mut self.leg,
            };
            let error = to_sine(*value) - exact;
            statistics.add(error);
            self.max_margin_errors[index] = self.max_margin_errors[index]
                .max(error.abs() / reference.tolerances.margins[index]);
        }
        let lengths_sq = clearance.slider_lengths_sq.into_iter();
        let pairs = lengths_sq.zip(reference.strokes_mm);
        for (side, (length_sq, stroke)) in Side::ALL.into_iter().zip(pairs) {
            let slider = robot.firmware().slider(side);
            let steps = f64::from(length_sq).sqrt() - f64::from(slider.nominal_length);
            self.stroke.add(steps - stroke * steps_per_mm(slider.scale));
        }
    }

    /// Prints the findings, and asserts that every error is within its tolerance.
    fn print_and_check(&self, name: &str) {
        println!(
            "{name}: type-2 {}, type-1 {}, leg {}, stroke {} steps; {} safe, {} refused, \
             {} disagreements within {:.3} tolerances, margins within {:.3}; refusals per condition {:?}",
            self.type2,
            self.type1,
            self.leg,
            self.stroke,
            self.safe_count,
            self.refused_count,
            self.disagreement_count,
            self.max_disagreement,
            self.max_margin_errors.into_iter().fold(0.0, f64::max),
            self.hazard_counts
        );
        for (margin, max_error) in MARGINS.iter().zip(self.max_margin_errors) {
            assert!(
                max_error <= 1.0,
                "{name}: {margin:?} is {max_error} tolerances off"
            );
        }
        assert!(
            self.stroke.max_abs <= LENGTH_BAND_STEPS,
            "{name}: a stroke is {} steps off",
            self.stroke
        );
        assert!(
            self.safe_count > 0 && self.refused_count > 0,
            "{name}: all poses are safe, or all are refused"
        );
    }
}

/// Returns the index of the condition that a hazard names, among the ten margins and two strokes.
fn condition_index(hazard: Hazard) -> usize {
    match hazard {
        Hazard::Margin { margin, .. } => {
            let index = MARGINS.iter().position(|known| *known == margin);
            index.expect("the margin is one of the ten")
        }
        Hazard::Stroke { side, .. } => 10 + side as usize,
        Hazard::Travel(_) => unreachable!("a clearance ignores servo travel"),
    }
}

/// Returns random poses, some in the full travel, others closer to neutral and to the limits of the safe poses.
fn random_poses(rng: &mut Rng, robot: &Robot) -> impl Iterator<Item = Pose> {
    let calibration = robot.firmware().calibration();
    let travel_fractions = [1.0, 0.7, 0.4, 0.2];
    (0..POSE_COUNT).map(move |n| {
        let fraction = travel_fractions[n % travel_fractions.len()];
        random_pose_within(rng, &calibration, fraction)
    })
}

#[test]
fn the_guards_margins_and_decisions_match_floating_point() {
    let mut hazard_counts = [0; 12];
    for (NamedRobot { name, robot }, mut rng) in robots_with_rngs(100) {
        let mut findings = Findings::default();
        for pose in random_poses(&mut rng, robot) {
            findings.add_pose(robot, &pose);
        }
        findings.print_and_check(name);
        for (sum, count) in hazard_counts.iter_mut().zip(findings.hazard_counts) {
            *sum += count;
        }
    }
    let do_all_occur = hazard_counts.iter().all(|count| *count > 0);
    assert!(do_all_occur, "{hazard_counts:?}");
}

#[test]
fn the_guards_decision_changes_at_the_floating_point_limit() {
    for (NamedRobot { name, robot }, mut rng) in robots_with_rngs(200) {
        let firmware = robot.firmware();
        let mut findings = Findings::default();
        while findings.refused_count < PAIR_COUNT {
            let unsafe_pose = random_pose(&mut rng, &firmware.calibration());
            if is_safe(firmware, &unsafe_pose) {
                continue;
            }
            for pose in find_straddling_poses(robot, unsafe_pose) {
                findings.add_pose(robot, &pose);
            }
        }
        findings.print_and_check(name);
    }
}

/// Finds two neighbouring poses on the path from neutral to an unsafe pose, first a safe pose and then an unsafe pose.
/// Fractions of the path are in units of 1/65536.
fn find_straddling_poses(robot: &Robot, unsafe_pose: Pose) -> [Pose; 2] {
    let pose_at = |fraction: u32| {
        let scale = |sweep: Sweep| (i64::from(sweep.0) * i64::from(fraction)) >> 16;
        Pose(unsafe_pose.0.map(|sweep| Sweep(scale(sweep) as i16)))
    };
    let (mut safe_fraction, mut unsafe_fraction) = (0, 1 << 16);
    while unsafe_fraction - safe_fraction > 1 {
        let middle_fraction = (safe_fraction + unsafe_fraction) / 2;
        match is_safe(robot.firmware(), &pose_at(middle_fraction)) {
            true => safe_fraction = middle_fraction,
            false => unsafe_fraction = middle_fraction,
        }
    }
    [pose_at(safe_fraction), pose_at(unsafe_fraction)]
}

#[test]
fn the_smallest_margin_matches_kinematics() {
    for (NamedRobot { name, robot }, mut rng) in robots_with_rngs(400) {
        let mut safe_count = 0;
        for pose in random_poses(&mut rng, robot).take(10_000) {
            if !is_safe(robot.firmware(), &pose) {
                continue;
            }
            safe_count += 1;
            let reference = Reference::compute(robot, &pose).expect("a safe pose closes all loops");
            let smallest_margin = reference.margins.into_iter().fold(f64::INFINITY, f64::min);
            let error =
                to_sine(Clearance::measure(robot.firmware(), &pose).min_margin()) - smallest_margin;
            let max_tolerance = reference.tolerances.margins.into_iter().fold(0.0, f64::max);
            assert!(
                error.abs() <= max_tolerance,
                "{name}: {pose:?} is {error} off"
            );
        }
        assert!(safe_count > 10, "{name}: {safe_count} safe poses");
    }
}

#[test]
fn the_guards_arithmetic_never_overflows_even_beyond_the_servos_travel() {
    for (NamedRobot { robot, .. }, mut rng) in robots_with_rngs(500) {
        let mut findings = Findings::default();
        for _ in 0..10_000 {
            findings.add_pose(robot, &Pose([(); 4].map(|()| Sweep(rng.i16(..)))));
        }
        assert!(findings.refused_count > 0);
    }
}
