//! Tests of the firmware with a missing or damaged robot section in flash: the firmware sends no pulse, and its console
//! and LED show the reason. The tests in `tests/section/damaged.rs` flip every bit. Here the firmware itself reads
//! the chip's flash, where no bounds checking stops a read beyond the section.

use std::mem::offset_of;

use lizard_core::console::word::Word;
use lizard_core::numbers::section::{
    FORMAT, Header, Numbers, REGION_BYTES, START_ADDRESS, write_checksum,
};
use lizard_host::board::SimulatedBoard;
use lizard_host_tests::{FRAME_CYCLES, FirmwareBench, load_named_robot, rng, robot};
use simulated_uno::{CYCLES_PER_MS, Fidelity, Pin};

use crate::measurements::{LED_PIN, led_edges};
use crate::{first_moving_gait, for_each_in_parallel, pose_command, run_in_both_simulations};

const MISSING_ROBOT_NOTE: &str = "# fault: no robot in the flash; write one";
const OTHER_VERSION_NOTE: &str =
    "# fault: the robot in the flash is for another version; write it again";
const DAMAGED_ROBOT_NOTE: &str = "# fault: the robot in the flash is damaged; write it again";

/// Bytes in flash in place of a valid section, and the line that reports them.
struct DamagedSection {
    description: String,
    section: Vec<u8>,
    /// The only line that reports the damage.
    expected_note: &'static str,
}

impl std::fmt::Debug for DamagedSection {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.description)
    }
}

/// Returns the robot's section with a change.
fn damage_section(
    description: impl Into<String>,
    expected_note: &'static str,
    change: impl FnOnce(&mut Vec<u8>),
) -> DamagedSection {
    let mut section = robot().section();
    change(&mut section);
    DamagedSection {
        description: description.into(),
        section,
        expected_note,
    }
}

/// Returns the robot's section with these bytes from an offset in the numbers on, and with a correct checksum.
fn damage_numbers(description: &str, offset: usize, bytes: &[u8]) -> DamagedSection {
    let start = size_of::<Header>() + offset;
    damage_section(description, DAMAGED_ROBOT_NOTE, |section| {
        section[start..start + bytes.len()].copy_from_slice(bytes);
        write_checksum(section);
    })
}

/// Returns sections that are missing, truncated, random or for another version.
fn build_unusable_sections() -> Vec<DamagedSection> {
    let mut sections = vec![
        damage_section("erased flash", MISSING_ROBOT_NOTE, Vec::clear),
        damage_section("zeros", MISSING_ROBOT_NOTE, |section| {
            *section = vec![0; REGION_BYTES.into()];
        }),
        damage_section("random bytes", MISSING_ROBOT_NOTE, |section| {
            *section = vec![0; REGION_BYTES.into()];
            rng(160).fill(section);
        }),
    ];
    let length = robot().section().len();
    let header_bytes = size_of::<Header>();
    for (end, note) in [
        (3, MISSING_ROBOT_NOTE),
        (5, OTHER_VERSION_NOTE),
        (7, DAMAGED_ROBOT_NOTE),
        (header_bytes, DAMAGED_ROBOT_NOTE),
        (header_bytes + size_of::<Numbers>() + 1, DAMAGED_ROBOT_NOTE),
        (length / 2, DAMAGED_ROBOT_NOTE),
        (length - 30, DAMAGED_ROBOT_NOTE),
    ] {
        let description = format!("cut at byte {end}");
        sections.push(damage_section(description, note, |section| {
            section.truncate(end)
        }));
    }
    for format in [0, FORMAT - 1, FORMAT + 1, 0xffff] {
        let description = format!("version {format}");
        sections.push(damage_section(description, OTHER_VERSION_NOTE, |section| {
            section[4..6].copy_from_slice(&format.to_le_bytes());
        }));
    }
    sections
}

