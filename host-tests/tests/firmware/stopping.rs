//! Tests of `stop`, `rest` and waking. The lines are sent at many times, and the pulses are checked frame by frame.

use lizard_host::sim::frame::{FRAME_CYCLES, Frame, group_frames};
use lizard_host_tests::{CYCLES_PER_US, FirmwareBench, gait_commands, robot};
use simulated_uno::{CYCLES_PER_MS, Edge, Fidelity};

use crate::{
    boot_and_command, boot_to_stand, boot_to_walk, expect_answer, for_each_in_parallel,
    frame_widths, neutral_widths, pose_command, run_in_both_simulations, start_in_both_simulations,
};

/// Cycles between the interruptions of a gait. This is not a multiple of a frame, so the interruptions cover many
/// phases of the gait and of the frame.
const INTERRUPTION_INTERVAL_CYCLES: u64 = 1_237_331;

#[test]
fn stop_freezes_the_robot_within_one_frame_in_any_phase_of_a_gait() {
    run_in_both_simulations(|fidelity| {
        for gait in gait_commands().iter().skip(1).take(4) {
            for n in 0..12 {
                let mut bench = boot_and_command(gait, fidelity);
                bench.uno.run_cycles(n * INTERRUPTION_INTERVAL_CYCLES);
                bench.send("stop");
                while bench.uno.unsent_byte_count() > 0 {
                    bench.uno.run_cycles(100);
                }
                let arrival_cycle = bench.uno.cycle();
                let frames = bench.run_for_frames(20);
                let is_later = |frame: &&Frame| frame.start > arrival_cycle + FRAME_CYCLES;
                let later_frames = frames.iter().filter(is_later);
                let sent_widths: Vec<_> = later_frames.map(Frame::expect_all_widths).collect();
                assert!(sent_widths.len() >= 18);
                let are_equal = sent_widths.iter().all(|widths| *widths == sent_widths[0]);
                assert!(are_equal, "{gait} {n}");
            }
        }
    });
}

#[test]
fn rest_ends_the_pulses_within_two_frames_without_cutting_one_short() {
    let cases: Vec<(Fidelity, u64)> = [Fidelity::Stock, Fidelity::DataSheet]
        .into_iter()
        .flat_map(|fidelity| (0..12).map(move |n| (fidelity, n * INTERRUPTION_INTERVAL_CYCLES)))
        .collect();
    for_each_in_parallel(&cases, |&(fidelity, extra_cycles)| {
        let mut bench = boot_to_walk(fidelity);
        bench.uno.run_cycles(extra_cycles);
        let first_frame = bench.run_for_frames(1)[0];
        // The recorded edges still contain this frame; later edges follow.
        bench.uno.run_cycles(extra_cycles % FRAME_CYCLES);
        bench.send("rest");
        bench.run_ms(100);
        let edges = bench.uno.edges();
        let mut last_fall = 0;
        for (pin, servo) in bench.pins().into_iter().zip(robot().servos()) {
            let pulses = bench.uno.pulses(pin);
            let is_rise = |edge: &&Edge| edge.pin == pin && edge.is_rising;
            let rise_count = edges.iter().filter(is_rise).count();
            assert_eq!(pulses.len(), rise_count, "{pin} is left high");
            for pulse in &pulses {
                // Each pulse is complete and within the servo's travel.
                let us = pulse.width as f64 / CYCLES_PER_US;
                let allowed_us = servo.min_us - 1.0..=servo.max_us + 1.0;
                assert!(allowed_us.contains(&us), "{us} us at {extra_cycles}");
                last_fall = last_fall.max(pulse.start + pulse.width);
            }
        }
        let received = bench.uno.received_by_uno();
        let last_byte = received.last().expect("the robot has received a line");
        assert!(last_fall < last_byte.cycle + 2 * FRAME_CYCLES && last_fall > first_frame.start);
        let frames = bench.run_for_frames(50);
        assert!(frames.iter().all(Frame::is_silent));
    });
}

