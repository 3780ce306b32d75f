//! The texts that the robot prints, packed in flash.
//!
//! An AVR program copies its string literals to its 2 KiB of RAM when it starts. The texts here stay in flash and are
//! packed: a frequent character has a four-bit code; any other character has an eight-bit code, and so has a phrase
//! that several texts share. A text is unpacked while it is printed.

use lizard_avr::flash;

use crate::console::output::Output;

macro_rules! texts {
    ($($name:ident = $text:expr;)*) => {
        /// A text that the robot prints: a message or a part of one.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        #[allow(missing_docs, reason = "each variant is named after its text")]
        pub enum Text { $($name),* }

        const TEXTS: &[&str] = &[$($text),*];
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
    PoseField = " pose=";
    Held = "# held in the last safe pose: ";
    InfoPrefix = "# ";
    Space = " ";
    Empty = "";
    CalTrim = " trim ";
    CalLimit = " limit ";
    CalDir = " dir ";
    CalScale = " scale ";
    CalBoot = "# boot ";
    CalDeadman = "# deadman ";

    // Notices: unsolicited lines.
    CalibrationBlank = "# calibration: none saved, using robot.toml's";
    CalibrationOneCopy = "# calibration: one of two copies is damaged, using the other";
    CalibrationDamaged = "# calibration: damaged, using robot.toml's";
    CalibrationForeign = "# calibration: for other servos, using robot.toml's";
    CalibrationUnfit = "# calibration: incompatible with the gaits, using robot.toml's";
    RestPoseNotSaved = "# memory: could not save the rest pose";
    NoticeFault = "# fault: ";
    NoticeSupply = "# supply: ";
    NoticeBoot = "# boot: ";
    NoticeDone = "# done";
    NoticeWaiting = "# waiting for ";
    Button = "button";
    Nose = "nose";
    FaultNoticeGuard = "the next pose is unsafe, stopped";
    FaultNoticeSupply = "the supply is too low to move";
    FaultNoticeLink = "no command within the deadman time, stopped";
    FaultNoticeWatchdog = "the program hung and was restarted";
    FaultNoticeLate = "a pulse was late, stopped";
    FaultNoticeBrownOut = "reset several times in a row by the button or a weak supply, resting";
    FaultNoticeRobot = "no robot in the flash; write one";
    FaultNoticeRobotFormat = "the robot in the flash is for another version; write it again";
    FaultNoticeRobotDamaged = "the robot in the flash is damaged; write it again";
    FaultNoticeStack = "the stack has grown into the data, stopped";
    LevelGood = ", good";
    LevelSlow = ", low: no saving, speed at most ";
    LevelStop = ", too low to move: stopped";
    LevelRest = ", too low to hold: pulses off";

    // Help, one line each.
    HelpGaits = "# gaits:";
    HelpCommands = "# others: ";
    HelpUsage = "# send a command alone for its usage; the docs explain it";

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

    // The reasons of errors and refusals.
    UnknownCommand = "unknown command; send help for the list";
    Garbled = "the line was garbled; send it again";
    UnexpectedArgument = "this command takes no argument";
    IncompleteName = "this command needs another word";
    CountUsage = "a gait takes a count, 1..999";
    SpeedUsage = "speed takes a whole number, 10..100";
    SpeedRange = "speed must be 10..100";
    WatchUsage = "watch takes a whole number, 0..10000";
    WatchRange = "watch must be 0..10000";
    PoseUsage = "pose takes four angles in degrees, with at most two decimals";
    MustBe = " must be ";
    Type2MarginHead = "type-2 margin of the head";
    Type2MarginTail = "type-2 margin of the tail";
    Type1Margin = "type-1 margin of ";
    LegMargin = "leg margin of ";
    MarginIs = " is ";
    MarginIsBelow = " is below 0.1";
    MarginLimit = ", must be at least ";
    Left = "left";
    Right = "right";
    SliderPosition = " slider is at ";
    StrokeRange = " mm, must be ";
    RangeSeparator = "..";
    TooLong = "a line has at most 63 characters";
    Resting = "the servos are resting; send stand first";
    TrimUsage = "trim takes a servo 1..4 and degrees, with at most two decimals";
    TrimRange = "trim must be -20..20";
    LimitUsage = "limit takes a servo 1..4 and two angles in degrees, with at most two decimals";
    LimitRange = "limit angles must be -360..360";
    DirUsage = "dir takes a servo 1..4 and + or -";
    ScaleUsage = "scale takes a servo 1..4 and us per degree, with at most two decimals";
    ScaleRange = "scale must be 5..20";
    BootUsage = "boot takes a gait, a routine or rest";
    DeadmanUsage = "deadman takes a whole number of milliseconds, 0..60000";
    DeadmanRange = "deadman must be 0..60000";
    TooNarrowForGaits = "'s travel must cover the gaits' range, ";
    TooNarrowForPose = "'s travel must cover its current and target angles; send stand first";
    SupplyTooLow = "the supply is too low";
    WriteFailed = "the memory write failed";
    NoRobot = "no robot in the flash";
    NothingSaved = "no saved calibration to load";
}

/// The phrases that occur in several texts, each stored once. The longest come first, because the first match is used.
const PHRASES: &[&str] = &[
    ", with at most two decimals",
    " takes a servo 1..4 and ",
    "'s travel must cover ",
    " takes a whole number",
    ", using robot.toml's",
    " angles in degrees",
    "# calibration: ",
    "in the flash",
    "stand first",
    " margin of ",
    ", stopped",
    "must be ",
    "; send ",
    "command",
    "deadman",
    "0..100",
    " takes",
    "supply",
    "watch",
    "speed",
    "type-",
    "robot",
    "gait",
    " is ",
    "the ",
    "for ",
    ", ",
    "# ",
    "he",
];

/// The characters of all texts, the most frequent first.
const ALPHABET: &[u8; 45] = b" etoasrnildmgwpu0c.hfb=v:k12y6;-,x3'9#z_+5478";

/// The number of characters with a four-bit code; the remaining four-bit values begin eight-bit codes.
const SHORT_CODE_COUNT: u8 = 12;

const TEXT_COUNT: usize = TEXTS.len();

/// The number of packed strings, which are the texts followed by the phrases.
const STRING_COUNT: usize = TEXT_COUNT + PHRASES.len();

/// The number of strings in a block. For each block its start is stored, for each string its length.
const STRINGS_PER_BLOCK: usize = 16;

const PACKED_STRINGS: PackedStrings = pack_strings();

flash! {
    /// The nibbles of all strings, two per byte.
    const NIBBLES: [u8; PACKED_STRINGS.nibble_count.div_ceil(2)] = *PACKED_STRINGS.nibbles.first_chunk().unwrap();
    /// The length of each string, nibbles.
    const STRING_LENGTHS: [u8; STRING_COUNT] = PACKED_STRINGS.lengths;
    /// The index of each block's first nibble.
    const BLOCK_STARTS: [u16; STRING_COUNT.div_ceil(STRINGS_PER_BLOCK)] = PACKED_STRINGS.block_starts;
    /// The characters, indexed by their code.
    const CHARACTERS: [u8; ALPHABET.len()] = *ALPHABET;
}

impl Text {
    /// Prints the text.
    #[inline(never)]
    pub fn print(self, out: &mut impl Output) {
        let mut current_string = PackedString::at(self as u8);
        // The part of the text after the phrase that is being printed.
        let mut text_rest = PackedString::EMPTY;
        loop {
            if current_string.nibbles_left == 0 {
                current_string = text_rest;
                text_rest.nibbles_left = 0;
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
                    text_rest = current_string;
                    current_string = PackedString::at(TEXT_COUNT as u8 + phrase_index);
                }
            }
        }
    }

    /// The length of the text in bytes.
    pub const fn length(self) -> u8 {
        TEXTS[self as usize].len() as u8
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

    /// Returns the packed string with this index; none of its nibbles has been read.
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

/// All strings as nibbles, two per byte, the first of each pair in the lower half.
struct PackedStrings {
    nibbles: [u8; BUFFER_BYTES],
    nibble_count: usize,
    /// The length of each string, nibbles.
    lengths: [u8; STRING_COUNT],
    /// The index of each block's first nibble.
    block_starts: [u16; STRING_COUNT.div_ceil(STRINGS_PER_BLOCK)],
}

/// The size of the compile-time buffer, which is larger than all strings together.
const BUFFER_BYTES: usize = 4096;

impl PackedStrings {
    const fn push_nibble(&mut self, nibble: u8) {
        self.nibbles[self.nibble_count / 2] |= nibble << (4 * (self.nibble_count & 1));
        self.nibble_count += 1;
    }

    /// Appends the code of a character or a phrase. The codes of the phrases follow those of the characters.
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

/// Packs all strings at compile time: texts with codes for their phrases, and phrases character by character.
#[allow(long_running_const_eval, reason = "packing takes at most a second")]
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
        let is_phrase = string_index >= TEXT_COUNT;
        let text = if is_phrase {
            PHRASES[string_index - TEXT_COUNT].as_bytes()
        } else {
            TEXTS[string_index].as_bytes()
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

/// Finds the first phrase with which a text begins. Returns the index of the phrase and the rest of the text; `None` if
/// the text begins with no phrase.
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
        assert!(
            code < ALPHABET.len(),
            "ALPHABET must contain every character"
        );
    }
    code
}

#[cfg(test)]
mod tests {
    use std::string::String;

    use super::*;

    #[test]
    fn a_text_is_printed_completely_and_its_length_matches() {
        for (text, expected) in [
            (Text::Banner, "# lizard "),
            (Text::Version, env!("CARGO_PKG_VERSION")),
            (
                Text::UnknownCommand,
                "unknown command; send help for the list",
            ),
            (Text::Resting, "the servos are resting; send stand first"),
        ] {
            let mut printed_text = String::new();
            text.print(&mut printed_text);
            assert_eq!(printed_text, expected);
            assert_eq!(usize::from(text.length()), expected.len());
        }
    }

    #[test]
    fn every_text_is_one_line_without_control_characters() {
        for text in TEXTS {
            let is_printable = |byte: u8| byte == b' ' || byte.is_ascii_graphic();
            assert!(text.bytes().all(is_printable));
        }
    }
}
