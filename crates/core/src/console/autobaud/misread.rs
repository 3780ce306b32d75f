//! Simulates every command sent at one baud rate and received at another, to find the lines that the robot would
//! misread as other commands.
//!
//! The serial line is modelled bit by bit: a receiver starts at a falling edge and samples the middle of each of its
//! own bits. The search visits every state that sender and receiver can reach together. Therefore it covers every
//! command with every number, and every difference between the two clocks.

mod automaton;

use std::collections::BTreeSet;
use std::string::String;
use std::vec::Vec;
use std::{println, vec};

use automaton::{GAIT_NAMES, LineAutomaton};

use super::MIN_COMMAND_BYTES;
use crate::console::word::Word;
use crate::numbers::rate::BaudRate;

/// The largest relative error of the sender's clock.
const MAX_CLOCK_ERROR: f64 = 0.02;

/// The earliest and the latest sample point of a receiver with eight samples per bit, as fractions of a bit. The
/// receiver detects the start bit up to one sample late, and takes the majority of samples 4, 5 and 6.
const SAMPLE_POINT_RANGE: [f64; 2] = [0.5, 0.625];

/// A line as received so far. The states are those of the automaton of accepted lines.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum ReceivedLine {
    /// A command, or the beginning of one, that leads to this state.
    CommandPrefix(usize),
    /// The beginning of a command that leads to this state, followed by this many bytes that match no command.
    Mismatch(usize, u8),
    /// A line with a garbled byte.
    Garbled,
    /// A line of unknown content: a backspace has deleted a byte before which several states are possible.
    Unknown,
    /// A command with its line end: the state before the line end, or `usize::MAX` if the content is unknown.
    CompleteCommand(usize),
}

impl ReceivedLine {
    /// Returns the line after another byte.
    fn advance(self, byte: u8, automaton: &LineAutomaton) -> Self {
        match (byte.to_ascii_lowercase(), self) {
            (b'\r' | b'\n', Self::CommandPrefix(state))
                if automaton.accepting_states.contains(&state) =>
            {
                Self::CompleteCommand(state)
            }
            (b'\r' | b'\n', Self::Unknown) => Self::CompleteCommand(usize::MAX),
            (b'\r' | b'\n', _) => Self::CommandPrefix(LineAutomaton::START),
            (0x80.., _) | (_, Self::Garbled) => Self::Garbled,
            (_, Self::Unknown) => Self::Unknown,
            (0x08 | 0x7f, Self::CommandPrefix(state)) => automaton
                .previous_state(state)
                .map_or(Self::Unknown, Self::CommandPrefix),
            (0x08 | 0x7f, Self::Mismatch(state, 1)) => Self::CommandPrefix(state),
            (0x08 | 0x7f, Self::Mismatch(state, count)) => Self::Mismatch(state, count - 1),
            (_, Self::Mismatch(state, count)) => Self::Mismatch(state, count + 1),
            (byte, Self::CommandPrefix(state)) => automaton.transitions[state]
                .get(&byte)
                .map_or(Self::Mismatch(state, 1), |next_state| {
                    Self::CommandPrefix(*next_state)
                }),
            (_, line) => line,
        }
    }
}

/// A graph of the bits that a sender may send. Bit 0 is the idle level; each byte takes ten bits, the start bit first.
struct BitGraph {
    /// The level during each bit; true is high, the idle level.
    levels: Vec<bool>,
    /// The possible successors of each bit.
    successors: Vec<Vec<usize>>,
    /// The start bits of the possible first bytes.
    first_start_bits: Vec<usize>,
}

impl BitGraph {
    /// Creates the graph of every line that the automaton accepts, sent without pauses and followed by the idle level.
    fn for_automaton(automaton: &LineAutomaton) -> Self {
        let mut bytes: Vec<(usize, u8, Option<usize>)> = Vec::new();
        for (state, transitions) in automaton.transitions.iter().enumerate() {
            for (byte, next_state) in transitions {
                bytes.push((state, *byte, Some(*next_state)));
            }
        }
        // A line ends with LF, CR, or CR LF.
        let state_after_cr = automaton.transitions.len();
        for end_state in &automaton.accepting_states {
            bytes.extend([
                (*end_state, b'\n', None),
                (*end_state, b'\r', None),
                (*end_state, b'\r', Some(state_after_cr)),
            ]);
        }
        bytes.push((state_after_cr, b'\n', None));
        let mut graph = Self {
            levels: vec![true],
            successors: vec![vec![0]],
            first_start_bits: Vec::new(),
        };
        let start_bit_index = |index: usize| 1 + 10 * index;
        let start_bits_after = |state: usize| {
            let byte_indices = (0..bytes.len()).filter(|index| bytes[*index].0 == state);
            byte_indices.map(start_bit_index).collect::<Vec<_>>()
        };
        for (index, (_, byte, next_state)) in bytes.iter().enumerate() {
            let sent_bits = 1 << 9 | u16::from(*byte) << 1;
            let levels = (0..10).map(|bit| sent_bits >> bit & 1 == 1);
            graph.levels.extend(levels);
            let later_bits = (1..10).map(|bit| vec![start_bit_index(index) + bit]);
            graph.successors.extend(later_bits);
            let next_start_bits = next_state.map_or(vec![0], start_bits_after);
            graph.successors.push(next_start_bits);
        }
        graph.first_start_bits = start_bits_after(LineAutomaton::START);
        graph
    }

