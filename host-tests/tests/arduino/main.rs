//! Tests of the Arduino library in `arduino/`. `make arduino-test` compiles the library's examples and the sketches in
//! this folder in the same way as the Arduino IDE. The examples and the tests' own sketches run on the simulated UNO;
//! the edges of EightServos must match those of the Rust crate `servo-pulses`.

use lizard_host_tests::{
    FirmwareBench, decode_text, pulse_widths, read_file, root, timer1_handler_cycles,
};
use servo_pulses::{CYCLES_PER_US, frame_cycles};
use simulated_uno::{CYCLES_PER_MS, Edge, FREQUENCY, Fidelity, Pin, State, Uno};

/// The pins of the eight servos in the library's examples.
const PINS: [u8; 8] = [2, 3, 7, 8, 9, 12, 14, 19];

/// The text that a test sends repeatedly, without gaps.
const FLOOD: &[u8] = b"The quick brown fox jumps over the lazy dog. ";

/// Loads the sketch with this name, which is an example of the library or a sketch of the tests.
fn load_sketch(name: &str) -> Uno {
    let path = format!("target/arduino/{name}/{name}.ino.elf");
    Uno::load(root().join(path), Fidelity::DataSheet)
        .unwrap_or_else(|error| panic!("run `make arduino-test` to build {name}: {error}"))
}

/// Returns all edges of the servos' pins, each with the number of cycles since the first edge.
fn collect_relative_edges(uno: &Uno) -> Vec<(u64, Pin, bool)> {
    let is_servo = |edge: &&Edge| edge.pin != Pin::d(13);
    let edges: Vec<Edge> = uno.edges().iter().filter(is_servo).copied().collect();
    let first_cycle = edges.first().expect("there are edges").cycle;
    let to_relative_edge = |edge: &Edge| (edge.cycle - first_cycle, edge.pin, edge.is_rising);
    edges.iter().map(to_relative_edge).collect()
}

/// Records each pin's pulse widths in cycles for 10 s, while the sketch echoes bytes that arrive without gaps.
fn record_widths_in_flood<const N: usize>(uno: &mut Uno, pins: [u8; N]) -> [Vec<u64>; N] {
    uno.run_ms(100);
    uno.take_edges();
    uno.take_transmitted();
    uno.flood(FLOOD);
    uno.run_ms(10_000);
    assert_eq!(*uno.state(), State::Alive);
    let echoed_count = uno.transmitted().len();
    assert!(echoed_count > 100_000, "{echoed_count} bytes echoed");
    pins.map(|pin| pulse_widths(uno, Pin::arduino(pin)))
}

/// Returns the difference between the longest and the shortest width.
fn compute_jitter(widths: &[u64]) -> u64 {
    let [min, max] = [widths.iter().min(), widths.iter().max()];
    max.expect("there are pulses") - min.expect("there are pulses")
}

#[test]
fn edges_of_eight_servos_match_the_rust_engine_to_the_cycle() {
    let path = FirmwareBench::elf_path().with_file_name("examples/sweep.elf");
    let mut rust_uno = Uno::load(path, Fidelity::DataSheet)
        .unwrap_or_else(|error| panic!("run `make sweep` to build the example: {error}"));
    let mut cpp_uno = load_sketch("EightServos");
    for uno in [&mut rust_uno, &mut cpp_uno] {
        uno.run_ms(20_000);
    }
    let [rust_edges, cpp_edges] = [&rust_uno, &cpp_uno].map(collect_relative_edges);
    let frame_count = 20_000 * CYCLES_PER_MS / u64::from(frame_cycles(8));
    let common_count = rust_edges.len().min(cpp_edges.len());
    let min_count = (frame_count - 3) * 16;
    assert!(common_count as u64 >= min_count, "{common_count} edges");
    let first_difference = (0..common_count).find(|index| cpp_edges[*index] != rust_edges[*index]);
    let pair = first_difference.map(|index| (index, cpp_edges[index], rust_edges[index]));
    assert_eq!(pair, None, "the first differing edge (index, C++, Rust)");
}

