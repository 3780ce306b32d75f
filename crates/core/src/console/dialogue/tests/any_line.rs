//! Lines of any bytes and of any length.

use super::*;

#[test]
fn a_line_that_is_too_long_is_refused_and_the_next_one_is_read() {
    let mut dialogue = wake_odd_robot();
    let message = "err 6 a line has at most 63 characters";
    assert_eq!(dialogue.send_line(&"stand".repeat(13)), message);
    assert_eq!(dialogue.send_line("stand"), "ok stand");
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

/// Bytes as from a person, from a faulty program, and from a broken cable.
fn any_bytes() -> impl Strategy<Value = Vec<u8>> {
    let mut lines = GAITS.to_vec();
    lines.extend([
        "help", "stop", "rest", "speed 33", "watch 9", "watch 0", "status", NEUTRAL,
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

/// The number of final lines with which the robot must answer these bytes.
fn count_answers_due(bytes: &[u8]) -> usize {
    let mut line = Line::new();
    bytes
        .iter()
        .filter(|byte| line.push(**byte).is_some())
        .count()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn every_line_of_any_bytes_gets_one_final_line_with_any_frames_between(
        bytes in any_bytes(),
        frames_between in 0u32..3,
    ) {
        let (mut whole_dialogue, mut slow_dialogue) = (wake_odd_robot(), wake_odd_robot());
        let final_lines_of = |lines: Vec<String>| -> Vec<String> {
            lines.into_iter().filter(|line| is_final(line)).collect()
        };
        let whole_lines = final_lines_of(whole_dialogue.send(&bytes));
        prop_assert_eq!(whole_lines.len(), count_answers_due(&bytes));
        let mut slow_lines = Vec::new();
        for byte in &bytes {
            slow_lines.extend(slow_dialogue.send(&[*byte]));
            slow_lines.extend(slow_dialogue.run_frames(frames_between));
        }
        // Only the answer to `status` depends on time; it is the one with `=`.
        let timeless_lines_of = |lines: Vec<String>| -> Vec<String> {
            lines.into_iter().filter(|line| !line.contains('=')).collect()
        };
        prop_assert_eq!(timeless_lines_of(final_lines_of(slow_lines)), timeless_lines_of(whole_lines));
    }

    #[test]
    fn a_refused_line_changes_nothing(
        history in prop::collection::vec((prop::sample::select(GAITS.to_vec()), 0u32..90), 0..4),
        speed in 10u8..=100,
        line in prop::sample::select(REFUSED_LINES.to_vec()),
    ) {
        let [mut asked_dialogue, mut spared_dialogue] = [(); 2].map(|()| wake_odd_robot());
        for dialogue in [&mut asked_dialogue, &mut spared_dialogue] {
            dialogue.send_line(&format!("speed {speed}"));
            for (gait, frames) in &history {
                dialogue.send_line(gait);
                dialogue.run_frames(*frames);
            }
        }
        prop_assert!(asked_dialogue.send_line(line).starts_with("err "));
        for _ in 0..40 {
            prop_assert_eq!(asked_dialogue.frame(), spared_dialogue.frame());
            prop_assert_eq!(asked_dialogue.read_lines(), spared_dialogue.read_lines());
        }
        prop_assert_eq!(asked_dialogue.send_line("status"), spared_dialogue.send_line("status"));
    }
}
