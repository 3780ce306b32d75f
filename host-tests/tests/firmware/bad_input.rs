//! Robustness tests of the running image: floods of random bytes and of nearly valid lines at the serial line's full
//! rate, for 15 seconds each. The environment variable `LIZARD_FUZZ` multiplies this time.

use fastrand::Rng;
use lizard_core::memory::copies::{self, SavedState};
use lizard_core::memory::settings::Settings;
use lizard_core::virtual_board::Eeprom;
use lizard_host_tests::{CYCLES_PER_US, FirmwareBench, robot};
use simulated_uno::{CYCLES_PER_MS, EepromOperation, Fidelity};

use crate::baud_rate::ask_until_answered;
use crate::measurements::recorded_pulses;
use crate::{Status, boot_to_stand, end_flood, random_lines};

/// Bytes that the serial line carries per second.
const BYTES_PER_SECOND: usize = 11_520;

/// The duration of each flood, s.
const FLOOD_SECONDS: u64 = 15;

/// Sends the bytes that `next_bytes` makes for the duration of a flood. Checks the pulses every second, and the board
/// after the flood.
fn assert_harmless(mut next_bytes: impl FnMut(&mut Rng) -> Vec<u8>) {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    let mut rng = lizard_host_tests::rng(77);
    bench.uno.take_edges();
    let mut pulse_count = 0;
    for second in 0..lizard_host_tests::scaled_count(FLOOD_SECONDS) {
        let mut sent_bytes = Vec::new();
        while sent_bytes.len() < BYTES_PER_SECOND {
            sent_bytes.extend(next_bytes(&mut rng));
        }
        bench.uno.send(&sent_bytes);
        bench.run_ms(1000);
        for (pulses, servo) in recorded_pulses(&bench).iter().zip(robot().servos()) {
            let us_to_cycles = |us: f64| (us * CYCLES_PER_US).round() as u64;
            let allowed_cycles = us_to_cycles(servo.min_us) - 2..=us_to_cycles(servo.max_us) + 2;
            pulse_count += pulses.len();
            for pulse in pulses {
                let is_allowed = allowed_cycles.contains(&pulse.width);
                assert!(is_allowed, "{pulse:?} in second {second}");
            }
        }
        bench.uno.take_edges();
    }
    assert!(pulse_count > 0, "no servo had a pulse");
    let reset_count = bench.uno.reset_events().len();
    assert_eq!(reset_count, 1, "the board was reset after power-on");
    // Waits for the bytes that are still queued in the sender and in the robot.
    while bench.uno.unsent_byte_count() > 0 {
        bench.run_ms(1000);
    }
    end_flood(&mut bench);
    assert_unharmed(bench);
}

/// Checks that the console answers and the EEPROM is valid.
fn assert_unharmed(mut bench: FirmwareBench) {
    // Bytes outside ASCII may have made the robot change its baud rate.
    ask_until_answered(&mut bench);
    assert_eq!(bench.say("watch 0"), "ok watch 0");
    bench.run_ms(300);
    assert_eq!(bench.say("stand"), "ok stand");
    Status::read(&mut bench).assert_has("gait=stand");
    let firmware = robot().firmware();
    let contents = bench.uno.eeprom();
    let mut settings = Settings::for_robot(firmware);
    let saved_state = copies::load(firmware, &Eeprom::with_bytes(contents), &mut settings);
    let is_valid = matches!(saved_state, SavedState::Latest | SavedState::Blank);
    assert!(is_valid, "{saved_state:?}");
    // The bytes beyond the saved data stay blank.
    assert!(contents[192..].iter().all(|byte| *byte == 0xff));
    let operations = bench.uno.eeprom_operations();
    println!("{} EEPROM operations", operations.len());
    // An operation takes 3.4 ms.
    let is_separate = |pair: &[EepromOperation]| pair[1].cycle - pair[0].cycle > 3 * CYCLES_PER_MS;
    assert!(operations.windows(2).all(is_separate));
}

#[test]
fn random_bytes_at_full_rate_do_no_harm_to_the_running_image() {
    assert_harmless(|rng| {
        let random_byte = |rng: &mut Rng| if rng.u8(..24) == 0 { b'\n' } else { rng.u8(..) };
        (0..256).map(|_| random_byte(rng)).collect()
    });
}

#[test]
fn nearly_valid_lines_at_full_rate_do_no_harm_to_the_running_image() {
    assert_harmless(|rng| {
        let mut line = random_lines::nearly_valid_line(rng);
        line.push(b'\n');
        line
    });
}
