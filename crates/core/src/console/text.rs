//! Every message that the robot prints, kept in flash.
//!
//! An AVR program copies its string literals to its 2 KiB of RAM at start. The messages here stay in flash
//! and are packed: a frequent character has a four-bit code; any other character, or a phrase that several
//! messages share, has an eight-bit code. A message is unpacked while it is printed.

use lizard_avr::flash;

use crate::console::output::Output;

macro_rules! texts {
    ($($name:ident = $message:expr;)*) => {
        /// A message, or a part of one.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        #[allow(missing_docs, reason = "each name is followed by its message")]
        pub enum Text { $($name),* }

        const MESSAGES: &[&str] = &[$($message),*];
    };
}

texts! {
    // The banner and information lines.
    Banner = "# lizard ";
    Version = env!("CARGO_PKG_VERSION");
    BannerRobot = " robot ";
    BannerNoRobot = " without a robot";
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

    // Notices: unsolicited lines.
    MemoryBlank = "# calibration: none is saved, robot.toml's is in use";
    MemoryOneCopy = "# calibration: one of two copies is damaged, the other is in use";
    MemoryDamaged = "# calibration: damaged, robot.toml's is in use";
    MemoryForeign = "# calibration: for other servos, robot.toml's is in use";
    MemoryUnfit = "# calibration: does not suit the gaits, robot.toml's is in use";
    MemoryNotKept = "# memory: does not keep the pose of this rest";
    NoticeFault = "# fault: ";
    NoticeSupply = "# supply: ";
    NoticeBoot = "# boot: ";
    NoticeDone = "# done";
    NoticeWaiting = "# waiting for ";
    Button = "button";
    Nose = "nose";
    WhyGuard = "the next pose is not safe, held";
    WhySupply = "the supply is too low to move";
    WhyLink = "no line for as long as deadman says, stopped";
    WhyWatchdog = "the program hung and began anew";
    WhyLate = "a pulse came late, stopped";
    WhyBrownOut = "reset several times in a row by the button or a weak supply, resting";
    WhyRobot = "no robot in the flash, write one";
    WhyRobotFormat = "the robot in the flash is for another version, write it again";
    WhyRobotDamaged = "the robot in the flash is damaged, write it again";
    WhyStack = "the stack has grown into the data, stopped";
    LevelGood = ", good";
    LevelSlow = ", low: no saving, speed up to ";
    LevelStop = ", too low to move: stopped";
    LevelRest = ", too low to hold: pulses ended";

    // Help, a line each.
    HelpGaits = "# gaits:";
    HelpWords = "# others: ";
    HelpHint = "# a word alone tells what it wants, the docs what it does";

    // Answers.
    Ok = "ok ";
    OkHelp = "ok help";
    OkGait = "ok gait=";
    Stop = "stop";
    Rest = "rest";
    Pose = "pose";
    Cal = "cal";
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
    FaultNone = "none";
    FaultGuard = "guard";
    FaultSupply = "supply";
    FaultLink = "link";
    FaultWatchdog = "watchdog";
    FaultLate = "late";
    FaultStack = "stack";
    FaultBrownOut = "brownout";
    FaultRobot = "robot";
    CausePower = "power";
    CauseExternal = "external";
    CauseBrownOut = "brownout";
    CauseWatchdog = "watchdog";
    Err = "err ";

    // Reasons.
    UnknownCommand = "unknown command, send help for the list";
    Garbled = "the line came garbled, send it again";
    UnexpectedArgument = "this command takes no argument";
    IncompleteName = "this command wants one more word";
    CountUsage = "a gait takes a count, 1..999";
    SpeedUsage = "speed wants a whole number, 10..100";
    SpeedRange = "speed must be 10..100";
    WatchUsage = "watch wants a whole number, 0..10000";
    WatchRange = "watch must be 0..10000";
    PoseUsage = "pose wants four angles in degrees, at most two decimals";
    Reaches = " reaches ";
    Type2Head = "type-2 margin of the head";
    Type2Tail = "type-2 margin of the tail";
    Type1 = "type-1 margin of ";
    Leg = "leg margin of ";
    Is = " is ";
    IsBelow = " is below 0.1";
    AtLeast = ", at least ";
    Left = "left";
    Right = "right";
    SliderPosition = " slider is at ";
    StrokeRange = " mm, stroke ";
    Dots = "..";
    TooLong = "a line has at most 63 characters";
    Resting = "servos are resting, send stand first";
    TrimUsage = "trim wants a servo 1..4 and degrees, at most two decimals";
    TrimRange = "trim must be -20..20";
    LimitUsage = "limit wants a servo 1..4 and two angles in degrees, at most two decimals";
    LimitRange = "limit wants angles of at most one turn";
    DirUsage = "dir wants a servo 1..4 and + or -";
    ScaleUsage = "scale wants a servo 1..4 and us per degree, at most two decimals";
    ScaleRange = "scale must be 5..20";
    BootUsage = "boot wants the name of a gait, or rest";
    DeadmanUsage = "deadman wants a whole number of milliseconds, 0..60000";
    DeadmanRange = "deadman must be 0..60000";
    TooNarrowForGaits = " would not reach what the gaits need, ";
    TooNarrowForPose = " would not reach where it is or goes, send stand first";
    LowSupply = "the supply is too low";
    NotKept = "the memory does not keep what is written";
    NoRobot = "no robot in the flash";
    NothingSaved = "nothing is saved that could be loaded";
}

