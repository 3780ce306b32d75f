//! Tests of the page's robot, without a browser.

use lizard_robot::Travel;

use super::*;

const PAPER: &str = include_str!("../../../../robots/paper.toml");

#[test]
fn a_refused_robot_leaves_the_previous_one() {
    let mut page = Page::default();
    assert_eq!(page.pulses([24_000; 4]), None);
    page.read(PAPER).expect("right");
    let error = page.read("[links]").expect_err("refused");
    assert!(error.refused.starts_with("robot.toml"), "{error:?}");
    assert!(page.pulses([24_000; 4]).is_some());
}

fn page() -> Page {
    let mut page = Page::default();
    page.read(PAPER).expect("right");
    page
}

/// Returns the index of a gait.
fn index(page: &Page, name: &str) -> usize {
    let gait = page.robot().and_then(|robot| robot.gait(name));
    gait.expect(name).index()
}

#[test]
fn pulses_that_end_leave_a_servo_where_it_is() {
    let mut page = page();
    page.set_servos("ideal");
    let scene = |frame: Option<Frame>| frame.and_then(|frame| frame.scene).expect("closes");
    let first = scene(page.pulses([24_000 + 1600, 24_000, 24_000, 24_000]));
    assert!((first.angles[0] - 148.590378).abs() < 1e-9, "{first:?}");
    assert_eq!(scene(page.pulses([0; 4])), first);
}

#[test]
fn servos_have_their_dead_band_and_their_rate_and_ideal_ones_neither() {
    let mut page = page();
    let turned = |page: &mut Page, cycles: u32| {
        let frame = page.pulses([24_000 + cycles, 24_000, 24_000, 24_000]);
        let frame = frame.expect("a robot");
        (
            frame.scene.expect("closes").angles[0] - 138.590378,
            frame.errors[0],
        )
    };
    let near = |(turned, error): (f64, f64), wanted: [f64; 2]| {
        assert!((turned - wanted[0]).abs() < 1e-9, "{turned}");
        assert!((error - wanted[1]).abs() < 1e-9, "{error}");
    };
    // 4 us are less than half of the servo's dead band of 10 us.
    near(turned(&mut page, 64), [0.0, 0.4]);
    // A step of 20 deg: less than 10 in the first 20 ms at 500 deg/s, as the rotor must spin up; then it stays within
    // the dead band plus the error that the servo needs to hold its pad against friction.
    let (first, _) = turned(&mut page, 3200);
    assert!((1.0..10.0).contains(&first), "{first}");
    for _ in 0..20 {
        turned(&mut page, 3200);
    }
    let (last, error) = turned(&mut page, 3200);
    assert!((18.8..20.6).contains(&last), "{last}");
    assert!((last + error - 20.0).abs() < 1e-9);
    page.set_servos("ideal");
    near(turned(&mut page, 3200), [20.0, 0.0]);
    // An unknown model changes nothing: the servos stay ideal.
    page.set_servos("better");
    near(turned(&mut page, 0), [0.0, 0.0]);
}

/// Lets the page follow two cycles of a gait with ideal servos, by poses `frames` frames apart. Returns the
/// second cycle's displacement, its slide of each foot per pose, mm, and its largest lag, deg.
fn cycle(page: &mut Page, name: &str, frames: u32) -> (Travel, Vec<[f64; 4]>, f64) {
    page.set_servos("ideal");
    let gait = page.robot().and_then(|robot| robot.gait(name)).expect(name);
    let poses: Vec<[f64; 4]> = gait
        .frames()
        .step_by(frames as usize)
        .map(|(_, phase)| gait.table_angles(phase))
        .collect();
    let mut follow = || -> Vec<Frame> {
        let follow = |angles: &[f64; 4]| page.pose(*angles, frames).expect("a robot");
        poses.iter().map(follow).collect()
    };
    let (first, second) = (follow(), follow());
    let end = |frames: &[Frame]| frames.last().expect("frames").place;
    let slides = second.iter().map(|frame| frame.slides).collect();
    let lag = second.iter().flat_map(|frame| frame.lag);
    let lag = lag.fold(0.0, |largest: f64, lag| largest.max(lag.abs()));
    (end(&first).movement_to(end(&second)), slides, lag)
}

