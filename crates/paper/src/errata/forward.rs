//! Section 4.2: forward position analysis of the body.

use std::f64::consts::{FRAC_PI_2, PI};

use lizard_kinematics::{End, FiveBarPose, Links, Vector};

use super::equation::Equation;
use super::sample::{Sample, angle_error_deg, polar, solve_half_angle};
use crate::bisection::bisect;

/// The equations of section 4.2 about the body, in the paper's order.
pub const EQUATIONS: &[Equation] = &[
    Equation::new(
        "4.2 head loop",
        "l1 cos θ1 + l2 cos θ2 - l3 cos θ3 - l4 cos θ4 - l0 = 0 (and sin)",
        "mm",
        |sample| {
            let [_, theta1, theta2, theta3, theta4, ..] = sample.theta();
            Some(head_gap(sample, [theta1, theta2, theta3, theta4]))
        },
    )
    .with_clockwise_error(|sample| {
        let [_, theta1, theta2, theta3, theta4, ..] = sample.theta();
        Some(head_gap(sample, [theta1, theta2, PI - theta3, PI - theta4]))
    }),
    Equation::new(
        "4.2 head, θ3",
        "θ3 = 2 atan((-B - sqrt(B² - 4AC))/(2A))",
        "deg",
        |sample| {
            let (a, b, c) = abc_coefficients(sample, sample.theta()[4]);
            let printed_theta3 = solve_half_angle(a, b, c, -1.0)?;
            Some(angle_error_deg(printed_theta3, sample.theta()[3]))
        },
    )
    .with_correction(
        "the intersection of two circles, as in `kinematics` (error: mm of loop closure)",
        |sample| {
            let Some((theta4, pose)) = solve_near_zero_a(sample, 0.0) else {
                return Some(0.0);
            };
            let (theta2, theta3) = (pose.theta_left_coupler(), pose.theta_right_coupler());
            let [theta1, theta2, theta3] =
                [sample.solution.pose.theta1, theta2, theta3].map(|degrees| degrees * (PI / 180.0));
            Some(head_gap(sample, [theta1, theta2, theta3, theta4]))
        },
    )
    .with_special_case("θ4 within 1e-9° of A = 0", error_near_zero_a),
    Equation::new(
        "4.2 head, θ2",
        "θ2 = 2 atan((-E + sqrt(E² + 4DF))/(2D)), K4 = -l4 cos θ4 + l1 cos θ1 + l0",
        "deg",
        |sample| {
            let (d, e, f) = def_coefficients(sample, 1.0);
            let radicand = e * e + 4.0 * d * f;
            let tangent = (radicand >= 0.0).then(|| (-e + radicand.sqrt()) / (2.0 * d))?;
            Some(angle_error_deg(2.0 * tangent.atan(), sample.theta()[2]))
        },
    )
    .with_correction(
        "θ2 = 2 atan((E - sqrt(E² - 4DF))/(2D)), K4 = -l4 cos θ4 + l1 cos θ1 - l0",
        |sample| {
            let (d, e, f) = def_coefficients(sample, -1.0);
            let radicand = e * e - 4.0 * d * f;
            let tangent = (radicand >= 0.0).then(|| (e - radicand.sqrt()) / (2.0 * d))?;
            Some(angle_error_deg(2.0 * tangent.atan(), sample.theta()[2]))
        },
    ),
    Equation::new(
        "4.2 tail loop",
        "R6 + R7 - R8 - R9 - R5 = 0",
        "mm",
        |sample| {
            let (lengths, theta) = (sample.lizard.links.to_array(), sample.theta());
            let links = [6, 7, 8, 9].map(|i| (lengths[i], theta[i - 1]));
            Some(loop_gap(links, lengths[5]))
        },
    ),
    Equation::new(
        "4.2 left loop, slider extended by s",
        "R11 + R12 - R13 - R14 - R10 = 0",
        "mm",
        |sample| Some(side_gap(sample, [10, 9], sample.solution.left.s)),
    ),
    Equation::new(
        "4.2 right loop, slider extended by s",
        "R16 + R17 - R18 - R19 - R15 = 0",
        "mm",
        |sample| Some(side_gap(sample, [15, 13], sample.solution.right.s)),
    ),
    Equation::new(
        "4.2 left slider halves",
        "θ10 + θ11 = 0",
        "deg",
        |sample| angle_error(sample, |theta| [theta[10] + theta[11], 0.0]),
    )
    .with_clockwise_error(|sample| angle_error(sample, |theta| [theta[10] + (PI - theta[11]), 0.0]))
    .with_correction("θ11 = θ10 + 180°", |sample| {
        angle_error(sample, |theta| [theta[11], theta[10] + PI])
    }),
    Equation::new(
        "4.2 right slider halves",
        "θ14 + θ15 = 0",
        "deg",
        |sample| angle_error(sample, |theta| [theta[14] + theta[15], 0.0]),
    )
    .with_clockwise_error(|sample| angle_error(sample, |theta| [theta[14] + (PI - theta[15]), 0.0]))
    .with_correction("θ15 = θ14 + 180°", |sample| {
        angle_error(sample, |theta| [theta[15], theta[14] + PI])
    }),
    Equation::new("4.2 arm on A1", "θ1 - θ12 + C1 = 0", "deg", |sample| {
        angle_error(sample, |theta| [theta[1] + FRAC_PI_2, theta[12]])
    }),
    Equation::new("4.2 arm on A2", "θ4 - θ16 + C2 = 0", "deg", |sample| {
        angle_error(sample, |theta| [theta[4] + FRAC_PI_2, theta[16]])
    })
    .with_clockwise_error(|sample| {
        angle_error(sample, |theta| [PI - theta[4] + FRAC_PI_2, PI - theta[16]])
    })
    .with_correction("θ16 = θ4 - C2", |sample| {
        angle_error(sample, |theta| [theta[4] - FRAC_PI_2, theta[16]])
    }),
    Equation::new("4.2 arm on A4", "θ9 - θ5 + C3 = 0", "deg", |sample| {
        angle_error(sample, |theta| [theta[9] + FRAC_PI_2, theta[5]])
    }),
    Equation::new("4.2 arm on A3", "θ13 - θ8 + C4 = 0", "deg", |sample| {
        angle_error(sample, |theta| [theta[13] + FRAC_PI_2, theta[8]])
    })
    .with_clockwise_error(|sample| {
        angle_error(sample, |theta| [PI - theta[13] + FRAC_PI_2, PI - theta[8]])
    })
    .with_correction("θ13 = θ8 + C4", |sample| {
        angle_error(sample, |theta| [theta[13] - FRAC_PI_2, theta[8]])
    }),
];

