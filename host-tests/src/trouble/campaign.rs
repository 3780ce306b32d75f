//! Campaign of many scenarios, played and judged on several threads, and the summary of its results.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use lizard_robot::Robot;
use lizard_rules::{BrokenRule, Rule};
use simulated_uno::Image;

use super::activity::Activity;
use super::judge::broken_rules;
use super::scenario::Scenario;
use super::stage::play;

/// A scenario in which the firmware broke at least one rule.
#[derive(Debug, Clone)]
pub struct Failure {
    /// The scenario.
    pub scenario: Scenario,
    /// The broken rules.
    pub broken_rules: Vec<BrokenRule>,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.scenario)?;
        for BrokenRule { rule, observation } in &self.broken_rules {
            writeln!(f, "  does not hold: {}\n    {observation}", rule.sentence())?;
        }
        Ok(())
    }
}

/// The results of a campaign.
#[derive(Debug, Default)]
pub struct Summary {
    /// For each activity, the number of scenarios played and the number of scenarios failed.
    pub activities: BTreeMap<Activity, (u64, u64)>,
    /// The scenarios that failed, in the order of their numbers.
    pub failures: Vec<Failure>,
    /// The number of simulated cycles.
    pub cycles: u64,
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (activity, (played, failed)) in &self.activities {
            writeln!(f, "{activity:14} {played:6} scenarios, {failed} failed")?;
        }
        for rule in Rule::ALL {
            let breaks_rule = |failure: &&Failure| {
                failure
                    .broken_rules
                    .iter()
                    .any(|broken| broken.rule == *rule)
            };
            let failures: Vec<&Failure> = self.failures.iter().filter(breaks_rule).collect();
            if let Some(first) = failures.first() {
                let (count, number) = (failures.len(), first.scenario.number);
                writeln!(
                    f,
                    "{count:6} times broken: {} (first in scenario {number})",
                    rule.sentence()
                )?;
            }
        }
        Ok(())
    }
}

/// Plays and judges one scenario. Returns its duration in cycles, and the failure if a rule is broken.
#[must_use]
pub fn judge(image: &Image, robot: &Robot, scenario: &Scenario) -> (u64, Option<Failure>) {
    let record = play(image, robot, scenario);
    let broken_rules = broken_rules(&record, robot, scenario);
    let failure = (!broken_rules.is_empty()).then(|| Failure {
        scenario: scenario.clone(),
        broken_rules,
    });
    (record.end_cycle, failure)
}

/// Plays and judges the scenarios `0..count` of a seed on `thread_count` threads. Calls `report_progress` after each
/// scenario with the number of scenarios done, and the failure if the scenario failed.
pub fn run_campaign(
    image: &Image,
    robot: &Robot,
    seed: u64,
    count: u64,
    thread_count: usize,
    report_progress: impl Fn(u64, Option<&Failure>) + Sync,
) -> Summary {
    let next_number = AtomicU64::new(0);
    let done_count = AtomicU64::new(0);
    let summary = Mutex::new(Summary::default());
    thread::scope(|scope| {
        for _ in 0..thread_count {
            scope.spawn(|| {
                loop {
                    let number = next_number.fetch_add(1, Ordering::Relaxed);
                    if number >= count {
                        return;
                    }
                    let scenario = Scenario::generate(seed, number, robot);
                    let (cycles, failure) = judge(image, robot, &scenario);
                    report_progress(
                        done_count.fetch_add(1, Ordering::Relaxed) + 1,
                        failure.as_ref(),
                    );
                    let mut summary = summary.lock().expect("no thread has panicked");
                    let counts = summary.activities.entry(scenario.activity).or_default();
                    let (played_count, failed_count) = counts;
                    *played_count += 1;
                    *failed_count += u64::from(failure.is_some());
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
