//! `make explore`: explores ten million states, or the number in the argument.

use std::process::ExitCode;

use lizard_explore::{search, small::small_robot};

fn main() -> ExitCode {
    let max_states = std::env::args()
        .nth(1)
        .map_or(Ok(10_000_000), |count| count.parse());
    let Ok(max_states) = max_states else {
        eprintln!("explore [how many states]");
        return ExitCode::FAILURE;
    };
    let robot = small_robot();
    let start = std::time::Instant::now();
    let result = search(robot, max_states);
    println!(
        "{} distinct states by {} actions in {:.0} s, the longest sequence of {}, {}",
        result.states,
        result.tried,
        start.elapsed().as_secs_f64(),
        result.longest,
        if result.is_complete {
            "closed"
        } else {
            "not closed"
        },
    );
    for (rule, (times, sequence)) in &result.broken {
        println!("\nBROKEN {times} times: {}\n{sequence}", rule.sentence());
    }
    if result.broken.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
