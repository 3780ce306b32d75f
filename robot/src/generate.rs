//! Rust source of the firmware's numbers: what the build script puts into
//! `$OUT_DIR/robot.rs`, in the types of the core.

use std::fmt::{self, Display, Write};

use lizard_kinematics::{End, FiveBar, Lizard, Side, Slider};

use crate::Robot;
use crate::servo::Servo;
use crate::table::{FRAMES_PER_SECOND, SAMPLES, STEPS_PER_DEGREE};

/// Steps of a length in one mm.
const STEPS_PER_MM: f64 = 256.0;
/// CPU cycles in one us.
const CYCLES_PER_US: f64 = 16.0;
/// 1.0 in Q15 and Q14.
const ONE_Q15: f64 = 32768.0;
const ONE_Q14: f64 = 16384.0;
/// What rounding may add to a number that robot.toml gives exactly.
const SLACK: f64 = 1e-6;

/// The source of a robot's numbers, headed by their hash.
pub(crate) fn source(robot: &Robot) -> String {
    let body = body(robot);
    let hash = crc32fast::hash(body.as_bytes());
    format!(
        "// Written by build.rs from robot.toml.\n\n/// CRC-32 of everything below.\npub const TABLES_HASH: u32 = {hash:#010x};\n{body}"
    )
}

/// The hash that the source carries.
pub(crate) fn hash(robot: &Robot) -> u32 {
    crc32fast::hash(body(robot).as_bytes())
}

fn body(robot: &Robot) -> String {
    Body(robot).to_string()
}

struct Body<'a>(&'a Robot);

impl Display for Body<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Robot {
            lizard,
            servos,
            limits,
            pace,
            tables,
            ..
        } = self.0;
        f.write_str("\n/// The servos A1, A2, A3, A4.\npub const SERVOS: [Servo; 4] = [\n")?;
        for servo in servos {
            writeln!(f, "    {},", servo_literal(servo))?;
        }
        f.write_str("];\n")?;
        let constants = [
            (
                "The head's loop, A1 on its left.",
                "HEAD: FiveBar",
                five_bar(&lizard.end(End::Head), "HEAD_SLOPE"),
            ),
            (
                "The tail's loop in tail-local angles, A4 on its left.",
                "TAIL: FiveBar",
                five_bar(
                    &lizard.end(End::Tail),
                    slopes(lizard).last().map_or("HEAD_SLOPE", |(name, _)| name),
                ),
            ),
            (
                "The slider between A1 and A4.",
                "LEFT: Slider",
                slider(robot_stroke(self.0), &lizard.side(Side::Left)),
            ),
            (
                "The slider between A2 and A3.",
                "RIGHT: Slider",
                slider(robot_stroke(self.0), &lizard.side(Side::Right)),
            ),
            (
                "Smallest margins, Q15, rounded up.",
                "LIMITS: Limits",
                format!(
                    "Limits {{ type2: {}, type1: {}, leg: {} }}",
                    q15(limits.type2),
                    q15(limits.type1),
                    q15(limits.leg)
                ),
            ),
            (
                "Fastest turn of a blend or a pose, 1/65536 turn in a frame, rounded down.",
                "SLEW: u16",
                floor(pace.slew * STEPS_PER_DEGREE / FRAMES_PER_SECOND).to_string(),
            ),
            (
                "How many gaits there are; the first is `stand`.",
                "GAIT_COUNT: usize",
                tables.gaits.len().to_string(),
            ),
            (
                "How many waveforms there are.",
                "WAVE_COUNT: usize",
                tables.waves.len().to_string(),
            ),
        ];
        for (doc, name, value) in constants {
            writeln!(f, "\n/// {doc}\npub const {name} = {value};")?;
        }
        let slopes = slopes(lizard);
        f.write_str("\nlizard_avr::flash! {\n")?;
        for (name, coupler) in &slopes {
            writeln!(
                f,
                "    const {name}: [u16; crate::slope::ENTRIES] = crate::slope::table({coupler});\n"
            )?;
        }
        f.write_str("    /// The gaits in the order of robot.toml.\n")?;
        f.write_str("    pub const GAITS: [Gait; GAIT_COUNT] = [\n")?;
        for gait in &tables.gaits {
            write!(
                f,
                "        Gait {{ name: *b\"{:<12}\", increment: {}, channels: [",
                gait.name.replace('-', " "),
                gait.increment
            )?;
            for c in gait.channels {
                write!(
                    f,
                    "Channel {{ wave: {}, offset: {:#06x}, gain: {} }}, ",
                    c.wave, c.offset, c.gain
                )?;
            }
            f.write_str("] },\n")?;
        }
        f.write_str("    ];\n\n    /// Waveforms, 1/65536 turn at gain 1.\n")?;
        writeln!(f, "    pub const WAVES: [[i16; {SAMPLES}]; WAVE_COUNT] = [")?;
        for wave in &tables.waves {
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
        f.write_str("    ];\n}\n")
    }
}

fn servo_literal(servo: &Servo) -> String {
    let (min, max) = servo.travel();
    format!(
        "Servo {{ pin: {}, neutral: {}, neutral_cycles: {}, gain: {}, min_sweep: {}, max_sweep: {} }}",
        servo.pin,
        (servo.neutral * STEPS_PER_DEGREE).round() as u32 as u16,
        (servo.neutral_us * CYCLES_PER_US).round(),
        (servo.us_per_degree * CYCLES_PER_US / STEPS_PER_DEGREE * ONE_Q14).round(),
        ceil(min * STEPS_PER_DEGREE),
        floor(max * STEPS_PER_DEGREE),
    )
}

fn five_bar(bars: &FiveBar, slope: &str) -> String {
    let coupler = length(bars.coupler_left);
    format!(
        "FiveBar::new({}, {}, {}, Slope::new({coupler}, {slope}))",
        length(bars.base),
        length(bars.crank_left),
        length(bars.crank_right),
    )
}

/// The tables of coupler slopes: one serves both loops where the couplers of
/// head and tail are alike.
fn slopes(lizard: &Lizard) -> Vec<(&'static str, i64)> {
    let [head, tail] = End::ALL.map(|end| length(lizard.end(end).coupler_left));
    let mut slopes = vec![("HEAD_SLOPE", head), ("TAIL_SLOPE", tail)];
    slopes.dedup_by_key(|(_, coupler)| *coupler);
    slopes
}

fn robot_stroke(robot: &Robot) -> (f64, f64) {
    (robot.limits.stroke_min, robot.limits.stroke_max)
}

fn slider((min, max): (f64, f64), slider: &Slider) -> String {
    format!(
        "Slider {{ offset: {}, base: {}, front: {}, rear: {}, nominal: {}, min: {}, max: {} }}",
        length(slider.offset),
        length(slider.base),
        length(slider.front),
        length(slider.rear),
        length(slider.nominal),
        ceil((slider.nominal + min) * STEPS_PER_MM),
        floor((slider.nominal + max) * STEPS_PER_MM),
    )
}

fn length(mm: f64) -> i64 {
    (mm * STEPS_PER_MM).round() as i64
}

fn q15(margin: f64) -> i64 {
    ceil(margin * ONE_Q15)
}

fn ceil(value: f64) -> i64 {
    (value - SLACK).ceil() as i64
}

fn floor(value: f64) -> i64 {
    (value + SLACK).floor() as i64
}
