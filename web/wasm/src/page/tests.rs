//! Tests of the page's state, without a browser.

use lizard_robot::Travel;

use super::*;
use crate::paper::PAPER_TOML;

#[test]
fn the_previous_robot_stays_after_a_refused_robot() {
    let mut page = PageState::default();
    assert_eq!(page.follow_pulses([24_000; 4]), None);
    page.load(PAPER_TOML).expect("paper.toml is valid");
    let result = page.load("[links]");
    let error = result.expect_err("a robot without links is refused");
    assert!(error.reason.starts_with("robot.toml"), "{error:?}");
    assert!(page.follow_pulses([24_000; 4]).is_some());
}

fn make_paper_page() -> PageState {
    let mut page = PageState::default();
    page.load(PAPER_TOML).expect("paper.toml is valid");
    page
}

/// Makes a page with the paper's robot and ideal servos.
fn make_ideal_page() -> PageState {
    let mut page = make_paper_page();
    page.set_servo_model("ideal");
    page
}

/// Returns the robot's own slider values.
fn own_floor(page: &PageState) -> Floor {
    Floor::for_robot(page.robot().expect("a robot is loaded"))
}

fn predict_walk(page: &PageState) -> GaitPrediction {
    let walk = page.robot().and_then(|robot| robot.gait("walk"));
    let walk_index = walk.expect("the robot has this gait").index();
    page.predict(walk_index).expect("the robot has this gait")
}

/// Predicts the distance of a cycle of `walk`, mm.
fn predict_walk_mm(page: &PageState) -> f64 {
    let forward = predict_walk(page).displacement.forward;
    forward.expect("the displacement is determined")
}

#[test]
fn a_servo_keeps_its_angle_when_its_pulses_end() {
    let mut page = make_ideal_page();
    let require_scene = |frame: Option<Frame>| {
        let scene = frame.and_then(|frame| frame.scene);
        scene.expect("every loop closes")
    };
    let first_scene = require_scene(page.follow_pulses([24_000 + 1600, 24_000, 24_000, 24_000]));
    let error = first_scene.angles[0] - 148.590378;
    assert!(error.abs() < 1e-9, "{first_scene:?}");
    assert_eq!(require_scene(page.follow_pulses([0; 4])), first_scene);
}

#[test]
fn real_servos_have_a_dead_band_and_limited_speed_but_ideal_servos_do_not() {
    let mut page = make_paper_page();
    let step_a1 = |page: &mut PageState, cycles: u32| {
        let frame = page.follow_pulses([24_000 + cycles, 24_000, 24_000, 24_000]);
        let frame = frame.expect("a robot is loaded");
        let scene = frame.scene.expect("every loop closes");
        let error = page.target_angles[0] - scene.angles[0];
        (scene.angles[0] - 138.590378, error)
    };
    let assert_near = |(turn, error): (f64, f64), expected: [f64; 2]| {
        assert!((turn - expected[0]).abs() < 1e-9, "turn {turn} deg");
        assert!((error - expected[1]).abs() < 1e-9, "error {error} deg");
    };
    // 4 us is less than half of the servo's dead band of 10 us.
    assert_near(step_a1(&mut page, 64), [0.0, 0.4]);
    // A step of 20 deg: in the first 20 ms, a servo of 500 deg/s turns by less than 10 deg, because the rotor must spin
    // up. Afterwards, its error stays within the dead band plus the error that holds the pad against friction.
    let (first_turn, _) = step_a1(&mut page, 3200);
    assert!((1.0..10.0).contains(&first_turn), "{first_turn}");
    for _ in 0..20 {
        step_a1(&mut page, 3200);
    }
    let (last_turn, error) = step_a1(&mut page, 3200);
    assert!((18.8..20.6).contains(&last_turn), "{last_turn}");
    assert!((last_turn + error - 20.0).abs() < 1e-9);
    page.set_servo_model("ideal");
    assert_near(step_a1(&mut page, 3200), [20.0, 0.0]);
    // An unknown model has no effect: the servos stay ideal.
    page.set_servo_model("better");
    assert_near(step_a1(&mut page, 0), [0.0, 0.0]);
}

