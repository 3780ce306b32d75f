//! Tests of resets: a program that hangs restarts without a wrong pulse, and the cause of every reset is reported
//! correctly.

use lizard_host_tests::{FirmwareBench, robot};
use lizard_robot::round_to_hundredths;
use simulated_uno::{CYCLES_PER_MS, EEPROM_SIZE, Fidelity, ResetCause, Uno};

use crate::measurements::{
    assert_flashes, assert_no_pulse, measure_widths, power_cycle, recorded_pulses,
    run_and_record_pulses, servo_slew_limit,
};
use crate::{Status, boot_to_stand, boot_to_walk, first_moving_gait, neutral_widths, pose_command};

/// Data address of Timer1's clock selection.
const TCCR1B: u16 = 0x81;
/// Data address of Timer1's interrupt mask.
const TIMSK1: u16 = 0x6f;

/// The longest time until the watchdog resets a program that hangs, ms: two stages of 125 ms each, plus the frame in
/// which main last reset the watchdog.
const MAX_TIMEOUT_MS: u64 = 250 + 20;

/// Moves the robot to a pose other than neutral, and returns its bench and the pulse widths of this pose.
fn hold_pose() -> (FirmwareBench, [u64; 4]) {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    bench.say(&pose_command([5.0, -4.0, 3.0, -2.0]));
    bench.run_ms(1000);
    let widths = measure_widths(&mut bench);
    assert_ne!(widths, neutral_widths());
    (bench, widths)
}

/// Runs until the watchdog resets the chip, ends the stall of the main loop, and returns the cycles that passed.
pub fn run_until_reset(bench: &mut FirmwareBench) -> u64 {
    let (start, resets_before) = (bench.uno.cycle(), bench.uno.watchdog_reset_count());
    let limit_cycles = MAX_TIMEOUT_MS * CYCLES_PER_MS;
    let was_reset = |uno: &Uno| uno.watchdog_reset_count() > resets_before;
    let is_in_time = bench.uno.run_until(limit_cycles, 1_000, was_reset);
    assert!(is_in_time, "no reset");
    // The restarted program must not be stalled.
    bench.uno.stall_main(0);
    bench.uno.cycle() - start
}

#[test]
fn a_main_loop_that_hangs_is_reset_and_the_robot_held_without_a_wrong_pulse() {
    let (mut bench, widths) = hold_pose();
    for round in 0..40u64 {
        // In each round, the main loop stops at a different time in the frame.
        bench.uno.run_cycles(round * 7_919);
        bench.uno.take_edges();
        bench.uno.stall_main(2_000 * CYCLES_PER_MS);
        let cycles = run_until_reset(&mut bench);
        assert!(
            cycles > 200 * CYCLES_PER_MS,
            "reset too early, after {cycles} cycles"
        );
        bench.uno.run_ms(300);
        for (servo, pulses) in recorded_pulses(&bench).iter().enumerate() {
            for pulse in pulses {
                let number = servo + 1;
                assert_eq!(pulse.width, widths[servo], "A{number} in round {round}");
            }
            let gaps = pulses.windows(2).map(|pair| pair[1].start - pair[0].start);
            let gap = gaps.max().expect("the servo has pulses");
            assert!(gap < 200 * CYCLES_PER_MS, "no pulse for {gap} cycles");
        }
        let resets = round + 1;
        let pairs = format!("reset=watchdog fault=watchdog resets={resets}");
        Status::read(&mut bench).assert_has(&pairs);
    }
    let fault_line = "# fault: the program hung and was restarted".to_owned();
    assert!(bench.texts_from(0).contains(&fault_line));
}

#[test]
fn a_hang_during_a_walk_holds_the_last_pose_until_a_command() {
    for walk_ms in [3, 137, 411, 893] {
        let mut bench = boot_to_walk(Fidelity::DataSheet);
        bench.run_ms(walk_ms);
        let widths_before = measure_widths(&mut bench);
        bench.uno.stall_main(2_000 * CYCLES_PER_MS);
        run_until_reset(&mut bench);
        bench.uno.run_ms(60);
        let pulses = run_and_record_pulses(&mut bench, 5000);
        for servo in 0..4 {
            let first_width = pulses[servo][0].width;
            assert!(pulses[servo].iter().all(|pulse| pulse.width == first_width));
            // The last computed frame may not have been sent.
            let change = first_width.abs_diff(widths_before[servo]);
            assert!(change <= 2 * servo_slew_limit(servo), "A{}", servo + 1);
        }
        Status::read(&mut bench).assert_has("gait=stop");
        assert_flashes(&mut bench, 12, 4);
        assert_eq!(bench.say("stand"), "ok stand");
        bench.run_ms(1500);
        Status::read(&mut bench).assert_has("fault=none");
        assert_eq!(measure_widths(&mut bench), neutral_widths());
    }
}

