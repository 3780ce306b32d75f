//! Tests of the servo settings, measured at the pins, and of the settings that survive a loss of power.

use lizard_host::sim::frame::FRAME_CYCLES;
use lizard_host_tests::{CYCLES_PER_US, robot};
use simulated_uno::{CYCLES_PER_MS, Fidelity, PowerCut, State};

use crate::measurements::{
    assert_no_leap, assert_no_leap_at, measure_widths, power_cycle, read_calibration,
    recorded_pulses, run_for_pulses, slew_limit,
};
use crate::reference_run::{ReferenceRun, SLOT_CYCLES};
use crate::{
    Status, boot_standing, first_moving_gait, neutral_widths, pose_command, run_in_both_simulations,
};

/// Returns A1's pulse width, cycles, for a trim, a gain (us per degree) and a sweep from neutral.
fn calibrated_width(trim_deg: f64, gain: f64, sweep_deg: f64) -> u64 {
    let servo = &robot().servos()[0];
    ((servo.neutral_us + gain * (trim_deg + sweep_deg)) * CYCLES_PER_US).round() as u64
}

/// Returns A1's gain, us per degree.
fn gain() -> f64 {
    robot().servos()[0].us_per_degree
}

/// Asserts that a pulse width (cycles) is the expected one, within the rounding of angles.
fn assert_near(width: u64, expected: u64, message: &str) {
    // An angle is stored in steps of 0.0055 deg and commanded with two decimals.
    assert!(
        width.abs_diff(expected) <= 4,
        "{message}: {width}, {expected}"
    );
}

#[test]
fn a_trim_turns_its_servo_alone_and_no_faster_than_the_slew_limit() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_standing(fidelity);
        let trim = [20, 10, 5, 2]
            .into_iter()
            .find(|trim| bench.say(&format!("trim 1 {trim}")) == format!("ok trim 1 {trim}"))
            .expect("some trim suits the gaits");
        bench.say("trim 1 0");
        bench.run_ms(500);
        bench.uno.take_edges();
        bench.say(&format!("trim 1 {trim}"));
        bench.run_ms(1000);
        let pulses = recorded_pulses(&bench);
        assert_no_leap(&pulses);
        assert!(
            pulses[0]
                .windows(2)
                .any(|pair| pair[0].width.abs_diff(pair[1].width) + 6 > slew_limit(0))
                || trim < 10,
            "no change reaches the slew limit"
        );
        let last_width = pulses[0].last().expect("A1 has a pulse").width;
        assert_near(
            last_width,
            calibrated_width(trim.into(), gain(), 0.0),
            "trimmed",
        );
        for (pulses, neutral) in pulses.iter().zip(neutral_widths()).skip(1) {
            assert!(pulses.iter().all(|pulse| pulse.width == neutral));
        }
        // The guard and `status` use the true angle.
        assert!((Status::read(&mut bench).pose()[0] - robot().servos()[0].neutral).abs() < 0.01);
    });
}

#[test]
fn a_new_scale_or_direction_shows_in_the_pulses_within_half_a_second() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_standing(fidelity);
        let gain_magnitude = gain().abs();
        bench.say(&pose_command([5.0, 0.0, 0.0, 0.0]));
        bench.run_ms(1000);
        assert_near(
            measure_widths(&mut bench)[0],
            calibrated_width(0.0, gain(), 5.0),
            "before",
        );
        let scale = gain_magnitude + 1.25;
        assert_eq!(
            bench.say(&format!("scale 1 {scale:.2}")),
            format!("ok scale 1 {scale:.2}")
        );
        bench.run_ms(500);
        let expected_width = calibrated_width(0.0, scale.copysign(gain()), 5.0);
        assert_near(measure_widths(&mut bench)[0], expected_width, "scaled");
        let other_direction = if gain() > 0.0 { '-' } else { '+' };
        assert_eq!(
            bench.say(&format!("dir 1 {other_direction}")),
            format!("ok dir 1 {other_direction}")
        );
        bench.uno.take_edges();
        bench.run_ms(500);
        let mut gains = robot().servos().each_ref().map(|servo| servo.us_per_degree);
        gains[0] = scale;
        assert_no_leap_at(&recorded_pulses(&bench), gains);
        let expected_width = calibrated_width(0.0, -scale.copysign(gain()), 5.0);
        assert_near(
            measure_widths(&mut bench)[0],
            expected_width,
            "in the other direction",
        );
    });
}

#[test]
fn limits_that_cut_off_a_gait_and_poses_beyond_a_limit_are_refused() {
    let mut bench = boot_standing(Fidelity::DataSheet);
    let neutral = robot().servos()[0].neutral;
    let calibration_before = read_calibration(&mut bench);
    let too_narrow_line = format!("limit 1 {:.2} {:.2}", neutral - 0.5, neutral + 0.5);
    if robot().gaits().iter().any(|gait| gait.has_movement()) {
        let refusal = bench.say(&too_narrow_line);
        assert!(refusal.starts_with("err 3 "), "{refusal}");
        assert_eq!(
            read_calibration(&mut bench),
            calibration_before,
            "a refused line has changed the calibration"
        );
    }
    let narrow_line = format!("limit 1 {:.2} {:.2}", neutral - 40.0, neutral + 40.0);
    assert_eq!(bench.say(&narrow_line), format!("ok {narrow_line}"));
    let refusal = bench.say(&pose_command([41.0, 0.0, 0.0, 0.0]));
    assert!(refusal.starts_with("err 3 "), "{refusal}");
}

