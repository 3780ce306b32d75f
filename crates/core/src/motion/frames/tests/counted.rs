//! Tests of gaits with a count of cycles, after which the robot stands still.

use std::format;

use super::*;

/// The number of frames by which a gait may run longer than its count; negative if it runs shorter.
const ALLOWED_EXCESS: core::ops::RangeInclusive<f64> = -2.0..=1.2;

/// Runs a motion to its standstill. Returns the number of cycles that its last gait covers. This function counts cycles
/// independently of the motion, by adding the change of the phase in each frame.
fn measure_cycles(motion: &mut Motion) -> f64 {
    let mut cycles_covered = 0.0;
    for _ in 0..200_000 {
        let phase_before = motion.phase();
        let was_cycling = motion.is_cycling();
        motion.advance_frame();
        if motion.has_come_to_standstill() {
            return cycles_covered;
        }
        if motion.is_in_move() {
            // Until this move began, the previous gait was braking; its cycles do not count.
            cycles_covered = 0.0;
        } else if was_cycling && motion.is_cycling() {
            let change = motion.phase().wrapping_sub(phase_before) & (CYCLE - 1);
            // The phase has 24 bits; the shifts extend the sign of the change.
            let signed_change = (change << 8) as i32 >> 8;
            cycles_covered += f64::from(signed_change) / f64::from(CYCLE);
        }
    }
    panic!("the motion never ends");
}

/// Returns the fraction of a cycle that a gait covers in a frame at full pace, which is negative for a gait that is
/// read backwards.
fn cycles_per_frame(motion: &Motion, name: &str) -> f64 {
    f64::from(motion.robot.gait(motion.robot.gait_id(name)).increment) / f64::from(CYCLE)
}

#[test]
fn every_counted_gait_ends_within_two_frames_of_its_count_at_any_pace() {
    for name in GAIT_NAMES.into_iter().filter(|name| *name != "stray") {
        for (speed, is_slow) in [(100, false), (100, true), (37, false), (10, false)] {
            for count in [1, 2, 3, 17] {
                let mut motion = Motion::standing();
                motion.set_speed(speed);
                motion.set_slow(is_slow);
                motion.start_for(name, count);
                let cycles_covered = measure_cycles(&mut motion);
                let cycles_per_frame = cycles_per_frame(&motion, name);
                let excess_cycles = cycles_covered / cycles_per_frame.signum() - f64::from(count);
                let excess_frames = excess_cycles / cycles_per_frame.abs();
                let case = format!("{name} {count} at {speed}: {excess_frames} excess frames");
                assert!(ALLOWED_EXCESS.contains(&excess_frames), "{case}");
                assert_eq!(motion.activity(), Activity::Stop);
                let held_pulses = motion.pose_pulses();
                for _ in 0..50 {
                    assert_eq!(motion.advance_frame(), held_pulses);
                    let is_reported_again = motion.has_come_to_standstill();
                    assert!(!is_reported_again, "the standstill is reported once");
                }
            }
        }
    }
    let mut motion = Motion::standing();
    motion.start_for("sway", 999);
    assert!((measure_cycles(&mut motion) - 999.0).abs() < 0.1);
}

#[test]
fn a_counted_gait_of_the_shortest_period_ends_within_two_frames_of_its_count() {
    for (is_forward, count) in [(true, 1), (false, 1), (true, 5), (false, 5)] {
        let robot = Sample::asymmetric();
        let index = robot.gait_id("sway").index();
        let increment = CYCLE as i32 / 10;
        let robot = robot.with_changes(|content| {
            content.gaits[index].increment = if is_forward { increment } else { -increment };
        });
        let mut motion = Motion::awake(robot);
        motion.start_for("sway", count);
        let cycles_covered = measure_cycles(&mut motion);
        let excess_frames = (cycles_covered.abs() - f64::from(count)) * 10.0;
        assert!(ALLOWED_EXCESS.contains(&excess_frames), "{excess_frames}");
        assert_eq!(cycles_covered > 0.0, is_forward);
    }
}

