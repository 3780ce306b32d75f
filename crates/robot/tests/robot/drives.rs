//! The drive of a leg: struts that yield in one direction, and play. The expected figures come from a separate
//! implementation of the same model.

use lizard_robot::{Body, Drive, DriveKind, Ground, Report, SpringCost, Walker};

use crate::{STUDIED, cycle_movement, gait, paper, paper_with};

fn ground_with(drive: Drive) -> Ground {
    Ground {
        drive,
        body: STUDIED,
        ..*paper().ground()
    }
}

/// Returns the ground of a robot on slotted struts, with springs of this force (N) and the rate of the paper's coil.
fn strut(force: f64) -> Ground {
    ground_with(Drive {
        kind: DriveKind::Strut(paper().strut_with(force, 0.395)),
        play: 0.0,
    })
}

fn play(play: f64) -> Ground {
    ground_with(Drive {
        play,
        ..Drive::RIGID
    })
}

#[test]
fn gaits_go_as_far_on_weak_struts_as_another_solver_found() {
    for (force, expected) in [(0.5, [34.8, 24.6, 14.3]), (1.0, [35.7, 26.7, 15.2])] {
        for (name, expected) in ["walk", "trot", "left"].into_iter().zip(expected) {
            let moved = cycle_movement(gait(paper(), name), &strut(force));
            assert!((moved - expected).abs() < 0.2, "{force} N {name} {moved}");
        }
    }
}

#[test]
fn from_two_newton_on_a_strut_walks_as_a_bar() {
    for name in ["walk", "trot", "crawl", "left", "arc-left"] {
        let gait = gait(paper(), name);
        let bar = cycle_movement(gait, paper().ground());
        for force in [2.0, 3.0, 5.0] {
            let moved = cycle_movement(gait, &strut(force));
            assert!(
                (moved / bar - 1.0).abs() < 0.005,
                "{force} N {name} {moved}"
            );
        }
        // The spring that docs/build.md recommends suffices for a robot of 400 g, and the strongest one for pads
        // with 1.5 times the friction.
        for (force, friction) in [(3.0, 0.7), (5.0, 1.05)] {
            let heavy = Ground {
                friction,
                body: Body {
                    mass: 400.0,
                    ..Body::DEFAULT
                },
                ..strut(force)
            };
            let moved = cycle_movement(gait, &heavy);
            assert!((moved / bar - 1.0).abs() < 0.01, "{force} N {name} {moved}");
        }
    }
}

#[test]
fn gaits_lose_to_play_what_another_solver_found() {
    for (size, expected) in [(1.0, [33.4, 24.4, 14.1]), (2.0, [31.5, 21.2, 12.8])] {
        for (name, expected) in ["walk", "trot", "left"].into_iter().zip(expected) {
            let walked = gait(paper(), name).simulate_cycle(&play(size));
            let moved = cycle_movement(gait(paper(), name), &play(size));
            assert!((moved - expected).abs() < 0.25, "{size} deg {name} {moved}");
            assert!((walked.lag - size).abs() < 1e-3, "{walked:?}");
        }
    }
}

#[test]
fn a_leg_leaves_its_servo_only_where_its_strut_grows_longer() {
    // The spring is so weak that the front legs lag while their servos turn forward, and the hind legs lag while
    // their servos turn backward.
    let ground = strut(0.5);
    let mut walker = Walker::new(ground, [0.0; 4]);
    for i in 1..=300 {
        let sweep = 20.0 * f64::sin(f64::from(i) / 20.0);
        walker.step([sweep, -sweep, sweep, -sweep]);
        let lag = walker.lag();
        assert!(lag[0] > -1e-6 && lag[1] > -1e-6, "{lag:?}");
        assert!(lag[2] < 1e-6 && lag[3] < 1e-6, "{lag:?}");
    }
}

#[test]
fn a_lever_is_the_arms_part_square_to_the_strut() {
    let robot = paper();
    let strut = robot.strut_with(4.0, 0.0);
    for (leg, plan) in robot.legs().iter().enumerate() {
        for sweep in [-20.0, 0.0, 13.0] {
            let angle = robot.servos()[leg].neutral + lizard_robot::servo::FORWARD[leg] * sweep;
            let length = |lag: f64| {
                let forward = lizard_robot::servo::FORWARD[leg];
                let [from, to] = plan.at(angle, angle - forward * lag).strut;
                (to - from).length()
            };
            let slope = (length(0.001) - length(-0.001)) / 0.002f64.to_radians();
            assert!(
                (strut.lever(leg, sweep) - slope.abs()).abs() < 1e-4,
                "{leg} {slope}"
            );
            let (lag, torque) = strut.slot_end(leg, sweep);
            let lag = lag.copysign(slope);
            assert!(
                (length(lag) - length(0.0) - strut.slot).abs() < 1e-6,
                "{lag}"
            );
            let slope = (length(lag + 0.001) - length(lag - 0.001)) / 0.002f64.to_radians();
            assert!(
                (torque - 4.0 * slope.abs()).abs() < 1e-3,
                "{torque} {slope}"
            );
        }
    }
}

