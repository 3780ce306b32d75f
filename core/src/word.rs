//! The words that the console takes for its own.

use lizard_avr::flash;
use ufmt::uWrite;

/// The effect of a command on the servos, if the robot does it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// No pulse changes: a question, or a setting for later.
    None,
    /// A motion begins, with pulses for every servo.
    Moves,
    /// The pose is frozen.
    Freezes,
    /// The pulses end.
    Rests,
    /// A gait goes faster or slower.
    Paces,
    /// A servo's calibration changes: the pulses of a pose, or the travel.
    Calibrates,
}

macro_rules! words {
    ($($name:ident = $word:literal $arguments:literal, $effect:ident;)*) => {
        /// A word of the console; no gait's name may begin with one.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        #[allow(missing_docs, reason = "each name is followed by its word")]
        pub enum Word { $($name),* }

        impl Word {
            /// All of them, as `help` lists them.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// Its effect on the servos: the one place that says so. Rules and tests on
            /// hosts ask here, or [`crate::command::effect`] for a whole line.
            pub const fn effect(self) -> Effect {
                match self { $(Self::$name => Effect::$effect),* }
            }

            /// A line that the paper's robot takes: the word, with arguments where it wants
            /// some.
            pub const fn example(self) -> &'static str {
                match self { $(Self::$name => concat!($word, $arguments)),* }
            }
        }

        /// Each with a bar behind it.
        const LIST: &str = concat!($($word, "|"),*);
    };
}

words! {
    // name = word and the arguments of an example, effect
    Help = "help" "", None;
    QuestionMark = "?" "", None;
    Stop = "stop" "", Freezes;
    Rest = "rest" "", Rests;
    Status = "status" "", None;
    Pose = "pose" " 155 41.41 318.59 221.41", Moves;
    Speed = "speed" " 50", Paces;
    Watch = "watch" " 5", None;
    Trim = "trim" " 1 8", Calibrates;
    Limit = "limit" " 4 200 240", Calibrates;
    Dir = "dir" " 2 -", Calibrates;
    Scale = "scale" " 3 12", Calibrates;
    Cal = "cal" "", None;
    Center = "center" "", Moves;
    Save = "save" "", None;
    Load = "load" "", Calibrates;
    Factory = "factory" "", Calibrates;
    Boot = "boot" " stand", None;
    Deadman = "deadman" " 2000", None;
}

/// Follows each word in the list.
const BAR: u8 = b'|';

flash! {
    const CHARACTERS: [u8; LIST.len()] = *LIST.as_bytes().first_chunk().unwrap();
    const WORDS: [Word; Word::ALL.len()] = *Word::ALL.first_chunk().unwrap();
}

impl Word {
    /// The one that is written so.
    #[inline(never)]
    pub fn find(written: &[u8]) -> Option<Self> {
        let mut number = 0;
        // What is left of `written` after a word's beginning, if it has that.
        let mut left = Some(written);
        for place in 0..LIST.len() {
            let character = CHARACTERS.at(place).load();
            left = match left {
                Some([]) if character == BAR => return Some(WORDS.at(number).load()),
                _ if character == BAR => {
                    number += 1;
                    Some(written)
                }
                Some([first, rest @ ..]) if *first == character => Some(rest),
                _ => None,
            };
        }
        None
    }

    /// Prints all of them, with bars in between.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn print_all<W: uWrite + ?Sized>(out: &mut W) -> Result<(), W::Error> {
        for place in 0..LIST.len() - 1 {
            out.write_char(char::from(CHARACTERS.at(place).load() & 0x7f))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::string::String;

    use super::*;

    #[test]
    fn every_word_that_is_listed_is_found_and_nothing_else_is() {
        let mut list = String::new();
        let Ok(()) = Word::print_all(&mut list);
        let words = list.split('|');
        assert_eq!(words.clone().count(), 19);
        for (word, found) in words.zip(Word::ALL) {
            assert_eq!(Word::find(word.as_bytes()), Some(*found), "{word}");
            let longer = std::format!("{word}s");
            for other in [&word[1..], &word[..word.len() - 1], &longer] {
                assert_eq!(Word::find(other.as_bytes()), None, "{other}");
            }
        }
        for other in ["", "|", "help|", "help|?", "sway", "sto", "stoq"] {
            assert_eq!(Word::find(other.as_bytes()), None, "{other}");
        }
    }
}
