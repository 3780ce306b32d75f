//! Tests of the `deadman` setting after resets, reconnections and lost answers.

use super::driving::{answer_as_robot, end_drive, run_session, start_driving};
use super::*;

#[test]
fn a_robot_that_has_not_answered_stop_keeps_the_deadman_for_driving_when_the_program_ends() {
    let (mut now, mut session) = start_driving(true);
    session.queue("walk");
    run_session(&mut session, &mut now, answer_as_robot);
    session.stop(now);
    assert_sends(&mut session, now, Some("stop"));
    assert_eq!(session.restore_deadman(), None);
    session.receive("ok stop");
    assert_eq!(session.restore_deadman().as_deref(), Some("deadman 700"));
}

#[test]
fn a_gait_after_a_reset_whose_banner_is_lost_starts_only_with_deadman_set() {
    let (mut now, mut session) = start_driving(true);
    let answer_at_frame = |frame: u64| {
        move |line: &str| match line {
            // The routine rests; after the reset, the robot rests as well.
            "status" => format!("ok gait=rest pose=1,2,3,4 margin=0.5 frames={frame} fault=none"),
            line => answer_as_robot(line),
        }
    };
    session.queue("patrol");
    let lines = run_session(&mut session, &mut now, answer_at_frame(500));
    assert_eq!(lines, "cal, deadman 700, patrol");
    let lines = run_session(&mut session, &mut now, answer_at_frame(3));
    assert_eq!(lines, "deadman 700");
    session.queue("patrol");
    let lines = run_session(&mut session, &mut now, answer_at_frame(50));
    assert_eq!(lines, "patrol");
}

#[test]
fn a_damaged_frame_count_does_not_end_the_driving_of_a_resting_routine() {
    let (mut now, mut session) = start_driving(true);
    session.queue("patrol");
    let answer_with_frames = |frames: &'static str| {
        move |line: &str| match line {
            "status" => format!("ok gait=rest pose=1,2,3,4 margin=0.5{frames} fault=none"),
            line => answer_as_robot(line),
        }
    };
    for (frames, expected_lines) in [
        (" frames=500", "cal, deadman 700, patrol"),
        ("", "deadman 700"),
        (" frames=600", ""),
    ] {
        let lines = run_session(&mut session, &mut now, answer_with_frames(frames));
        assert_eq!(lines, expected_lines, "{frames}");
        assert!(session.is_driven(), "{frames}");
    }
}

#[test]
fn a_robot_that_was_connected_again_without_a_reset_gets_its_own_deadman_back() {
    for (is_reset, expected) in [(false, "deadman 2000"), (true, "")] {
        let (mut now, mut session) = start_driving(true);
        session.queue("walk");
        let answer_with_own_deadman = |line: &str| answer_as_robot(line).replace("700", "2000");
        run_session(&mut session, &mut now, answer_with_own_deadman);
        session.restart(now, false, is_reset);
        let answer_as_stopped_robot = |line: &str| match line {
            "status" => WALKING_STATUS.replace("gait=walk", "gait=stop"),
            line => answer_as_robot(line).replace("700", "901"),
        };
        let lines = run_session(&mut session, &mut now, answer_as_stopped_robot);
        assert_eq!(lines, expected);
    }
}

#[test]
fn save_stores_the_robots_own_deadman_even_if_the_restored_one_is_not_confirmed() {
    for is_stopped in [false, true] {
        let (mut now, mut session) = start_driving(true);
        end_drive(&mut session, &mut now);
        assert_sends(&mut session, now, Some("deadman 700")); // the link loses this line
        if is_stopped {
            session.stop(now);
            assert_sends(&mut session, now, Some("stop"));
            session.receive("ok stop");
            session.queue("save");
        } else {
            session.queue("save");
            now += ANSWER_TIMEOUT;
            assert!(session.time_out_request(now).is_some());
        }
        assert_sends(&mut session, now, Some("deadman 700"));
        session.receive("ok deadman 700");
        assert_sends(&mut session, now, Some("save"));
    }
}

#[test]
fn a_walking_robot_gets_lines_in_time_while_an_answer_is_missing() {
    let (mut now, mut session) = start_driving(true);
    session.queue("walk");
    run_session(&mut session, &mut now, answer_as_robot);
    session.queue("speed 50");
    // The link loses this line, and then the answer to every `status`.
    let mut last_send_time = now;
    let end = now + 2 * ANSWER_TIMEOUT;
    while now < end {
        if session.take_next_line(now).is_some() {
            last_send_time = now;
        }
        session.time_out_request(now);
        now += Duration::from_millis(10);
        let silence = now - last_send_time;
        assert!(silence <= Duration::from_millis(700 / 3), "{silence:?}");
    }
}

#[test]
fn an_additional_status_is_not_shown_and_restores_nothing_while_a_gait_is_about_to_start() {
    let (mut now, mut session) = start_driving(true);
    end_drive(&mut session, &mut now);
    session.queue("back");
    assert_sends(&mut session, now, Some("back"));
    assert_sends(&mut session, now + deadman::LINE_INTERVAL, Some("status"));
    let late_status = WALKING_STATUS.replace("gait=walk", "gait=stop");
    assert_eq!(session.receive(&late_status), None);
    assert_shows(&mut session, "ok back");
    assert_eq!(session.receive(WALKING_STATUS), None);
    assert!(session.is_driven());
}