#[test]
fn servos_wake_one_after_another_a_tenth_of_a_second_apart() {
    let find_wake_frames = |frames: &[Frame]| -> [usize; 4] {
        std::array::from_fn(|servo| {
            let is_awake = |frame: &Frame| frame.widths[servo].is_some();
            let first_index = frames.iter().position(is_awake);
            let first_index = first_index.expect("the servo wakes");
            let mut later_frames = frames[first_index..].iter();
            assert!(later_frames.all(is_awake), "A{}", servo + 1);
            first_index
        })
    };
    run_in_both_simulations(|fidelity| {
        // After power-on, frames are counted from A1's first pulse.
        let mut bench = FirmwareBench::power_on(fidelity);
        bench.run_ms(1000);
        let first_rise = bench.first_pulse_cycle().expect("A1 has a pulse");
        assert!(first_rise < 300 * CYCLES_PER_MS);
        let frames = group_frames(&bench.uno.edges(), bench.pins(), first_rise, 40);
        assert_eq!(find_wake_frames(&frames), [0, 5, 10, 15]);

        let mut bench = boot_to_walk(fidelity);
        bench.say("stop");
        bench.run_ms(100);
        let pose = frame_widths(&bench.run_for_frames(1))[0];
        bench.say("rest");
        bench.run_ms(100);
        bench.send("stand");
        let frames = bench.run_for_frames(100);
        let [a1, a2, a3, a4] = find_wake_frames(&frames);
        assert_eq!([a2 - a1, a3 - a2, a4 - a3], [5, 5, 5]);
        // The servos wake in the pose in which they rested, and move to `stand` from this pose.
        for (servo, frame) in [a1, a2, a3, a4].into_iter().enumerate() {
            assert_eq!(frames[frame].widths[servo], Some(pose[servo]));
        }
        assert_eq!(frames[99].expect_all_widths(), neutral_widths());
    });
}

/// Returns a sweep from neutral for each servo, all of different sizes, with a maximum of `max_sweep_deg`.
fn scale_sweeps(max_sweep_deg: f64) -> [f64; 4] {
    [-1.0, 0.25, 0.8, -0.6].map(|fraction| max_sweep_deg * fraction)
}

#[test]
fn all_servos_reach_a_pose_together_and_within_the_slew_limit() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        // The pose is as far from neutral as the robot allows.
        let (sweeps, _) = [24.0, 16.0, 8.0, 4.0, 2.0]
            .map(scale_sweeps)
            .map(|sweeps| (sweeps, bench.say(&pose_command(sweeps))))
            .into_iter()
            .find(|(_, answer)| answer.starts_with("ok pose"))
            .expect("one of the poses is safe");
        bench.say("stand");
        bench.run_ms(3000);
        expect_answer(&mut bench, &pose_command(sweeps), "ok pose");
        let sent_widths = frame_widths(&bench.run_for_frames(150));
        let end_widths = sent_widths[149];
        for (i, servo) in robot().servos().iter().enumerate() {
            let goal_us = servo.pulse(servo.neutral + sweeps[i]);
            let goal = (goal_us * CYCLES_PER_US).round() as u64;
            let end = end_widths[i];
            // Rounding to hundredths of a degree and rounding to steps of 1/65536 turn cost a cycle or two each.
            assert!(end.abs_diff(goal) <= 4, "expected {goal} cycles, got {end}");
        }
        // The path is a straight line: at any time, each servo has covered the same fraction of its sweep.
        let to_sweep = |widths: [u64; 4]| -> [f64; 4] {
            std::array::from_fn(|i| widths[i] as f64 - neutral_widths()[i] as f64)
        };
        let full_sweep = to_sweep(end_widths);
        for widths in &sent_widths {
            let covered_sweep = to_sweep(*widths);
            for (covered, full) in covered_sweep.into_iter().zip(full_sweep) {
                let error = covered - covered_sweep[0] / full_sweep[0] * full;
                assert!(error.abs() <= 8.0, "{widths:?}");
            }
        }
        let max_step_deg = robot().speed_limits().slew / 50.0;
        for pair in sent_widths.windows(2) {
            for (i, servo) in robot().servos().iter().enumerate() {
                let max_step = max_step_deg * CYCLES_PER_US * servo.us_per_degree.abs();
                let step = pair[0][i].abs_diff(pair[1][i]) as f64;
                let number = i + 1;
                assert!(step <= max_step + 2.0, "A{number}: a step of {step} cycles");
            }
        }
    });
}
