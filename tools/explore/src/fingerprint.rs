//! Fingerprints that decide which states are equal: two states are equal if the core's own `Debug` output
//! is the same for both, except for counters that have no effect.
//!
//! The core derives `Debug` for everything it holds, so a new field is included
//! automatically, and the core needs no code for this. A field that cannot matter is left
//! out. A field that is only compared with a few values, such as a countdown, is rounded
//! as `RULES` says. Of several states that rounding makes equal, the search explores only
//! the first that it reaches.

use std::fmt::{self, Write};

/// A function that rounds a number.
type Rounding = fn(u64) -> u64;

/// The treatment of a field.
#[derive(Clone, Copy)]
enum Treatment {
    Skip,
    Coarse(Rounding),
}

use Treatment::{Coarse, Skip};

/// The name of a struct, the name of a field in it, and the treatment of that field.
type Field = (&'static str, &'static str, Treatment);

/// The fields that are left out or rounded in a state's fingerprint.
const RULES: &[Field] = &[
    ("Main", "last_tick", Skip),
    // The previous line has no effect, since the next byte begins a new line.
    ("Console", "line", Skip),
    // No action ends within a line, so no line waits for its rest.
    ("Console", "silence_ms", Skip),
    // A line at another rate has enough wrong bytes to change the rate, however many came before.
    ("RateFinder", "wrong_byte_count", Skip),
    (
        "Motion",
        "frame_count",
        Coarse(|frames| u64::from(frames >= 1_500)),
    ),
    ("Motion", "calibration", Skip),
    ("CycleCount", "phase_covered", Coarse(|phase| phase >> 14)),
    ("CycleCount", "last_phase", Skip),
    ("Routine", "frames_left", Coarse(coarse_countdown)),
    ("Stance", "sent_pulses", Coarse(|width| width >> 11)),
    ("Stance", "pose", Coarse(|sweep| sweep >> 10)),
    (
        "Stance",
        "frames_awake",
        Coarse(|frames| frames.div_ceil(5)),
    ),
    ("Led", "frames", Skip),
    ("Safety", "is_lit", Skip),
    ("Safety", "handled_late_edges", Skip),
    // The observer counts the silence, too, where it matters.
    ("Safety", "silence_ms", Skip),
    ("Safety", "boot_timer", Coarse(coarse_countdown)),
    ("Supply", "reading", Skip),
    ("Supply", "frames_at_other_level", Coarse(coarse_countdown)),
    ("Cycling", "gait", Skip),
    ("Cycling", "phase", Coarse(|phase| phase >> 22)),
    ("Cycling", "pace", Coarse(coarse_pace)),
    ("Moving", "pace", Coarse(coarse_pace)),
    ("PointToPointMove", "from", Coarse(|sweep| sweep >> 11)),
    ("PointToPointMove", "share_per_frame", Skip),
    (
        "PointToPointMove",
        "elapsed_share",
        Coarse(|share| share >> 13),
    ),
    ("Restart", "reset_count", Coarse(|count| count.min(1))),
    ("Control", "reset_count", Coarse(|count| count.min(1))),
];

/// The fields that a refused command may change: they record that a line has arrived.
const LINE_ARRIVAL_FIELDS: &[Field] = &[
    ("Main", "last_tick", Skip),
    ("Console", "line", Skip),
    ("Console", "silence_ms", Skip),
    ("Console", "answer", Skip),
    ("RateFinder", "wrong_byte_count", Skip),
    ("RateFinder", "has_received", Skip),
    ("Console", "has_printed_banner", Skip),
    ("Safety", "silence_ms", Skip),
    ("Safety", "boot_timer", Skip),
    // A command shows that a program opened the port, which resets the board.
    ("Control", "has_heard_command", Skip),
    // From then on, the motion that `boot` began counts as ordered.
    ("Control", "is_unattended", Skip),
];

fn coarse_countdown(frames: u64) -> u64 {
    match frames {
        0 | 1 => frames,
        2..=5 => 2,
        6..=25 => 3,
        26..=60 => 4,
        _ => 5,
    }
}

fn coarse_pace(pace: u64) -> u64 {
    u64::from(pace > 0) + u64::from(pace >= 1024)
}

/// Returns a fingerprint that rounds fields or leaves them out as `RULES` says.
pub fn coarse_fingerprint(value: &impl fmt::Debug) -> u64 {
    fingerprint(value, RULES)
}

/// Returns the exact fingerprint of every field except those that record that a line has arrived.
pub fn fingerprint_without_line_arrival(value: &impl fmt::Debug) -> u64 {
    fingerprint(value, LINE_ARRIVAL_FIELDS)
}

fn fingerprint(value: &impl fmt::Debug, rules: &'static [Field]) -> u64 {
    let mut reader = Reader {
        rules,
        fingerprint: Fingerprint::default(),
        within: Vec::new(),
        last: 0,
        is_field_name_next: false,
        number: None,
        skipped: None,
    };
    write!(reader, "{value:?}").expect("Debug does not fail");
    reader.fingerprint.0
}

/// A hash of numbers.
#[derive(Clone, Copy)]
pub struct Fingerprint(pub u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(0x9e37_79b9_7f4a_7c15)
    }
}

impl Fingerprint {
    /// Adds a number to the hash.
    pub fn add(&mut self, value: u64) {
        let mixed = (self.0 ^ value).wrapping_mul(0xff51_afd7_ed55_8ccd);
        self.0 = (mixed ^ (mixed >> 32)).wrapping_mul(0xc4ce_b9fe_1a85_ec53) ^ (mixed >> 29);
    }
}

