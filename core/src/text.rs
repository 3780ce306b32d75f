//! Every sentence that the robot prints, kept in flash.
//!
//! A string literal of an AVR program is copied to its 2 KiB of RAM at start.
//! The sentences here stay in flash as one run of characters, six bits each, and
//! are fetched one by one when they are printed.

use core::ops::{Range, RangeInclusive};

use lizard_avr::flash;
use ufmt::uWrite;

macro_rules! texts {
    ($($name:ident = $sentence:expr;)*) => {
        /// A sentence, or a part of one.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        #[allow(missing_docs, reason = "each name is followed by its sentence")]
        pub enum Text { $($name),* }

        const SENTENCES: &[&str] = &[$($sentence),*];
    };
}

texts! {
    // The banner and information lines.
    Banner = "# lizard ";
    Version = env!("CARGO_PKG_VERSION");
    BannerTables = " tables ";
    BannerEnd = ", send help for the commands";
    WatchTime = "# t=";
    WatchPose = " pose=";
    Held = "# held in the last safe pose: ";
    Information = "# ";
    Blank = " ";
    Nothing = "";
    CalTrim = " trim ";
    CalLimit = " limit ";
    CalDir = " dir ";
    CalScale = " scale ";
    CalBoot = "# boot ";
    CalDeadman = "# deadman ";

    // Notices: what is said without being asked for.
    MemoryBlank = "# calibration: none is saved, robot.toml's is in use";
    MemoryOther = "# calibration: one of two copies is damaged, the other is in use";
    MemoryDamaged = "# calibration: damaged, robot.toml's is in use";
    MemoryForeign = "# calibration: for other servos, robot.toml's is in use";
    MemoryUnfit = "# calibration: does not suit the gaits, robot.toml's is in use";
    NoticeFault = "# fault: ";
    NoticeSupply = "# supply: ";
    NoticeBoot = "# boot: ";
    WhyGuard = "the next pose is not safe, held";
    WhySupply = "the supply is too low to move";
    WhyLink = "no line for as long as deadman says, stopped";
    WhyWatchdog = "the program hung and began anew";
    WhyLate = "a pulse came late and was dropped, stopped";
    WhyStack = "the stack has grown into the data, stopped";
    LevelGood = ", good";
    LevelSlow = ", low: half speed, no saving";
    LevelStop = ", too low to move: stopped";
    LevelRest = ", too low to hold: pulses ended";

    // Help, a line each.
    HelpGaits = "# gaits:";
    HelpWords = "# others:";
    HelpHint = "# a word alone tells what it wants, the docs what it does";

    // Answers, and the words of commands.
    Ok = "ok ";
    OkHelp = "ok help";
    OkGait = "ok gait=";
    Help = "help";
    Stop = "stop";
    Rest = "rest";
    Pose = "pose";
    Speed = "speed";
    Watch = "watch";
    Status = "status";
    QuestionMark = "?";
    Trim = "trim";
    Limit = "limit";
    Dir = "dir";
    Scale = "scale";
    Cal = "cal";
    Center = "center";
    Save = "save";
    Load = "load";
    Factory = "factory";
    Boot = "boot";
    Deadman = "deadman";
    StatusPhase = " phase=";
    StatusMargin = " margin=";
    StatusSpeed = " speed=";
    StatusFrames = " frames=";
    StatusLate = " late=";
    StatusRxLost = " rx_lost=";
    StatusGuard = " guard=";
    GuardClear = "clear";
    GuardHeld = "held";
    StatusFault = " fault=";
    StatusReset = " reset=";
    StatusResets = " resets=";
    StatusVcc = " vcc=";
    StatusRail = " rail=";
    Unmeasured = "-";
    FaultNone = "none";
    FaultGuard = "guard";
    FaultSupply = "supply";
    FaultLink = "link";
    FaultWatchdog = "watchdog";
    FaultLate = "late";
    FaultStack = "stack";
    CausePower = "power";
    CauseExternal = "external";
    CauseBrownOut = "brownout";
    CauseWatchdog = "watchdog";
    Err = "err ";

    // Reasons.
    Unknown = "unknown command, send help for the list";
    Surplus = "this command takes no argument";
    Incomplete = "this command wants one more word";
    SpeedWants = "speed wants a whole number, 10..100";
    SpeedRange = "speed must be 10..100";
    WatchWants = "watch wants a whole number, 0..10000";
    WatchRange = "watch must be 0..10000";
    PoseWants = "pose wants four angles in degrees, at most two decimals";
    Beyond = " reaches ";
    Type2Head = "type-2 margin of the head";
    Type2Tail = "type-2 margin of the tail";
    Type1 = "type-1 margin of ";
    Leg = "leg margin of ";
    Is = " is ";
    Least = ", at least ";
    Left = "left";
    Right = "right";
    Slider = " slider is at ";
    Within = " mm, stroke ";
    Dots = "..";
    TooLong = "a line has at most 63 characters";
    Resting = "servos are resting, send stand first";
    TrimWants = "trim wants a servo 1..4 and degrees, at most two decimals";
    TrimRange = "trim must be -20..20";
    LimitWants = "limit wants a servo 1..4 and two angles in degrees, at most two decimals";
    LimitRange = "limit wants angles of at most one turn";
    DirWants = "dir wants a servo 1..4 and + or -";
    ScaleWants = "scale wants a servo 1..4 and us per degree, at most two decimals";
    ScaleRange = "scale must be 5..20";
    BootWants = "boot wants the name of a gait, or rest";
    DeadmanWants = "deadman wants a whole number of milliseconds, 0..60000";
    DeadmanRange = "deadman must be 0..60000";
    Needed = " would not reach what the gaits need, ";
    NotHere = " would not reach where it is or goes, send stand first";
    LowSupply = "the supply is too low";
    NotKept = "the memory does not keep what is written";
    NothingSaved = "nothing is saved that could be loaded";
}

