//! Tests of scripts sent by radio, through a port that does not reset the board.

use lizard_time_limit::TIME_LIMIT;

use crate::fixture::{Uno, find_gait_except_stand, run_unchecked};

#[test]
fn the_robot_stops_after_a_script_by_radio_because_console_sets_deadman() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start_by_radio(&folder);
    let command = format!("console {}", uno.port());
    // The radio loses lines, so the script is repeated until all answers have arrived.
    let send_script = |lines: &str, expected: &[&str]| {
        let mut text = String::new();
        TIME_LIMIT.wait_for("all answers to the script", || {
            // The sleep is longer than the `deadman` time, so that the robot stops.
            std::thread::sleep(std::time::Duration::from_millis(1_500));
            (text, ..) = run_unchecked(&folder, &command, lines);
            expected.iter().all(|answer| text.contains(answer))
        });
        text
    };
    let gait = find_gait_except_stand(&folder);
    let accepted = format!("ok {gait}");
    send_script(
        &format!("stand\n{gait}\ncal\n"),
        &[
            "not reset",
            &accepted,
            "# deadman 0",
            "(no more lines: the robot now stops by itself)",
        ],
    );
    send_script("status\n", &["ok gait=stop", "fault=link"]);
    let text = send_script(
        &format!("{gait}\nstop\nstatus\n"),
        &[&accepted, "ok stop\nok gait=stop"],
    );
    // The text may begin with late answers to the program's own `status` lines.
    let (_, status) = text.split_once("ok stop\n").expect("`stop` is accepted");
    assert!(!status.contains("fault=link"), "{text}");
}