/// A reader of the output of `Debug`, which writes a name, a brace, a field's name, a colon and
/// a value, each as a separate piece.
struct Reader {
    rules: &'static [Field],
    fingerprint: Fingerprint,
    /// The values around the next piece, outermost first: the hash of a struct's name, or 0 for a tuple or
    /// a list.
    within: Vec<u64>,
    /// The hash of the previous piece.
    last: u64,
    /// True if the next piece is a field's name.
    is_field_name_next: bool,
    /// The rounding of numbers in the current field, and the depth of that field.
    number: Option<(Rounding, usize)>,
    /// The depth of the field that is being left out.
    skipped: Option<usize>,
}

/// Returns the hash of a short text.
const fn hash(text: &str) -> u64 {
    let bytes = text.as_bytes();
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut index = 0;
    while index < bytes.len() {
        hash = (hash ^ bytes[index] as u64).wrapping_mul(0x0100_0000_01b3);
        index += 1;
    }
    hash
}

impl Write for Reader {
    fn write_str(&mut self, piece: &str) -> fmt::Result {
        match piece {
            " { " => {
                self.within.push(self.last);
                self.is_field_name_next = true;
            }
            "(" | "[" => self.within.push(0),
            " }" | ")" | "]" => {
                self.end_field();
                self.within.pop();
            }
            ", " => {
                self.end_field();
                self.is_field_name_next = self.within.last().is_some_and(|name| *name != 0);
            }
            ": " => {}
            _ if self.is_field_name_next => {
                self.is_field_name_next = false;
                if self.skipped.is_none() {
                    self.begin_field(piece);
                }
            }
            _ if self.skipped.is_none() => self.add_value(piece),
            _ => {}
        }
        if self.skipped.is_none() {
            self.last = hash(piece);
        }
        Ok(())
    }
}

impl Reader {
    /// Ends the treatment of the field at the current depth.
    fn end_field(&mut self) {
        let depth = self.within.len();
        self.skipped = self.skipped.filter(|skipped| *skipped != depth);
        self.number = self.number.filter(|(_, field_depth)| *field_depth != depth);
    }

    fn begin_field(&mut self, field: &str) {
        let name = hash(field);
        self.fingerprint.add(name);
        let struct_hash = *self.within.last().unwrap_or(&0);
        let rule = self
            .rules
            .iter()
            .find(|(owner, field_name, _)| *field_name == field && hash(owner) == struct_hash);
        match rule {
            Some((_, _, Skip)) => self.skipped = Some(self.within.len()),
            Some((_, _, Coarse(round))) => self.number = Some((*round, self.within.len())),
            None => {}
        }
    }

    fn add_value(&mut self, piece: &str) {
        match (piece.parse::<u64>(), self.number) {
            (Ok(number), Some((round, _))) => self.fingerprint.add(round(number)),
            (Ok(number), None) => self.fingerprint.add(number),
            (Err(_), _) => self.fingerprint.add(hash(piece)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::small::small_robot;
    use crate::{Action, initial_states};

    #[derive(Clone, Copy, Debug)]
    #[allow(dead_code, reason = "read by Debug")]
    struct Motion {
        frame_count: u32,
        stance: Stance,
        speed: i16,
        list: [u8; 3],
    }

    #[derive(Clone, Copy, Debug)]
    #[allow(dead_code, reason = "read by Debug")]
    struct Stance {
        frames_awake: u8,
    }

    const MOTION: Motion = Motion {
        frame_count: 7,
        stance: Stance { frames_awake: 3 },
        speed: -5,
        list: [1, 2, 3],
    };

    /// Returns [`MOTION`] with one change.
    fn motion_with(change: impl Fn(&mut Motion)) -> Motion {
        let mut motion = MOTION;
        change(&mut motion);
        motion
    }

    #[test]
    fn counters_are_left_out_coarse_fields_are_rounded_and_all_others_count() {
        let fingerprint = coarse_fingerprint(&MOTION);
        assert_eq!(
            coarse_fingerprint(&motion_with(|motion| motion.frame_count = 1_499)),
            fingerprint
        );
        assert_eq!(
            coarse_fingerprint(&motion_with(|motion| motion.stance.frames_awake = 5)),
            fingerprint
        );
        assert_ne!(
            coarse_fingerprint(&motion_with(|motion| motion.frame_count = 1_500)),
            fingerprint
        );
        assert_ne!(
            coarse_fingerprint(&motion_with(|motion| motion.stance.frames_awake = 6)),
            fingerprint
        );
        assert_ne!(
            coarse_fingerprint(&motion_with(|motion| motion.speed = 5)),
            fingerprint
        );
        assert_ne!(
            coarse_fingerprint(&motion_with(|motion| motion.list[2] = 4)),
            fingerprint
        );
        let exact_fingerprint = fingerprint_without_line_arrival(&MOTION);
        assert_ne!(
            fingerprint_without_line_arrival(&motion_with(|motion| motion.frame_count = 8)),
            exact_fingerprint
        );
    }

    #[test]
    fn every_rule_names_an_existing_field() {
        let robot = small_robot();
        let mut text = String::new();
        for initial_state in initial_states::all(robot) {
            for action in [Action::Say("walk"), Action::Say("save"), Action::Frames(25)] {
                let mut world = initial_state.world.clone();
                _ = world.apply(action);
                let ram = world.running.board.ram.peek_restart(Default::default());
                _ = write!(text, "{:?} {ram:?}", world.running.main);
            }
        }
        for (owner, field, _) in RULES.iter().chain(LINE_ARRIVAL_FIELDS) {
            assert!(text.contains(&format!("{owner} {{ ")), "{owner}");
            assert!(text.contains(&format!(" {field}: ")), "{owner}.{field}");
        }
    }
}
