//! Rust source of the firmware's numbers: what the build script puts into
//! `$OUT_DIR/robot.rs`, in the types of the core.

use std::fmt::{self, Display, Write};

use lizard_core::gait::SAMPLES;

use crate::numbers::{Bars, Loop, Numbers};

/// The source of a robot's numbers, headed by their hash.
pub(crate) fn source(numbers: &Numbers) -> String {
    format!(
        "// Written by build.rs from robot.toml.\n\n/// CRC-32 of everything below.\npub const HASH: u32 = {:#010x};\n{}",
        hash(numbers),
        Body(numbers)
    )
}

/// The hash that the source carries.
pub(crate) fn hash(numbers: &Numbers) -> u32 {
    crc32fast::hash(Body(numbers).to_string().as_bytes())
}

/// The hash of the servos alone, by which a saved calibration is known to be theirs.
/// Gaits, bars and limits may change without it.
pub(crate) fn servo_hash(numbers: &Numbers) -> u32 {
    let Numbers {
        pins,
        neutral,
        calibration,
        ..
    } = numbers;
    crc32fast::hash(format!("{pins:?} {neutral:?} {calibration:?}").as_bytes())
}

struct Body<'a>(&'a Numbers);

impl Display for Body<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.constants(f)?;
        f.write_str("\nlizard_avr::flash! {\n")?;
        self.coupler_tables(f)?;
        self.gaits(f)?;
        self.waves(f)?;
        f.write_str("}\n")
    }
}

impl Body<'_> {
    fn constants(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let robot = self.0;
        let [head, tail] = &robot.ends;
        let [left, right] = &robot.sides;
        let tail_tables = if share_tables(head, tail) {
            "HEAD"
        } else {
            "TAIL"
        };
        let neutral = robot.neutral.map(|angle| format!("{angle:?}")).join(", ");
        let constants = [
            (
                "Arduino numbers of the servos' pins, A1 to A4; 14 to 19 are A0 to A5.",
                "PINS: [u8; 4]",
                format!("{:?}", robot.pins),
            ),
            (
                "The servos' angles in the neutral pose.",
                "NEUTRAL: [Angle; 4]",
                format!("[{neutral}]"),
            ),
            (
                "The servos' pulses and travel.",
                "CALIBRATION: [Calibration; 4]",
                format!("{:?}", robot.calibration),
            ),
            (
                "Whether the tail is built as the head is.",
                "ENDS_ALIKE: bool",
                (head == tail).to_string(),
            ),
            (
                "Whether the right side is built as the left one is.",
                "SIDES_ALIKE: bool",
                (left == right).to_string(),
            ),
            (
                "The head's loop, A1 on its left.",
                "HEAD: FiveBar<'static>",
                five_bar(head, "HEAD"),
            ),
            (
                "The tail's loop in its own frame, A4 on its left.",
                "TAIL: FiveBar<'static>",
                five_bar(tail, tail_tables),
            ),
            (
                "The slider between A1 and A4.",
                "LEFT: Slider",
                format!("{left:?}"),
            ),
            (
                "The slider between A2 and A3.",
                "RIGHT: Slider",
                format!("{right:?}"),
            ),
            (
                "Smallest margins, rounded up.",
                "LIMITS: Limits",
                format!("{:?}", robot.limits),
            ),
            (
                "Fastest turn in a point-to-point move, 1/65536 turn in a frame, rounded down.",
                "SLEW: Slew",
                format!("Slew::new({})", robot.slew.per_frame),
            ),
            (
                "What the gaits need of the servos.",
                "REACH: [Reach; 4]",
                format!("{:?}", robot.reach),
            ),
            (
                "The servos' supply, where it is measured, mV.",
                "RAIL: Option<Rail>",
                format!("{:?}", robot.supplies.rail),
            ),
            (
                "The supplies, mV.",
                "SUPPLIES: Supplies",
                format!(
                    "Supplies {{ reference: {}, board: {:?}, rail: RAIL }}",
                    robot.supplies.reference, robot.supplies.board
                ),
            ),
            (
                "Arduino number of the pin of the servos' rail, where that is measured.",
                "RAIL_PIN: Option<u8>",
                format!("{:?}", robot.rail_pin),
            ),
            (
                "CRC-32 of the servos' pins, angles and pulses.",
                "SERVO_HASH: u32",
                format!("{:#010x}", servo_hash(robot)),
            ),
        ];
        for (doc, name, value) in constants {
            writeln!(f, "\n/// {doc}\npub const {name} = {value};")?;
        }
        Ok(())
    }

    fn coupler_tables(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [head, tail] = &self.0.ends;
        let near_stretched = head.couplers.near_stretched;
        if share_tables(head, tail) {
            let either = near_stretched || tail.couplers.near_stretched;
            return coupler_tables(f, "HEAD", &head.couplers, either);
        }
        coupler_tables(f, "HEAD", &head.couplers, near_stretched)?;
        coupler_tables(f, "TAIL", &tail.couplers, tail.couplers.near_stretched)
    }

    fn gaits(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let tables = &self.0.tables;
        writeln!(f, "    /// The gaits in the order of robot.toml.")?;
        writeln!(f, "    pub const GAITS: [Gait; {}] = [", tables.gaits.len())?;
        for gait in &tables.gaits {
            writeln!(f, "        {gait:?},")?;
        }
        writeln!(f, "    ];\n\n    /// Their names.")?;
        let names = String::from_utf8_lossy(&tables.names);
        writeln!(
            f,
            "    pub const NAMES: [u8; {}] = *b{names:?};",
            tables.names.len()
        )
    }

    fn waves(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let waves = &self.0.tables.waves;
        writeln!(f, "\n    /// Waveforms, 1/65536 turn at gain 1.")?;
        writeln!(
            f,
            "    pub const WAVES: [[i16; {SAMPLES}]; {}] = [",
            waves.len()
        )?;
        for wave in waves {
            f.write_str("        [\n")?;
            for row in wave.chunks(16) {
                f.write_str("           ")?;
                for sample in row {
                    write!(f, " {sample},")?;
                }
                f.write_char('\n')?;
            }
            f.write_str("        ],\n")?;
        }
        f.write_str("    ];\n")
    }
}