/// Computes the difference between the two angles that `angles` returns for a sample's thetas, deg.
fn angle_error(sample: &Sample, angles: fn([f64; 17]) -> [f64; 2]) -> Option<f64> {
    let [a, b] = angles(sample.theta());
    Some(angle_error_deg(a, b))
}

/// Computes the gap in the head's loop for these angles (rad) of l1 to l4, mm.
fn head_gap(sample: &Sample, [theta1, theta2, theta3, theta4]: [f64; 4]) -> f64 {
    let Links {
        l0, l1, l2, l3, l4, ..
    } = sample.lizard.links;
    loop_gap([(l1, theta1), (l2, theta2), (l3, theta3), (l4, theta4)], l0)
}

/// Computes the length of the vector first + second - third - fourth - base, mm; 0 if the loop is closed. Each of the
/// four links is given by its length (mm) and angle (rad).
fn loop_gap(links: [(f64, f64); 4], base: f64) -> f64 {
    let [a, b, c, d] = links.map(|(length, angle)| polar(length, angle));
    (a + b - c - d - Vector::new(base, 0.0)).length()
}

/// Computes the gap in a side's loop whose slider is extended by `travel`, mm. `first_indices` are the paper's indices
/// of the base's length and of the rear arm's angle; the other indices follow.
fn side_gap(sample: &Sample, first_indices: [usize; 2], travel: f64) -> f64 {
    let (lengths, theta) = (sample.lizard.links.to_array(), sample.theta());
    let [base, first_angle] = first_indices;
    let vector_at =
        |i: usize, extension: f64| polar(lengths[base + 1 + i] + extension, theta[first_angle + i]);
    let sum = vector_at(0, 0.0) + vector_at(1, travel / 2.0)
        - vector_at(2, travel / 2.0)
        - vector_at(3, 0.0)
        - polar(lengths[base], FRAC_PI_2);
    sum.length()
}

