//! Every rule, in the words of a user.

use std::fmt;

macro_rules! rules {
    ($($name:ident = $sentence:literal;)*) => {
        /// A promise of the robot.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Rule { $(#[doc = $sentence] $name),* }

        impl Rule {
            /// All rules.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// The promise as a sentence.
            #[must_use]
            pub const fn sentence(self) -> &'static str {
                match self { $(Self::$name => $sentence),* }
            }
        }
    };
}

rules! {
    Lives = "the program neither crashes nor halts, and uses the board as the board allows";
    OneAnswer = "every line gets exactly one answer";
    Answered = "the console is never mute for ever";
    Begins = "pulses begin only by an order, by boot three seconds after a start, or at power-on";
    OneByOne = "servos never begin in one frame, but for those that a hang interrupted";
    Held = "after a hang the servos are held where they were";
    Silence = "a hang that ends the pulses ends in a reset";
    NeedlessReset = "a hang without which the pulses go on ends in no reset";
    Moves = "a robot without pulses never answers that it moves";
    StatusSaysWhy = "status says rest or a fault where there are no pulses";
    RestIsRest = "status says rest only where there are no pulses";
    RestEnds = "rest ends the pulses within a frame";
    Stands = "after stand the robot stands, whatever came before";
    Refused = "a refused command changes nothing";
    Wrong = "what is no command, or no good one, is refused";
    Allowed = "what the supply allows is not refused for its sake";
    Load = "what load takes, limit would have taken";
    Deadman = "a gait ends for want of a line only if none came for as long as deadman says";
    RestAgain = "rest, said again, writes nothing";
    Travel = "no pulse is cut short or too long";
    Leap = "no pulse is farther from the one before than the slew limit";
    LeapByReset = "no reset of a held robot makes a servo leap";
    RestPose = "a robot that has rested wakes in the pose of its rest, whatever reset it";
    RestKept = "where the robot rests stays in the memory, also after a reset";
    Told = "what stopped the robot is in status and on the console until it is told to move";
    GuardNamed = "status names a fault wherever the guard holds";
    Led = "the LED shows the fault that status tells";
    BrownOuts = "brown-outs in a row come to an end";
    Supply = "the supply stops or rests the robot only by six frames below its voltage";
    Written = "the EEPROM is written only above its voltage and after the first reading";
    Guarded = "every pose that is sent has passed the guard";
    Memory = "the memory holds whole records or nothing, and only what was saved";
}

/// A broken rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Broken {
    /// The rule.
    pub rule: Rule,
    /// The observation that breaks it.
    pub seen: String,
}

impl Broken {
    /// A rule broken by an observation.
    pub fn new(rule: Rule, seen: impl Into<String>) -> Self {
        let seen = seen.into();
        Self { rule, seen }
    }
}

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.rule.sentence(), self.seen)
    }
}
