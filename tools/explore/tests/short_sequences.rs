//! Test of the safety rules with a hundredth of the states that `make explore` visits.

use lizard_explore::{search, small_robot::small_robot};

const MAX_STATES: usize = 100_000;

#[test]
fn no_short_sequence_of_actions_violates_a_rule() {
    let robot = small_robot();
    let result = search(robot, MAX_STATES);
    assert!(
        result.state_count >= MAX_STATES || result.is_complete,
        "{} states",
        result.state_count
    );
    let violations: Vec<String> = result
        .violations
        .iter()
        .map(|(rule, (count, sequence))| {
            format!("violated {count} times: {}\n{sequence}", rule.sentence())
        })
        .collect();
    assert!(violations.is_empty(), "{}", violations.join("\n\n"));
}
