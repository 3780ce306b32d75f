//! Cycle-accurate comparison of the core on the AVR and on the host, with random commands for ten minutes.
//! `LIZARD_MINUTES=2` shortens the run, so that many robots can be tested.

use fastrand::Rng;
use lizard_host::sim::core_run;
use lizard_host::sim::frame::{FRAME_CYCLES, first_cycle, group_frames};
use lizard_host_tests::{FirmwareBench, dialogue_minutes, robot};
use simulated_uno::{CYCLES_PER_MS, FREQUENCY, Fidelity};

use crate::{Status, boot_to_stand, for_each_in_parallel, format_pose, to_comparable_line};

/// Duration of a byte on the serial line in cycles, rounded up.
const CYCLES_PER_BYTE: u64 = 1400;

/// Returns the cycle at which the comparison ends.
fn end_cycle() -> u64 {
    60 * dialogue_minutes() * FREQUENCY
}

/// Returns a random line: any command, valid or not. Some lines have upper-case letters, blanks or a second line end.
fn random_line(rng: &mut Rng) -> String {
    let pose_near = |rng: &mut Rng, max_deg: f64| {
        let servos = robot().servos();
        format_pose(servos.map(|servo| servo.neutral + max_deg * (2.0 * rng.f64() - 1.0)))
    };
    match rng.u64(..20) {
        0..7 => rng
            .choice(robot().gaits())
            .expect("every robot has `stand`")
            .command(),
        7..9 => pose_near(rng, 15.0),
        9..11 => pose_near(rng, 45.0),
        11 => pose_near(rng, 100.0),
        12..14 => format!("speed {}", rng.u64(..120)),
        14 => "stop\r".into(),
        15 => ["rest", "rest", "stand", "stand", "stand"][rng.u64(..5) as usize].into(),
        16 => format!("watch {}", [0, 0, 1, 2, 9, 10_000][rng.u64(..6) as usize]),
        17 => {
            ["status", "help", "?", "arc", "pose", "speed", "walk on"][rng.u64(..7) as usize].into()
        }
        18 => {
            let length = rng.u64(..90) + 1;
            let random_character = |_| char::from(33 + rng.u64(..94) as u8);
            (0..length).map(random_character).collect()
        }
        _ => "  StaNd\t ".into(),
    }
}

/// Sends lines until a second before the end, and returns their number. Each line waits for the answer to the previous
/// line, and ends at a random time in a frame, at least a millisecond from the ticks, so that its frame is certain.
fn send_random_lines(bench: &mut FirmwareBench, first_rise: u64, rng: &mut Rng) -> u32 {
    let mut sent_count = 0;
    let mut eeprom_cycles = 0;
    // A frame's tick comes one slot before A1's pulse.
    let tick_cycle = first_rise - FRAME_CYCLES / 5;
    while bench.uno.cycle() < end_cycle() - FREQUENCY {
        let line = random_line(rng);
        let sending_cycles = (line.len() as u64 + 1) * CYCLES_PER_BYTE;
        let wait_cycles = rng.u64(..40) * rng.u64(..40) * CYCLES_PER_MS;
        let earliest_cycle = bench.uno.cycle() + eeprom_cycles + wait_cycles + sending_cycles;
        let frame = (earliest_cycle - tick_cycle).div_ceil(FRAME_CYCLES);
        let cycles_in_frame = CYCLES_PER_MS + rng.u64(..18 * CYCLES_PER_MS);
        let start_cycle = tick_cycle + frame * FRAME_CYCLES + cycles_in_frame - sending_cycles;
        bench.uno.run_until_cycle(start_cycle);
        bench.say(&line);
        sent_count += 1;
        // The main loop reads no input while it saves or erases a rest pose.
        eeprom_cycles = if line == "rest" { 250 } else { 10 } * CYCLES_PER_MS;
    }
    bench.run_ms(250);
    sent_count
}

#[test]
fn random_commands_give_the_same_widths_and_lines_on_the_avr_and_on_the_host() {
    let cases = [
        (Fidelity::Stock, 1),
        (Fidelity::DataSheet, 2),
        (Fidelity::DataSheet, 3),
    ];
    for_each_in_parallel(&cases, |&(fidelity, seed)| {
        let mut bench = boot_to_stand(fidelity);
        let first_rise = bench.first_pulse_cycle().expect("the robot stands");
        let sent_line_count = send_random_lines(&mut bench, first_rise, &mut Rng::with_seed(seed));
        Status::read(&mut bench).assert_has("late=0 rx_lost=0");

        bench.uno.run_until_cycle(end_cycle());
        let frame_count = (bench.uno.cycle() - first_cycle(first_rise)) / FRAME_CYCLES;
        let sent_frames = group_frames(&bench.uno.edges(), bench.pins(), first_rise, frame_count);
        let (received, count) = (bench.uno.received_by_uno(), sent_frames.len());
        let host_run = core_run::play(*robot().firmware(), &received, &[], first_rise, count);
        let mut distinct_widths = std::collections::HashSet::new();
        for (n, (frame, expected)) in sent_frames.iter().zip(&host_run.widths).enumerate() {
            let widths = frame.widths.map(|width| width.unwrap_or(0));
            let expected = expected.map(u64::from);
            assert_eq!(
                widths, expected,
                "frame {n} differs, or the ELF file is outdated"
            );
            distinct_widths.insert(widths);
        }
        let distinct_count = distinct_widths.len() as u64;
        let counts = [frame_count, u64::from(sent_line_count), distinct_count];
        println!("{fidelity:?}: {counts:?} frames, lines and sets of widths");
        let min_counts = [2_900, 100, 500].map(|minimum| minimum * dialogue_minutes());
        assert!((0..3).all(|i| counts[i] > min_counts[i]), "{counts:?}");

        // All other lines also agree. Reports are not compared, because the frame of a report also depends on the free
        // space in the serial buffer.
        let is_compared = |line: &&str| !line.starts_with("# t=");
        let to_comparable = |line: &'_ str| to_comparable_line(line, fidelity);
        let expected_lines = host_run.text.lines().filter(is_compared).map(to_comparable);
        let expected_lines: Vec<String> = expected_lines.collect();
        let lines = bench.lines().iter().map(|line| line.text.as_str());
        let lines: Vec<String> = lines.filter(is_compared).map(to_comparable).collect();
        for (n, (line, expected)) in lines.iter().zip(&expected_lines).enumerate() {
            assert_eq!(line, expected, "line {n}");
        }
        // The UNO runs beyond the last complete frame, and may have sent one more line; or its last line is not yet
        // complete.
        let (count, expected_count) = (lines.len(), expected_lines.len());
        let has_expected_count = count.abs_diff(expected_count) <= 1;
        assert!(has_expected_count, "{count} lines, not {expected_count}");
    });
}
