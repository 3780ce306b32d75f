//! The minimum cost, checked against the lower bound of the dual problem for random pads and springs.

use super::*;
use proptest::prelude::*;

use crate::lag_energy::{Side, Stretch};

const EVEN_LOADS: [f64; 4] = [1.0; 4];
/// Torque of a stop: more than that of a pad at the end of a leg of 45 mm.
const STOP_TORQUE: f64 = 250.0;
const PAD_POSITIONS: [Point; 4] = [[55.0, 80.0], [55.0, -80.0], [-55.0, -80.0], [-55.0, 80.0]];

/// Pads with equal loads and frictions, on rigid legs.
fn rigid_pads(positions: [Point; 4], swing: [Point; 4]) -> Pads {
    Pads {
        at: positions,
        swing,
        ratio: 1.0,
        load: EVEN_LOADS,
        compliance: None,
        body: None,
    }
}

/// The friction's work and the springs' energy.
fn cost_of(pads: &Pads, displacement: &Displacement) -> f64 {
    let length_of = |slide: Point| {
        let weight = pads.weight(slide);
        (weight[0] * slide[0]).hypot(weight[1] * slide[1])
    };
    let slides = pads.slides(displacement).into_iter().zip(pads.load);
    let friction: f64 = slides.map(|(slide, load)| load * length_of(slide)).sum();
    let energy_of = |compliance: Compliance| -> f64 {
        let lags = displacement.lag.iter();
        lags.zip(compliance.lag_energy)
            .map(|(lag, drive)| drive.expand(*lag, 0.0).0)
            .sum()
    };
    friction + pads.compliance.map_or(0.0, energy_of)
}

/// Computes by duality a lower bound of the minimum cost, from the friction forces of a displacement's slides. If the
/// sum and the torque of these forces are zero, no movement of the body costs less than their work `sum f . swing`,
/// minus the largest gain of their torques on the springs. Returns the sum and the torque, and the displacement's
/// cost minus this lower bound.
fn certificate_of(pads: &Pads, displacement: &Displacement) -> ([f64; 3], f64) {
    let eps = largest(&pads.swing) * MIN_ROUNDING;
    let (mut work, mut net) = (0.0, [0.0; 3]);
    for (i, slide) in pads.slides(displacement).into_iter().enumerate() {
        let weight = pads.weight(slide);
        let length = (weight[0] * slide[0])
            .hypot(weight[1] * slide[1])
            .hypot(eps);
        let force = [
            weight[0] * weight[0] * slide[0] / length,
            weight[1] * slide[1] / length,
        ];
        assert!(
            (force[0] / weight[0]).hypot(force[1]) <= 1.0 + 1e-12,
            "a pad cannot hold that"
        );
        let force = force.map(|component| pads.load[i] * component);
        let work_along = |[x, y]: Point| force[0] * x + force[1] * y;
        work += work_along(pads.swing[i]);
        if let Some(compliance) = pads.compliance {
            let torque = work_along(compliance.lag_derivatives[i]);
            work +=
                torque * compliance.previous_lags[i] - compliance.lag_energy[i].conjugate(torque);
        }
        net[0] += force[0];
        net[1] += force[1];
        net[2] += (pads.at[i][0] * force[1] - pads.at[i][1] * force[0]) / 100.0;
    }
    (net, cost_of(pads, displacement) - work)
}

fn assert_minimal(pads: &Pads) {
    let (net, gap) = certificate_of(pads, &pads.minimum());
    assert!(
        net.iter().all(|component| component.abs() < 1e-5),
        "forces out of balance: {net:?}"
    );
    assert!(gap.abs() < 1e-5 * largest(&pads.swing), "gap {gap}");
}

#[test]
fn a_near_tie_of_two_feet_against_two_is_decided_correctly() {
    // A sine walk: at each instant two legs move in one direction about as fast as two in the other, so that
    // only lever arms decide.
    for step in 0..1000 {
        let (from, to) = (f64::from(step), f64::from(step + 1));
        let foot_at = |i: usize, step: f64| {
            let start = [0.25, 0.75, 0.5, 0.0][i];
            let psi = 0.35 * ((step / 1000.0 - start) * std::f64::consts::TAU).cos();
            let side = [1.0, -1.0, -1.0, 1.0][i];
            [
                [55.0, 55.0, -55.0, -55.0][i] + 45.0 * psi.sin(),
                side * (35.0 + 45.0 * psi.cos()),
            ]
        };
        let positions = std::array::from_fn(|i| foot_at(i, (from + to) / 2.0));
        let swing = std::array::from_fn(|i| {
            let (a, b) = (foot_at(i, from), foot_at(i, to));
            [b[0] - a[0], b[1] - a[1]]
        });
        assert_minimal(&rigid_pads(positions, swing));
    }
}

