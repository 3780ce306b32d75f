//! Fingerprints of states. Two states count as equal if their fingerprints are equal.
//!
//! A fingerprint is a hash of the core's own `Debug` output. The core derives `Debug` for all its structs, so
//! every new field is included automatically, and the core needs no code for the search. `FIELD_RULES` lists the
//! exceptions. A field without effect, such as some counters, is left out. A field that the core compares with only a
//! few values, such as a countdown, is rounded. If rounding makes several states equal, the search explores only the
//! state that it reaches first.

use std::fmt::{self, Write};

/// A function that rounds a number.
type Rounding = fn(u64) -> u64;

/// The treatment of a field in a fingerprint.
#[derive(Clone, Copy)]
enum Treatment {
    Skip,
    Round(Rounding),
}

use Treatment::{Round, Skip};

/// A rule for a field: the struct's name, the field's name, and the field's treatment.
type FieldRule = (&'static str, &'static str, Treatment);

/// The fields that are left out or rounded in a state's fingerprint.
const FIELD_RULES: &[FieldRule] = &[
    ("Main", "last_tick", Skip),
    // The next byte begins a new line, so the previous line has no effect.
    ("Console", "line", Skip),
    // No action ends in the middle of a line, so the time since the last byte has no effect.
    ("Console", "silence_ms", Skip),
    // A single line at another baud rate has enough wrong bytes to change the rate.
    ("RateDetector", "wrong_byte_count", Skip),
    (
        "Motion",
        "frame_count",
        Round(|frames| u64::from(frames >= 1_500)),
    ),
    ("Motion", "calibration", Skip),
    ("CycleCount", "phase_covered", Round(|phase| phase >> 14)),
    ("CycleCount", "last_phase", Skip),
    ("Routine", "frames_left", Round(countdown_class)),
    ("ServoState", "sent_pulses", Round(|width| width >> 11)),
    ("ServoState", "pose", Round(|sweep| sweep >> 10)),
    (
        "ServoState",
        "frames_awake",
        Round(|frames| frames.div_ceil(5)),
    ),
    ("LedPattern", "frames", Skip),
    ("Safety", "is_lit", Skip),
    ("Safety", "handled_late_edges", Skip),
    // While `deadman` is set, the observer also measures the time without a line.
    ("Safety", "silence_ms", Skip),
    ("Safety", "boot_timer", Round(countdown_class)),
    ("Supply", "reading", Skip),
    ("Supply", "frames_at_other_level", Round(countdown_class)),
    ("Cycling", "gait", Skip),
    ("Cycling", "phase", Round(|phase| phase >> 22)),
    ("Cycling", "pace", Round(pace_class)),
    ("Moving", "pace", Round(pace_class)),
    ("PointToPointMove", "from", Round(|sweep| sweep >> 11)),
    ("PointToPointMove", "fraction_per_frame", Skip),
    (
        "PointToPointMove",
        "elapsed_fraction",
        Round(|fraction| fraction >> 13),
    ),
    ("Restart", "reset_count", Round(|count| count.min(1))),
    ("Controller", "reset_count", Round(|count| count.min(1))),
];

/// The fields that record the arrival of a line. A refused command may change only these fields.
const LINE_ARRIVAL_FIELDS: &[FieldRule] = &[
    ("Main", "last_tick", Skip),
    ("Console", "line", Skip),
    ("Console", "silence_ms", Skip),
    ("Console", "answer", Skip),
    ("RateDetector", "wrong_byte_count", Skip),
    ("RateDetector", "has_received", Skip),
    ("Console", "has_printed_banner", Skip),
    ("Safety", "silence_ms", Skip),
    ("Safety", "boot_timer", Skip),
    // A command shows that the last reset came from a program that opened the port.
    ("Controller", "has_received_command", Skip),
    // After a command, the motion that `boot` started counts as commanded.
    ("Controller", "is_unattended", Skip),
];

