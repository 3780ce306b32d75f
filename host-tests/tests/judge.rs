//! Tests that run the same image on two simulators, which must agree on every pulse and every byte. docs/judges.md
//! describes both simulators and the meaning of their agreement.

use std::thread;

use lizard_host::sim::frame::servo_pins;
use lizard_host_tests::judge::{
    AVR8JS_LAG_CYCLES, Outputs, PinPulse, compare_console, compare_pulses, run_judge_tests,
    run_on_avr8js,
};
use lizard_host_tests::{FirmwareBench, gait_commands, robot};
use simulated_uno::{CYCLES_PER_MS, Fidelity, Pin, SerialByte};

/// Boots a bench until its robot stands. The bench has recorded all outputs since power-on.
fn boot_to_stand() -> FirmwareBench {
    let mut bench = FirmwareBench::power_on(Fidelity::DataSheet);
    bench.run_ms(1000);
    bench
}

/// The allowed difference in time between the bytes of two consoles. Two interrupts may delay the main loop before a
/// byte, and each may come one cycle later on one simulator than on the other.
const INTERRUPT_CYCLES: u64 = 2;

/// The allowed difference in time if the console depends on the EEPROM or the receiver, which the main loop polls only
/// once per iteration: an upper bound of the cycles in one iteration of the main loop. An iteration computes a frame in
/// at most 12 000 cycles, and writes a piece of a line. If the EEPROM becomes ready just before an iteration on one
/// simulator and just after its start on the other, the main loop notices the change one iteration later on the other
/// simulator.
const MAX_LOOP_CYCLES: u64 = 20_000;

/// Runs avr8js on the bytes that the bench has received, and checks that pulses, console and EEPROM agree. Without a
/// maximum jitter, the consoles are not compared.
fn check_agreement(bench: &mut FirmwareBench, case_name: &str, max_jitter_cycles: Option<u64>) {
    let end_cycle = bench.uno.cycle();
    let edges = bench.uno.edges();
    let simavr_outputs = Outputs::new(&edges, bench.bytes(), end_cycle);
    let received_bytes = bench.uno.received_by_uno();
    let image = FirmwareBench::image();
    let avr8js = run_on_avr8js(&image, &received_bytes, end_cycle, robot());
    let avr8js = unwrap_or_panic(avr8js, case_name);
    let pulse_agreement = compare_pulses(&simavr_outputs, &avr8js.outputs, &servo_pins(robot()));
    let pulse_agreement = unwrap_or_panic(pulse_agreement, case_name);
    assert_eq!(
        pulse_agreement.offset_cycles, AVR8JS_LAG_CYCLES,
        "{case_name}: the pulses' delay, cycles"
    );
    if let Some(max_jitter_cycles) = max_jitter_cycles {
        let console_agreement = compare_console(&simavr_outputs, &avr8js.outputs);
        let console_agreement = unwrap_or_panic(console_agreement, case_name);
        assert!(
            console_agreement.offset_cycles.abs() <= 1
                && console_agreement.jitter_cycles <= max_jitter_cycles,
            "{case_name}: the times of the console's bytes differ: {console_agreement:?}"
        );
        println!("{case_name}: console {console_agreement:?}");
    }
    let eeprom = bench.uno.eeprom();
    let differing_address = eeprom.iter().zip(&avr8js.eeprom).position(|(a, b)| a != b);
    assert_eq!(
        differing_address, None,
        "{case_name}: the address at which the EEPROMs differ"
    );
    println!(
        "{case_name}: {} bytes received, pulses {pulse_agreement:?}; {:.1} s in {} ms of processor time",
        received_bytes.len(),
        end_cycle as f64 / (1000 * CYCLES_PER_MS) as f64,
        avr8js.cpu_ms
    );
}

fn unwrap_or_panic<T>(result: Result<T, String>, case_name: &str) -> T {
    result.unwrap_or_else(|error| panic!("{case_name}: {error}"))
}

#[test]
fn two_simulators_agree_on_every_pulse_of_every_gait() {
    let mut bench = boot_to_stand();
    for line in gait_commands() {
        bench.say(&line);
        bench.run_ms(2000);
        bench.say("status");
    }
    bench.say("stop");
    bench.run_ms(500);
    check_agreement(&mut bench, "all gaits", Some(INTERRUPT_CYCLES));
}

#[test]
fn two_simulators_agree_on_saved_settings() {
    let mut bench = boot_to_stand();
    for line in ["trim 1 3", "save", "trim 2 -2.5", "save", "rest"] {
        bench.say(line);
        bench.run_ms(2_000);
    }
    let eeprom = bench.uno.eeprom();
    let written_count = eeprom.iter().filter(|byte| **byte != 0xff).count();
    assert!(
        written_count > 100,
        "only {written_count} bytes of two calibrations and a pose were written"
    );
    let case_name = "two calibrations and a pose";
    check_agreement(&mut bench, case_name, Some(MAX_LOOP_CYCLES));
}

