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
        let mut text = Self::default();
        text.add_state();
        text
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
    fn digits(&mut self, from: &[usize], max_digits: usize) -> Vec<usize> {
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
        let mut ends = self.digits(&[blank, sign], 3);
        let point = self.add_transition(&ends, *b".");
        ends.extend(self.digits(&[point], 2));
        ends
    }

    /// The state before state `at`: the start if no state precedes it, `None` if several do.
    pub fn previous_state(&self, at: usize) -> Option<usize> {
        let leads = |from: &usize| self.transitions[*from].values().any(|to| *to == at);
        let mut before = (0..self.transitions.len()).filter(leads);
        let first = before.next().unwrap_or(Self::START);
        before.next().is_none().then_some(first)
    }

    /// All commands, as programs and people write them.
    pub fn all_commands() -> Self {
        let mut text = Self::new();
        for gait in &*GAITS {
            let name = text.add_word(gait);
            let blank = text.add_transition(&[name], *b" ");
            let counts = text.digits(&[blank], 3);
            text.accepting_states.insert(name);
            text.accepting_states.extend(counts);
        }
        for word in Word::ALL {
            let end = text.add_word(word.text());
            if *word == Word::Boot {
                for argument in GAITS.iter().map(String::as_str).chain(["rest"]) {
                    let end = text.add_word(&format!("boot {argument}"));
                    text.accepting_states.insert(end);
                }
                continue;
            }
            let mut ends = vec![end];
            // The example has as many arguments as the word takes.
            for (index, example) in word.example().split(' ').skip(1).enumerate() {
                let blank = text.add_transition(&ends, *b" ");
                let whole = matches!(word, Word::Speed | Word::Watch | Word::Deadman);
                ends = match (word, index) {
                    (Word::Trim | Word::Limit | Word::Dir | Word::Scale, 0) => {
                        vec![text.add_transition(&[blank], *b"1234")]
                    }
                    _ if matches!(example, "+" | "-") => {
                        vec![text.add_transition(&[blank], *b"+-")]
                    }
                    _ if whole => text.digits(&[blank], 5),
                    _ => text.add_decimal(blank),
                };
            }
            text.accepting_states.extend(ends);
        }
        text
    }

    /// A superset of the lines that the parser accepts: arguments of any length and number.
    pub fn accepted_lines() -> Self {
        let mut text = Self::new();
        for word in GAITS
            .iter()
            .map(String::as_str)
            .chain(Word::ALL.iter().map(|word| word.text()))
        {
            let end = text.add_word(word);
            let blank = text.add_transition(&[end], *b" \t\x0c");
            let any: Vec<u8> = match word {
                "boot" => (b' '..=b'~').collect(),
                _ => b"0123456789.+- \t\x0c".to_vec(),
            };
            for byte in any {
                text.transitions[blank].entry(byte).or_insert(blank);
            }
            text.accepting_states.extend([end, blank]);
        }
        for blank in *b" \t\x0c" {
            text.transitions[Self::START].insert(blank, Self::START);
        }
        text
    }
}
