//! Tests that compare the contact model with the physics engine rapier: at two friction coefficients, with legs mounted
//! outward, and for a tuned gait.
//!
//! The engine, rapier 0.36, computed the displacements without the model, for a chassis with inertia and four balls
//! dragged over the floor. rapier is no longer a dependency; its results are reference values that reveal a regression
//! of the model. Gaits that depend on inertia were simulated at a slower pace.

use lizard_physics::{Displacement, load_robot};
use lizard_robot::{Body, GroundContact, LegGeometry};

/// The compared gaits; no gait mirrors or reverses another.
const GAITS: [&str; 5] = ["walk", "trot", "crawl", "left", "arc-left"];

/// Each gait's displacement in one cycle: mm forward, mm to the left, deg counter-clockwise.
type Displacements = [[f64; 3]; 5];

/// Returns the ground of the paper's robot with a body of 280 g.
fn ground_with_280_g() -> GroundContact {
    GroundContact {
        body: Body {
            mass: 280.0,
            ..Body::DEFAULT
        },
        ..*load_robot("paper").ground()
    }
}

/// Asserts that each gait's displacement in the model differs from `expected` by at most `max_mm` and `max_deg`.
fn assert_agreement(ground: &GroundContact, expected: &Displacements, max_mm: f64, max_deg: f64) {
    let paper = load_robot("paper");
    for (name, displacement) in GAITS.into_iter().zip(expected) {
        let gait = paper.gait(name).expect("the robot has this gait");
        let model_displacement = Displacement::from(gait.simulate_cycle(ground).travel);
        let (distance, turn) = model_displacement.compute_difference(Displacement(*displacement));
        assert!(
            distance <= max_mm && turn <= max_deg,
            "{name}: engine {displacement:?}, model {model_displacement:?}, drive {:?}",
            ground.drive
        );
    }
}

#[test]
fn rigid_legs_match_the_engine_on_a_slippery_and_on_a_rough_floor() {
    for (friction, displacements) in [(0.4, SLIPPERY_FLOOR), (1.0, ROUGH_FLOOR)] {
        let ground = GroundContact {
            friction_coefficient: friction,
            ..ground_with_280_g()
        };
        assert_agreement(&ground, &displacements, 0.5, 0.3);
    }
}

#[test]
fn legs_mounted_outward_match_the_engine() {
    let ground = ground_with_280_g();
    let legs = LegGeometry {
        mount_angle: 45.0,
        ..ground.legs
    };
    let ground = GroundContact { legs, ..ground };
    assert_agreement(&ground, &MOUNTED_OUTWARD, 0.5, 0.3);
}

#[test]
fn the_tuned_gait_matches_rapier_and_is_faster_than_walk_in_mujoco() {
    let (paper, tuned) = (load_robot("paper"), load_robot("own-gaits"));
    let stride = tuned.gait("stride").expect("own-gaits.toml has this gait");
    let walk = paper.gait("walk").expect("paper.toml has this gait");
    let model_displacement = Displacement::from(stride.simulate_cycle(&ground_with_280_g()).travel);
    let (distance, turn) = model_displacement.compute_difference(Displacement([40.95, -0.44, 0.0]));
    assert!(distance <= 0.5 && turn <= 0.3, "{model_displacement:?}");
    let stored = lizard_physics::WalkResults::load_stored();
    let compute_speed = |robot: &str, gait: &str, period: f64| {
        let level_case = lizard_physics::Case::ALL[0];
        stored.get(robot, gait, level_case).expect(gait).mujoco.0[0] / period
    };
    let walk_speed = compute_speed("paper", "walk", walk.period());
    let stride_speed = compute_speed("own-gaits", "stride", stride.period());
    let is_faster = stride_speed > 1.25 * walk_speed;
    let speeds = format!("walk {walk_speed:.1} mm/s, stride {stride_speed:.1} mm/s");
    assert!(is_faster, "{speeds}");
}

/// The engine's displacements on rigid legs at a friction of 0.4.
const SLIPPERY_FLOOR: Displacements = [
    [34.58, -0.02, 0.0],
    [26.64, -0.08, 0.0],
    [30.63, 0.02, 0.02],
    [-0.02, 0.01, 15.22],
    [17.68, 0.83, 5.26],
];

/// The engine's displacements on rigid legs at a friction of 1.0.
const ROUGH_FLOOR: Displacements = [
    [34.46, -0.02, 0.0],
    [26.66, -0.08, 0.0],
    [30.63, 0.07, 0.0],
    [-0.02, 0.01, 15.25],
    [17.67, 0.84, 5.24],
];

/// The engine's displacements on rigid legs mounted 45 deg outward, at half the pace.
const MOUNTED_OUTWARD: Displacements = [
    [5.57, 0.0, 0.0],
    [12.87, 0.27, 0.0],
    [22.81, -0.06, 0.01],
    [-0.01, 0.01, 16.27],
    [3.41, 0.37, 6.97],
];
