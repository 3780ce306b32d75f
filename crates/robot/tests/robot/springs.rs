//! Legs that springs pull along: figures of a separate implementation of the same
//! model, and consequences that hold exactly.

use lizard_robot::{Body, Drive, Ground, Sprung, Walker};

use crate::{gait, paper, paper_with};

/// The mass for which the other implementation was asked, g.
const STUDIED: Body = Body {
    mass: 280.0,
    ..Body::DEFAULT
};

/// The paper's robot, 280 g, on a friction of 0.7 and springs of this rate.
fn springs(rate: f64) -> Ground {
    Ground {
        drive: Drive::spring(rate, 0.0),
        body: STUDIED,
        ..*paper().ground()
    }
}

#[test]
fn walk_and_left_go_as_far_as_their_springs_let_them() {
    for (rate, forward, turn) in [
        (2.0, 17.6, 6.6),
        (5.0, 30.0, 11.9),
        (10.0, 33.1, 13.6),
        (20.0, 33.8, 14.5),
    ] {
        let walk = gait(paper(), "walk").walked(&springs(rate));
        let left = gait(paper(), "left").walked(&springs(rate));
        assert!((walk.travel.forward - forward).abs() < 0.1, "{walk:?}");
        assert!((left.travel.turn - turn).abs() < 0.1, "{left:?}");
        // A foot that is dragged lags by its friction at the length of its leg.
        assert!((walk.lag - 21.6 / rate).abs() < 0.05 * walk.lag, "{walk:?}");
    }
}

#[test]
fn trot_needs_one_and_a_half_newton_millimetres_per_degree() {
    let forward = |rate| gait(paper(), "trot").walked(&springs(rate)).travel.forward;
    let ways = [1.4, 1.5, 1.6].map(forward);
    assert!(
        ways[0].abs() < 0.3 && ways[1] < 0.6 && (1.0..2.0).contains(&ways[2]),
        "{ways:?}"
    );
}

#[test]
fn the_stiffness_that_is_needed_grows_with_mass_and_friction() {
    let way = |mass: f64, friction: f64, rate: f64| {
        let ground = Ground {
            body: Body {
                mass,
                ..Body::DEFAULT
            },
            friction,
            ..springs(rate)
        };
        gait(paper(), "walk").walked(&ground)
    };
    let (one, two) = (way(280.0, 0.7, 5.0), way(420.0, 1.4, 15.0));
    assert!((one.travel.forward - two.travel.forward).abs() < 1e-6);
    assert!((one.lag - two.lag).abs() < 1e-6);
}

#[test]
fn stiff_springs_are_rigid_legs() {
    for name in ["walk", "trot", "crawl", "back", "left", "arc-left"] {
        let rigid = gait(paper(), name).walked(paper().ground()).travel;
        let stiff = gait(paper(), name).walked(&springs(10_000.0)).travel;
        let off = (rigid.forward - stiff.forward).hypot(rigid.left - stiff.left);
        assert!(
            off < 0.06 && (rigid.turn - stiff.turn).abs() < 0.01,
            "{name} {rigid:?} {stiff:?}"
        );
    }
}

#[test]
fn a_leg_is_rigid_up_to_its_springs_preload() {
    let on = |preload: f64| {
        let ground = Ground {
            drive: Drive::spring(2.0, preload),
            ..springs(2.0)
        };
        gait(paper(), "walk").walked(&ground)
    };
    let rigid = gait(paper(), "walk").walked(paper().ground());
    // The pads' friction at the leg is 22 N mm, 24 where they carry most.
    let held = on(26.0);
    assert!(held.lag < 1e-3, "{held:?}");
    assert!((held.travel.forward - rigid.travel.forward).abs() < 0.06);
    let yields = on(10.0);
    assert!((yields.lag - (21.6 - 10.0) / 2.0).abs() < 0.6, "{yields:?}");
    assert!(yields.travel.forward < 30.0);
}

#[test]
fn no_leg_is_held_back_further_than_its_pad_can() {
    let robot = paper();
    let ground = springs(3.0);
    let crawl = gait(robot, "crawl");
    let mut walker = Walker::new(ground, crawl.sweeps(0.0));
    for i in 1..=500 {
        walker.step(crawl.sweeps(f64::from(i) / 250.0));
        let loads = ground.loads(ground.feet.at(walker.legs()));
        for (lag, load) in walker.lag().into_iter().zip(loads) {
            let most = ground.grip() * load * ground.feet.reach / 3.0;
            assert!(lag.abs() < most + 0.02, "{lag} {most}");
        }
    }
}

#[test]
fn pads_that_hold_less_let_a_leg_go_and_a_still_one_stays() {
    let walk = gait(paper(), "walk");
    let mut walker = Walker::new(springs(5.0), walk.sweeps(0.0));
    for i in 1..=100 {
        walker.step(walk.sweeps(f64::from(i) / 100.0));
    }
    let (lag, legs) = (walker.lag(), walk.sweeps(1.0));
    walker.step(legs);
    for (now, before) in walker.lag().into_iter().zip(lag) {
        assert!(
            (now - before).abs() < 1e-6,
            "nothing moves, so nothing lags"
        );
    }
    walker.set_ground(Ground {
        friction: 0.07,
        ..springs(5.0)
    });
    walker.step(legs);
    for lag in walker.lag() {
        assert!(lag.abs() < 0.5, "{lag}");
    }
    walker.set_ground(*paper().ground());
    assert_eq!(walker.lag(), [0.0; 4]);
}

#[test]
fn a_report_says_how_far_legs_lag_and_what_is_left() {
    assert_eq!(Sprung::of(gait(paper(), "walk"), paper().ground()), None);
    let of = |name| Sprung::of(gait(paper(), name), &springs(5.0)).expect("springs");
    let share = |name| of(name).share.expect(name);
    assert!((share("walk") - 30.0 / 34.2).abs() < 0.01);
    assert!((share("left") - 11.9 / 15.3).abs() < 0.01);
    assert_eq!((of("stand").share, of("look").share), (None, None));

    let robot = paper_with(
        "mount = 0.0",
        "mount = 0.0\ndrive = { kind = \"spring\", stiffness = 5.0 }",
    )
    .expect("a spring");
    let heavier = Ground {
        body: paper().ground().body,
        ..springs(5.0)
    };
    assert_eq!(robot.ground(), &heavier);
    let report = lizard_robot::Report::of(&robot).to_string();
    let walk = report.lines().find(|line| line.starts_with("walk"));
    let on = Sprung::of(gait(&robot, "walk"), &heavier).expect("springs");
    let left = format!("{:.0}", 100.0 * on.share.expect("walk"));
    assert!(walk.expect("walk").ends_with(&left), "{report}");
    assert!(report.contains("lag  of rigid"));
}

#[test]
fn what_stands_on_the_feet_can_be_told() {
    let ground = |from: &str, to: &str| *paper_with(from, to).expect("a body").ground();
    let heavy = ground("mass = 396.4 ", "mass = 310\ncentre = [5.0, -2.0] ");
    assert_eq!((heavy.body.mass, heavy.body.centre), (310.0, [5.0, -2.0]));
    assert!((heavy.grip() - 0.7 * 0.31 * 9.80665 / 4.0).abs() < 1e-12);
    let smooth = ground("[ground]", "[ground]\nfriction = 0.5");
    assert!((smooth.grip() - 0.5 * 0.3964 * 9.80665 / 4.0).abs() < 1e-12);
}