/// Phrases that occur in several messages, stored once. The longest come first, since the first phrase that
/// matches is used.
const PHRASES: &[&str] = &[
    " wants a servo 1..4 and ",
    ", robot.toml's is in use",
    ", at most two decimals",
    " wants a whole number",
    " would not reach wh",
    " angles in degrees",
    "# calibration: ",
    " margin of ",
    "stand first",
    " must be ",
    "command",
    "deadman",
    ", send ",
    "0..100",
    " wants",
    "supply",
    "watch",
    "speed",
    "type-",
    "limit",
    " what",
    "fault",
    "gait",
    " is ",
    "the ",
    "for ",
    ", ",
    "# ",
    "he",
];

/// Every character of the messages, the most frequent first.
const ALPHABET: &[u8; 45] = b" eotsarnldipmgcw0uh.=fb:vk1y2-,x6#z?_3+54'789";

/// The number of characters with a four-bit code; the remaining four-bit values begin eight-bit codes.
const SHORT_CODE_COUNT: u8 = 12;

const MESSAGE_COUNT: usize = MESSAGES.len();

/// The number of packed strings: the messages first, then the phrases.
const STRING_COUNT: usize = MESSAGE_COUNT + PHRASES.len();

/// The number of strings in a block. Only the start of each block and the length of each string are stored.
const STRINGS_PER_BLOCK: usize = 16;

const PACKED_STRINGS: PackedStrings = pack_strings();

flash! {
    /// The nibbles of all strings, two in each byte.
    const NIBBLES: [u8; PACKED_STRINGS.nibble_count.div_ceil(2)] = *PACKED_STRINGS.nibbles.first_chunk().unwrap();
    /// The length of each string, nibbles.
    const STRING_LENGTHS: [u8; STRING_COUNT] = PACKED_STRINGS.lengths;
    /// The index of each block's first nibble.
    const BLOCK_STARTS: [u16; STRING_COUNT.div_ceil(STRINGS_PER_BLOCK)] = PACKED_STRINGS.block_starts;
    /// The characters, by their code.
    const CHARACTERS: [u8; ALPHABET.len()] = *ALPHABET;
}

impl Text {
    /// Prints the message.
    #[inline(never)]
    pub fn print(self, out: &mut impl Output) {
        let mut current_string = PackedString::at(self as u8);
        // The rest of the message after the phrase that is being printed.
        let mut message_rest = PackedString::EMPTY;
        loop {
            if current_string.nibbles_left == 0 {
                current_string = message_rest;
                message_rest.nibbles_left = 0;
            }
            if current_string.nibbles_left == 0 {
                return;
            }
            let mut code = current_string.next_nibble();
            if code >= SHORT_CODE_COUNT {
                code = SHORT_CODE_COUNT
                    + (code - SHORT_CODE_COUNT) * 16
                    + current_string.next_nibble();
            }
            match code.checked_sub(ALPHABET.len() as u8) {
                None => {
                    let character = CHARACTERS.at(usize::from(code)).load();
                    out.write_byte(character);
                }
                Some(phrase_index) => {
                    message_rest = current_string;
                    current_string = PackedString::at(MESSAGE_COUNT as u8 + phrase_index);
                }
            }
        }
    }

    /// The length of the message in bytes.
    pub const fn length(self) -> u8 {
        MESSAGES[self as usize].len() as u8
    }
}

/// The unread nibbles of a packed string.
#[derive(Clone, Copy)]
struct PackedString {
    /// The index of the next nibble.
    nibble_index: u16,
    nibbles_left: u8,
}

impl PackedString {
    const EMPTY: Self = Self {
        nibble_index: 0,
        nibbles_left: 0,
    };

    /// Returns the packed message or phrase with this index; none of its nibbles has been read.
    #[inline(never)]
    fn at(string_index: u8) -> Self {
        let string_index = usize::from(string_index);
        let length_of = |string_index| STRING_LENGTHS.at(string_index).load();
        let mut nibble_index = BLOCK_STARTS.at(string_index / STRINGS_PER_BLOCK).load();
        for earlier_index in string_index / STRINGS_PER_BLOCK * STRINGS_PER_BLOCK..string_index {
            nibble_index += u16::from(length_of(earlier_index));
        }
        Self {
            nibble_index,
            nibbles_left: length_of(string_index),
        }
    }

