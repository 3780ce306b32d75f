//! The command words of the console.

use lizard_avr::flash;

use crate::console::output::Output;
use crate::numbers::gaits::GaitId;
use crate::numbers::robot::Robot;

/// The effect of an accepted command on the servos.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// No pulse changes: the command is a query, or a setting that takes effect later.
    None,
    /// A motion begins, and every servo gets pulses.
    Motion,
    /// The pose is frozen.
    Freeze,
    /// The pulses end.
    Rest,
    /// The speed of gaits changes.
    SpeedChange,
    /// The calibration of a servo changes: the pulse for an angle, or the travel.
    CalibrationChange,
}

macro_rules! words {
    (
        reserved: { $($reserved:ident = $reserved_word:literal $reserved_arguments:literal, $reserved_effect:ident;)* }
        yielding: { $($yielding:ident = $yielding_word:literal $yielding_arguments:literal, $yielding_effect:ident;)* }
    ) => {
        words! { @all
            $($reserved = $reserved_word $reserved_arguments, $reserved_effect;)*
            $($yielding = $yielding_word $yielding_arguments, $yielding_effect;)*
        }

        /// The number of reserved words, with which no gait's name may begin. They come first in [`Word::ALL`].
        pub(crate) const RESERVED_COUNT: usize = [$(Word::$reserved),*].len();
    };
    (@all $($name:ident = $word:literal $arguments:literal, $effect:ident;)*) => {
        /// A command word of the console.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        #[allow(missing_docs, reason = "each variant is named after its word")]
        pub enum Word { $($name),* }

        impl Word {
            /// All words, in the order in which `help` lists them.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// The spelling of the word.
            pub const fn spelling(self) -> &'static str {
                match self { $(Self::$name => $word),* }
            }

            /// The effect of the word's command on the servos. For the effect of a whole line, see
            /// [`crate::console::command::effect`].
            pub const fn effect(self) -> Effect {
                match self { $(Self::$name => Effect::$effect),* }
            }

            /// A line that the robot of robots/paper.toml accepts: the word with the arguments that it requires.
            pub const fn example(self) -> &'static str {
                match self { $(Self::$name => concat!($word, $arguments)),* }
            }
        }

        /// All words, each followed by a bar.
        const WORD_LIST: &str = concat!($($word, "|"),*);
    };
}

// Each row: variant = "word" "arguments of the example", effect.
words! {
    // No gait's name may begin with one of these words. The list is closed, so that every later version accepts a robot
    // file that an earlier version has accepted.
    reserved: {
        Help = "help" "", None;
        QuestionMark = "?" "", None;
        Stop = "stop" "", Freeze;
        Rest = "rest" "", Rest;
        Status = "status" "", None;
        Pose = "pose" " 155 41.41 318.59 221.41", Motion;
        Speed = "speed" " 50", SpeedChange;
        Watch = "watch" " 5", None;
        Trim = "trim" " 1 8", CalibrationChange;
        Limit = "limit" " 4 200 240", CalibrationChange;
        Dir = "dir" " 2 -", CalibrationChange;
        Scale = "scale" " 3 12", CalibrationChange;
        Cal = "cal" "", None;
        Center = "center" "", Motion;
        Save = "save" "", None;
        Load = "load" "", CalibrationChange;
        Factory = "factory" "", CalibrationChange;
        Boot = "boot" " rest", None;
        Deadman = "deadman" " 2000", None;
    }
    // Words of later versions: each yields to a gait of the same name.
    yielding: {
    }
}

/// The character that ends each word of `WORD_LIST`.
const TERMINATOR: u8 = b'|';

flash! {
    const CHARACTERS: [u8; WORD_LIST.len()] = *WORD_LIST.as_bytes().first_chunk().unwrap();
    const WORDS: [Word; Word::ALL.len()] = *Word::ALL.first_chunk().unwrap();
}

impl Word {
    /// Finds the word with this spelling.
    #[inline(never)]
    pub fn find(spelling: &[u8]) -> Option<Self> {
        let mut word_index = 0;
        // The part of `spelling` that is not matched yet; `None` once it differs from the current word.
        let mut unmatched = Some(spelling);
        for index in 0..WORD_LIST.len() {
            let character = CHARACTERS.at(index).load();
            unmatched = match unmatched {
                Some([]) if character == TERMINATOR => return Some(WORDS.at(word_index).load()),
                _ if character == TERMINATOR => {
                    word_index += 1;
                    Some(spelling)
                }
                Some([first, rest @ ..]) if *first == character => Some(rest),
                _ => None,
            };
        }
        None
    }

