//! A console with somebody at the other end of its line.

use std::collections::HashMap;
use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use crate::console::{Console, Counters, LONGEST_LINE};
use crate::pose::Pulses;
use crate::restart::Restart;
use crate::safety::Health;
use crate::sample::{Chip, Sample, WELL};

/// Frames until the robot stands and may begin to move.
pub(super) const WAKING: u32 = 21;

/// A console, and what its other end reads.
pub(super) struct Dialogue {
    pub(super) console: Console<Sample>,
    pub(super) counters: Counters,
    pub(super) chip: Chip,
    pub(super) health: Health,
}

impl Dialogue {
    /// At power-on, the banner not yet read.
    pub(super) fn new(robot: Sample) -> Self {
        Self::begun(robot, Chip::blank(), Restart::default())
    }

    pub(super) fn begun(robot: Sample, chip: Chip, restart: Restart) -> Self {
        Self {
            console: {
                let mut console = Console::new(robot);
                console.begin(&chip, &restart);
                console
            },
            counters: Counters::default(),
            chip,
            health: WELL,
        }
    }

    /// With the banner read and the robot awake.
    pub(super) fn standing() -> Self {
        Self::awake(Sample::odd())
    }

    pub(super) fn awake(robot: Sample) -> Self {
        let mut dialogue = Self::new(robot);
        let said = dialogue.read();
        assert_eq!(
            said.len(),
            2,
            "the banner, and that nothing is saved: {said:?}"
        );
        dialogue.run(WAKING);
        dialogue
    }

    /// Every line that waits, each checked for its form.
    pub(super) fn read(&mut self) -> Vec<String> {
        let mut lines = Vec::new();
        while self.console.has_output() || self.console.is_writing() {
            if !self.console.has_output() {
                self.console.write_memory(&mut self.chip);
                continue;
            }
            let mut text = String::new();
            while !text.ends_with("\r\n") && self.console.has_output() {
                let Ok(()) = self.console.write_line(&mut text, self.counters);
            }
            assert!(text.len() <= usize::from(LONGEST_LINE), "{text}");
            let line = text.strip_suffix("\r\n").expect("a whole line");
            let plain = |byte: u8| byte == b' ' || byte.is_ascii_graphic();
            assert!(line.bytes().all(plain), "{line:?}");
            assert!(line.starts_with("# ") || is_final(line), "{line:?}");
            lines.push(line.to_string());
            assert!(lines.len() < 400, "it never stops");
        }
        lines
    }

    /// Sends bytes, each when there is nothing to write, as main does.
    pub(super) fn send(&mut self, bytes: &[u8]) -> Vec<String> {
        let mut lines = self.read();
        for byte in bytes {
            self.console.receive(*byte);
            lines.extend(self.read());
        }
        lines
    }

    /// Sends a line and returns its final line, the only one and the last.
    pub(super) fn say(&mut self, line: &str) -> String {
        let said = self.send(format!("{line}\r").as_bytes());
        let (last, before) = said.split_last().expect("an answer");
        assert!(is_final(last), "{last}");
        assert!(before.iter().all(|line| line.starts_with("# ")), "{said:?}");
        last.clone()
    }

    pub(super) fn frame(&mut self) -> (Pulses, Vec<String>) {
        let pulses = self.console.frame(&self.health);
        (pulses, self.read())
    }

    pub(super) fn run(&mut self, frames: u32) -> Vec<String> {
        (0..frames).flat_map(|_| self.frame().1).collect()
    }

    /// A value of the status line.
    pub(super) fn status(&mut self, key: &str) -> String {
        let line = self.say("status");
        pairs(line.strip_prefix("ok ").expect("a status"))[key].clone()
    }
}

/// The pulses of a frame.
pub(super) fn widths(dialogue: &mut Dialogue) -> [u16; 4] {
    dialogue.frame().0.0.map(|width| width.0)
}

/// True for the one line that ends an answer.
pub(super) fn is_final(line: &str) -> bool {
    let code = line
        .strip_prefix("err ")
        .and_then(|rest| rest.split_once(' '));
    line.starts_with("ok ")
        || code.is_some_and(|(code, reason)| {
            matches!(code, "1" | "2" | "3" | "4" | "5" | "6" | "7" | "8" | "9")
                && !reason.is_empty()
        })
}

/// `key=value` with blanks between, each key once.
pub(super) fn pairs(text: &str) -> HashMap<String, String> {
    let mut pairs = HashMap::new();
    for word in text.split(' ') {
        let (key, value) = word.split_once('=').expect("key=value");
        assert!(!key.is_empty() && !value.is_empty(), "{text}");
        assert!(pairs.insert(key.to_string(), value.to_string()).is_none());
    }
    pairs
}
