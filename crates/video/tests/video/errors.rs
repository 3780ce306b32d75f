//! Tests with videos that cannot be measured.

use std::assert_matches;

use fastrand::Rng;
use lizard_studio::render::{Pose, Studio};
use lizard_studio::walk::{Variation, Walk, paper_gait, true_displacement};
use lizard_video::{Frame, Gait, MeasuredGait, Setup, Video, VideoError};

use crate::studio::{
    FRAME_RATE, FULL_SCALE, add_frame, record_frames, record_robot, record_walk, scaled_gait,
    studio,
};

/// Returns a walk that is centred on the origin.
fn centred_walk(gait: &Gait, cycle_count: usize) -> Walk {
    let start_forward = -true_displacement(gait).forward * cycle_count as f64 / 2.0;
    let start = [start_forward, 0.0, 0.0];
    let mut rng = Rng::with_seed(1);
    Walk::new(gait, start, cycle_count, Variation::default(), &mut rng)
}

/// Records a centred walk.
fn record_cycles(studio: &Studio, gait: &Gait, cycle_count: usize, frame_rate: f64) -> Video {
    let (walk, mut rng) = (centred_walk(gait, cycle_count), Rng::with_seed(2));
    record_walk(studio, &walk, frame_rate, &mut rng)
}

/// Records five cycles of `walk`.
fn record_five_cycles(studio: &Studio) -> Video {
    record_cycles(studio, &paper_gait("walk"), 5, FRAME_RATE)
}

/// Returns the error that occurs when five cycles of `walk` are measured in a changed studio.
fn expect_error(setup: Setup, change: impl Fn(&mut Studio)) -> VideoError {
    let mut studio = studio();
    change(&mut studio);
    let measured = record_five_cycles(&studio).measure(setup, &paper_gait("walk"));
    measured.expect_err("the video cannot be measured")
}

#[test]
fn a_video_without_frames_or_tags_is_rejected() {
    let (gait, mut video) = (paper_gait("walk"), Video::default());
    assert_eq!(video.measure(FULL_SCALE, &gait), Err(VideoError::NoFrames));
    let grey = Frame::new(320, 240, vec![128; 320 * 240]).expect("the frame is complete");
    add_frame(&mut video, 0.0, &grey);
    assert_eq!(video.measure(FULL_SCALE, &gait), Err(VideoError::NoTag));
}

#[test]
fn the_error_names_a_tag_that_is_always_covered() {
    let error = expect_error(FULL_SCALE, |studio| studio.covered_tags = vec![2]);
    assert_eq!(error, VideoError::NoFloorTag { id: 2 });
    let error = expect_error(FULL_SCALE, |studio| studio.covered_tags = vec![4]);
    let VideoError::DeckTagTooRare { visible_count, .. } = error else {
        panic!("{error}");
    };
    assert_eq!(visible_count, 0);
}

#[test]
fn a_tag_with_a_cable_over_its_corner_counts_as_missing() {
    let error = expect_error(FULL_SCALE, |studio| {
        let [x, y, _] = studio.strips[0];
        studio.discs = vec![[x + 128.0, y + 22.0, 10.0, 40.0]];
    });
    assert_eq!(error, VideoError::NoFloorTag { id: 1 });
}

#[test]
fn no_tag_is_found_in_darkness_or_glare() {
    for light in [0.05, 10.0] {
        let error = expect_error(FULL_SCALE, |studio| studio.light = light);
        assert_eq!(error, VideoError::NoTag, "light {light}");
    }
}

#[test]
fn a_card_whose_arrow_points_to_the_tail_is_reported_as_another_gait() {
    let gait = paper_gait("walk");
    let walk = centred_walk(&gait, 5);
    let turned_pose_at = |time| {
        let [x, y, heading] = walk.pose_at(time);
        [x, y, heading + std::f64::consts::PI]
    };
    let (duration_s, mut rng) = (walk.duration_s(), Rng::with_seed(2));
    let video = record_robot(&studio(), duration_s, FRAME_RATE, turned_pose_at, &mut rng);
    let measured = video.measure(FULL_SCALE, &gait);
    let error = measured.expect_err("the robot walks backward");
    assert_matches!(error, VideoError::GaitMismatch { .. });
    assert!(error.to_string().contains("arrow"), "{error}");
}

#[test]
fn frames_of_another_size_and_times_that_do_not_increase_are_rejected() {
    let frame =
        |size| Frame::new(size, size, vec![128; size * size]).expect("the frame is complete");
    let mut video = Video::default();
    let result = video.add_frame(0.0, &frame(64));
    result.expect("the first frame fits any video");
    for (seconds, size, error) in [
        (0.1, 65, VideoError::SizeDiffers { frame_number: 2 }),
        (0.0, 64, VideoError::TimeNotLater { frame_number: 2 }),
    ] {
        let result = video.add_frame(seconds, &frame(size));
        assert_eq!(result, Err(error), "{size} px at {seconds} s");
    }
}

