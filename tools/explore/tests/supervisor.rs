//! Test with a hundredth of the states of `make explore`: from any initial state, no sequence of a few actions breaks
//! a rule.

use lizard_explore::{search, small::small_robot};

/// Number of states to explore.
const STATES: usize = 100_000;

#[test]
fn no_short_sequence_of_actions_breaks_a_rule() {
    let robot = small_robot();
    let result = search(robot, STATES);
    assert!(
        result.states >= STATES || result.is_complete,
        "{} states",
        result.states
    );
    let broken: Vec<String> = result
        .broken
        .iter()
        .map(|(rule, (times, sequence))| {
            format!("broken {times} times: {}\n{sequence}", rule.sentence())
        })
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n\n"));
}
