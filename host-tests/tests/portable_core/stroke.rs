//! A stroke from one pose to another, of every length there is.

use lizard::pose::Pose;
use lizard::robot::SLEW;
use lizard::stroke::Stroke;
use lizard_host_tests::robot;
use proptest::prelude::*;

/// All of a motion's pace.
const FULL: u16 = 1024;

/// The poses of a stroke at full pace, its start first.
fn course(from: Pose, to: Pose) -> Vec<Pose> {
    let mut stroke = Stroke::new(&from, &to);
    let mut poses = vec![from];
    while !stroke.arrived() {
        stroke.advance(FULL);
        poses.push(stroke.pose(&to));
        assert!(poses.len() < 100, "{from:?} to {to:?} never ends");
    }
    poses
}

/// A stroke of one servo.
fn way(from: i16, to: i16) -> Vec<i16> {
    course(Pose([from, 0, 0, 0]), Pose([to, 0, 0, 0]))
        .iter()
        .map(|pose| pose.0[0])
        .collect()
}

#[test]
fn the_slew_limit_is_the_files_rounded_down() {
    let frame = robot().pace.slew * 0.02 * 65536.0 / 360.0;
    assert_eq!(SLEW, frame as u16);
}

#[test]
fn a_stroke_of_any_length_keeps_the_slew_limit_and_wastes_no_time() {
    let mut fastest = 0;
    for length in 0..=32_767i32 {
        for (from, to) in [
            (0, length),
            (16_384, 16_384 - length),
            (-16_383, length - 16_383),
        ] {
            let (from, to) = (from as i16, to as i16);
            let sweeps = way(from, to);
            assert_eq!(sweeps.last(), Some(&to));
            let steps = sweeps.windows(2).map(|pair| pair[1].abs_diff(pair[0]));
            let most = steps.max().expect("at least one frame");
            assert!(most <= SLEW, "{from} to {to}: {most} in a frame");
            fastest = fastest.max(most);
            // A smoothstep needs half as long again as a steady move.
            let least = 1.5 * f64::from(length) / f64::from(SLEW);
            let frames = (sweeps.len() - 1) as f64;
            assert!(
                frames <= (1.01 * least).max(6.0) + 3.0,
                "{from} to {to}: {frames}"
            );
        }
    }
    println!("fastest frame of any stroke: {fastest} of {SLEW}");
    assert!(fastest > SLEW / 20 * 19, "slower than it may be");
}

#[test]
fn a_stroke_goes_straight_there_and_follows_a_smoothstep() {
    for length in (1..32_767).step_by(13) {
        let sweeps = way(-16_383, -16_383 + length);
        // A way is halved to fit an i16, so that an odd one is a step off.
        assert!(
            sweeps.windows(2).all(|pair| pair[0] <= pair[1] + 1),
            "{length}"
        );
        let frames = sweeps.len() - 1;
        // Every frame an equal share of the time, in 1/32768, and a rest for
        // the last one where that does not add up to all of it.
        let worst = |equal_frames: usize| {
            let share = f64::from(32_768 / equal_frames as u16) / 32_768.0;
            let off = sweeps.iter().enumerate().map(|(frame, sweep)| {
                let u = (share * frame as f64).min(1.0);
                let meant = f64::from(length) * u * u * (3.0 - 2.0 * u) - 16_383.0;
                (f64::from(*sweep) - meant).abs()
            });
            off.fold(0.0, f64::max)
        };
        let off = worst(frames).min(worst(frames - 1));
        assert!(off <= 4.0, "{length}: {off} steps");
    }
}

proptest! {
    #[test]
    fn all_servos_have_the_same_share_of_their_way_behind_them(
        from in prop::array::uniform4(-16_384i16..=16_384),
        to in prop::array::uniform4(-16_384i16..=16_384),
    ) {
        let (from, to) = (Pose(from), Pose(to));
        let ways: [i32; 4] = std::array::from_fn(|n| i32::from(to.0[n]) - i32::from(from.0[n]));
        let longest = (0..4).max_by_key(|n| ways[*n].abs()).expect("four");
        prop_assume!(ways[longest].abs() > 1000);
        for pose in course(from, to) {
            let gone = |n: usize| f64::from(i32::from(pose.0[n]) - i32::from(from.0[n]));
            let share = gone(longest) / f64::from(ways[longest]);
            for (n, way) in ways.into_iter().enumerate() {
                // Two steps of rounding at either servo.
                let off = gone(n) - share * f64::from(way);
                prop_assert!(off.abs() <= 4.0, "{pose:?}: A{} is {off} steps off", n + 1);
            }
        }
    }

    #[test]
    fn a_stroke_at_any_pace_stays_on_its_line(
        from in prop::array::uniform4(-16_384i16..=16_384),
        to in prop::array::uniform4(-16_384i16..=16_384),
        paces in prop::collection::vec(0u16..=FULL, 1..60),
    ) {
        let (from, to) = (Pose(from), Pose(to));
        let mut stroke = Stroke::new(&from, &to);
        let mut last = from;
        for pace in paces {
            stroke.advance(pace);
            let pose = stroke.pose(&to);
            prop_assert!(last.farthest(&pose) <= SLEW);
            for n in 0..4 {
                let (low, high) = (from.0[n].min(to.0[n]), from.0[n].max(to.0[n]));
                // A way is halved to fit an i16, so that an odd one is a step off.
                prop_assert!((low - 1..=high + 1).contains(&pose.0[n]));
            }
            last = pose;
        }
    }
}
