//! Generator of nearly valid console lines: all commands, with arguments within or slightly beyond their ranges, often
//! with up to three random changes. A change inserts, removes or alters a byte, or cuts the line.

use fastrand::Rng;
use lizard_core::console::word::Word;
use lizard_host_tests::robot;

/// Returns a random number with at most two decimals, from the range between `min` and `max`, extended by a fifth at
/// each end.
fn random_number(rng: &mut Rng, min: f64, max: f64) -> String {
    let margin = (max - min) * 0.2;
    let number = min - margin + rng.f64() * (max - min + 2.0 * margin);
    match rng.u8(..4) {
        0 => format!("{number:.0}"),
        1 => format!("{number:.1}"),
        _ => format!("{number:.2}"),
    }
}

/// Returns a random angle near a servo's neutral angle, deg, as text.
fn random_angle(rng: &mut Rng, servo: usize) -> String {
    let neutral = robot().servos()[servo].neutral;
    let max_deg = [5.0, 30.0, 100.0][rng.usize(..3)];
    random_number(rng, neutral - max_deg, neutral + max_deg)
}

/// Returns a random line that is valid except that its numbers may be out of range.
fn random_valid_line(rng: &mut Rng) -> String {
    let gaits = robot().gaits();
    let random_gait = |rng: &mut Rng| gaits[rng.usize(..gaits.len())].command();
    let servo_index = rng.usize(..4);
    let servo_number = servo_index + 1;
    match rng.u8(..24) {
        0..5 => random_gait(rng),
        5 => "stop".into(),
        6 => "rest".into(),
        7 => "stand".into(),
        8 => format!("speed {}", random_number(rng, 10.0, 100.0)),
        9 | 10 => {
            let angles: Vec<String> = (0..4).map(|servo| random_angle(rng, servo)).collect();
            format!("pose {}", angles.join(" "))
        }
        11 => format!("speed {}", rng.u8(..)),
        12 => format!("watch {}", rng.u16(..300)),
        // Lines with long answers are rare.
        13 => match rng.u8(..16) {
            0 => ["help", "?"][rng.usize(..2)].into(),
            1 => "cal".into(),
            _ => "status".into(),
        },
        14 | 15 => format!("trim {servo_number} {}", random_number(rng, -20.0, 20.0)),
        16 => {
            let min = random_angle(rng, servo_index);
            format!(
                "limit {servo_number} {min} {}",
                random_angle(rng, servo_index)
            )
        }
        17 => format!("dir {servo_number} {}", ['+', '-'][rng.usize(..2)]),
        18 => format!("scale {servo_number} {}", random_number(rng, 5.0, 20.0)),
        19 => rng
            .choice(Word::ALL)
            .expect("the console has commands")
            .example()
            .into(),
        20 if rng.u8(..4) == 0 => "save".into(),
        20 | 21 => ["load", "factory"][rng.usize(..2)].into(),
        22 if rng.bool() => format!("boot {}", random_gait(rng)),
        22 => "boot rest".into(),
        _ => format!("deadman {}", random_number(rng, 0.0, 60_000.0)),
    }
}

/// Returns a random nearly valid line without its line end.
pub fn nearly_valid_line(rng: &mut Rng) -> Vec<u8> {
    let mut bytes = random_valid_line(rng).into_bytes();
    let change_count = [0, 0, 0, 1, 1, 2, 3][rng.usize(..7)];
    for _ in 0..change_count {
        let offset = rng.usize(..=bytes.len());
        match rng.u8(..5) {
            0 => bytes.insert(offset, rng.u8(..)),
            1 => bytes.insert(offset, b" .-+0159\x08\t"[rng.usize(..10)]),
            2 if offset < bytes.len() => {
                bytes.remove(offset);
            }
            3 if offset < bytes.len() => bytes[offset] ^= 1 << rng.u8(..8),
            _ => bytes.truncate(offset),
        }
    }
    // A line end within the bytes would make two lines.
    bytes.retain(|byte| !matches!(byte, b'\r' | b'\n'));
    bytes
}
