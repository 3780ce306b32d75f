//! Tests of the `deadman` setting while a person drives.

use std::cell::Cell;

use super::*;

/// Starts a session of a person who drives; also returns its start.
pub(super) fn start_driving(polls_status: bool) -> (Instant, Session) {
    let (now, session) = start(polls_status, false);
    (now, session.with_deadman())
}

/// Runs the session for a second with the robot's answers from `answer_line`, and advances `now`. Returns the sent
/// lines without `status`, separated by commas.
pub(super) fn run_session(
    session: &mut Session,
    now: &mut Instant,
    answer_line: impl Fn(&str) -> String,
) -> String {
    let mut lines = Vec::new();
    for _ in 0..100 {
        if let Some(line) = session.take_next_line(*now) {
            for received_line in answer_line(&line).lines() {
                session.receive(received_line);
            }
            lines.push(line);
        }
        *now += Duration::from_millis(10);
    }
    lines.retain(|line| line != "status");
    lines.join(", ")
}

pub(super) fn answer_as_robot(line: &str) -> String {
    match line {
        "status" => WALKING_STATUS.to_owned(),
        "cal" => "# boot stand\n# deadman 700\nok cal".to_owned(),
        line => format!("ok {}", line.trim()),
    }
}

#[test]
fn driving_sets_deadman_and_sends_lines_in_time() {
    let (mut now, mut session) = start_driving(true);
    session.queue("walk");
    for line in [&["cal", "deadman 700", "walk"][..], &["status"; 20]].concat() {
        assert_sends(&mut session, now, Some(line));
        for received_line in answer_as_robot(line).lines() {
            session.receive(received_line);
        }
        now += Duration::from_millis(700 / 3);
    }
}

#[test]
fn deadman_is_restored_before_cal_and_set_again_afterwards() {
    let (mut now, mut session) = start_driving(false);
    for line in ["walk", "cal"] {
        session.queue(line);
    }
    let lines = run_session(&mut session, &mut now, answer_as_robot);
    let expected = "cal, deadman 700, walk, deadman 700, cal, deadman 700";
    assert_eq!(lines, expected);
}

#[test]
fn a_gait_after_stop_starts_only_with_deadman_set() {
    for answered_count in 0..3 {
        let (mut now, mut session) = start_driving(false);
        session.queue("walk");
        run_session(&mut session, &mut now, answer_as_robot);
        session.queue("cal");
        for _ in 0..answered_count {
            let line = session.take_next_line(now).expect("a line is due");
            session.receive(&format!("ok {line}"));
        }
        session.take_next_line(now); // the answer is lost
        session.stop(now);
        assert_sends(&mut session, now, Some("stop"));
        session.receive("ok stop");
        session.queue("walk");
        let lines = run_session(&mut session, &mut now, answer_as_robot);
        assert_eq!(lines, "deadman 700, walk", "{answered_count} answers");
    }
}

#[test]
fn a_stop_that_drops_load_keeps_the_robots_own_deadman() {
    let (mut now, mut session) = start_driving(true);
    session.queue("walk");
    let answer_with_own_deadman = |line: &str| answer_as_robot(line).replace("700", "2000");
    run_session(&mut session, &mut now, answer_with_own_deadman);
    session.queue("load");
    session.stop(now);
    let answer_with_driving_deadman = |line: &str| answer_as_robot(line).replace("700", "901");
    let lines = run_session(&mut session, &mut now, answer_with_driving_deadman);
    assert_eq!(lines, "stop, cal, deadman 901");
    assert_eq!(session.restore_deadman().as_deref(), Some("deadman 2000"));
}

#[test]
fn a_stopped_robot_gets_its_own_deadman_back() {
    let (mut now, mut session) = start_driving(true);
    let answer_with_own_deadman = |line: &str| answer_as_robot(line).replace("700", "2000");
    session.queue("walk");
    let lines = run_session(&mut session, &mut now, answer_with_own_deadman);
    assert_eq!(lines, "cal, deadman 901, walk");
    session.queue("save");
    let lines = run_session(&mut session, &mut now, answer_with_own_deadman);
    assert_eq!(lines, "deadman 2000, save, deadman 901");
    session.stop(now);
    let answer_as_stopped_robot =
        |line: &str| answer_with_own_deadman(line).replace("gait=walk", "gait=stop");
    let lines = run_session(&mut session, &mut now, answer_as_stopped_robot);
    assert_eq!(lines, "stop, deadman 2000");
    assert_eq!(session.restore_deadman(), None);
}