#[test]
fn saved_settings_apply_from_the_first_pulse_after_power_on() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_standing(fidelity);
        bench.say("trim 1 1.5");
        bench.say("trim 3 -2");
        bench.say("deadman 2500");
        let calibration = read_calibration(&mut bench);
        assert_eq!(bench.say("save"), "ok save");
        bench.run_ms(500);
        let widths = measure_widths(&mut bench);
        assert_near(widths[0], calibrated_width(1.5, gain(), 0.0), "trimmed");
        power_cycle(&mut bench);
        bench.run_ms(700);
        // From the first pulse on, the widths are those of the saved settings.
        for (pulses, width) in recorded_pulses(&bench).iter().zip(widths) {
            assert!(pulses.len() > 10 && pulses.iter().all(|pulse| pulse.width == width));
        }
        assert_eq!(read_calibration(&mut bench), calibration);
        let lines = bench.lines();
        assert!(
            !lines[lines.len() - 12..]
                .iter()
                .any(|line| line.text.contains("calibration:")),
            "there is a note about the calibration although the memory is valid"
        );
    });
}

#[test]
fn load_factory_and_power_on_discard_unsaved_settings() {
    let mut bench = boot_standing(Fidelity::DataSheet);
    let factory_calibration = read_calibration(&mut bench);
    let refusal = bench.say("load");
    assert!(refusal.starts_with("err 9 "), "{refusal}");
    bench.say("trim 1 1");
    let saved_calibration = read_calibration(&mut bench);
    assert_eq!(bench.say("save"), "ok save");
    bench.say("trim 1 -1");
    assert_ne!(read_calibration(&mut bench), saved_calibration);
    assert_eq!(bench.say("load"), "ok load");
    assert_eq!(read_calibration(&mut bench), saved_calibration);
    bench.run_ms(500);
    assert_near(
        measure_widths(&mut bench)[0],
        calibrated_width(1.0, gain(), 0.0),
        "loaded",
    );
    assert_eq!(bench.say("factory"), "ok factory");
    assert_eq!(read_calibration(&mut bench), factory_calibration);
    bench.run_ms(500);
    assert_eq!(measure_widths(&mut bench), neutral_widths());
    power_cycle(&mut bench);
    assert_eq!(
        read_calibration(&mut bench),
        saved_calibration,
        "`factory` alone has saved settings"
    );
}

#[test]
fn a_save_writes_only_bytes_that_differ_one_at_a_time_and_loses_no_input() {
    run_in_both_simulations(|fidelity| {
        let mut run = ReferenceRun::start_walking(fidelity);
        for round in 1..=6 {
            run.bench.say(&format!("deadman {}", 50_000 + 257 * round));
            run.bench.send("save");
            for _ in 0..40 {
                run.bench.uno.send(b" ");
                run.bench.run_ms(3);
            }
            run.bench.run_ms(150);
            let lines = run.bench.lines();
            assert_eq!(
                lines.last().expect("the robot has answered").text,
                "ok save"
            );
        }
        let operations = run.bench.uno.eeprom_operations();
        if run.is_data_sheet_simulation() {
            assert!(operations.len() > 6 * 6, "{}", operations.len());
        }
        for operation in &operations {
            assert_ne!(
                operation.old_value, operation.new_value,
                "an unchanged byte is written"
            );
        }
        for pair in operations.windows(2) {
            assert!(
                pair[1].cycle - pair[0].cycle >= 3 * CYCLES_PER_MS,
                "two bytes are written at once"
            );
        }
        assert_eq!(run.late_edge_count(), 0);
        let status = Status::read(&mut run.bench);
        assert_eq!(status.number("rx_lost"), 0.0);
    });
}

#[test]
fn every_pulse_of_a_walk_is_exact_while_the_memory_is_written() {
    run_in_both_simulations(|fidelity| {
        let mut run = ReferenceRun::start_walking(fidelity);
        run.bench.say("deadman 54321");
        let start = run.run_to_next_frame();
        let operations_before = run.bench.uno.eeprom_operations().len();
        run.bench.send("save");
        // The serial line stays busy, since the main loop reads no byte until it has saved.
        for _ in 0..14 {
            run.bench.uno.send(b" \t ");
            run.run_to(run.bench.uno.cycle() + FRAME_CYCLES);
        }
        run.run_to(start + 40 * FRAME_CYCLES - SLOT_CYCLES / 2);
        let frames = run.frames_since(start);
        assert!(frames.len() >= 40);
        for (frame, expected) in frames {
            assert_eq!(frame.all_widths(), Some(expected), "{frame:?}");
        }
        assert_eq!(run.late_edge_count(), 0);
        if run.is_data_sheet_simulation() {
            assert!(run.bench.uno.eeprom_operations().len() > operations_before + 40);
        }
    });
}