#[test]
fn the_table_of_a_drive_makes_the_ground() {
    let drive = |table: &str| {
        let to = format!("mount = 0.0\ndrive = {{ {table} }}");
        *paper_with("mount = 0.0", &to).expect(table).drive()
    };
    assert_eq!(drive(""), Drive::RIGID);
    assert_eq!(drive("kind = \"rigid\", play = 0.5").play, 0.5);
    let strut = *drive("kind = \"strut\", force = 4, rate = 0.4")
        .strut()
        .expect("a strut");
    assert_eq!(strut, paper().strut_with(4.0, 0.4));
    // Without the keys `force` and `rate`, both follow from the coil spring as it is mounted between its screws.
    let coil = drive("kind = \"strut\"");
    assert_eq!(
        coil.strut(),
        Some(&paper().strut_of(&paper().parts().spring))
    );
    assert!((paper().mounted_spring_length() - 28.5f64.hypot(10.0) - 3.0).abs() < 1e-9);
}

#[test]
fn a_drive_that_is_changed_takes_its_legs_along() {
    let mut walker = Walker::new(strut(0.2), [0.0; 4]);
    (1..=40).for_each(|i| {
        walker.step([0.5 * f64::from(i), 0.0, 0.0, 0.0]);
    });
    assert!(walker.lag()[0] > 5.0, "{:?}", walker.lag());
    walker.set_ground(play(1.5));
    assert!((walker.lag()[0] - 1.5).abs() < 1e-9, "{:?}", walker.lag());
    walker.set_ground(play(0.0));
    assert_eq!(walker.lag(), [0.0; 4]);
}

#[test]
fn the_pull_that_is_needed_grows_with_mass_and_friction() {
    let walked = |mass: f64, friction: f64, pull: f64| {
        let ground = Ground {
            body: Body {
                mass,
                ..Body::DEFAULT
            },
            friction,
            drive: Drive {
                kind: DriveKind::Strut(paper().strut_with(pull, 0.4 * pull)),
                play: 0.0,
            },
            ..*paper().ground()
        };
        gait(paper(), "walk").simulate_cycle(&ground)
    };
    let (one, two) = (walked(280.0, 0.7, 0.5), walked(420.0, 1.4, 1.5));
    assert!(one.lag > 3.0 && (one.lag - two.lag).abs() < 1e-6);
    assert!((one.travel.forward - two.travel.forward).abs() < 1e-6);
}

#[test]
fn pads_that_hold_less_let_a_leg_go_and_a_still_one_stays() {
    let walk = gait(paper(), "walk");
    let mut walker = Walker::new(strut(0.5), walk.sweeps(0.0));
    for i in 1..=90 {
        walker.step(walk.sweeps(f64::from(i) / 100.0));
    }
    let (lag, legs) = (walker.lag(), walk.sweeps(0.9));
    assert!(lag.iter().any(|lag| lag.abs() > 2.0), "{lag:?}");
    walker.step(legs);
    for (now, before) in walker.lag().into_iter().zip(lag) {
        assert!(
            (now - before).abs() < 1e-6,
            "no servo turns, so no lag changes"
        );
    }
    walker.set_ground(Ground {
        friction: 0.07,
        ..strut(0.5)
    });
    walker.step(legs);
    for lag in walker.lag() {
        assert!(lag.abs() < 0.5, "{lag}");
    }
    walker.set_ground(*paper().ground());
    assert_eq!(walker.lag(), [0.0; 4]);
}

#[test]
fn a_report_has_the_lag_of_the_legs_and_the_share_of_rigid_ones() {
    assert_eq!(
        SpringCost::of(gait(paper(), "walk"), paper().ground()),
        None
    );
    let of = |name| SpringCost::of(gait(paper(), name), &strut(0.5)).expect("it lags");
    let share = |name| of(name).share.expect(name);
    assert!((share("trot") - 24.6 / 26.7).abs() < 0.01);
    assert!((share("left") - 14.3 / 15.3).abs() < 0.01);
    assert_eq!((of("stand").share, of("look").share), (None, None));

    let drive = "mount = 0.0\ndrive = { kind = \"strut\", force = 0.5, rate = 0.395 }";
    let robot = paper_with("mount = 0.0", drive).expect("a strut");
    let report = Report::of(&robot).to_string();
    let trot = report.lines().find(|line| line.starts_with("trot"));
    let on = SpringCost::of(gait(&robot, "trot"), robot.ground()).expect("it lags");
    let share = format!("{:.0}", 100.0 * on.share.expect("trot"));
    assert!(trot.expect("trot").ends_with(&share), "{report}");
    assert!(report.contains("lag  of rigid"));
}

#[test]
fn mass_and_friction_are_read_from_the_file() {
    let ground = |from: &str, to: &str| *paper_with(from, to).expect("a body").ground();
    let heavy = ground("mass = 435.0 ", "mass = 310\ncentre = [5.0, -2.0] ");
    assert_eq!((heavy.body.mass, heavy.body.centre), (310.0, [5.0, -2.0]));
    assert!((heavy.grip() - 0.7 * 0.31 * 9.80665 / 4.0).abs() < 1e-12);
    let smooth = ground("[ground]", "[ground]\nfriction = 0.5");
    assert!((smooth.grip() - 0.5 * 0.435 * 9.80665 / 4.0).abs() < 1e-12);
}