#[test]
fn a_robot_is_driven_while_its_routine_rests() {
    let answer_as_resting_robot =
        |line: &str| answer_as_robot(line).replace("gait=walk", "gait=rest");
    for end in ["# done", "ok stop", "ok rest"] {
        let (mut now, mut session) = start_driving(true);
        session.queue("patrol");
        run_session(&mut session, &mut now, answer_as_resting_robot);
        assert!(session.is_driven());

        // The answer to the name of another routine is lost, but the status shows that it runs.
        session.receive(end);
        run_session(&mut session, &mut now, answer_as_robot);
        run_session(&mut session, &mut now, answer_as_resting_robot);
        assert!(session.is_driven());

        session.receive(end);
        run_session(&mut session, &mut now, answer_as_resting_robot);
        assert!(!session.is_driven(), "{end}");
    }
}

#[test]
fn deadman_left_by_an_earlier_run_is_restored_as_zero() {
    let (mut now, mut session) = start_driving(true);
    session.queue("arc left");
    let answer_with_driving_deadman = |line: &str| answer_as_robot(line).replace("700", "901");
    run_session(&mut session, &mut now, answer_with_driving_deadman);
    assert_eq!(session.restore_deadman().as_deref(), Some("deadman 0"));
}

#[test]
fn a_script_sets_no_deadman() {
    let (mut now, mut session) = start(true, false);
    session.queue("walk");
    let lines = run_session(&mut session, &mut now, answer_as_robot);
    assert_eq!(lines, "walk");
}

#[test]
fn a_gait_starts_only_after_deadman_is_confirmed() {
    let (now, mut session) = start_driving(false);
    session.queue("walk");
    assert_sends(&mut session, now, Some("cal"));
    session.receive("# deadman 0");
    session.receive("ok cal");
    assert_sends(&mut session, now, Some("deadman 901"));
    let later = now + ANSWER_TIMEOUT;
    let message = session.time_out_request(later);
    let message = message.expect("the user gets a message");
    assert!(message.contains("not sent"), "{message}");
    assert_sends(&mut session, later, None); // walk is not sent
    assert!(session.check_all_accepted().is_err()); // the failure is counted
    session.queue("walk");
    assert_sends(&mut session, later, Some("deadman 901"));
}

#[test]
fn an_unknown_deadman_is_neither_replaced_nor_restored() {
    let (now, mut session) = start_driving(false);
    session.queue("walk");
    assert_sends(&mut session, now, Some("cal"));
    session.receive("# boot stand"); // the link has lost the line with the setting
    let message = session.receive("ok cal").expect("the user gets a message");
    assert!(message.contains("not sent"), "{message}");
    assert_sends(&mut session, now, None);

    session.queue("walk");
    assert_sends(&mut session, now, Some("cal"));
    assert_eq!(session.restore_deadman(), None); // the user quits before the answer
}

#[test]
fn a_setting_during_a_drive_becomes_the_robots_own_and_the_robot_is_still_driven() {
    let answer_with_zero = |line: &str| answer_as_robot(line).replace("700", "0");
    for (line, sent_lines, own_ms) in [
        ("deadman 5000", "deadman 5000, deadman 901", 5000),
        ("factory", "deadman 0, factory, cal, deadman 901", 0),
        ("load", "deadman 0, load, cal, deadman 901", 0),
    ] {
        let (mut now, mut session) = start_driving(true);
        session.queue("walk");
        run_session(&mut session, &mut now, answer_with_zero);
        session.queue(line);
        let lines = run_session(&mut session, &mut now, answer_with_zero);
        assert_eq!(lines, sent_lines);
        let own_line = format!("deadman {own_ms}");
        assert_eq!(session.restore_deadman(), Some(own_line));
    }
}

#[test]
fn a_gait_after_load_reads_the_loaded_deadman() {
    let (mut now, mut session) = start_driving(false);
    session.queue("walk");
    run_session(&mut session, &mut now, answer_as_robot);
    session.restore_deadman();
    session.queue("load");
    session.queue("walk");
    let lines = run_session(&mut session, &mut now, answer_as_robot);
    assert_eq!(lines, "load, cal, deadman 700, walk");
}

