//! Tests with videos of a robot that slides down a tilted board.

use std::assert_matches;

use fastrand::Rng;
use lizard_studio::board::{EVENLY_LIFTED_BOARD, LiftedBoard, small_studio};
use lizard_studio::render::{Studio, random_normal};
use lizard_video::{Estimate, MeasuredSlide, SlideError, Video};

use crate::studio::{add_frame, analyse, record_robot};

/// Records a board while it is lifted.
fn record_board(board: &LiftedBoard, studio: &Studio, frame_rate: f64) -> Video {
    let mut video = Video::default();
    board.record(studio, frame_rate, |seconds, frame| {
        add_frame(&mut video, seconds, frame);
    });
    video
}

fn measure_slide(board: &LiftedBoard) -> Result<MeasuredSlide, SlideError> {
    MeasuredSlide::from_video(&analyse(&record_board(board, &small_studio(), 30.0)))
}

/// Checks that an estimate lies within two standard errors of the true value, and that its standard error is below
/// `max_standard_error`.
fn check_estimate(estimate: Estimate, truth: f64, max_standard_error: f64) {
    println!("{estimate:?}, truth {truth:.3}");
    assert!(
        (estimate.value - truth).abs() < 2.0 * estimate.standard_error,
        "{estimate:?}, truth {truth}"
    );
    assert!(estimate.standard_error < max_standard_error, "{estimate:?}");
}

#[test]
fn a_slide_head_first_or_tail_first_gives_static_and_sliding_friction() {
    for (head_direction_deg, static_friction, sliding_friction) in
        [(8.0, 0.75, 0.68), (-175.0, 0.5, 0.5)]
    {
        let board = LiftedBoard {
            static_friction,
            sliding_friction,
            head_direction_deg,
            ..EVENLY_LIFTED_BOARD
        };
        let slide = measure_slide(&board).expect("the slide can be measured");
        assert_eq!(slide.is_head_first, head_direction_deg == 8.0);
        check_estimate(slide.tilt, static_friction.atan().to_degrees(), 0.6);
        check_estimate(slide.static_friction, static_friction, 0.02);
        check_estimate(slide.sliding_friction, sliding_friction, 0.02);
    }
}

/// A board with little friction, for which a short video is sufficient.
const SLIPPERY_BOARD: LiftedBoard = LiftedBoard {
    static_friction: 0.35,
    sliding_friction: 0.3,
    lift_deg_per_s: 8.0,
    end_tilt_deg: 30.0,
    ..EVENLY_LIFTED_BOARD
};

#[test]
fn a_video_without_a_measurable_slide_is_rejected_with_the_reason() {
    let expect_error = |change: fn(&mut LiftedBoard)| {
        let mut board = SLIPPERY_BOARD;
        change(&mut board);
        measure_slide(&board).expect_err("the video shows no measurable slide")
    };
    let not_slid = expect_error(|board| board.end_tilt_deg = 12.0);
    assert_matches!(not_slid, SlideError::NoSlide { tilt, .. } if (tilt - 12.0).abs() < 1.0);
    let moving = expect_error(|board| board.lift_start_s = 0.3);
    assert_matches!(moving, SlideError::NotAtRest { .. });
    let across_slope = expect_error(|board| board.head_direction_deg = 36.0);
    assert_matches!(across_slope, SlideError::AcrossSlope { angle } if (angle - 36.0).abs() < 3.0);
    let pushed = expect_error(|board| board.slide_direction_deg = 180.0);
    assert_matches!(pushed, SlideError::NotDownhill { angle } if angle > 170.0);
    let fast = expect_error(|board| board.lift_deg_per_s = 40.0);
    assert_matches!(fast, SlideError::LiftedTooFast { rate } if rate > 20.0);
    let video = record_board(&SLIPPERY_BOARD, &small_studio(), 5.0);
    let result = MeasuredSlide::from_video(&analyse(&video));
    assert_matches!(result, Err(SlideError::TooFewFrames { .. }));
}

#[test]
fn a_robot_that_is_moved_by_hand_in_the_first_second_has_not_slid() {
    let pose_at = |seconds: f64| [if seconds < 0.25 { 90.0 } else { 55.0 }, 5.0, 0.0];
    let mut rng = Rng::with_seed(4);
    let video = record_robot(&small_studio(), 1.5, 10.0, pose_at, &mut rng);
    let result = MeasuredSlide::from_video(&analyse(&video));
    assert_matches!(result, Err(SlideError::NoSlide { distance, .. }) if distance < 1.0);
}

/// Run by `make measure-test`. The level board's tilt varies with a standard deviation of 0.3 deg, as after
/// levelling with a spirit level.
#[test]
#[ignore = "takes minutes; make measure-test"]
fn in_at_least_14_of_16_videos_the_true_friction_lies_within_two_standard_errors() {
    let mut rng = Rng::with_seed(12);
    let video_count = 16;
    let mut hits = [0; 2];
    for i in 0..video_count {
        let start_tilt_deg = 0.3 * random_normal(&mut rng);
        let mut random_between = |low: f64, high: f64| low + (high - low) * rng.f64();
        let friction = random_between(0.35, 0.8);
        let board = LiftedBoard {
            static_friction: friction,
            sliding_friction: friction * random_between(0.8, 1.0),
            lift_deg_per_s: random_between(2.0, 9.0),
            head_direction_deg: 180.0 * (i % 2) as f64 + random_between(-12.0, 12.0),
            start_tilt_deg,
            ..EVENLY_LIFTED_BOARD
        };
        let mut studio = small_studio();
        (studio.camera_tilt, studio.distortion) =
            (random_between(0.0, 18.0), random_between(-0.006, 0.006));
        studio.readout_s = 0.015;
        let video = record_board(&board, &studio, [30.0, 60.0][i / 2 % 2]);
        let slide = MeasuredSlide::from_video(&analyse(&video)).expect("the slide can be measured");
        let pairs = [
            (slide.static_friction, board.static_friction),
            (slide.sliding_friction, board.sliding_friction),
        ];
        for (hits, (estimate, truth)) in hits.iter_mut().zip(pairs) {
            println!("{estimate:?}, truth {truth:.3}");
            *hits += usize::from((estimate.value - truth).abs() < 2.0 * estimate.standard_error);
        }
    }
    let [static_hits, sliding_hits] = hits;
    println!(
        "{video_count} videos; within two standard errors: static {static_hits}, \
         sliding {sliding_hits}"
    );
    assert!(static_hits >= video_count - 2 && sliding_hits >= video_count - 2);
}
