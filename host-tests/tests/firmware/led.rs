//! Test of the LED on D13, whose slow flashes show that the board is running.

use lizard_host::sim::frame::FRAME_CYCLES;
use lizard_host_tests::FirmwareBench;

use crate::measurements::led_edges;
use crate::start_in_both_simulations;

#[test]
fn the_led_is_lit_at_power_on_and_changes_every_32_frames() {
    start_in_both_simulations(FirmwareBench::power_on, |mut bench| {
        bench.run_ms(5000);
        let led_edges = led_edges(&bench);
        let first = led_edges[0];
        assert!(first.is_rising, "{first:?}");
        assert!(first.cycle < 3 * FRAME_CYCLES, "{first:?}");
        assert!(led_edges.len() >= 7, "{} changes in 5 s", led_edges.len());
        for (n, pair) in led_edges.windows(2).enumerate().skip(1) {
            assert_ne!(pair[0].is_rising, pair[1].is_rising);
            // The firmware sets the LED after computing the frame, whose duration varies.
            let interval = pair[1].cycle - pair[0].cycle;
            let is_regular = interval.abs_diff(32 * FRAME_CYCLES) < FRAME_CYCLES / 10;
            assert!(is_regular, "change {n}: {interval} cycles");
        }
    });
}