#[test]
fn two_simulators_agree_with_a_saturated_serial_line() {
    let mut commands = gait_commands().into_iter();
    let moving_gait = commands.find(|line| line != "stand");
    let moving_gait = moving_gait.unwrap_or_else(|| "stand".into());
    // No flood contains a command that moves the robot: bytes of a flood are lost, so the two simulators might execute
    // different commands. While long answers are sent, some bytes of a flood are lost, and the choice of bytes depends
    // on single cycles, so these consoles are not compared.
    let floods = [
        ("status\n", None),
        ("help\n", None),
        ("?\r", None),
        ("x", Some(MAX_LOOP_CYCLES)),
        ("\0\u{7f}\u{8}\n", Some(MAX_LOOP_CYCLES)),
    ];
    thread::scope(|scope| {
        for (flood, max_jitter_cycles) in floods {
            let moving_gait = &moving_gait;
            scope.spawn(move || {
                let mut bench = boot_to_stand();
                bench.say("watch 1");
                bench.say(moving_gait);
                bench.uno.flood(flood.as_bytes());
                bench.run_ms(2000);
                bench.uno.flood(b"");
                bench.uno.send(b"\nwatch 0\nstatus\n");
                bench.run_ms(500);
                check_agreement(&mut bench, &format!("{flood:?}"), max_jitter_cycles);
            });
        }
    });
}

#[test]
fn the_known_errors_of_avr8js_still_exist_and_are_corrected() {
    unwrap_or_panic(run_judge_tests(), "the judge's own tests");
}

fn pulse(rise_cycle: u64, width: u64) -> PinPulse {
    PinPulse {
        pin: Pin::d(9),
        rise_cycle,
        width,
    }
}

fn build_outputs(pulses: &[PinPulse], text: &str) -> Outputs {
    let sent_bytes = text.bytes().map(|value| SerialByte { cycle: 0, value });
    Outputs {
        pulses: pulses.to_vec(),
        sent_bytes: sent_bytes.collect(),
        end_cycle: 10_000_000,
    }
}

#[test]
fn the_first_difference_between_two_simulators_is_reported() {
    let pulses = [pulse(1_000, 24_000), pulse(321_000, 24_000)];
    let simavr_outputs = build_outputs(&pulses, "ok walk");
    let later_pulses = pulses.map(|original| pulse(original.rise_cycle + 1, original.width));
    let compare_with_simavr = |pulses: &[PinPulse]| {
        let avr8js_outputs = build_outputs(pulses, "ok walk");
        compare_pulses(&simavr_outputs, &avr8js_outputs, &[Pin::d(9)])
            .map(|agreement| (agreement.count, agreement.offset_cycles))
    };
    assert_eq!(compare_with_simavr(&later_pulses), Ok((2, 1)));
    let find_pulse_error = |pulses: &[PinPulse]| compare_with_simavr(pulses).err();
    let find_console_error =
        |text: &str| compare_console(&simavr_outputs, &build_outputs(&pulses, text)).err();
    for (message, expected_text) in [
        (
            find_pulse_error(&[pulses[0], pulse(321_000, 24_001)]),
            "pulse 1: on simavr D9 rises at cycle 321000 for 24000 cycles; on avr8js D9 rises at cycle 321000 for 24001 cycles",
        ),
        (
            find_pulse_error(&[pulses[0], pulse(321_001, 24_000)]),
            "on avr8js D9 rises at cycle 321001",
        ),
        (
            find_pulse_error(&pulses[..1]),
            "pulse 1 occurs only on simavr",
        ),
        (
            find_pulse_error(&[pulses[0], pulses[1], pulse(641_000, 24_000)]),
            "pulse 2 occurs only on avr8js: D9 rises at cycle 641000",
        ),
        (find_pulse_error(&[]), "no servo gets a pulse"),
        (
            find_console_error("ok well"),
            "byte 4 of the console, cycle 0: simavr sends \"ok wa\", avr8js \"ok we\"",
        ),
        (
            find_console_error("ok"),
            "byte 2 of the console occurs only on simavr: \"ok \"",
        ),
        (
            find_console_error("ok walks"),
            "byte 7 of the console occurs only on avr8js: \"ok walks\"",
        ),
    ] {
        let message = message.expect(expected_text);
        assert!(message.contains(expected_text), "{message}");
    }
}
