//! Breadth-first search through all sequences of [`Action`]s, up to a number of states.
//!
//! All states that `n` actions reach are processed before the states that `n + 1` actions reach, by as
//! many threads as there are processors. So the first sequence that breaks a rule is one of the
//! shortest. Of a processed state, the search keeps only the fingerprint and the step that reached it.

use std::collections::{BTreeMap, HashSet};
use std::fmt::Write as _;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::vec;

use lizard_core::numbers::robot::Robot;
use lizard_rules::{BrokenRule, Rule};

use crate::action::Action;
use crate::initial_states::{self, InitialState};
use crate::world::{Verdict, World};

/// Number of states that a thread takes at a time.
const CHUNK: usize = 256;

type SeenStates = HashSet<u64>;

/// The results of a search.
#[derive(Debug, Default)]
pub struct SearchResult {
    /// Number of distinct states.
    pub states: usize,
    /// Number of actions tried.
    pub tried: usize,
    /// Number of actions in the longest sequence.
    pub longest: usize,
    /// True if no state is left to explore.
    pub is_complete: bool,
    /// The broken rules, each with its count and its first sequence.
    pub broken: BTreeMap<Rule, (usize, String)>,
}

/// A step of a sequence: the state before it, and the action.
#[derive(Clone, Copy)]
struct Step {
    from: u32,
    action: u8,
}

/// Searches from all initial states, until `max` distinct states are reached or no state is left to explore.
pub fn search(robot: Robot<'static>, max: usize) -> SearchResult {
    let actions = Action::all();
    let initial_states = initial_states::all(robot);
    let known_states: Vec<Mutex<SeenStates>> = (0..64).map(|_| Mutex::default()).collect();
    let mut steps: Vec<Step> = Vec::new();
    let mut result = SearchResult::default();
    let mut frontier: Vec<(World, u32)> = Vec::new();
    for (index, initial_state) in initial_states.iter().enumerate() {
        steps.push(Step {
            from: u32::MAX,
            action: 0,
        });
        if is_new(&known_states, initial_state.world.fingerprint()) {
            frontier.push((initial_state.world.clone(), index as u32));
        }
    }
    let state_count = AtomicUsize::new(frontier.len());
    // Each panic is reported as a broken rule.
    let panic_hook = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    while !frontier.is_empty() && state_count.load(Ordering::Relaxed) < max {
        result.longest += 1;
        let queue = Mutex::new(frontier.into_iter());
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let thread_results: Vec<ThreadResult> = thread::scope(|scope| {
            let run_thread = || explore_queue(&queue, &actions, &known_states, &state_count, max);
            let threads: Vec<_> = (0..threads).map(|_| scope.spawn(run_thread)).collect();
            threads
                .into_iter()
                .map(|thread| thread.join().expect("a thread of the walk"))
                .collect()
        });
        let mut next_frontier = Vec::new();
        let mut broken = Vec::new();
        for thread_result in thread_results {
            result.tried += thread_result.tried;
            broken.extend(thread_result.broken);
            next_frontier.extend(thread_result.reached);
        }
        // The broken rules are sorted, so that the result does not depend on which thread was faster.
        broken.sort_by_key(|(from, action, _)| (*from, *action));
        for (from, action, fault) in broken {
            let entry = result.broken.entry(fault.rule).or_insert_with(|| {
                let description =
                    describe(&initial_states, &steps, &actions, Step { from, action });
                (0, format!("{description}\n  {}", fault.seen))
            });
            entry.0 += 1;
        }
        frontier = next_frontier
            .into_iter()
            .map(|(world, step)| {
                steps.push(step);
                (world, steps.len() as u32 - 1)
            })
            .collect();
    }
    panic::set_hook(panic_hook);
    result.is_complete = frontier.is_empty();
    result.states = state_count.into_inner();
    result
}

/// The results of one thread.
#[derive(Default)]
struct ThreadResult {
    tried: usize,
    reached: Vec<(World, Step)>,
    broken: Vec<(u32, u8, BrokenRule)>,
}

fn is_new(known_states: &[Mutex<SeenStates>], fingerprint: u64) -> bool {
    let shard = &known_states[(fingerprint >> 58) as usize];
    shard
        .lock()
        .expect("no thread has failed")
        .insert(fingerprint)
}

fn explore_queue(
    queue: &Mutex<vec::IntoIter<(World, u32)>>,
    actions: &[Action],
    known_states: &[Mutex<SeenStates>],
    state_count: &AtomicUsize,
    max: usize,
) -> ThreadResult {
    let mut result = ThreadResult::default();
    while state_count.load(Ordering::Relaxed) < max {
        let chunk: Vec<_> = {
            let mut queue = queue.lock().expect("no thread has failed");
            queue.by_ref().take(CHUNK).collect()
        };
        if chunk.is_empty() {
            break;
        }
        for (world, from) in chunk {
            result.expand(&world, from, actions, known_states, state_count);
        }
    }
    result
}

impl ThreadResult {
    /// Applies every possible action to a state.
    fn expand(
        &mut self,
        world: &World,
        from: u32,
        actions: &[Action],
        known_states: &[Mutex<SeenStates>],
        state_count: &AtomicUsize,
    ) {
        for (number, action) in actions.iter().enumerate() {
            if !world.is_possible(*action) {
                continue;
            }
            self.tried += 1;
            let mut next_world = world.clone();
            let step = Step {
                from,
                action: number as u8,
            };
            match apply_catching_panics(&mut next_world, *action) {
                Err(broken) => self.broken.push((step.from, step.action, broken)),
                Ok(()) if is_new(known_states, next_world.fingerprint()) => {
                    state_count.fetch_add(1, Ordering::Relaxed);
                    self.reached.push((next_world, step));
                }
                Ok(()) => {}
            }
        }
    }
}

/// Applies an action. A panic counts as a broken rule.
fn apply_catching_panics(world: &mut World, action: Action) -> Verdict {
    let result = panic::catch_unwind(AssertUnwindSafe(|| world.apply(action)));
    result.unwrap_or_else(|reason| {
        let message = reason.downcast_ref::<String>().cloned();
        let message = message.or_else(|| reason.downcast_ref::<&str>().map(ToString::to_string));
        Err(BrokenRule::new(Rule::Lives, message.unwrap_or_default()))
    })
}

/// Describes the sequence that ends with the step `last` in words.
fn describe(
    initial_states: &[InitialState],
    steps: &[Step],
    actions: &[Action],
    last: Step,
) -> String {
    let mut sequence = vec![actions[usize::from(last.action)]];
    let mut index = last.from;
    while steps[index as usize].from != u32::MAX {
        sequence.push(actions[usize::from(steps[index as usize].action)]);
        index = steps[index as usize].from;
    }
    let initial_state = &initial_states[index as usize];
    let mut text = format!("  power on with {}", initial_state.conditions);
    let all_actions = initial_state
        .actions
        .iter()
        .copied()
        .chain(sequence.into_iter().rev());
    for action in all_actions {
        _ = write!(text, "; {action}");
    }
    text
}
