//! `stop`, `rest` and waking: what must be right at any moment, to the frame.

use lizard_host::sim::frame::{FRAME, Frame, frames as frames_of, servo_pins};
use lizard_host_tests::{FirmwareBench, robot};
use simulated_uno::{CYCLES_PER_MS, CYCLES_PER_US, Fidelity};

use crate::{awake, doing, for_each, in_both, widths};

/// Gaits to be interrupted, and every how many cycles: not a multiple of a frame's
/// fraction, so that many phases of gait and frame are met.
const GAITS: [&str; 4] = ["walk", "trot", "left", "look"];
const APART: u64 = 1_237_331;

/// Says a line at cycle `at` after a second of `gait`, and returns the bench and
/// the cycle at which the last byte of the line has arrived.
fn interrupt(gait: &str, line: &str, at: u64, fidelity: Fidelity) -> (FirmwareBench, u64) {
    let mut bench = doing(gait, fidelity);
    bench.uno.run_cycles(at);
    bench.send(line);
    while bench.uno.unsent() > 0 {
        bench.uno.run_cycles(100);
    }
    let arrived = bench.uno.cycle();
    (bench, arrived)
}

#[test]
fn stop_freezes_within_one_frame_from_any_phase_of_a_gait() {
    in_both(|fidelity| {
        for gait in GAITS {
            for n in 0..12 {
                let (mut bench, arrived) = interrupt(gait, "stop", n * APART, fidelity);
                let frames = bench.run_for_frames(20);
                let late = frames.iter().filter(|frame| frame.start > arrived + FRAME);
                let sent: Vec<_> = late.map(Frame::widths).collect();
                assert!(sent.len() >= 18);
                assert!(sent.iter().all(|widths| *widths == sent[0]), "{gait} {n}");
            }
        }
    });
}

#[test]
fn rest_ends_the_pulses_within_two_frames_and_cuts_none_short() {
    let cases: Vec<(Fidelity, u64)> = [Fidelity::Stock, Fidelity::DataSheet]
        .into_iter()
        .flat_map(|fidelity| (0..12).map(move |n| (fidelity, n * APART)))
        .collect();
    for_each(&cases, |&(fidelity, at)| {
        let mut bench = doing("walk", fidelity);
        bench.uno.run_cycles(at);
        let first = bench.run_for_frames(1)[0];
        // The frame before is still in `edges`; those from now on come after it.
        bench.uno.run_cycles(at % FRAME);
        bench.send("rest");
        bench.run_ms(100);
        let edges = bench.uno.edges();
        let mut last_fall = 0;
        for (servo, pin) in robot().servos().iter().map(|servo| servo.pin).enumerate() {
            let pulses = bench.uno.pulses(simulated_uno::Pin::d(pin));
            let ups = edges
                .iter()
                .filter(|edge| edge.pin.number() == pin && edge.high)
                .count();
            assert_eq!(pulses.len(), ups, "A{} is left high", servo + 1);
            for pulse in &pulses {
                // Whole pulses of a walk, which sweeps 20 deg either way.
                let us = pulse.width / CYCLES_PER_US;
                assert!((1299..=1701).contains(&us), "{us} us at {at}");
                last_fall = last_fall.max(pulse.start + pulse.width);
            }
        }
        let heard = bench.uno.received_by_uno();
        let arrived = heard.last().expect("a line").cycle;
        assert!(last_fall < arrived + 2 * FRAME && last_fall > first.start);
        assert!(
            bench
                .run_for_frames(50)
                .iter()
                .all(|frame| frame.is_silent())
        );
    });
}

#[test]
fn servos_wake_one_after_another_a_tenth_of_a_second_apart() {
    let woken = |frames: &[Frame]| -> [usize; 4] {
        std::array::from_fn(|servo| {
            let first = frames
                .iter()
                .position(|frame| frame.widths[servo].is_some());
            let first = first.expect("it wakes");
            let rest = &frames[first..];
            assert!(
                rest.iter().all(|frame| frame.widths[servo].is_some()),
                "A{}",
                servo + 1
            );
            first
        })
    };
    in_both(|fidelity| {
        // At power-on: frames are counted from A1's first pulse.
        let mut bench = FirmwareBench::power_on(fidelity);
        bench.run_ms(1000);
        let pins = servo_pins(robot());
        let first = bench.uno.pulses(pins[0])[0].start;
        assert!(first < 300 * CYCLES_PER_MS);
        let frames = frames_of(&bench.uno.edges(), pins, first, 40);
        assert_eq!(woken(&frames), [0, 5, 10, 15]);

        let mut bench = doing("walk", fidelity);
        bench.say("stop");
        bench.run_ms(100);
        let pose = widths(&bench.run_for_frames(1))[0];
        bench.say("rest");
        bench.run_ms(100);
        bench.send("stand");
        let frames = bench.run_for_frames(100);
        let [a1, a2, a3, a4] = woken(&frames);
        assert_eq!([a2 - a1, a3 - a2, a4 - a3], [5, 5, 5]);
        // They wake where they were, and stand up from there.
        for (servo, at) in [a1, a2, a3, a4].into_iter().enumerate() {
            assert_eq!(frames[at].widths[servo], Some(pose[servo]));
        }
        assert_eq!(frames[99].widths(), [24_000; 4]);
    });
}

#[test]
fn a_pose_is_reached_by_all_servos_together_and_not_too_fast() {
    in_both(|fidelity| {
        let mut bench = awake(fidelity);
        let target = [99.25, 41.5, 280.75, 230.0];
        assert!(
            bench
                .say("pose 99.25 41.5 280.75 230")
                .starts_with("ok pose")
        );
        let sent = widths(&bench.run_for_frames(60));
        let goal: [u64; 4] =
            std::array::from_fn(|i| (robot().servos()[i].pulse(target[i]) * 16.0).round() as u64);
        let end = sent[59];
        for (end, goal) in end.into_iter().zip(goal) {
            // The console's angle is held in steps of 1/65536 turn, .88 cycles.
            assert!(end.abs_diff(goal) <= 1, "{end}, not {goal}");
        }
        // Along a straight line: each servo has done the same share of its way.
        let whole = end.map(|end| end as f64 - 24_000.0);
        for widths in &sent {
            let gone = widths.map(|width| width as f64 - 24_000.0);
            for (gone_here, whole_here) in gone.into_iter().zip(whole) {
                let off = gone_here - gone[0] / whole[0] * whole_here;
                assert!(off.abs() <= 2.5, "{widths:?}");
            }
        }
        let most = robot().pace().slew / 50.0 * 160.0;
        for pair in sent.windows(2) {
            let mut steps = (0..4).map(|servo| pair[0][servo].abs_diff(pair[1][servo]));
            assert!(steps.all(|step| step as f64 <= most), "{pair:?}");
        }
    });
}
