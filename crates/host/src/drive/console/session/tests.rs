use super::*;

const WALKING_STATUS: &str = "ok gait=walk phase=0 pose=1,2,3,4 margin=0.5 guard=clear fault=none";

#[test]
fn a_users_line_is_sent_after_the_previous_answer() {
    let now = Instant::now();
    let mut session = Session::new(now, true, false);
    assert_eq!(session.take_next_line(now).as_deref(), Some("status"));
    session.queue("walk");
    session.queue("speed 50");
    assert_eq!(
        session.take_next_line(now),
        None,
        "the status has not been answered"
    );
    assert_eq!(
        session.receive(WALKING_STATUS),
        None,
        "the user did not ask for it"
    );
    assert_eq!(session.take_next_line(now).as_deref(), Some("walk"));
    assert_eq!(session.receive("# fault: x").as_deref(), Some("# fault: x"));
    assert_eq!(session.take_next_line(now), None);
    assert_eq!(session.receive("ok walk").as_deref(), Some("ok walk"));
    assert_eq!(session.take_next_line(now).as_deref(), Some("speed 50"));
    assert_eq!(
        session.receive("ok speed 50").as_deref(),
        Some("ok speed 50")
    );
    assert!(session.is_idle());
    assert_eq!(
        session.take_next_line(now),
        None,
        "the next status is not due"
    );
    assert_eq!(
        session.take_next_line(now + STATUS_INTERVAL).as_deref(),
        Some("status")
    );
    assert!(session.status().is_some_and(Status::is_moving));
}

#[test]
fn a_status_requested_by_the_user_is_shown() {
    let now = Instant::now();
    let mut session = Session::new(now, false, false);
    session.queue("status");
    session.take_next_line(now);
    assert_eq!(
        session.receive(WALKING_STATUS).as_deref(),
        Some(WALKING_STATUS)
    );
}

#[test]
fn a_reset_cancels_the_request_and_repeats_watch() {
    let now = Instant::now();
    let mut session = Session::new(now, false, true);
    assert_eq!(session.take_next_line(now).as_deref(), Some("watch 1"));
    session.receive("ok watch 1");
    session.queue("walk");
    session.take_next_line(now);
    session.receive("# lizard 0.2.0");
    assert_eq!(
        session.take_next_line(now).as_deref(),
        Some("watch 1"),
        "poses are requested again"
    );
}

#[test]
fn poses_are_shown_only_if_the_user_asks_for_them() {
    let now = Instant::now();
    let mut session = Session::new(now, false, true);
    session.take_next_line(now);
    session.receive("ok watch 1");
    assert_eq!(session.receive("# t=1 pose=1,2,3,4"), None);
    session.queue("watch 50");
    session.take_next_line(now);
    session.receive("ok watch 50");
    assert!(session.receive("# t=50 pose=1,2,3,4").is_some());
}

#[test]
fn a_missing_answer_is_reported_once() {
    let now = Instant::now();
    let mut session = Session::new(now, false, false);
    session.queue("walk");
    session.queue("stop");
    session.take_next_line(now);
    assert_eq!(session.time_out_request(now), None);
    let later = now + ANSWER_TIMEOUT;
    assert_eq!(
        session.time_out_request(later).as_deref(),
        Some("(no answer to `walk`)")
    );
    assert_eq!(session.time_out_request(later), None);
    assert_eq!(session.take_next_line(later).as_deref(), Some("stop"));
}

#[test]
fn stop_waits_for_no_answer_and_drops_queued_lines() {
    let now = Instant::now();
    let mut session = Session::new(now, true, false);
    assert_eq!(session.take_next_line(now).as_deref(), Some("status"));
    session.queue("walk");
    session.stop(now);
    assert_eq!(session.take_next_line(now).as_deref(), Some("stop"));
    assert_eq!(
        session.receive(WALKING_STATUS),
        None,
        "the answer to the earlier status"
    );
    assert_eq!(session.receive("ok stop").as_deref(), Some("ok stop"));
    assert!(session.is_idle());
    assert_eq!(
        session.take_next_line(now + STATUS_INTERVAL).as_deref(),
        Some("status")
    );
}

