//! Breadth-first search through all sequences of [`Action`]s, up to a maximum number of distinct states.
//!
//! The search processes all states that `n` actions reach before the states that `n + 1` actions reach, so the first
//! sequence that violates a rule is one of the shortest. There are as many threads as processors. For each processed
//! state, the search keeps only the fingerprint and the step that reached the state.

use std::collections::{BTreeMap, HashSet};
use std::fmt::Write as _;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::vec;

use lizard_core::numbers::robot::Robot;
use lizard_rules::{Rule, Violation};

use crate::action::Action;
use crate::initial_states::{self, InitialState};
use crate::world::{Verdict, World};

/// Number of states that a thread takes from the queue at a time.
const STATES_PER_CHUNK: usize = 256;

/// The results of a search.
#[derive(Debug, Default)]
pub struct SearchResult {
    /// The number of distinct states that were reached.
    pub state_count: usize,
    /// The number of actions that were tried, in all states together.
    pub tried_action_count: usize,
    /// The number of actions in the longest sequence.
    pub longest_sequence_length: usize,
    /// True if no state is left to explore.
    pub is_complete: bool,
    /// For each violated rule, the number of violations and the first sequence that violated the rule.
    pub violations: BTreeMap<Rule, (usize, String)>,
}

/// A step of a sequence.
#[derive(Clone, Copy)]
struct Step {
    /// The index of the previous step; `u32::MAX` if this entry stands for an initial state.
    previous_step: u32,
    action_index: u8,
}

/// The parts of a search that all threads share.
struct Search {
    actions: Vec<Action>,
    /// The fingerprints of known states, in sets by their upper bits, so that threads seldom wait for one another.
    known_states: Vec<Mutex<HashSet<u64>>>,
    /// The number of known states.
    state_count: AtomicUsize,
    max_states: usize,
}

/// Searches from all initial states, until `max_states` distinct states are reached or no state is left to explore.
pub fn search(robot: Robot<'static>, max_states: usize) -> SearchResult {
    let search = Search {
        actions: Action::all(),
        known_states: (0..64).map(|_| Mutex::default()).collect(),
        state_count: AtomicUsize::new(0),
        max_states,
    };
    let initial_states = initial_states::prepare_all(robot);
    let mut steps: Vec<Step> = Vec::new();
    let mut result = SearchResult::default();
    let mut frontier: Vec<(World, u32)> = Vec::new();
    for (index, initial_state) in initial_states.iter().enumerate() {
        steps.push(Step {
            previous_step: u32::MAX,
            action_index: 0,
        });
        if search.insert_if_new(&initial_state.world) {
            frontier.push((initial_state.world.clone(), index as u32));
        }
    }
    // A panic is reported as a violation, so the hook prints nothing.
    let panic_hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    while !frontier.is_empty() && !search.is_at_limit() {
        result.longest_sequence_length += 1;
        let queue = Mutex::new(frontier.into_iter());
        let thread_count = thread::available_parallelism().map_or(1, usize::from);
        let thread_results: Vec<ThreadResult> = thread::scope(|scope| {
            let run_thread = || search.explore_queue(&queue);
            let threads: Vec<_> = (0..thread_count).map(|_| scope.spawn(run_thread)).collect();
            threads
                .into_iter()
                .map(|thread| thread.join().expect("no thread of the search panics"))
                .collect()
        });
        let mut next_frontier = Vec::new();
        let mut violations = Vec::new();
        for thread_result in thread_results {
            result.tried_action_count += thread_result.tried_action_count;
            violations.extend(thread_result.violations);
            next_frontier.extend(thread_result.reached_states);
        }
        // Sorted, so that the result does not depend on the threads' speeds.
        violations.sort_by_key(|(step, _)| (step.previous_step, step.action_index));
        for (step, violation) in violations {
            let entry = result.violations.entry(violation.rule);
            let (count, _) = entry.or_insert_with(|| {
                let description = describe_sequence(&initial_states, &steps, &search.actions, step);
                (0, format!("{description}\n  {}", violation.observation))
            });
            *count += 1;
        }
        let number_step = |(world, step)| {
            steps.push(step);
            (world, steps.len() as u32 - 1)
        };
        frontier = next_frontier.into_iter().map(number_step).collect();
    }
    panic::set_hook(panic_hook);
    result.is_complete = frontier.is_empty();
    result.state_count = search.state_count.into_inner();
    result
}

