use super::*;

mod driving;
mod lost_lines;

const WALKING_STATUS: &str = "ok gait=walk phase=0 pose=1,2,3,4 margin=0.5 guard=clear fault=none";

/// Starts a session; also returns its start.
fn start(polls_status: bool, watches_poses: bool) -> (Instant, Session) {
    let now = Instant::now();
    (now, Session::new(now, polls_status, watches_poses))
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
fn a_reset_fails_the_unanswered_line_and_repeats_watch() {
    let (now, mut session) = start(false, true);
    assert_sends(&mut session, now, Some("watch 1"));
    session.receive("ok watch 1");
    session.queue("walk");
    session.take_next_line(now);
    let shown_line = session.receive("# lizard 0.2.0");
    let expected = "# lizard 0.2.0 (no answer to `walk`)";
    assert_eq!(shown_line.as_deref(), Some(expected));
    assert_sends(&mut session, now, Some("watch 1")); // poses are requested again
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
fn a_stop_in_upper_case_from_a_script_is_answered_too() {
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
fn a_stop_of_an_unplugged_robot_is_repeated_and_its_silence_counts_from_the_reconnection() {
    let (now, mut session) = start(false, false);
    session.stop(now);
    let later = now + SILENCE_TIMEOUT;
    session.restart(later, false, true);
    assert_sends(&mut session, later, Some("stop"));
    assert_eq!(session.time_out_request(later), None);
    let message = session.time_out_request(later + SILENCE_TIMEOUT);
    assert!(message.is_some_and(|message| message.contains("may still move")));
}

#[test]
fn only_a_complete_refusal_of_stop_ends_its_repetition() {
    for (refusal, next_line) in [
        ("err 7 the servos are resting; send stand first", "stand"),
        ("err 10 no robot in the flash", "stand"),
        ("err 7 the servos are resting; senok walk", "stop"),
    ] {
        let (now, mut session) = start(false, false);
        session.stop(now);
        assert_sends(&mut session, now, Some("stop"));
        assert_shows(&mut session, refusal);
        session.queue("stand");
        assert_sends(&mut session, now + STOP_INTERVAL, Some(next_line));
    }
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

#[test]
fn poses_are_requested_again_after_a_reset_whose_banner_is_lost() {
    let (mut now, mut session) = start(true, true);
    assert_sends(&mut session, now, Some("watch 1"));
    session.receive("ok watch 1");
    for (frames, is_reset) in [(900, false), (901, false), (50, true), (75, false)] {
        assert_sends(&mut session, now, Some("status"));
        session.receive(&format!("{WALKING_STATUS} frames={frames}"));
        assert_sends(&mut session, now, is_reset.then_some("watch 1"));
        session.receive("ok watch 1");
        now += STATUS_INTERVAL;
    }
}
