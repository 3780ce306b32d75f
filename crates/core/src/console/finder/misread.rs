//! Simulates every command sent at one rate and read at another, to find the lines that the robot would misread
//! as commands.
//!
//! The serial line is modelled bit by bit: a receiver starts at a falling edge and samples the middle of each
//! of its own bits. The search visits every state that sender and receiver can reach together, so it covers
//! every command with every number, and every difference between their clocks.

mod automaton;

use std::collections::BTreeSet;
use std::string::String;
use std::vec::Vec;
use std::{println, vec};

use automaton::{GAITS, LineAutomaton};

use super::MIN_COMMAND_BYTES;
use crate::console::word::Word;
use crate::numbers::rate::Rate;

/// Largest error of the sender's clock, as a share.
const CLOCK_ERROR: f64 = 0.02;

/// Earliest and latest point, as shares of a bit, at which a receiver with eight samples per bit reads it: the
/// start bit is detected up to one sample late, and the majority of the samples 4, 5 and 6 counts.
const BIT_MIDDLE: [f64; 2] = [0.5, 0.625];

/// A receiver's reading of a line so far.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum LineReading {
    /// The beginning of a command, or all of it.
    CommandPrefix(usize),
    /// The beginning of a command in this state, followed by this many bytes that continue no command.
    Mismatch(usize, u8),
    /// A line with a garbled byte.
    Garbled,
    /// A line of unknown content: a backspace deleted a byte, and the state before that byte is ambiguous.
    Deleted,
    /// A command with its line end, in this state; `usize::MAX` if its content is unknown.
    CompleteCommand(usize),
}

impl LineReading {
    /// The reading after another byte.
    fn after_byte(self, byte: u8, automaton: &LineAutomaton) -> Self {
        match (byte.to_ascii_lowercase(), self) {
            (b'\r' | b'\n', Self::CommandPrefix(state))
                if automaton.accepting_states.contains(&state) =>
            {
                Self::CompleteCommand(state)
            }
            (b'\r' | b'\n', Self::Deleted) => Self::CompleteCommand(usize::MAX),
            (b'\r' | b'\n', _) => Self::CommandPrefix(LineAutomaton::START),
            (0x80.., _) | (_, Self::Garbled) => Self::Garbled,
            (_, Self::Deleted) => Self::Deleted,
            (0x08 | 0x7f, Self::CommandPrefix(state)) => automaton
                .previous_state(state)
                .map_or(Self::Deleted, Self::CommandPrefix),
            (0x08 | 0x7f, Self::Mismatch(state, 1)) => Self::CommandPrefix(state),
            (0x08 | 0x7f, Self::Mismatch(state, count)) => Self::Mismatch(state, count - 1),
            (_, Self::Mismatch(state, count)) => Self::Mismatch(state, count + 1),
            (byte, Self::CommandPrefix(state)) => automaton.transitions[state]
                .get(&byte)
                .map_or(Self::Mismatch(state, 1), |next_state| {
                    Self::CommandPrefix(*next_state)
                }),
            (_, reading) => reading,
        }
    }
}

/// A graph of the bits that a sender may send: the line's level at each, and the bits that may follow it. Bit 0 is
/// the idle line; each byte of the text has ten bits, a start bit first.
struct BitGraph {
    levels: Vec<bool>,
    next: Vec<Vec<usize>>,
    /// The start bits of the bytes with which a text may begin.
    first_start_bits: Vec<usize>,
}

impl BitGraph {
    /// The bits of a text sent without pauses, and silence after its end.
    fn of(automaton: &LineAutomaton) -> Self {
        let mut bytes: Vec<(usize, u8, Option<usize>)> = Vec::new();
        for (state, transitions) in automaton.transitions.iter().enumerate() {
            bytes.extend(
                transitions
                    .iter()
                    .map(|(byte, next_state)| (state, *byte, Some(*next_state))),
            );
        }
        // CR, LF, or both.
        let return_state = automaton.transitions.len();
        for end_state in &automaton.accepting_states {
            bytes.extend([
                (*end_state, b'\n', None),
                (*end_state, b'\r', None),
                (*end_state, b'\r', Some(return_state)),
            ]);
        }
        bytes.push((return_state, b'\n', None));
        let mut graph = Self {
            levels: vec![true],
            next: vec![vec![0]],
            first_start_bits: Vec::new(),
        };
        let start_bit_of = |index: usize| 1 + 10 * index;
        let followers_of = |state: usize| {
            let following_bytes = bytes
                .iter()
                .enumerate()
                .filter(move |(_, byte)| byte.0 == state);
            following_bytes
                .map(|(index, _)| start_bit_of(index))
                .collect::<Vec<_>>()
        };
        for (index, (_, byte, next_state)) in bytes.iter().enumerate() {
            let frame_bits = 1 << 9 | u16::from(*byte) << 1;
            graph
                .levels
                .extend((0..10).map(|bit| frame_bits >> bit & 1 == 1));
            graph
                .next
                .extend((1..10).map(|bit| vec![start_bit_of(index) + bit]));
            graph.next.push(next_state.map_or(vec![0], followers_of));
        }
        graph.first_start_bits = followers_of(LineAutomaton::START);
        graph
    }