/// Records five cycles of `walk`. `studio_index` selects the studio of a frame from its index and the number of frames.
fn record_in_two_studios(
    studios: [Studio; 2],
    studio_index: impl Fn(usize, usize) -> usize,
) -> Video {
    let walk = centred_walk(&paper_gait("walk"), 5);
    let mut rng = Rng::with_seed(3);
    let backgrounds = studios.map(|studio| studio.render_background(&mut rng));
    let count = (walk.duration_s() * FRAME_RATE) as usize;
    record_frames(walk.duration_s(), FRAME_RATE, |seconds| {
        let background = &backgrounds[studio_index((seconds * FRAME_RATE) as usize, count)];
        background.render_frame(seconds, |time| walk.pose_at(time), &mut rng)
    })
}

/// Records a walk with a camera that moves halfway through the video. In the second half, `covered_tags` are covered.
fn record_with_moved_camera(covered_tags: Vec<usize>) -> Video {
    let first = studio();
    let mut second = first.clone();
    (second.camera_tilt, second.aim[0], second.covered_tags) =
        (first.camera_tilt + 1.0, first.aim[0] + 12.0, covered_tags);
    record_in_two_studios([first, second], |index, count| 2 * index / count)
}

#[test]
fn a_moving_camera_must_see_every_floor_tag() {
    let gait = paper_gait("walk");
    let analysed_video = record_with_moved_camera(Vec::new()).analyse(FULL_SCALE);
    let analysed_video = analysed_video.expect("all tags are visible");
    assert!(analysed_video.camera.has_camera_moved);
    let measured = analysed_video.measure(&gait, None);
    check_distance(measured, &gait, 0.3);
    let measured = record_with_moved_camera(vec![1]).measure(FULL_SCALE, &gait);
    let error = measured.expect_err("a tag is hidden");
    assert_matches!(error, VideoError::CameraMoved { frame_count } if frame_count > 15);
}

/// Checks that the measured distance matches the true distance.
fn check_distance(
    measured: Result<MeasuredGait, VideoError>,
    gait: &Gait,
    max_error: f64,
) -> MeasuredGait {
    let measured = measured.expect("the gait can be measured");
    let error = measured.forward.value - true_displacement(gait).forward;
    assert!(error.abs() < max_error, "{:?}", measured.forward);
    measured
}

#[test]
fn a_floor_tag_may_be_covered_for_a_while_if_the_camera_stands_still() {
    let gait = paper_gait("walk");
    let uncovered = studio();
    let mut covered = uncovered.clone();
    covered.covered_tags = vec![0];
    let video = record_in_two_studios([uncovered, covered], |index, _| index / 8 % 2);
    check_distance(video.measure(FULL_SCALE, &gait), &gait, 0.2);
}

#[test]
fn a_sheet_printed_too_small_gives_the_true_distance_if_the_ruler_is_measured() {
    let mut studio = studio();
    studio.print_scale = [0.972; 2];
    let setup = Setup {
        print_scale: 0.972,
        ..FULL_SCALE
    };
    let gait = paper_gait("walk");
    let measured = record_five_cycles(&studio).measure(setup, &gait);
    check_distance(measured, &gait, 0.2);
}

#[test]
fn tags_that_were_cut_apart_and_moved_are_rejected() {
    let error = expect_error(FULL_SCALE, |studio| studio.tag_distance_factor = 0.95);
    assert!(
        matches!(error, VideoError::WrongTagSize { edge } if edge > 51.5)
            || matches!(error, VideoError::SheetMismatch { .. }),
        "{error}"
    );
    let message = error.to_string();
    assert!(message.starts_with("the floor tags are"), "{message}");
}

#[test]
fn a_card_at_another_height_than_given_is_rejected_by_its_size() {
    let wrong_setup = Setup {
        deck_height: 40.0,
        ..FULL_SCALE
    };
    let error = expect_error(wrong_setup, |studio| studio.deck_tag_height = 83.0);
    assert_matches!(error, VideoError::WrongHeight { height_by_size, .. } if height_by_size > 52.0);
}

/// Returns the error that occurs when `walk` is measured in a video of a robot that moves as `pose_at` determines.
fn expect_robot_error(pose_at: impl Fn(f64) -> Pose) -> VideoError {
    expect_robot_error_in(&studio(), 4.0, pose_at)
}

/// Returns the error of [`expect_robot_error`] in a studio, for a video of `duration_s`.
fn expect_robot_error_in(
    studio: &Studio,
    duration_s: f64,
    pose_at: impl Fn(f64) -> Pose,
) -> VideoError {
    let mut rng = Rng::with_seed(2);
    let video = record_robot(studio, duration_s, FRAME_RATE, pose_at, &mut rng);
    let measured = video.measure(FULL_SCALE, &paper_gait("walk"));
    measured.expect_err("the video shows no walk")
}