#[test]
fn a_cycle_frame_by_frame_leads_where_the_prediction_says() {
    for name in ["walk", "left", "arc-right", "back"] {
        let mut page = page();
        let robot = page.robot().expect("a robot");
        let wanted = robot.predict(robot.gait(name).expect("a gait"));
        // A pose in every frame, and in every second frame, as a board on USB reports.
        for frames in [1, 2] {
            let (movement, _, _) = cycle(&mut page, name, frames);
            let near = |got: f64, wanted: Option<f64>, within: f64| {
                let deviation = got - wanted.expect("decided");
                assert!(deviation.abs() < within, "{name} {frames} {movement:?}");
            };
            // The poses in between are interpolated.
            near(movement.forward, wanted.forward, 0.4 * f64::from(frames));
            near(movement.left, wanted.left, 0.5);
            near(movement.turn, wanted.turn, 0.3);
        }
    }
}

#[test]
fn servos_with_a_dead_band_are_predicted_to_lose_it() {
    let mut page = page();
    let walk = index(&page, "walk");
    let forward = |page: &Page| {
        page.predict(walk)
            .and_then(|movement| movement.movement.forward())
    };
    let sg90 = forward(&page).expect("decided");
    page.set_servos("ideal");
    let ideal = forward(&page).expect("decided");
    // The loss is 1 deg of 40, as in crates/twin/tests/stream.rs, and up to 2 % where the samples
    // of a waveform cut its corners; the prediction for ideal servos has no such samples.
    assert!((sg90 / ideal - 39.0 / 40.0).abs() < 0.02, "{sg90} {ideal}");
    page.set_servos("copy");
    let copy = page.predict(walk).expect("decided");
    let copy = copy.lines.expect("shares");
    page.set_servos("own");
    let own = page
        .predict(walk)
        .and_then(|movement| movement.lines)
        .expect("shares");
    for (copy, own) in copy.into_iter().zip(own) {
        assert!(copy > 1.3 * own, "a weaker servo uses more: {copy} {own}");
    }
    // docs/gaits.md lists these two values, for half and full pace, and also the value for 4 V that is checked below.
    assert!(
        (own[9] - 0.45).abs() < 0.005 && (own[19] - 0.72).abs() < 0.005,
        "{own:?}"
    );
    page.set_servos("own at 4.0");
    let weak = page.predict(walk).and_then(|movement| movement.lines);
    assert!((weak.expect("shares")[19] - 0.87).abs() < 0.005, "{weak:?}");
    // An unknown supply changes nothing.
    page.set_servos("own at 12");
    page.set_servos("own at a wall");
    assert_eq!(page.predict(walk).and_then(|movement| movement.lines), weak);
}

#[test]
fn in_a_walk_most_feet_hold() {
    let (_, slides, _) = cycle(&mut page(), "walk", 1);
    let mut slid = [0.0; 4];
    for frame in slides {
        let holds = frame.iter().filter(|mm| **mm < 0.3).count();
        assert!(holds >= 2, "{frame:?}");
        slid = [0, 1, 2, 3].map(|i| slid[i] + frame[i]);
    }
    assert!(
        slid.iter().all(|mm| *mm > 20.0),
        "each foot is dragged once: {slid:?}"
    );
}

#[test]
fn springs_that_are_set_act_and_are_predicted() {
    let mut page = page();
    page.set_servos("ideal");
    let walk = index(&page, "walk");
    let rigid = page.predict(walk).expect("a gait");
    assert_eq!((rigid.lag, rigid.share), (None, None));
    for force in [0.35, 0.55] {
        page.set_floor(Floor {
            kind: Legs::Strut,
            force,
            ..Floor::of(page.robot().expect("a robot"))
        });
        let soft = page.predict(walk).expect("a gait");
        let (movement, _, lag) = cycle(&mut page, "walk", 1);
        let forward = |movement: &GaitPrediction| movement.movement.forward().expect("decided");
        assert!(
            (movement.forward - forward(&soft)).abs() < 0.5,
            "{movement:?} {soft:?}"
        );
        assert!(
            (lag / soft.lag.expect("springs") - 1.0).abs() < 0.05,
            "{lag} {soft:?}"
        );
        let share = forward(&soft) / forward(&rigid);
        assert!(
            (soft.share.expect("springs") - share).abs() < 0.01,
            "{soft:?}"
        );
    }
}

