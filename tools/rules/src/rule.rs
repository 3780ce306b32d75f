//! The rules that the robot must keep, each with a sentence for the user.

use std::fmt;

macro_rules! rules {
    ($($name:ident = $sentence:literal;)*) => {
        /// A rule that the robot must keep.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Rule { $(#[doc = $sentence] $name),* }

        impl Rule {
            /// All rules.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// The rule as a sentence.
            pub const fn sentence(self) -> &'static str {
                match self { $(Self::$name => $sentence),* }
            }
        }
    };
}

rules! {
    KeepsRunning = "the program neither crashes nor halts, and uses the board as the board allows";
    OneAnswer = "every line gets exactly one answer";
    AnswersAlways = "the console always answers again";
    PulsesPermitted = "pulses begin only by an order, by boot three seconds after a start, or at power-on";
    WakeOneByOne = "no two servos begin in one frame, except after a hang";
    HeldAfterHang = "after a hang the servos are held where they were";
    ResetAfterHang = "a hang that ends the pulses ends in a reset";
    NoNeedlessReset = "a hang that does not end the pulses causes no reset";
    MotionHasPulses = "a robot without pulses never answers that it moves";
    StatusNamesCause = "status says rest or a fault where there are no pulses";
    NoPulsesInRest = "status says rest only where there are no pulses";
    RestEndsPulses = "rest ends the pulses within a frame";
    StandWorks = "after stand the robot stands, in any earlier state";
    RefusalChangesNothing = "a refused command changes nothing";
    InvalidRefused = "a line that is not a valid command is refused";
    OtherRateIgnored = "a line at another rate than the robot's does nothing";
    RateFound = "a robot that is asked again and again at one rate answers";
    NoNeedlessRefusal = "no command is refused for a supply that allows it";
    LoadedLimitsValid = "load accepts only settings that limit would accept";
    DeadmanNotEarly = "a gait ends without a command only if no line came for the time of deadman";
    DeadmanNotLate = "a gait goes on for no longer than deadman and 40 ms without a command";
    OnlySentLines = "no line is acted on that nobody sent";
    StopRepeated = "a stop that a link has lost is sent again until it is answered";
    CountedMotionEnds = "a motion with a count comes to an end";
    ContactsOnlyInRoutine = "a contact moves the robot only within a routine";
    DoneOncePerMotion = "no motion is said to be done more often than motions were begun";
    SecondRestWritesNothing = "rest, said again, writes nothing";
    PulseWidth = "no pulse is cut short or too long";
    SlewLimit = "no pulse is farther from the one before than the slew limit";
    PulsePeriod = "whatever arrives on the line, pulses begin 20 ms apart to the cycle";
    NoLeapByReset = "no reset of a held robot makes a servo leap";
    WakesInRestPose = "a robot that has rested wakes in the pose of its rest, whatever reset it";
    RestPoseKept = "where the robot rests stays in the memory, also after a reset";
    StopReported = "what stopped the robot is in status and on the console until it is told to move";
    GuardFaultNamed = "status names a fault wherever the guard holds";
    LedShowsFault = "the LED shows the fault that status tells";
    BrownOutsEnd = "brown-outs in a row come to an end";
    LowForSixFrames = "the supply stops or rests the robot only by six frames below its voltage";
    SafeWrites = "the EEPROM is written only above its voltage and after the first reading";
    PosesGuarded = "every pose that is sent has passed the guard";
    MemoryWhole = "the memory holds whole records or nothing, and only what was saved";
}

/// A broken rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrokenRule {
    /// The rule.
    pub rule: Rule,
    /// A description of the observation that breaks the rule.
    pub observation: String,
}

impl BrokenRule {
    /// Creates a broken rule from the rule and the observation that breaks the rule.
    pub fn new(rule: Rule, observation: impl Into<String>) -> Self {
        let observation = observation.into();
        Self { rule, observation }
    }
}

impl fmt::Display for BrokenRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.rule.sentence(), self.observation)
    }
}
