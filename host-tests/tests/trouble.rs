//! Fault-injection tests at random moments during all activities. `make trouble` runs 10 000 scenarios unless
//! COUNT is set.

use std::collections::BTreeSet;

use lizard_host_tests::trouble::{Activity, Scenario, run_campaign, run_scenario};
use lizard_host_tests::{FirmwareBench, patrolling_robot, read_file, robot_with_patrol, seed};
use lizard_robot::Robot;

/// The number of scenarios. Of thirteen scenarios, four are drives, and the other nine activities have one each.
const SCENARIO_COUNT: u64 = 156;

#[test]
fn faults_at_any_moment_violate_no_rule() {
    let robot = patrolling_robot();
    let image = FirmwareBench::image_with(robot);
    let summary = run_campaign(&image, robot, seed(), SCENARIO_COUNT, |_, _| {});
    let first_failure = summary.failures.first();
    assert!(
        summary.failures.is_empty(),
        "{}  to run only this scenario: make trouble SEED={} ONLY={}\n\n{summary}",
        first_failure.map_or_else(String::new, ToString::to_string),
        seed(),
        first_failure.map_or(0, |failure| failure.scenario.number),
    );
    let all_activities: BTreeSet<Activity> = Activity::ALL.into();
    let counts_by_activity = summary.counts_by_activity;
    let tested_activities: BTreeSet<Activity> = counts_by_activity.keys().copied().collect();
    assert_eq!(tested_activities, all_activities);
    for (activity, (run_count, _)) in counts_by_activity {
        let scenarios_of_13 = if activity == Activity::Driven { 4 } else { 1 };
        let expected_count = scenarios_of_13 * SCENARIO_COUNT / 13;
        assert_eq!(run_count, expected_count, "{activity}");
    }
}

#[test]
fn seed_and_number_determine_a_scenario() {
    for number in 0..100 {
        let scenario = Scenario::generate(7, number, patrolling_robot());
        assert_eq!(scenario, Scenario::generate(7, number, patrolling_robot()));
        let other_scenario = Scenario::generate(8, number, patrolling_robot());
        assert_ne!(scenario.steps, other_scenario.steps);
    }
}

#[test]
fn most_patrols_reach_the_wait_for_an_obstacle() {
    let robot = patrolling_robot();
    let image = FirmwareBench::image_with(robot);
    let scenarios = (0..SCENARIO_COUNT).map(|number| Scenario::generate(seed(), number, robot));
    let patrols = scenarios.filter(|scenario| scenario.activity == Activity::Patrolling);
    let reaches_obstacle_wait = |scenario: &Scenario| {
        let record = run_scenario(&image, robot, scenario);
        let mut lines = record.printed_lines.iter();
        lines.any(|line| line.text == "# waiting for nose")
    };
    let walking_count = patrols.filter(reaches_obstacle_wait).count() as u64;
    assert!(
        walking_count > SCENARIO_COUNT / 13 / 2,
        "{walking_count} patrols wait for an obstacle"
    );
}

#[test]
fn a_robot_without_room_for_a_routine_patrols_with_fewer_gaits() {
    let mut text = read_file("robot.toml");
    let mut full_robot = Robot::parse(&text).expect("robot.toml is valid");
    for number in 0.. {
        text += &format!("[gait.more-{number}]\nlike = \"walk\"\n");
        match Robot::parse(&text) {
            Ok(robot) => full_robot = robot,
            Err(_) => break,
        }
    }
    let text = text.rsplit_once("[gait.").expect("the text has a gait").0;
    let reduced_robot =
        robot_with_patrol(text).expect("without some gaits there is room for a routine");
    assert!(reduced_robot.gaits().len() < full_robot.gaits().len());
    assert!(reduced_robot.gaits().len() > 5);
    assert!(reduced_robot.routine("patrol").is_some());
}
