use super::*;

const WALKING_STATUS: &str = "ok gait=walk phase=0 pose=1,2,3,4 margin=0.5 guard=clear fault=none";

/// Starts a session; also returns its start.
fn start(polls_status: bool, watches_poses: bool) -> (Instant, Session) {
    let now = Instant::now();
    (now, Session::new(now, polls_status, watches_poses))
}

/// Starts a session of a person who drives; also returns its start.
fn start_driving(polls_status: bool) -> (Instant, Session) {
    let (now, session) = start(polls_status, false);
    (now, session.with_deadman())
}

/// Checks the line that the session sends at `time`; `None` stands for no line.
#[track_caller]
fn assert_sends(session: &mut Session, time: Instant, line: Option<&str>) {
    assert_eq!(session.take_next_line(time).as_deref(), line);
}

/// Checks that the session shows a line from the robot to the user.
#[track_caller]
fn assert_shows(session: &mut Session, line: &str) {
    assert_eq!(session.receive(line).as_deref(), Some(line));
}

#[test]
fn a_users_line_is_sent_after_the_previous_answer() {
    let (now, mut session) = start(true, false);
    assert_sends(&mut session, now, Some("status"));
    session.queue("walk");
    session.queue("speed 50");
    assert_sends(&mut session, now, None); // the status has not been answered
    assert_eq!(session.receive(WALKING_STATUS), None); // the user did not ask for it
    assert_sends(&mut session, now, Some("walk"));
    assert_shows(&mut session, "# fault: x");
    assert_sends(&mut session, now, None);
    assert_shows(&mut session, "ok walk");
    assert_sends(&mut session, now, Some("speed 50"));
    assert_shows(&mut session, "ok speed 50");
    assert!(session.is_idle());
    assert_sends(&mut session, now, None); // the next status is not due
    assert_sends(&mut session, now + STATUS_INTERVAL, Some("status"));
    assert!(session.status().is_some_and(Status::is_walking));
}

#[test]
fn a_status_requested_by_the_user_is_shown() {
    let (now, mut session) = start(false, false);
    session.queue("status");
    session.take_next_line(now);
    assert_shows(&mut session, WALKING_STATUS);
}

#[test]
fn a_reset_cancels_the_request_and_repeats_watch() {
    let (now, mut session) = start(false, true);
    assert_sends(&mut session, now, Some("watch 1"));
    session.receive("ok watch 1");
    session.queue("walk");
    session.take_next_line(now);
    session.receive("# lizard 0.2.0");
    assert_sends(&mut session, now, Some("watch 1")); // poses are requested again
}

#[test]
fn a_line_without_an_answer_before_a_reset_has_failed() {
    let (now, mut session) = start(false, false);
    session.queue("walk");
    session.take_next_line(now);
    session.receive("# lizard 0.2.0");
    let failure = session.check_all_accepted();
    let message = failure.expect_err("walk has no answer").to_string();
    assert!(message.ends_with("`walk`: no answer"), "{message}");
}

#[test]
fn poses_are_shown_only_if_the_user_asks_for_them() {
    for line in ["watch 50", "WATCH 50"] {
        let (now, mut session) = start(false, true);
        session.take_next_line(now);
        session.receive("ok watch 1");
        assert_eq!(session.receive("# t=1 pose=1,2,3,4"), None);
        session.queue(line);
        session.take_next_line(now);
        session.receive("ok watch 50");
        assert!(session.receive("# t=50 pose=1,2,3,4").is_some(), "{line}");
    }
}

#[test]
fn stop_of_a_script_is_answered_in_upper_case_too() {
    let (now, mut session) = start(false, false);
    session.queue("STOP");
    session.take_next_line(now);
    assert_shows(&mut session, "ok stop");
    assert!(session.is_idle());
}

#[test]
fn a_missing_answer_is_reported_once() {
    let (now, mut session) = start(false, false);
    session.queue("walk");
    session.queue("stop");
    session.take_next_line(now);
    assert_eq!(session.time_out_request(now), None);
    let later = now + ANSWER_TIMEOUT;
    let message = session.time_out_request(later);
    assert_eq!(message.as_deref(), Some("(no answer to `walk`)"));
    assert_eq!(session.time_out_request(later), None);
    assert_sends(&mut session, later, Some("stop"));
}

