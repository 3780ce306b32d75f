//! Test with a received byte at every cycle of a frame: it moves no edge, and no byte is lost.

use lizard_host::sim::frame::FRAME;
use simulated_uno::Fidelity;

use crate::run_in_both_simulations;
use crate::walk::ReferenceRun;

/// Returns the number of bytes to send and the interval between two bytes in cycles, long enough for main to fall
/// asleep. With the data sheet's corrections, the bytes cover every cycle of a frame, since the interval and the
/// frame have no common factor. In stock simavr, they cover every fifth cycle, since the common factor is five.
const fn byte_count_and_interval(fidelity: Fidelity) -> (u64, u64) {
    match fidelity {
        Fidelity::DataSheet => (FRAME, 3_001),
        Fidelity::Stock => (FRAME / 5, 3_005),
    }
}

#[test]
fn a_byte_at_any_cycle_of_a_frame_moves_no_edge_and_is_not_lost() {
    // The line is no command, so that answers are sent, too. They take a third of the lines' time, and main takes
    // no byte until an answer is nearly sent.
    let line = format!("{}\n", "z".repeat(59));
    run_in_both_simulations(|fidelity| {
        let (byte_count, interval) = byte_count_and_interval(fidelity);
        let mut walk = ReferenceRun::start_walking(fidelity);
        let line_count_before = walk.bench.lines().len();
        let start = walk.next_frame();
        let begin_cycle = walk.bench.uno.cycle();
        for n in 0..byte_count {
            walk.run_to(begin_cycle + n * interval);
            let byte = line.as_bytes()[n as usize % line.len()];
            walk.bench.uno.send(&[byte]);
        }
        walk.bench.run_ms(40);
        let frames = walk.frames_since(start);
        assert!(frames.len() as u64 >= byte_count * interval / FRAME);
        for (frame, expected) in frames {
            assert_eq!(frame.all_widths(), Some(expected), "{frame:?}");
        }
        assert_eq!((walk.late_edge_count(), walk.word("serial::LOST")), (0, 0));
        let answers = (walk.bench.lines().len() - line_count_before) as u64;
        assert_eq!(answers, byte_count / line.len() as u64);
    });
}
