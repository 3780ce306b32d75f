//! A hundredth of `make explore`: nothing that happens within a few steps of any
//! beginning breaks a rule.

use lizard_explore::{search, small::small};

/// States to go through.
const STATES: usize = 100_000;

#[test]
fn whatever_happens_and_in_whatever_order_every_rule_holds() {
    let robot = small();
    let found = search(robot, STATES);
    assert!(
        found.states >= STATES || found.closed,
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
