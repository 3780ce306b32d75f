//! Robustness tests of the core, compiled for this machine. The inputs are two million random bytes, two million nearly
//! valid lines and two thousand EEPROM contents. Each line must get one answer, every pulse must be within the limits,
//! and the EEPROM must always be valid.
//!
//! The environment variable `LIZARD_FUZZ` multiplies the number of inputs.

use std::thread;

use fastrand::Rng;
use lizard_core::memory::record::CONTENT_BYTES;
use lizard_core::virtual_board::Eeprom;
use lizard_fuzz::ObservedBoard;
use lizard_host_tests::{robot, scaled_count};

#[path = "firmware/random_lines.rs"]
mod random_lines;

/// Number of random bytes or lines in a test. The test of EEPROM contents takes a thousandth of this number.
const INPUT_COUNT: u64 = 2_000_000;

/// Number of threads in a test.
const THREAD_COUNT: u64 = 2;

/// Runs a test on several threads. Each thread gets its own random numbers and an equal part of [`INPUT_COUNT`].
fn run_on_threads(test: impl Fn(&mut Rng, u64) + Sync) {
    let count = scaled_count(INPUT_COUNT) / THREAD_COUNT;
    thread::scope(|scope| {
        for thread_number in 0..THREAD_COUNT {
            let test = &test;
            let mut rng = lizard_host_tests::rng(1000 + thread_number);
            scope.spawn(move || test(&mut rng, count));
        }
    });
}

#[test]
fn millions_of_random_bytes_do_no_harm_to_the_core() {
    run_on_threads(|rng, count| {
        let mut board = ObservedBoard::power_on(robot(), Eeprom::blank());
        for byte_index in 0..count {
            // Line ends are more frequent than other bytes.
            let byte = if rng.u8(..32) == 0 { b'\n' } else { rng.u8(..) };
            board.send_byte(byte);
            if byte_index % 64 == 0 {
                board.run_frame();
            }
            if byte_index % 65_536 == 0 {
                board.assert_memory_is_valid();
            }
        }
        board.send_byte(b'\n');
        for byte in b"stop\n" {
            board.send_byte(*byte);
        }
        assert!(board.output().starts_with("ok ") || board.output().contains("err 7"));
    });
}

#[test]
fn millions_of_nearly_valid_lines_do_no_harm_to_the_core() {
    run_on_threads(|rng, count| {
        let mut board = ObservedBoard::power_on(robot(), Eeprom::blank());
        let mut accepted_count = 0u64;
        for line_index in 0..count {
            for byte in random_lines::nearly_valid_line(rng) {
                board.send_byte(byte);
            }
            board.send_byte(b'\n');
            accepted_count += u64::from(board.output().contains("ok "));
            if line_index % 16 == 0 {
                board.run_frame();
            }
            if line_index % 4_096 == 0 {
                board.assert_memory_is_valid();
            }
        }
        assert!(
            accepted_count > count / 4,
            "{accepted_count} of {count} lines accepted"
        );
    });
}

#[test]
fn thousands_of_eeprom_contents_do_no_harm_to_the_core() {
    run_on_threads(|rng, count| {
        for _ in 0..count / 1_000 {
            // Changes up to one byte, three bytes or most bytes.
            let change_count = [1, 3, 3 * CONTENT_BYTES][rng.usize(..3)];
            let mut input = [0; 3 * CONTENT_BYTES + 12];
            for _ in 0..change_count {
                input[rng.usize(..3 * CONTENT_BYTES)] = rng.u8(..);
            }
            let patch_count = rng.usize(..=4);
            rng.fill(&mut input[3 * CONTENT_BYTES..]);
            lizard_fuzz::check_memory(&input[..3 * CONTENT_BYTES + 3 * patch_count]);
        }
    });
}