/// Follows two cycles of a gait with ideal servos, by poses that are `frame_step` frames apart. Returns for the
/// second cycle the displacement, the slide of each foot per pose, mm, and the largest lag, deg.
fn follow_cycles(
    page: &mut PageState,
    name: &str,
    frame_step: u32,
) -> (Travel, Vec<[f64; 4]>, f64) {
    page.set_servo_model("ideal");
    let gait = page.robot().and_then(|robot| robot.gait(name));
    let gait = gait.expect("the robot has this gait");
    let frames = gait.frames().step_by(frame_step as usize);
    let poses = frames.map(|(_, phase)| gait.table_angles(phase));
    let poses: Vec<[f64; 4]> = poses.collect();
    let mut follow_cycle = || -> Vec<Frame> {
        let frame_at = |angles: &[f64; 4]| {
            let frame = page.follow_pose(*angles, frame_step);
            frame.expect("a robot is loaded")
        };
        poses.iter().map(frame_at).collect()
    };
    let (first_cycle, second_cycle) = (follow_cycle(), follow_cycle());
    let end_place = |frames: &[Frame]| frames.last().expect("a cycle has frames").place;
    let slips = second_cycle.iter().map(|frame| frame.slips).collect();
    let lags = second_cycle.iter().flat_map(|frame| frame.lags);
    let largest_lag = lags.fold(0.0, |largest: f64, lag| largest.max(lag.abs()));
    let displacement = end_place(&first_cycle).displacement_to(end_place(&second_cycle));
    (displacement, slips, largest_lag)
}

#[test]
fn a_cycle_followed_frame_by_frame_ends_where_predicted() {
    for name in ["walk", "left", "arc-right", "back"] {
        let mut page = make_paper_page();
        let robot = page.robot().expect("a robot is loaded");
        let prediction = robot.predict(robot.gait(name).expect("the robot has this gait"));
        // A pose in every frame, and in every second frame, as a board reports poses on USB.
        for frame_step in [1, 2] {
            let (displacement, _, _) = follow_cycles(&mut page, name, frame_step);
            let assert_near = |value: f64, expected: Option<f64>, tolerance: f64| {
                let deviation = value - expected.expect("the displacement is determined");
                assert!(
                    deviation.abs() < tolerance,
                    "{name}, {frame_step} frames per pose: {displacement:?}"
                );
            };
            // The poses in between are interpolated.
            let tolerance = 0.4 * f64::from(frame_step);
            assert_near(displacement.forward, prediction.forward, tolerance);
            assert_near(displacement.left, prediction.left, 0.5);
            assert_near(displacement.turn, prediction.turn, 0.3);
        }
    }
}

#[test]
fn the_prediction_depends_on_the_servos_dead_band_torque_and_supply() {
    let mut page = make_paper_page();
    let predict_utilisations = |page: &PageState| {
        let utilisations = predict_walk(page).utilisations;
        utilisations.expect("the servos are not ideal")
    };
    let sg90_mm = predict_walk_mm(&page);
    page.set_servo_model("ideal");
    let ideal_mm = predict_walk_mm(&page);
    // The loss is 1 deg of 40, as in crates/twin/tests/frames.rs, plus up to 2 %, because a waveform's samples cut its
    // corners; the prediction for ideal servos has no such samples.
    assert!(
        (sg90_mm / ideal_mm - 39.0 / 40.0).abs() < 0.02,
        "SG90 {sg90_mm} mm, ideal {ideal_mm} mm"
    );
    page.set_servo_model("copy");
    let copy_utilisations = predict_utilisations(&page);
    page.set_servo_model("own");
    let own_utilisations = predict_utilisations(&page);
    for (copy_utilisation, own_utilisation) in copy_utilisations.into_iter().zip(own_utilisations) {
        assert!(
            copy_utilisation > 1.3 * own_utilisation,
            "a weaker servo must have a higher utilisation: copy {copy_utilisation}, own {own_utilisation}"
        );
    }
    // docs/gaits.md lists these two values, for half and full pace, and also the value for 4 V that is checked below.
    let assert_near = |utilisations: [f64; 20], step: usize, expected: f64| {
        let error = utilisations[step] - expected;
        assert!(error.abs() < 0.005, "{utilisations:?}");
    };
    assert_near(own_utilisations, 9, 0.45);
    assert_near(own_utilisations, 19, 0.72);
    page.set_servo_model("own at 4.0");
    let low_supply_utilisations = predict_utilisations(&page);
    assert_near(low_supply_utilisations, 19, 0.87);
    // An invalid supply has no effect.
    page.set_servo_model("own at 12");
    page.set_servo_model("own at a wall");
    assert_eq!(predict_utilisations(&page), low_supply_utilisations);
}

#[test]
fn at_least_two_feet_stick_at_any_time_of_a_walk() {
    let (_, slips, _) = follow_cycles(&mut make_paper_page(), "walk", 1);
    let mut slid_mm = [0.0; 4];
    for frame_slips in slips {
        let sticking_count = frame_slips.iter().filter(|mm| **mm < 0.3).count();
        assert!(sticking_count >= 2, "{frame_slips:?} mm");
        slid_mm = [0, 1, 2, 3].map(|i| slid_mm[i] + frame_slips[i]);
    }
    assert!(
        slid_mm.iter().all(|mm| *mm > 20.0),
        "each foot must slide at some time in the cycle: {slid_mm:?} mm"
    );
}

