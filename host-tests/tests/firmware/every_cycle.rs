//! Test that a byte arriving at any cycle of a frame moves no edge and is not lost.

use lizard_host::sim::frame::FRAME_CYCLES;
use simulated_uno::Fidelity;

use crate::reference_run::ReferenceRun;
use crate::run_in_both_simulations;

#[test]
fn a_byte_at_any_cycle_of_a_frame_moves_no_edge_and_is_not_lost() {
    // The line is not a command, so the robot also sends answers. An answer takes a third of the time of a line, and
    // the main loop reads no byte until most of the answer has been sent.
    let line = format!("{}\n", "z".repeat(59));
    run_in_both_simulations(|fidelity| {
        // The interval between bytes, in cycles, is long enough for the main loop to fall asleep. In corrected simavr,
        // the bytes cover every cycle of a frame, because interval and frame have no common factor. In stock simavr,
        // the bytes cover every fifth cycle, because the common factor is five.
        let (byte_count, interval) = match fidelity {
            Fidelity::DataSheet => (FRAME_CYCLES, 3_001),
            Fidelity::Stock => (FRAME_CYCLES / 5, 3_005),
        };
        let mut run = ReferenceRun::start_walking(fidelity);
        let line_count_before = run.bench.lines().len();
        let start = run.run_to_next_frame();
        let first_byte_cycle = run.bench.uno.cycle();
        for n in 0..byte_count {
            run.run_to(first_byte_cycle + n * interval);
            let byte = line.as_bytes()[n as usize % line.len()];
            run.bench.uno.send(&[byte]);
        }
        run.bench.run_ms(40);
        let frame_count = run.assert_exact_since(start, "receiving") as u64;
        assert!(frame_count >= byte_count * interval / FRAME_CYCLES);
        assert_eq!(run.late_edge_count(), 0);
        assert_eq!(run.read_word("serial::LOST_BYTES"), 0);
        let answer_count = (run.bench.lines().len() - line_count_before) as u64;
        assert_eq!(answer_count, byte_count / line.len() as u64);
    });
}
