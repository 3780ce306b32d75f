//! Tests of the servo settings, measured at the pins, and of the settings saved across a loss of power.

use lizard_host::sim::frame::FRAME_CYCLES;
use lizard_host_tests::{CYCLES_PER_US, FirmwareBench, robot};
use simulated_uno::{CYCLES_PER_MS, Fidelity, PowerCut, State};

use crate::measurements::{
    assert_steady, assert_within_slew_limit, measure_widths, power_cycle, read_calibration,
    recorded_pulses, run_and_record_pulses, servo_scales, servo_slew_limit,
};
use crate::reference_run::{ReferenceRun, SLOT_CYCLES};
use crate::{
    Status, boot_to_stand, expect_answer, first_moving_gait, neutral_widths, pose_command,
    run_in_both_simulations, start_in_both_simulations,
};

/// Returns A1's pulse width in cycles for a trim, a scale and a sweep from neutral.
fn calibrated_width(trim_deg: f64, us_per_degree: f64, sweep_deg: f64) -> u64 {
    let servo = &robot().servos()[0];
    ((servo.neutral_us + us_per_degree * (trim_deg + sweep_deg)) * CYCLES_PER_US).round() as u64
}

/// Returns A1's scale, us per degree.
fn a1_us_per_degree() -> f64 {
    robot().servos()[0].us_per_degree
}

/// Asserts that a pulse width in cycles matches the expected width, except for the rounding of angles.
#[track_caller]
fn assert_near(width: u64, expected: u64, message: &str) {
    // An angle is stored in steps of 0.0055 deg and commanded with two decimals.
    crate::assert_near(width as f64, expected as f64, 4.0, message);
}

#[test]
fn a_trim_turns_only_its_servo_within_the_slew_limit() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        let trim = [20, 10, 5, 2]
            .into_iter()
            .find(|trim| bench.say(&format!("trim 1 {trim}")) == format!("ok trim 1 {trim}"))
            .expect("one of the trims is compatible with the gaits");
        bench.say("trim 1 0");
        bench.run_ms(500);
        bench.uno.take_edges();
        bench.say(&format!("trim 1 {trim}"));
        bench.run_ms(1000);
        let pulses = recorded_pulses(&bench);
        assert_within_slew_limit(&pulses, servo_scales());
        let steps = pulses[0].windows(2);
        let max_step = steps
            .map(|pair| pair[0].width.abs_diff(pair[1].width))
            .max();
        let has_fast_step = max_step.is_some_and(|step| step + 6 > servo_slew_limit(0));
        assert!(
            has_fast_step || trim < 10,
            "no step reaches the slew limit, the largest is {max_step:?}"
        );
        let last_width = pulses[0].last().expect("A1 has a pulse").width;
        let expected_width = calibrated_width(trim.into(), a1_us_per_degree(), 0.0);
        assert_near(last_width, expected_width, "trimmed");
        for (pulses, neutral) in pulses.iter().zip(neutral_widths()).skip(1) {
            assert!(pulses.iter().all(|pulse| pulse.width == neutral));
        }
        // The guard and `status` use the true angle.
        assert!((Status::read(&mut bench).pose()[0] - robot().servos()[0].neutral).abs() < 0.01);
    });
}

#[test]
fn a_new_scale_or_direction_changes_the_pulses_within_half_a_second() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        bench.say(&pose_command([5.0, 0.0, 0.0, 0.0]));
        bench.run_ms(1000);
        let expected_width = calibrated_width(0.0, a1_us_per_degree(), 5.0);
        assert_near(measure_widths(&mut bench)[0], expected_width, "before");
        let scale = a1_us_per_degree().abs() + 1.25;
        bench.expect_ok(&format!("scale 1 {scale:.2}"));
        bench.run_ms(500);
        let expected_width = calibrated_width(0.0, scale.copysign(a1_us_per_degree()), 5.0);
        assert_near(measure_widths(&mut bench)[0], expected_width, "scaled");
        let other_direction = if a1_us_per_degree() > 0.0 { '-' } else { '+' };
        bench.expect_ok(&format!("dir 1 {other_direction}"));
        bench.uno.take_edges();
        bench.run_ms(500);
        let mut scales = servo_scales();
        scales[0] = scale;
        assert_within_slew_limit(&recorded_pulses(&bench), scales);
        let expected_width = calibrated_width(0.0, -scale.copysign(a1_us_per_degree()), 5.0);
        assert_near(measure_widths(&mut bench)[0], expected_width, "reversed");
    });
}

#[test]
fn limits_that_cut_off_a_gait_and_poses_beyond_a_limit_are_refused() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    let neutral = robot().servos()[0].neutral;
    let calibration_before = read_calibration(&mut bench);
    let too_narrow_line = format!("limit 1 {:.2} {:.2}", neutral - 0.5, neutral + 0.5);
    if robot().gaits().iter().any(|gait| gait.has_movement()) {
        expect_answer(&mut bench, &too_narrow_line, "err 3 ");
        let calibration = read_calibration(&mut bench);
        assert_eq!(
            calibration, calibration_before,
            "a refused line changed the calibration"
        );
    }
    let narrow_line = format!("limit 1 {:.2} {:.2}", neutral - 40.0, neutral + 40.0);
    bench.expect_ok(&narrow_line);
    expect_answer(&mut bench, &pose_command([41.0, 0.0, 0.0, 0.0]), "err 3 ");
}