#[test]
fn springs_set_on_the_page_act_as_predicted() {
    let mut page = make_ideal_page();
    let (rigid_prediction, rigid_mm) = (predict_walk(&page), predict_walk_mm(&page));
    assert_eq!(rigid_prediction.lag, None);
    assert_eq!(rigid_prediction.fraction, None);
    for force in [0.35, 0.55] {
        page.set_floor(Floor {
            kind: LegDrive::Strut,
            force,
            ..own_floor(&page)
        });
        let (sprung_prediction, sprung_mm) = (predict_walk(&page), predict_walk_mm(&page));
        let (displacement, _, largest_lag) = follow_cycles(&mut page, "walk", 1);
        assert!(
            (displacement.forward - sprung_mm).abs() < 0.5,
            "followed {displacement:?}, predicted {sprung_prediction:?}"
        );
        let predicted_lag = sprung_prediction.lag.expect("the legs have springs");
        assert!(
            (largest_lag / predicted_lag - 1.0).abs() < 0.05,
            "lag {largest_lag} deg, predicted {sprung_prediction:?}"
        );
        let predicted_fraction = sprung_prediction.fraction.expect("the legs have springs");
        let error = predicted_fraction - sprung_mm / rigid_mm;
        assert!(error.abs() < 0.01, "{sprung_prediction:?}");
    }
}

#[test]
fn mass_and_friction_matter_only_with_springs() {
    let predict_with = |kind: LegDrive, mass: f64, friction: f64, force: f64| {
        let mut page = make_ideal_page();
        page.set_floor(Floor {
            kind,
            force,
            rate: 0.8 * force,
            mass,
            friction,
            ..own_floor(&page)
        });
        predict_walk_mm(&page)
    };
    let [rigid, strut] = [LegDrive::Rigid, LegDrive::Strut];
    let rigid_mm = predict_with(rigid, 280.0, 0.7, 1.0);
    assert_eq!(rigid_mm, predict_with(rigid, 560.0, 0.2, 1.0));
    let strut_mm = predict_with(strut, 280.0, 0.7, 0.5);
    assert!((strut_mm - predict_with(strut, 140.0, 1.4, 0.5)).abs() < 1e-6);
    assert!((strut_mm - predict_with(strut, 280.0, 1.4, 1.0)).abs() < 1e-6);
    assert!((strut_mm - predict_with(strut, 280.0, 1.4, 0.5)).abs() > 1.0);
}

#[test]
fn friction_that_differs_by_direction_changes_the_prediction() {
    let mut page = make_paper_page();
    let isotropic_prediction = predict_walk(&page);
    page.set_floor(Floor {
        ratio: 1.4,
        ..own_floor(&page)
    });
    assert_ne!(predict_walk(&page), isotropic_prediction);
    assert_eq!(page.predict(99), None);
}

#[test]
fn a_written_floor_is_read_back_and_all_other_values_stay() {
    let read_floor =
        |text: &str| Floor::for_robot(&Robot::parse(text).expect("the text is a valid robot"));
    let write_floor = |text: &str, floor| {
        let edited = PageState::edit_floor(text, floor).expect("the values can be written");
        assert_eq!(edited.refusal, None);
        edited.text
    };
    assert_eq!(write_floor(PAPER_TOML, read_floor(PAPER_TOML)), PAPER_TOML);
    let floor = Floor {
        friction: 0.55,
        ratio: 1.5,
        mass: 412.0,
        leaf: 2.0,
        twist: -0.6,
        kind: LegDrive::Strut,
        force: 2.5,
        rate: 0.25,
        play: 0.5,
    };
    let strut_toml = write_floor(PAPER_TOML, floor);
    assert_eq!(read_floor(&strut_toml), floor);
    let rigid_toml = write_floor(&strut_toml, read_floor(PAPER_TOML));
    assert_eq!(read_floor(&rigid_toml), read_floor(PAPER_TOML));
    assert!(!rigid_toml.contains("\nforce ="), "{rigid_toml}");
}

#[test]
fn a_foot_that_is_too_long_shortens_the_predicted_walk_on_stiff_feet() {
    let mut page = make_paper_page();
    let own_floor = own_floor(&page);
    let mut predict_with = |leaf: f64, twist: f64| {
        page.set_floor(Floor {
            leaf,
            twist,
            ..own_floor
        });
        predict_walk_mm(&page)
    };
    let level_mm = predict_with(2.0, 0.0);
    assert!(predict_with(3.3, 1.0) < 0.3 * level_mm);
    assert!(predict_with(own_floor.leaf, 1.0) > 0.9 * level_mm);
}
