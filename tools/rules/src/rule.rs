//! All rules that the robot must keep, as sentences for a user.

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
            pub const fn sentence(self) -> &'static str {
                match self { $(Self::$name => $sentence),* }
            }
        }
    };
}

rules! {
    Lives = "the program neither crashes nor halts, and uses the board as the board allows";
    OneAnswer = "every line gets exactly one answer";
    Answered = "the console always answers again";
    Begins = "pulses begin only by an order, by boot three seconds after a start, or at power-on";
    OneByOne = "no two servos begin in one frame, except after a hang";
    Held = "after a hang the servos are held where they were";
    Silence = "a hang that ends the pulses ends in a reset";
    NeedlessReset = "a hang that does not end the pulses causes no reset";
    Moves = "a robot without pulses never answers that it moves";
    StatusSaysWhy = "status says rest or a fault where there are no pulses";
    RestIsRest = "status says rest only where there are no pulses";
    RestEnds = "rest ends the pulses within a frame";
    Stands = "after stand the robot stands, in any earlier state";
    Refused = "a refused command changes nothing";
    Wrong = "a line that is not a valid command is refused";
    OtherRate = "a line at another rate than the robot's does nothing";
    Found = "a robot that is asked again and again at one rate answers";
    Allowed = "no command is refused for a supply that allows it";
    Load = "load accepts only settings that limit would accept";
    Deadman = "a gait ends without a command only if no line came for the time of deadman";
    Silenced = "a gait goes on for no longer than deadman and 40 ms without a command";
    Sent = "no line is acted on that nobody sent";
    Stopped = "a stop that a link has lost is sent again until it is answered";
    Ends = "a motion with a count comes to an end";
    Contacts = "a contact moves the robot only within a routine";
    Done = "no motion is said to be done more often than motions were begun";
    RestAgain = "rest, said again, writes nothing";
    Travel = "no pulse is cut short or too long";
    Leap = "no pulse is farther from the one before than the slew limit";
    OnTime = "whatever arrives on the line, pulses begin 20 ms apart to the cycle";
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
pub struct BrokenRule {
    /// The rule that is broken.
    pub rule: Rule,
    /// The observation that breaks it.
    pub seen: String,
}

impl BrokenRule {
    /// Makes a broken rule from the observation that breaks it.
    pub fn new(rule: Rule, seen: impl Into<String>) -> Self {
        let seen = seen.into();
        Self { rule, seen }
    }
}

impl fmt::Display for BrokenRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.rule.sentence(), self.seen)
    }
}