#[test]
fn a_strut_that_bears_the_friction_is_as_good_as_rigid() {
    let mut page = page();
    let floor = Floor {
        kind: Legs::Strut,
        force: 3.0,
        ..Floor::of(page.robot().expect("a robot"))
    };
    page.set_floor(floor);
    let strut = page.predict(index(&page, "walk")).expect("a gait");
    assert!(strut.share.expect("springs") > 0.99, "{strut:?}");
}

#[test]
fn weight_and_friction_matter_to_springs_alone() {
    let walked = |kind: Legs, mass: f64, friction: f64, force: f64| {
        let mut page = page();
        page.set_servos("ideal");
        let floor = Floor {
            kind,
            force,
            rate: 0.8 * force,
            mass,
            friction,
            ..Floor::of(page.robot().expect("a robot"))
        };
        page.set_floor(floor);
        let movement = page.predict(index(&page, "walk")).expect("a gait").movement;
        movement.forward().expect("decided")
    };
    let [rigid, strut] = [Legs::Rigid, Legs::Strut];
    let own = walked(rigid, 280.0, 0.7, 1.0);
    assert_eq!(own, walked(rigid, 560.0, 0.2, 1.0));
    let light = walked(strut, 280.0, 0.7, 0.5);
    assert!((light - walked(strut, 140.0, 1.4, 0.5)).abs() < 1e-6);
    assert!((light - walked(strut, 280.0, 1.4, 1.0)).abs() < 1e-6);
    assert!((light - walked(strut, 280.0, 1.4, 0.5)).abs() > 1.0);
}

#[test]
fn friction_that_differs_by_direction_changes_the_prediction() {
    let mut page = page();
    let walk = index(&page, "walk");
    let even = page.predict(walk);
    let floor = Floor {
        ratio: 1.4,
        ..Floor::of(page.robot().expect("a robot"))
    };
    page.set_floor(floor);
    assert_ne!(page.predict(walk), even);
    assert_eq!(page.predict(99), None);
}

#[test]
fn a_written_floor_is_read_back_and_everything_else_stays() {
    let own = |text: &str| Floor::of(&Robot::parse(text).expect("right"));
    let written = |text: &str, floor| {
        let edited = Page::edit_floor(text, floor).expect("it has room");
        assert_eq!(edited.refusal, None);
        edited.text
    };
    assert_eq!(written(PAPER, own(PAPER)), PAPER);
    let floor = Floor {
        friction: 0.55,
        ratio: 1.5,
        mass: 412.0,
        leaf: 2.0,
        twist: -0.6,
        kind: Legs::Strut,
        force: 2.5,
        rate: 0.25,
        play: 0.5,
    };
    let slotted = written(PAPER, floor);
    assert_eq!(own(&slotted), floor);
    let rigid = written(&slotted, own(PAPER));
    assert_eq!(own(&rigid), own(PAPER));
    assert!(!rigid.contains("\nforce ="), "{rigid}");
}

#[test]
fn a_foot_that_is_too_long_is_predicted() {
    let mut page = page();
    let (walk, own) = (index(&page, "walk"), Floor::of(page.robot().expect("one")));
    let mut ahead = |leaf: f64, twist: f64| {
        page.set_floor(Floor { leaf, twist, ..own });
        let movement = page.predict(walk).expect("a gait").movement;
        movement.forward().expect("decided")
    };
    let level = ahead(2.0, 0.0);
    assert!(ahead(3.3, 1.0) < 0.3 * level && ahead(own.leaf, 1.0) > 0.9 * level);
}