#[test]
fn stop_waits_for_no_answer_and_drops_queued_lines() {
    let (now, mut session) = start(true, false);
    assert_sends(&mut session, now, Some("status"));
    session.queue("walk");
    session.stop(now);
    assert_sends(&mut session, now, Some("stop"));
    assert_eq!(session.receive(WALKING_STATUS), None); // the answer to the earlier status
    assert_shows(&mut session, "ok stop");
    assert!(session.is_idle());
    assert_sends(&mut session, now + STATUS_INTERVAL, Some("status"));
}

#[test]
fn stop_is_repeated_until_answered_and_late_answers_are_ignored() {
    let (now, mut session) = start(false, false);
    session.stop(now);
    let mut time = now;
    for _ in 0..9 {
        assert_sends(&mut session, time, Some("stop"));
        assert_sends(&mut session, time, None);
        time += STOP_INTERVAL;
    }
    let message = session.time_out_request(time);
    let message = message.expect("the user gets a message");
    assert!(message.contains("may still move"), "{message}");
    assert_eq!(session.time_out_request(time), None, "only once");
    assert_shows(&mut session, "ok stop");
    session.queue("walk");
    assert_sends(&mut session, time, None); // late answers may still arrive
    time += LATE_ANSWER_TIME;
    assert_sends(&mut session, time, Some("walk"));
    assert_eq!(session.receive("ok stop"), None, "it does not answer walk");
    assert!(!session.is_idle());
    assert_shows(&mut session, "ok walk");
    assert!(session.is_idle());
}

#[test]
fn a_refusal_of_stop_without_pulses_ends_the_repetition() {
    for refusal in [
        "err 7 the servos are resting; send stand first",
        "err 10 no robot in the flash",
    ] {
        let (now, mut session) = start(false, false);
        session.stop(now);
        assert_sends(&mut session, now, Some("stop"));
        assert_shows(&mut session, refusal);
        session.queue("stand");
        assert_sends(&mut session, now + STOP_INTERVAL, Some("stand"));
    }
}

#[test]
fn a_partial_refusal_does_not_answer_stop() {
    let (now, mut session) = start(false, false);
    session.stop(now);
    session.take_next_line(now);
    session.receive("err 7 the servos are resting; senok walk");
    assert_sends(&mut session, now + STOP_INTERVAL, Some("stop"));
}

#[test]
fn a_late_answer_does_not_count_for_the_next_line() {
    let (now, mut session) = start(false, false);
    session.queue("trim 1 2");
    session.queue("walk");
    session.take_next_line(now);
    session.time_out_request(now + ANSWER_TIMEOUT);
    session.take_next_line(now + ANSWER_TIMEOUT);
    session.receive("ok trim 1 2.00");
    assert!(!session.is_idle(), "walk has no answer");
    session.receive("ok walk");
    assert!(session.is_idle());
}

#[test]
fn every_event_is_kept_in_order() {
    let (now, mut session) = start(true, false);
    session.queue("walk");
    session.take_next_line(now);
    session.receive("# note");
    session.receive("err 1 no");
    session.take_next_line(now);
    session.receive(WALKING_STATUS);
    let events = [
        Event::Sent("walk".to_owned()),
        Event::Note("# note".to_owned()),
        Event::Answer("err 1 no".to_owned()),
        Event::Status(WALKING_STATUS.to_owned()),
    ];
    assert_eq!(session.take_events(), events);
    assert!(session.take_events().is_empty());
}

#[test]
fn failed_lines_are_counted_once_and_the_first_is_named() {
    let (now, mut session) = start(false, false);
    let mut ask = |line: &str, answer: Option<&str>| {
        session.queue(line);
        session.take_next_line(now);
        match answer {
            Some(answer) => drop(session.receive(answer)),
            None => drop(session.time_out_request(now + ANSWER_TIMEOUT)),
        }
        let result = session.check_all_accepted();
        result.map_err(|failure| failure.to_string())
    };
    assert_eq!(ask("walk", Some("ok walk")), Ok(()));
    let refusal =
        |count| format!("the robot did not accept {count} lines, the first `fly`: err 1 no");
    assert_eq!(ask("fly", Some("err 1 no")), Err(refusal("1 of 2")));
    assert_eq!(ask("swim", Some("err 2 no")), Err(refusal("2 of 3")));
    assert_eq!(ask("stop", None), Err(refusal("3 of 4")));
    session.receive("err 3 late");
    let failure = session
        .check_all_accepted()
        .expect_err("lines were refused");
    assert_eq!(failure.to_string(), refusal("3 of 4"));
}

