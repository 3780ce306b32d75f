//! Tests of the servo pulses while interrupts are blocked for at most [`MAX_BLOCKED_CYCLES`] cycles, and for longer.

use fastrand::Rng;
use lizard_host::sim::frame::{FRAME_CYCLES, Frame};
use lizard_host_tests::pulse_widths;
use simulated_uno::{CYCLES_PER_MS, max_pins_high};

use crate::pulses::servo_edges;
use crate::reference_run::{ReferenceRun, SLOT_CYCLES};
use crate::{neutral_widths, start_in_both_simulations};

/// Longest time for which other handlers and code with interrupts disabled may delay a servo interrupt, cycles.
const MAX_BLOCKED_CYCLES: u64 = 160;

/// An interval of `length` cycles in which interrupts are blocked. The interval begins `cycles_before_edge` cycles
/// before an edge.
#[derive(Clone, Copy, Debug)]
struct BlockedInterval {
    cycles_before_edge: u64,
    length: u64,
}

/// An edge of each servo's pulse.
#[derive(Clone, Copy)]
enum PulseEdge {
    Rising,
    Falling,
}

/// Runs one frame for each blocked interval, which delays the chosen edges of all servos. Returns the frames, each with
/// its expected widths.
fn run_blocked_frames(
    run: &mut ReferenceRun,
    edges: &[PulseEdge],
    intervals: &[BlockedInterval],
) -> Vec<(Frame, [u64; 4])> {
    let start = run.run_to_next_frame();
    let expected_widths = run.expected_widths(start, intervals.len());
    for (frame_index, (interval, expected)) in intervals.iter().zip(expected_widths).enumerate() {
        for (servo, width) in expected.into_iter().enumerate() {
            let rise = start + frame_index as u64 * FRAME_CYCLES + servo as u64 * SLOT_CYCLES;
            for edge in edges {
                let cycle = match edge {
                    PulseEdge::Rising => rise,
                    PulseEdge::Falling => rise + width,
                };
                run.run_to(cycle - interval.cycles_before_edge);
                run.bench.uno.block_interrupts(interval.length);
            }
        }
    }
    run.run_to(start + intervals.len() as u64 * FRAME_CYCLES - SLOT_CYCLES / 2);
    let frames = run.frames_since(start);
    let count = frames.len();
    assert_eq!(count, intervals.len(), "not every interval has a frame");
    frames
}

/// Returns blocked intervals of this length, from an interval that begins at the edge to an interval that begins just
/// less than `max_start` cycles before the edge. The starts are `step` cycles apart.
fn generate_intervals(length: u64, max_start: u64, step: usize) -> Vec<BlockedInterval> {
    let starts = (0..max_start).step_by(step);
    let to_interval = |cycles_before_edge| BlockedInterval {
        cycles_before_edge,
        length,
    };
    starts.map(to_interval).collect()
}

/// Delays one edge of each pulse of a standing robot by blocked intervals of several lengths above
/// [`MAX_BLOCKED_CYCLES`], each of which begins at the edge, ends before the edge or begins between these times. Checks
/// that about half of the edges are late and counted. `is_possible` decides whether a late edge can give this width.
fn assert_late_edges_counted(
    edge: PulseEdge,
    is_possible: impl Fn(&BlockedInterval, Option<u64>, u64) -> bool + Sync,
) {
    start_in_both_simulations(ReferenceRun::start_standing, |mut run| {
        let lengths = [200, 230, 300, 500, 900].into_iter();
        let intervals = lengths.flat_map(|length| generate_intervals(length, length + 300, 7));
        let intervals: Vec<BlockedInterval> = intervals.collect();
        let mut late_count = 0;
        let frames = run_blocked_frames(&mut run, &[edge], &intervals);
        for (interval, (frame, expected)) in intervals.iter().zip(frames) {
            for (sent, expected) in frame.widths.into_iter().zip(expected) {
                let is_late = sent != Some(expected);
                late_count += u64::from(is_late);
                let is_allowed = !is_late || is_possible(interval, sent, expected);
                assert!(is_allowed, "{interval:?}: {frame:?}");
            }
        }
        // A quarter to three quarters of the edges are late.
        let edge_count = 4 * intervals.len() as u64;
        let is_about_half = (edge_count / 4..edge_count * 3 / 4).contains(&late_count);
        assert!(is_about_half, "{late_count} of {edge_count} edges are late");
        assert_eq!(run.late_edge_count(), late_count);
    });
}

#[test]
fn interrupts_blocked_for_the_allowed_time_move_no_edge() {
    start_in_both_simulations(ReferenceRun::start_walking, |mut run| {
        let intervals = generate_intervals(MAX_BLOCKED_CYCLES, 450, 1);
        let edges = [PulseEdge::Rising, PulseEdge::Falling];
        let frames = run_blocked_frames(&mut run, &edges, &intervals);
        for (interval, (frame, expected)) in intervals.iter().zip(frames) {
            let widths = frame.all_widths();
            assert_eq!(widths, Some(expected), "{interval:?}: {frame:?}");
        }
        assert_eq!(run.late_edge_count(), 0);
    });
}

// A late edge is a fault that stops a gait, so the robot stands in the following tests.

