//! Section 4.2: forward position analysis of the legs.

use lizard_kinematics::{Leg, Vector};

use super::equation::Equation;
use super::sample::{Sample, angle_error_deg, polar, solve_half_angle};

/// The equations of section 4.2 about the legs, in the paper's order.
pub const EQUATIONS: &[Equation] = &[
    Equation::new(
        "4.2 leg loops",
        "LG1 + LG12 - LG13 - LG10 = 0, and with LG10 for legs 2 to 4",
        "mm; the paper means LG20, LG30, LG40",
        |sample| {
            let leg = &sample.lizard.leg;
            max_error(sample, ALL_LEGS, |theta| {
                let sum = polar(leg.crank, theta) + Vector::new(leg.coupler - leg.ground, 0.0)
                    - polar(leg.follower, theta);
                Some(sum.length())
            })
        },
    ),
    Equation::new(
        "4.2 θ_lg13, front legs",
        "θ_lg13 = 2 atan((-H + sqrt(H² - 4GI))/(2G))",
        "deg",
        |sample| follower_error(sample, FRONT_LEGS, 1.0, None),
    )
    .with_correction("the negative root for 0 < θ_lg < 180°", |sample| {
        follower_error(sample, FRONT_LEGS, -1.0, None)
    }),
    Equation::new(
        "4.2 θ_lg13, hind legs",
        "the same, with the positive root",
        "deg",
        |sample| follower_error(sample, HIND_LEGS, 1.0, None),
    ),
    Equation::new(
        "4.2 H, legs 2 to 4",
        "H = -2 sin θ1",
        "deg in θ_lg13 with the corrected root",
        |sample| error_of_legs_2_to_4(sample, Some(-2.0 * sample.theta()[1].sin())),
    )
    .with_correction("H = -2 sin θ_lgi", |sample| {
        error_of_legs_2_to_4(sample, None)
    }),
    Equation::new(
        "4.2 θ_lg12, front legs",
        "θ_lg12 = 2 atan((-K - sqrt(K² - 4JL))/(2J)), J: -lg10 cos θ/lg12, L: -(lg10/lg12 + 1) cos θ",
        "deg",
        |sample| coupler_error(sample, FRONT_LEGS, -1.0, -1.0),
    )
    .with_correction(
        "J: +lg10 cos θ/lg12, L: +(lg10/lg12 - 1) cos θ",
        |sample| coupler_error(sample, FRONT_LEGS, 1.0, -1.0),
    ),
    Equation::new("4.2 θ_lg12, hind legs", "the same", "deg", |sample| {
        coupler_error(sample, HIND_LEGS, -1.0, -1.0)
    })
    .with_correction(
        "J and L as above, and the positive root for 180° < θ_lg < 360°",
        |sample| coupler_error(sample, HIND_LEGS, 1.0, 1.0),
    ),
];

/// The paper's indices of the front legs' drive angles.
const FRONT_LEGS: &[usize] = &[1, 4];
/// The paper's indices of the hind legs' drive angles.
const HIND_LEGS: &[usize] = &[8, 5];
/// The paper's indices of all legs' drive angles.
const ALL_LEGS: &[usize] = &[1, 4, 8, 5];

/// Computes the largest error over these legs; `None` if the equation has no real root for a leg.
fn max_error(
    sample: &Sample,
    legs: &[usize],
    leg_error: impl Fn(f64) -> Option<f64>,
) -> Option<f64> {
    legs.iter()
        .map(|&leg| leg_error(sample.theta()[leg]))
        .try_fold(0.0, |max: f64, error| Some(max.max(error?)))
}

/// Computes the largest error, deg, of the followers' angles from the printed G and I, and from H = -2 sin theta_lg of
/// each leg, or from `h_override` if it is given. `root_sign` selects the root. In a parallelogram, the follower's true
/// angle is the crank's angle.
fn follower_error(
    sample: &Sample,
    legs: &[usize],
    root_sign: f64,
    h_override: Option<f64>,
) -> Option<f64> {
    let Leg {
        ground,
        crank,
        coupler,
        follower,
    } = sample.lizard.leg;
    max_error(sample, legs, |theta| {
        let cos_theta = theta.cos();
        let constant_term = (crank * crank + follower * follower + ground * ground
            - coupler * coupler)
            / (2.0 * crank * follower);
        let g = cos_theta - ground / crank - ground * cos_theta / follower + constant_term;
        let h = h_override.unwrap_or(-2.0 * theta.sin());
        let i = ground / crank - (ground / follower + 1.0) * cos_theta + constant_term;
        let printed_angle = solve_half_angle(g, h, i, root_sign)?;
        Some(angle_error_deg(printed_angle, theta))
    })
}

/// Computes the largest error, deg, of the followers' angles of legs 2 to 4, with the corrected root.
fn error_of_legs_2_to_4(sample: &Sample, h_override: Option<f64>) -> Option<f64> {
    let front = follower_error(sample, &[4], -1.0, h_override)?;
    Some(front.max(follower_error(sample, HIND_LEGS, 1.0, h_override)?))
}

/// Computes the largest error, deg, of the couplers' angles from J, K and L. In a parallelogram, the true angle is 0.
/// `term_sign` is the sign of the terms in lg10/lg12: -1 as printed, 1 as corrected. `root_sign` selects the root.
fn coupler_error(sample: &Sample, legs: &[usize], term_sign: f64, root_sign: f64) -> Option<f64> {
    let Leg {
        ground,
        crank,
        coupler,
        follower,
    } = sample.lizard.leg;
    max_error(sample, legs, |theta| {
        let cos_theta = theta.cos();
        let constant_term =
            (follower * follower - ground * ground - crank * crank - coupler * coupler)
                / (2.0 * crank * coupler);
        let j =
            cos_theta - ground / crank + term_sign * ground * cos_theta / coupler + constant_term;
        let k = -2.0 * theta.sin();
        let l = ground / crank + (term_sign * ground / coupler - 1.0) * cos_theta + constant_term;
        Some(angle_error_deg(solve_half_angle(j, k, l, root_sign)?, 0.0))
    })
}