/// Returns the class of a countdown: exact for 0 and 1, coarse for more frames.
fn countdown_class(frames: u64) -> u64 {
    match frames {
        0 | 1 => frames,
        2..=5 => 2,
        6..=25 => 3,
        26..=60 => 4,
        _ => 5,
    }
}

/// Returns 0 if the motion stands still, 2 at full pace (1024), and 1 between.
fn pace_class(pace: u64) -> u64 {
    u64::from(pace > 0) + u64::from(pace >= 1024)
}

/// Returns the fingerprint of a value, with the fields in `FIELD_RULES` rounded or left out.
pub fn coarse_fingerprint(value: &impl fmt::Debug) -> u64 {
    fingerprint(value, FIELD_RULES)
}

/// Returns the fingerprint of a value without rounding, and without the fields that record a line's arrival.
pub fn fingerprint_without_line_arrival(value: &impl fmt::Debug) -> u64 {
    fingerprint(value, LINE_ARRIVAL_FIELDS)
}

fn fingerprint(value: &impl fmt::Debug, rules: &[FieldRule]) -> u64 {
    let mut reader = DebugReader {
        rules,
        fingerprint: Fingerprint(INITIAL_HASH),
        enclosing_hashes: Vec::new(),
        last_piece_hash: 0,
        is_field_name_next: false,
        rounding: None,
        skipped_depth: None,
    };
    write!(reader, "{value:?}").expect("Debug does not fail");
    reader.fingerprint.0
}

/// The hash of an empty sequence of numbers.
const INITIAL_HASH: u64 = 0x9e37_79b9_7f4a_7c15;

/// A hash of a sequence of numbers.
#[derive(Clone, Copy)]
pub struct Fingerprint(pub u64);

impl Fingerprint {
    /// Adds a number to the hash.
    pub fn add(&mut self, value: u64) {
        let mixed = (self.0 ^ value).wrapping_mul(0xff51_afd7_ed55_8ccd);
        self.0 = (mixed ^ (mixed >> 32)).wrapping_mul(0xc4ce_b9fe_1a85_ec53) ^ (mixed >> 29);
    }
}

/// A reader of `Debug` output, which arrives in separate pieces, such as a struct's name, a brace, a field's name, a
/// colon or a value.
struct DebugReader<'a> {
    rules: &'a [FieldRule],
    fingerprint: Fingerprint,
    /// The values that enclose the next piece, outermost first: for a struct the hash of its name, for a tuple or a
    /// list 0.
    enclosing_hashes: Vec<u64>,
    /// The hash of the previous piece.
    last_piece_hash: u64,
    /// True if the next piece is a field's name.
    is_field_name_next: bool,
    /// The rounding of numbers in the current field, and the field's depth.
    rounding: Option<(Rounding, usize)>,
    /// The depth of the field that is being left out.
    skipped_depth: Option<usize>,
}

/// Returns the hash of a short text.
fn hash(text: &str) -> u64 {
    let mix = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    text.bytes().fold(0xcbf2_9ce4_8422_2325, mix)
}

impl Write for DebugReader<'_> {
    fn write_str(&mut self, piece: &str) -> fmt::Result {
        match piece {
            " { " => {
                self.enclosing_hashes.push(self.last_piece_hash);
                self.is_field_name_next = true;
            }
            "(" | "[" => self.enclosing_hashes.push(0),
            " }" | ")" | "]" => {
                self.end_field();
                self.enclosing_hashes.pop();
            }
            ", " => {
                self.end_field();
                let enclosing_hash = self.enclosing_hashes.last();
                self.is_field_name_next = enclosing_hash.is_some_and(|hash| *hash != 0);
            }
            ": " => {}
            _ if self.is_field_name_next => {
                self.is_field_name_next = false;
                if self.skipped_depth.is_none() {
                    self.begin_field(piece);
                }
            }
            _ if self.skipped_depth.is_none() => self.add_value(piece),
            _ => {}
        }
        if self.skipped_depth.is_none() {
            self.last_piece_hash = hash(piece);
        }
        Ok(())
    }
}

