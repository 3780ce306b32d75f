//! What can be wrong in robot.toml, each as the sentence that its author reads.

use std::fmt;

/// A fault in robot.toml: where it is and what it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Error {
    /// The file's name as it was given.
    pub file: String,
    /// Line of the key, from 1, where one is to blame.
    pub line: Option<usize>,
    /// The whole key, `servo.A1.pin`; empty for a fault of the whole file.
    pub key: String,
    /// The fault.
    pub problem: Problem,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if !self.key.is_empty() {
            write!(f, ": {}", self.key)?;
        }
        let link = if self.key.is_empty() || self.problem.is_clause() {
            ":"
        } else {
            ""
        };
        write!(f, "{link} {}", self.problem)
    }
}

impl std::error::Error for Error {}

/// A fault of one key, before the file and line are known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fault {
    pub key: String,
    pub problem: Problem,
}

/// A value, or the key that spoils it.
pub(crate) type Checked<T> = Result<T, Fault>;

impl Problem {
    /// True where the sentence has a subject of its own, false where the key
    /// is its subject.
    fn is_clause(&self) -> bool {
        matches!(
            self,
            Self::Neutral(_)
                | Self::Stand
                | Self::Circle(_)
                | Self::OutOfReach { .. }
                | Self::Unsafe { .. }
                | Self::TooNear { .. }
                | Self::Travel { .. }
                | Self::HalfTurn { .. }
                | Self::TooFast { .. }
                | Self::Coarse { .. }
        )
    }

    /// Blames `key`.
    pub(crate) fn at(self, key: impl Into<String>) -> Fault {
        Fault {
            key: key.into(),
            problem: self,
        }
    }
}

