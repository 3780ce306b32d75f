//! `make trouble`: runs many random fault-injection scenarios on the simulated UNO. The program prints its progress,
//! the steps of the first failing scenarios, and a summary by activity.
//!
//! The environment variables SEED and COUNT select the scenarios. With ONLY, the program runs only the scenario with
//! this number. `make` runs this program in the `crates` folder.

use std::io::{IsTerminal, Write};
use std::process::ExitCode;
use std::time::Instant;

use lizard_host_tests::trouble::{Failure, Scenario, collect_events, run_and_check, run_campaign};
use lizard_host_tests::{FirmwareBench, patrolling_robot, read_number, read_positive_number};
use lizard_rules::{Event, MS, Time};
use simulated_uno::{FREQUENCY, Image};

/// Number of failing scenarios to print in full.
const MAX_PRINTED_FAILURES: usize = 5;

fn main() -> ExitCode {
    let robot = patrolling_robot();
    let image = FirmwareBench::image_with(robot);
    let seed = read_number("SEED").unwrap_or(1);
    if let Some(scenario_number) = read_number("ONLY") {
        return run_verbosely(&image, seed, scenario_number);
    }
    let count = read_positive_number("COUNT", 10_000);
    let start = Instant::now();
    let report = |done_count: u64, failure: Option<&Failure>| {
        if let Some(failure) = failure {
            let number = failure.scenario.number;
            let (activity, violation) = (failure.scenario.activity, &failure.violations[0]);
            println!("scenario {number} ({activity}) violates: {violation}");
        } else if done_count.is_multiple_of(100) && std::io::stdout().is_terminal() {
            print!("{done_count} of {count}\r");
            _ = std::io::stdout().flush();
        }
    };
    let summary = run_campaign(&image, robot, seed, count, report);
    for failure in summary.failures.iter().take(MAX_PRINTED_FAILURES) {
        println!(
            "\n{failure}  to run only this scenario: make trouble SEED={seed} ONLY={}",
            failure.scenario.number
        );
    }
    println!("\n{summary}");
    let simulated_s = summary.cycle_count / FREQUENCY;
    let elapsed_s = start.elapsed().as_secs_f64();
    println!("seed {seed}: {count} scenarios, {simulated_s} s simulated in {elapsed_s:.0} s");
    match summary.failures.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}

/// Runs one scenario, and prints its steps, its events and its violations.
fn run_verbosely(image: &Image, seed: u64, number: u64) -> ExitCode {
    let scenario = Scenario::generate(seed, number, patrolling_robot());
    print!("{scenario}");
    let (record, failure) = run_and_check(image, patrolling_robot(), &scenario);
    let mut last_pulse_times = [Time::MIN / 2; 4];
    for (time, event) in collect_events(&record) {
        let is_reported = match event {
            Event::ByteReceived | Event::TimePasses => false,
            // Prints a servo's pulse only after more than 30 ms without a pulse.
            Event::Pulse(pulse) => {
                let previous_time = std::mem::replace(&mut last_pulse_times[pulse.servo], time);
                time - previous_time > 30 * MS
            }
            _ => true,
        };
        if is_reported {
            println!("{:10.3} ms  {event:?}", time as f64 / MS as f64);
        }
    }
    match failure {
        None => {
            println!("every rule holds");
            ExitCode::SUCCESS
        }
        Some(failure) => {
            print!("{failure}");
            ExitCode::FAILURE
        }
    }
}