    /// Creates the graph of any sequence of 7-bit bytes, with or without pauses between them.
    fn for_any_bytes() -> Self {
        let mut automaton = LineAutomaton::new();
        automaton.transitions[0] = (0..0x80).map(|byte| (byte, 0)).collect();
        let mut graph = Self::for_automaton(&automaton);
        graph.successors[0].extend(graph.first_start_bits.clone());
        // A pause may follow the stop bit of each byte.
        for index in 0..0x80 {
            graph.successors[10 + 10 * index].push(0);
        }
        graph
    }
}

/// Computes the possible sample times of the ten bits of a byte, as numbers of whole sender bits since the start edge:
/// one array for each combination of clock error and sample point.
fn compute_sample_times(sender: BaudRate, receiver: BaudRate) -> BTreeSet<[usize; 10]> {
    // The nearest baud rate that the chip's divider can produce, as in src/board/serial.rs.
    let chip_baud = 2e6 / (2e6 / f64::from(receiver.baud())).round();
    let ratio = f64::from(sender.baud()) / chip_baud;
    let mut sample_times = BTreeSet::new();
    for clock_step in 0..=400 {
        let ratio = ratio * (1.0 + MAX_CLOCK_ERROR * (f64::from(clock_step) / 200.0 - 1.0));
        for sample_point_step in 0..=32 {
            let [earliest, latest] = SAMPLE_POINT_RANGE;
            let sample_point = earliest + (latest - earliest) * f64::from(sample_point_step) / 32.0;
            let sample_time = |bit: usize| ((bit as f64 + sample_point) * ratio) as usize;
            sample_times.insert(core::array::from_fn(sample_time));
        }
    }
    sample_times
}

/// The receiver's line, and the bit of the graph that the sender is sending.
type LinkState = (ReceivedLine, usize);

/// Receives a byte from each start edge. Returns all possible states after the byte.
fn receive_byte(
    start_edges: &BTreeSet<LinkState>,
    graph: &BitGraph,
    automaton: &LineAutomaton,
    sample_times: [usize; 10],
) -> BTreeSet<LinkState> {
    let mut current_states: BTreeSet<(ReceivedLine, usize, u16)> = start_edges
        .iter()
        .map(|(line, bit_index)| (*line, *bit_index, 0))
        .collect();
    let mut time = 0;
    for (bit, sample_time) in sample_times.into_iter().enumerate() {
        while time < sample_time {
            time += 1;
            let advance = |(line, bit_index, sampled_bits): &(ReceivedLine, usize, u16)| {
                let (line, sampled_bits) = (*line, *sampled_bits);
                graph.successors[*bit_index]
                    .iter()
                    .map(move |next_bit| (line, *next_bit, sampled_bits))
            };
            current_states = current_states.iter().flat_map(advance).collect();
        }
        let sample = |(line, bit_index, sampled_bits)| {
            let level = u16::from(graph.levels[bit_index]);
            (line, bit_index, sampled_bits | level << bit)
        };
        current_states = current_states
            .into_iter()
            .map(sample)
            // The receiver ignores a start bit that it samples as high.
            .filter(|(.., sampled_bits)| sampled_bits & 1 == 0)
            .collect();
    }
    let finish_byte = |(line, bit_index, sampled_bits): (ReceivedLine, usize, u16)| {
        // A byte without a stop bit is garbled.
        let byte = if sampled_bits >> 9 == 1 {
            (sampled_bits >> 1) as u8
        } else {
            0xff
        };
        (line.advance(byte, automaton), bit_index)
    };
    current_states.into_iter().map(finish_byte).collect()
}

/// Finds the start edges that may follow these states.
fn find_start_edges(states: BTreeSet<LinkState>, graph: &BitGraph) -> BTreeSet<LinkState> {
    let (mut visited, mut start_edges) = (BTreeSet::new(), BTreeSet::new());
    let mut to_visit: Vec<LinkState> = states.into_iter().collect();
    while let Some((line, bit_index)) = to_visit.pop() {
        if !visited.insert((line, bit_index)) {
            continue;
        }
        for next_bit in &graph.successors[bit_index] {
            if graph.levels[bit_index] && !graph.levels[*next_bit] {
                start_edges.insert((line, *next_bit));
            } else {
                to_visit.push((line, *next_bit));
            }
        }
    }
    start_edges
}

