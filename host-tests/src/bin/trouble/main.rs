//! `make trouble`: plays many random scenarios of trouble on the simulated UNO. Prints
//! progress, a summary by activity, and the first failing scenarios as scripts.
//!
//! The environment variables SEED and COUNT choose the scenarios; ONLY plays only the scenario with this number.
//! `make` runs the program in the folder `crates`.

use std::io::{IsTerminal, Write};
use std::process::ExitCode;
use std::thread;
use std::time::Instant;

use lizard_host_tests::trouble::{Scenario, campaign, events, judge};
use lizard_host_tests::{FirmwareBench, patrolling};
use lizard_rules::{Event, MS, Time};
use simulated_uno::{FREQUENCY, Image};

/// Number of failing scenarios that are printed in full.
const PRINTED: usize = 5;

fn number(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok().filter(|text| !text.is_empty())?;
    Some(
        text.parse()
            .unwrap_or_else(|_| panic!("{name}={text} is not a number")),
    )
}

fn main() -> ExitCode {
    let image = FirmwareBench::image_with(patrolling());
    let seed = number("SEED").unwrap_or(1);
    if let Some(only) = number("ONLY") {
        return play_scenario(&image, seed, only);
    }
    let count = number("COUNT").unwrap_or(10_000);
    let threads = thread::available_parallelism().map_or(1, |n| n.get());
    let begin = Instant::now();
    let summary = campaign(
        &image,
        patrolling(),
        seed,
        count,
        threads,
        |done, failure| {
            if let Some(failure) = failure {
                let number = failure.scenario.number;
                let (activity, broken) = (failure.scenario.activity, &failure.broken[0]);
                println!("scenario {number} ({activity}): broken: {broken}");
            } else if done.is_multiple_of(100) && std::io::stdout().is_terminal() {
                print!("{done} of {count}\r");
                _ = std::io::stdout().flush();
            }
        },
    );
    for failure in summary.failures.iter().take(PRINTED) {
        println!(
            "\n{failure}  alone: make trouble SEED={seed} ONLY={}",
            failure.scenario.number
        );
    }
    println!("\n{summary}");
    let seconds = summary.cycles / FREQUENCY;
    let elapsed = begin.elapsed().as_secs_f64();
    println!("seed {seed}: {count} scenarios, {seconds} s simulated in {elapsed:.0} s");
    if summary.failures.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Plays one scenario, and prints its events and the rules that they break.
fn play_scenario(image: &Image, seed: u64, number: u64) -> ExitCode {
    let scenario = Scenario::of(seed, number, patrolling());
    print!("{scenario}");
    let record = lizard_host_tests::trouble::play(image, patrolling(), &scenario);
    let mut last = [Time::MIN / 2; 4];
    for (at, event) in events(&record) {
        let is_reported = match event {
            Event::Byte | Event::Pass => false,
            // Of a servo's pulses, only the first after more than 30 ms without a pulse is printed.
            Event::Pulse(pulse) => {
                let before = std::mem::replace(&mut last[pulse.servo], at);
                at - before > 30 * MS
            }
            _ => true,
        };
        if is_reported {
            println!("{:10.3} ms  {event:?}", at as f64 / MS as f64);
        }
    }
    match judge(image, patrolling(), &scenario).1 {
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
