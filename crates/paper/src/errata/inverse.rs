//! Section 4.1: inverse position analysis.

use std::f64::consts::PI;

use lizard_kinematics::{End, Side, Vector};

use super::equation::Equation;
use super::sample::{Sample, polar};

/// The equations of section 4.1, in the paper's order.
pub const EQUATIONS: &[Equation] = &[
    Equation::new(
        "4.1 head, left arm",
        "(x11 - l1 cos θ1 + l0/2)² + (y11 - l1 sin θ1)² = l2²",
        "mm in length",
        |sample| {
            let links = &sample.lizard.links;
            let crank = polar(links.l1, sample.theta()[1]);
            arm_error(head_point(sample), -links.l0 / 2.0, crank, links.l2)
        },
    ),
    Equation::new(
        "4.1 head, right arm",
        "(x11 - l1 cos θ2 - l0/2)² + (y11 - l1 sin θ2)² = l2²",
        "mm in length",
        |sample| {
            let links = &sample.lizard.links;
            let crank = polar(links.l1, sample.theta()[2]);
            arm_error(head_point(sample), links.l0 / 2.0, crank, links.l2)
        },
    )
    .with_correction(
        "(x11 - l4 cos θ4 - l0/2)² + (y11 - l4 sin θ4)² = l3²",
        |sample| {
            let links = &sample.lizard.links;
            let crank = polar(links.l4, sample.theta()[4]);
            arm_error(head_point(sample), links.l0 / 2.0, crank, links.l3)
        },
    ),
    Equation::new(
        "4.1 tail, arm of A3",
        "(x21 - l9 cos θ8 + l5/2)² + (y21 - l9 sin θ8)² = l8²",
        "mm in length",
        |sample| {
            let links = &sample.lizard.links;
            let crank = polar(links.l9, sample.theta()[8]);
            arm_error(tail_point(sample), -links.l5 / 2.0, crank, links.l8)
        },
    )
    .with_correction(
        "the same in a frame turned by 180°: x21, y21 negated, θ8 - 180°",
        |sample| {
            let links = &sample.lizard.links;
            let crank = polar(links.l9, sample.theta()[8] - PI);
            arm_error(-tail_point(sample), -links.l5 / 2.0, crank, links.l8)
        },
    ),
    Equation::new(
        "4.1 tail, arm of A4",
        "(x21 - l9 cos θ7 - l5/2)² + (y21 - l9 sin θ7)² = l8²",
        "mm in length",
        |sample| {
            let links = &sample.lizard.links;
            let crank = polar(links.l9, sample.theta()[7]);
            arm_error(tail_point(sample), links.l5 / 2.0, crank, links.l8)
        },
    )
    .with_correction(
        "in the turned frame (x21 - l6 cos θ5 - l5/2)² + (y21 - l6 sin θ5)² = l7²",
        |sample| {
            let links = &sample.lizard.links;
            let crank = polar(links.l6, sample.theta()[5] - PI);
            arm_error(-tail_point(sample), links.l5 / 2.0, crank, links.l7)
        },
    ),
    Equation::new(
        "4.1 left body, x31 and y31",
        "2 x31 = l13 cos θ11 + l14 cos θ12 (y31: sin)",
        "mm",
        |sample| slider_error(sample, Side::Left, [(13, 11), (14, 12)]),
    )
    .with_correction(
        "2 x31 = l11 cos θ9 + l14 cos θ12, from the middle of l10",
        |sample| slider_error(sample, Side::Left, [(11, 9), (14, 12)]),
    ),
    Equation::new(
        "4.1 right body, x41 and y41",
        "2 x41 = l19 cos θ16 + l18 cos θ15 (y41: sin)",
        "mm",
        |sample| slider_error(sample, Side::Right, [(19, 16), (18, 15)]),
    )
    .with_correction(
        "2 x41 = l16 cos θ13 + l19 cos θ16, from the middle of l15",
        |sample| slider_error(sample, Side::Right, [(16, 13), (19, 16)]),
    ),
];

/// Computes the difference between a coupler's length and the distance from its crank's tip to a point, mm.
fn arm_error(point: Vector, shaft_x: f64, crank: Vector, coupler_length: f64) -> Option<f64> {
    let tip = Vector::new(shaft_x, 0.0) + crank;
    Some(((point - tip).length() - coupler_length).abs())
}

/// The head point relative to the middle of l0, in chassis axes.
fn head_point(sample: &Sample) -> Vector {
    sample.solution.head.end_point
}

/// The tail point relative to the middle of l5, in chassis axes.
fn tail_point(sample: &Sample) -> Vector {
    End::Tail.mirror(sample.solution.tail.end_point)
}

/// Computes the distance from the middle of a slider to half the sum of two vectors, each given by the paper's indices
/// of its length and of its angle, mm.
fn slider_error(sample: &Sample, side: Side, index_pairs: [(usize, usize); 2]) -> Option<f64> {
    let (lengths, theta) = (sample.lizard.links.to_array(), sample.theta());
    let [first, second] = index_pairs.map(|(length, angle)| polar(lengths[length], theta[angle]));
    // The middle of the slider relative to the middle between its shafts; the rear shaft is the origin.
    let slider = sample.solution.side(side);
    let middle = (slider.rear_tip + slider.front_tip - slider.front_shaft) * 0.5;
    Some((middle - (first + second) * 0.5).length())
}