#[test]
fn three_pads_that_agree_hold_and_the_fourth_slides() {
    for odd_pad in 0..4 {
        let mut swing = [[-1.0, 0.0]; 4];
        swing[odd_pad] = [3.0, 0.0];
        let twist = rigid_pads(PAD_POSITIONS, swing).minimum().twist;
        assert!(
            (twist[0] - 1.0).abs() < 1e-7 && twist[1].abs() < 1e-7 && twist[2].abs() < 1e-9,
            "{twist:?}"
        );
    }
}

#[test]
fn a_single_pad_that_swings_alone_moves_nothing() {
    let swing = [[5.0, 1.0], [0.0; 2], [0.0; 2], [0.0; 2]];
    let twist = rigid_pads(PAD_POSITIONS, swing).minimum().twist;
    assert!(
        twist.iter().all(|component| component.abs() < 1e-7),
        "{twist:?}"
    );
}

#[test]
fn legs_that_swing_against_each_other_turn_the_body() {
    // The pads move as one rigid body that turns by -0.01 rad, so the body turns by 0.01 rad and no pad slides.
    let swing = PAD_POSITIONS.map(|[x, y]| [0.01 * y, -0.01 * x]);
    let twist = rigid_pads(PAD_POSITIONS, swing).minimum().twist;
    assert!((twist[2] - 0.01).abs() < 1e-9 && twist[0].abs() < 1e-7 && twist[1].abs() < 1e-7);
}

fn any_point(size: f64) -> impl Strategy<Value = Point> {
    [-size..size, -size..size]
}

proptest! {
    #[test]
    fn no_twist_costs_less_than_the_balanced_forces_prove(
        jitter in prop::array::uniform4(any_point(20.0)),
        swing in prop::array::uniform4(any_point(5.0)),
        ratio in 0.5f64..2.0,
        load in prop::array::uniform4(0.8f64..1.2),
    ) {
        let positions = std::array::from_fn(|i| {
            [PAD_POSITIONS[i][0] + jitter[i][0], PAD_POSITIONS[i][1] + jitter[i][1]]
        });
        assert_minimal(&Pads { at: positions, swing, ratio, load, compliance: None, body: None });
    }

    #[test]
    fn no_twist_nearby_costs_less(
        swing in prop::array::uniform4(any_point(5.0)),
        nudge in prop::array::uniform3(-1.0f64..1.0),
        exponent in -6i32..1,
        load in prop::array::uniform4(0.8f64..1.2),
    ) {
        let pads = Pads { at: PAD_POSITIONS, swing, ratio: 1.3, load, compliance: None, body: None };
        let minimum = pads.minimum();
        let (twist, scale) = (minimum.twist, 10f64.powi(exponent));
        let nudged = [twist[0] + scale * nudge[0], twist[1] + scale * nudge[1], twist[2] + scale * nudge[2] / 80.0];
        let nudged = Displacement { twist: nudged, ..minimum };
        prop_assert!(cost_of(&pads, &minimum) <= cost_of(&pads, &nudged) + 1e-6);
    }

    // Every leg has play. Below it is a stop; above it is a stop, too, or a slotted strut.
    #[test]
    fn no_place_within_the_play_or_the_slot_costs_less(
        swing in prop::array::uniform4(any_point(5.0)),
        load in prop::array::uniform4(0.5f64..1.5),
        play in 0.0f64..0.03,
        lag_shares in prop::array::uniform4(-1.0f64..1.0),
        force in prop::option::of(0.2f64..6.0),
        arm_deg in 40.0f64..85.0,
    ) {
        prop_assume!(swing.iter().flatten().any(|component| component.abs() > 1e-3));
        let (sin, cos) = arm_deg.to_radians().sin_cos();
        let servo_end = [22.0 * cos - 30.2, 22.0 * sin];
        let angle = servo_end[1].atan2(servo_end[0]) - arm_deg.to_radians();
        let stretch = Stretch::new(servo_end[0].hypot(servo_end[1]), 22.0, angle);
        // The spring of a robot of the paper's size. Without a rate, its torque would fall as the strut
        // grows, because its lever shrinks.
        let upper = force.map_or(Side::Stop, |force| Side::strut(stretch, force, 1.5, 5.0));
        let drive = LagEnergy { play, stop: STOP_TORQUE, lower: Side::Stop, upper, motor: None };
        let compliance = Some(Compliance {
            lag_derivatives: [[45.0, 0.0]; 4],
            previous_lags: lag_shares.map(|share| share * play),
            lag_energy: [drive; 4],
        });
        assert_minimal(&Pads { at: PAD_POSITIONS, swing, ratio: 1.0, load, compliance, body: None });
    }
}
