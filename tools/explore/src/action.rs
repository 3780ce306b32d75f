//! Commands and faults that the search applies, and their names in reports.

use std::fmt;

use lizard_core::console::word::Word;
use lizard_core::memory::restart::Cause;
use lizard_core::numbers::rate::BaudRate;

use crate::small::{BUTTON, NOSE};

/// An event that the search applies to the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// A line is sent and executed; its output and its writes to the memory are still pending.
    Say(&'static str),
    /// A line arrives in which noise has changed a byte.
    Noise,
    /// Lines are sent at this rate from now on.
    SendAt(BaudRate),
    /// Main performs its most urgent task.
    Step,
    /// Frames pass.
    Frames(u8),
    /// Main does nothing for this many milliseconds.
    Stall(u16),
    /// The supply falls or rises to this many millivolts.
    Supply(u16),
    /// If true, the supply is weak from now on: when three servos have woken, they pull it down to
    /// 2.4 V. If false, the supply is strong again.
    Weak(bool),
    /// A pulse's edge comes late.
    Late,
    /// The stack grows into the data.
    Stack,
    /// The processor is reset.
    Reset(Cause),
    /// Power is lost and comes back. The byte that was being written then has this value; `None` if no byte is
    /// torn.
    LosePower(Option<u8>),
    /// If true, the contact at this pin closes; if false, it opens.
    Contact(u8, bool),
    /// If true, nobody reads the robot's output from now on; if false, somebody reads it again.
    StopReading(bool),
}

/// Lines that are tried. Each command word that begins none of these lines is tried with its example.
const LINES: [&str; 30] = [
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
    "cal",
    "garbage",
];

impl Action {
    /// Returns every action, even if the current state does not permit it.
    pub fn all() -> Vec<Self> {
        let mut actions = vec![
            Self::Frames(1),
            Self::Frames(5),
            Self::Frames(25),
            Self::Frames(160),
            Self::Step,
            Self::Noise,
        ];
        let is_tried = |word: &&Word| {
            let mut first_words = LINES.iter().filter_map(|line| line.split(' ').next());
            first_words.any(|first_word| first_word == word.text())
        };
        let other_words = Word::ALL.iter().filter(|word| !is_tried(word));
        actions.extend(LINES.map(Self::Say));
        actions.extend(BaudRate::ALL.map(Self::SendAt));
        actions.extend(other_words.map(|word| Self::Say(word.example())));
        // The last hand-over of a frame was 16 ms ago. In these times main misses no hand-over, one, three or
        // five; or the watchdog ends the pulses; or the watchdog resets the chip.
        actions.extend([3, 15, 60, 100, 120, 130, 200, 229, 240].map(Self::Stall));
        actions.extend([5_000, 4_100, 3_900, 3_500].map(Self::Supply));
        actions.extend([Self::Weak(true), Self::Weak(false)]);
        actions.extend([Self::Late, Self::Stack]);
        actions.extend([Cause::External, Cause::BrownOut].map(Self::Reset));
        actions.extend([None, Some(0x00), Some(0x5a), Some(0xff)].map(Self::LosePower));
        actions.extend([BUTTON, NOSE].map(|pin| Self::Contact(pin, true)));
        actions.extend([BUTTON, NOSE].map(|pin| Self::Contact(pin, false)));
        actions.extend([Self::StopReading(true), Self::StopReading(false)]);
        actions
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Say(line) => write!(f, "say `{line}`"),
            Self::Step => f.write_str("one step of main"),
            Self::SendAt(rate) => write!(f, "lines come at {} baud from now on", rate.baud()),
            Self::Noise => f.write_str("noise within `walk`"),
            Self::Frames(1) => f.write_str("a frame"),
            Self::Frames(count) => write!(f, "{count} frames"),
            Self::Stall(ms) => write!(f, "main does nothing for {ms} ms"),
            Self::Supply(mv) => write!(f, "the supply is at {mv} mV"),
            Self::Weak(true) => f.write_str("the supply becomes too weak for three servos"),
            Self::Weak(false) => f.write_str("the supply bears four servos again"),
            Self::Late => f.write_str("a frame in which an edge comes late"),
            Self::Stack => f.write_str("a frame in which the stack reaches the data"),
            Self::Reset(cause) => write!(f, "reset: {cause:?}"),
            Self::LosePower(None) => f.write_str("power is lost and comes back"),
            Self::LosePower(Some(byte)) => {
                write!(f, "power is lost in a write, the byte is {byte:#04x}")
            }
            Self::Contact(pin, is_closed) => {
                let contact = if *pin == BUTTON { "button" } else { "nose" };
                write!(
                    f,
                    "the {contact} {}",
                    if *is_closed { "closes" } else { "opens" }
                )
            }
            Self::StopReading(true) => f.write_str("nobody listens any more"),
            Self::StopReading(false) => f.write_str("somebody listens again"),
        }
    }
}