/// Returns sections with one flipped bit each: one for each field of the header, and one for each of forty parts of the
/// remaining section.
fn build_sections_with_flipped_bit() -> Vec<DamagedSection> {
    let rng = &mut rng(161);
    let header_bytes = size_of::<Header>();
    let rest_bytes = robot().section().len() - header_bytes;
    let mut starts = vec![
        offset_of!(Header, magic),
        offset_of!(Header, format),
        offset_of!(Header, length),
        offset_of!(Header, crc),
        offset_of!(Header, name),
        offset_of!(Header, hash),
        offset_of!(Header, servo_hash),
    ];
    starts.extend((0..=40).map(|n| header_bytes + n * rest_bytes / 40));
    let flip = |(part, bounds): (usize, &[usize])| {
        let (byte, bit) = (rng.usize(bounds[0]..bounds[1]), rng.u8(..8));
        let expected_note = match part {
            0 => MISSING_ROBOT_NOTE, // in `magic`
            1 => OTHER_VERSION_NOTE, // in `format`
            _ => DAMAGED_ROBOT_NOTE,
        };
        let description = format!("bit {bit} of byte {byte}");
        damage_section(description, expected_note, |section| {
            section[byte] ^= 1 << bit;
        })
    };
    starts.windows(2).enumerate().map(flip).collect()
}

/// Returns sections with a correct checksum but invalid numbers.
fn build_invalid_sections() -> Vec<DamagedSection> {
    let pins = offset_of!(Numbers, pins);
    let calibration = offset_of!(Numbers, calibration);
    let numbers_bytes = robot().section().len() - size_of::<Header>();
    let second_pin = robot().firmware().pins()[1];
    vec![
        damage_numbers("a servo on the serial line", pins, &[1]),
        damage_numbers("two servos on one pin", pins, &[second_pin]),
        damage_numbers(
            "a rail on a pin that measures nothing",
            offset_of!(Numbers, rail_pin),
            &[20, 0],
        ),
        damage_numbers(
            "a neutral pulse that is too long for any servo",
            calibration,
            &60_000u16.to_le_bytes(),
        ),
        damage_numbers("a travel on one side of neutral", calibration + 4, &[5, 0]),
        damage_numbers("no cranks", offset_of!(Numbers, ends), &[0; 20]),
        damage_numbers("numbers with all bits one", 0, &vec![0xff; numbers_bytes]),
        damage_numbers("numbers with all bits zero", 0, &vec![0; numbers_bytes]),
    ]
}

/// Starts a board with this section in its flash.
fn boot_damaged_board(damaged: &DamagedSection, fidelity: Fidelity) -> FirmwareBench {
    let mut image = FirmwareBench::image();
    let addresses = u32::from(START_ADDRESS)..u32::from(START_ADDRESS) + u32::from(REGION_BYTES);
    let result = image.replace(addresses, &damaged.section);
    result.expect("the section fits");
    FirmwareBench(SimulatedBoard::with_image(image, fidelity, robot()))
}

