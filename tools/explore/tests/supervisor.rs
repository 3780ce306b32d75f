//! A hundredth of `make explore`: no sequence of a few actions from any beginning breaks a rule.

use lizard_explore::{search, small::small};

/// States to go through.
const STATES: usize = 100_000;

#[test]
fn no_short_sequence_of_actions_breaks_a_rule() {
    let robot = small();
    let found = search(robot, STATES);
    assert!(
        found.states >= STATES || found.is_complete,
        "{} states",
        found.states
    );
    let broken: Vec<String> = found
        .broken
        .iter()
        .map(|(rule, (times, sequence))| {
            format!("broken {times} times: {}\n{sequence}", rule.sentence())
        })
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n\n"));
}
