//! Section 4.1: inverse position analysis.

use std::f64::consts::PI;

use lizard_kinematics::{End, Vector};

use super::equation::Equation;
use super::sample::{Sample, polar};

/// The equations in the paper's order.
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
        |sample| {
            let (links, theta) = (&sample.lizard.links, sample.theta());
            let sum = polar(links.l13, theta[11]) + polar(links.l14, theta[12]);
            Some((slider_middle(sample, 0) - sum * 0.5).length())
        },
    )
    .with_correction(
        "2 x31 = l11 cos θ9 + l14 cos θ12, from the middle of l10",
        |sample| {
            let (links, theta) = (&sample.lizard.links, sample.theta());
            let sum = polar(links.l11, theta[9]) + polar(links.l14, theta[12]);
            Some((slider_middle(sample, 0) - sum * 0.5).length())
        },
    ),
    Equation::new(
        "4.1 right body, x41 and y41",
        "2 x41 = l19 cos θ16 + l18 cos θ15 (y41: sin)",
        "mm",
        |sample| {
            let (links, theta) = (&sample.lizard.links, sample.theta());
            let sum = polar(links.l19, theta[16]) + polar(links.l18, theta[15]);
            Some((slider_middle(sample, 1) - sum * 0.5).length())
        },
    )
    .with_correction(
        "2 x41 = l16 cos θ13 + l19 cos θ16, from the middle of l15",
        |sample| {
            let (links, theta) = (&sample.lizard.links, sample.theta());
            let sum = polar(links.l16, theta[13]) + polar(links.l19, theta[16]);
            Some((slider_middle(sample, 1) - sum * 0.5).length())
        },
    ),
];

/// The difference between a coupler's length and the distance from its crank's tip to a point.
fn arm_error(point: Vector, shaft_x: f64, crank: Vector, coupler: f64) -> Option<f64> {
    let tip = Vector::new(shaft_x, 0.0) + crank;
    Some(((point - tip).length() - coupler).abs())
}

/// The head point relative to the middle of l0, in chassis axes.
fn head_point(sample: &Sample) -> Vector {
    sample.solution.head.end_point
}

/// The tail point relative to the middle of l5, in chassis axes.
fn tail_point(sample: &Sample) -> Vector {
    End::Tail.mirror(sample.solution.tail.end_point)
}

/// The middle of a slider, relative to the middle between its shafts. `side` is 0 for left, 1 for right.
fn slider_middle(sample: &Sample, side: usize) -> Vector {
    let slider = [&sample.solution.left, &sample.solution.right][side];
    (slider.rear_tip + slider.front_tip - slider.front_shaft) * 0.5
}
