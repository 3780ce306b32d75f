//! Finite automata for the lines that a sender may send and for the lines that the parser accepts.

use std::borrow::ToOwned;
use std::collections::{BTreeMap, BTreeSet};
use std::string::String;
use std::sync::LazyLock;
use std::vec::Vec;
use std::{format, fs, vec};

use crate::console::word::Word;

/// The names of all gaits in robots/ and of a routine, spelled as on the serial line, with spaces instead of hyphens.
pub static GAIT_NAMES: LazyLock<BTreeSet<String>> = LazyLock::new(|| {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots");
    let files = fs::read_dir(folder).expect("the folder robots/ is readable");
    let mut names = BTreeSet::from(["patrol".to_owned()]);
    for file in files {
        let text = fs::read_to_string(file.expect("robots/ can be listed").path())
            .expect("a robot file is readable text");
        let tables = text.lines().filter_map(|line| line.strip_prefix("[gait."));
        let gaits = tables.filter_map(|table| table.strip_suffix(']'));
        let gaits = gaits.filter(|name| !name.contains('.'));
        names.extend(gaits.map(|name| name.replace('-', " ")));
    }
    assert!(names.len() > 25, "{names:?}");
    names
});

/// A finite automaton that reads a line byte by byte.
#[derive(Default)]
pub struct LineAutomaton {
    /// For each state, the possible next bytes with the states to which they lead.
    pub transitions: Vec<BTreeMap<u8, usize>>,
    /// The states in which a command may end.
    pub accepting_states: BTreeSet<usize>,
}

impl LineAutomaton {
    /// The state at the start of a line.
    pub const START: usize = 0;

    /// Creates an automaton with only the start state.
    pub fn new() -> Self {
        let mut automaton = Self::default();
        automaton.add_state();
        automaton
    }

    /// Adds a state without transitions; returns it.
    fn add_state(&mut self) -> usize {
        self.transitions.push(BTreeMap::new());
        self.transitions.len() - 1
    }

    /// Adds a state, with a transition to it from each of these states for each of these bytes; returns the state.
    fn add_successor(
        &mut self,
        from: &[usize],
        bytes: impl IntoIterator<Item = u8> + Clone,
    ) -> usize {
        let to = self.add_state();
        for state in from {
            self.transitions[*state].extend(bytes.clone().into_iter().map(|byte| (byte, to)));
        }
        to
    }

    /// Adds a word at the start of a line, unless the automaton already has it; returns the state at its end.
    pub fn add_word(&mut self, word: &str) -> usize {
        word.bytes().fold(Self::START, |state, byte| {
            self.transitions[state]
                .get(&byte)
                .copied()
                .unwrap_or_else(|| self.add_successor(&[state], [byte]))
        })
    }

    /// Adds a number of one to `max_digits` digits; returns the states in which the number may end.
    fn add_digits(&mut self, from: &[usize], max_digits: usize) -> Vec<usize> {
        let mut states = from.to_vec();
        let mut end_states = Vec::new();
        for _ in 0..max_digits {
            states = vec![self.add_successor(&states, b'0'..=b'9')];
            end_states.extend(&states);
        }
        end_states
    }

    /// Adds a number with an optional sign, one to three digits, and at most two decimals after a point. Returns the
    /// states in which the number may end.
    fn add_decimal(&mut self, separator_state: usize) -> Vec<usize> {
        let sign_state = self.add_successor(&[separator_state], *b"+-");
        let mut end_states = self.add_digits(&[separator_state, sign_state], 3);
        let point_state = self.add_successor(&end_states, *b".");
        end_states.extend(self.add_digits(&[point_state], 2));
        end_states
    }

    /// Returns the only state that leads to `state`; the start state if there is no such state, `None` if there are
    /// several.
    pub fn previous_state(&self, state: usize) -> Option<usize> {
        let leads_to_state = |from: &usize| self.transitions[*from].values().any(|to| *to == state);
        let mut previous_states = (0..self.transitions.len()).filter(leads_to_state);
        let first_state = previous_states.next().unwrap_or(Self::START);
        previous_states.next().is_none().then_some(first_state)
    }

    /// Creates an automaton that accepts all commands in their canonical notation, with single spaces.
    pub fn for_canonical_commands() -> Self {
        let mut automaton = Self::new();
        for gait in &*GAIT_NAMES {
            let name_end = automaton.add_word(gait);
            let separator_state = automaton.add_successor(&[name_end], *b" ");
            let count_end_states = automaton.add_digits(&[separator_state], 3);
            automaton.accepting_states.insert(name_end);
            automaton.accepting_states.extend(count_end_states);
        }
        for word in Word::ALL {
            let word_end = automaton.add_word(word.spelling());
            if *word == Word::Boot {
                for argument in GAIT_NAMES.iter().map(String::as_str).chain(["rest"]) {
                    let boot_end = automaton.add_word(&format!("boot {argument}"));
                    automaton.accepting_states.insert(boot_end);
                }
                continue;
            }
            let mut end_states = vec![word_end];
            // The example has as many arguments as the command takes.
            for (index, example) in word.example().split(' ').skip(1).enumerate() {
                let separator_state = automaton.add_successor(&end_states, *b" ");
                let is_whole_number = matches!(word, Word::Speed | Word::Watch | Word::Deadman);
                end_states = match (word, index) {
                    (Word::Trim | Word::Limit | Word::Dir | Word::Scale, 0) => {
                        vec![automaton.add_successor(&[separator_state], *b"1234")]
                    }
                    _ if matches!(example, "+" | "-") => {
                        vec![automaton.add_successor(&[separator_state], *b"+-")]
                    }
                    _ if is_whole_number => automaton.add_digits(&[separator_state], 5),
                    _ => automaton.add_decimal(separator_state),
                };
            }
            automaton.accepting_states.extend(end_states);
        }
        automaton
    }

    /// Creates an automaton that accepts a superset of the lines that the parser accepts: any number of arguments of
    /// any length.
    pub fn for_accepted_lines() -> Self {
        let mut automaton = Self::new();
        let words = Word::ALL.iter().map(|word| word.spelling());
        for word in GAIT_NAMES.iter().map(String::as_str).chain(words) {
            let word_end = automaton.add_word(word);
            let separator_state = automaton.add_successor(&[word_end], *b" \t\x0c");
            let argument_bytes: Vec<u8> = match word {
                "boot" => (b' '..=b'~').collect(),
                _ => b"0123456789.+- \t\x0c".to_vec(),
            };
            let transitions = &mut automaton.transitions[separator_state];
            for byte in argument_bytes {
                transitions.entry(byte).or_insert(separator_state);
            }
            let end_states = [word_end, separator_state];
            automaton.accepting_states.extend(end_states);
        }
        for separator in *b" \t\x0c" {
            automaton.transitions[Self::START].insert(separator, Self::START);
        }
        automaton
    }
}
