//! Tests of the lines that `status` and `watch` print.

use super::*;

#[test]
fn status_reports_each_value_under_its_key() {
    let mut robot = wake_asymmetric_robot();
    robot.board.late_edges = 7;
    robot.board.lost_bytes = 65_535;
    robot.run_frames(1);
    robot.send_line("speed 42");
    robot.send_and_run("sway left", 200);
    let line = robot.send_line("status");
    let motion = robot.motion();
    let phase = (u64::from(motion.phase()) * 1000) >> 24;
    let angles = motion.pose().angles(&motion.robot().neutral_angles());
    let angles = angles.map(|angle| {
        let centideg = angle.centideg();
        format!("{}.{:02}", centideg / 100, centideg % 100)
    });
    let clearance = Clearance::measure(motion.robot(), motion.pose());
    let margin = clearance.min_margin().thousandths();
    let expected = format!(
        "ok gait=sway-left phase=0.{phase:03} pose={} margin=0.{margin:03} speed=42 frames={} \
         late=7 rx_lost=65535 guard=clear fault=none reset=power resets=0 vcc=5.00 rail=6.00",
        angles.join(","),
        motion.frame_count(),
    );
    assert_eq!(line, expected);
}

#[test]
fn status_omits_a_voltage_until_it_is_measured() {
    let mut robot = RunningRobot::power_on(*Sample::asymmetric());
    robot.read_lines();
    let line = robot.send_line("status");
    assert!(line.ends_with(" resets=0"), "{line}");
    robot.run_frames(4);
    robot.expect_status(&[("vcc", "5.00"), ("rail", "6.00")]);
}

#[test]
fn status_shows_the_robots_activity() {
    let mut robot = wake_asymmetric_robot();
    assert_eq!(robot.status_value("gait"), "stand");
    for (command, name) in [
        ("sway", "sway"),
        ("sway left", "sway-left"),
        (NEUTRAL_COMMAND, "pose"),
        ("stop", "stop"),
        ("rest", "rest"),
        ("stand", "stand"),
    ] {
        robot.send_line(command);
        assert_eq!(robot.status_value("gait"), name);
    }
}

#[test]
fn the_longest_possible_status_fits_into_an_output_line() {
    let name = "longest name of a gait that any robot may have..";
    assert_eq!(name.len(), crate::numbers::gaits::MAX_NAME_BYTES);
    let mut robot = wake_robot(Sample::asymmetric().with_gait(name));
    robot.board.late_edges = u16::MAX;
    robot.board.lost_bytes = u16::MAX;
    robot.expect_accepted(name);
    let line = robot.send_line("status");
    let values = parse_pairs(line.strip_prefix("ok ").expect("the line is a status"));
    // The keys whose values could be longer than in this line, each with its longest possible value.
    let longest_values = [
        ("phase", "0.999"),
        ("pose", "359.99,359.99,359.99,359.99"),
        ("margin", "-1.000"),
        ("speed", "100"),
        ("frames", "4294967295"),
        ("guard", "clear"),
    ];
    let extra_lengths = longest_values.map(|(key, longest)| longest.len() - values[key].len());
    let extra_bytes: usize = extra_lengths.iter().sum();
    assert!(line.len() + extra_bytes + "\r\n".len() <= usize::from(MAX_OUTPUT_LINE_BYTES));
}

#[test]
fn watch_reports_the_pose_of_every_nth_frame_until_watch_0() {
    for interval in [1u32, 2, 7, 50] {
        let mut robot = wake_and_send(&["sway"]);
        robot.send_line(&format!("watch {interval}"));
        let start_frame = robot.motion().frame_count();
        let mut report_frames = Vec::new();
        for _ in 0..200 {
            for line in robot.run_frames(1) {
                let report = parse_pairs(line.strip_prefix("# ").expect("the line is a report"));
                let frame: u32 = report["t"].parse().expect("t is a number");
                assert_eq!(frame, robot.motion().frame_count());
                assert_eq!(report["pose"], robot.status_value("pose"));
                assert_eq!(report.len(), 2);
                report_frames.push(frame - start_frame);
            }
        }
        let expected: Vec<u32> = (1..=200).filter(|frame| frame % interval == 0).collect();
        assert_eq!(report_frames, expected);
        assert!(robot.send_and_run("watch 0", 200).is_empty());
    }
}

#[test]
fn watch_continues_at_rest_and_a_new_watch_starts_a_new_interval() {
    let mut robot = wake_and_send(&["watch 5"]);
    assert_eq!(robot.send_and_run("rest", 50).len(), 10);
    robot.run_frames(3);
    assert!(robot.send_and_run("watch 10", 9).is_empty());
    assert_eq!(robot.run_frames(1).len(), 1);
}

#[test]
fn several_unread_reports_are_written_as_one_report() {
    let mut robot = wake_and_send(&["watch 2"]);
    robot.run_without_reader(20);
    assert_eq!(robot.read_lines().len(), 1);
    robot.run_without_reader(2);
    assert!(robot.has_output());
    robot.board.send(b"watch 0\r");
    let printed_lines = robot.read_lines();
    assert_eq!(printed_lines.len(), 2, "{printed_lines:?}");
    assert_eq!(printed_lines[1], "ok watch 0");
    assert!(robot.run_frames(10).is_empty());
}