/// The results of one thread for one sequence length.
#[derive(Default)]
struct ThreadResult {
    tried_action_count: usize,
    reached_states: Vec<(World, Step)>,
    violations: Vec<(Step, Violation)>,
}

impl Search {
    fn is_at_limit(&self) -> bool {
        self.state_count.load(Ordering::Relaxed) >= self.max_states
    }

    /// Inserts a state's fingerprint, and counts the state if it is new. Returns false if the state was known before.
    fn insert_if_new(&self, world: &World) -> bool {
        let fingerprint = world.fingerprint();
        let shard = self.known_states[(fingerprint >> 58) as usize].lock();
        let is_new = shard.expect("no thread has failed").insert(fingerprint);
        self.state_count
            .fetch_add(usize::from(is_new), Ordering::Relaxed);
        is_new
    }

    fn explore_queue(&self, queue: &Mutex<vec::IntoIter<(World, u32)>>) -> ThreadResult {
        let mut result = ThreadResult::default();
        while !self.is_at_limit() {
            let chunk: Vec<_> = {
                let mut queue = queue.lock().expect("no thread has failed");
                queue.by_ref().take(STATES_PER_CHUNK).collect()
            };
            if chunk.is_empty() {
                break;
            }
            for (world, step_index) in chunk {
                self.expand(&world, step_index, &mut result);
            }
        }
        result
    }

    /// Applies every possible action to the state `world`, which the step `step_index` reached.
    fn expand(&self, world: &World, step_index: u32, result: &mut ThreadResult) {
        let actions = self.actions.iter().enumerate();
        for (action_index, action) in actions.filter(|(_, action)| world.is_possible(**action)) {
            result.tried_action_count += 1;
            let mut next_world = world.clone();
            let step = Step {
                previous_step: step_index,
                action_index: action_index as u8,
            };
            match apply_catching_panics(&mut next_world, *action) {
                Err(violation) => result.violations.push((step, violation)),
                Ok(()) if self.insert_if_new(&next_world) => {
                    result.reached_states.push((next_world, step));
                }
                Ok(()) => {}
            }
        }
    }
}

/// Applies an action. A panic counts as a violation.
fn apply_catching_panics(world: &mut World, action: Action) -> Verdict {
    let result = panic::catch_unwind(AssertUnwindSafe(|| world.apply(action)));
    result.unwrap_or_else(|payload| {
        let message = payload.downcast_ref::<String>().cloned();
        let message = message.or_else(|| payload.downcast_ref::<&str>().map(ToString::to_string));
        let message = message.unwrap_or_default();
        Err(Violation::new(Rule::KeepsRunning, message))
    })
}

/// Returns a description of the sequence that ends with `last_step`.
fn describe_sequence(
    initial_states: &[InitialState],
    steps: &[Step],
    actions: &[Action],
    last_step: Step,
) -> String {
    let mut sequence = vec![actions[usize::from(last_step.action_index)]];
    let mut step_index = last_step.previous_step;
    while steps[step_index as usize].previous_step != u32::MAX {
        sequence.push(actions[usize::from(steps[step_index as usize].action_index)]);
        step_index = steps[step_index as usize].previous_step;
    }
    let initial_state = &initial_states[step_index as usize];
    let mut text = format!("  power on with {}", initial_state.conditions);
    for action in initial_state.actions.iter().chain(sequence.iter().rev()) {
        _ = write!(text, "; {action}");
    }
    text
}
