//! Tests that the firmware meets every budget of `lizard sim bench` that is counted in cycles or bytes.

use lizard_host::bench;
use lizard_host_tests::{FRAME_CYCLES, FirmwareBench, patrolling_robot, robot};
use simulated_uno::Fidelity;

use crate::{FRAMES_PER_SECOND, boot_and_command, boot_to_walk};

#[test]
fn every_budget_is_met() {
    let (elf, patrolling_robot) = (FirmwareBench::elf_path(), Some(patrolling_robot()));
    let rows = bench::measure(&elf, robot(), patrolling_robot, |_| {});
    let rows = rows.expect("the measurement runs");
    let mut missed_rows = Vec::new();
    for row in rows.iter().filter(|row| !row.is_machine_dependent) {
        println!(
            "{:<30} {:>8.1?} {:<6} {:?}",
            row.name, row.measured, row.unit, row.budget
        );
        if !row.is_within_budget {
            missed_rows.push(format!("{row:?}"));
        }
    }
    assert!(missed_rows.is_empty(), "{missed_rows:#?}");
    // A measurement without any result would also meet most budgets.
    let find_measured = |name: &str| {
        let row = rows.iter().find(|row| row.name.trim() == name);
        row.unwrap_or_else(|| panic!("no row {name}")).measured
    };
    let measured = |name: &str| find_measured(name).expect(name);
    let max_tick_cycles = measured("control tick, worst");
    assert!(measured("longest serial interrupt") > 50.0);
    assert!(measured("tick to frame, line saturated") > max_tick_cycles);
    assert!(measured("servo interrupts per frame") > 1000.0);
    assert!(measured("in a routine, mean") > 1_000.0);
    // No run uses more stack than the static analysis predicts, and the worst run comes close to the prediction.
    let excess_bytes =
        measured("between stack and static RAM") - measured("with the deepest stack");
    println!("the static analysis predicts {excess_bytes} bytes more stack than was measured");
    assert!((0.0..150.0).contains(&excess_bytes), "{excess_bytes}");
    if let (Some(tick_cycles), Some(guard_cycles), Some(main_cycles)) = (
        find_measured("control tick, mean in any gait"),
        find_measured("of which the guard"),
        find_measured("main, mean per frame of a gait"),
    ) {
        assert!(tick_cycles > 1000.0 && max_tick_cycles > tick_cycles);
        assert!(guard_cycles > 100.0 && guard_cycles < tick_cycles && main_cycles > tick_cycles);
        // In a cell that the safety maps certify, the guard needs only two comparisons for each pair of servos.
        let is_fast = guard_cycles < 2_000.0;
        assert!(is_fast || !robot().has_room_for_maps(), "{guard_cycles}");
    }
}

#[test]
fn the_processor_is_awake_for_less_than_a_tenth_of_the_time_in_every_gait() {
    for fidelity in [Fidelity::Stock, Fidelity::DataSheet] {
        for gait in robot().gaits() {
            let mut bench = boot_and_command(&gait.command(), fidelity);
            let awake_before = bench.uno.awake_cycles();
            bench.run_ms(4000);
            let awake_cycles = bench.uno.awake_cycles() - awake_before;
            let cycles_per_frame = awake_cycles / (4 * FRAMES_PER_SECOND);
            let is_asleep = cycles_per_frame < FRAME_CYCLES / 10;
            let name = gait.name();
            assert!(is_asleep, "{name}: {cycles_per_frame} cycles in a frame");
        }
    }
}

#[test]
fn every_tick_computes_one_frame() {
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    // Aligns the run with the frames, so that the measurement starts with a complete frame.
    bench.run_for_frames(0);
    let calls = bench.time_calls("Controller::compute_frame", 2000);
    assert_eq!(calls.len() as u64, 2 * FRAMES_PER_SECOND);
    for pair in calls.windows(2) {
        // Calls are one frame apart, except for the instruction in progress at a tick and the branches taken before
        // the call.
        let interval = pair[1].enter_cycle - pair[0].enter_cycle;
        assert!(interval.abs_diff(FRAME_CYCLES) < 100, "{interval}");
    }
}
