//! Tests of the rate finder with wrong bytes, commands and pauses.

use super::*;
use crate::console::line::GARBLED_BYTE;

/// Feeds a finder these bytes and then a pause; returns the rate to which the finder changes, if any.
fn feed_and_pause(finder: &mut RateFinder, bytes: &[u8]) -> Option<BaudRate> {
    for byte in bytes {
        finder.note_byte(*byte);
        // A frame in which a byte arrives is not a pause.
        assert_eq!(finder.end_frame(), None);
    }
    finder.end_frame()
}

#[test]
fn wrong_bytes_lead_through_all_rates_in_a_cycle() {
    let mut finder = RateFinder::new(BaudRate::Fastest);
    let mut tried_rates = std::vec::Vec::new();
    for _ in 0..5 {
        assert_eq!(feed_and_pause(&mut finder, &[GARBLED_BYTE; 3]), None);
        tried_rates.extend(feed_and_pause(&mut finder, &[0x80]).map(BaudRate::baud));
    }
    assert_eq!(tried_rates, [57_600, 38_400, 9_600, 115_200, 57_600]);
}

#[test]
fn ascii_text_of_any_length_never_changes_the_rate() {
    let mut finder = RateFinder::new(BaudRate::Third);
    for _ in 0..1000 {
        let text: std::vec::Vec<u8> = (0..0x80).collect();
        assert_eq!(feed_and_pause(&mut finder, &text), None);
    }
}

#[test]
fn a_rate_that_has_carried_a_command_survives_31_wrong_bytes() {
    let mut finder = RateFinder::new(BaudRate::Slowest);
    for _ in 0..100 {
        assert!(finder.note_command(4));
        assert_eq!(feed_and_pause(&mut finder, &[GARBLED_BYTE; 31]), None);
    }
    let new_rate = feed_and_pause(&mut finder, &[GARBLED_BYTE]);
    assert_eq!(new_rate, Some(BaudRate::Fastest));
    assert_eq!(
        feed_and_pause(&mut finder, &[GARBLED_BYTE; 4]),
        Some(BaudRate::Half),
        "a guessed rate survives only 3 wrong bytes"
    );
}

#[test]
fn long_noise_changes_the_rate_once_in_the_pause_after_it() {
    let mut finder = RateFinder::new(BaudRate::Fastest);
    let new_rate = feed_and_pause(&mut finder, &[GARBLED_BYTE; 10_000]);
    assert_eq!(new_rate, Some(BaudRate::Half));
    assert_eq!(
        feed_and_pause(&mut finder, &[]),
        None,
        "the rate changes only once"
    );
}

#[test]
fn a_guessed_rate_is_not_confirmed_by_a_command_of_three_bytes() {
    for rate in BaudRate::ALL {
        let mut finder = RateFinder::new(rate);
        let is_usb_rate = rate == BaudRate::Fastest;
        assert_eq!(finder.note_command(3), is_usb_rate, "{rate:?}");
        assert!(finder.note_command(4));
        for _ in 0..3 {
            // Noise that does not change the rate does not turn it into a guess again.
            assert_eq!(feed_and_pause(&mut finder, &[GARBLED_BYTE; 31]), None);
            assert!(finder.note_command(1), "{rate:?} has carried a command");
        }
    }
}
