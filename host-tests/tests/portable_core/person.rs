//! Somebody at the console: types lines, reads answers, while the frames go by.

use std::collections::HashMap;

use lizard::console::{Console, Counters, LONGEST_LINE};
use lizard::pose::Pulses;

use crate::frames::WAKING;

/// A person, the console, and the frames that a test lets pass.
pub struct Person {
    pub console: Console,
    pub counters: Counters,
}

impl Person {
    /// At power-on, the banner not yet read.
    pub fn new() -> Self {
        Self {
            console: Console::new(),
            counters: Counters::default(),
        }
    }

    /// With the banner read and the robot awake.
    pub fn standing() -> Self {
        let mut person = Self::new();
        assert_eq!(person.listen().len(), 1, "the banner");
        person.run(WAKING + 1);
        person
    }

    /// Everything that the console has to say, line by line, each checked for
    /// its form.
    pub fn listen(&mut self) -> Vec<String> {
        let mut lines = Vec::new();
        while self.console.has_news() {
            let mut text = String::new();
            let Ok(()) = self.console.speak(&mut text, self.counters);
            assert!(text.len() <= usize::from(LONGEST_LINE), "{text}");
            let line = text.strip_suffix("\r\n").expect("a whole line");
            let plain = |byte: u8| byte == b' ' || byte.is_ascii_graphic();
            assert!(line.bytes().all(plain), "{line:?}");
            assert!(is_information(line) || is_final(line), "{line:?}");
            lines.push(line.to_owned());
            assert!(lines.len() < 100, "it never stops");
        }
        lines
    }

    /// Types bytes, as the firmware's main loop takes them: each one when there
    /// is nothing to say. Returns what was said.
    pub fn type_in(&mut self, bytes: &[u8]) -> Vec<String> {
        let mut lines = self.listen();
        for byte in bytes {
            self.console.hear(*byte);
            lines.extend(self.listen());
        }
        lines
    }

    /// Types a line and returns its final line, the only one.
    pub fn say(&mut self, line: &str) -> String {
        let said = self.type_in(format!("{line}\r").as_bytes());
        let (last, before) = said.split_last().expect("an answer");
        assert!(is_final(last), "{last}");
        assert!(before.iter().all(|line| is_information(line)), "{said:?}");
        last.clone()
    }

    /// A frame, and what was said because of it.
    pub fn frame(&mut self) -> (Pulses, Vec<String>) {
        let pulses = self.console.frame();
        (pulses, self.listen())
    }

    /// Some frames, and all that was said.
    pub fn run(&mut self, frames: u32) -> Vec<String> {
        (0..frames).flat_map(|_| self.frame().1).collect()
    }

    /// A value of the status line.
    pub fn status(&mut self, key: &str) -> String {
        let line = self.say("status");
        let mut pairs = pairs(line.strip_prefix("ok ").expect("a status"));
        pairs.remove(key).expect(key)
    }
}

/// True for a line of further information.
pub fn is_information(line: &str) -> bool {
    line.starts_with("# ")
}

/// True for the one line that ends an answer.
pub fn is_final(line: &str) -> bool {
    match line.strip_prefix("err ") {
        None => line.starts_with("ok "),
        Some(rest) => {
            let (code, reason) = rest.split_once(' ').unwrap_or((rest, ""));
            matches!(code, "1" | "2" | "3" | "4" | "5" | "6" | "7") && !reason.is_empty()
        }
    }
}

/// `key=value` pairs with blanks between.
///
/// # Panics
/// If the text is anything else, or says a key twice.
pub fn pairs(text: &str) -> HashMap<String, String> {
    let mut pairs = HashMap::new();
    for word in text.split(' ') {
        let (key, value) = word.split_once('=').expect("key=value");
        assert!(!key.is_empty() && !value.is_empty(), "{text}");
        assert!(pairs.insert(key.to_owned(), value.to_owned()).is_none());
    }
    pairs
}