/// Checks that the watchdog resets the chip, and that the robot then holds the pose with these widths.
fn assert_reset_in_pose(mut bench: FirmwareBench, widths: [u64; 4], case: &str) {
    run_until_reset(&mut bench);
    bench.uno.run_ms(100);
    assert_eq!(measure_widths(&mut bench), widths, "{case}");
    let status = Status::read(&mut bench);
    assert_eq!(status.text("reset"), "watchdog", "{case}");
}

#[test]
fn a_stopped_timer_or_disabled_timer_interrupts_are_detected() {
    for (register, value) in [(TCCR1B, 0), (TIMSK1, 0), (TIMSK1, 0x02), (TIMSK1, 0x04)] {
        let (mut bench, widths) = hold_pose();
        // Runs to the tick's slot, in which no pin is high.
        bench.run_for_frames(1);
        let pins = bench.pins();
        assert!(pins.iter().all(|pin| !bench.uno.is_high(*pin)));
        bench.uno.poke(register, value);
        assert_reset_in_pose(bench, widths, &format!("{register:02x}={value}"));
    }
}

#[test]
fn disabled_interrupts_are_detected_and_reported_as_a_watchdog_reset() {
    let (mut bench, widths) = hold_pose();
    // The data address of SREG, whose highest bit enables interrupts.
    let sreg = 0x5f;
    let is_blocked = |uno: &Uno| uno.peek(sreg) & 0x80 == 0;
    assert!(bench.uno.run_until(CYCLES_PER_MS, 1, is_blocked));
    bench.uno.block_interrupts(1_000 * CYCLES_PER_MS);
    assert_reset_in_pose(bench, widths, "interrupts blocked");
}

#[test]
fn a_robot_that_works_is_never_reset() {
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    bench.uno.flood(b"status\nhelp\ncal\nsave\nx");
    bench.run_ms(20_000);
    assert_eq!(bench.uno.reset_events().len(), 1);
}

/// Returns a board shortly after power-on, with or without a boot loader.
fn boot(has_boot_loader: bool) -> FirmwareBench {
    let mut bench = FirmwareBench::power_on(Fidelity::DataSheet);
    bench.uno.set_boot_loader(has_boot_loader);
    bench.run_ms(700);
    bench
}

#[test]
fn every_cause_of_a_reset_is_reported_and_resets_are_counted() {
    use ResetCause::{BrownOut, External, PowerOn, Watchdog};
    for has_boot_loader in [false, true] {
        let mut bench = boot(has_boot_loader);
        let assert_reported = |bench: &mut FirmwareBench, cause: &str, resets: f64| {
            bench.uno.run_ms(700);
            let status = Status::read(bench);
            let reported = (status.text("reset"), status.number("resets"));
            assert_eq!(reported, (cause, resets), "boot loader: {has_boot_loader}");
        };
        assert_reported(&mut bench, "power", 0.0);
        bench.uno.reset();
        assert_reported(&mut bench, "external", 1.0);
        bench.uno.stall_main(1_000 * CYCLES_PER_MS);
        run_until_reset(&mut bench);
        assert_reported(&mut bench, "watchdog", 2.0);
        bench.uno.set_supply_mv(2_400.0);
        bench.uno.run_ms(5);
        bench.uno.set_supply_mv(5_000.0);
        // The boot loader clears the chip's record of the cause, and RAM keeps its contents, so the firmware cannot
        // distinguish the dip from an external reset.
        let dip_cause = ["brownout", "external"][usize::from(has_boot_loader)];
        assert_reported(&mut bench, dip_cause, 3.0);
        bench.uno.reset();
        assert_reported(&mut bench, "external", 4.0);
        power_cycle(&mut bench);
        assert_reported(&mut bench, "power", 0.0);
        let events = bench.uno.reset_events();
        let causes: Vec<ResetCause> = events.iter().map(|event| event.cause).collect();
        let expected = [PowerOn, External, Watchdog, BrownOut, External, PowerOn];
        assert_eq!(causes, expected);
    }
}