#[test]
fn stop_is_repeated_until_answered_and_late_answers_are_ignored() {
    let now = Instant::now();
    let mut session = Session::new(now, false, false);
    session.stop(now);
    let mut time = now;
    for _ in 0..9 {
        assert_eq!(session.take_next_line(time).as_deref(), Some("stop"));
        assert_eq!(session.take_next_line(time), None);
        time += STOP_INTERVAL;
    }
    let message = session
        .time_out_request(time)
        .expect("the user gets a message");
    assert!(message.contains("may still move"), "{message}");
    assert_eq!(session.time_out_request(time), None, "only once");
    assert_eq!(session.receive("ok stop").as_deref(), Some("ok stop"));
    session.queue("walk");
    assert_eq!(
        session.take_next_line(time),
        None,
        "late answers may still arrive"
    );
    time += LATE_ANSWER_TIME;
    assert_eq!(session.take_next_line(time).as_deref(), Some("walk"));
    assert_eq!(session.receive("ok stop"), None, "it does not answer walk");
    assert!(!session.is_idle());
    assert_eq!(session.receive("ok walk").as_deref(), Some("ok walk"));
    assert!(session.is_idle());
}

#[test]
fn a_refusal_of_stop_without_pulses_ends_the_repetition() {
    for refusal in [
        "err 7 the servos are resting; send stand first",
        "err 10 no robot in the flash",
    ] {
        let now = Instant::now();
        let mut session = Session::new(now, false, false);
        session.stop(now);
        assert_eq!(session.take_next_line(now).as_deref(), Some("stop"));
        assert_eq!(session.receive(refusal).as_deref(), Some(refusal));
        session.queue("stand");
        assert_eq!(
            session.take_next_line(now + STOP_INTERVAL).as_deref(),
            Some("stand")
        );
    }
}

#[test]
fn a_partial_refusal_does_not_answer_stop() {
    let now = Instant::now();
    let mut session = Session::new(now, false, false);
    session.stop(now);
    session.take_next_line(now);
    session.receive("err 7 the servos are resting; senok walk");
    let next = session.take_next_line(now + STOP_INTERVAL);
    assert_eq!(next.as_deref(), Some("stop"));
}

#[test]
fn a_late_answer_does_not_count_for_the_next_line() {
    let now = Instant::now();
    let mut session = Session::new(now, false, false);
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
    let now = Instant::now();
    let mut session = Session::new(now, true, false);
    session.queue("walk");
    session.take_next_line(now);
    session.receive("# note");
    session.receive("err 1 no");
    session.take_next_line(now);
    session.receive(WALKING_STATUS);
    let events = session.take_events();
    assert_eq!(
        events,
        [
            Event::Sent("walk".to_owned()),
            Event::Note("# note".to_owned()),
            Event::Answer("err 1 no".to_owned()),
            Event::Status(WALKING_STATUS.to_owned()),
        ]
    );
    assert!(session.take_events().is_empty());
}

#[test]
fn failed_lines_are_counted_once_and_the_first_is_named() {
    let now = Instant::now();
    let mut session = Session::new(now, false, false);
    let mut ask = |line: &str, answer: Option<&str>| {
        session.queue(line);
        session.take_next_line(now);
        match answer {
            Some(answer) => drop(session.receive(answer)),
            None => drop(session.time_out_request(now + ANSWER_TIMEOUT)),
        }
        session
            .check_all_accepted()
            .map_err(|failure| failure.to_string())
    };
    assert_eq!(ask("walk", Some("ok walk")), Ok(()));
    let expected_message =
        |count| format!("the robot did not accept {count} lines, the first `fly`: err 1 no");
    assert_eq!(
        ask("fly", Some("err 1 no")),
        Err(expected_message("1 of 2"))
    );
    assert_eq!(
        ask("swim", Some("err 2 no")),
        Err(expected_message("2 of 3"))
    );
    assert_eq!(ask("stop", None), Err(expected_message("3 of 4")));
    session.receive("err 3 late");
    assert!(
        session
            .check_all_accepted()
            .is_err_and(|failure| failure.to_string() == expected_message("3 of 4"))
    );
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
    let now = Instant::now();
    let mut session = Session::new(now, true, false).with_deadman();
    session.queue("walk");
    let lines = run_session(&mut session, now, 5000, answer_as_robot);
    assert_eq!(exclude_status(&lines), ["cal", "deadman 700", "walk"]);
    let gaps = lines.windows(2).map(|pair| pair[1].0 - pair[0].0);
    assert!(gaps.max().is_some_and(|gap| gap <= 700 / 3), "{lines:?}");
}