    /// True if no gait's name may begin with this word.
    pub const fn is_reserved(self) -> bool {
        (self as usize) < RESERVED_COUNT
    }

    /// Prints all words, separated by bars, except yielding words that are also the name of a gait.
    /// `FIRST_YIELDING_INDEX` is the index of the first yielding word: a parameter, so that tests can make words yield.
    pub(crate) fn print_all<const FIRST_YIELDING_INDEX: usize>(
        out: &mut impl Output,
        robot: &Robot,
    ) {
        let mut word_index = 0;
        let mut prints_word = true;
        for index in 0..WORD_LIST.len() - 1 {
            let character = CHARACTERS.at(index).load();
            // Compiles to nothing while no word yields.
            if FIRST_YIELDING_INDEX < Self::ALL.len() && character == TERMINATOR {
                word_index += 1;
                prints_word =
                    word_index < FIRST_YIELDING_INDEX || !is_gait_name_at(index + 1, robot);
            }
            if prints_word {
                out.write_byte(character);
            }
        }
    }
}

/// True if the word at this index of `WORD_LIST` is also the name of a gait.
fn is_gait_name_at(index: usize, robot: &Robot) -> bool {
    GaitId::all(robot.gait_count()).any(|id| {
        let letters = (index..WORD_LIST.len()).map(|index| CHARACTERS.at(index).load());
        letters
            .take_while(|letter| *letter != TERMINATOR)
            .eq(robot.gait_name(id))
    })
}

#[cfg(test)]
mod tests {
    use std::string::String;
    use std::vec::Vec;

    use super::*;
    use crate::sample::Sample;

    /// The reserved words of the first version, which later versions must keep.
    const FIRST_VERSION_WORDS: &str = "help|?|stop|rest|status|pose|speed|watch|trim|limit|dir|\
        scale|cal|center|save|load|factory|boot|deadman";

    #[test]
    fn the_reserved_words_match_the_first_version() {
        let reserved = Word::ALL.iter().filter(|word| word.is_reserved());
        let reserved_words: Vec<&str> = reserved.map(|word| word.spelling()).collect();
        assert_eq!(reserved_words.join("|"), FIRST_VERSION_WORDS);
    }

    #[test]
    fn every_word_is_found_only_by_its_exact_spelling() {
        for word in Word::ALL {
            let spelling = word.spelling();
            assert_eq!(Word::find(spelling.as_bytes()), Some(*word), "{spelling}");
            let longer_word = std::format!("{spelling}s");
            for misspelling in [
                &spelling[1..],
                &spelling[..spelling.len() - 1],
                &longer_word,
            ] {
                assert_eq!(Word::find(misspelling.as_bytes()), None, "{misspelling}");
            }
        }
        for non_word in ["", "|", "help|", "help|?", "sway", "sto", "stoq"] {
            assert_eq!(Word::find(non_word.as_bytes()), None, "{non_word}");
        }
    }

    /// Checks that all words except these are printed.
    fn assert_lists_all_but<const FIRST_YIELDING_INDEX: usize>(robot: &Robot, omitted: &[Word]) {
        let words = Word::ALL.iter().filter(|word| !omitted.contains(word));
        let words: Vec<&str> = words.map(|word| word.spelling()).collect();
        let mut list = String::new();
        Word::print_all::<FIRST_YIELDING_INDEX>(&mut list, robot);
        assert_eq!(list, words.join("|"));
    }

    #[test]
    fn a_yielding_word_is_omitted_if_a_gait_has_the_same_name() {
        let robot = Sample::paper();
        assert_lists_all_but::<RESERVED_COUNT>(&robot, &[]);
        assert_lists_all_but::<1>(&robot, &[]);
        let mut robot = robot;
        for name in ["stop", "trim", "deadman", "sav", "loads", "boot on"] {
            robot = robot.with_gait(name);
        }
        let yielding_words = [Word::Stop, Word::Trim, Word::Deadman];
        assert_lists_all_but::<RESERVED_COUNT>(&robot, &[]);
        assert_lists_all_but::<1>(&robot, &yielding_words);
        assert_lists_all_but::<3>(&robot, &yielding_words[1..]);
        assert_lists_all_but::<9>(&robot, &yielding_words[2..]);
    }
}
