//! Films that cannot be measured, each with the reason.

use std::assert_matches;

use fastrand::Rng;
use lizard_film::{Film, Gait, MeasuredGait, Picture, Setup, Trouble};
use lizard_studio::render::{Pose, Studio};
use lizard_studio::walk::{Variation, Walk, paper_gait, true_displacement};

use crate::studio::{FULL_SCALE, film_pictures, film_robot, film_walk, small_studio};

/// Pictures per second: a low rate suffices, since most tests check only the reason.
const PICTURE_RATE: f64 = 8.0;

fn studio() -> Studio {
    small_studio(5, 20.0)
}

/// A walk that is centred on the origin.
fn centred_walk(gait: &Gait, cycles: usize) -> Walk {
    let start = [
        -true_displacement(gait).forward * cycles as f64 / 2.0,
        0.0,
        0.0,
    ];
    let mut rng = Rng::with_seed(1);
    Walk::new(gait, start, cycles, Variation::default(), &mut rng)
}

/// Films a centred walk.
fn film_cycles(studio: &Studio, gait: &Gait, cycles: usize, picture_rate: f64) -> Film {
    let (walk, mut rng) = (centred_walk(gait, cycles), Rng::with_seed(2));
    film_walk(studio, &walk, picture_rate, &mut rng)
}

/// Films five cycles of `walk`.
fn film_five_cycles(studio: &Studio) -> Film {
    film_cycles(studio, &paper_gait("walk"), 5, PICTURE_RATE)
}

/// The reason why five cycles of `walk` cannot be measured in this studio.
fn trouble_of(studio: &Studio, setup: Setup) -> Trouble {
    film_five_cycles(studio)
        .measure(setup, &paper_gait("walk"))
        .expect_err("the film cannot be measured")
}

#[test]
fn a_film_without_pictures_or_tags_is_refused() {
    let (gait, mut film) = (paper_gait("walk"), Film::default());
    assert_eq!(film.measure(FULL_SCALE, &gait), Err(Trouble::NoPictures));
    let grey = Picture::new(320, 240, vec![128; 320 * 240]).expect("the picture is complete");
    film.add(0.0, &grey).expect("the picture fits the film");
    assert_eq!(film.measure(FULL_SCALE, &gait), Err(Trouble::NoTag));
}

#[test]
fn a_tag_that_is_always_covered_is_named() {
    let mut studio = studio();
    studio.hidden_tags = vec![2];
    let trouble = trouble_of(&studio, FULL_SCALE);
    assert_eq!(trouble, Trouble::NoFloorTag { id: 2 });
    studio.hidden_tags = vec![4];
    let trouble = trouble_of(&studio, FULL_SCALE);
    assert_matches!(
        trouble,
        Trouble::DeckTagTooRare {
            visible_count: 0,
            ..
        }
    );
}

#[test]
fn a_tag_with_a_cable_over_its_corner_counts_as_missing() {
    let mut studio = studio();
    let [x, y, _] = studio.strips[0];
    studio.discs = vec![[x + 128.0, y + 22.0, 10.0, 40.0]];
    let trouble = trouble_of(&studio, FULL_SCALE);
    assert_eq!(trouble, Trouble::NoFloorTag { id: 1 });
}