#[test]
fn deadman_is_restored_before_cal_and_set_again_afterwards() {
    let now = Instant::now();
    let mut session = Session::new(now, false, false).with_deadman();
    for line in ["walk", "cal"] {
        session.queue(line);
    }
    let lines = run_session(&mut session, now, 500, answer_as_robot);
    let expected = [
        "cal",
        "deadman 700",
        "walk",
        "deadman 700",
        "cal",
        "deadman 700",
    ];
    assert_eq!(exclude_status(&lines), expected);
}

#[test]
fn a_stopped_robot_gets_its_own_deadman_back() {
    let now = Instant::now();
    let mut session = Session::new(now, true, false).with_deadman();
    let answer_with_own_deadman = |line: &str| answer_as_robot(line).replace("700", "2000");
    session.queue("walk");
    let lines = run_session(&mut session, now, 1000, answer_with_own_deadman);
    assert_eq!(exclude_status(&lines), ["cal", "deadman 901", "walk"]);
    session.queue("save");
    let saved_lines = run_session(
        &mut session,
        now + Duration::from_secs(1),
        500,
        answer_with_own_deadman,
    );
    assert_eq!(
        exclude_status(&saved_lines),
        ["deadman 2000", "save", "deadman 901"]
    );
    session.stop(now + Duration::from_secs(2));
    let answer_as_stopped_robot =
        |line: &str| answer_with_own_deadman(line).replace("gait=walk", "gait=stop");
    let lines = run_session(
        &mut session,
        now + Duration::from_secs(2),
        2000,
        answer_as_stopped_robot,
    );
    assert_eq!(exclude_status(&lines), ["stop", "deadman 2000"]);
    assert_eq!(session.restore_deadman(), None);
}

#[test]
fn deadman_left_by_an_earlier_run_is_restored_as_zero() {
    let now = Instant::now();
    let mut session = Session::new(now, true, false).with_deadman();
    session.queue("arc left");
    let answer_with_driving_deadman = |line: &str| answer_as_robot(line).replace("700", "901");
    run_session(&mut session, now, 1000, answer_with_driving_deadman);
    assert_eq!(session.restore_deadman().as_deref(), Some("deadman 0"));
}

#[test]
fn a_script_sets_no_deadman() {
    let now = Instant::now();
    let mut session = Session::new(now, true, false);
    session.queue("walk");
    assert_eq!(
        exclude_status(&run_session(&mut session, now, 1000, answer_as_robot)),
        ["walk"]
    );
}

#[test]
fn a_gait_starts_only_after_deadman_is_confirmed() {
    let now = Instant::now();
    let mut session = Session::new(now, false, false).with_deadman();
    session.queue("walk");
    assert_eq!(session.take_next_line(now).as_deref(), Some("cal"));
    session.receive("# deadman 0");
    session.receive("ok cal");
    assert_eq!(session.take_next_line(now).as_deref(), Some("deadman 901"));
    let later = now + ANSWER_TIMEOUT;
    let message = session
        .time_out_request(later)
        .expect("the user gets a message");
    assert!(message.contains("not sent"), "{message}");
    assert_eq!(session.take_next_line(later), None, "walk is not sent");
    assert!(
        session.check_all_accepted().is_err(),
        "the failure is counted"
    );
    session.queue("walk");
    assert_eq!(
        session.take_next_line(later).as_deref(),
        Some("deadman 901")
    );
}

#[test]
fn a_silent_robot_is_reported_once_until_it_answers() {
    let mut now = Instant::now();
    let mut session = Session::new(now, true, false);
    let mut ask = |is_answered: bool| {
        now += STATUS_INTERVAL;
        assert_eq!(session.take_next_line(now).as_deref(), Some("status"));
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
