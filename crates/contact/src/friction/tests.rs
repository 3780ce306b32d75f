//! The minimum cost, checked against the lower bound of the dual problem for random pads and springs.

use super::*;
use crate::assert_near;
use proptest::prelude::*;

use crate::lag_energy::{Resistance, StrutTriangle};

/// Torque of a stop, larger than any pad can exert on a 45 mm leg.
const STOP_TORQUE: f64 = 250.0;
const PAD_POSITIONS: [Point; 4] = [[55.0, 80.0], [55.0, -80.0], [-55.0, -80.0], [-55.0, 80.0]];

/// Creates pads with equal loads and the same friction in all directions, on rigid legs.
fn rigid_leg_pads(positions: [Point; 4], swings: [Point; 4]) -> Pads {
    Pads {
        positions,
        swings,
        friction_ratio: 1.0,
        loads: [1.0; 4],
        compliance: None,
        inertia: None,
    }
}

/// Computes the length of a slide, with its components weighted.
fn weighted_length(pads: &Pads, slide: Point) -> f64 {
    let weights = pads.slide_weights(slide);
    (weights[0] * slide[0]).hypot(weights[1] * slide[1])
}

/// Computes the sum of the friction's work and the springs' energy.
fn compute_cost(pads: &Pads, displacement: &Displacement) -> f64 {
    let slides = pads.slides(displacement).into_iter().zip(pads.loads);
    let friction = slides.map(|(slide, load)| load * weighted_length(pads, slide));
    let spring_energy = |compliance: Compliance| -> f64 {
        let lags = displacement.lags.iter().zip(compliance.lag_energies);
        let energies = lags.map(|(lag, lag_energy)| lag_energy.expand(*lag, 0.0).energy);
        energies.sum()
    };
    friction.sum::<f64>() + pads.compliance.map_or(0.0, spring_energy)
}

/// Computes a lower bound of the minimum cost by duality, from the friction forces of a displacement's slides. The
/// forces do the work `sum f . swing`, and their torques can release at most a certain energy from the springs. If the
/// forces balance each other, every displacement of the body costs at least this work minus this energy. Returns the
/// net force and torque, and the duality gap: the displacement's cost minus the lower bound.
fn compute_dual_certificate(pads: &Pads, displacement: &Displacement) -> ([f64; 3], f64) {
    /// Length that converts the net torque to a force, mm.
    const TORQUE_LEVER_ARM: f64 = 100.0;
    let eps = max_abs_component(&pads.swings) * MIN_SMOOTHING;
    let (mut lower_bound, mut net_force) = (0.0, [0.0; 3]);
    for (i, slide) in pads.slides(displacement).into_iter().enumerate() {
        let weights = pads.slide_weights(slide);
        let length = weighted_length(pads, slide).hypot(eps);
        let force = [
            weights[0] * weights[0] * slide[0] / length,
            weights[1] * slide[1] / length,
        ];
        let is_possible = (force[0] / weights[0]).hypot(force[1]) <= 1.0 + 1e-12;
        assert!(is_possible, "the force is greater than the pad's friction");
        let force = force.map(|component| pads.loads[i] * component);
        let work_along = |[x, y]: Point| force[0] * x + force[1] * y;
        lower_bound += work_along(pads.swings[i]);
        if let Some(compliance) = pads.compliance {
            let torque = work_along(compliance.sweep_derivatives[i]);
            lower_bound +=
                torque * compliance.previous_lags[i] - compliance.lag_energies[i].conjugate(torque);
        }
        net_force[0] += force[0];
        net_force[1] += force[1];
        let [x, y] = pads.positions[i];
        net_force[2] += (x * force[1] - y * force[0]) / TORQUE_LEVER_ARM;
    }
    (net_force, compute_cost(pads, displacement) - lower_bound)
}

fn assert_minimal(pads: &Pads) {
    let (net_force, duality_gap) = compute_dual_certificate(pads, &pads.minimise_cost(None));
    let is_balanced = net_force.iter().all(|component| component.abs() < 1e-5);
    assert!(is_balanced, "the forces do not balance: {net_force:?}");
    let is_closed = duality_gap.abs() < 1e-5 * max_abs_component(&pads.swings);
    assert!(is_closed, "the duality gap is {duality_gap}");
}

#[test]
fn the_minimum_is_found_when_two_feet_nearly_balance_the_other_two() {
    // In a gait of sine waves, two legs always swing in one direction and the other two in the opposite one at nearly
    // the same speed. Only the lever arms decide.
    for step in 0..1000 {
        let (start, end) = (f64::from(step), f64::from(step + 1));
        let foot_position_at = |i: usize, step: f64| {
            let start_phase = [0.25, 0.75, 0.5, 0.0][i];
            let sweep = 0.35 * ((step / 1000.0 - start_phase) * std::f64::consts::TAU).cos();
            let left_sign = [1.0, -1.0, -1.0, 1.0][i];
            [
                [55.0, 55.0, -55.0, -55.0][i] + 45.0 * sweep.sin(),
                left_sign * (35.0 + 45.0 * sweep.cos()),
            ]
        };
        let positions = std::array::from_fn(|i| foot_position_at(i, (start + end) / 2.0));
        let swings = std::array::from_fn(|i| {
            let (a, b) = (foot_position_at(i, start), foot_position_at(i, end));
            [b[0] - a[0], b[1] - a[1]]
        });
        assert_minimal(&rigid_leg_pads(positions, swings));
    }
}