fn five_bar(bars: &Loop, tables: &str) -> String {
    let Bars { left, right, .. } = bars.couplers;
    let some = |there: bool, name: &str| {
        if there {
            format!("Some({tables}_{name})")
        } else {
            "None".to_string()
        }
    };
    let unequal = left != right;
    format!(
        "FiveBar::new({}, {}, {}, Couplers::new({left}, {right}, couplers::Tables {{ rise: {tables}_RISE, stretched: {}, folded: {}, skew: {} }}))",
        bars.base,
        bars.left,
        bars.right,
        some(bars.couplers.near_stretched, "STRETCHED"),
        some(bars.couplers.differ_much(), "FOLDED"),
        some(unequal, "SKEW"),
    )
}

/// Whether the couplers of both ends are equally long, so that their tables are the
/// same.
fn share_tables(head: &Loop, tail: &Loop) -> bool {
    let lengths = |end: &Loop| (end.couplers.left, end.couplers.right);
    lengths(head) == lengths(tail)
}

/// The tables of a pair of couplers; the compiler computes them.
fn coupler_tables(
    f: &mut fmt::Formatter,
    end: &str,
    bars: &Bars,
    near_stretched: bool,
) -> fmt::Result {
    let unequal = bars.left != bars.right;
    for (name, function, there) in [
        ("RISE", "rise", true),
        ("STRETCHED", "stretched", near_stretched),
        ("FOLDED", "folded", bars.differ_much()),
        ("SKEW", "skew", unequal),
    ] {
        if there {
            writeln!(
                f,
                "    const {end}_{name}: Table = couplers::{function}({}, {});",
                bars.left, bars.right
            )?;
        }
    }
    f.write_char('\n')
}

#[cfg(test)]
mod tests {
    use crate::testing::{all, with};
    use lizard_avr::Flash;
    use lizard_core::part::{End, Side};
    use lizard_core::robot::Robot as _;
    use lizard_core::supply::Thresholds;

    /// The whole numbers in a text, outside of words.
    fn numbers(text: &str) -> Vec<i64> {
        let apart = |c: char| !(c.is_ascii_alphanumeric() || c == '-' || c == '_');
        text.split(apart)
            .filter_map(|word| word.parse().ok())
            .collect()
    }

