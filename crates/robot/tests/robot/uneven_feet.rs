//! The loads of the four feet, which statics alone does not determine, and the loss of distance with a foot that is too
//! long.

use lizard_robot::{Body, GroundContact, Stance, Walker};

use crate::{REFERENCE_BODY, gait, paper, paper_with, simulate_movement};

/// The gaits that move the paper's robot.
const MOVING_GAITS: [&str; 8] = [
    "walk",
    "trot",
    "crawl",
    "back",
    "left",
    "right",
    "arc-left",
    "arc-right",
];

/// Returns the paper's ground with feet of this stiffness (N/mm), and the front left foot too long by `twist` (mm).
fn ground_with(stiffness: f64, twist: f64) -> GroundContact {
    GroundContact {
        stance: Stance {
            stiffness,
            twist,
            ..Stance::DEFAULT
        },
        body: REFERENCE_BODY,
        ..*paper().ground()
    }
}

#[test]
fn the_loss_with_an_overloaded_diagonal_matches_a_separate_solver() {
    // The expected values come from a separate implementation, in which the feet of one diagonal always carry four
    // tenths more load, and the other two feet carry four tenths less.
    for (name, expected) in [
        ("walk", 24.8),
        ("crawl", 17.4),
        ("left", 9.0),
        ("trot", 17.6),
    ] {
        let gait = gait(paper(), name);
        let sweeps_at = |i: i32| gait.sweeps(gait.phase_at(gait.period() * f64::from(i) / 1000.0));
        let ground = *paper().ground();
        let mut walker = Walker::with_unevenness(ground, sweeps_at(0), [1.4, 0.6, 1.4, 0.6], 1.0);
        (1..=1000).for_each(|i| {
            walker.move_to(sweeps_at(i));
        });
        let travel = walker.body_pose().travel();
        let movement = match name {
            "left" => travel.turn,
            _ => travel.forward,
        };
        assert!((movement - expected).abs() < 0.45, "{name}: {movement}");
    }
}

#[test]
fn with_soft_feet_a_foot_1_mm_too_long_costs_less_than_three_percent() {
    let Stance {
        stiffness, twist, ..
    } = paper().ground().stance;
    assert_eq!((stiffness, twist), (0.5, 0.0));
    for name in MOVING_GAITS {
        let gait = gait(paper(), name);
        let level_movement = simulate_movement(gait, paper().ground());
        for twist in [1.0, -1.0] {
            let ratio = simulate_movement(gait, &ground_with(stiffness, twist)) / level_movement;
            assert!(
                (0.97..1.03).contains(&ratio),
                "{name}, twist {twist} mm: the ratio is {ratio}"
            );
        }
    }
}

#[test]
fn with_stiff_feet_a_foot_0_6_mm_too_long_costs_at_least_three_quarters() {
    let compute_ratio = |name: &str| {
        let gait = gait(paper(), name);
        simulate_movement(gait, &ground_with(3.3, 0.6)) / simulate_movement(gait, paper().ground())
    };
    for (name, max_ratio) in [("walk", 0.25), ("crawl", 0.15), ("left", 0.25)] {
        assert!(compute_ratio(name) < max_ratio, "{name}");
    }
    // Feet can be adjusted to a fifth of a millimetre; an error of this size is negligible.
    let gait = gait(paper(), "walk");
    assert!(simulate_movement(gait, &ground_with(3.3, 0.2)) > 33.5);
}

#[test]
fn the_loss_depends_only_on_stiffness_times_excess_length_divided_by_weight() {
    let gait = gait(paper(), "walk");
    let movement_on = |ground: &GroundContact| simulate_movement(gait, ground);
    let movement = movement_on(&ground_with(2.0, 0.6));
    assert!((movement_on(&ground_with(0.5, 2.4)) - movement).abs() < 1e-6);
    let heavy_ground = GroundContact {
        body: Body {
            mass: 614.0,
            ..Body::DEFAULT
        },
        ..ground_with(2.0, 1.2)
    };
    assert!((movement_on(&heavy_ground) - movement).abs() < 1e-6);
    // If all feet are level and equally stiff, their stiffness does not matter.
    let level_movement = movement_on(paper().ground());
    assert_eq!(movement_on(&ground_with(50.0, 0.0)), level_movement);
}

#[test]
fn stiffness_and_twist_are_read_from_the_file() {
    let robot = paper_with("[body]", "[feet]\nstiffness = 2.0\ntwist = -0.6\n[body]");
    let stance = robot.expect("the robot is valid").ground().stance;
    assert_eq!((stance.stiffness, stance.twist), (2.0, -0.6));
    assert_eq!(stance.twist_error, Stance::DEFAULT.twist_error);
}
