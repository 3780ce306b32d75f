//! Tests of a button and an obstacle switch at the pins of the running image, with the patrol from docs/gaits.md.

use std::sync::LazyLock;

use lizard_host::board::SimulatedBoard;
use lizard_host::sim::frame::Frame;
use lizard_host_tests::{FirmwareBench, read_file};
use lizard_robot::{Robot, Travel};
use simulated_uno::{CYCLES_PER_MS, Call, Fidelity, Pin};

use crate::measurements::{measure_widths, power_cycle, run_and_record_pulses};
use crate::{FRAMES_PER_SECOND, Status, frame_angles, run_in_both_simulations};

/// The button's pin in docs/gaits.md.
const BUTTON_PIN: Pin = Pin::a(1);
/// The pin of the obstacle switch in docs/gaits.md, where this input is named `nose`.
const OBSTACLE_PIN: Pin = Pin::a(2);

/// The shortest time for which a contact must be closed to count for certain, ms: three frames.
const DEBOUNCE_MS: u64 = 60;

/// The largest allowed mean duration of a frame's computation, cycles.
const MAX_MEAN_FRAME_CYCLES: u64 = 5_000;

/// Returns the paper's robot with the patrol from docs/gaits.md.
fn patrol_robot() -> &'static Robot {
    static ROBOT: LazyLock<Robot> = LazyLock::new(|| build_patrol_robot("A1", "A2"));
    &ROBOT
}

/// Builds the paper's robot with the patrol from docs/gaits.md, with button and obstacle switch at these pins.
fn build_patrol_robot(button_pin: &str, obstacle_pin: &str) -> Robot {
    let page_text = read_file("docs/gaits.md");
    let blocks = page_text.split("```");
    let mut patrols = blocks
        .filter_map(|block| block.strip_prefix("toml\n"))
        .filter(|block| block.contains("[input.button]"));
    let patrol = patrols.next().expect("docs/gaits.md has a patrol");
    let patrol = patrol
        .replace("\"A1\"", &format!("\"{button_pin}\""))
        .replace("\"A2\"", &format!("\"{obstacle_pin}\""));
    let text = format!("{}\n{patrol}", read_file("robots/paper.toml"));
    Robot::parse(&text).expect("the robot with the patrol is valid")
}

/// Boots a board with this robot and both contacts open, and runs it for a second.
fn boot_with_inputs(robot: &Robot, fidelity: Fidelity) -> FirmwareBench {
    let board = SimulatedBoard::boot(&FirmwareBench::elf_path(), fidelity, robot)
        .expect("the firmware prints its banner");
    let mut bench = FirmwareBench(board);
    for pin in [BUTTON_PIN, OBSTACLE_PIN] {
        bench.uno.set_contact(pin, false);
    }
    bench.run_ms(1_000);
    bench
}

/// Starts the patrol and returns a bench whose robot waits for the button.
fn start_waiting_patrol(fidelity: Fidelity) -> FirmwareBench {
    let mut bench = boot_with_inputs(patrol_robot(), fidelity);
    assert_eq!(bench.say("patrol"), "ok patrol");
    bench.run_ms(500);
    assert_eq!(read_notes(&mut bench, 0), ["# waiting for button"]);
    bench
}

/// Starts the patrol, presses the button, and returns a bench whose robot walks until the obstacle switch closes.
fn start_walking_patrol(fidelity: Fidelity) -> FirmwareBench {
    let mut bench = start_waiting_patrol(fidelity);
    press(&mut bench, BUTTON_PIN, 200);
    bench.run_ms(1_000);
    bench
}

/// Closes a contact for `ms` milliseconds.
fn press(bench: &mut FirmwareBench, pin: Pin, ms: u64) {
    bench.uno.set_contact(pin, true);
    bench.run_ms(ms);
    bench.uno.set_contact(pin, false);
}

/// Returns the notes (lines that begin with `#`) from line `first_line` on, except those of the banner.
fn read_notes(bench: &mut FirmwareBench, first_line: usize) -> Vec<String> {
    let excluded_starts = ["# lizard", "# calibration"];
    let is_banner = |line: &str| excluded_starts.iter().any(|start| line.starts_with(start));
    let mut notes = bench.texts_from(first_line);
    notes.retain(|line| line.starts_with('#') && !is_banner(line));
    notes
}

/// Predicts the robot's displacement for these pulses with the contact model.
fn predict_travel(frames: &[Frame]) -> Travel {
    patrol_robot().predict_travel(frame_angles(patrol_robot(), frames))
}

/// Runs the robot for three seconds and checks that it walks straight ahead.
fn assert_walks_ahead(bench: &mut FirmwareBench) {
    let travel = predict_travel(&bench.run_for_frames(3 * FRAMES_PER_SECOND));
    let is_ahead = travel.forward > 90.0 && travel.turn.abs() < 5.0;
    assert!(is_ahead, "{travel:?}");
}

/// Runs the board for a second. Returns true if no pulse width changes.
fn stays_still_for_a_second(bench: &mut FirmwareBench) -> bool {
    let frames = bench.run_for_frames(FRAMES_PER_SECOND);
    frames.iter().all(|frame| frame.widths == frames[0].widths)
}