/// Computes the coefficients A, B and C as printed, for this theta4 (rad) and the sample's theta1.
fn abc_coefficients(sample: &Sample, theta4: f64) -> (f64, f64, f64) {
    let Links {
        l0, l1, l2, l3, l4, ..
    } = sample.lizard.links;
    // `Sample::theta` would compute arc tangents that are not needed here.
    let theta1 = sample.solution.pose.theta1 * PI / 180.0;
    let k1 = l4 * theta4.sin() - l1 * theta1.sin();
    let k2 = l4 * theta4.cos() - l1 * theta1.cos() + l0;
    let common = l3 * l3 - l2 * l2 + k2 * k2 + k1 * k1;
    (
        (common - 2.0 * k2 * l3) / 2.0,
        2.0 * k1 * l3,
        (common + 2.0 * k2 * l3) / 2.0,
    )
}

/// Computes the coefficients D, E and F. `base_sign` is the sign of l0 in K4: 1 as printed, -1 as corrected.
fn def_coefficients(sample: &Sample, base_sign: f64) -> (f64, f64, f64) {
    let Links {
        l0, l1, l2, l3, l4, ..
    } = sample.lizard.links;
    let theta = sample.theta();
    let k3 = -l4 * theta[4].sin() + l1 * theta[1].sin();
    let k4 = -l4 * theta[4].cos() + l1 * theta[1].cos() + base_sign * l0;
    let common = l3 * l3 - l2 * l2 - k4 * k4 - k3 * k3;
    (
        (common + 2.0 * k4 * l2) / 2.0,
        2.0 * k3 * l2,
        (common - 2.0 * k4 * l2) / 2.0,
    )
}

/// Finds the theta4 (rad) at which A is 0 for the sample's theta1; `None` if there is no such angle from -90 to 90
/// degrees.
fn find_theta4_at_zero_a(sample: &Sample) -> Option<f64> {
    let coefficient_a = |theta4: f64| abc_coefficients(sample, theta4).0;
    let angle_at = |i: i32| f64::from(i) * FRAC_PI_2 / 90.0;
    let start =
        (-90..90).find(|&i| coefficient_a(angle_at(i)) * coefficient_a(angle_at(i + 1)) < 0.0)?;
    let (low, high) = (angle_at(start), angle_at(start + 1));
    let is_below = |theta4: f64| coefficient_a(low) * coefficient_a(theta4) > 0.0;
    Some(bisect(low, high, 60, is_below))
}

/// Solves the head for the sample's theta1 and for the theta4 (rad) that exceeds the one at which A is 0 by
/// `offset_deg`; `None` if there is no such theta4 or no solution.
fn solve_near_zero_a(sample: &Sample, offset_deg: f64) -> Option<(f64, FiveBarPose)> {
    let theta4 = find_theta4_at_zero_a(sample)? + offset_deg * PI / 180.0;
    let head = sample.lizard.end(End::Head);
    let pose = head.forward(sample.solution.pose.theta1, theta4 * 180.0 / PI);
    Some((theta4, pose.ok()?))
}

/// Computes the error of the printed theta3 close to the theta4 at which A is 0; 0 if there is no such theta4.
fn error_near_zero_a(sample: &Sample) -> Option<f64> {
    let offset_deg = (sample.random[0] - 0.5) * 2e-9;
    let Some((theta4, exact_pose)) = solve_near_zero_a(sample, offset_deg) else {
        return Some(0.0);
    };
    let (a, b, c) = abc_coefficients(sample, theta4);
    let printed_theta3 = solve_half_angle(a, b, c, -1.0)?;
    let exact_theta3 = exact_pose.theta_right_coupler() * PI / 180.0;
    Some(angle_error_deg(printed_theta3, exact_theta3))
}