    /// Reads the next nibble.
    #[inline(always)]
    fn next_nibble(&mut self) -> u8 {
        let nibbles = NIBBLES.at(usize::from(self.nibble_index >> 1)).load();
        let nibble = if self.nibble_index & 1 == 0 {
            nibbles
        } else {
            nibbles >> 4
        };
        self.nibble_index += 1;
        self.nibbles_left -= 1;
        nibble & 0xf
    }
}

/// All strings as nibbles, two in each byte, the first of each pair in the lower half.
struct PackedStrings {
    nibbles: [u8; BUFFER_BYTES],
    nibble_count: usize,
    /// The length of each string, nibbles.
    lengths: [u8; STRING_COUNT],
    /// The index of each block's first nibble.
    block_starts: [u16; STRING_COUNT.div_ceil(STRINGS_PER_BLOCK)],
}

/// The size of the buffer at compile time, which is more than the strings need.
const BUFFER_BYTES: usize = 4096;

impl PackedStrings {
    const fn push_nibble(&mut self, nibble: u8) {
        self.nibbles[self.nibble_count / 2] |= nibble << (4 * (self.nibble_count & 1));
        self.nibble_count += 1;
    }

    /// Appends the code of a character or of a phrase. The codes of phrases follow those of all characters.
    const fn push_code(&mut self, code: usize) {
        assert!(code < SHORT_CODE_COUNT as usize + (16 - SHORT_CODE_COUNT as usize) * 16);
        let code = code as u8;
        if code < SHORT_CODE_COUNT {
            self.push_nibble(code);
        } else {
            self.push_nibble(SHORT_CODE_COUNT + (code - SHORT_CODE_COUNT) / 16);
            self.push_nibble((code - SHORT_CODE_COUNT) % 16);
        }
    }
}

/// Packs all strings at compile time: messages with codes for their phrases, and phrases character by character.
#[allow(long_running_const_eval, reason = "it takes a second at most")]
const fn pack_strings() -> PackedStrings {
    let mut packed = PackedStrings {
        nibbles: [0; BUFFER_BYTES],
        nibble_count: 0,
        lengths: [0; STRING_COUNT],
        block_starts: [0; _],
    };
    let mut string_index = 0;
    while string_index < STRING_COUNT {
        let start = packed.nibble_count;
        if string_index % STRINGS_PER_BLOCK == 0 {
            packed.block_starts[string_index / STRINGS_PER_BLOCK] = start as u16;
        }
        let is_phrase = string_index >= MESSAGE_COUNT;
        let text = if is_phrase {
            PHRASES[string_index - MESSAGE_COUNT].as_bytes()
        } else {
            MESSAGES[string_index].as_bytes()
        };
        let mut remaining_text = text;
        while let [first, after_first @ ..] = remaining_text {
            match find_phrase(remaining_text) {
                Some((phrase_index, after_phrase)) if !is_phrase => {
                    packed.push_code(ALPHABET.len() + phrase_index);
                    remaining_text = after_phrase;
                }
                _ => {
                    packed.push_code(character_code(*first));
                    remaining_text = after_first;
                }
            }
        }
        assert!(packed.nibble_count - start <= 255);
        packed.lengths[string_index] = (packed.nibble_count - start) as u8;
        string_index += 1;
    }
    packed
}

/// Finds the first phrase that a text begins with. Returns the phrase's index and the rest of the text; `None` if the
/// text begins with no phrase.
const fn find_phrase(text: &[u8]) -> Option<(usize, &[u8])> {
    let mut phrase_index = 0;
    while phrase_index < PHRASES.len() {
        let mut pattern = PHRASES[phrase_index].as_bytes();
        let mut remaining_text = text;
        while let ([expected_byte, pattern_rest @ ..], [byte, text_rest @ ..]) =
            (pattern, remaining_text)
            && *expected_byte == *byte
        {
            (pattern, remaining_text) = (pattern_rest, text_rest);
        }
        if pattern.is_empty() {
            return Some((phrase_index, remaining_text));
        }
        phrase_index += 1;
    }
    None
}

/// Returns the code of a character.
const fn character_code(character: u8) -> usize {
    let mut code = 0;
    while ALPHABET[code] != character {
        code += 1;
        assert!(code < ALPHABET.len(), "ALPHABET lacks a character");
    }
    code
}

#[cfg(test)]
mod tests {
    use std::string::String;

    use super::*;

    #[test]
    fn a_message_is_printed_completely_and_its_length_is_right() {
        for (text, expected) in [
            (Text::Banner, "# lizard "),
            (Text::Version, env!("CARGO_PKG_VERSION")),
            (
                Text::UnknownCommand,
                "unknown command, send help for the list",
            ),
            (Text::Resting, "servos are resting, send stand first"),
        ] {
            let mut printed_text = String::new();
            text.print(&mut printed_text);
            assert_eq!(printed_text, expected);
            assert_eq!(usize::from(text.length()), expected.len());
        }
    }

    #[test]
    fn every_message_is_one_line_without_control_characters() {
        for message in MESSAGES {
            assert!(
                message
                    .bytes()
                    .all(|byte| byte == b' ' || byte.is_ascii_graphic())
            );
        }
    }
}