#[test]
fn saved_settings_apply_from_the_first_pulse_after_power_on() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        bench.say("trim 1 1.5");
        bench.say("trim 3 -2");
        bench.say("deadman 2500");
        let calibration = read_calibration(&mut bench);
        assert_eq!(bench.say("save"), "ok save");
        bench.run_ms(500);
        let widths = measure_widths(&mut bench);
        let expected_width = calibrated_width(1.5, a1_us_per_degree(), 0.0);
        assert_near(widths[0], expected_width, "trimmed");
        power_cycle(&mut bench);
        bench.run_ms(700);
        // From the first pulse on, the widths match the saved settings.
        assert_steady(&recorded_pulses(&bench), widths, 11);
        assert_eq!(read_calibration(&mut bench), calibration);
        let line_count = bench.lines().len();
        let last_lines = bench.texts_from(line_count - 12).join("\n");
        let is_valid = !last_lines.contains("calibration:");
        assert!(is_valid, "the saved settings are invalid: {last_lines}");
    });
}

#[test]
fn load_factory_and_power_on_discard_unsaved_settings() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    let factory_calibration = read_calibration(&mut bench);
    expect_answer(&mut bench, "load", "err 9 ");
    bench.say("trim 1 1");
    let saved_calibration = read_calibration(&mut bench);
    assert_eq!(bench.say("save"), "ok save");
    bench.say("trim 1 -1");
    assert_ne!(read_calibration(&mut bench), saved_calibration);
    assert_eq!(bench.say("load"), "ok load");
    assert_eq!(read_calibration(&mut bench), saved_calibration);
    bench.run_ms(500);
    let expected_width = calibrated_width(1.0, a1_us_per_degree(), 0.0);
    assert_near(measure_widths(&mut bench)[0], expected_width, "loaded");
    assert_eq!(bench.say("factory"), "ok factory");
    assert_eq!(read_calibration(&mut bench), factory_calibration);
    bench.run_ms(500);
    assert_eq!(measure_widths(&mut bench), neutral_widths());
    power_cycle(&mut bench);
    let calibration = read_calibration(&mut bench);
    assert_eq!(
        calibration, saved_calibration,
        "`factory` saved settings without `save`"
    );
}

#[test]
fn a_save_writes_only_changed_bytes_one_by_one_and_loses_no_input() {
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
            assert_eq!(run.bench.last_text(), "ok save");
        }
        let operations = run.bench.uno.eeprom_operations();
        if fidelity == Fidelity::DataSheet {
            assert!(operations.len() > 6 * 6, "{}", operations.len());
        }
        for operation in &operations {
            let (old_value, new_value) = (operation.old_value, operation.new_value);
            assert_ne!(old_value, new_value, "an unchanged byte was written");
        }
        for pair in operations.windows(2) {
            let are_separate = pair[1].cycle - pair[0].cycle >= 3 * CYCLES_PER_MS;
            assert!(are_separate, "two bytes were written at once");
        }
        assert_eq!(run.late_edge_count(), 0);
        Status::read(&mut run.bench).assert_has("rx_lost=0");
    });
}

#[test]
fn a_byte_that_arrives_as_a_memory_write_begins_does_not_prevent_the_write() {
    let save_while_sending = |byte_cycle: Option<u64>| {
        let mut bench = boot_to_stand(Fidelity::DataSheet);
        bench.expect_ok("deadman 54321");
        bench.send("save");
        if let Some(cycle) = byte_cycle {
            bench.uno.run_until_cycle(cycle);
            bench.uno.send(b" ");
        }
        bench.run_ms(500);
        bench
    };
    let undisturbed_bench = save_while_sending(None);
    let operations = undisturbed_bench.uno.eeprom_operations();
    let last_write = operations.last().expect("a byte was written").cycle;
    let early_cycle = last_write - 5_000;
    let received_bytes = save_while_sending(Some(early_cycle)).uno.received_by_uno();
    let arrival = received_bytes.last().expect("the byte has arrived").cycle;
    let transfer_cycles = arrival - early_cycle;
    for lead in 0..20 {
        let bench = save_while_sending(Some(last_write - transfer_cycles - lead));
        assert!(
            bench.uno.eeprom() == undisturbed_bench.uno.eeprom(),
            "a byte {lead} cycles before a write prevents it"
        );
    }
}

