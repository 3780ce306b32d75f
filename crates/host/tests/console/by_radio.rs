//! Tests of scripts that are sent by radio, through a port that does not reset the board.

use lizard_time_limit::LIMIT;

use crate::fixture::{Uno, moving_gait, run};

#[test]
fn a_script_by_radio_uses_deadman_so_the_robot_stops_when_the_script_ends() {
    let folder = tempfile::tempdir().expect("a temporary folder is created");
    let uno = Uno::start_by_radio(folder.path());
    // The radio loses lines, so the script is repeated until all answers have arrived.
    let send_script = |lines: &str, expected: &[&str]| {
        let mut text = String::new();
        LIMIT.expect("all answers to the script", || {
            // Longer than the `deadman` time, so that the robot stops.
            std::thread::sleep(std::time::Duration::from_millis(1_500));
            text = run(folder.path(), &["console", &uno.port()], lines).0;
            expected.iter().all(|answer| text.contains(answer))
        });
        text
    };
    let gait = moving_gait(folder.path());
    let accepted = format!("ok {gait}");
    send_script(
        &format!("stand\n{gait}\ncal\n"),
        &[
            "not reset",
            &accepted,
            "# deadman 0",
            "(the robot stops by itself now",
        ],
    );
    send_script("status\n", &["ok gait=stop", "fault=link"]);
    let stop_text = send_script(
        &format!("{gait}\nstop\nstatus\n"),
        &[&accepted, "ok stop", "ok gait=stop"],
    );
    assert!(!stop_text.contains("fault=link"), "{stop_text}");
}
