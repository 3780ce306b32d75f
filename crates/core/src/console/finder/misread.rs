//! Simulates every command sent at one baud rate and read at another, to find the lines that the robot would misread
//! as other commands.
//!
//! The serial line is modelled bit by bit: a receiver starts at a falling edge and samples the middle of each
//! of its own bits. The search visits every state that sender and receiver can reach together, so it covers
//! every command with every number, and every difference between their clocks.

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

/// The earliest and the latest sample point, as fractions of a bit, of a receiver with eight samples per bit: it
/// detects the start bit up to one sample late, and reads the majority of the samples 4, 5 and 6.
const SAMPLE_POINT_RANGE: [f64; 2] = [0.5, 0.625];

/// A receiver's reading of a line so far. The states are those of the automaton of accepted lines.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum LineReading {
    /// A command, or the beginning of one, that leads to this state.
    CommandPrefix(usize),
    /// The beginning of a command that leads to this state, followed by this many bytes that continue no command.
    Mismatch(usize, u8),
    /// A line with a garbled byte.
    Garbled,
    /// A line of unknown content: a backspace has deleted a byte, and the state before that byte is ambiguous.
    Deleted,
    /// A command with its line end; the state before the line end, or `usize::MAX` if the content is unknown.
    CompleteCommand(usize),
}

impl LineReading {
    /// Returns the reading after another byte.
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

/// A graph of the bits that a sender may send. Bit 0 is the idle line; each byte of the text has ten bits, a start bit
/// first.
struct BitGraph {
    /// The level of the serial line during each bit; true is high, as when idle.
    levels: Vec<bool>,
    /// The bits that may follow each bit.
    successors: Vec<Vec<usize>>,
    /// The start bits of the bytes with which a text may begin.
    first_start_bits: Vec<usize>,
}

impl BitGraph {
    /// Creates the graph of every line that the automaton accepts, sent without pauses and followed by the idle line.
    fn for_automaton(automaton: &LineAutomaton) -> Self {
        let mut bytes: Vec<(usize, u8, Option<usize>)> = Vec::new();
        for (state, transitions) in automaton.transitions.iter().enumerate() {
            bytes.extend(
                transitions
                    .iter()
                    .map(|(byte, next_state)| (state, *byte, Some(*next_state))),
            );
        }
        // CR, LF, or both.
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
        let start_bit_of = |index: usize| 1 + 10 * index;
        let start_bits_after = |state: usize| {
            let following_bytes = bytes
                .iter()
                .enumerate()
                .filter(move |(_, (from_state, ..))| *from_state == state);
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
                .successors
                .extend((1..10).map(|bit| vec![start_bit_of(index) + bit]));
            graph
                .successors
                .push(next_state.map_or(vec![0], start_bits_after));
        }
        graph.first_start_bits = start_bits_after(LineAutomaton::START);
        graph
    }

