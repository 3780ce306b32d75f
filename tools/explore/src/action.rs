//! Actions that may happen to a robot, in the words of a person.

use std::fmt;

use lizard_core::console::word::Word;
use lizard_core::memory::restart::Cause;

/// An action: something that happens to the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// A line is sent and executed; its output and its writes to the memory are still to do.
    Say(&'static str),
    /// A line comes in which noise has changed a byte.
    Noise,
    /// Main does its most urgent task.
    Step,
    /// Frames pass.
    Frames(u8),
    /// Main does nothing for this many milliseconds.
    Stall(u16),
    /// The supply falls or rises to this many millivolts.
    Supply(u16),
    /// From now on three servos that wake pull the supply down to 2.4 V if true, or no longer.
    Weak(bool),
    /// A pulse's edge comes late.
    Late,
    /// The stack grows into the data.
    Stack,
    /// The processor is reset.
    Reset(Cause),
    /// Power is lost and comes back; a byte that was being written holds this.
    LosePower(Option<u8>),
    /// The listener stops reading the output if true, or reads it again.
    Deaf(bool),
}

/// Lines that are tried, beside an example of each other word.
const LINES: [&str; 24] = [
    "stand",
    "walk",
    "trot",
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
    "boot rest",
    "deadman 100",
    "deadman 20",
    "deadman 0",
    "status",
    "cal",
    "garbage",
];

impl Action {
    /// Every action, whatever the state.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut all = vec![
            Self::Frames(1),
            Self::Frames(5),
            Self::Frames(25),
            Self::Frames(160),
            Self::Step,
            Self::Noise,
        ];
        let is_tried = |word: &&Word| {
            let mut words = LINES.iter().filter_map(|line| line.split(' ').next());
            words.any(|tried| tried == word.text())
        };
        let others = Word::ALL.iter().filter(|word| !is_tried(word));
        all.extend(LINES.map(Self::Say));
        all.extend(others.map(|word| Self::Say(word.example())));
        // After the frame before, whose hand-over was 16 ms ago: main is late for
        // nothing, for a hand-over, for three, for five; it is interrupted by the
        // watchdog and continues; it is reset.
        all.extend([3, 15, 60, 100, 120, 130, 200, 229, 240].map(Self::Stall));
        all.extend([5_000, 4_100, 3_900, 3_500].map(Self::Supply));
        all.extend([Self::Weak(true), Self::Weak(false)]);
        all.extend([Self::Late, Self::Stack]);
        all.extend([Cause::External, Cause::BrownOut].map(Self::Reset));
        all.extend([None, Some(0x00), Some(0x5a), Some(0xff)].map(Self::LosePower));
        all.extend([Self::Deaf(true), Self::Deaf(false)]);
        all
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Say(line) => write!(f, "say `{line}`"),
            Self::Step => f.write_str("one step of main"),
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
            Self::Deaf(true) => f.write_str("nobody listens any more"),
            Self::Deaf(false) => f.write_str("somebody listens again"),
        }
    }
}