/// Finds the commands that a receiver may decode from a sender's bits, by visiting every state that the two can reach
/// together. Each command is identified by its final automaton state.
fn find_decodable_commands(sender: BaudRate, receiver: BaudRate) -> BTreeSet<usize> {
    let graph = BitGraph::for_automaton(&LineAutomaton::for_canonical_commands());
    let automaton = LineAutomaton::for_accepted_lines();
    let initial_lines = [
        ReceivedLine::CommandPrefix(LineAutomaton::START),
        ReceivedLine::Mismatch(LineAutomaton::START, 1),
        ReceivedLine::Garbled,
    ];
    let mut to_visit: BTreeSet<LinkState> = (graph.first_start_bits.iter())
        .flat_map(|start_bit| initial_lines.map(|line| (line, *start_bit)))
        .collect();
    let (mut visited, mut commands) = (to_visit.clone(), BTreeSet::new());
    while !to_visit.is_empty() {
        let mut end_states = BTreeSet::new();
        for sample_times in compute_sample_times(sender, receiver) {
            end_states.extend(receive_byte(&to_visit, &graph, &automaton, sample_times));
        }
        end_states.retain(|(line, _)| match line {
            ReceivedLine::CompleteCommand(command) => {
                commands.insert(*command);
                false
            }
            _ => true,
        });
        to_visit = find_start_edges(end_states, &graph);
        to_visit.retain(|state| visited.insert(*state));
    }
    let [sender, receiver] = [sender, receiver].map(BaudRate::baud);
    println!("{sender} at {receiver}: {} states", visited.len());
    commands
}

/// Iterates over the pairs of different rates, sender and receiver, whose sender is the faster one if
/// `is_sender_faster` is true, otherwise the slower one.
fn rate_pairs(is_sender_faster: bool) -> impl Iterator<Item = (BaudRate, BaudRate)> {
    let senders = BaudRate::ALL.into_iter();
    let pairs = senders.flat_map(|sender| BaudRate::ALL.map(|receiver| (sender, receiver)));
    pairs.filter(move |(sender, receiver)| {
        sender != receiver && (sender.baud() > receiver.baud()) == is_sender_faster
    })
}

#[test]
fn a_receiver_faster_than_the_sender_never_decodes_a_line_end() {
    let graph = BitGraph::for_any_bytes();
    let automaton = LineAutomaton::for_accepted_lines();
    for (sender, receiver) in rate_pairs(false) {
        let bit_indices = 0..graph.levels.len();
        let all_states = bit_indices.map(|bit_index| (ReceivedLine::Garbled, bit_index));
        let start_edges = find_start_edges(all_states.collect(), &graph);
        assert!(start_edges.len() > 128);
        for sample_times in compute_sample_times(sender, receiver) {
            let end_states = receive_byte(&start_edges, &graph, &automaton, sample_times);
            let line_end = ReceivedLine::CommandPrefix(LineAutomaton::START);
            let reads_line_end = end_states.iter().any(|(line, _)| *line == line_end);
            assert!(!reads_line_end, "{sender:?} received at {receiver:?}");
        }
    }
}

#[test]
fn a_receiver_slower_than_the_sender_misreads_lines_only_as_words_too_short_to_be_accepted() {
    let mut automaton = LineAutomaton::for_accepted_lines();
    let words = Word::ALL.iter().map(|word| word.spelling());
    let short_words = words.filter(|word| word.len() < MIN_COMMAND_BYTES);
    let short_words: BTreeSet<usize> = short_words.map(|word| automaton.add_word(word)).collect();
    for (sender, receiver) in rate_pairs(true) {
        let commands = find_decodable_commands(sender, receiver);
        let case = std::format!("{sender:?} at {receiver:?}: {commands:?}");
        assert!(commands.is_subset(&short_words), "{case}");
    }
}

#[test]
fn every_command_is_decoded_at_its_own_rate() {
    let mut automaton = LineAutomaton::for_accepted_lines();
    for rate in BaudRate::ALL {
        let commands = find_decodable_commands(rate, rate);
        let words = Word::ALL.iter().map(|word| word.spelling());
        for word in GAIT_NAMES.iter().map(String::as_str).chain(words) {
            let end_state = automaton.add_word(word);
            let argument_state = automaton.transitions[end_state][&b' '];
            let is_decoded = commands.contains(&end_state) || commands.contains(&argument_state);
            assert!(is_decoded, "{word} at {rate:?}");
        }
    }
}
