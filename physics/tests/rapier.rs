//! The contact model against rapier, on springs, at other frictions, on legs mounted outward.
//!
//! The model is quasi-static, the engine is not: where a gait leans on inertia, it is
//! played slower. Gaits that are another one reversed or mirrored are played at one
//! friction only. `look` depends on ties and is left out, as is `stand`.

use std::sync::LazyLock;

use lizard_physics::rapier::{Setup, Yaw, walked};
use lizard_robot::{Body, Drive, Feet, Ground, Robot, Travel};

fn paper() -> &'static Robot {
    static ROBOT: LazyLock<Robot> = LazyLock::new(|| {
        Robot::parse(include_str!("../../robots/paper.toml")).expect("paper.toml is right")
    });
    &ROBOT
}

/// The paper's robot of 280 g, two ninths of which are in the feet.
fn ground() -> Ground {
    Ground {
        body: Body {
            mass: 280.0,
            ..Body::DEFAULT
        },
        ..*paper().ground()
    }
}

/// The gaits that no other one gives by symmetry.
const KINDS: [&str; 5] = ["walk", "trot", "crawl", "left", "arc-left"];

/// The paper's lengths, with the gait that `lizard tune` has found for them.
fn tuned() -> Robot {
    Robot::parse(include_str!("../../robots/own-gaits.toml")).expect("own-gaits.toml is right")
}

/// A cycle of a gait by the engine, at a share of its pace.
fn engine(robot: &Robot, name: &str, ground: &Ground, yaw: Yaw, pace: f64) -> Travel {
    let setup = Setup {
        feet: ground.feet,
        mass: ground.body.mass,
        friction: ground.friction,
        yaw,
        pace,
        stiffness: 2.0,
        long: 0.0,
        strut: None,
    };
    walked(robot.gait(name).expect(name), &setup)
}

/// Asserts that engine and model differ by no more than this, and returns what the
/// engine says.
fn agree(name: &str, ground: &Ground, yaw: Yaw, pace: f64, mm: f64, deg: f64) -> Travel {
    agree_of(paper(), name, ground, yaw, pace, mm, deg)
}

fn agree_of(
    robot: &Robot,
    name: &str,
    ground: &Ground,
    yaw: Yaw,
    pace: f64,
    mm: f64,
    deg: f64,
) -> Travel {
    let theirs = engine(robot, name, ground, yaw, pace);
    let ours = robot.gait(name).expect(name).walked(ground).travel;
    let off = (theirs.forward - ours.forward).hypot(theirs.left - ours.left);
    println!(
        "{name} {theirs:?} off {off:.2} mm, {:.2} deg",
        theirs.turn - ours.turn
    );
    assert!(
        off <= mm && (theirs.turn - ours.turn).abs() <= deg,
        "{name} goes {theirs:?} by the engine, {ours:?} by the model, with {:?}",
        ground.drive
    );
    theirs
}

#[test]
fn rigid_legs_on_a_slippery_floor_go_where_the_engine_goes() {
    let ground = Ground {
        friction: 0.4,
        ..ground()
    };
    for name in KINDS {
        agree(name, &ground, Yaw::RIGID, 1.0, 0.5, 0.3);
    }
}

#[test]
fn rigid_legs_on_a_rough_floor_go_where_the_engine_goes() {
    let ground = Ground {
        friction: 1.0,
        ..ground()
    };
    for name in KINDS {
        agree(name, &ground, Yaw::RIGID, 1.0, 0.5, 0.3);
    }
}

fn springs(rate: f64) {
    let ground = Ground {
        drive: Drive::spring(rate, 0.0),
        ..ground()
    };
    for name in KINDS {
        agree(name, &ground, Yaw::spring(rate), 0.25, 1.0, 0.3);
    }
}

#[test]
fn soft_springs_lag_as_in_the_engine() {
    springs(2.0);
}

#[test]
fn springs_lag_as_in_the_engine() {
    springs(5.0);
}

#[test]
fn hard_springs_lag_as_in_the_engine() {
    springs(10.0);
}

#[test]
fn legs_mounted_outward_lose_what_they_lose_in_the_engine() {
    let ground = ground();
    let ground = Ground {
        feet: Feet {
            mount: 45.0,
            ..ground.feet
        },
        ..ground
    };
    for name in KINDS {
        agree(name, &ground, Yaw::RIGID, 0.5, 0.5, 0.3);
    }
}

#[test]
fn the_engine_gives_the_same_bits_twice() {
    let once = || engine(paper(), "arc-left", &ground(), Yaw::RIGID, 1.0);
    assert_eq!(once(), once());
}

#[test]
fn the_tuned_gait_is_faster_than_walk_in_the_engine_too() {
    let (robot, ground) = (tuned(), ground());
    agree_of(&robot, "stride", &ground, Yaw::RIGID, 0.5, 0.5, 0.3);
    let speed = |robot: &Robot, name: &str| {
        let way = engine(robot, name, &ground, Yaw::RIGID, 1.0);
        way.forward / robot.gait(name).expect(name).period()
    };
    let predicted = |robot: &Robot, name: &str| {
        let gait = robot.gait(name).expect(name);
        gait.walked(&ground).travel.forward / gait.period()
    };
    assert!(predicted(&robot, "stride") > 1.3 * predicted(paper(), "walk"));
    // At its full pace inertia takes 1 mm in 41.
    let (walk, stride) = (speed(paper(), "walk"), speed(&robot, "stride"));
    println!("walk {walk:.1} mm/s, stride {stride:.1} mm/s");
    assert!(
        stride > 1.25 * walk,
        "walk {walk:.1} mm/s, stride {stride:.1}"
    );
}
