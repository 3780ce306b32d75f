//! What stops the robot, and where it begins.

use super::*;

#[test]
fn boot_does_what_it_says_three_seconds_after_power_on_unless_a_byte_comes() {
    let mut dialogue = standing();
    for boot in ["sway left", "rest"] {
        dialogue.say(&format!("boot {boot}"));
        assert_eq!(dialogue.say("save"), "ok save");
        let chip = dialogue.board.memory.clone();
        let mut alone = Dialogue::with(Sample::odd(), chip.clone(), Restart::default());
        let said = alone.run(149);
        assert_eq!(said.len(), 1, "{said:?}");
        assert_eq!(alone.motion().activity(), Activity::Gait(GaitId::STAND));
        assert_eq!(alone.run(1), [format!("# boot: {boot}")]);
        assert_eq!(alone.status("gait"), boot.replace(' ', "-"));
        let mut watched = Dialogue::with(Sample::odd(), chip, Restart::default());
        watched.run(100);
        watched.board.send(b" ");
        watched.run(400);
        assert_eq!(watched.status("gait"), "stand");
    }
}

#[test]
fn a_gait_ends_when_the_link_is_lost_and_says_why() {
    let mut dialogue = standing();
    dialogue.say("deadman 400");
    dialogue.say("sway");
    for _ in 0..30 {
        assert!(dialogue.run(15).is_empty());
        dialogue.say("status");
    }
    let said = dialogue.run(21);
    assert_eq!(
        said,
        ["# fault: no line for as long as deadman says, stopped"]
    );
    assert_eq!(
        (dialogue.status("gait"), dialogue.status("fault")),
        ("stop".into(), "link".into())
    );
    dialogue.say("sway");
    assert_eq!(dialogue.status("fault"), "none");
}

/// The board's supply is at so many millivolts, its rail at 6 V.
fn supply(dialogue: &mut Dialogue, mv: u32) {
    let supplies = dialogue.motion().robot().supplies();
    let truth = reading(&supplies, mv, 6_000);
    dialogue.board.converter.set(truth);
}

#[test]
fn a_falling_supply_slows_the_gait_then_stops_it_then_ends_the_pulses_and_nothing_restarts() {
    let mut dialogue = standing();
    dialogue.say("sway");
    dialogue.run(150);
    let pace = |dialogue: &mut Dialogue| {
        let before = dialogue.motion().phase();
        dialogue.run(10);
        dialogue.motion().phase().wrapping_sub(before) & 0xff_ffff
    };
    let full = pace(&mut dialogue);
    supply(&mut dialogue, 4_400);
    let said = dialogue.run(40);
    assert!(
        said[0].starts_with("# supply: 4.") && said[0].ends_with("V, low: half speed, no saving"),
        "{said:?}"
    );
    let half = f64::from(pace(&mut dialogue)) / f64::from(full);
    assert!((half - 0.5).abs() < 0.02, "{half}");
    assert_eq!(dialogue.say("save"), "err 8 the supply is too low");
    supply(&mut dialogue, 4_200);
    let said = dialogue.run(40);
    assert_eq!(said.len(), 2);
    assert_eq!(dialogue.status("gait"), "stop");
    assert_eq!(dialogue.status("fault"), "supply");
    assert!(dialogue.say("sway").starts_with("err 8 "));
    assert!(dialogue.say(NEUTRAL).starts_with("err 8 "));
    supply(&mut dialogue, 4_000);
    dialogue.run(40);
    assert_eq!(dialogue.status("gait"), "rest");
    assert_eq!(dialogue.frame(), Pulses::default());
    supply(&mut dialogue, 5_000);
    let said = dialogue.run(100);
    assert!(
        said.last().is_some_and(|line| line.ends_with(" V, good")),
        "{said:?}"
    );
    assert_eq!(dialogue.status("gait"), "rest");
    assert_eq!(dialogue.say("stand"), "ok stand");
}

#[test]
fn after_a_hang_the_robot_is_held_in_the_pose_it_had_and_says_so() {
    let sweeps = [400, -300, 200, -100].map(crate::units::Sweep);
    let restart = Restart {
        cause: Cause::Watchdog,
        count: 3,
        pose: Some(Pose(sweeps)),
    };
    let mut dialogue = Dialogue::with(Sample::odd(), Eeprom::blank(), restart);
    let said = dialogue.run(1);
    assert!(
        said.contains(&"# fault: the program hung and began anew".to_string()),
        "{said:?}"
    );
    let motion = dialogue.motion();
    let held = Pose(sweeps).pulses(motion.calibration());
    for _ in 0..400 {
        assert_eq!(dialogue.frame(), held, "at once, and for good");
    }
    assert_eq!(dialogue.status("reset"), "watchdog");
    assert_eq!(dialogue.status("resets"), "3");
    assert_eq!(dialogue.status("fault"), "watchdog");
    dialogue.say("stand");
    dialogue.run(100);
    assert_eq!(dialogue.status("fault"), "none");
    assert_eq!(dialogue.status("pose"), dialogue_neutral());
}

fn dialogue_neutral() -> String {
    NEUTRAL.replacen("pose ", "", 1).replace(' ', ",")
}

#[test]
fn a_pose_that_is_not_safe_or_not_reached_is_not_taken_over() {
    for sweeps in [[30_000, 0, 0, 0], [-6803, 7663, 0, 0]] {
        let restart = Restart {
            cause: Cause::Watchdog,
            count: 1,
            pose: Some(Pose(sweeps.map(crate::units::Sweep))),
        };
        let mut dialogue = Dialogue::with(Sample::odd(), Eeprom::blank(), restart);
        dialogue.run(30);
        assert_eq!(dialogue.status("pose"), dialogue_neutral());
    }
}

#[test]
fn a_robot_that_rested_wakes_where_it_rested_and_then_stands_without_a_leap() {
    let mut dialogue = standing();
    dialogue.say("pose 140 50 311 224.5");
    dialogue.run(150);
    dialogue.say("rest");
    let chip = dialogue.board.memory.clone();
    let mut again = Dialogue::with(Sample::odd(), chip.clone(), Restart::default());
    again.lines();
    assert_eq!(again.status("pose"), "140.00,50.00,311.00,224.50");
    let there = again.motion().pose().pulses(again.motion().calibration());
    for servo in 0..4 {
        for _ in 0..5 {
            let widths = widths(&mut again);
            for (other, width) in widths.into_iter().enumerate() {
                let expected = if other < servo { there.0[other].0 } else { 0 };
                // The fifth frame wakes the next one.
                assert!(width == expected || other == servo, "{servo} {other}");
            }
        }
    }
    again.run(200);
    assert_eq!(again.status("pose"), dialogue_neutral());
    // Having moved, it has forgotten where it rested.
    let after = Dialogue::with(
        Sample::odd(),
        again.board.memory.clone(),
        Restart::default(),
    );
    assert_eq!(after.motion().pose(), &Pose::NEUTRAL);
}

#[test]
fn the_pose_of_a_rest_is_forgotten_before_the_first_pulse() {
    let mut dialogue = standing();
    dialogue.say("rest");
    assert_eq!(dialogue.board.memory.bytes()[128], 0xa5);
    dialogue.board.send(b"stand\r");
    // The answer goes first; then main deals with the memory, long before the first
    // servo wakes.
    dialogue.lines();
    assert_eq!(dialogue.board.memory.bytes()[128], 0xff);
    assert_eq!(dialogue.frame(), Pulses::default());
}