#[test]
fn in_the_dark_and_in_the_glare_no_tag_is_found() {
    let mut studio = studio();
    for light in [0.05, 10.0] {
        studio.light = light;
        assert_eq!(trouble_of(&studio, FULL_SCALE), Trouble::NoTag);
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
    let mut rng = Rng::with_seed(2);
    let film = film_robot(
        &studio(),
        walk.duration_s(),
        PICTURE_RATE,
        turned_pose_at,
        &mut rng,
    );
    let trouble = film
        .measure(FULL_SCALE, &gait)
        .expect_err("the robot walks backward");
    assert_matches!(trouble, Trouble::GaitMismatch { .. });
    assert!(trouble.to_string().contains("arrow"), "{trouble}");
}

#[test]
fn pictures_of_another_size_and_times_that_do_not_increase_are_refused() {
    let picture =
        |size| Picture::new(size, size, vec![128; size * size]).expect("the picture is complete");
    let mut film = Film::default();
    film.add(0.0, &picture(64))
        .expect("the first picture fits any film");
    assert_eq!(
        film.add(0.1, &picture(65)),
        Err(Trouble::SizeDiffers { picture_number: 2 })
    );
    assert_eq!(
        film.add(0.0, &picture(64)),
        Err(Trouble::TimeNotLater { picture_number: 2 })
    );
}

/// Films a walk with a camera that is moved once, in the middle. In the second half, the tags `hidden_tags` are
/// covered.
fn film_with_moved_camera(hidden_tags: Vec<usize>) -> Film {
    let walk = centred_walk(&paper_gait("walk"), 5);
    let mut rng = Rng::with_seed(3);
    let first = studio();
    let mut second = first.clone();
    (second.camera_tilt, second.aim[0], second.hidden_tags) =
        (first.camera_tilt + 1.0, first.aim[0] + 12.0, hidden_tags);
    let backgrounds = [first, second].map(|studio| studio.background(&mut rng));
    let count = (walk.duration_s() * PICTURE_RATE) as usize;
    film_pictures(walk.duration_s(), PICTURE_RATE, |seconds| {
        let background = &backgrounds[2 * (seconds * PICTURE_RATE) as usize / count];
        background.picture(seconds, |time| walk.pose_at(time), &mut rng)
    })
}

#[test]
fn a_camera_that_moves_has_to_see_every_tag_of_the_floor() {
    let gait = paper_gait("walk");
    let analysed_film = film_with_moved_camera(Vec::new())
        .analyse(FULL_SCALE)
        .expect("all tags are visible");
    assert!(analysed_film.camera.has_camera_moved);
    let measured = analysed_film.measure(&gait, None);
    check_distance(measured, &gait, 0.3);
    let trouble = film_with_moved_camera(vec![1])
        .measure(FULL_SCALE, &gait)
        .expect_err("a tag is hidden");
    assert_matches!(trouble, Trouble::CameraMoved { picture_count } if picture_count > 15);
}

/// Checks that the measured distance is the true one.
fn check_distance(
    measured: Result<MeasuredGait, Trouble>,
    gait: &Gait,
    max_error: f64,
) -> MeasuredGait {
    let measured = measured.expect("the gait can be measured");
    let error = measured.forward.value - true_displacement(gait).forward;
    assert!(error.abs() < max_error, "{:?}", measured.forward);
    measured
}

#[test]
fn a_tag_that_is_covered_for_a_while_does_no_harm_if_the_camera_stands_still() {
    let gait = paper_gait("walk");
    let walk = centred_walk(&gait, 5);
    let mut rng = Rng::with_seed(3);
    let uncovered = studio();
    let mut covered = uncovered.clone();
    covered.hidden_tags = vec![0];
    let backgrounds = [uncovered, covered].map(|studio| studio.background(&mut rng));
    let film = film_pictures(walk.duration_s(), PICTURE_RATE, |seconds| {
        let background = &backgrounds[(seconds * PICTURE_RATE) as usize / 8 % 2];
        background.picture(seconds, |time| walk.pose_at(time), &mut rng)
    });
    check_distance(film.measure(FULL_SCALE, &gait), &gait, 0.2);
}

#[test]
fn a_sheet_printed_too_small_gives_the_true_distance_if_its_ruler_is_measured() {
    let mut studio = studio();
    studio.print_scale = [0.972; 2];
    let setup = Setup {
        print_scale: 0.972,
        ..FULL_SCALE
    };
    let gait = paper_gait("walk");
    check_distance(film_five_cycles(&studio).measure(setup, &gait), &gait, 0.2);
}

#[test]
fn tags_that_were_cut_apart_and_moved_are_refused() {
    let mut studio = studio();
    studio.tag_distance_factor = 0.95;
    let trouble = trouble_of(&studio, FULL_SCALE);
    assert!(
        matches!(trouble, Trouble::WrongTagSize { edge } if edge > 51.5)
            || matches!(trouble, Trouble::SheetMismatch { .. }),
        "{trouble}"
    );
    let message = trouble.to_string();
    assert!(message.starts_with("the floor's tags"), "{message}");
}

#[test]
fn a_card_at_another_height_than_given_is_noticed_by_its_size() {
    let mut studio = studio();
    studio.deck_tag_height = 83.0;
    let wrong_setup = Setup {
        deck_height: 40.0,
        ..FULL_SCALE
    };
    let trouble = trouble_of(&studio, wrong_setup);
    assert_matches!(trouble, Trouble::WrongHeight { height_by_size, .. } if height_by_size > 52.0);
}

/// The reason why a film of a robot whose pose is given by `pose_at` cannot be measured.
fn trouble_of_robot(pose_at: impl Fn(f64) -> Pose) -> Trouble {
    trouble_in_studio(&studio(), 4.0, pose_at)
}

/// The reason why a film of a robot that does not walk cannot be measured.
fn trouble_in_studio(studio: &Studio, duration_s: f64, pose_at: impl Fn(f64) -> Pose) -> Trouble {
    let mut rng = Rng::with_seed(2);
    let film = film_robot(studio, duration_s, PICTURE_RATE, pose_at, &mut rng);
    let measured = film.measure(FULL_SCALE, &paper_gait("walk"));
    measured.expect_err("the film shows no walk")
}

#[test]
fn a_robot_that_stands_still_is_reported_as_not_moved() {
    let trouble = trouble_of_robot(|_| [0.0; 3]);
    assert_matches!(trouble, Trouble::NoMovement { distance, .. } if distance < 1.0);
}

#[test]
fn a_robot_too_far_from_the_strips_is_refused() {
    let mut studio = studio();
    (studio.size, studio.aim) = ([1280, 720], [150.0, 0.0]);
    studio.camera_height = 1000.0;
    let trouble = trouble_in_studio(&studio, 1.0, |_| [430.0, 0.0, 0.0]);
    assert_matches!(trouble, Trouble::TooFarFromStrips { distance, .. } if distance > 400.0);
}

#[test]
fn movements_that_are_not_the_gait_are_refused() {
    let turning = trouble_of_robot(|time| [0.0, 0.0, 0.6 * time]);
    assert_matches!(turning, Trouble::GaitMismatch { .. });
    let backward = trouble_of_robot(|time| [60.0 - 30.0 * time, 0.0, 0.0]);
    assert_matches!(backward, Trouble::GaitMismatch { .. });
    let creeping = trouble_of_robot(|time| [1.5 * time, 0.0, 0.0]);
    assert_matches!(creeping, Trouble::NoMovement { .. });
}

#[test]
fn cycles_of_twice_or_four_times_the_duration_are_reported_as_another_pace() {
    let gait = paper_gait("walk");
    for multiple in [2, 4] {
        let slow = Gait {
            period: gait.period * f64::from(multiple),
            path: gait.path.clone(),
        };
        let measured = film_cycles(&studio(), &slow, 3, 5.0).measure(FULL_SCALE, &gait);
        assert_eq!(measured, Err(Trouble::WrongPace { ratio: multiple }));
    }
}

#[test]
fn a_film_whose_rate_is_off_by_some_percent_shows_the_distance_per_cycle_and_its_duration() {
    let gait = paper_gait("walk");
    for rate_error in [0.94, 1.04] {
        let stretched = Gait {
            period: gait.period * rate_error,
            path: gait.path.clone(),
        };
        let film = film_cycles(&studio(), &stretched, 6, 12.0);
        let measured = check_distance(film.measure(FULL_SCALE, &gait), &gait, 0.2);
        let error = (measured.period.value / stretched.period - 1.0).abs();
        assert!(error < 0.005, "{rate_error}: {error}");
    }
}

/// A picture of the sheet and the card, with a second copy of them to the right if `has_second_copy`, else an empty
/// area.
fn picture_with_copy(has_second_copy: bool) -> Picture {
    let mut rng = Rng::with_seed(2);
    let picture = studio()
        .background(&mut rng)
        .picture(0.0, |_| [0.0; 3], &mut rng);
    let [width, height] = picture.size();
    let empty_row = vec![200; width];
    let rows = picture.grey().chunks(width);
    let rows =
        rows.flat_map(|row| [row, if has_second_copy { row } else { &empty_row[..] }].concat());
    Picture::new(2 * width, height, rows.collect()).expect("the picture is complete")
}

#[test]
fn a_tag_that_appears_twice_in_a_picture_is_refused() {
    let result = Film::default().add(0.0, &picture_with_copy(true));
    assert_matches!(
        result,
        Err(Trouble::DuplicateTag {
            picture_number: 1,
            ..
        })
    );
}

#[test]
fn a_second_copy_that_appears_later_is_noticed_within_sixteen_pictures() {
    let mut film = Film::default();
    film.add(0.0, &picture_with_copy(false))
        .expect("each tag appears once");
    let doubled_picture = picture_with_copy(true);
    let trouble = (1..=16).find_map(|n| film.add(f64::from(n) / 30.0, &doubled_picture).err());
    assert_matches!(trouble, Some(Trouble::DuplicateTag { .. }));
}

#[test]
fn two_cycles_are_too_few() {
    let gait = paper_gait("walk");
    let measured = film_cycles(&studio(), &gait, 2, PICTURE_RATE).measure(FULL_SCALE, &gait);
    let trouble = measured.expect_err("the film has too few cycles");
    assert_matches!(trouble, Trouble::TooShort { cycles, .. } if (1.0..2.5).contains(&cycles));
}
