//! The rules that the robot must obey, each as a sentence for the user.

use std::fmt;

macro_rules! rules {
    ($($name:ident = $sentence:literal;)*) => {
        /// A rule that the robot must obey.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Rule { $(#[doc = $sentence] $name),* }

        impl Rule {
            /// All rules, in the order of this list.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// Returns the rule as a sentence.
            pub const fn sentence(self) -> &'static str {
                match self { $(Self::$name => $sentence),* }
            }
        }
    };
}

rules! {
    KeepsRunning = "the program neither crashes nor halts, and uses the chip only as its data sheet allows";
    OneAnswer = "every line gets exactly one answer";
    AnswersAgain = "the console answers again after every disturbance";
    PulsesPermitted = "pulses begin only on a command, by the boot setting three seconds after a start, or at power-on";
    WakeOneByOne = "no two servos wake in the same frame, except after a hang";
    HeldAfterHang = "after a hang the servos hold their positions";
    ResetAfterHang = "a hang that ends the pulses ends in a reset";
    NoNeedlessReset = "a hang that does not end the pulses causes no reset";
    MotionHasPulses = "a robot without pulses never answers that it moves";
    StatusNamesCause = "status says rest or a fault when there are no pulses";
    NoPulsesInRest = "status says rest only when there are no pulses";
    RestEndsPulses = "rest ends the pulses within a frame";
    StandWorks = "after stand the robot stands, whatever its previous state";
    MotionBegins = "an accepted motion is carried out, unless a new fault stops it";
    RefusalChangesNothing = "a refused command changes nothing";
    InvalidRefused = "a line that is not a valid command is refused";
    OtherRateIgnored = "a line sent at another baud rate than the robot's has no effect";
    RateFound = "a robot that is queried repeatedly at one baud rate eventually answers";
    NoNeedlessRefusal = "no command is refused because of the supply while the supply is sufficient";
    LoadedLimitsValid = "load accepts only settings that limit would accept";
    DeadmanNotEarly = "a gait ends without a command only if no line arrived for the time of deadman";
    DeadmanNotLate = "without a command a gait ends at most 40 ms after the time of deadman";
    OnlySentLines = "the robot acts only on lines that were sent";
    StopRepeated = "a stop that is lost on the link is sent again until it is answered";
    CountedMotionEnds = "a motion with a count comes to an end";
    ContactsOnlyInRoutine = "a contact moves the robot only during a routine";
    DoneOncePerMotion = "no more motions are reported done than have begun";
    SecondRestWritesNothing = "a repeated rest writes nothing to the EEPROM";
    PulseWidth = "no pulse is too short or too long";
    SlewLimit = "no pulse width differs from the previous one by more than the slew limit";
    PulsePeriod = "whatever arrives on the serial line, pulses begin 20 ms apart, to the cycle";
    NoStepByReset = "no reset of a robot with pulses makes a servo jump";
    WakesInRestPose = "a robot that has rested wakes in its rest pose, whatever reset it";
    RestPoseKept = "the rest pose stays in the EEPROM, even across a reset";
    StopReported = "status and the console name the cause of a stop until the next motion command";
    NoBootAfterStop = "boot moves no robot that a fault or the guard has stopped since the start";
    GuardFaultNamed = "status names a fault whenever the guard holds the robot";
    LedShowsFault = "the LED shows the fault that status reports";
    BrownOutsEnd = "a series of brown-outs comes to an end";
    LowForSixFrames = "a low supply stops or rests the robot only after six frames below the threshold";
    SafeWrites = "the EEPROM is written only after the supply was measured and while it is above the writing threshold";
    PosesGuarded = "every pose that is sent has passed the guard";
    MemoryValid = "the EEPROM holds valid records or nothing, and only what was saved";
}

/// A violation of a rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The violated rule.
    pub rule: Rule,
    /// A description of the observation that violates the rule.
    pub observation: String,
}

impl Violation {
    /// Creates a violation from the rule and the observation.
    pub fn new(rule: Rule, observation: impl Into<String>) -> Self {
        let observation = observation.into();
        Self { rule, observation }
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.rule.sentence(), self.observation)
    }
}
