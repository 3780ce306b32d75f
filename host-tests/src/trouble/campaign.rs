//! Campaign of many scenarios, run and checked on several threads, and the summary of its results.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use lizard_robot::Robot;
use lizard_rules::{Rule, Violation};
use simulated_uno::Image;

use super::activity::Activity;
use super::record::Record;
use super::rule_checks::find_violations;
use super::scenario::Scenario;
use super::scenario_run::run_scenario;

/// A scenario in which the firmware violated at least one rule.
#[derive(Debug, Clone)]
pub struct Failure {
    /// The scenario that was run.
    pub scenario: Scenario,
    /// The violations of rules, at least one.
    pub violations: Vec<Violation>,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.scenario)?;
        for Violation { rule, observation } in &self.violations {
            writeln!(f, "  violated: {}\n    {observation}", rule.sentence())?;
        }
        Ok(())
    }
}

/// The results of a campaign.
#[derive(Debug, Default)]
pub struct Summary {
    /// For each activity, the number of scenarios run and the number of scenarios failed.
    pub counts_by_activity: BTreeMap<Activity, (u64, u64)>,
    /// The scenarios that failed, in the order of their numbers.
    pub failures: Vec<Failure>,
    /// The number of simulated cycles.
    pub cycle_count: u64,
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (activity, (run_count, failed_count)) in &self.counts_by_activity {
            writeln!(
                f,
                "{activity:14} {run_count:6} scenarios, {failed_count} failed"
            )?;
        }
        for rule in Rule::ALL {
            let violates_rule = |failure: &&Failure| {
                let mut violations = failure.violations.iter();
                violations.any(|violation| violation.rule == *rule)
            };
            let failures: Vec<&Failure> = self.failures.iter().filter(violates_rule).collect();
            if let Some(first) = failures.first() {
                let (count, number) = (failures.len(), first.scenario.number);
                writeln!(
                    f,
                    "{count:6} scenarios violate: {} (first: scenario {number})",
                    rule.sentence()
                )?;
            }
        }
        Ok(())
    }
}

/// Runs and checks one scenario. Returns its record, and the failure if a rule is violated.
#[must_use]
pub fn run_and_check(
    image: &Image,
    robot: &Robot,
    scenario: &Scenario,
) -> (Record, Option<Failure>) {
    let record = run_scenario(image, robot, scenario);
    let violations = find_violations(&record, robot, scenario);
    let failure = (!violations.is_empty()).then(|| Failure {
        scenario: scenario.clone(),
        violations,
    });
    (record, failure)
}

/// Runs and checks the scenarios `0..count` of a seed on as many threads as there are processors. After each scenario,
/// calls `report_progress` with the number of scenarios done, and the failure if the scenario failed.
pub fn run_campaign(
    image: &Image,
    robot: &Robot,
    seed: u64,
    count: u64,
    report_progress: impl Fn(u64, Option<&Failure>) + Sync,
) -> Summary {
    let next_number = AtomicU64::new(0);
    let done_count = AtomicU64::new(0);
    let summary = Mutex::new(Summary::default());
    let thread_count = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..thread_count {
            scope.spawn(|| {
                loop {
                    let number = next_number.fetch_add(1, Ordering::Relaxed);
                    if number >= count {
                        return;
                    }
                    let scenario = Scenario::generate(seed, number, robot);
                    let (record, failure) = run_and_check(image, robot, &scenario);
                    let new_count = done_count.fetch_add(1, Ordering::Relaxed) + 1;
                    report_progress(new_count, failure.as_ref());
                    let mut summary = summary.lock().expect("no thread has panicked");
                    let counts = &mut summary.counts_by_activity;
                    let (run_count, failed_count) = counts.entry(scenario.activity).or_default();
                    *run_count += 1;
                    *failed_count += u64::from(failure.is_some());
                    summary.cycle_count += record.end_cycle;
                    summary.failures.extend(failure);
                }
            });
        }
    });
    let mut summary = summary.into_inner().expect("no thread has panicked");
    let failures = &mut summary.failures;
    failures.sort_by_key(|failure| failure.scenario.number);
    summary
}
