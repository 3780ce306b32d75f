//! Tests of the rate detector with wrong bytes, commands and pauses.

use super::*;
use crate::console::line::GARBLED_BYTE;

/// Feeds `bytes`, followed by a pause, to a detector. Returns the rate to which the detector changes, if any.
fn feed_and_pause(detector: &mut RateDetector, bytes: &[u8]) -> Option<BaudRate> {
    for byte in bytes {
        detector.record_byte(*byte);
        // A frame in which a byte arrives is not a pause.
        assert_eq!(detector.end_frame(), None);
    }
    detector.end_frame()
}

#[test]
fn wrong_bytes_cycle_through_all_rates() {
    let mut detector = RateDetector::new(BaudRate::Fastest);
    let mut tried_rates = std::vec::Vec::new();
    for _ in 0..5 {
        assert_eq!(feed_and_pause(&mut detector, &[GARBLED_BYTE; 3]), None);
        tried_rates.extend(feed_and_pause(&mut detector, &[0x80]).map(BaudRate::baud));
    }
    assert_eq!(tried_rates, [57_600, 38_400, 9_600, 115_200, 57_600]);
}

#[test]
fn ascii_text_of_any_length_never_changes_the_rate() {
    let mut detector = RateDetector::new(BaudRate::Third);
    for _ in 0..1000 {
        let text: std::vec::Vec<u8> = (0..0x80).collect();
        assert_eq!(feed_and_pause(&mut detector, &text), None);
    }
}

#[test]
fn a_confirmed_rate_survives_31_wrong_bytes() {
    let mut detector = RateDetector::new(BaudRate::Slowest);
    for _ in 0..100 {
        assert!(detector.confirm_rate(4));
        assert_eq!(feed_and_pause(&mut detector, &[GARBLED_BYTE; 31]), None);
    }
    let new_rate = feed_and_pause(&mut detector, &[GARBLED_BYTE]);
    assert_eq!(new_rate, Some(BaudRate::Fastest));
    let new_rate = feed_and_pause(&mut detector, &[GARBLED_BYTE; 4]);
    let claim = "a guessed rate survives only 3 wrong bytes";
    assert_eq!(new_rate, Some(BaudRate::Half), "{claim}");
}

#[test]
fn many_wrong_bytes_change_the_rate_once_at_the_next_pause() {
    let mut detector = RateDetector::new(BaudRate::Fastest);
    let new_rate = feed_and_pause(&mut detector, &[GARBLED_BYTE; 10_000]);
    assert_eq!(new_rate, Some(BaudRate::Half));
    let new_rate = feed_and_pause(&mut detector, &[]);
    assert_eq!(new_rate, None, "the rate changes only once");
}

#[test]
fn four_bytes_confirm_a_guessed_rate_and_31_wrong_bytes_leave_it_confirmed() {
    for rate in BaudRate::ALL {
        let mut detector = RateDetector::new(rate);
        // The fastest rate is that of USB, which is not a guess.
        let is_usb_rate = rate == BaudRate::Fastest;
        assert_eq!(detector.confirm_rate(3), is_usb_rate, "{rate:?}");
        assert!(detector.confirm_rate(4));
        for _ in 0..3 {
            assert_eq!(feed_and_pause(&mut detector, &[GARBLED_BYTE; 31]), None);
            assert!(detector.confirm_rate(1), "{rate:?} is confirmed");
        }
    }
}