/// Asserts the twist of a body on rigid legs with these swings.
#[track_caller]
fn assert_twist(swings: [Point; 4], expected: Twist) {
    let pads = rigid_leg_pads(PAD_POSITIONS, swings);
    let twist = pads.minimise_cost(None).twist;
    for (i, max_error) in [1e-7, 1e-7, 1e-9].into_iter().enumerate() {
        assert_near(twist[i], expected[i], max_error);
    }
}

#[test]
fn three_pads_that_swing_alike_hold_while_the_fourth_slides() {
    for sliding_pad in 0..4 {
        let mut swings = [[-1.0, 0.0]; 4];
        swings[sliding_pad] = [3.0, 0.0];
        assert_twist(swings, [1.0, 0.0, 0.0]);
    }
}

#[test]
fn a_single_swinging_pad_does_not_move_the_body() {
    let swings = [[5.0, 1.0], [0.0; 2], [0.0; 2], [0.0; 2]];
    assert_twist(swings, [0.0; 3]);
}

#[test]
fn legs_that_swing_against_each_other_turn_the_body() {
    // The pads turn by -0.01 rad about the body's centre, so the body turns by 0.01 rad, and no pad slides.
    let swings = PAD_POSITIONS.map(|[x, y]| [0.01 * y, -0.01 * x]);
    assert_twist(swings, [0.0, 0.0, 0.01]);
}

fn any_point_within(max: f64) -> impl Strategy<Value = Point> {
    [-max..max, -max..max]
}

proptest! {
    #[test]
    fn with_rigid_legs_the_minimum_cost_equals_the_dual_lower_bound(
        jitter in prop::array::uniform4(any_point_within(20.0)),
        swings in prop::array::uniform4(any_point_within(5.0)),
        friction_ratio in 0.5f64..2.0,
        loads in prop::array::uniform4(0.8f64..1.2),
    ) {
        let positions = std::array::from_fn(|i| {
            [PAD_POSITIONS[i][0] + jitter[i][0], PAD_POSITIONS[i][1] + jitter[i][1]]
        });
        assert_minimal(&Pads { positions, swings, friction_ratio, loads, compliance: None, inertia: None });
    }

    #[test]
    fn no_twist_near_the_minimum_costs_less(
        swings in prop::array::uniform4(any_point_within(5.0)),
        nudge in prop::array::uniform3(-1.0f64..1.0),
        exponent in -6i32..1,
        loads in prop::array::uniform4(0.8f64..1.2),
    ) {
        let pads = Pads { positions: PAD_POSITIONS, swings, friction_ratio: 1.3, loads, compliance: None, inertia: None };
        let minimum = pads.minimise_cost(None);
        let (twist, scale) = (minimum.twist, 10f64.powi(exponent));
        let nudged = [twist[0] + scale * nudge[0], twist[1] + scale * nudge[1], twist[2] + scale * nudge[2] / 80.0];
        let nudged = Displacement { twist: nudged, ..minimum };
        prop_assert!(compute_cost(&pads, &minimum) <= compute_cost(&pads, &nudged) + 1e-6);
    }

    // Every leg has play, with a stop at its lower end, and with another stop or a slotted strut at its upper end.
    #[test]
    fn with_play_and_slotted_struts_the_minimum_cost_equals_the_dual_lower_bound(
        swings in prop::array::uniform4(any_point_within(5.0)),
        loads in prop::array::uniform4(0.5f64..1.5),
        play in 0.0f64..0.03,
        lag_fractions in prop::array::uniform4(-1.0f64..1.0),
        preload in prop::option::of(0.2f64..6.0),
        strut_angle_deg in 40.0f64..85.0,
    ) {
        prop_assume!(swings.iter().flatten().any(|component| component.abs() > 1e-3));
        let (sin, cos) = strut_angle_deg.to_radians().sin_cos();
        let joint = [22.0 * cos - 30.2, 22.0 * sin];
        let angle = joint[1].atan2(joint[0]) - strut_angle_deg.to_radians();
        let triangle = StrutTriangle::new(joint[0].hypot(joint[1]), 22.0, angle);
        // A spring for a robot of the paper's size. The spring rate makes the torque rise as the strut lengthens,
        // although the lever arm shrinks, so the energy is convex.
        let upper_resistance = preload.map_or(Resistance::Stop, |preload| Resistance::strut(triangle, preload, 1.5, 5.0));
        let resistances = [Resistance::Stop, upper_resistance];
        let lag_energy = LagEnergy { play, stop_torque: STOP_TORQUE, resistances, motor: None };
        let compliance = Some(Compliance {
            sweep_derivatives: [[45.0, 0.0]; 4],
            previous_lags: lag_fractions.map(|fraction| fraction * play),
            lag_energies: [lag_energy; 4],
        });
        assert_minimal(&Pads { positions: PAD_POSITIONS, swings, friction_ratio: 1.0, loads, compliance, inertia: None });
    }
}