impl DebugReader<'_> {
    /// Ends the rounding or skipping of the field at the current depth.
    fn end_field(&mut self) {
        let depth = self.enclosing_hashes.len();
        self.skipped_depth.take_if(|skipped| *skipped == depth);
        self.rounding.take_if(|(_, rounded)| *rounded == depth);
    }

    fn begin_field(&mut self, field: &str) {
        self.fingerprint.add(hash(field));
        let depth = self.enclosing_hashes.len();
        let struct_hash = *self.enclosing_hashes.last().unwrap_or(&0);
        let mut rules = self.rules.iter();
        match rules.find(|(name, field_name, _)| *field_name == field && hash(name) == struct_hash)
        {
            Some((_, _, Skip)) => self.skipped_depth = Some(depth),
            Some((_, _, Round(round))) => self.rounding = Some((*round, depth)),
            None => {}
        }
    }

    fn add_value(&mut self, piece: &str) {
        match (piece.parse::<u64>(), self.rounding) {
            (Ok(number), Some((round, _))) => self.fingerprint.add(round(number)),
            (Ok(number), None) => self.fingerprint.add(number),
            (Err(_), _) => self.fingerprint.add(hash(piece)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::small_robot::small_robot;
    use crate::{Action, initial_states};

    #[derive(Clone, Copy, Debug)]
    #[allow(dead_code, reason = "read by Debug")]
    struct Motion {
        frame_count: u32,
        servo_state: ServoState,
        speed: i16,
        list: [u8; 3],
    }

    #[derive(Clone, Copy, Debug)]
    #[allow(dead_code, reason = "read by Debug")]
    struct ServoState {
        frames_awake: u8,
    }

    const MOTION: Motion = Motion {
        frame_count: 7,
        servo_state: ServoState { frames_awake: 3 },
        speed: -5,
        list: [1, 2, 3],
    };

    #[test]
    fn a_coarse_fingerprint_rounds_the_listed_fields_and_includes_all_others_exactly() {
        let fingerprint = coarse_fingerprint(&MOTION);
        type Change = fn(&mut Motion);
        let changes: [(Change, bool); 6] = [
            (|motion| motion.frame_count = 1_499, true),
            (|motion| motion.servo_state.frames_awake = 5, true),
            (|motion| motion.frame_count = 1_500, false),
            (|motion| motion.servo_state.frames_awake = 6, false),
            (|motion| motion.speed = 5, false),
            (|motion| motion.list[2] = 4, false),
        ];
        for (change, is_equal) in changes {
            let mut motion = MOTION;
            change(&mut motion);
            let has_same_fingerprint = coarse_fingerprint(&motion) == fingerprint;
            assert_eq!(has_same_fingerprint, is_equal, "{motion:?}");
        }
        let mut changed_motion = MOTION;
        changed_motion.frame_count = 8;
        let exact_fingerprint = fingerprint_without_line_arrival(&MOTION);
        let changed_fingerprint = fingerprint_without_line_arrival(&changed_motion);
        assert_ne!(changed_fingerprint, exact_fingerprint);
    }

    #[test]
    fn every_rule_names_an_existing_field() {
        let mut states = Vec::new();
        for initial_state in initial_states::prepare_all(small_robot()) {
            for action in [
                Action::Line("walk"),
                Action::Line("save"),
                Action::Frames(25),
            ] {
                let mut world = initial_state.world.clone();
                _ = world.apply(action);
                let restart = world.running_robot.board.ram.peek_restart(None);
                states.push((world.running_robot.main, restart));
            }
        }
        for (name, field, _) in FIELD_RULES.iter().chain(LINE_ARRIVAL_FIELDS) {
            let rule = [(*name, *field, Skip)];
            let mut states = states.iter();
            let is_skipped =
                states.any(|state| fingerprint(state, &rule) != fingerprint(state, &[]));
            assert!(is_skipped, "{name}.{field}");
        }
    }
}
