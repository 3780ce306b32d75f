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
    /// A line of unknown content: a byte was deleted whose previous state is ambiguous.
    Deleted,
    /// A command with its line end, in this state; `usize::MAX` if its content is unknown.
    CompleteCommand(usize),
}

impl LineReading {
    /// The reading after another byte.
    fn after_byte(self, byte: u8, text: &LineAutomaton) -> Self {
        match (byte.to_ascii_lowercase(), self) {
            (b'\r' | b'\n', Self::CommandPrefix(state))
                if text.accepting_states.contains(&state) =>
            {
                Self::CompleteCommand(state)
            }
            (b'\r' | b'\n', Self::Deleted) => Self::CompleteCommand(usize::MAX),
            (b'\r' | b'\n', _) => Self::CommandPrefix(LineAutomaton::START),
            (0x80.., _) | (_, Self::Garbled) => Self::Garbled,
            (_, Self::Deleted) => Self::Deleted,
            (0x08 | 0x7f, Self::CommandPrefix(state)) => text
                .previous_state(state)
                .map_or(Self::Deleted, Self::CommandPrefix),
            (0x08 | 0x7f, Self::Mismatch(state, 1)) => Self::CommandPrefix(state),
            (0x08 | 0x7f, Self::Mismatch(state, more)) => Self::Mismatch(state, more - 1),
            (_, Self::Mismatch(state, more)) => Self::Mismatch(state, more + 1),
            (byte, Self::CommandPrefix(state)) => text.transitions[state]
                .get(&byte)
                .map_or(Self::Mismatch(state, 1), |to| Self::CommandPrefix(*to)),
            (_, read) => read,
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
    fn of(text: &LineAutomaton) -> Self {
        let mut bytes: Vec<(usize, u8, Option<usize>)> = Vec::new();
        for (state, next) in text.transitions.iter().enumerate() {
            bytes.extend(next.iter().map(|(byte, to)| (state, *byte, Some(*to))));
        }
        // CR, LF, or both.
        let return_sent = text.transitions.len();
        for end in &text.accepting_states {
            bytes.extend([
                (*end, b'\n', None),
                (*end, b'\r', None),
                (*end, b'\r', Some(return_sent)),
            ]);
        }
        bytes.push((return_sent, b'\n', None));
        let mut bits = Self {
            levels: vec![true],
            next: vec![vec![0]],
            first_start_bits: Vec::new(),
        };
        let start = |index: usize| 1 + 10 * index;
        let followers = |state: usize| {
            let follows = bytes
                .iter()
                .enumerate()
                .filter(move |(_, byte)| byte.0 == state);
            follows.map(|(index, _)| start(index)).collect::<Vec<_>>()
        };
        for (index, (_, byte, to)) in bytes.iter().enumerate() {
            let line = 1 << 9 | u16::from(*byte) << 1;
            bits.levels.extend((0..10).map(|bit| line >> bit & 1 == 1));
            bits.next
                .extend((1..10).map(|bit| vec![start(index) + bit]));
            bits.next.push(to.map_or(vec![0], followers));
        }
        bits.first_start_bits = followers(LineAutomaton::START);
        bits
    }

    /// The bits of any 7-bit bytes in any order, with or without pauses.
    fn with_any_bytes() -> Self {
        let mut text = LineAutomaton::new();
        text.transitions[0] = (0..0x80).map(|byte| (byte, 0)).collect();
        let mut bits = Self::of(&text);
        bits.next[0].extend(bits.first_start_bits.clone());
        for index in 0..0x80 {
            bits.next[10 + 10 * index].push(0);
        }
        bits
    }
}

/// The bits of the sender that a receiver samples, counted from the start edge: for every difference of the
/// clocks and every position of the middle.
fn sampled_bits(sender: Rate, receiver: Rate) -> BTreeSet<[usize; 10]> {
    // The rate that the chip's divider can produce, as in src/board/serial.rs.
    let chip = 2e6 / (2e6 / f64::from(receiver.baud())).round();
    let ratio = f64::from(sender.baud()) / chip;
    let mut all = BTreeSet::new();
    for step in 0..=400 {
        let ratio = ratio * (1.0 + CLOCK_ERROR * (f64::from(step) / 200.0 - 1.0));
        for step in 0..=32 {
            let middle = BIT_MIDDLE[0] + (BIT_MIDDLE[1] - BIT_MIDDLE[0]) * f64::from(step) / 32.0;
            all.insert(core::array::from_fn(|bit| {
                ((bit as f64 + middle) * ratio) as usize
            }));
        }
    }
    all
}

/// A receiver's reading, and the bit that the sender sends at that time.
type ReceiverState = (LineReading, usize);

/// Reads a byte from each of these start edges; returns the states after it.
fn read_byte(
    edges: &BTreeSet<ReceiverState>,
    bits: &BitGraph,
    text: &LineAutomaton,
    look: [usize; 10],
) -> BTreeSet<ReceiverState> {
    let mut current: BTreeSet<(LineReading, usize, u16)> =
        edges.iter().map(|(read, at)| (*read, *at, 0)).collect();
    let mut time = 0;
    for (bit, at) in look.into_iter().enumerate() {
        while time < at {
            time += 1;
            let next = |(read, at, line): &(LineReading, usize, u16)| {
                let (read, line) = (*read, *line);
                bits.next[*at].iter().map(move |next| (read, *next, line))
            };
            current = current.iter().flat_map(next).collect();
        }
        let look = |(read, at, line)| (read, at, line | u16::from(bits.levels[at]) << bit);
        current = current
            .into_iter()
            .map(look)
            .filter(|(.., line)| line & 1 == 0)
            .collect();
    }
    let end = |(read, at, line): (LineReading, usize, u16)| {
        // A byte without a stop bit is garbled.
        let byte = if line >> 9 == 1 {
            (line >> 1) as u8
        } else {
            0xff
        };
        (read.after_byte(byte, text), at)
    };
    current.into_iter().map(end).collect()
}

/// The start edges that can follow these states.
fn edges_from(states: BTreeSet<ReceiverState>, bits: &BitGraph) -> BTreeSet<ReceiverState> {
    let (mut visited, mut edges) = (BTreeSet::new(), BTreeSet::new());
    let mut to_visit: Vec<ReceiverState> = states.into_iter().collect();
    while let Some((read, at)) = to_visit.pop() {
        if !visited.insert((read, at)) {
            continue;
        }
        for next in &bits.next[at] {
            if bits.levels[at] && !bits.levels[*next] {
                edges.insert((read, *next));
            } else {
                to_visit.push((read, *next));
            }
        }
    }
    edges
}

/// The commands that a receiver can read at another rate, over all states that it can reach.
fn commands_read(sender: Rate, receiver: Rate) -> BTreeSet<usize> {
    let (bits, text) = (
        BitGraph::of(&LineAutomaton::all_commands()),
        LineAutomaton::accepted_lines(),
    );
    let before = [
        LineReading::CommandPrefix(LineAutomaton::START),
        LineReading::Mismatch(LineAutomaton::START, 1),
        LineReading::Garbled,
    ];
    let mut to_visit: BTreeSet<ReceiverState> = (bits.first_start_bits.iter())
        .flat_map(|state| before.map(|read| (read, *state)))
        .collect();
    let (mut visited, mut commands) = (to_visit.clone(), BTreeSet::new());
    while !to_visit.is_empty() {
        let mut ends = BTreeSet::new();
        for look in sampled_bits(sender, receiver) {
            ends.extend(read_byte(&to_visit, &bits, &text, look));
        }
        ends.retain(|(read, _)| match read {
            LineReading::CompleteCommand(command) => {
                commands.insert(*command);
                false
            }
            _ => true,
        });
        to_visit = edges_from(ends, &bits);
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
    let all = Rate::ALL.into_iter();
    let pairs = all.flat_map(|sender| Rate::ALL.map(|receiver| (sender, receiver)));
    pairs.filter(move |(sender, receiver)| {
        sender != receiver && (sender.baud() > receiver.baud()) == is_faster
    })
}

#[test]
fn no_line_ends_at_a_receiver_that_is_faster_than_the_sender_of_any_bytes() {
    let bits = BitGraph::with_any_bytes();
    let text = LineAutomaton::accepted_lines();
    for (sender, receiver) in rate_pairs(false) {
        let edges: BTreeSet<ReceiverState> = (0..bits.levels.len())
            .filter(|state| bits.levels[*state])
            .flat_map(|state| bits.next[state].iter().filter(|next| !bits.levels[**next]))
            .map(|state| (LineReading::Garbled, *state))
            .collect();
        assert!(edges.len() > 128);
        for look in sampled_bits(sender, receiver) {
            let read = read_byte(&edges, &bits, &text, look);
            let ends = read
                .iter()
                .any(|(read, _)| *read == LineReading::CommandPrefix(LineAutomaton::START));
            assert!(!ends, "{sender:?} read at {receiver:?}");
        }
    }
}

#[test]
fn no_command_that_may_come_first_is_read_at_a_slower_rate() {
    let mut text = LineAutomaton::accepted_lines();
    let words = Word::ALL.iter().map(|word| word.text());
    let is_short = |word: &&str| word.len() < MIN_COMMAND_BYTES;
    let short: BTreeSet<usize> = words
        .filter(is_short)
        .map(|word| text.add_word(word))
        .collect();
    for (sender, receiver) in rate_pairs(true) {
        let read = commands_read(sender, receiver);
        assert!(
            read.is_subset(&short),
            "{sender:?} at {receiver:?}: {read:?}"
        );
    }
}

#[test]
fn every_command_is_read_at_its_own_rate() {
    let mut text = LineAutomaton::accepted_lines();
    for rate in Rate::ALL {
        let read = commands_read(rate, rate);
        let words = Word::ALL.iter().map(|word| word.text());
        for word in GAITS.iter().map(String::as_str).chain(words) {
            let end = text.add_word(word);
            let with_arguments = text.transitions[end][&b' '];
            let is_read = read.contains(&end) || read.contains(&with_arguments);
            assert!(is_read, "{word} at {rate:?}");
        }
    }
}
