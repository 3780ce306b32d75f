//! Test of the safety rules with a hundredth of the states that `make explore` visits.

use lizard_explore::{search, small_robot::small_robot};

const MAX_STATES: usize = 100_000;

#[test]
fn no_short_sequence_of_actions_violates_a_rule() {
    let result = search(small_robot(), MAX_STATES);
    let count = result.state_count;
    assert!(count >= MAX_STATES || result.is_complete, "{count} states");
    let violations = result.violations.iter();
    let violations: Vec<String> = violations
        .map(|(rule, (count, sequence))| {
            format!("violated {count} times: {}\n{sequence}", rule.sentence())
        })
        .collect();
    assert!(violations.is_empty(), "{}", violations.join("\n\n"));
}
