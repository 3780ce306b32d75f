//! Tests that no frame is late or wrong for robots with random pins, directions and gaits, and that no step of main
//! exceeds its bound.

use lizard_core::numbers::gaits::MAX_NAME_BYTES;
use lizard_host::bench::measure_longest_step;
use lizard_host::board::SimulatedBoard;
use lizard_host::sim::gait_choice;
use lizard_host_tests::random_robot::{random_robot, with_many_gaits};
use lizard_host_tests::{FirmwareBench, read_positive_number, rng};
use lizard_robot::{Robot, to_command};
use simulated_uno::Fidelity;

use crate::reference_run::ReferenceRun;
use crate::{FRAMES_PER_SECOND, for_each_in_parallel};

/// Bytes that move no servo; each flood repeats one of these texts at the full rate of the serial line.
const FLOODS: [&str; 5] = ["status\n", "help\n", "cal\n", "?\r", "x"];

/// Runs a gait for two seconds during a flood of serial input, and asserts that each frame has the widths that the core
/// computes.
fn assert_frames_exact(robot: &Robot, gait: &str, flood: &str, robot_name: &str) {
    let board = SimulatedBoard::power_on(&FirmwareBench::elf_path(), Fidelity::DataSheet, robot);
    let mut bench = FirmwareBench(board.expect("`make firmware` has built the ELF"));
    bench.run_ms(1000);
    let mut run = ReferenceRun::with_lines(bench, robot, &["watch 1", &to_command(gait)]);
    run.bench.uno.flood(flood.as_bytes());
    let frames = run.bench.run_for_frames(2 * FRAMES_PER_SECOND);
    let case = format!("{robot_name}, {flood:?}");
    let exact_count = run.assert_exact_since(frames[0].start, &case);
    assert_eq!(exact_count, frames.len(), "{case}: number of frames");
}

#[test]
fn no_frame_of_a_random_robot_is_late_or_wrong_under_any_flood() {
    // `make other-robots` sets the number of robots to 100.
    let robot_count = read_positive_number("LIZARD_ROBOTS", 4);
    for_each_in_parallel(&[0, 1], |parity| {
        for number in (*parity..robot_count).step_by(2) {
            let mut rng = rng(2_000 + number);
            let (toml, mut robot) = random_robot(&mut rng);
            // A third of the robots get many gaits with short names, and another third many gaits with long names.
            match number % 3 {
                1 => robot = with_many_gaits(&toml, 10),
                2 => robot = with_many_gaits(&toml, MAX_NAME_BYTES),
                _ => {}
            }
            let robot_name = format!("robot {number}");
            let gaits = gait_choice::list_moving_gaits(&robot);
            for flood in FLOODS {
                let gait = gaits[rng.usize(..gaits.len())];
                assert_frames_exact(&robot, gait, flood, &robot_name);
            }
        }
    });
}

#[test]
fn the_longest_step_of_main_stays_within_its_bound_for_any_number_of_gaits() {
    /// Upper bound of the cycles of a step that does not search for a gait's name. The longest is `factory`.
    const MAX_CYCLES_WITHOUT_SEARCH: usize = 34_000;
    let (toml, robot) = random_robot(&mut rng(2_000));
    let name_lengths = [10, 24, MAX_NAME_BYTES];
    let robots = name_lengths.map(|length| with_many_gaits(&toml, length));
    for robot in robots.iter().chain([&robot]) {
        let cycles =
            measure_longest_step(&FirmwareBench::elf_path(), robot).expect("the measurement runs");
        let search_cycles = robot.max_search_cycles();
        let result = format!("{cycles} cycles, bound of the search {search_cycles}");
        println!("{} gaits: {result}", robot.gaits().len());
        let max_cycles = search_cycles.max(MAX_CYCLES_WITHOUT_SEARCH);
        assert!(cycles as usize <= max_cycles, "{result}");
        // If the search is the longest step, the bound is less than twice the measured time.
        let is_tight = cycles as usize > search_cycles / 2;
        let is_search_longest = search_cycles >= MAX_CYCLES_WITHOUT_SEARCH;
        assert!(is_tight || !is_search_longest, "{result}");
    }
}