const COUNT: usize = SENTENCES.len();
const LENGTH: usize = starts()[COUNT] as usize;

/// Bytes that hold so many characters.
const BYTE_COUNT: usize = LENGTH.div_ceil(4) * 3;

/// Codes of letters.
const LETTERS: RangeInclusive<u8> = 0x21..=0x3a;

flash! {
    const BYTES: [u8; BYTE_COUNT] = bytes();
    const STARTS: [u16; COUNT + 1] = starts();
}

impl Text {
    /// Prints the sentence.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn print<W: uWrite + ?Sized>(self, out: &mut W) -> Result<(), W::Error> {
        for at in self.place() {
            out.write_char(char::from(character(at) & 0x7f))?;
        }
        Ok(())
    }

    /// Its length in bytes.
    pub fn length(self) -> u8 {
        self.place().len() as u8
    }

    /// True if the sentence is just this word.
    pub fn is(self, word: &[u8]) -> bool {
        let place = self.place();
        place.len() == word.len() && place.zip(word).all(|(at, byte)| character(at) == *byte)
    }

    fn place(self) -> Range<usize> {
        let start = |index: usize| usize::from(STARTS.at(index).load());
        start(self as usize)..start(self as usize + 1)
    }
}

/// The character at a place among all sentences.
#[inline(never)]
fn character(place: usize) -> u8 {
    let group = (place >> 2) * 3;
    let byte = |n: usize| BYTES.at(group + n).load();
    // Bit by bit shifts of two bytes would cost as much as sending the character.
    let code = match place & 3 {
        0 => byte(0) >> 2,
        1 => (byte(0) << 4 | byte(1) >> 4) & 0x3f,
        2 => (byte(1) << 2 | byte(2) >> 6) & 0x3f,
        _ => byte(2) & 0x3f,
    };
    code + if LETTERS.contains(&code) { 0x40 } else { 0x20 }
}

/// A character's six bits: ASCII from the blank to the underscore, less 32, with
/// lower-case letters in the place of capitals, of which there are none.
const fn code(character: u8) -> u8 {
    match character {
        b'a'..=b'z' => character - 0x40,
        b' '..=b'@' | b'_' => character - 0x20,
        _ => panic!("a sentence has lower-case letters, digits and signs below 0x40"),
    }
}

/// All sentences, six bits a character, four characters in three bytes.
const fn bytes() -> [u8; BYTE_COUNT] {
    let mut bytes = [0; BYTE_COUNT];
    let mut index = 0;
    let mut place = 0;
    while index < COUNT {
        let sentence = SENTENCES[index].as_bytes();
        let mut at = 0;
        while at < sentence.len() {
            let code = code(sentence[at]);
            let group = place / 4 * 3;
            match place & 3 {
                0 => bytes[group] = code << 2,
                1 => {
                    bytes[group] |= code >> 4;
                    bytes[group + 1] = code << 4;
                }
                2 => {
                    bytes[group + 1] |= code >> 2;
                    bytes[group + 2] = code << 6;
                }
                _ => bytes[group + 2] |= code,
            }
            place += 1;
            at += 1;
        }
        index += 1;
    }
    bytes
}

/// Where each sentence starts; the last entry is where the last one ends.
const fn starts() -> [u16; COUNT + 1] {
    let mut starts = [0; COUNT + 1];
    let mut index = 0;
    while index < COUNT {
        starts[index + 1] = starts[index] + SENTENCES[index].len() as u16;
        index += 1;
    }
    starts
}

#[cfg(test)]
mod tests {
    use std::string::String;

    use super::*;

    #[test]
    fn a_sentence_is_printed_whole_and_has_its_length() {
        for (text, expected) in [
            (Text::Banner, "# lizard "),
            (Text::Version, env!("CARGO_PKG_VERSION")),
            (Text::QuestionMark, "?"),
            (Text::Unknown, "unknown command, send help for the list"),
            (Text::Resting, "servos are resting, send stand first"),
        ] {
            let mut printed = String::new();
            let Ok(()) = text.print(&mut printed);
            assert_eq!(printed, expected);
            assert_eq!(usize::from(text.length()), expected.len());
        }
    }

    #[test]
    fn a_word_is_itself_and_neither_shorter_nor_longer() {
        assert!(Text::Stop.is(b"stop"));
        for other in ["", "s", "sto", "stoq", "stops", "rest"] {
            assert!(!Text::Stop.is(other.as_bytes()), "{other}");
        }
    }

    #[test]
    fn every_sentence_is_one_line_without_control_characters() {
        for sentence in SENTENCES {
            assert!(
                sentence
                    .bytes()
                    .all(|byte| byte == b' ' || byte.is_ascii_graphic())
            );
        }
    }
}
