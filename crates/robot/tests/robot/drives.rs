//! The drive of a leg: struts that yield in one direction, and play. The expected values come from a separate
//! implementation of the same model.

use lizard_robot::{Body, Drive, DriveEffect, DriveKind, GroundContact, Report, Walker};

use crate::{REFERENCE_BODY, assert_near, gait, paper, paper_with, simulate_movement};

/// Returns the paper's ground with this drive and the reference body.
fn ground_with(drive: Drive) -> GroundContact {
    GroundContact {
        drive,
        body: REFERENCE_BODY,
        ..*paper().ground()
    }
}

/// Returns the ground of a robot on slotted struts, with springs of this force (N) and the rate of the paper's coil.
fn ground_with_strut(force: f64) -> GroundContact {
    ground_with(Drive {
        kind: DriveKind::Strut(paper().strut_with_spring(force, 0.395)),
        play: 0.0,
    })
}

/// Returns the ground of a robot whose legs have this play (deg).
fn ground_with_play(play: f64) -> GroundContact {
    ground_with(Drive {
        play,
        ..Drive::RIGID
    })
}

#[test]
fn gaits_with_weak_struts_match_a_separate_solver() {
    for (force, expected) in [(0.5, [34.8, 24.6, 14.3]), (1.0, [35.7, 26.7, 15.2])] {
        for (name, expected) in ["walk", "trot", "left"].into_iter().zip(expected) {
            let movement = simulate_movement(gait(paper(), name), &ground_with_strut(force));
            assert_near(&format!("{name} at {force} N"), movement, expected, 0.2);
        }
    }
}

#[test]
fn struts_with_at_least_two_newtons_act_like_rigid_links() {
    for name in ["walk", "trot", "crawl", "left", "arc-left"] {
        let gait = gait(paper(), name);
        let rigid_movement = simulate_movement(gait, paper().ground());
        for force in [2.0, 3.0, 5.0] {
            let ratio = simulate_movement(gait, &ground_with_strut(force)) / rigid_movement;
            assert_near(&format!("{name} at {force} N"), ratio, 1.0, 0.005);
        }
        // docs/build.md recommends springs of 3 to 5 N. For a robot of 400 g, 3 N is enough, and 5 N is enough even for
        // pads with 1.5 times the friction.
        for (force, friction) in [(3.0, 0.7), (5.0, 1.05)] {
            let heavy_ground = GroundContact {
                friction_coefficient: friction,
                body: Body {
                    mass: 400.0,
                    ..Body::DEFAULT
                },
                ..ground_with_strut(force)
            };
            let ratio = simulate_movement(gait, &heavy_ground) / rigid_movement;
            assert_near(&format!("{name} at {force} N"), ratio, 1.0, 0.01);
        }
    }
}

#[test]
fn gaits_with_play_match_a_separate_solver() {
    for (play_deg, expected) in [(1.0, [33.4, 24.4, 14.1]), (2.0, [31.5, 21.2, 12.8])] {
        for (name, expected) in ["walk", "trot", "left"].into_iter().zip(expected) {
            let gait = gait(paper(), name);
            let ground = ground_with_play(play_deg);
            let label = format!("{name} with {play_deg} deg of play");
            assert_near(&label, simulate_movement(gait, &ground), expected, 0.25);
            assert_near(&label, gait.simulate_cycle(&ground).max_lag, play_deg, 1e-3);
        }
    }
}

#[test]
fn a_leg_lags_only_in_the_direction_that_lengthens_its_strut() {
    // The spring is so weak that the front legs lag while their servos turn forward, and the hind legs lag while
    // their servos turn backward.
    let ground = ground_with_strut(0.5);
    let mut walker = Walker::new(ground, [0.0; 4]);
    for i in 1..=300 {
        let sweep = 20.0 * f64::sin(f64::from(i) / 20.0);
        walker.move_to([sweep, -sweep, sweep, -sweep]);
        let lags = walker.lags();
        assert!(lags[0] > -1e-6 && lags[1] > -1e-6, "{lags:?}");
        assert!(lags[2] < 1e-6 && lags[3] < 1e-6, "{lags:?}");
    }
}

