//! Test of the rule for the LED's patterns.

use lizard_rules::{MS, led};

#[test]
fn an_led_that_stops_changing_is_a_violation() {
    // For fault 1 the LED flashes every 1280 ms. Here it flashes twice and then stays dark.
    let edges_ms = [(0, true), (160, false), (1_280, true), (1_440, false)];
    let edges = edges_ms.map(|(ms, is_on)| (ms * MS, is_on));
    assert_eq!(led::check_pattern(&edges, 0, 2_500 * MS, 1), Ok(()));
    assert!(led::check_pattern(&edges, 0, 2_700 * MS, 1).is_err());
}
