//! Tests with videos of several gaits, and of rests between them.

use std::assert_matches;

use fastrand::Rng;
use lizard_studio::walk::{Variation, WalkSeries, paper_gait};
use lizard_video::{AnalysedVideo, Gait, GaitMatch, MeasuredGait, VideoError, min_rest_duration};

use crate::accuracy::means_and_truths;
use crate::studio::{FRAME_RATE, FULL_SCALE, record_robot, scaled_gait, studio};

/// A small variation of the cycles, as in a real robot.
const VARIATION: Variation = Variation {
    cycle_deviation: [0.2, 0.2, 0.004],
    clock_deviation: 0.0,
    ruler_deviation: 0.0,
};

/// Records walks with rests of `rest` seconds between them, and analyses the video.
fn record_walks(walks: &[(&Gait, usize)], rest: f64) -> (AnalysedVideo, WalkSeries) {
    let mut rng = Rng::with_seed(6);
    let series = WalkSeries::new([-60.0, 0.0, 0.0], walks, rest, VARIATION, &mut rng);
    let (pose_at, duration_s) = (|time: f64| series.pose_at(time), series.duration_s());
    let video = record_robot(&studio(), duration_s, FRAME_RATE, pose_at, &mut rng);
    let analysed_video = video.analyse(FULL_SCALE);
    (analysed_video.expect("all tags are visible"), series)
}

/// Checks that a result matches the true movement of a gait.
fn check_result(measured: &MeasuredGait, gait: &Gait) {
    let means_and_truths = means_and_truths(measured, gait).into_iter();
    for ((mean, truth), max_error) in means_and_truths.zip([0.4, 0.4, 0.6]) {
        let error = (mean.value - truth).abs();
        assert!(error < max_error, "{mean:?}, truth {truth}");
        assert!(error < 4.0 * mean.standard_error, "{mean:?}, truth {truth}");
    }
}

#[test]
fn each_gait_of_a_video_is_found_between_rests_and_measured() {
    let names = ["walk", "left", "back", "trot"];
    let gaits = names.map(paper_gait);
    let order = [0, 1, 2, 0];
    let (analysed_video, series) = record_walks(&order.map(|i| (&gaits[i], 4)), 1.6);
    let walks = analysed_video.find_walks(min_rest_duration(&gaits));
    assert_eq!(walks.len(), order.len(), "{walks:?}");
    for (found_span, true_span) in walks.iter().zip(series.movement_spans()) {
        // A found walk includes parts of the adjacent rests, and misses at most one frame of the movement.
        let lead = true_span[0] - found_span[0];
        let lag = found_span[1] - true_span[1];
        for shift in [lead, lag] {
            let is_small = (-0.2..1.2).contains(&shift);
            assert!(is_small, "{shift} s: {found_span:?}, truth {true_span:?}");
        }
    }
    let measure = |gait: &Gait, walk: [f64; 2]| {
        let measured = analysed_video.measure(gait, Some(walk));
        measured.expect("the gait can be measured")
    };
    for (walk, i) in walks.iter().zip(order) {
        let gait_match = analysed_video.match_gait(&gaits, *walk);
        assert_eq!(gait_match, GaitMatch::Unique(i));
        check_result(&measure(&gaits[i], *walk), &gaits[i]);
    }
    // Both walks together give one result.
    let [first, second] = [0, 3].map(|i| measure(&gaits[0], walks[i]));
    let combined = MeasuredGait::combine(&[first.clone(), second.clone()], &gaits[0]);
    check_result(&combined, &gaits[0]);
    assert_eq!(combined.cycles, [first.cycles, second.cycles].concat());
    // A walk of another gait is rejected.
    let result = analysed_video.measure(&gaits[2], Some(walks[1]));
    assert_matches!(result, Err(VideoError::GaitMismatch { .. }));
}

#[test]
fn a_robot_that_moves_half_as_far_as_predicted_matches_its_gait() {
    let gaits = ["walk", "left", "back", "trot"].map(paper_gait);
    let weak_gaits = gaits.each_ref().map(|gait| scaled_gait(gait, 0.5));
    let (analysed_video, _) = record_walks(&[0, 1, 2, 3].map(|i| (&weak_gaits[i], 4)), 1.6);
    let walks = analysed_video.find_walks(min_rest_duration(&gaits));
    let gait_matches: Vec<GaitMatch> = walks
        .iter()
        .map(|walk| analysed_video.match_gait(&gaits, *walk))
        .collect();
    assert_eq!(gait_matches, [0, 1, 2, 3].map(GaitMatch::Unique));
    let measured = analysed_video.measure(&gaits[0], Some(walks[0]));
    check_result(&measured.expect("the gait can be measured"), &weak_gaits[0]);
}

#[test]
fn two_gaits_with_the_same_path_are_both_reported() {
    let walk = paper_gait("walk");
    let gaits = [paper_gait("back"), walk.clone(), walk.clone()];
    let (analysed_video, _) = record_walks(&[(&walk, 4)], 1.0);
    let walks = analysed_video.find_walks(min_rest_duration(&gaits));
    let gait_match = analysed_video.match_gait(&gaits, walks[0]);
    let [first, second] =
        [(1, 2), (2, 1)].map(|(best, second_best)| GaitMatch::Ambiguous { best, second_best });
    assert!([first, second].contains(&gait_match), "{gait_match:?}");
}

