//! Test that the pulses of every robot in robots/ match the recorded pulses to the cycle.
//!
//! A robot's record is the number of edges at its servo pins in ten simulated minutes of random commands, and a digest
//! of these edges. A pulse that is one cycle longer or later, or on another pin, changes the digest. An intended change
//! to a robot's values or to a command's effect also changes the digest; in this case, replace the records with the
//! values that the failed test prints.

use lizard_host::sim::frame::{FRAME_CYCLES, servo_pins};
use lizard_host::sim::supplies;
use lizard_host_tests::{FirmwareBench, decode_text, load_named_robot, load_robots_from_files};
use lizard_robot::Robot;
use simulated_uno::{CYCLES_PER_MS, Edge, Fidelity, State, Uno};

use crate::{FRAMES_PER_SECOND, for_each_in_parallel};

/// A random number generator that no library update can change: xorshift64*, Vigna 2016.
struct Random(u64);

impl Random {
    /// Returns a random number below `end`.
    fn next_below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32) % end
    }

    /// Returns a random number between `min` and `max` hundredths, formatted with two decimals for the console.
    fn next_decimal(&mut self, min: i64, max: i64) -> String {
        let value = min + self.next_below((max - min) as u64 + 1) as i64;
        let sign = if value < 0 { "-" } else { "" };
        let magnitude = value.unsigned_abs();
        format!("{sign}{}.{:02}", magnitude / 100, magnitude % 100)
    }
}

/// Returns a random command, which is a gait in almost half of the cases.
fn random_command(random: &mut Random, robot: &Robot) -> String {
    let servo = 1 + random.next_below(4);
    let neutral_hundredths = |index: usize| (robot.servos()[index].neutral * 100.0).round() as i64;
    let random_pose_near = |random: &mut Random, max_offset: i64| {
        let random_angle = |index: usize| {
            let angle = neutral_hundredths(index);
            random.next_decimal(angle - max_offset, angle + max_offset)
        };
        let angles: Vec<String> = (0..4).map(random_angle).collect();
        format!("pose {}", angles.join(" "))
    };
    match random.next_below(32) {
        0..14 => {
            let gaits = robot.gaits();
            let gait = &gaits[random.next_below(gaits.len() as u64) as usize];
            gait.command()
        }
        14..17 => random_pose_near(random, 2_000),
        17 => random_pose_near(random, 6_000),
        18 => "stop".into(),
        19 => "rest".into(),
        20 | 21 => "stand".into(),
        22 => "center".into(),
        23 | 24 => format!("speed {}", 10 + random.next_below(91)),
        25 => format!("trim {servo} {}", random.next_decimal(-2_000, 2_000)),
        26 => {
            let neutral = neutral_hundredths(servo as usize - 1);
            let min = random.next_decimal(neutral - 9_000, neutral - 1_000);
            let max = random.next_decimal(neutral + 1_000, neutral + 9_000);
            format!("limit {servo} {min} {max}")
        }
        27 => format!("scale {servo} {}", random.next_decimal(500, 2_000)),
        28 => ["save", "load", "factory"][random.next_below(3) as usize].into(),
        29 => format!("deadman {}", 200 * random.next_below(10)),
        30 => "status".into(),
        _ => "help".into(),
    }
}

/// Runs a robot for ten minutes and returns the digest and the number of all servo edges.
fn run_and_digest(name: &str) -> (u64, u64) {
    let frame_count = 600 * FRAMES_PER_SECOND;
    let robot = load_named_robot(name);
    let mut uno = Uno::with_image(FirmwareBench::image_with(&robot), Fidelity::DataSheet);
    supplies::connect_healthy_robot(&mut uno, &robot);
    let pins = servo_pins(&robot);
    // Times are relative to the first pulse, because the time of the first pulse depends on the code.
    let has_risen = uno.run_until(500 * CYCLES_PER_MS, 1_000, |uno| uno.is_high(pins[0]));
    assert!(has_risen, "no pulse");
    let is_a1_rise = |edge: &&Edge| edge.is_rising && edge.pin == pins[0];
    let edges = uno.edges();
    let first_rise = edges.iter().find(is_a1_rise).expect("A1 has risen").cycle;
    let first_rise_ms = first_rise as f64 / CYCLES_PER_MS as f64;
    println!("{name}: the first pulse begins after {first_rise_ms:.3} ms");
    let mut random = Random(0x1234_5678_9abc_def1);
    let mut digest = 0xcbf2_9ce4_8422_2325u64;
    let mut edge_count = 0;
    let mut command_count = 0;
    // The first command comes when all servos are awake.
    let mut next_frame = 50;
    for frame in 0..frame_count {
        let start = first_rise + frame * FRAME_CYCLES;
        if frame == next_frame {
            // The line is sent far from the interrupt that starts a frame, 4 ms before A1's pulse may begin, and long
            // before the next line, so the frame in which the robot executes the line is certain.
            uno.run_until_cycle(start + random.next_below(8) * CYCLES_PER_MS);
            uno.send(random_command(&mut random, &robot).as_bytes());
            uno.send(b"\n");
            command_count += 1;
            next_frame += 16 + random.next_below(48);
        }
        uno.run_until_cycle(start + FRAME_CYCLES - FRAME_CYCLES / 10);
        assert_eq!(*uno.state(), State::Alive);
        let edges = uno.take_edges().into_iter();
        for edge in edges.filter(|edge| edge.cycle >= first_rise) {
            let Some(servo) = pins.iter().position(|pin| *pin == edge.pin) else {
                continue;
            };
            edge_count += 1;
            let pin_level = (servo as u64) << 1 | u64::from(edge.is_rising);
            // FNV-1a.
            for byte in ((edge.cycle - first_rise) << 3 | pin_level).to_le_bytes() {
                digest = (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
    let text = decode_text(&uno.transmitted());
    let answer_count = text.lines().filter(|line| !line.starts_with('#')).count();
    // The last command may have come too late for its answer.
    assert!(
        (command_count - 1..=command_count).contains(&answer_count),
        "{answer_count} answers to {command_count} commands"
    );
    println!("{name}: {command_count} commands, {edge_count} edges, {digest:#018x}");
    (digest, edge_count)
}

#[test]
fn the_pulses_of_every_robot_match_its_record() {
    // The large robot is the paper's robot scaled by 4/3, so its servos get the same pulses.
    let recorded = [
        ("grain", (0xa932_205f_0ec5_bed7, 187_804)),
        ("large", (0x3a1b_1df5_bc67_f514, 184_384)),
        ("own-gaits", (0xb28d_e650_7bf4_729a, 152_328)),
        ("paper", (0x3a1b_1df5_bc67_f514, 184_384)),
        ("unequal", (0xef9f_3060_6801_8a27, 164_444)),
    ];
    // The first robot is the robot under test.
    let file_robots = load_robots_from_files().into_iter().skip(1);
    let files: Vec<String> = file_robots.map(|named_robot| named_robot.name).collect();
    assert_eq!(
        files,
        recorded.map(|(name, _)| format!("{name}.toml")),
        "expected one record for each file"
    );
    for_each_in_parallel(&recorded, |(name, expected)| {
        let (digest, edge_count) = run_and_digest(name);
        assert_eq!(
            (digest, edge_count),
            *expected,
            "{name}: {digest:#018x}, {edge_count} edges"
        );
    });
}