    /// The bits of any 7-bit bytes in any order, with or without pauses.
    fn with_any_bytes() -> Self {
        let mut automaton = LineAutomaton::new();
        automaton.transitions[0] = (0..0x80).map(|byte| (byte, 0)).collect();
        let mut graph = Self::of(&automaton);
        graph.next[0].extend(graph.first_start_bits.clone());
        for index in 0..0x80 {
            graph.next[10 + 10 * index].push(0);
        }
        graph
    }
}

/// The bits of the sender that a receiver samples, counted from the start edge: for every difference of the
/// clocks and every position of the middle.
fn sampled_bits(sender: Rate, receiver: Rate) -> BTreeSet<[usize; 10]> {
    // The rate that the chip's divider can produce, as in src/board/serial.rs.
    let chip_baud = 2e6 / (2e6 / f64::from(receiver.baud())).round();
    let ratio = f64::from(sender.baud()) / chip_baud;
    let mut samples = BTreeSet::new();
    for clock_step in 0..=400 {
        let ratio = ratio * (1.0 + CLOCK_ERROR * (f64::from(clock_step) / 200.0 - 1.0));
        for middle_step in 0..=32 {
            let middle =
                BIT_MIDDLE[0] + (BIT_MIDDLE[1] - BIT_MIDDLE[0]) * f64::from(middle_step) / 32.0;
            samples.insert(core::array::from_fn(|bit| {
                ((bit as f64 + middle) * ratio) as usize
            }));
        }
    }
    samples
}

/// A receiver's reading, and the bit that the sender sends at that time.
type ReceiverState = (LineReading, usize);

/// Reads a byte from each of these start edges; returns the states after it.
fn read_byte(
    edges: &BTreeSet<ReceiverState>,
    graph: &BitGraph,
    automaton: &LineAutomaton,
    sample_times: [usize; 10],
) -> BTreeSet<ReceiverState> {
    let mut current: BTreeSet<(LineReading, usize, u16)> = edges
        .iter()
        .map(|(reading, bit_index)| (*reading, *bit_index, 0))
        .collect();
    let mut time = 0;
    for (bit, sample_time) in sample_times.into_iter().enumerate() {
        while time < sample_time {
            time += 1;
            let advance = |(reading, bit_index, level_bits): &(LineReading, usize, u16)| {
                let (reading, level_bits) = (*reading, *level_bits);
                graph.next[*bit_index]
                    .iter()
                    .map(move |next| (reading, *next, level_bits))
            };
            current = current.iter().flat_map(advance).collect();
        }
        let sample = |(reading, bit_index, level_bits)| {
            (
                reading,
                bit_index,
                level_bits | u16::from(graph.levels[bit_index]) << bit,
            )
        };
        current = current
            .into_iter()
            .map(sample)
            .filter(|(.., level_bits)| level_bits & 1 == 0)
            .collect();
    }
    let finish_byte = |(reading, bit_index, level_bits): (LineReading, usize, u16)| {
        // A byte without a stop bit is garbled.
        let byte = if level_bits >> 9 == 1 {
            (level_bits >> 1) as u8
        } else {
            0xff
        };
        (reading.after_byte(byte, automaton), bit_index)
    };
    current.into_iter().map(finish_byte).collect()
}

/// The start edges that can follow these states.
fn edges_from(states: BTreeSet<ReceiverState>, graph: &BitGraph) -> BTreeSet<ReceiverState> {
    let (mut visited, mut edges) = (BTreeSet::new(), BTreeSet::new());
    let mut to_visit: Vec<ReceiverState> = states.into_iter().collect();
    while let Some((reading, bit_index)) = to_visit.pop() {
        if !visited.insert((reading, bit_index)) {
            continue;
        }
        for next in &graph.next[bit_index] {
            if graph.levels[bit_index] && !graph.levels[*next] {
                edges.insert((reading, *next));
            } else {
                to_visit.push((reading, *next));
            }
        }
    }
    edges
}

