//! The lines that a sender may send and those that the parser accepts, as state machines of their bytes.

use std::borrow::ToOwned;
use std::collections::{BTreeMap, BTreeSet};
use std::string::String;
use std::sync::LazyLock;
use std::vec::Vec;
use std::{format, fs, vec};

use crate::console::word::Word;

/// The names of all gaits in robots/ and of a routine, as they are sent.
pub static GAITS: LazyLock<BTreeSet<String>> = LazyLock::new(|| {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots");
    let files = fs::read_dir(folder).expect("the folder of robots");
    let mut names = BTreeSet::from(["patrol".to_owned()]);
    for file in files {
        let text = fs::read_to_string(file.expect("a file").path()).expect("text");
        let tables = text.lines().filter_map(|line| line.strip_prefix("[gait."));
        let gaits = tables.filter_map(|table| table.strip_suffix(']'));
        names.extend(
            gaits
                .filter(|name| !name.contains('.'))
                .map(|name| name.replace('-', " ")),
        );
    }
    assert!(names.len() > 25, "{names:?}");
    names
});

/// A state machine of text: the bytes that may follow each state, and the states in which a command may end.
#[derive(Default)]
pub struct LineAutomaton {
    pub transitions: Vec<BTreeMap<u8, usize>>,
    pub accepting_states: BTreeSet<usize>,
}

impl LineAutomaton {
    pub const START: usize = 0;

    pub fn new() -> Self {
        let mut automaton = Self::default();
        automaton.add_state();
        automaton
    }

    fn add_state(&mut self) -> usize {
        self.transitions.push(BTreeMap::new());
        self.transitions.len() - 1
    }

    /// Adds a state, with a transition to it from each of these states for each of these bytes; returns the state.
    fn add_transition(
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

    /// Adds a word at the start of a line, unless it is there already; returns the state at its end.
    pub fn add_word(&mut self, word: &str) -> usize {
        word.bytes().fold(Self::START, |state, byte| {
            self.transitions[state]
                .get(&byte)
                .copied()
                .unwrap_or_else(|| self.add_transition(&[state], [byte]))
        })
    }

    /// Adds up to `max_digits` digits; returns the states in which the number may end.
    fn add_digits(&mut self, from: &[usize], max_digits: usize) -> Vec<usize> {
        let mut states = from.to_vec();
        let mut ends = Vec::new();
        for _ in 0..max_digits {
            states = vec![self.add_transition(&states, b'0'..=b'9')];
            ends.extend(&states);
        }
        ends
    }

    /// Adds degrees or hundredths: an optional sign, up to three digits, up to two decimals; returns the states in
    /// which the number may end.
    fn add_decimal(&mut self, blank: usize) -> Vec<usize> {
        let sign = self.add_transition(&[blank], *b"+-");
        let mut ends = self.add_digits(&[blank, sign], 3);
        let point = self.add_transition(&ends, *b".");
        ends.extend(self.add_digits(&[point], 2));
        ends
    }

    /// The state before this one: the start if no state precedes it, `None` if several do.
    pub fn previous_state(&self, state: usize) -> Option<usize> {
        let leads_to_state = |from: &usize| self.transitions[*from].values().any(|to| *to == state);
        let mut previous_states = (0..self.transitions.len()).filter(leads_to_state);
        let first = previous_states.next().unwrap_or(Self::START);
        previous_states.next().is_none().then_some(first)
    }

    /// All commands, as programs and people write them.
    pub fn all_commands() -> Self {
        let mut automaton = Self::new();
        for gait in &*GAITS {
            let name_end = automaton.add_word(gait);
            let blank_state = automaton.add_transition(&[name_end], *b" ");
            let count_ends = automaton.add_digits(&[blank_state], 3);
            automaton.accepting_states.insert(name_end);
            automaton.accepting_states.extend(count_ends);
        }
        for word in Word::ALL {
            let word_end = automaton.add_word(word.text());
            if *word == Word::Boot {
                for argument in GAITS.iter().map(String::as_str).chain(["rest"]) {
                    let boot_end = automaton.add_word(&format!("boot {argument}"));
                    automaton.accepting_states.insert(boot_end);
                }
                continue;
            }
            let mut ends = vec![word_end];
            // The example has as many arguments as the word takes.
            for (index, example) in word.example().split(' ').skip(1).enumerate() {
                let blank_state = automaton.add_transition(&ends, *b" ");
                let is_whole_number = matches!(word, Word::Speed | Word::Watch | Word::Deadman);
                ends = match (word, index) {
                    (Word::Trim | Word::Limit | Word::Dir | Word::Scale, 0) => {
                        vec![automaton.add_transition(&[blank_state], *b"1234")]
                    }
                    _ if matches!(example, "+" | "-") => {
                        vec![automaton.add_transition(&[blank_state], *b"+-")]
                    }
                    _ if is_whole_number => automaton.add_digits(&[blank_state], 5),
                    _ => automaton.add_decimal(blank_state),
                };
            }
            automaton.accepting_states.extend(ends);
        }
        automaton
    }

    /// A superset of the lines that the parser accepts: arguments of any length and number.
    pub fn accepted_lines() -> Self {
        let mut automaton = Self::new();
        for word in GAITS
            .iter()
            .map(String::as_str)
            .chain(Word::ALL.iter().map(|word| word.text()))
        {
            let word_end = automaton.add_word(word);
            let blank_state = automaton.add_transition(&[word_end], *b" \t\x0c");
            let argument_bytes: Vec<u8> = match word {
                "boot" => (b' '..=b'~').collect(),
                _ => b"0123456789.+- \t\x0c".to_vec(),
            };
            for byte in argument_bytes {
                automaton.transitions[blank_state]
                    .entry(byte)
                    .or_insert(blank_state);
            }
            automaton.accepting_states.extend([word_end, blank_state]);
        }
        for blank in *b" \t\x0c" {
            automaton.transitions[Self::START].insert(blank, Self::START);
        }
        automaton
    }
}