    /// Creates the graph of any sequence of 7-bit bytes, with or without pauses between them.
    fn with_any_bytes() -> Self {
        let mut automaton = LineAutomaton::new();
        automaton.transitions[0] = (0..0x80).map(|byte| (byte, 0)).collect();
        let mut graph = Self::for_automaton(&automaton);
        graph.successors[0].extend(graph.first_start_bits.clone());
        for index in 0..0x80 {
            graph.successors[10 + 10 * index].push(0);
        }
        graph
    }
}

/// Returns the times at which a receiver may sample the ten bits of a byte, in completed bits of the sender since the
/// start edge: one array for each clock error and each sample point.
fn possible_sample_times(sender: BaudRate, receiver: BaudRate) -> BTreeSet<[usize; 10]> {
    // The nearest rate that the chip's divider can produce, as in src/board/serial.rs.
    let chip_baud = 2e6 / (2e6 / f64::from(receiver.baud())).round();
    let ratio = f64::from(sender.baud()) / chip_baud;
    let mut sample_times = BTreeSet::new();
    for clock_step in 0..=400 {
        let ratio = ratio * (1.0 + MAX_CLOCK_ERROR * (f64::from(clock_step) / 200.0 - 1.0));
        for sample_point_step in 0..=32 {
            let sample_point = SAMPLE_POINT_RANGE[0]
                + (SAMPLE_POINT_RANGE[1] - SAMPLE_POINT_RANGE[0]) * f64::from(sample_point_step)
                    / 32.0;
            sample_times.insert(core::array::from_fn(|bit| {
                ((bit as f64 + sample_point) * ratio) as usize
            }));
        }
    }
    sample_times
}

/// A receiver's reading, and the bit of the graph that the sender is sending.
type ReceiverState = (LineReading, usize);

/// Reads a byte from each of these start edges; returns all possible states after the byte.
fn read_byte(
    start_edges: &BTreeSet<ReceiverState>,
    graph: &BitGraph,
    automaton: &LineAutomaton,
    sample_times: [usize; 10],
) -> BTreeSet<ReceiverState> {
    let mut current_states: BTreeSet<(LineReading, usize, u16)> = start_edges
        .iter()
        .map(|(reading, bit_index)| (*reading, *bit_index, 0))
        .collect();
    let mut time = 0;
    for (bit, sample_time) in sample_times.into_iter().enumerate() {
        while time < sample_time {
            time += 1;
            let advance = |(reading, bit_index, level_bits): &(LineReading, usize, u16)| {
                let (reading, level_bits) = (*reading, *level_bits);
                graph.successors[*bit_index]
                    .iter()
                    .map(move |next_bit| (reading, *next_bit, level_bits))
            };
            current_states = current_states.iter().flat_map(advance).collect();
        }
        let sample = |(reading, bit_index, level_bits)| {
            (
                reading,
                bit_index,
                level_bits | u16::from(graph.levels[bit_index]) << bit,
            )
        };
        current_states = current_states
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
    current_states.into_iter().map(finish_byte).collect()
}

/// Finds the start edges that can follow these states.
fn start_edges_after(states: BTreeSet<ReceiverState>, graph: &BitGraph) -> BTreeSet<ReceiverState> {
    let (mut visited, mut start_edges) = (BTreeSet::new(), BTreeSet::new());
    let mut to_visit: Vec<ReceiverState> = states.into_iter().collect();
    while let Some((reading, bit_index)) = to_visit.pop() {
        if !visited.insert((reading, bit_index)) {
            continue;
        }
        for next_bit in &graph.successors[bit_index] {
            if graph.levels[bit_index] && !graph.levels[*next_bit] {
                start_edges.insert((reading, *next_bit));
            } else {
                to_visit.push((reading, *next_bit));
            }
        }
    }
    start_edges
}

/// Finds the commands that a receiver can read from a sender, over all states that both can reach together. Each
/// command is given by its last state.
fn find_readable_commands(sender: BaudRate, receiver: BaudRate) -> BTreeSet<usize> {
    let (graph, automaton) = (
        BitGraph::for_automaton(&LineAutomaton::all_commands()),
        LineAutomaton::accepted_lines(),
    );
    let initial_readings = [
        LineReading::CommandPrefix(LineAutomaton::START),
        LineReading::Mismatch(LineAutomaton::START, 1),
        LineReading::Garbled,
    ];
    let mut to_visit: BTreeSet<ReceiverState> = (graph.first_start_bits.iter())
        .flat_map(|start_bit| initial_readings.map(|reading| (reading, *start_bit)))
        .collect();
    let (mut visited, mut commands) = (to_visit.clone(), BTreeSet::new());
    while !to_visit.is_empty() {
        let mut end_states = BTreeSet::new();
        for sample_times in possible_sample_times(sender, receiver) {
            end_states.extend(read_byte(&to_visit, &graph, &automaton, sample_times));
        }
        end_states.retain(|(reading, _)| match reading {
            LineReading::CompleteCommand(command) => {
                commands.insert(*command);
                false
            }
            _ => true,
        });
        to_visit = start_edges_after(end_states, &graph);
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

/// Returns the pairs (sender, receiver) of different rates: those whose sender is faster if `is_sender_faster` is true,
/// else those whose sender is slower.
fn rate_pairs(is_sender_faster: bool) -> impl Iterator<Item = (BaudRate, BaudRate)> {
    let senders = BaudRate::ALL.into_iter();
    let pairs = senders.flat_map(|sender| BaudRate::ALL.map(|receiver| (sender, receiver)));
    pairs.filter(move |(sender, receiver)| {
        sender != receiver && (sender.baud() > receiver.baud()) == is_sender_faster
    })
}

#[test]
fn a_receiver_faster_than_the_sender_reads_no_line_end_in_any_bytes() {
    let graph = BitGraph::with_any_bytes();
    let automaton = LineAutomaton::accepted_lines();
    for (sender, receiver) in rate_pairs(false) {
        let start_edges: BTreeSet<ReceiverState> = (0..graph.levels.len())
            .filter(|bit_index| graph.levels[*bit_index])
            .flat_map(|bit_index| {
                graph.successors[bit_index]
                    .iter()
                    .filter(|next_bit| !graph.levels[**next_bit])
            })
            .map(|start_bit| (LineReading::Garbled, *start_bit))
            .collect();
        assert!(start_edges.len() > 128);
        for sample_times in possible_sample_times(sender, receiver) {
            let end_states = read_byte(&start_edges, &graph, &automaton, sample_times);
            let is_line_end_read = end_states
                .iter()
                .any(|(reading, _)| *reading == LineReading::CommandPrefix(LineAutomaton::START));
            assert!(!is_line_end_read, "{sender:?} read at {receiver:?}");
        }
    }
}

#[test]
fn a_receiver_slower_than_the_sender_misreads_lines_only_as_words_too_short_to_be_obeyed() {
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
    for rate in BaudRate::ALL {
        let commands = find_readable_commands(rate, rate);
        let words = Word::ALL.iter().map(|word| word.text());
        for word in GAIT_NAMES.iter().map(String::as_str).chain(words) {
            let end_state = automaton.add_word(word);
            let argument_state = automaton.transitions[end_state][&b' '];
            let is_read = commands.contains(&end_state) || commands.contains(&argument_state);
            assert!(is_read, "{word} at {rate:?}");
        }
    }
}