#[test]
fn a_counted_gait_brakes_like_a_gait_replaced_by_another() {
    let mut counted_motion = Motion::standing();
    counted_motion.start_for("sway", 2);
    let mut endless_motion = Motion::standing();
    endless_motion.start("sway");
    loop {
        let mut replaced_motion = endless_motion.clone();
        let pulses = counted_motion.advance_frame();
        if let Some(Target::Standstill) = counted_motion.next_target {
            replaced_motion.start("back");
            assert_eq!(replaced_motion.advance_frame(), pulses);
            endless_motion = replaced_motion;
            break;
        }
        assert_eq!(endless_motion.advance_frame(), pulses);
    }
    while endless_motion.pace() > 0 {
        let pulses = counted_motion.advance_frame();
        assert_eq!(endless_motion.advance_frame(), pulses);
        assert!(!counted_motion.has_come_to_standstill());
    }
    let last_pulses = counted_motion.pose_pulses();
    assert_eq!(counted_motion.advance_frame(), last_pulses);
    assert!(counted_motion.has_come_to_standstill());
}

#[test]
fn a_count_commanded_for_a_running_gait_begins_at_its_current_phase() {
    for (start_frames, count) in [(60, 1), (95, 2), (110, 3)] {
        let mut motion = Motion::in_gait("sway", start_frames);
        motion.start_for("sway", count);
        let cycles_covered = measure_cycles(&mut motion);
        let excess_frames = (cycles_covered - f64::from(count)) / cycles_per_frame(&motion, "sway");
        assert!(ALLOWED_EXCESS.contains(&excess_frames), "{excess_frames}");
    }
}

#[test]
fn a_new_order_replaces_a_count_even_while_the_gait_brakes_at_its_end() {
    let mut counted_motion = Motion::standing();
    counted_motion.start_for("sway", 1);
    let mut braking_motion = counted_motion.clone();
    counted_motion.run(20);
    while !matches!(braking_motion.next_target, Some(Target::Standstill)) {
        braking_motion.advance_frame();
    }
    braking_motion.run(2);
    let gait = braking_motion.gait_name();
    assert_eq!(gait, Some("sway"), "the gait is still running");
    for motion in [braking_motion, counted_motion] {
        let mut endless_motion = motion.clone();
        endless_motion.start("sway");
        for _ in 0..2_000 {
            endless_motion.advance_frame();
            assert!(!endless_motion.has_come_to_standstill());
            assert_eq!(endless_motion.gait_name(), Some("sway"));
        }
        let mut second_motion = motion.clone();
        second_motion.start_for("back", 2);
        let cycles_covered = measure_cycles(&mut second_motion);
        assert!((cycles_covered + 2.0).abs() < 0.05, "{cycles_covered}");
        let go_to_pose = |motion: &mut Motion| motion.go_to_sweeps(SWEEPS);
        let orders: [fn(&mut Motion); 3] = [Motion::stop, Motion::rest, go_to_pose];
        for order in orders {
            let mut interrupted_motion = motion.clone();
            order(&mut interrupted_motion);
            for _ in 0..500 {
                interrupted_motion.advance_frame();
                assert!(!interrupted_motion.has_come_to_standstill());
            }
        }
    }
}

#[test]
fn a_new_calibration_interrupts_a_count_without_shortening_it() {
    let mut motion = Motion::in_gait("sway", 0);
    motion.start_for("sway", 2);
    motion.run(60);
    let mut cycles_covered = f64::from(motion.phase()) / f64::from(CYCLE);
    assert!(cycles_covered > 0.1, "{cycles_covered}");
    assert!(cycles_covered < 0.9, "{cycles_covered}");
    motion.settle();
    cycles_covered += measure_cycles(&mut motion);
    let excess_frames = (cycles_covered - 2.0) / cycles_per_frame(&motion, "sway");
    assert!(ALLOWED_EXCESS.contains(&excess_frames), "{excess_frames}");
}
