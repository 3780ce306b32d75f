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
        let tail_tables = if tail.couplers == head.couplers {
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
        ];
        for (doc, name, value) in constants {
            writeln!(f, "\n/// {doc}\npub const {name} = {value};")?;
        }
        Ok(())
    }

    fn coupler_tables(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [head, tail] = &self.0.ends;
        coupler_tables(f, "HEAD", &head.couplers)?;
        if tail.couplers == head.couplers {
            return Ok(());
        }
        coupler_tables(f, "TAIL", &tail.couplers)
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

/// The tables of a pair of couplers; the compiler computes them.
fn coupler_tables(f: &mut fmt::Formatter, end: &str, bars: &Bars) -> fmt::Result {
    let unequal = bars.left != bars.right;
    for (name, function, there) in [
        ("RISE", "rise", true),
        ("STRETCHED", "stretched", bars.near_stretched),
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