#[test]
fn a_walk_in_slow_motion_or_of_an_unknown_gait_matches_no_gait() {
    let gaits = ["walk", "left", "back", "trot"].map(paper_gait);
    for (i, scale) in [(0, 1.0), (0, 0.7), (1, 1.0)] {
        let mut slow = scaled_gait(&gaits[i], scale);
        slow.period *= 2.0;
        let (half_speed, _) = record_walks(&[(&slow, 3)], 1.0);
        let walks = half_speed.find_walks(2.0 * min_rest_duration(&gaits));
        let gait_match = half_speed.match_gait(&gaits, walks[0]);
        let wrong_pace = VideoError::WrongPace { ratio: 2 };
        assert_eq!(
            gait_match,
            GaitMatch::NoMatch(wrong_pace),
            "gait {i}, scale {scale}"
        );
    }
    let unknown = paper_gait("right");
    let (analysed_video, _) = record_walks(&[(&unknown, 4)], 1.0);
    let walks = analysed_video.find_walks(min_rest_duration(&gaits));
    let gait_match = analysed_video.match_gait(&gaits, walks[0]);
    assert_matches!(gait_match, GaitMatch::NoMatch(_));
}

#[test]
fn the_result_for_one_of_two_gaits_without_a_rest_between_them_is_right_or_an_error() {
    let [walk, arc, left] = ["walk", "arc-left", "left"].map(paper_gait);
    for (first, second) in [(&walk, &arc), (&walk, &left), (&arc, &walk)] {
        let (analysed_video, _) = record_walks(&[(first, 4), (second, 4)], 0.0);
        let gaits = [walk.clone(), arc.clone(), left.clone()];
        let walks = analysed_video.find_walks(min_rest_duration(&gaits));
        assert_eq!(walks.len(), 1);
        for gait in [first, second] {
            match analysed_video.measure(gait, Some(walks[0])) {
                // If this gait moves the robot farther than the other one, it can be measured alone.
                Ok(measured) => check_result(&measured, gait),
                Err(error) => assert_matches!(
                    error,
                    VideoError::GaitMismatch { .. }
                        | VideoError::MovementChanges { .. }
                        | VideoError::WrongPace { .. }
                ),
            }
        }
    }
}

#[test]
fn a_short_turn_of_one_degree_during_a_rest_is_not_a_walk() {
    let walk = paper_gait("walk");
    let extra_heading_at = |time: f64| match (4.0..4.5).contains(&time) {
        true => 0.02,
        false => 0.0,
    };
    let mut rng = Rng::with_seed(6);
    let series = WalkSeries::new([-60.0, 0.0, 0.0], &[(&walk, 3)], 1.0, VARIATION, &mut rng);
    let pose_at = |time: f64| {
        let [x, y, heading] = series.pose_at(time);
        [x, y, heading + extra_heading_at(time - 2.0)]
    };
    let video = record_robot(&studio(), 8.0, FRAME_RATE, pose_at, &mut rng);
    let analysed_video = video.analyse(FULL_SCALE).expect("all tags are visible");
    let walks = analysed_video.find_walks(min_rest_duration(&[walk]));
    assert_eq!(walks.len(), 1);
}

/// Finds the largest deviation from the predicted path within a cycle. Returns its phase, axis, and size in standard
/// errors.
fn find_largest_deviation(measured: &MeasuredGait) -> (f64, usize, f64) {
    let deviations = measured.cycle_path.iter().flat_map(|point| {
        let differences = point.standardised_differences().map(f64::abs);
        (0..3).map(move |axis| (point.phase, axis, differences[axis]))
    });
    let largest = deviations.max_by(|a, b| a.2.total_cmp(&b.2));
    largest.expect("the path has a point")
}

#[test]
fn a_deviation_from_the_predicted_path_is_found_at_its_phase() {
    let walk = paper_gait("walk");
    let mut swerving = walk.clone();
    let count = walk.path.len() - 1;
    for (i, pose) in swerving.path.iter_mut().enumerate() {
        let offset = (i as f64 / count as f64 - 0.6) / 0.12;
        pose.left += 1.5 * (-offset.powi(2)).exp();
    }
    let measure = |gait: &Gait| {
        let (analysed_video, _) = record_walks(&[(gait, 6)], 1.0);
        let measured = analysed_video.measure(&walk, None);
        measured.expect("the gait can be measured")
    };
    let (phase, axis, size) = find_largest_deviation(&measure(&swerving));
    assert!(
        (phase - 0.6).abs() < 0.1 && axis == 1,
        "phase {phase}, axis {axis}"
    );
    assert!(size > 5.0, "{size} standard errors");
    let (_, _, size) = find_largest_deviation(&measure(&walk));
    assert!(size < 3.5, "{size} standard errors");
}
