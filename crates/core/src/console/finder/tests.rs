//! Wrong bytes, commands and pauses, in all orders.

use super::*;
use crate::console::line::GARBLED;

/// Gives a finder these bytes and a pause; returns the rate it changes to, if any.
fn feed_and_pause(finder: &mut RateFinder, bytes: &[u8]) -> Option<Rate> {
    for byte in bytes {
        finder.note_byte(*byte);
        // A frame in which a byte came is no pause.
        assert_eq!(finder.end_frame(), None);
    }
    finder.end_frame()
}

#[test]
fn wrong_bytes_lead_through_all_rates_and_back_to_that_of_usb() {
    let mut finder = RateFinder::new(Rate::Fastest);
    let mut tried_rates = std::vec::Vec::new();
    for _ in 0..5 {
        assert_eq!(feed_and_pause(&mut finder, &[GARBLED; 3]), None);
        tried_rates.extend(feed_and_pause(&mut finder, &[0x80]).map(Rate::baud));
    }
    assert_eq!(tried_rates, [57_600, 38_400, 9_600, 115_200, 57_600]);
}

#[test]
fn text_of_any_kind_and_length_changes_no_rate() {
    let mut finder = RateFinder::new(Rate::Third);
    for _ in 0..1000 {
        let text: std::vec::Vec<u8> = (0..0x80).collect();
        assert_eq!(feed_and_pause(&mut finder, &text), None);
    }
}

#[test]
fn a_rate_that_has_carried_a_command_survives_31_wrong_bytes() {
    let mut finder = RateFinder::new(Rate::Slowest);
    for _ in 0..100 {
        assert!(finder.note_command(4));
        assert_eq!(feed_and_pause(&mut finder, &[GARBLED; 31]), None);
    }
    assert_eq!(feed_and_pause(&mut finder, &[GARBLED]), Some(Rate::Fastest));
    assert_eq!(
        feed_and_pause(&mut finder, &[GARBLED; 4]),
        Some(Rate::Half),
        "a guess stands 3"
    );
}

#[test]
fn noise_without_a_pause_changes_the_rate_once_it_pauses() {
    let mut finder = RateFinder::new(Rate::Fastest);
    assert_eq!(
        feed_and_pause(&mut finder, &[GARBLED; 10_000]),
        Some(Rate::Half)
    );
    assert_eq!(feed_and_pause(&mut finder, &[]), None, "and once only");
}

#[test]
fn a_guessed_rate_is_not_confirmed_by_a_word_of_three_letters() {
    for rate in Rate::ALL {
        let mut finder = RateFinder::new(rate);
        let is_of_usb = rate == Rate::Fastest;
        assert_eq!(finder.note_command(3), is_of_usb, "{rate:?}");
        assert!(finder.note_command(4));
        for _ in 0..3 {
            // Noise that does not change the rate does not make it a guess again.
            assert_eq!(feed_and_pause(&mut finder, &[GARBLED; 31]), None);
            assert!(finder.note_command(1), "{rate:?} has carried a command");
        }
    }
}