#[test]
fn a_late_rising_edge_drops_its_pulse_and_is_counted() {
    assert_late_edges_counted(PulseEdge::Rising, |_, sent, _| sent.is_none());
}

#[test]
fn a_late_falling_edge_occurs_at_once_and_is_counted() {
    assert_late_edges_counted(PulseEdge::Falling, |interval, sent, expected| {
        // After the blocked interval, the handler's prologue takes up to 90 cycles.
        let max_delay = (interval.length + 90).saturating_sub(interval.cycles_before_edge);
        sent.is_some_and(|width| (expected..=expected + max_delay).contains(&width))
    });
}

#[test]
fn interrupts_blocked_for_most_of_a_slot_drop_only_its_pulse() {
    start_in_both_simulations(ReferenceRun::start_standing, |mut run| {
        for (servo, length) in (0..4).zip([20_000, 30_000, 45_000, 62_000]) {
            let start = run.run_to_next_frame();
            let late_count_before = run.late_edge_count();
            run.run_to(start + servo * SLOT_CYCLES - 600);
            run.bench.uno.block_interrupts(length);
            run.run_to(start + 3 * FRAME_CYCLES - SLOT_CYCLES / 2);
            for (frame, commanded) in run.frames_since(start) {
                let mut expected = commanded.map(Some);
                if frame.start == start {
                    expected[servo as usize] = None;
                }
                assert_eq!(frame.widths, expected, "A{} and {length}", servo + 1);
                // Each pulse starts exactly at the start of its slot.
                for (slot, pulse_start) in (0..).zip(frame.pulse_starts) {
                    let slot_start = frame.start + slot * SLOT_CYCLES;
                    let is_exact = pulse_start.is_none_or(|start| start == slot_start);
                    assert!(is_exact, "{frame:?}");
                }
            }
            assert_eq!(run.late_edge_count(), late_count_before + 1);
        }
    });
}

#[test]
fn a_missed_falling_edge_occurs_when_the_next_slot_begins() {
    start_in_both_simulations(ReferenceRun::start_standing, |mut run| {
        let pins = run.bench.pins();
        let neutral = neutral_widths();
        // The blocked interval ends between 220 cycles before the next slot's edge and 360 cycles after it.
        for excess_cycles in (0..600).step_by(20) {
            for servo in 0..4 {
                run.bench.run_for_frames(1);
                run.bench.uno.take_edges();
                let servo_pin = pins[servo];
                let uno = &mut run.bench.uno;
                assert!(uno.run_until(2 * FRAME_CYCLES, 100, |uno| uno.is_high(servo_pin)));
                uno.run_cycles(neutral[servo] - 500);
                let edges = uno.edges();
                let rise_cycle = edges.last().expect("the pulse has risen").cycle;
                let end_cycle = rise_cycle + SLOT_CYCLES - 220 + excess_cycles;
                uno.block_interrupts(end_cycle - uno.cycle());
                let late_count_before = run.late_edge_count();
                run.bench.run_ms(40);
                let message = format!("A{} and {excess_cycles}", servo + 1);
                assert_eq!(run.late_edge_count(), late_count_before + 1, "{message}");
                let widths = pulse_widths(&run.bench.uno, servo_pin);
                let allowed_widths = SLOT_CYCLES - 300..SLOT_CYCLES + excess_cycles + 100;
                assert!(allowed_widths.contains(&widths[0]), "{message}: {widths:?}");
                let are_neutral = widths[1..].iter().all(|width| *width == neutral[servo]);
                assert!(are_neutral, "{message}");
                // No other servo misses its pulse.
                let edges = servo_edges(&run.bench);
                let rises = edges.iter().filter(|edge| edge.is_rising);
                let mut rise_pins = rises.map(|edge| edge.pin);
                assert!(rise_pins.any(|pin| pin == servo_pin));
                let next_pins = (1..8).map(|n| pins[(servo + n) % 4]);
                assert!(rise_pins.take(7).eq(next_pins), "{message}");
            }
        }
    });
}

#[test]
fn milliseconds_without_interrupts_shorten_no_pulse_and_never_raise_two_pins_at_once() {
    start_in_both_simulations(ReferenceRun::start_standing, |mut run| {
        let mut rng = Rng::with_seed(5);
        for _ in 0..200 {
            run.bench.run_for_frames(0);
            run.bench.uno.run_cycles(rng.u64(..FRAME_CYCLES));
            let length = rng.u64(1_000..5 * CYCLES_PER_MS);
            run.bench.uno.block_interrupts(length);
            run.bench.run_ms(30);
            let pins = run.bench.pins();
            let edges = servo_edges(&run.bench);
            assert_eq!(max_pins_high(&edges), 1);
            for (pin, neutral) in pins.into_iter().zip(neutral_widths()) {
                for pulse in run.bench.uno.pulses(pin) {
                    // In the worst case, interrupts are enabled again in the middle of the next slot.
                    let max_width = neutral.max(SLOT_CYCLES + 300).max(neutral + length);
                    let is_allowed = (neutral..=max_width).contains(&pulse.width);
                    assert!(is_allowed, "{pin}: {pulse:?} after {length} cycles");
                }
            }
        }
        for frame in run.bench.run_for_frames(3) {
            assert_eq!(frame.expect_all_widths(), neutral_widths());
        }
    });
}
