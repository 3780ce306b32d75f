//! Tests of autobaud: the firmware finds the sender's baud rate.

use fastrand::Rng;
use lizard_host_tests::FirmwareBench;
use simulated_uno::{CYCLES_PER_MS, Fidelity};

use crate::pulses::servo_edges;
use crate::watchdog::run_until_reset;
use crate::{
    Status, boot_to_stand, boot_to_walk, expect_answer, first_moving_gait, run_in_both_simulations,
};

/// The answer to a garbled line, and to a command that is too short to confirm a guessed rate.
pub const GARBLED_ANSWER: &str = "err 1 the line was garbled; send it again";

/// The baud rates, each with the number of `status` lines until the first answer after a cold start. One line is lost
/// at each rate that the robot tries before the right one. One more is reported as garbled, because its start may have
/// arrived at the previous rate.
const BAUD_RATES: [(f64, u32); 4] = [(115_200.0, 1), (57_600.0, 3), (38_400.0, 4), (9_600.0, 5)];

/// Sends `status` until the robot answers, and returns the number of lines sent.
pub fn ask_until_answered(bench: &mut FirmwareBench) -> u32 {
    for sent_count in 1..=40 {
        let line_count = bench.lines().len();
        bench.uno.send(b"status\n");
        bench.run_ms(350);
        let mut texts = bench.texts_from(line_count).into_iter();
        if texts.any(|text| text.starts_with("ok gait=")) {
            return sent_count;
        }
    }
    panic!("no answer to 40 `status` lines");
}

/// Waits a second after `event`, and checks that the robot answers the first line; `baud` was the rate before the
/// event.
fn assert_answered_at_once(bench: &mut FirmwareBench, baud: f64, event: &str) {
    bench.run_ms(1_000);
    assert_eq!(ask_until_answered(bench), 1, "{baud} baud, {event}");
}

/// Boots a board and lets its robot find this baud rate.
fn boot_at(baud: f64) -> FirmwareBench {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    bench.uno.set_baud(baud);
    ask_until_answered(&mut bench);
    let error = bench.uno.chip_baud() / baud - 1.0;
    assert!(error.abs() < 0.022, "{baud} baud");
    bench
}

#[test]
fn a_robot_finds_each_baud_rate_within_a_few_lines() {
    // Stock simavr delivers every byte at any rate, so only the corrected simulation can test this.
    for (baud, expected_line_count) in BAUD_RATES {
        // A slow, an exact and a fast sender.
        for factor in [0.985, 1.0, 1.02] {
            let mut bench = boot_to_stand(Fidelity::DataSheet);
            bench.uno.set_baud(baud * factor);
            let line_count = ask_until_answered(&mut bench);
            assert_eq!(line_count, expected_line_count, "{baud} baud");
            assert_eq!(ask_until_answered(&mut bench), 1);
        }
    }
}

#[test]
fn a_short_command_at_an_unconfirmed_rate_is_reported_as_garbled_and_not_executed() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    bench.uno.set_baud(9_600.0);
    let line_count = bench.lines().len();
    for _ in 0..12 {
        // `cal` is too short to confirm a guessed rate.
        bench.uno.send(b"cal\n");
        bench.run_ms(350);
    }
    let answers = bench.texts_from(line_count);
    let garbled_answers = answers.iter().filter(|answer| *answer == GARBLED_ANSWER);
    assert!(garbled_answers.count() >= 2, "{answers:?}");
    assert!(answers.iter().all(|answer| !answer.starts_with("ok")));
    ask_until_answered(&mut bench);
    expect_answer(&mut bench, "cal", "ok");
}

#[test]
fn a_robot_that_has_found_one_rate_finds_any_other() {
    for (first_baud, _) in BAUD_RATES {
        for (second_baud, _) in BAUD_RATES {
            let mut bench = boot_at(first_baud);
            bench.uno.set_baud(second_baud);
            ask_until_answered(&mut bench);
        }
    }
}

#[test]
fn a_reset_or_power_on_restores_115_200_baud_and_a_hang_keeps_the_rate() {
    for (baud, _) in BAUD_RATES {
        let mut bench = boot_at(baud);
        bench.uno.stall_main(1_000 * CYCLES_PER_MS);
        run_until_reset(&mut bench);
        assert_answered_at_once(&mut bench, baud, "after a hang");
        Status::read(&mut bench).assert_has("reset=watchdog");
        bench.uno.reset();
        bench.uno.set_baud(115_200.0);
        assert_answered_at_once(&mut bench, baud, "then a reset");
        bench.uno.set_baud(baud);
        ask_until_answered(&mut bench);
        bench.uno.power_cycle();
        bench.uno.set_baud(115_200.0);
        assert_answered_at_once(&mut bench, baud, "then power-on");
    }
}

#[test]
fn the_baud_rate_search_moves_no_pulse_edge() {
    run_in_both_simulations(|fidelity| {
        let [undisturbed_edges, disturbed_edges] = [false, true].map(|is_disturbed| {
            let mut bench = boot_to_walk(fidelity);
            bench.uno.take_edges();
            let mut rng = Rng::with_seed(3);
            let mut used_rates = std::collections::BTreeSet::new();
            for _ in 0..120 {
                if is_disturbed {
                    // The chip never uses 4800 baud, so it cannot read the bytes as commands.
                    bench.uno.set_baud(4_800.0);
                    let line: Vec<u8> = (0..rng.usize(1..30)).map(|_| rng.u8(..)).collect();
                    bench.uno.send(&line);
                }
                bench.run_ms(97);
                used_rates.insert(bench.uno.chip_baud() as u64);
            }
            assert_eq!(used_rates.len(), if is_disturbed { 4 } else { 1 });
            servo_edges(&bench)
        });
        assert!(undisturbed_edges.len() > 4_000);
        assert!(undisturbed_edges == disturbed_edges, "an edge moved");
    });
}

#[test]
fn noise_is_never_executed_and_the_rate_is_found_again() {
    let mut bench = boot_to_stand(Fidelity::DataSheet);
    let line_count = bench.lines().len();
    let mut rng = Rng::with_seed(5);
    for _ in 0..400 {
        bench.uno.set_baud(300.0 + 200_000.0 * rng.f64());
        let noise: Vec<u8> = (0..rng.usize(1..9)).map(|_| rng.u8(..)).collect();
        bench.uno.send_with_framing_error(&noise);
        bench.run_ms(rng.u64(1..60));
    }
    let mut texts = bench.texts_from(line_count).into_iter();
    assert!(!texts.any(|text| text.starts_with("ok ")));
    bench.uno.set_baud(115_200.0);
    assert!(ask_until_answered(&mut bench) <= 8);
    assert_eq!(Status::read(&mut bench).number("late"), 0.0);
}

#[test]
fn garbled_bytes_between_commands_do_not_change_the_rate() {
    let mut bench = boot_at(9_600.0);
    for _ in 0..40 {
        bench.uno.send_with_framing_error(&[0x55; 31]);
        bench.run_ms(100);
        assert_eq!(bench.say(""), GARBLED_ANSWER);
        bench.expect_ok(&first_moving_gait());
        bench.uno.send_with_framing_error(&[0x55; 31]);
        bench.uno.send(b"\n");
        bench.run_ms(100);
        assert_eq!(bench.say("stop"), "ok stop");
    }
}