#[test]
fn after_power_on_and_a_press_the_robot_patrols_without_a_computer() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_with_inputs(patrol_robot(), fidelity);
        bench.say("boot patrol");
        bench.send("save");
        bench.run_ms(500);
        power_cycle(&mut bench);
        let line_count = bench.lines().len();
        bench.run_ms(10_000);
        let notes = read_notes(&mut bench, line_count);
        assert_eq!(notes, ["# boot: patrol", "# waiting for button"]);
        assert!(stays_still_for_a_second(&mut bench));
        // The button bounces.
        for ms in [1, 3, 1, 2, 7, 1, 2] {
            press(&mut bench, BUTTON_PIN, ms);
            bench.run_ms(1);
        }
        press(&mut bench, BUTTON_PIN, 150);
        // The move to the first pose ends within half a second.
        bench.run_ms(500);
        assert_walks_ahead(&mut bench);
        for _ in 0..2 {
            let line_count = bench.lines().len();
            bench.uno.set_contact(OBSTACLE_PIN, true);
            let mut frames = bench.run_for_frames(2 * FRAMES_PER_SECOND);
            bench.uno.set_contact(OBSTACLE_PIN, false);
            frames.extend(bench.run_for_frames(6 * FRAMES_PER_SECOND));
            let turn_travel = predict_travel(&frames);
            let has_turned = turn_travel.turn > 75.0;
            assert!(has_turned, "the robot did not turn: {turn_travel:?}");
            assert!(read_notes(&mut bench, line_count).is_empty());
            // The patrol needs no second press: it waits only for the obstacle switch.
            bench.run_ms(2_500);
            let notes = read_notes(&mut bench, line_count);
            assert_eq!(notes, ["# waiting for nose"]);
            assert_walks_ahead(&mut bench);
        }
        Status::read(&mut bench).assert_has("gait=patrol late=0");
    });
}

#[test]
fn a_stuck_button_or_a_short_press_starts_nothing() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_with_inputs(patrol_robot(), fidelity);
        bench.uno.set_contact(BUTTON_PIN, true);
        bench.say("patrol");
        bench.run_ms(5_000);
        assert!(stays_still_for_a_second(&mut bench));
        bench.uno.set_contact(BUTTON_PIN, false);
        bench.run_ms(DEBOUNCE_MS);
        // Presses shorter than two frames never close the button in three successive frames.
        for ms in 1..39 {
            press(&mut bench, BUTTON_PIN, ms);
            bench.run_ms(41);
        }
        assert!(stays_still_for_a_second(&mut bench));
        press(&mut bench, BUTTON_PIN, DEBOUNCE_MS);
        assert!(!stays_still_for_a_second(&mut bench));
    });
}

#[test]
fn stop_rest_reset_hang_or_low_supply_end_the_patrol_and_no_press_restarts_it() {
    for start_patrol in [start_waiting_patrol, start_walking_patrol] {
        type Event = fn(&mut FirmwareBench);
        let events: [(&str, Event); 5] = [
            ("stop", |bench| assert_eq!(bench.say("stop"), "ok stop")),
            ("rest", |bench| assert_eq!(bench.say("rest"), "ok rest")),
            ("a reset", |bench| {
                bench.uno.reset();
                bench.uno.run_ms(4_000);
            }),
            ("a hang", |bench| {
                bench.uno.stall_main(270 * CYCLES_PER_MS);
                bench.uno.run_ms(4_000);
            }),
            ("a low supply", |bench| {
                bench.uno.set_supply_mv(3_850.0);
                bench.run_ms(500);
                bench.uno.set_supply_mv(5_000.0);
                bench.run_ms(1_000);
            }),
        ];
        for (name, event) in events {
            let mut bench = start_patrol(Fidelity::DataSheet);
            event(&mut bench);
            let widths_before = measure_widths(&mut bench);
            let line_count = bench.lines().len();
            for pin in [BUTTON_PIN, OBSTACLE_PIN] {
                bench.uno.set_contact(pin, true);
                let servo_pulses = run_and_record_pulses(&mut bench, 1_000);
                bench.uno.set_contact(pin, false);
                for (pulses, width_before) in servo_pulses.iter().zip(widths_before) {
                    let is_steady = pulses.iter().all(|pulse| pulse.width == width_before);
                    let has_pulses = !pulses.is_empty();
                    assert!(is_steady && has_pulses == (width_before != 0), "{name}");
                }
            }
            assert!(read_notes(&mut bench, line_count).is_empty(), "{name}");
        }
    }
}

#[test]
fn contacts_on_the_servos_ports_change_no_pulse() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_with_inputs(&build_patrol_robot("D8", "D4"), fidelity);
        bench.uno.set_contact(Pin::d(8), false);
        bench.uno.set_contact(Pin::d(4), false);
        let neutral = measure_widths(&mut bench);
        assert_eq!(bench.say("patrol"), "ok patrol");
        for frame in bench.run_for_frames(5 * FRAMES_PER_SECOND) {
            assert_eq!(frame.expect_all_widths(), neutral);
        }
        press(&mut bench, Pin::d(8), 100);
        bench.run_ms(2_000);
        assert!(!stays_still_for_a_second(&mut bench));
        press(&mut bench, Pin::d(4), 100);
        bench.run_ms(10_000);
        Status::read(&mut bench).assert_has("late=0");
        let notes = read_notes(&mut bench, 0);
        let expected = ["button", "nose", "nose"].map(|name| format!("# waiting for {name}"));
        assert_eq!(notes, expected);
    });
}

#[test]
fn a_patrol_frame_takes_at_most_five_thousand_cycles_on_average() {
    for start_patrol in [start_waiting_patrol, start_walking_patrol] {
        let mut bench = start_patrol(Fidelity::DataSheet);
        let calls = bench.time_calls("Controller::compute_frame", 4_000);
        let cycles: u64 = calls.iter().map(Call::cycles).sum();
        let mean_cycles = cycles / calls.len() as u64;
        println!("{mean_cycles} cycles a frame");
        assert!(calls.len() >= 190, "{} calls", calls.len());
        let is_fast = mean_cycles <= MAX_MEAN_FRAME_CYCLES;
        assert!(is_fast, "{mean_cycles} cycles a frame");
    }
}
