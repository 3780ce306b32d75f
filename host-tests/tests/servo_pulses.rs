//! Tests of the crate `servo-pulses` without the lizard's firmware. On the simulated UNO, the crate's example moves
//! eight servos during a flood of serial bytes.

use lizard_host_tests::{FirmwareBench, read_file, timer1_handler_cycles};
use servo_pulses::{CYCLES_PER_US, MIN_WIDTH_CYCLES, frame_cycles, max_width_cycles};
use simulated_uno::{CYCLES_PER_MS, Fidelity, Pin, State, Uno, max_pins_high};

/// The pins of the example's servos, in the order of the example.
const PINS: [u8; 8] = [2, 3, 7, 8, 9, 12, 14, 19];

/// Returns the width of a servo's pulse in a frame, cycles. According to the example's description, the width rises
/// from 1000 us to 2000 us and falls again, by a constant step per frame that is different for each servo.
fn compute_expected_width(servo: u64, frame: u64) -> u64 {
    // The example stores the position in 16 bits.
    let position = frame * (16 * servo + 5) % 65_536 % 32_000;
    32_000 - 16_000u64.abs_diff(position)
}

/// Loads the crate's example `sweep`.
fn load_sweep_example(fidelity: Fidelity) -> Uno {
    let elf = FirmwareBench::elf_path().with_file_name("examples/sweep.elf");
    Uno::load(&elf, fidelity)
        .unwrap_or_else(|error| panic!("run `make sweep` to build the example: {error}"))
}

#[test]
fn eight_servos_are_exact_to_the_cycle_during_a_flood_of_echoed_bytes() {
    for fidelity in [Fidelity::DataSheet, Fidelity::Stock] {
        let mut uno = load_sweep_example(fidelity);
        uno.run_ms(50);
        uno.take_edges();
        let text = b"The quick brown fox jumps over the lazy dog. ";
        uno.flood(text);
        uno.run_ms(10_000);
        uno.flood(b"");
        uno.run_ms(10_000);
        assert_eq!(*uno.state(), State::Alive);
        let frame_length_cycles = u64::from(frame_cycles(8));
        let mut servo_edges = uno.edges();
        servo_edges.retain(|edge| edge.pin != Pin::d(13));
        let high_count = max_pins_high(&servo_edges);
        assert_eq!(high_count, 1, "pins that are high at the same time");
        // The first two or three frames are not among the edges.
        let first_width = uno.pulses(Pin::arduino(PINS[0]))[0].width;
        let skipped_frame_count = (0..10)
            .find(|frame| compute_expected_width(0, *frame) == first_width)
            .expect("the first recorded frame is one of the first ten");
        for (servo, pin) in PINS.into_iter().enumerate() {
            let pulses = uno.pulses(Pin::arduino(pin));
            assert!(pulses.len() > 880, "{} pulses of pin {pin}", pulses.len());
            for (frame, pulse) in (skipped_frame_count..).zip(&pulses) {
                let expected = compute_expected_width(servo as u64, frame);
                assert_eq!(
                    pulse.width, expected,
                    "{fidelity:?}, pin {pin}, frame {frame}"
                );
            }
            for pair in pulses.windows(2) {
                // The rising edges are exactly one frame apart.
                let interval = pair[1].start - pair[0].start;
                assert_eq!(interval, frame_length_cycles, "{fidelity:?}, pin {pin}");
            }
        }
        let echo: Vec<u8> = uno.transmitted().iter().map(|sent| sent.value).collect();
        // The serial line was saturated in both directions. Stock simavr sends more slowly than it receives and
        // therefore loses bytes. The simulation according to the data sheet loses no byte.
        if fidelity == Fidelity::DataSheet {
            assert!(echo.len() > 115_000, "{} bytes", echo.len());
            let mut pairs = echo.iter().zip(text.iter().cycle());
            let wrong_index = pairs.position(|(byte, expected)| byte != expected);
            assert_eq!(wrong_index, None, "the first wrong byte of the echo");
            assert_eq!(uno.overrun_count(), 0);
            assert_eq!(uno.sent_byte_count(), echo.len() as u64);
        } else {
            assert!(echo.len() > 100_000, "{} bytes", echo.len());
        }
    }
}

#[test]
fn servo_pins_left_high_are_low_before_the_first_pulse() {
    let mut uno = load_sweep_example(Fidelity::DataSheet);
    let pins = PINS.map(|number| servo_pulses::Pin::arduino(number).expect("the UNO has the pin"));
    for pin in pins {
        uno.poke(u16::from(pin.port()), 0xff);
    }
    uno.run_ms(1);
    for pin in pins {
        let level = uno.peek(u16::from(pin.port())) & pin.mask();
        assert_eq!(level, 0, "{pin:?}");
    }
}

#[test]
fn the_led_toggles_every_sixteen_frames() {
    let mut uno = load_sweep_example(Fidelity::DataSheet);
    uno.run_ms(3_000);
    let blinks = uno.pulses(Pin::d(13));
    assert_eq!(blinks.len(), 4);
    for blink in blinks {
        let error = blink.width.abs_diff(16 * u64::from(frame_cycles(8)));
        assert!(error < CYCLES_PER_MS / 10, "{error} cycles");
    }
}

#[test]
fn the_costs_in_the_readme_match_the_example() {
    let mut uno = load_sweep_example(Fidelity::DataSheet);
    uno.run_ms(100);
    let cycles_before = timer1_handler_cycles(&uno);
    uno.run_cycles(100 * u64::from(frame_cycles(8)));
    let cycles_per_frame = (timer1_handler_cycles(&uno) - cycles_before) as f64 / 100.0;
    let readme = read_file("crates/pulses/README.md");
    let read_number = |name: &str| -> f64 {
        let prefix = format!("| {name}");
        let row = readme.lines().find(|line| line.starts_with(&prefix));
        let cell = row.and_then(|row| row.split('|').nth(2));
        let number = cell.and_then(|cell| cell.replace(' ', "").parse().ok());
        number.unwrap_or_else(|| panic!("the README has no number in a row {name}: {row:?}"))
    };
    // The tolerance is 2 %, because another compiler version may change the costs slightly.
    let assert_near = |name: &str, measured: f64| {
        let stated_value = read_number(name);
        let error = (measured - stated_value).abs();
        assert!(
            error <= stated_value / 50.0,
            "{name}: the README states {stated_value}, measured {measured}"
        );
    };
    assert_near("CPU cycles in handlers per frame", cycles_per_frame);
    let (flash_used, static_ram) = (uno.image().flash_used(), uno.image().static_ram());
    assert_near("flash of the whole program, bytes", flash_used.into());
    assert_near("static RAM of the whole program, bytes", static_ram.into());
}

#[test]
fn the_pulse_width_limits_allow_a_servos_full_travel() {
    let us_to_cycles = |us: u32| us * u32::from(CYCLES_PER_US);
    assert!(u32::from(MIN_WIDTH_CYCLES) <= us_to_cycles(400));
    let allows_2400_us = |count: usize| u32::from(max_width_cycles(count)) >= us_to_cycles(2_400);
    assert!((1..=8).all(allows_2400_us));
}