#[test]
fn boot_begins_its_gait_three_seconds_after_power_on_unless_a_byte_comes() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_standing(fidelity);
        let gait = first_moving_gait();
        assert_eq!(
            bench.say(&format!("boot {gait}")),
            format!("ok boot {gait}")
        );
        assert_eq!(bench.say("save"), "ok save");
        power_cycle(&mut bench);
        let standing_pulses = run_for_pulses(&mut bench, 2900);
        let neutral = neutral_widths();
        for (pulses, width) in standing_pulses.iter().zip(neutral) {
            assert!(!pulses.is_empty() && pulses.iter().all(|pulse| pulse.width == width));
        }
        bench.run_ms(300);
        let last_line = bench
            .lines()
            .last()
            .expect("the robot has printed a note")
            .text
            .clone();
        assert_eq!(last_line, format!("# boot: {gait}"));
        assert_eq!(
            Status::read(&mut bench).text("gait"),
            gait.replace(' ', "-")
        );
        power_cycle(&mut bench);
        bench.run_ms(2000);
        bench.uno.send(b" ");
        for (pulses, width) in run_for_pulses(&mut bench, 4000).iter().zip(neutral) {
            assert!(!pulses.is_empty() && pulses.iter().all(|pulse| pulse.width == width));
        }
    });
}

/// Moves the robot to a pose near the neutral one and returns its pulse widths.
fn move_to_nearby_pose(bench: &mut lizard_host_tests::FirmwareBench) -> [u64; 4] {
    bench.say(&pose_command([6.0, -6.0, 6.0, -6.0]));
    bench.run_ms(1000);
    let widths = measure_widths(bench);
    assert!(widths.iter().zip(neutral_widths()).all(|(a, b)| *a != b));
    widths
}

#[test]
fn at_power_on_the_servos_wake_one_by_one_in_the_pose_of_the_last_rest() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_standing(fidelity);
        let rest_widths = move_to_nearby_pose(&mut bench);
        assert_eq!(bench.say("rest"), "ok rest");
        bench.run_ms(400);
        power_cycle(&mut bench);
        bench.run_ms(1500);
        let pulses = recorded_pulses(&bench);
        for servo in 0..4 {
            assert_eq!(pulses[servo][0].width, rest_widths[servo]);
            if servo > 0 {
                let interval = pulses[servo][0].start - pulses[servo - 1][0].start;
                assert_eq!(
                    interval,
                    5 * FRAME_CYCLES + SLOT_CYCLES,
                    "the servos do not wake a tenth of a second apart"
                );
            }
        }
        assert_no_leap(&pulses);
        assert_eq!(
            measure_widths(&mut bench),
            neutral_widths(),
            "the robot does not stand"
        );
        // The robot has moved since it rested, so its saved rest pose is no longer valid.
        power_cycle(&mut bench);
        bench.run_ms(300);
        let first_width = bench.uno.pulses(bench.pins()[0])[0].width;
        assert_eq!(first_width, neutral_widths()[0]);
    });
}

#[test]
fn a_power_cut_while_a_rest_is_saved_gives_that_pose_or_the_neutral_one() {
    let mut bench = boot_standing(Fidelity::DataSheet);
    let blank_eeprom = bench.uno.eeprom();
    let rest_widths = move_to_nearby_pose(&mut bench);
    let operations_before = bench.uno.eeprom_operations().len();
    bench.say("rest");
    bench.run_ms(400);
    let operation_count = bench.uno.eeprom_operations().len() - operations_before;
    assert!(operation_count > 10, "{operation_count}");
    let mut neutral_and_rest_counts = [0, 0];
    for operation in 0..operation_count as u64 {
        for (stuck_bits, is_in_write) in [(0, true), (0x5a, true), (0x33, false)] {
            bench.uno.set_eeprom(&blank_eeprom);
            power_cycle(&mut bench);
            bench.run_ms(500);
            move_to_nearby_pose(&mut bench);
            let cut = if is_in_write {
                PowerCut::InWrite(operation)
            } else {
                PowerCut::InErase(operation)
            };
            bench.uno.cut_power(cut, stuck_bits);
            bench.say("rest");
            bench.uno.run_ms(400);
            assert_eq!(*bench.uno.state(), State::Off);
            power_cycle(&mut bench);
            bench.run_ms(600);
            let first_widths = recorded_pulses(&bench).map(|pulses| pulses[0].width);
            assert!(
                first_widths == rest_widths || first_widths == neutral_widths(),
                "byte {operation}, {stuck_bits:02x}: {first_widths:?}"
            );
            neutral_and_rest_counts[usize::from(first_widths == rest_widths)] += 1;
        }
    }
    assert!(
        neutral_and_rest_counts[0] > neutral_and_rest_counts[1] && neutral_and_rest_counts[1] > 0,
        "{neutral_and_rest_counts:?}"
    );
}
