//! `make explore`: explores ten million states, or as many as the argument says.

use std::process::ExitCode;

use lizard_explore::{search, small_robot::small_robot};

fn main() -> ExitCode {
    let max_states = std::env::args()
        .nth(1)
        .map_or(Ok(10_000_000), |count| count.parse());
    let Ok(max_states) = max_states else {
        eprintln!("usage: explore [MAX_STATES]");
        return ExitCode::FAILURE;
    };
    let robot = small_robot();
    let start = std::time::Instant::now();
    let result = search(robot, max_states);
    println!(
        "{} distinct states by {} actions in {:.0} s, the longest sequence of {}, {}",
        result.state_count,
        result.tried_action_count,
        start.elapsed().as_secs_f64(),
        result.longest_sequence_length,
        if result.is_complete {
            "closed"
        } else {
            "not closed"
        },
    );
    for (rule, (count, sequence)) in &result.broken_rules {
        println!("\nBROKEN {count} times: {}\n{sequence}", rule.sentence());
    }
    if result.broken_rules.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
