//! Tests of refused lines and of random bytes.

use super::*;

#[test]
fn a_line_that_is_too_long_is_refused_and_the_next_line_is_executed() {
    let mut robot = wake_asymmetric_robot();
    let message = "err 6 a line has at most 63 characters";
    assert_eq!(robot.send_line(&"stand".repeat(13)), message);
    assert_eq!(robot.send_line("stand"), "ok stand");
}

/// Lines that are refused in every state of the robot.
const REFUSED_LINES: [&str; 9] = [
    "dance",
    "sway fast",
    "speed 9",
    "speed",
    "watch 10001",
    "pose 1 2 3",
    "pose 400 1 1 1",
    "pose 132.37 1 309.64 226.18",
    "pose 170 130 309.64 226.18",
];

/// Yields random bytes like those from a person, a faulty program or a broken cable.
fn any_bytes() -> impl Strategy<Value = Vec<u8>> {
    let mut lines = GAIT_NAMES.to_vec();
    lines.extend([
        "help",
        "stop",
        "rest",
        "speed 33",
        "watch 9",
        "watch 0",
        "status",
        NEUTRAL_COMMAND,
    ]);
    lines.extend(REFUSED_LINES);
    let line = prop::sample::select(lines).prop_map(|line| format!("{line}\r").into_bytes());
    let piece = prop_oneof![
        4 => line,
        1 => prop::collection::vec(any::<u8>(), 0..40),
        1 => "[ -~\x08\x7f\t]{0,80}[\r\n]{0,2}".prop_map(String::into_bytes),
        2 => "(pose|speed|watch|sway|POSE)( [+-]?[0-9]{0,6}\\.?[0-9]{0,3}){0,5}\r\n"
            .prop_map(String::into_bytes),
    ];
    prop::collection::vec(piece, 0..12).prop_map(|pieces| pieces.concat())
}

/// Counts the final lines that these bytes must get.
fn count_expected_final_lines(bytes: &[u8]) -> usize {
    let mut line = Line::new();
    let ends_line = |byte: &&u8| line.push(**byte).is_some();
    bytes.iter().filter(ends_line).count()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn every_random_line_gets_one_final_line_however_slowly_its_bytes_arrive(
        bytes in any_bytes(),
        frames_between_bytes in 0u32..3,
    ) {
        let (mut burst_robot, mut bytewise_robot) = (wake_asymmetric_robot(), wake_asymmetric_robot());
        let keep_final_lines = |lines: Vec<String>| -> Vec<String> {
            lines.into_iter().filter(|line| is_answer(line)).collect()
        };
        let burst_lines = keep_final_lines(burst_robot.send(&bytes));
        prop_assert_eq!(burst_lines.len(), count_expected_final_lines(&bytes));
        let mut bytewise_lines = Vec::new();
        for byte in &bytes {
            bytewise_lines.extend(bytewise_robot.send(&[*byte]));
            bytewise_lines.extend(bytewise_robot.run_frames(frames_between_bytes));
        }
        // Only the answer to `status` depends on time, and no other answer contains `=`.
        let omit_status = |lines: Vec<String>| -> Vec<String> {
            lines.into_iter().filter(|line| !line.contains('=')).collect()
        };
        prop_assert_eq!(omit_status(keep_final_lines(bytewise_lines)), omit_status(burst_lines));
    }

    #[test]
    fn a_refused_line_changes_nothing(
        history in prop::collection::vec((prop::sample::select(GAIT_NAMES.to_vec()), 0u32..90), 0..4),
        speed in 10u8..=100,
        line in prop::sample::select(REFUSED_LINES.to_vec()),
    ) {
        let mut tested_robot = wake_and_send(&[&format!("speed {speed}")]);
        for (gait, frames) in history {
            tested_robot.send_line(gait);
            tested_robot.run_frames(frames);
        }
        let mut undisturbed_robot = tested_robot.clone();
        prop_assert!(tested_robot.send_line(line).starts_with("err "));
        for _ in 0..40 {
            prop_assert_eq!(tested_robot.run_frame(), undisturbed_robot.run_frame());
            prop_assert_eq!(tested_robot.read_lines(), undisturbed_robot.read_lines());
        }
        prop_assert_eq!(tested_robot.send_line("status"), undisturbed_robot.send_line("status"));
    }
}