#[test]
fn a_flood_of_serial_bytes_changes_no_width_by_even_one_cycle() {
    let mut uno = load_sketch("BesideSerial");
    // 90 degrees is the middle of the range between 544 and 2400 us.
    let expected_cycles = (544 + (2400 - 544) / 2) * u64::from(CYCLES_PER_US);
    for widths in record_widths_in_flood(&mut uno, PINS) {
        assert!(widths.len() > 440, "{} pulses", widths.len());
        assert!(
            widths.iter().all(|actual| *actual == expected_cycles),
            "not all widths are {expected_cycles} cycles: {widths:?}"
        );
    }
    assert_eq!(uno.overrun_count(), 0);
    let readme = read_file("arduino/ServoPulses/README.md");
    for (memory, bytes) in [
        ("flash", uno.image().flash_used()),
        ("static RAM", uno.image().static_ram().into()),
    ] {
        let row = format!("| {memory} of the whole sketch, bytes | {bytes} |");
        assert!(readme.contains(&row), "the README has no {row}");
    }
}

#[test]
#[ignore = "needs Arduino's Servo library: make arduino-test SERVO=folder"]
fn the_servo_library_has_jitter_in_the_same_flood() {
    for (name, allowed_jitters) in [("ServoBesideSerial", 50..200), ("BesideSerial", 0..1)] {
        let mut uno = load_sketch(name);
        let widths = record_widths_in_flood(&mut uno, PINS);
        let measured_jitters = widths.map(|widths| compute_jitter(&widths));
        let image = uno.image();
        println!(
            "{name}: jitter {measured_jitters:?} cycles, {} bytes of flash, {} bytes of RAM, {} cycles per second",
            image.flash_used(),
            image.static_ram(),
            timer1_handler_cycles(&uno) * FREQUENCY / uno.cycle()
        );
        let is_allowed = |jitter: &u64| allowed_jitters.contains(jitter);
        assert!(measured_jitters.iter().all(is_allowed));
    }
}

#[test]
fn a_late_pulse_is_left_out_and_no_pulse_is_too_short() {
    let mut uno = load_sketch("Late");
    uno.run_ms(10_000);
    let pulses = uno.pulses(Pin::d(9));
    // The sketch disables interrupts half of the time, so many of the 500 pulses are late.
    let count = pulses.len();
    assert!((100..400).contains(&count), "{count} pulses");
    for pulse in pulses {
        // A falling edge waits until interrupts are enabled again, at most 30 us.
        let width = pulse.width;
        assert!((24_000..24_500).contains(&width), "{width} cycles");
    }
    assert!(uno.is_high(Pin::d(13)), "the sketch reported no late edge");
}

#[test]
fn every_change_of_a_width_is_atomic_and_no_pulse_is_cut() {
    let mut uno = load_sketch("Restless");
    let [rewritten_widths, attached_widths] = record_widths_in_flood(&mut uno, [9, 14]);
    for width in [0x5dff, 0x5e00] {
        let widths = rewritten_widths.iter();
        let pulse_count = widths.filter(|actual| **actual == width).count();
        assert!(pulse_count > 20, "{pulse_count} pulses of {width} cycles");
    }
    let mut widths = rewritten_widths.iter();
    let torn_width = widths.find(|width| ![0x5dff, 0x5e00].contains(*width));
    assert_eq!(torn_width, None);
    let count = attached_widths.len();
    assert!(count > 20, "{count} pulses");
    assert_eq!(attached_widths.iter().find(|width| **width != 24_000), None);
}

#[test]
fn angles_and_widths_match_the_servo_library() {
    let mut uno = load_sketch("Ask");
    assert!(uno.run_until_line(100 * CYCLES_PER_MS));
    let printed_text = decode_text(&uno.take_transmitted());
    // For each of eight servos, the sketch prints the servo's index plus `attached()`, which is 1. For a ninth servo
    // and for pin 20, the sketch prints 255.
    assert_eq!(printed_text, "12345678255255\r\n");
    for (written_value, angle, width_us) in [
        (0, 0, 1000),
        (1, 1, 1005),
        (90, 90, 1500),
        (179, 179, 1994),
        (180, 180, 2000),
        (543, 180, 2000),
        (544, 0, 1000),
        (1250, 45, 1250),
        (2400, 180, 2000),
        (-20, 0, 1000),
    ] {
        let answer = uno.say(&written_value.to_string());
        let expected = Some(format!("{angle} {width_us}"));
        assert_eq!(answer, expected, "written value {written_value}");
        uno.run_ms(50);
        uno.take_edges();
        uno.run_ms(50);
        let widths = pulse_widths(&uno, Pin::d(2));
        assert!(!widths.is_empty());
        let expected = width_us * u64::from(CYCLES_PER_US);
        let are_expected = widths.iter().all(|width| *width == expected);
        assert!(are_expected, "written value {written_value}: {widths:?}");
        // All other servos are detached.
        assert!(uno.edges().iter().all(|edge| edge.pin == Pin::d(2)));
    }
}
