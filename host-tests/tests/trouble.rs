//! Trouble at random moments of everything that the robot does: a hundredth of what
//! `make trouble` plays.

use std::collections::BTreeSet;
use std::thread;

use lizard_host_tests::trouble::{Activity, Scenario, campaign};
use lizard_host_tests::{FirmwareBench, robot, seed};

/// As many scenarios, an eighth for each activity.
const COUNT: u64 = 152;

#[test]
fn whatever_goes_wrong_at_whatever_moment_the_robot_does_what_a_user_would_sign() {
    let image = FirmwareBench::image();
    let threads = thread::available_parallelism().map_or(1, |n| n.get());
    let summary = campaign(&image, robot(), seed(), COUNT, threads, |_, _| {});
    let first = summary.failures.first();
    assert!(
        summary.failures.is_empty(),
        "{}  alone: make trouble SEED={} ONLY={}\n\n{summary}",
        first.map_or_else(String::new, ToString::to_string),
        seed(),
        first.map_or(0, |failure| failure.scenario.number),
    );
    let activities: BTreeSet<Activity> = Activity::ALL.into();
    let played: BTreeSet<Activity> = summary.activities.keys().copied().collect();
    assert_eq!(played, activities);
    assert!(
        summary
            .activities
            .values()
            .all(|(played, _)| *played == COUNT / 8)
    );
}

#[test]
fn a_scenario_is_made_of_its_seed_and_number_alone() {
    for number in 0..100 {
        let scenario = Scenario::of(7, number, robot());
        assert_eq!(scenario, Scenario::of(7, number, robot()));
        assert_ne!(scenario.steps, Scenario::of(8, number, robot()).steps);
    }
}