#[test]
fn a_struts_lever_arm_is_the_derivative_of_its_length() {
    let robot = paper();
    let strut = robot.strut_with_spring(4.0, 0.0);
    for (leg, plan) in robot.legs().iter().enumerate() {
        for sweep in [-20.0, 0.0, 13.0] {
            let forward_sign = lizard_robot::servo::FORWARD_TURN_SIGN[leg];
            let angle = robot.servos()[leg].neutral + forward_sign * sweep;
            let length_at = |lag: f64| {
                let [servo_anchor, leg_anchor] = plan
                    .points_at(angle, angle - forward_sign * lag)
                    .strut_anchors;
                (leg_anchor - servo_anchor).length()
            };
            let slope = (length_at(0.001) - length_at(-0.001)) / 0.002f64.to_radians();
            let label = format!("leg {leg} at {sweep} deg");
            assert_near(&label, strut.lever_arm(leg, sweep), slope.abs(), 1e-4);
            let (lag, torque) = strut.lag_and_torque_at_slot_end(leg, sweep);
            let lag = lag.copysign(slope);
            let extension = length_at(lag) - length_at(0.0);
            assert_near(&label, extension, strut.slot_length, 1e-6);
            let slope = (length_at(lag + 0.001) - length_at(lag - 0.001)) / 0.002f64.to_radians();
            assert_near(&label, torque, 4.0 * slope.abs(), 1e-3);
        }
    }
}

#[test]
fn the_drive_is_read_from_its_table() {
    let read_drive = |table: &str| {
        let replacement = format!("mount = 0.0\ndrive = {{ {table} }}");
        *paper_with("mount = 0.0", &replacement)
            .expect(table)
            .drive()
    };
    assert_eq!(read_drive(""), Drive::RIGID);
    assert_eq!(read_drive("kind = \"rigid\", play = 0.5").play, 0.5);
    let strut = *read_drive("kind = \"strut\", force = 4, rate = 0.4")
        .strut()
        .expect("the drive has a strut");
    assert_eq!(strut, paper().strut_with_spring(4.0, 0.4));
    // Without the keys `force` and `rate`, both follow from the coil spring as it is mounted between its screws.
    let default_drive = read_drive("kind = \"strut\"");
    assert_eq!(default_drive.strut(), Some(&paper().own_strut()));
    assert!((paper().mounted_spring_length() - 28.5f64.hypot(10.0) - 3.0).abs() < 1e-9);
}

#[test]
fn a_stiffer_drive_reduces_the_lag_of_a_leg() {
    let mut walker = Walker::new(ground_with_strut(0.2), [0.0; 4]);
    (1..=40).for_each(|i| {
        walker.move_to([0.5 * f64::from(i), 0.0, 0.0, 0.0]);
    });
    assert!(walker.lags()[0] > 5.0, "{:?}", walker.lags());
    walker.set_ground(ground_with_play(1.5));
    assert!((walker.lags()[0] - 1.5).abs() < 1e-9, "{:?}", walker.lags());
    walker.set_ground(ground_with_play(0.0));
    assert_eq!(walker.lags(), [0.0; 4]);
}

#[test]
fn a_walk_depends_only_on_the_spring_force_divided_by_mass_and_friction() {
    let walk_cycle = |mass: f64, friction: f64, force: f64| {
        let ground = GroundContact {
            body: Body {
                mass,
                ..Body::DEFAULT
            },
            friction_coefficient: friction,
            drive: Drive {
                kind: DriveKind::Strut(paper().strut_with_spring(force, 0.4 * force)),
                play: 0.0,
            },
            ..*paper().ground()
        };
        gait(paper(), "walk").simulate_cycle(&ground)
    };
    let (light_cycle, heavy_cycle) = (walk_cycle(280.0, 0.7, 0.5), walk_cycle(420.0, 1.4, 1.5));
    assert!(light_cycle.max_lag > 3.0 && (light_cycle.max_lag - heavy_cycle.max_lag).abs() < 1e-6);
    assert!((light_cycle.travel.forward - heavy_cycle.travel.forward).abs() < 1e-6);
}