#[test]
fn resets_are_counted_up_to_255_and_no_further() {
    let mut bench = boot(true);
    for reset in 1..=260u32 {
        bench.uno.reset();
        bench.run_ms(5);
        if reset >= 253 {
            bench.run_ms(700);
            let reported = Status::read(&mut bench).number("resets");
            assert_eq!(reported, f64::from(reset.min(255)), "{reset} resets");
        }
    }
}

#[test]
fn power_on_is_recognised_whatever_the_ram_contains() {
    let mut bench = boot(true);
    // The angles as `status` prints them, deg.
    let servos = robot().servos();
    let neutral_angles = servos.map(|servo| round_to_hundredths(servo.neutral));
    for seed in 0..300 {
        bench.uno.set_noise_seed(seed);
        power_cycle(&mut bench);
        let status = Status::read(&mut bench);
        status.assert_has("reset=power resets=0");
        assert_eq!(status.pose(), neutral_angles);
    }
}

#[test]
fn a_hang_that_ends_by_itself_is_reset_like_any_other() {
    let (mut bench, widths) = hold_pose();
    // The stalls range from shorter than the watchdog's first stage of 125 ms to longer than both stages.
    for ms in (90..300).step_by(10) {
        let resets_before = bench.uno.watchdog_reset_count();
        bench.uno.stall_main(ms * CYCLES_PER_MS);
        bench.uno.run_ms(ms + 150);
        let was_reset = bench.uno.watchdog_reset_count() > resets_before;
        let servo_pulses = run_and_record_pulses(&mut bench, 200);
        for (servo, pulses) in servo_pulses.iter().enumerate() {
            let is_steady =
                pulses.len() >= 9 && pulses.iter().all(|pulse| pulse.width == widths[servo]);
            assert!(is_steady, "A{} after {ms} ms: {pulses:?}", servo + 1);
        }
        assert!(was_reset || ms < 130, "{ms} ms");
        let fault = if was_reset { "watchdog" } else { "none" };
        assert_eq!(Status::read(&mut bench).text("fault"), fault, "{ms} ms");
        // The next iteration begins without a fault, in the same pose.
        bench.say(&pose_command([5.0, -4.0, 3.0, -2.0]));
        bench.run_ms(500);
    }
}

#[test]
fn a_resting_robot_that_hangs_restarts_without_a_pulse() {
    // The EEPROM holds the pose in which the robot rested, or is blank.
    for is_blank in [false, true] {
        for ms in [140, 200, 400] {
            let (mut bench, _) = hold_pose();
            assert_eq!(bench.say("rest"), "ok rest");
            bench.run_ms(500);
            if is_blank {
                bench.uno.set_eeprom(&[0xff; EEPROM_SIZE]);
            }
            let resets_before = bench.uno.watchdog_reset_count();
            bench.uno.stall_main(ms * CYCLES_PER_MS);
            bench.uno.run_ms(ms + 150);
            assert!(bench.uno.watchdog_reset_count() > resets_before);
            assert_no_pulse(&mut bench, 6000, &format!("{ms} ms"));
            Status::read(&mut bench).assert_has("gait=rest fault=watchdog");
            let answer = bench.say(&first_moving_gait());
            assert_eq!(answer, "err 7 the servos are resting; send stand first");
            assert_eq!(bench.say("stand"), "ok stand");
            bench.run_ms(2000);
            assert_eq!(measure_widths(&mut bench), neutral_widths());
        }
    }
}

#[test]
fn a_resting_robot_rests_after_a_reset_until_boot_or_a_command() {
    let (mut bench, _) = hold_pose();
    bench.say("rest");
    bench.run_ms(300);
    bench.uno.reset();
    // `boot` starts `stand`, because no byte arrives.
    assert_no_pulse(&mut bench, 2_900, "before `boot`");
    bench.uno.run_ms(2_500);
    assert_eq!(measure_widths(&mut bench), neutral_widths());
    assert!(bench.texts_from(0).contains(&"# boot: stand".to_owned()));
    bench.say("rest");
    bench.run_ms(300);
    bench.uno.reset();
    bench.uno.run_ms(1000);
    bench.uno.send(b"\r");
    assert_no_pulse(&mut bench, 5_000, "after a byte, which cancels `boot`");
}
