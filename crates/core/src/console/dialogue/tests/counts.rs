//! Gaits with a count, and the events that end them early.

use super::*;

/// Frames that are enough for the move to `sway`, three of its cycles, and the braking.
const LONG_FRAMES: u32 = 400;

#[test]
fn a_count_ends_with_one_line_and_the_robot_holds_its_last_pose() {
    for name in ["sway", "sway left", "back"] {
        let mut dialogue = standing();
        assert_eq!(dialogue.say(&format!("{name}  2")), format!("ok {name}  2"));
        assert_eq!(dialogue.status("gait"), name.replace(' ', "-"));
        assert_eq!(dialogue.run(LONG_FRAMES), ["# done"]);
        assert_eq!(
            (dialogue.status("gait"), dialogue.status("fault")),
            ("stop".into(), "none".into())
        );
        let held = dialogue.frame();
        assert!(dialogue.run(LONG_FRAMES).is_empty());
        assert_eq!(dialogue.frame(), held);
    }
    let mut dialogue = standing();
    dialogue.say("sway");
    assert!(dialogue.run(5 * LONG_FRAMES).is_empty(), "no count, no end");
}

#[test]
fn a_wrong_count_is_refused_and_changes_nothing() {
    let mut dialogue = standing();
    let message = "a gait takes a count, 1..999";
    for line in ["sway 0", "sway 1000", "sway 2x", "sway 1 1"] {
        dialogue.refuse(line, &format!("2 {message}"));
        assert_eq!(dialogue.status("gait"), "stand");
    }
    dialogue.say("rest");
    dialogue.refuse("sway 3", "7 servos are resting, send stand first");
    assert_eq!(dialogue.say("stand 1"), "ok stand 1");
}

#[test]
fn whatever_stops_the_robot_ends_a_count_without_done() {
    let begun = || {
        let mut dialogue = standing();
        dialogue.say("sway 2");
        dialogue.run(30);
        dialogue
    };
    for line in ["stop", "rest", "stand", NEUTRAL, "sway"] {
        let mut dialogue = begun();
        dialogue.say(line);
        assert!(dialogue.run(LONG_FRAMES).is_empty(), "{line}");
    }
    let mut silent = begun();
    silent.say("deadman 100");
    let printed = silent.run(LONG_FRAMES);
    assert_eq!(printed.len(), 1, "{printed:?}");
    assert!(printed[0].starts_with("# fault: no line"), "{printed:?}");
    let mut weak = begun();
    supply(&mut weak, 4_200);
    let printed = weak.run(LONG_FRAMES);
    assert!(!printed.contains(&"# done".to_string()), "{printed:?}");
    assert_eq!(weak.status("fault"), "supply");
    let mut unsafe_one = standing();
    unsafe_one.say("stray 9");
    let printed = unsafe_one.run(5 * LONG_FRAMES);
    assert_eq!(printed.len(), 1, "{printed:?}");
    assert!(printed[0].starts_with("# held"), "{printed:?}");
}

#[test]
fn a_low_supply_makes_a_count_take_longer_and_does_not_end_it() {
    let frames = |mv: Option<u16>| {
        let mut dialogue = standing();
        if let Some(mv) = mv {
            supply(&mut dialogue, mv.into());
            dialogue.run(40);
        }
        dialogue.say("sway 2");
        (1..2_000_u32)
            .find(|_| dialogue.run(1) == ["# done"])
            .expect("an end")
    };
    let (full, slow) = (frames(None), frames(Some(4_400)));
    // An upper bound: at a lower pace, the cycles take longer, but speeding up and braking hardly do.
    let most = full * 100 / u32::from(SLOW_PACE);
    assert!(
        slow > u32::midpoint(full, most) && slow < most,
        "{full} and {slow}"
    );
}

#[test]
fn a_reset_ends_a_count() {
    for cause in [Cause::External, Cause::BrownOut, Cause::Watchdog] {
        let mut dialogue = standing();
        dialogue.say("sway 2");
        dialogue.run(60);
        dialogue.reset(cause);
        let printed = dialogue.run(LONG_FRAMES);
        assert!(!printed.contains(&"# done".to_string()), "{printed:?}");
        assert!(["stand", "stop"].contains(&dialogue.status("gait").as_str()));
    }
}