/// The commands that a receiver can read at another rate, over all states that it can reach.
fn find_readable_commands(sender: Rate, receiver: Rate) -> BTreeSet<usize> {
    let (graph, automaton) = (
        BitGraph::of(&LineAutomaton::all_commands()),
        LineAutomaton::accepted_lines(),
    );
    let initial_readings = [
        LineReading::CommandPrefix(LineAutomaton::START),
        LineReading::Mismatch(LineAutomaton::START, 1),
        LineReading::Garbled,
    ];
    let mut to_visit: BTreeSet<ReceiverState> = (graph.first_start_bits.iter())
        .flat_map(|state| initial_readings.map(|reading| (reading, *state)))
        .collect();
    let (mut visited, mut commands) = (to_visit.clone(), BTreeSet::new());
    while !to_visit.is_empty() {
        let mut end_states = BTreeSet::new();
        for sample_times in sampled_bits(sender, receiver) {
            end_states.extend(read_byte(&to_visit, &graph, &automaton, sample_times));
        }
        end_states.retain(|(reading, _)| match reading {
            LineReading::CompleteCommand(command) => {
                commands.insert(*command);
                false
            }
            _ => true,
        });
        to_visit = edges_from(end_states, &graph);
        to_visit.retain(|state| visited.insert(*state));
    }
    println!(
        "{} at {}: {} states",
        sender.baud(),
        receiver.baud(),
        visited.len()
    );
    commands
}

/// The pairs (sender, receiver) of different rates whose sender is the faster one, or the slower one if `is_faster`
/// is false.
fn rate_pairs(is_faster: bool) -> impl Iterator<Item = (Rate, Rate)> {
    let senders = Rate::ALL.into_iter();
    let pairs = senders.flat_map(|sender| Rate::ALL.map(|receiver| (sender, receiver)));
    pairs.filter(move |(sender, receiver)| {
        sender != receiver && (sender.baud() > receiver.baud()) == is_faster
    })
}

#[test]
fn no_line_ends_at_a_receiver_that_is_faster_than_the_sender_of_any_bytes() {
    let graph = BitGraph::with_any_bytes();
    let automaton = LineAutomaton::accepted_lines();
    for (sender, receiver) in rate_pairs(false) {
        let edges: BTreeSet<ReceiverState> = (0..graph.levels.len())
            .filter(|state| graph.levels[*state])
            .flat_map(|state| {
                graph.next[state]
                    .iter()
                    .filter(|next| !graph.levels[**next])
            })
            .map(|state| (LineReading::Garbled, *state))
            .collect();
        assert!(edges.len() > 128);
        for sample_times in sampled_bits(sender, receiver) {
            let end_states = read_byte(&edges, &graph, &automaton, sample_times);
            let is_line_end_read = end_states
                .iter()
                .any(|(reading, _)| *reading == LineReading::CommandPrefix(LineAutomaton::START));
            assert!(!is_line_end_read, "{sender:?} read at {receiver:?}");
        }
    }
}

#[test]
fn no_command_that_may_come_first_is_read_at_a_slower_rate() {
    let mut automaton = LineAutomaton::accepted_lines();
    let words = Word::ALL.iter().map(|word| word.text());
    let is_short = |word: &&str| word.len() < MIN_COMMAND_BYTES;
    let short_words: BTreeSet<usize> = words
        .filter(is_short)
        .map(|word| automaton.add_word(word))
        .collect();
    for (sender, receiver) in rate_pairs(true) {
        let commands = find_readable_commands(sender, receiver);
        assert!(
            commands.is_subset(&short_words),
            "{sender:?} at {receiver:?}: {commands:?}"
        );
    }
}

#[test]
fn every_command_is_read_at_its_own_rate() {
    let mut automaton = LineAutomaton::accepted_lines();
    for rate in Rate::ALL {
        let commands = find_readable_commands(rate, rate);
        let words = Word::ALL.iter().map(|word| word.text());
        for word in GAITS.iter().map(String::as_str).chain(words) {
            let end_state = automaton.add_word(word);
            let argument_state = automaton.transitions[end_state][&b' '];
            let is_read = commands.contains(&end_state) || commands.contains(&argument_state);
            assert!(is_read, "{word} at {rate:?}");
        }
    }
}