#[test]
fn every_pulse_of_a_walk_is_exact_while_the_memory_is_written() {
    run_in_both_simulations(|fidelity| {
        let mut run = ReferenceRun::start_walking(fidelity);
        run.bench.say("deadman 54321");
        let start = run.run_to_next_frame();
        let operations_before = run.bench.uno.eeprom_operations().len();
        run.bench.send("save");
        // Keeps the serial line busy. The main loop reads none of these bytes until it has saved.
        for _ in 0..14 {
            run.bench.uno.send(b" \t ");
            run.run_to(run.bench.uno.cycle() + FRAME_CYCLES);
        }
        run.run_to(start + 40 * FRAME_CYCLES - SLOT_CYCLES / 2);
        assert!(run.assert_exact_since(start, "saving") >= 40);
        assert_eq!(run.late_edge_count(), 0);
        if fidelity == Fidelity::DataSheet {
            assert!(run.bench.uno.eeprom_operations().len() > operations_before + 40);
        }
    });
}

#[test]
fn boot_begins_its_gait_three_seconds_after_power_on_unless_a_byte_arrives() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        let gait = first_moving_gait();
        bench.expect_ok(&format!("boot {gait}"));
        assert_eq!(bench.say("save"), "ok save");
        power_cycle(&mut bench);
        let pulses = run_and_record_pulses(&mut bench, 2900);
        assert_steady(&pulses, neutral_widths(), 1);
        bench.run_ms(300);
        assert_eq!(bench.last_text(), format!("# boot: {gait}"));
        let gait_pair = format!("gait={}", gait.replace(' ', "-"));
        Status::read(&mut bench).assert_has(&gait_pair);
        power_cycle(&mut bench);
        bench.run_ms(2000);
        bench.uno.send(b" ");
        let pulses = run_and_record_pulses(&mut bench, 4000);
        assert_steady(&pulses, neutral_widths(), 1);
    });
}

/// Moves the robot to a pose near neutral and returns its pulse widths.
fn move_to_nearby_pose(bench: &mut FirmwareBench) -> [u64; 4] {
    bench.say(&pose_command([6.0, -6.0, 6.0, -6.0]));
    bench.run_ms(1000);
    let widths = measure_widths(bench);
    assert!(widths.iter().zip(neutral_widths()).all(|(a, b)| *a != b));
    widths
}

#[test]
fn at_power_on_the_servos_wake_one_by_one_in_the_pose_of_the_last_rest() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        let rest_widths = move_to_nearby_pose(&mut bench);
        assert_eq!(bench.say("rest"), "ok rest");
        bench.run_ms(400);
        power_cycle(&mut bench);
        bench.run_ms(1500);
        let pulses = recorded_pulses(&bench);
        let first_pulses = pulses.each_ref().map(|pulses| pulses[0]);
        assert_eq!(first_pulses.map(|pulse| pulse.width), rest_widths);
        for pair in first_pulses.windows(2) {
            let interval = pair[1].start - pair[0].start;
            let expected_interval = 5 * FRAME_CYCLES + SLOT_CYCLES;
            assert_eq!(
                interval, expected_interval,
                "the servos do not wake a tenth of a second apart: {pair:?}"
            );
        }
        assert_within_slew_limit(&pulses, servo_scales());
        let widths = measure_widths(&mut bench);
        assert_eq!(widths, neutral_widths(), "the robot does not stand");
        // The robot has moved since it rested, so its saved rest pose is no longer valid.
        power_cycle(&mut bench);
        bench.run_ms(300);
        let first_width = bench.uno.pulses(bench.pins()[0])[0].width;
        assert_eq!(first_width, neutral_widths()[0]);
    });
}

#[test]
fn a_power_cut_during_a_rest_save_leaves_the_rest_pose_or_the_neutral_pose() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    let blank_eeprom = bench.uno.eeprom();
    let rest_widths = move_to_nearby_pose(&mut bench);
    let operations_before = bench.uno.eeprom_operations().len();
    bench.say("rest");
    bench.run_ms(400);
    let operation_count = bench.uno.eeprom_operations().len() - operations_before;
    assert!(operation_count > 10, "{operation_count} operations");
    let (mut neutral_count, mut rest_count) = (0, 0);
    for operation in 0..operation_count as u64 {
        for (ones, cut) in [
            (0, PowerCut::InWrite(operation)),
            (0x5a, PowerCut::InWrite(operation)),
            (0x33, PowerCut::InErase(operation)),
        ] {
            bench.uno.set_eeprom(&blank_eeprom);
            power_cycle(&mut bench);
            bench.run_ms(500);
            move_to_nearby_pose(&mut bench);
            bench.uno.cut_power(cut, ones);
            bench.say("rest");
            bench.uno.run_ms(400);
            assert_eq!(*bench.uno.state(), State::Off);
            power_cycle(&mut bench);
            bench.run_ms(600);
            match recorded_pulses(&bench).map(|pulses| pulses[0].width) {
                widths if widths == rest_widths => rest_count += 1,
                widths if widths == neutral_widths() => neutral_count += 1,
                widths => panic!("operation {operation}, ones {ones:02x}: {widths:?}"),
            }
        }
    }
    let counts = (neutral_count, rest_count);
    assert!(neutral_count > rest_count && rest_count > 0, "{counts:?}");
}
