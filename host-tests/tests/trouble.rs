//! Tests with trouble at random moments of all activities: a hundredth of the scenarios of `make trouble`.

use std::collections::BTreeSet;
use std::thread;

use lizard_host_tests::trouble::{Activity, Scenario, campaign, play};
use lizard_host_tests::{FirmwareBench, patrol_of, patrolling, root, seed};
use lizard_robot::Robot;

/// Number of scenarios. Of thirteen scenarios, four are drives, and each other activity has one.
const COUNT: u64 = 156;

#[test]
fn trouble_at_any_moment_breaks_no_rule() {
    let image = FirmwareBench::image_with(patrolling());
    let threads = thread::available_parallelism().map_or(1, |n| n.get());
    let summary = campaign(&image, patrolling(), seed(), COUNT, threads, |_, _| {});
    let first_failure = summary.failures.first();
    assert!(
        summary.failures.is_empty(),
        "{}  alone: make trouble SEED={} ONLY={}\n\n{summary}",
        first_failure.map_or_else(String::new, ToString::to_string),
        seed(),
        first_failure.map_or(0, |failure| failure.scenario.number),
    );
    let activities: BTreeSet<Activity> = Activity::ALL.into();
    let played: BTreeSet<Activity> = summary.activities.keys().copied().collect();
    assert_eq!(played, activities);
    for (activity, (played_count, _)) in summary.activities {
        let share = if activity == Activity::Driving { 4 } else { 1 };
        assert_eq!(played_count, share * COUNT / 13, "{activity}");
    }
}

#[test]
fn a_scenario_follows_from_its_seed_and_number_alone() {
    for number in 0..100 {
        let scenario = Scenario::of(7, number, patrolling());
        assert_eq!(scenario, Scenario::of(7, number, patrolling()));
        assert_ne!(scenario.steps, Scenario::of(8, number, patrolling()).steps);
    }
}

#[test]
fn most_patrols_of_the_scenarios_get_as_far_as_the_wait_for_a_wall() {
    let image = FirmwareBench::image_with(patrolling());
    let scenarios = (0..COUNT).map(|number| Scenario::of(seed(), number, patrolling()));
    let patrols = scenarios.filter(|scenario| scenario.activity == Activity::Patrolling);
    let reaches_wall_wait = |scenario: &Scenario| {
        let record = play(&image, patrolling(), scenario);
        record
            .lines
            .iter()
            .any(|line| line.text == "# waiting for nose")
    };
    let walked_count = patrols.filter(reaches_wall_wait).count() as u64;
    assert!(walked_count > COUNT / 13 / 2, "{walked_count}");
}

#[test]
fn a_robot_without_room_for_a_routine_patrols_with_fewer_gaits() {
    let mut text = std::fs::read_to_string(root().join("robot.toml")).expect("a robot.toml");
    let mut full_robot = Robot::parse(&text).expect("a robot");
    for n in 0.. {
        text += &format!("[gait.more-{n}]\nlike = \"walk\"\n");
        match Robot::parse(&text) {
            Ok(robot) => full_robot = robot,
            Err(_) => break,
        }
    }
    let text = text.rsplit_once("[gait.").expect("a gait").0;
    let patrolling = patrol_of(text).expect("room for a routine");
    assert!(patrolling.gaits().len() < full_robot.gaits().len());
    assert!(patrolling.gaits().len() > 5);
    assert!(patrolling.routine("patrol").is_some());
}