#[test]
fn a_lag_stays_constant_while_no_servo_turns_and_falls_with_friction() {
    let walk = gait(paper(), "walk");
    let mut walker = Walker::new(ground_with_strut(0.5), walk.sweeps(0.0));
    for i in 1..=90 {
        walker.move_to(walk.sweeps(f64::from(i) / 100.0));
    }
    let lags = walker.lags();
    let sweeps = walk.sweeps(0.9);
    assert!(lags.iter().any(|lag| lag.abs() > 2.0), "{lags:?}");
    walker.move_to(sweeps);
    for (new_lag, old_lag) in walker.lags().into_iter().zip(lags) {
        let label = "no servo turns, so no lag changes";
        assert_near(label, new_lag, old_lag, 1e-6);
    }
    walker.set_ground(GroundContact {
        friction_coefficient: 0.07,
        ..ground_with_strut(0.5)
    });
    walker.move_to(sweeps);
    for lag in walker.lags() {
        assert!(lag.abs() < 0.5, "the lag is {lag} deg");
    }
    walker.set_ground(*paper().ground());
    assert_eq!(walker.lags(), [0.0; 4]);
}

#[test]
fn a_report_shows_the_displacement_relative_to_rigid_legs() {
    let rigid_effect = DriveEffect::compute(gait(paper(), "walk"), paper().ground());
    assert_eq!(rigid_effect, None);
    let compute_effect = |name| {
        DriveEffect::compute(gait(paper(), name), &ground_with_strut(0.5)).expect("the legs lag")
    };
    let compute_fraction = |name| compute_effect(name).fraction_of_rigid.expect(name);
    assert!((compute_fraction("trot") - 24.6 / 26.7).abs() < 0.01);
    assert!((compute_fraction("left") - 14.3 / 15.3).abs() < 0.01);
    let fractions = ["stand", "look"].map(|name| compute_effect(name).fraction_of_rigid);
    assert_eq!(fractions, [None, None]);

    let drive = "mount = 0.0\ndrive = { kind = \"strut\", force = 0.5, rate = 0.395 }";
    let robot = paper_with("mount = 0.0", drive).expect("the robot is valid");
    let report = Report::compute(&robot).to_string();
    let trot = report.lines().find(|line| line.starts_with("trot"));
    let effect = DriveEffect::compute(gait(&robot, "trot"), robot.ground()).expect("the legs lag");
    let fraction = effect.fraction_of_rigid.expect("trot moves the robot");
    let trot = trot.expect("the report has the gait trot");
    let percent_text = format!("{:.0}", 100.0 * fraction);
    assert!(trot.ends_with(&percent_text), "{report}");
    assert!(report.contains("lag % of rigid"));
}

#[test]
fn mass_and_friction_are_read_from_the_file() {
    let read_ground =
        |old: &str, new: &str| *paper_with(old, new).expect("the robot is valid").ground();
    let heavy_ground = read_ground("mass = 435.0 ", "mass = 310\ncentre = [5.0, -2.0] ");
    assert_eq!(heavy_ground.body.mass, 310.0);
    assert_eq!(heavy_ground.body.centre_of_mass, [5.0, -2.0]);
    assert!((heavy_ground.mean_friction_force() - 0.7 * 0.31 * 9.80665 / 4.0).abs() < 1e-12);
    let smooth_ground = read_ground("[ground]", "[ground]\nfriction = 0.5");
    assert!((smooth_ground.mean_friction_force() - 0.5 * 0.435 * 9.80665 / 4.0).abs() < 1e-12);
}