/// Runs the session for `duration_ms` with the robot's answers from `answer_line`; returns the sent lines with their
/// times in ms.
fn run_session(
    session: &mut Session,
    start: Instant,
    duration_ms: u64,
    answer_line: impl Fn(&str) -> String,
) -> Vec<(u64, String)> {
    let mut lines = Vec::new();
    for time_ms in (0..duration_ms).step_by(10) {
        if let Some(line) = session.take_next_line(start + Duration::from_millis(time_ms)) {
            for received_line in answer_line(&line).lines() {
                session.receive(received_line);
            }
            lines.push((time_ms, line));
        }
    }
    lines
}

fn answer_as_robot(line: &str) -> String {
    match line {
        "status" => WALKING_STATUS.to_owned(),
        "cal" => "# boot stand\n# deadman 700\nok cal".to_owned(),
        line => format!("ok {}", line.trim()),
    }
}

fn exclude_status(lines: &[(u64, String)]) -> Vec<&str> {
    let texts = lines.iter().map(|(_, line)| line.as_str());
    texts.filter(|line| *line != "status").collect()
}

#[test]
fn driving_sets_deadman_and_sends_lines_in_time() {
    let (now, mut session) = start_driving(true);
    session.queue("walk");
    let lines = run_session(&mut session, now, 5000, answer_as_robot);
    assert_eq!(exclude_status(&lines), ["cal", "deadman 700", "walk"]);
    let gaps = lines.windows(2).map(|pair| pair[1].0 - pair[0].0);
    assert!(gaps.max().is_some_and(|gap| gap <= 700 / 3), "{lines:?}");
}

#[test]
fn deadman_is_restored_before_cal_and_set_again_afterwards() {
    let (now, mut session) = start_driving(false);
    for line in ["walk", "cal"] {
        session.queue(line);
    }
    let lines = run_session(&mut session, now, 500, answer_as_robot);
    let lines = exclude_status(&lines).join(", ");
    assert_eq!(
        lines,
        "cal, deadman 700, walk, deadman 700, cal, deadman 700"
    );
}

#[test]
fn a_stopped_robot_gets_its_own_deadman_back() {
    let (now, mut session) = start_driving(true);
    let answer_with_own_deadman = |line: &str| answer_as_robot(line).replace("700", "2000");
    session.queue("walk");
    let lines = run_session(&mut session, now, 1000, answer_with_own_deadman);
    assert_eq!(exclude_status(&lines), ["cal", "deadman 901", "walk"]);
    session.queue("save");
    let now = now + Duration::from_secs(1);
    let lines = run_session(&mut session, now, 500, answer_with_own_deadman);
    let expected = ["deadman 2000", "save", "deadman 901"];
    assert_eq!(exclude_status(&lines), expected);
    let now = now + Duration::from_secs(1);
    session.stop(now);
    let answer_as_stopped_robot =
        |line: &str| answer_with_own_deadman(line).replace("gait=walk", "gait=stop");
    let lines = run_session(&mut session, now, 2000, answer_as_stopped_robot);
    assert_eq!(exclude_status(&lines), ["stop", "deadman 2000"]);
    assert_eq!(session.restore_deadman(), None);
}

#[test]
fn a_robot_is_driven_while_its_routine_rests() {
    let answer_as_resting_robot =
        |line: &str| answer_as_robot(line).replace("gait=walk", "gait=rest");
    for end in ["# done", "ok stop", "ok rest"] {
        let (start, mut session) = start_driving(true);
        session.queue("patrol");
        run_session(&mut session, start, 500, answer_as_resting_robot);
        assert!(session.is_driven());

        // The answer to the name of another routine is lost, but the status shows that it runs.
        session.receive(end);
        let now = start + Duration::from_secs(1);
        run_session(&mut session, now, 500, answer_as_robot);
        let now = now + Duration::from_secs(1);
        run_session(&mut session, now, 500, answer_as_resting_robot);
        assert!(session.is_driven());

        session.receive(end);
        let now = now + Duration::from_secs(1);
        run_session(&mut session, now, 500, answer_as_resting_robot);
        assert!(!session.is_driven(), "{end}");
    }
}

