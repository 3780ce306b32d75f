//! Commands and faults that the search applies, and their descriptions in reports. Main is the core's main loop.

use std::fmt;

use lizard_core::console::word::Word;
use lizard_core::memory::restart::Cause;
use lizard_core::numbers::rate::BaudRate;

use crate::small_robot::{BUTTON_PIN, NOSE_PIN};

/// An event that the search applies to the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// A line is sent, and main executes it. The line's output and EEPROM writes are still pending.
    Line(&'static str),
    /// A line arrives in which noise has changed one byte.
    GarbledLine,
    /// Lines are sent at this baud rate from now on.
    SenderRate(BaudRate),
    /// Main performs one step, its most urgent task.
    MainStep,
    /// This many frames pass.
    Frames(u8),
    /// Main does nothing for this many milliseconds.
    Stall(u16),
    /// The supply falls or rises to this many millivolts.
    SupplyMv(u16),
    /// The supply becomes weak (true), so that three awake servos cause a brown-out, or becomes strong again (false).
    WeakSupply(bool),
    /// A frame passes in which an edge of a pulse is late.
    LateEdge,
    /// A frame passes in which the stack grows into the data.
    StackOverflow,
    /// The processor is reset.
    Reset(Cause),
    /// Power is lost and comes back. A byte that the EEPROM was writing then has this value; `None` if no byte is torn.
    PowerLoss(Option<u8>),
    /// The contact at this pin closes (true) or opens (false).
    Contact(u8, bool),
    /// The host stops reading the robot's output (true) or reads it again (false).
    HeldOutput(bool),
}

/// The lines that the search sends. For each command word that begins none of these lines, the search also sends the
/// word's example.
const LINES: [&str; 31] = [
    "stand",
    "walk",
    "trot",
    "walk 1",
    "trot 2",
    "round",
    "round 1",
    "patrol",
    "stray",
    "stop",
    "rest",
    "pose 155 41.41 318.59 221.41",
    "pose 138.59 170 318.59 221.41",
    "speed 50",
    "trim 1 8",
    "dir 2 -",
    "scale 3 12",
    "limit 4 200 240",
    "save",
    "load",
    "factory",
    "boot walk",
    "boot round",
    "boot rest",
    "deadman 100",
    "deadman 20",
    "deadman 0",
    "status",
    "watch 1",
    "cal",
    "nonsense",
];

impl Action {
    /// Returns all actions, including those that are not possible in every state.
    pub fn all() -> Vec<Self> {
        let mut actions = vec![
            Self::Frames(1),
            Self::Frames(5),
            Self::Frames(25),
            Self::Frames(160),
            Self::MainStep,
            Self::GarbledLine,
        ];
        let begins_line = |word: &&Word| {
            let mut first_words = LINES.iter().filter_map(|line| line.split(' ').next());
            first_words.any(|first_word| first_word == word.spelling())
        };
        let other_words = Word::ALL.iter().filter(|word| !begins_line(word));
        actions.extend(LINES.map(Self::Line));
        actions.extend(BaudRate::ALL.map(Self::SenderRate));
        actions.extend(other_words.map(|word| Self::Line(word.example())));
        // At the end of a frame, 19 ms have passed since main handed the frame to the board. During these stalls, main
        // misses zero, one, three or five frames, or the watchdog ends the pulses, or it resets the processor.
        actions.extend([3, 15, 60, 100, 120, 130, 200, 229, 240].map(Self::Stall));
        actions.extend([5_000, 4_100, 3_900, 3_500].map(Self::SupplyMv));
        actions.extend([Self::WeakSupply(true), Self::WeakSupply(false)]);
        actions.extend([Self::LateEdge, Self::StackOverflow]);
        actions.extend([Cause::External, Cause::BrownOut].map(Self::Reset));
        actions.extend([None, Some(0x00), Some(0x5a), Some(0xff)].map(Self::PowerLoss));
        actions.extend([BUTTON_PIN, NOSE_PIN].map(|pin| Self::Contact(pin, true)));
        actions.extend([BUTTON_PIN, NOSE_PIN].map(|pin| Self::Contact(pin, false)));
        actions.extend([Self::HeldOutput(true), Self::HeldOutput(false)]);
        actions
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "send `{line}`"),
            Self::MainStep => f.write_str("main performs one step"),
            Self::SenderRate(rate) => write!(f, "the sender changes to {} baud", rate.baud()),
            Self::GarbledLine => f.write_str("noise changes a byte of `walk`"),
            Self::Frames(1) => f.write_str("a frame passes"),
            Self::Frames(count) => write!(f, "{count} frames pass"),
            Self::Stall(ms) => write!(f, "main does nothing for {ms} ms"),
            Self::SupplyMv(mv) => write!(f, "the supply changes to {mv} mV"),
            Self::WeakSupply(true) => f.write_str("the supply becomes too weak for three servos"),
            Self::WeakSupply(false) => f.write_str("the supply can power four servos again"),
            Self::LateEdge => f.write_str("a frame passes in which an edge is late"),
            Self::StackOverflow => {
                f.write_str("a frame passes in which the stack reaches the data")
            }
            Self::Reset(cause) => write!(f, "reset: {cause:?}"),
            Self::PowerLoss(None) => f.write_str("power is lost and comes back"),
            Self::PowerLoss(Some(byte)) => {
                f.write_str("power is lost during a write, ")?;
                write!(f, "the byte becomes {byte:#04x}")
            }
            Self::Contact(pin, is_closed) => {
                let contact = if *pin == BUTTON_PIN { "button" } else { "nose" };
                let change = if *is_closed { "closes" } else { "opens" };
                write!(f, "the {contact} {change}")
            }
            Self::HeldOutput(true) => f.write_str("no host reads the output"),
            Self::HeldOutput(false) => f.write_str("a host reads the output again"),
        }
    }
}
