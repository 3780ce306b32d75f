//! Many scenarios on all cores, and what came of them.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use lizard_robot::Robot;
use simulated_uno::Image;

use super::activity::Activity;
use super::invariants::{INVARIANTS, Rules};
use super::scenario::Scenario;
use super::stage::play;

/// A scenario that broke an invariant.
#[derive(Debug, Clone)]
pub struct Failure {
    /// The scenario.
    pub scenario: Scenario,
    /// The sentences that do not hold, with what was seen.
    pub broken: Vec<(&'static str, String)>,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.scenario)?;
        for (sentence, seen) in &self.broken {
            writeln!(f, "  does not hold: {sentence}\n    {seen}")?;
        }
        Ok(())
    }
}

/// What came of many scenarios.
#[derive(Debug, Default)]
pub struct Summary {
    /// How many scenarios of each activity were played, and how many failed.
    pub activities: BTreeMap<Activity, (u64, u64)>,
    /// What failed, in order of number.
    pub failures: Vec<Failure>,
    /// Simulated cycles.
    pub cycles: u64,
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (activity, (played, failed)) in &self.activities {
            writeln!(f, "{activity:14} {played:6} scenarios, {failed} failed")?;
        }
        for (sentence, _) in INVARIANTS {
            let broken = |failure: &&Failure| failure.broken.iter().any(|(s, _)| *s == sentence);
            let failures: Vec<&Failure> = self.failures.iter().filter(broken).collect();
            if let Some(first) = failures.first() {
                let (count, number) = (failures.len(), first.scenario.number);
                writeln!(
                    f,
                    "{count:6} times not so: {sentence} (first in scenario {number})"
                )?;
            }
        }
        Ok(())
    }
}

/// Plays one scenario and judges it; how many cycles it took, and what is broken.
#[must_use]
pub fn judge(image: &Image, robot: &Robot, scenario: &Scenario) -> (u64, Option<Failure>) {
    let record = play(image, robot, scenario);
    let rules = Rules::of(robot, scenario);
    let mut broken = Vec::new();
    for (sentence, holds) in INVARIANTS {
        if let Err(seen) = holds(&record, &rules) {
            broken.push((sentence, seen));
        }
    }
    let failure = (!broken.is_empty()).then(|| Failure {
        scenario: scenario.clone(),
        broken,
    });
    (record.end, failure)
}

/// Plays the scenarios `0..count` of a seed on `threads` threads; `progress` hears the
/// number of each that is done.
pub fn campaign(
    image: &Image,
    robot: &Robot,
    seed: u64,
    count: u64,
    threads: usize,
    progress: impl Fn(u64, Option<&Failure>) + Sync,
) -> Summary {
    let next = AtomicU64::new(0);
    let done = AtomicU64::new(0);
    let summary = Mutex::new(Summary::default());
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= count {
                        return;
                    }
                    let scenario = Scenario::of(seed, number, robot);
                    let (cycles, failure) = judge(image, robot, &scenario);
                    progress(done.fetch_add(1, Ordering::Relaxed) + 1, failure.as_ref());
                    let mut summary = summary.lock().expect("no thread has panicked");
                    let tally = summary.activities.entry(scenario.activity).or_default();
                    tally.0 += 1;
                    tally.1 += u64::from(failure.is_some());
                    summary.cycles += cycles;
                    summary.failures.extend(failure);
                }
            });
        }
    });
    let mut summary = summary.into_inner().expect("no thread has panicked");
    summary
        .failures
        .sort_by_key(|failure| failure.scenario.number);
    summary
}