/// Starts a drive at the time `now`, which advances, and lets the robot report that its gait has ended.
pub(super) fn end_drive(session: &mut Session, now: &mut Instant) {
    session.queue("walk");
    run_session(session, now, answer_as_robot);
    *now += deadman::LINE_INTERVAL;
    assert_sends(session, *now, Some("status"));
    session.receive(&WALKING_STATUS.replace("gait=walk", "gait=stop"));
}

#[test]
fn a_gait_at_the_end_of_another_is_driven_too() {
    let (mut now, mut session) = start_driving(true);
    end_drive(&mut session, &mut now);
    session.queue("back");
    assert_sends(&mut session, now, Some("back"));
    session.receive("ok back");
    assert!(session.is_driven());
}

#[test]
fn deadman_is_restored_again_if_the_robot_has_not_confirmed_it() {
    let (mut now, mut session) = start_driving(true);
    end_drive(&mut session, &mut now);
    assert_sends(&mut session, now, Some("deadman 700"));
    now += ANSWER_TIMEOUT;
    assert!(session.time_out_request(now).is_some());
    assert_sends(&mut session, now, Some("status"));
    session.receive(&WALKING_STATUS.replace("gait=walk", "gait=stop"));
    assert_sends(&mut session, now, Some("deadman 700"));
    now += ANSWER_TIMEOUT;
    assert!(session.time_out_request(now).is_some());
    // The robot may have its own setting again.
    session.queue("walk");
    let lines = run_session(&mut session, &mut now, answer_as_robot);
    assert_eq!(lines, "deadman 700, walk");
    assert!(session.is_driven());
}

#[test]
fn the_value_for_driving_does_not_stay_if_a_line_about_it_is_refused_or_its_answer_is_incomplete() {
    // `load` sends `deadman 2000`, `load`, `cal` and `deadman 901`; `stop` drops the first two.
    for (is_stopped, damaged_line, answer, expected) in [
        (false, "deadman 2000", "err 1", "deadman 2000, deadman 2000"),
        (
            true,
            "deadman 901",
            "err 1",
            "stop, cal, deadman 901, deadman 2000",
        ),
        (
            true,
            "cal",
            "# boot stand\nok cal",
            "stop, cal, cal, deadman 2000",
        ),
    ] {
        let (mut now, mut session) = start_driving(true);
        session.queue("walk");
        let answer_with_own_deadman = |line: &str| answer_as_robot(line).replace("700", "2000");
        run_session(&mut session, &mut now, answer_with_own_deadman);
        session.queue("load");
        if is_stopped {
            session.stop(now);
        }
        let damage_count = Cell::new(0);
        let answer_with_damage = |line: &str| match line {
            "status" => WALKING_STATUS.replace("gait=walk", "gait=stop"),
            line if line == damaged_line && damage_count.replace(1) == 0 => answer.to_owned(),
            line => answer_as_robot(line).replace("700", "901"),
        };
        let lines = run_session(&mut session, &mut now, answer_with_damage);
        assert_eq!(lines, expected);
        assert!(!session.is_driven());
    }
}

#[test]
fn save_stores_the_robots_own_deadman_even_if_the_robot_has_not_reported_it() {
    let (mut now, mut session) = start_driving(true);
    session.queue("walk");
    run_session(&mut session, &mut now, answer_as_robot);
    session.queue("load");
    let answer_with_driving_value = |line: &str| match line {
        "cal" => "# deadman 901\nok cal".to_owned(),
        line => answer_as_robot(line),
    };
    for line in ["deadman 700", "load"] {
        assert_sends(&mut session, now, Some(line));
        session.receive(&answer_as_robot(line));
    }
    assert_sends(&mut session, now, Some("cal"));
    session.receive("ok cal"); // the link has lost the line with the setting
    session.queue("save");
    let lines = run_session(&mut session, &mut now, answer_with_driving_value);
    assert_eq!(lines, "cal, deadman 700, save, deadman 700");
}

#[test]
fn a_reset_during_the_preparation_of_a_drive_starts_it_again() {
    let (mut now, mut session) = start_driving(false);
    session.queue("walk");
    assert_sends(&mut session, now, Some("cal"));
    session.receive("# lizard 0.2.0");
    let lines = run_session(&mut session, &mut now, answer_as_robot);
    assert_eq!(lines, "cal, deadman 700, walk");
    assert_eq!(session.restore_deadman().as_deref(), Some("deadman 700"));
}