    /// What a constant of the source is set to.
    fn value<'a>(source: &'a str, name: &str) -> &'a str {
        let start = format!("const {name}:");
        let from = source.find(&start).unwrap_or_else(|| panic!("no {name}"));
        let from = from + source[from..].find('=').expect("a value") + 1;
        let to = from + source[from..].find(";\n").expect("an end");
        &source[from..to]
    }

    fn held<T: Copy>(flash: Flash<'_, [T]>) -> Vec<T> {
        (0..flash.len())
            .map(|i| flash.get(i).expect("within").load())
            .collect()
    }

    #[test]
    fn the_source_says_what_the_run_time_robot_is() {
        for (name, robot) in all() {
            let firmware = robot.firmware();
            let source = firmware.source();
            let of = |name: &str| numbers(value(&source, name));
            let wide = |values: &[i64]| values.to_vec();

            assert_eq!(of("PINS"), firmware.pins().map(i64::from), "{name}");
            assert_eq!(of("NEUTRAL"), firmware.neutral().map(|a| i64::from(a.0)));
            let calibration = firmware.calibration().map(|c| {
                [
                    i64::from(c.neutral.0),
                    i64::from(c.gain),
                    i64::from(c.min.0),
                    i64::from(c.max.0),
                ]
            });
            assert_eq!(of("CALIBRATION"), calibration.concat());
            let reach = |servo| {
                let reach = firmware.reach(servo);
                [reach.min.0, reach.max.0].map(i64::from)
            };
            assert_eq!(
                of("REACH"),
                lizard_core::part::Servo::ALL.map(reach).concat()
            );
            let supplies = firmware.supplies();
            let board = supplies.board;
            assert_eq!(
                of("SUPPLIES"),
                [supplies.reference, board.slow, board.stop, board.rest].map(i64::from)
            );
            let rail = supplies.rail.map_or(Vec::new(), |rail| {
                let Thresholds { slow, stop, rest } = rail.thresholds;
                [rail.reference, slow, stop, rest].map(i64::from).to_vec()
            });
            assert_eq!(of("RAIL"), rail, "{name}");
            let pin = firmware.rail_pin().map(i64::from);
            assert_eq!(of("RAIL_PIN"), pin.as_slice(), "{name}");
            assert_eq!(
                value(&source, "SERVO_HASH").trim(),
                format!("{:#010x}", firmware.servo_hash())
            );
            let limits = firmware.limits();
            assert_eq!(
                of("LIMITS"),
                [limits.type2, limits.type1, limits.leg].map(|s| i64::from(s.0))
            );
            assert_eq!(of("SLEW"), wide(&[i64::from(firmware.slew().per_frame)]));
            for (name, side) in [("LEFT", Side::Left), ("RIGHT", Side::Right)] {
                let s = firmware.side(side);
                let slider = [
                    i64::from(s.scale.bits),
                    i64::from(s.offset),
                    i64::from(s.base),
                    i64::from(s.front),
                    i64::from(s.rear),
                    i64::from(s.nominal),
                    i64::from(s.min),
                    i64::from(s.max),
                ];
                assert_eq!(of(name), slider);
            }
            let l = robot.lizard().links;
            for (name, end, mm) in [
                ("HEAD", End::Head, [l.l0, l.l1, l.l4, l.l2, l.l3]),
                ("TAIL", End::Tail, [l.l5, l.l6, l.l9, l.l7, l.l8]),
            ] {
                let per_mm = f64::from(1u32 << firmware.end_scale(end).bits);
                assert_eq!(of(name), mm.map(|mm| (mm * per_mm).round() as i64));
            }

            let gaits: Vec<i64> = held(firmware.gaits())
                .iter()
                .flat_map(|gait| {
                    let mut all = vec![
                        i64::from(gait.name_start),
                        i64::from(gait.name_length),
                        i64::from(gait.increment),
                    ];
                    for channel in gait.channels {
                        all.extend([
                            i64::from(channel.wave),
                            i64::from(channel.offset),
                            i64::from(channel.gain),
                        ]);
                    }
                    all
                })
                .collect();
            assert_eq!(of("GAITS"), gaits, "{name}");
            let waves: Vec<i64> = held(firmware.waves())
                .concat()
                .into_iter()
                .map(i64::from)
                .collect();
            assert_eq!(of("WAVES"), waves, "{name}");
            let names = String::from_utf8(held(firmware.names())).expect("ASCII");
            assert_eq!(value(&source, "NAMES"), format!(" *b{names:?}"));
        }
    }

    #[test]
    fn a_mechanism_that_differs_has_constants_of_its_own() {
        for (name, robot) in all() {
            let source = robot.firmware().source();
            let alike = (name != "unequal").to_string();
            assert_eq!(value(&source, "ENDS_ALIKE").trim(), alike, "{name}");
            assert_eq!(value(&source, "SIDES_ALIKE").trim(), alike, "{name}");
            // The tail's tables are the head's where its couplers are.
            assert!(value(&source, "TAIL").contains("rise: HEAD_RISE"), "{name}");
            assert!(value(&source, "HEAD").contains("rise: HEAD_RISE"), "{name}");
            assert!(!source.contains("TAIL_RISE: Table"), "{name}");
        }
        let changes = [("l7 = 55.0 ", "l7 = 46.0 "), ("l8 = 48.0 ", "l8 = 52.0 ")];
        let apart = with("unequal", &changes).expect("other couplers on the tail");
        let source = apart.firmware().source();
        assert!(value(&source, "TAIL").contains("rise: TAIL_RISE"));
        assert!(source.contains("TAIL_RISE: Table"));
        // Couplers alike, cranks not: two loops, one set of tables.
        let wider = with("paper", &[("l6 = 30.0 ", "l6 = 31.0 ")]).expect("a longer crank");
        let source = wider.firmware().source();
        assert_eq!(value(&source, "ENDS_ALIKE").trim(), "false");
        assert_eq!(value(&source, "SIDES_ALIKE").trim(), "true");
        assert!(value(&source, "TAIL").contains("rise: HEAD_RISE"));
    }

    #[test]
    fn every_table_that_is_named_is_there_with_its_couplers() {
        for (name, robot) in all() {
            let source = robot.firmware().source();
            for end in ["HEAD", "TAIL"] {
                let bars = value(&source, end);
                let [.., a, b] = numbers(bars)[..] else {
                    panic!("{bars}")
                };
                let names = bars.split(|c: char| !(c.is_ascii_uppercase() || c == '_'));
                for table in names.filter(|word| word.contains('_') && word.len() > 4) {
                    assert_eq!(numbers(value(&source, table)), [a, b], "{name} {table}");
                }
            }
        }
    }

    #[test]
    fn the_hash_is_that_of_the_lines_below_it() {
        for (_, robot) in all() {
            let source = robot.firmware().source();
            let (head, body) = source.split_once(";\n").expect("the hash's line");
            let hash = crc32fast::hash(body.as_bytes());
            assert!(head.ends_with(&format!("HASH: u32 = {hash:#010x}")));
            assert_eq!(hash, robot.firmware().hash());
        }
    }

    #[test]
    fn the_hash_covers_all_that_the_firmware_gets_and_nothing_else() {
        let hash =
            |changes: &[(&str, &str)]| with("paper", changes).expect("valid").firmware().hash();
        let paper = hash(&[]);
        for change in [
            ("pin = \"D9\"", "pin = \"D6\""),
            ("\nslew = 300.0", "\nslew = 250.0"),
            ("amplitude = 15.0", "amplitude = 14.9"),
            ("period = 4.0", "period = 4.1"),
            ("stroke_max = 45.0", "stroke_max = 44.0"),
            ("[gait.look]", "[gait.gaze]\nlike = \"walk\"\n[gait.look]"),
        ] {
            assert_ne!(hash(&[change]), paper, "{change:?}");
        }
        assert_eq!(
            hash(&[("_forward = 1.0", "_forward = 1.2")]),
            paper,
            "the floor is no part of it"
        );
        for hips in ["hip_side = 36.0", "hip_forward = 70.0\nhip_side = 35.0"] {
            let change = format!("{hips}\nmount = 0.0 ");
            assert_eq!(hash(&[("mount = 0.0 ", &change)]), paper, "{hips}");
        }
        let parts = "[parts]\npivot = [31.0, 9.0]\nfoot = [-2.0, 1.0]\n[ground] ";
        assert_eq!(hash(&[("[ground] ", parts)]), paper);
    }

    #[test]
    fn the_servos_hash_changes_with_the_servos_alone() {
        let hash = |changes: &[(&str, &str)]| {
            let robot = with("paper", changes).expect("valid");
            robot.firmware().servo_hash()
        };
        let paper = hash(&[]);
        for change in [
            ("pin = \"D9\"", "pin = \"D6\""),
            ("neutral_us = 1500.0", "neutral_us = 1501.0"),
            ("us_per_degree = 10.0", "us_per_degree = 10.1"),
            ("min_us = 600.0", "min_us = 610.0"),
        ] {
            assert_ne!(hash(&[change]), paper, "{change:?}");
        }
        for change in [
            ("\nslew = 300.0", "\nslew = 250.0"),
            ("amplitude = 15.0", "amplitude = 14.9"),
            ("stroke_max = 45.0", "stroke_max = 44.0"),
        ] {
            assert_eq!(hash(&[change]), paper, "{change:?}");
        }
    }
}
