//! Gaits with a count: they run that many cycles and then stand still.

use super::*;

/// Returns the cycles that a motion covers from a standstill to its end, and the frames that it takes. It counts
/// independently of the motion, by adding the phase's change in each frame.
fn cycles(motion: &mut Motion) -> (f64, u32) {
    let (mut covered, mut frames) = (0.0, 0);
    loop {
        let before = motion.phase();
        let was_cycling = motion.is_cycling();
        motion.tick();
        frames += 1;
        assert!(frames < 200_000, "it never ends");
        if motion.has_ended() {
            return (covered, frames);
        }
        if motion.is_moving() {
            // The previous gait was braking until here.
            covered = 0.0;
        } else if was_cycling && motion.is_cycling() {
            let step = motion.phase().wrapping_sub(before) & (CYCLE - 1);
            let signed = (step << 8) as i32 >> 8;
            covered += f64::from(signed) / f64::from(CYCLE);
        }
    }
}

/// The share of a cycle that a gait covers in a frame at full pace; negative for a gait that runs backwards.
fn cycles_per_frame(motion: &Motion, name: &str) -> f64 {
    f64::from(motion.robot.gait(motion.robot.id(name)).increment) / f64::from(CYCLE)
}

#[test]
fn every_gait_goes_its_count_of_cycles_within_two_frames_at_any_pace() {
    for name in GAITS.into_iter().filter(|name| *name != "stray") {
        for (speed, slow) in [(100, false), (100, true), (37, false), (10, false)] {
            for count in [1, 2, 3, 17] {
                let mut motion = Motion::standing();
                motion.set_speed(speed);
                motion.set_slow(slow);
                motion.start_for(name, count);
                let (covered, _) = cycles(&mut motion);
                let frame = cycles_per_frame(&motion, name);
                let over = covered / frame.signum() - f64::from(count);
                let frames = over / frame.abs();
                assert!(
                    (-2.0..=1.2).contains(&frames),
                    "{name} {count} at {speed}: {frames} frames too many"
                );
                assert_eq!(motion.activity(), Activity::Stop);
                let held = motion.held();
                for _ in 0..50 {
                    assert_eq!(motion.tick(), held);
                    assert!(!motion.has_ended(), "once");
                }
            }
        }
    }
    let mut motion = Motion::standing();
    motion.start_for("sway", 999);
    assert!((cycles(&mut motion).0 - 999.0).abs() < 0.1);
}

#[test]
fn a_gait_of_the_shortest_period_ends_too() {
    for (forward, count) in [(true, 1), (false, 1), (true, 5), (false, 5)] {
        let robot = Sample::odd();
        let index = robot.id("sway").index();
        let increment = CYCLE as i32 / 10;
        let robot = robot.with(|content| {
            content.gaits[index].increment = if forward { increment } else { -increment };
        });
        let mut motion = Motion::awake(robot);
        motion.start_for("sway", count);
        let (covered, _) = cycles(&mut motion);
        let over = (covered.abs() - f64::from(count)) * 10.0;
        assert!((-2.0..=1.2).contains(&over), "{over}");
        assert_eq!(covered > 0.0, forward);
    }
}

#[test]
fn a_count_ends_like_a_gait_that_brakes_frame_by_frame() {
    let mut counted = Motion::standing();
    counted.start_for("sway", 2);
    let mut endless = Motion::standing();
    endless.start("sway");
    loop {
        let mut ordered = endless.clone();
        let pulses = counted.tick();
        if let Some(Target::End) = counted.next {
            ordered.start("back");
            assert_eq!(ordered.tick(), pulses);
            endless = ordered;
            break;
        }
        assert_eq!(endless.tick(), pulses);
    }
    while endless.pace() > 0 {
        assert_eq!(counted.tick(), endless.tick());
        assert!(!counted.has_ended());
    }
    let last = counted.held();
    assert_eq!(counted.tick(), last);
    assert!(counted.has_ended());
}

#[test]
fn the_same_gait_goes_on_from_where_it_is_and_counts_from_there() {
    for (from, count) in [(60, 1), (95, 2), (110, 3)] {
        let mut motion = Motion::in_gait("sway", from);
        motion.start_for("sway", count);
        let (covered, _) = cycles(&mut motion);
        let over = (covered - f64::from(count)) / cycles_per_frame(&motion, "sway");
        assert!((-2.0..=1.2).contains(&over), "{over}");
    }
}

#[test]
fn a_new_order_replaces_a_count_also_while_it_brakes_to_its_end() {
    let braking = || {
        let mut motion = Motion::standing();
        motion.start_for("sway", 1);
        while !matches!(motion.next, Some(Target::End)) {
            motion.tick();
        }
        motion.run(2);
        assert_eq!(motion.gait(), Some("sway"), "it still walks");
        motion
    };
    let counted = || {
        let mut motion = Motion::standing();
        motion.start_for("sway", 1);
        motion.run(20);
        motion
    };
    for mut motion in [braking(), counted()] {
        let mut other = motion.clone();
        motion.start("sway");
        for _ in 0..2_000 {
            motion.tick();
            assert!(!motion.has_ended() && motion.gait() == Some("sway"));
        }
        other.start_for("back", 2);
        let (covered, _) = cycles(&mut other);
        assert!((covered + 2.0).abs() < 0.05, "{covered}");
    }
    for mut motion in [braking(), counted()] {
        let (mut stopped, mut posed) = (motion.clone(), motion.clone());
        stopped.stop();
        posed.head_for_pose(THERE);
        motion.rest();
        for mut motion in [stopped, posed, motion] {
            for _ in 0..500 {
                motion.tick();
                assert!(!motion.has_ended());
            }
        }
    }
}

#[test]
fn a_new_calibration_interrupts_a_count_and_does_not_shorten_it() {
    let mut motion = Motion::in_gait("sway", 0);
    motion.start_for("sway", 2);
    motion.run(60);
    let mut covered = f64::from(motion.phase()) / f64::from(CYCLE);
    assert!(covered > 0.1 && covered < 0.9, "{covered}");
    motion.settle();
    covered += cycles(&mut motion).0;
    let over = (covered - 2.0) / cycles_per_frame(&motion, "sway");
    assert!((-2.0..=1.2).contains(&over), "{over}");
}