/// The kinds of fault. Gait faults come from the checks of every sample.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// The file cannot be opened.
    #[error("cannot be read: {0}")]
    Unreadable(String),
    /// The file is larger than any robot file.
    #[error("is longer than {mib} MiB, so it is no robot file")]
    Huge {
        /// What it may have, MiB.
        mib: u64,
    },
    /// The file is not UTF-8 text, from this line on.
    #[error("is not UTF-8 text: line {0} holds other bytes")]
    NotText(usize),
    /// The text is not TOML.
    #[error("{0}")]
    Syntax(String),
    /// A key that must be there is not.
    #[error("is missing; it must be {0}")]
    Missing(&'static str),
    /// A key that means nothing.
    #[error("is not a known key; {0}")]
    Unknown(Hint),
    /// A key of an earlier form of the file.
    #[error("is not read any more; write {0}")]
    Moved(&'static str),
    /// A value of the wrong type.
    #[error("is {found}; it must be {expected}")]
    Type {
        /// What the file holds.
        found: String,
        /// What it must hold.
        expected: &'static str,
    },
    /// A number outside what the robot or the fixed point allows.
    #[error("is {}; it must be within {min} to {max} {unit}", short(*value))]
    Range {
        /// The number found.
        value: f64,
        /// Smallest allowed.
        min: f64,
        /// Largest allowed.
        max: f64,
        /// Unit of all three.
        unit: &'static str,
    },
    /// Two lengths that the mechanism needs equal are not.
    #[error("is {value}, but {other} is {other_value}; {why}")]
    Unequal {
        /// Its own value.
        value: f64,
        /// The key that it must equal.
        other: &'static str,
        /// That key's value.
        other_value: f64,
        /// Why they must be equal.
        why: &'static str,
    },
    /// Hips in another place than the pivots and the foot put them.
    #[error(
        "is {value} mm, but parts.pivot and parts.foot put it at {follows:.2} mm; leave one of them out"
    )]
    OtherHip {
        /// Its own value, mm.
        value: f64,
        /// Where it follows to be, mm.
        follows: f64,
    },
    /// Hips that the pivots put where no leg can be.
    #[error(
        "is left out and follows from links, parts.pivot and parts.foot, which put it at {value:.2} mm; it must be within {min} to {max} mm"
    )]
    FarHip {
        /// Where it follows to be, mm.
        value: f64,
        /// Smallest allowed, mm.
        min: f64,
        /// Largest allowed, mm.
        max: f64,
    },
    /// A value that must stay below another.
    #[error("is {value}; it must be less than {other}, which is {other_value}")]
    NotLess {
        /// Its own value.
        value: f64,
        /// The key above it.
        other: &'static str,
        /// That key's value.
        other_value: f64,
    },
    /// A coupler that is short compared with the rest of its loop.
    #[error(
        "is {value} mm, which is short beside the rest of its loop; the firmware's 16-bit integers ask for at least {least:.1} mm, or for shorter cranks and a shorter base"
    )]
    ShortCoupler {
        /// Its value, mm.
        value: f64,
        /// The least, mm.
        least: f64,
    },
    /// More waveforms than a byte numbers.
    #[error(
        "needs one waveform too many: the firmware numbers them with a byte, so gaits may share {most}; those that differ only in amplitude, start, gain, period or direction share one"
    )]
    ManyWaves {
        /// How many there may be.
        most: usize,
    },
    /// A pin that is not one of the board's free digital pins.
    #[error(
        "is \"{0}\"; it must be one of D2 to D12 or A0 to A5 (D0 and D1 are the serial line, D13 is the LED)"
    )]
    Pin(String),
    /// A pin that measures no voltage.
    #[error("is \"{0}\"; it must be one of A0 to A5")]
    NotAnalogue(String),
    /// One pin for two servos.
    #[error("is \"{pin}\", which servo.{other} has already")]
    PinTwice {
        /// The pin.
        pin: String,
        /// The servo that took it first.
        other: &'static str,
    },
    /// A servo without gain cannot be aimed.
    #[error(
        "is {}; it must be within 1 to 22 us, or -22 to -1 where a longer pulse turns the horn clockwise",
        short(*.0)
    )]
    Gain(f64),
    /// The robot would refuse to stand.
    #[error("the neutral pose is not safe: {0}")]
    Neutral(String),
    /// A mass centre outside the feet.
    #[error(
        "is so far from the middle that foot {0} is in the air at neutral; all four must carry"
    )]
    InTheAir(&'static str),
    /// A name of the robot that the firmware cannot say.
    #[error("must be at most {most} lower-case letters, digits and dashes")]
    RobotName {
        /// How many characters it may have.
        most: usize,
    },
    /// More gaits than the board has room for.
    #[error(
        "the robot takes {over} bytes more than the {most} that the board has for it; {waves} waveforms take {of_waves}, {gaits} gaits and their names {of_gaits}: leave out gaits, first those whose waveform no other has"
    )]
    Large {
        /// Bytes too many.
        over: usize,
        /// Bytes that there are.
        most: usize,
        /// Its waveforms.
        waves: usize,
        /// Their bytes.
        of_waves: usize,
        /// Its gaits.
        gaits: usize,
        /// Bytes of them and their names.
        of_gaits: usize,
    },
    /// Numbers that passed every check of a file and that the firmware does not take.
    #[error("the firmware would not take this robot: its numbers cannot be worked with")]
    Impossible,
    /// A gait name the console cannot take.
    #[error("is no gait name: {0}")]
    Name(&'static str),
    /// A gait name that is too long for a line of the console.
    #[error(
        "is no gait name: it has {length} characters, but `status` must fit into a line of the console with it, so it may have {most}"
    )]
    LongName {
        /// How many it has.
        length: usize,
        /// How many it may have.
        most: usize,
    },
    /// A gait name whose number in the memory is that of another one.
    #[error(
        "is no gait name: the memory would take it for {0} when `boot` begins it, so one of them needs another name"
    )]
    SameKey(String),
    /// A gait name that is a console command.
    #[error("is no gait name: \"{0}\" is a command of the console")]
    Command(String),
    /// The first gait is not `stand`.
    #[error("the first gait must be stand, the neutral pose that the robot takes at power-on")]
    Stand,
    /// The first gait moves.
    #[error(
        "must be the neutral pose that the robot takes at power-on: waveform = \"still\" and a period"
    )]
    Moving,
    /// A gait given in no way, or in two.
    #[error("needs exactly one of {0}")]
    OneOf(&'static str),
    /// A key that another key rules out.
    #[error("does not go with {0}")]
    Conflict(String),
    /// A reference to a gait that is not there.
    #[error("names the gait \"{name}\", which does not exist; {hint}")]
    NoSuchGait {
        /// The name given.
        name: String,
        /// What exists.
        hint: Hint,
    },
    /// References that chase each other.
    #[error("the gaits refer to each other in a circle: {0}")]
    Circle(String),
    /// A word that is not among the allowed ones.
    #[error("is \"{word}\"; {hint}")]
    Word {
        /// The word given.
        word: String,
        /// What is allowed.
        hint: Hint,
    },
    /// An order of swings that is not each leg once.
    #[error("must list each of LF, RF, RH, LH exactly once")]
    Order,
    /// A path point that the five-bar cannot reach with its elbows outward.
    #[error("the point ({x:.2}, {y:.2}) mm at phase {phase:.4} is out of reach of the {which}")]
    OutOfReach {
        /// Head or tail.
        which: &'static str,
        /// The point, mm from the middle of the base, outward positive in y.
        x: f64,
        /// See `x`.
        y: f64,
        /// Phase, 0 to 1.
        phase: f64,
    },
    /// A gait sample that breaks a margin.
    #[error("at phase {phase:.4}: {violation}")]
    Unsafe {
        /// Phase, 0 to 1.
        phase: f64,
        /// What is violated, its value and its limit.
        violation: String,
    },
    /// A gait sample nearer to a limit than the firmware's integers resolve.
    #[error(
        "at phase {phase:.4}: margin or travel {what} is so near to its limit that the firmware's integers take it to be beyond; leave it a little room"
    )]
    TooNear {
        /// Phase, 0 to 1.
        phase: f64,
        /// The condition, as `lizard pose` calls it.
        what: &'static str,
    },
    /// A gait sample outside a servo's travel.
    #[error(
        "at phase {phase:.4} servo {servo} would be at {angle:.2} deg, outside its travel of {min:.2} to {max:.2} deg"
    )]
    Travel {
        /// Phase, 0 to 1.
        phase: f64,
        /// A1 to A4.
        servo: &'static str,
        /// Chassis-frame angle, deg.
        angle: f64,
        /// Smallest angle of its travel, deg.
        min: f64,
        /// Largest, deg.
        max: f64,
    },
    /// A sweep that the fixed point does not hold.
    #[error("servo {servo} would sweep half a turn or more")]
    HalfTurn {
        /// A1 to A4.
        servo: &'static str,
    },
    /// More gaits than a byte numbers.
    #[error("holds {found} gaits; the firmware numbers them with a byte, so leave at most {most}")]
    Many {
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: usize,
    },
    /// A gait that asks more of a servo than it can do.
    #[error(
        "at phase {phase:.4} servo {servo} would turn at {speed:.1} deg/s; limits.gait_slew is {limit:.1} deg/s"
    )]
    TooFast {
        /// Phase, 0 to 1.
        phase: f64,
        /// A1 to A4.
        servo: &'static str,
        /// deg/s over one 20 ms frame.
        speed: f64,
        /// The limit, deg/s.
        limit: f64,
    },
    /// A waveform too steep for 64 samples.
    #[error(
        "its table of 64 samples is {error:.3} deg off at phase {phase:.4} (servo {servo}); at most {limit:.2} deg is allowed"
    )]
    Coarse {
        /// Phase, 0 to 1.
        phase: f64,
        /// A1 to A4.
        servo: &'static str,
        /// deg.
        error: f64,
        /// deg.
        limit: f64,
    },
}

/// A number as its author wrote it, or with an exponent where that would fill a
/// line with zeros.
fn short(value: f64) -> String {
    if value != 0.0 && !(1e-6..1e9).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

/// What would have been right: the nearest word, or all of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Hint(String);

impl Hint {
    /// The hint for `word` where `all` are allowed.
    pub fn new(word: &str, all: &[&str]) -> Self {
        let near = all.iter().map(|known| (distance(word, known), known)).min();
        Self(match near {
            // Two letters of a word may be wrong, but not one of two.
            Some((d, known)) if d == 0 || (d <= 2 && known.len() > 2 && d < known.len()) => {
                format!("did you mean \"{known}\"?")
            }
            _ => format!("allowed are {}", all.join(", ")),
        })
    }
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Levenshtein distance, blind to case: how many letters two words differ by.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.to_lowercase().chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.to_lowercase().chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for j in 0..b.len() {
            let substituted = diagonal + usize::from(letter != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