/// Checks that the firmware finds no robot, sends no pulse and reports the damage.
fn assert_finds_no_robot(damaged: &DamagedSection) {
    let bench = &mut boot_damaged_board(damaged, Fidelity::DataSheet);
    bench.run_ms(300);
    let banner = format!("# lizard {} without a robot", env!("CARGO_PKG_VERSION"));
    let lines = bench.texts_from(0);
    assert!(lines[0].starts_with(&banner), "{lines:?}");
    assert_eq!(lines[1..], [damaged.expected_note]);
    // The firmware answers only queries, and refuses all other commands.
    let query_words = [Word::Help, Word::QuestionMark, Word::Status];
    let refused_words = Word::ALL.iter().filter(|word| !query_words.contains(word));
    let examples = refused_words.map(|word| word.example().to_owned());
    let moves = [first_moving_gait(), "stand".into(), pose_command([1.0; 4])];
    for line in moves.into_iter().chain(examples) {
        let (notes, answer) = bench.ask(&line);
        assert_eq!(answer, "err 10 no robot in the flash", "{line}");
        assert!(notes.is_empty(), "{line}: {notes:?}");
    }
    let (notes, answer) = bench.ask("help");
    assert_eq!(answer, "ok help");
    assert!(notes.len() < 10, "{notes:?}");
    // Waits until after the delay of `boot`.
    bench.run_ms(3_200);
    let (notes, status) = bench.ask("status");
    assert!(notes.is_empty(), "{notes:?}");
    // The status has no pose, margin or voltage, which would be meaningless without a robot.
    let expected = "ok gait=rest late=0 rx_lost=0 guard=clear fault=robot reset=power resets=0";
    assert_eq!(status, expected);
    let texts = bench.texts_from(0).into_iter();
    let fault_lines = texts.filter(|text| text.starts_with("# fault:"));
    assert_eq!(fault_lines.count(), 1, "number of fault reports");
    let mut edges = bench.uno.edges().into_iter();
    let other_edge = edges.find(|edge| edge.pin != LED_PIN);
    assert_eq!(other_edge, None, "a pin other than the LED's changed");
    for pin in (2..=12).chain(14..=19).map(Pin::arduino) {
        assert!(!bench.uno.is_high(pin), "{pin}");
    }
    assert_eq!(bench.uno.watchdog_reset_count(), 0);
    assert_eq!(bench.uno.reset_events().len(), 1);
    assert_eq!(bench.uno.eeprom_operations(), []);
    assert!(bench.uno.eeprom().iter().all(|byte| *byte == 0xff));
}

#[test]
fn without_a_complete_robot_there_is_no_pulse_and_the_console_names_the_reason() {
    for_each_in_parallel(&build_unusable_sections(), assert_finds_no_robot);
}

#[test]
fn with_a_flipped_bit_in_any_part_of_the_robot_there_is_no_pulse() {
    for_each_in_parallel(&build_sections_with_flipped_bit(), assert_finds_no_robot);
}

#[test]
fn impossible_numbers_move_no_servo_even_with_a_valid_checksum() {
    for_each_in_parallel(&build_invalid_sections(), assert_finds_no_robot);
}

/// This check is the only part of the start-up that a robot compiled into the firmware would not need.
#[test]
fn every_robots_section_is_checked_within_a_frame() {
    let names = ["grain", "large", "own-gaits", "paper", "unequal"];
    for_each_in_parallel(&names, |name| {
        let robot = load_named_robot(name);
        let image = FirmwareBench::image_with(&robot);
        let board = SimulatedBoard::with_image(image, Fidelity::DataSheet, &robot);
        let calls = FirmwareBench(board).time_calls("Robot::open", 200);
        assert_eq!(calls.len(), 1, "{name}: {calls:?}");
        let section_bytes = robot.section().len();
        let ms = calls[0].cycles() as f64 / CYCLES_PER_MS as f64;
        println!("{name}: {section_bytes} bytes in {ms:.1} ms");
        assert!(calls[0].cycles() < FRAME_CYCLES, "{name}: {calls:?}");
    });
}

#[test]
fn without_a_robot_the_led_flashes_eight_times_and_pauses() {
    run_in_both_simulations(|fidelity| {
        let bench = &mut boot_damaged_board(&build_unusable_sections()[0], fidelity);
        bench.run_ms(8_000);
        let led_edges = led_edges(bench);
        // For each interval, true if the LED was on, and the interval's length in frames.
        let durations = led_edges.windows(2).map(|pair| {
            let frames = (pair[1].cycle - pair[0].cycle) as f64 / FRAME_CYCLES as f64;
            (pair[0].is_rising, frames.round() as u64)
        });
        let durations: Vec<(bool, u64)> = durations.collect();
        let mut pattern = [(true, 8), (false, 8)].repeat(8);
        pattern[15] = (false, 56);
        // The first flash begins with the program, so it may be shorter.
        assert_eq!(durations[1..16], pattern[1..], "{durations:?}");
        assert_eq!(durations[16..32], pattern[..], "{durations:?}");
    });
}