#[test]
fn a_robot_that_stands_still_is_reported_as_not_moving() {
    let error = expect_robot_error(|_| [0.0; 3]);
    assert_matches!(error, VideoError::NoMovement { distance, .. } if distance < 1.0);
}

#[test]
fn a_robot_too_far_from_the_strips_is_rejected() {
    let mut studio = studio();
    (studio.size, studio.aim) = ([1280, 720], [150.0, 0.0]);
    studio.camera_height = 1000.0;
    let error = expect_robot_error_in(&studio, 1.0, |_| [430.0, 0.0, 0.0]);
    assert_matches!(error, VideoError::TooFarFromStrips { distance, .. } if distance > 400.0);
}

#[test]
fn movements_that_do_not_match_the_gait_are_rejected() {
    let turning = expect_robot_error(|time| [0.0, 0.0, 0.6 * time]);
    assert_matches!(turning, VideoError::GaitMismatch { .. });
    let backward = expect_robot_error(|time| [60.0 - 30.0 * time, 0.0, 0.0]);
    assert_matches!(backward, VideoError::GaitMismatch { .. });
    let creeping = expect_robot_error(|time| [1.5 * time, 0.0, 0.0]);
    assert_matches!(creeping, VideoError::NoMovement { .. });
}

#[test]
fn cycles_of_twice_or_four_times_the_duration_are_reported_as_another_pace() {
    for (name, multiple, scale) in [
        ("walk", 2, 1.0),
        ("walk", 4, 1.0),
        ("trot", 2, 0.7),
        ("left", 2, 1.0),
        ("crawl", 2, 1.0),
    ] {
        let gait = paper_gait(name);
        let mut slow = scaled_gait(&gait, scale);
        slow.period *= f64::from(multiple);
        let measured = record_cycles(&studio(), &slow, 3, 5.0).measure(FULL_SCALE, &gait);
        let wrong_pace = VideoError::WrongPace { ratio: multiple };
        assert_eq!(measured, Err(wrong_pace), "{name}, scale {scale}");
    }
}

#[test]
fn a_frame_rate_error_of_some_percent_does_not_change_the_distance_per_cycle() {
    let gait = paper_gait("walk");
    for rate_factor in [0.94, 1.04] {
        let mut stretched = gait.clone();
        stretched.period *= rate_factor;
        let video = record_cycles(&studio(), &stretched, 6, 12.0);
        let measured = check_distance(video.measure(FULL_SCALE, &gait), &gait, 0.2);
        let error = (measured.period.value / stretched.period - 1.0).abs();
        assert!(
            error < 0.005,
            "rate factor {rate_factor}: relative error {error}"
        );
    }
}

/// Renders the sheet and the card. On the right are a second copy of both if `has_second_copy`, and an empty
/// area otherwise.
fn render_sheet(has_second_copy: bool) -> Frame {
    let mut rng = Rng::with_seed(2);
    let background = studio().render_background(&mut rng);
    let frame = background.render_frame(0.0, |_| [0.0; 3], &mut rng);
    let [width, height] = frame.size();
    let empty_row = vec![200; width];
    let rows = frame.grey().chunks(width);
    let rows =
        rows.flat_map(|row| [row, if has_second_copy { row } else { &empty_row[..] }].concat());
    Frame::new(2 * width, height, rows.collect()).expect("the frame is complete")
}

#[test]
fn a_tag_that_appears_twice_in_a_frame_is_rejected() {
    let result = Video::default().add_frame(0.0, &render_sheet(true));
    let Err(VideoError::DuplicateTag { frame_number, .. }) = result else {
        panic!("{result:?}");
    };
    assert_eq!(frame_number, 1);
}

#[test]
fn a_second_copy_that_appears_later_is_noticed_within_sixteen_frames() {
    let mut video = Video::default();
    let result = video.add_frame(0.0, &render_sheet(false));
    result.expect("each tag appears once");
    let doubled_frame = render_sheet(true);
    let error = (1..=16).find_map(|n| video.add_frame(f64::from(n) / 30.0, &doubled_frame).err());
    assert_matches!(error, Some(VideoError::DuplicateTag { .. }));
}

#[test]
fn a_video_of_two_cycles_is_rejected_as_too_short() {
    let gait = paper_gait("walk");
    let measured = record_cycles(&studio(), &gait, 2, FRAME_RATE).measure(FULL_SCALE, &gait);
    let error = measured.expect_err("the video has too few cycles");
    assert_matches!(error, VideoError::TooShort { cycles, .. } if (1.0..2.5).contains(&cycles));
}