#[test]
fn deadman_left_by_an_earlier_run_is_restored_as_zero() {
    let (now, mut session) = start_driving(true);
    session.queue("arc left");
    let answer_with_driving_deadman = |line: &str| answer_as_robot(line).replace("700", "901");
    run_session(&mut session, now, 1000, answer_with_driving_deadman);
    assert_eq!(session.restore_deadman().as_deref(), Some("deadman 0"));
}

#[test]
fn a_script_sets_no_deadman() {
    let (now, mut session) = start(true, false);
    session.queue("walk");
    let lines = run_session(&mut session, now, 1000, answer_as_robot);
    assert_eq!(exclude_status(&lines), ["walk"]);
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
        let (now, mut session) = start_driving(true);
        session.queue("walk");
        run_session(&mut session, now, 500, answer_with_zero);
        session.queue(line);
        let now = now + Duration::from_secs(1);
        let lines = run_session(&mut session, now, 500, answer_with_zero);
        assert_eq!(exclude_status(&lines).join(", "), sent_lines);
        let own_line = format!("deadman {own_ms}");
        assert_eq!(session.restore_deadman(), Some(own_line));
    }
}

#[test]
fn a_gait_after_load_reads_the_loaded_deadman() {
    let (now, mut session) = start_driving(false);
    session.queue("walk");
    run_session(&mut session, now, 500, answer_as_robot);
    session.restore_deadman();
    session.queue("load");
    session.queue("walk");
    let now = now + Duration::from_secs(1);
    let lines = run_session(&mut session, now, 500, answer_as_robot);
    let lines = exclude_status(&lines).join(", ");
    assert_eq!(lines, "load, cal, deadman 700, walk");
}

/// Starts a drive, and lets the robot report that its gait has ended; returns the time after that.
fn end_drive(session: &mut Session, start: Instant) -> Instant {
    session.queue("walk");
    run_session(session, start, 300, answer_as_robot);
    let now = start + Duration::from_secs(1);
    assert_sends(session, now, Some("status"));
    session.receive(&WALKING_STATUS.replace("gait=walk", "gait=stop"));
    now
}

#[test]
fn a_gait_at_the_end_of_another_is_driven_too() {
    let (start, mut session) = start_driving(true);
    let now = end_drive(&mut session, start);
    session.queue("back");
    assert_sends(&mut session, now, Some("back"));
    session.receive("ok back");
    assert!(session.is_driven());
}

#[test]
fn deadman_is_restored_again_if_the_robot_has_not_confirmed_it() {
    let (start, mut session) = start_driving(true);
    let now = end_drive(&mut session, start);
    assert_sends(&mut session, now, Some("deadman 700"));
    let now = now + ANSWER_TIMEOUT;
    assert!(session.time_out_request(now).is_some());
    assert_sends(&mut session, now, Some("status"));
    session.receive(&WALKING_STATUS.replace("gait=walk", "gait=stop"));
    assert_sends(&mut session, now, Some("deadman 700"));
}

#[test]
fn a_reset_during_the_preparation_of_a_drive_starts_it_again() {
    let (now, mut session) = start_driving(false);
    session.queue("walk");
    assert_sends(&mut session, now, Some("cal"));
    session.receive("# lizard 0.2.0");
    let lines = run_session(&mut session, now, 500, answer_as_robot);
    let lines = exclude_status(&lines).join(", ");
    assert_eq!(lines, "cal, deadman 700, walk");
    assert_eq!(session.restore_deadman().as_deref(), Some("deadman 700"));
}

#[test]
fn a_silent_robot_is_reported_once_until_it_answers() {
    let (mut now, mut session) = start(true, false);
    let mut ask = |is_answered: bool| {
        now += STATUS_INTERVAL;
        assert_sends(&mut session, now, Some("status"));
        if is_answered {
            session.receive(WALKING_STATUS);
        }
        now += STATUS_TIMEOUT;
        session.time_out_request(now)
    };
    assert!(ask(false).is_some_and(|message| message.contains("does not answer")));
    assert_eq!(ask(false), None);
    assert_eq!(ask(true), None);
    assert!(ask(false).is_some());
}
