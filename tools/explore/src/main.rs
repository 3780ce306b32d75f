//! `make explore`: explores as many states as the argument says, by default ten million.

use std::process::ExitCode;

use lizard_explore::{search, small_robot::small_robot};

fn main() -> ExitCode {
    let argument = std::env::args().nth(1);
    let max_states = argument.map_or(Ok(10_000_000), |count| count.parse());
    let Ok(max_states) = max_states else {
        eprintln!("usage: explore [MAX_STATES]");
        return ExitCode::FAILURE;
    };
    let robot = small_robot();
    let start = std::time::Instant::now();
    let result = search(robot, max_states);
    let end = match result.is_complete {
        true => "all states explored",
        false => "stopped at the limit",
    };
    println!(
        "{} distinct states, {} actions tried in {:.0} s, longest sequence {} actions, {end}",
        result.state_count,
        result.tried_action_count,
        start.elapsed().as_secs_f64(),
        result.longest_sequence_length,
    );
    for (rule, (count, sequence)) in &result.violations {
        println!("\nVIOLATED {count} times: {}\n{sequence}", rule.sentence());
    }
    match result.violations.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}
