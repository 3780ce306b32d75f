//! `make trouble`: many scenarios of trouble on the simulated UNO, with progress, a
//! summary by activity, and every scenario that fails as a script.
//!
//! SEED and COUNT choose them; ONLY plays one of the seed alone. Run it from the folder
//! `host`.

use std::io::{IsTerminal, Write};
use std::process::ExitCode;
use std::thread;
use std::time::Instant;

use lizard_host_tests::trouble::{Scenario, campaign, judge};
use lizard_host_tests::{FirmwareBench, robot};
use simulated_uno::{FREQUENCY, Image};

/// Failing scenarios that are printed whole.
const PRINTED: usize = 5;

fn number(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok().filter(|text| !text.is_empty())?;
    Some(
        text.parse()
            .unwrap_or_else(|_| panic!("{name}={text} is no number")),
    )
}

fn main() -> ExitCode {
    let image = FirmwareBench::image();
    let seed = number("SEED").unwrap_or(1);
    if let Some(only) = number("ONLY") {
        return one(&image, seed, only);
    }
    let count = number("COUNT").unwrap_or(10_000);
    let threads = thread::available_parallelism().map_or(1, |n| n.get());
    let begin = Instant::now();
    let summary = campaign(&image, robot(), seed, count, threads, |done, failure| {
        if let Some(failure) = failure {
            let number = failure.scenario.number;
            let (sentence, seen) = &failure.broken[0];
            println!(
                "scenario {number} ({}): not so: {sentence}: {seen}",
                failure.scenario.activity
            );
        } else if done.is_multiple_of(100) && std::io::stdout().is_terminal() {
            print!("{done} of {count}\r");
            _ = std::io::stdout().flush();
        }
    });
    for failure in summary.failures.iter().take(PRINTED) {
        println!(
            "\n{failure}  alone: make trouble SEED={seed} ONLY={}",
            failure.scenario.number
        );
    }
    println!("\n{summary}");
    let seconds = summary.cycles / FREQUENCY;
    let took = begin.elapsed().as_secs_f64();
    println!("seed {seed}: {count} scenarios, {seconds} s simulated in {took:.0} s");
    if summary.failures.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Plays one and says all that was said.
fn one(image: &Image, seed: u64, number: u64) -> ExitCode {
    let scenario = Scenario::of(seed, number, robot());
    print!("{scenario}");
    let record = lizard_host_tests::trouble::play(image, robot(), &scenario);
    for heard in &record.heard {
        println!(
            "{:10.3} ms  > {}",
            heard.cycle as f64 / 16_000.0,
            heard.text
        );
    }
    for start in &record.starts {
        println!(
            "{:10.3} ms  start: {:?}",
            start.cycle as f64 / 16_000.0,
            start.cause
        );
    }
    for line in &record.lines {
        println!("{:10.3} ms  {}", line.cycle as f64 / 16_000.0, line.text);
    }
    for begin in record.begins() {
        let at = begin.pulse.start as f64 / 16_000.0;
        println!(
            "{at:10.3} ms  A{} begins, {} cycles",
            begin.servo + 1,
            begin.pulse.width
        );
    }
    match judge(image, robot(), &scenario).1 {
        None => {
            println!("every sentence holds");
            ExitCode::SUCCESS
        }
        Some(failure) => {
            print!("{failure}");
            ExitCode::FAILURE
        }
    }
}
