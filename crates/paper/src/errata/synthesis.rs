//! Sections 2 and 3: mobility and dimensional synthesis.

use std::f64::consts::PI;

use lizard_kinematics::{End, Vector, Workspace};

use super::equation::Equation;
use super::sample::{LINK_TABLE, Sample, polar};
use crate::design::{CLAIMED_LCI, PROPORTION_SUM, Proportions, lci};
use crate::mobility;

/// The margin below which a leg counts as close to a change point.
const MIN_LEG_MARGIN: f64 = 0.3;

/// The equations of sections 2 and 3, in the paper's order.
pub const EQUATIONS: &[Equation] = &[
    Equation::new(
        "2.1 mobility of the body",
        "M = 3(N - 1 - j) + sum f = 4, with N = 13, j = 16",
        "freedoms, relative to the rank of the constraints",
        |sample| {
            let freedoms = mobility::count_body_freedoms(&sample.lizard, &sample.solution);
            Some((freedoms as f64 - 4.0).abs())
        },
    ),
    Equation::new(
        "2.2 mobility of a leg",
        "M = 1",
        "freedoms, relative to the rank of the constraints",
        |sample| {
            let freedoms =
                mobility::count_left_front_leg_freedoms(&sample.lizard, &sample.solution);
            Some((freedoms as f64 - 1.0).abs())
        },
    ),
    Equation::new(
        "3.1 dimensional factor",
        "D = (R1 + R2 + R3)/0.9 = R3/r3, r1 + r2 + r3 = 0.9",
        "mm",
        |sample| {
            let (d, proportions) = (10.0 + 100.0 * sample.random[0], Proportions::PAPER);
            let five_bar = proportions.five_bar(d);
            let sum =
                five_bar.left_crank_length + five_bar.left_coupler_length + five_bar.base / 2.0;
            let sum_error = (sum / PROPORTION_SUM - d).abs();
            let base_error = (proportions.factor_for_base(five_bar.base) - d).abs();
            Some(sum_error.max(base_error))
        },
    ),
    Equation::new(
        "3.1 design space",
        "r3 < 0.45 ensures r1 + r2 > r3",
        "D",
        |sample| {
            let r3 = 0.45 * sample.random[0];
            Some((r3 - (PROPORTION_SUM - r3)).max(0.0))
        },
    ),
    Equation::new(
        "3.1.2 workspace circles (all four)",
        "(x11 ± l0/2)² + y11 = (l1 ± l2)²",
        "mm in radius",
        |sample| compute_circle_error(sample, |y| y),
    )
    .with_correction("(x11 ± l0/2)² + y11² = (l1 ± l2)²", |sample| {
        compute_circle_error(sample, |y| y * y)
    }),
    Equation::new(
        "3.1.3 maximal inscribed circle",
        "r = (l1 + l2 - |l1 - l2|)/2, y = sqrt((l1 + l2 + |l1 - l2|)²/4 - (l0/2)²)",
        "mm",
        |sample| {
            let head = Workspace::for_five_bar(&sample.lizard.end(End::Head));
            let (sum, difference) = (head.outer_radius, head.inner_radius);
            let r = (sum - difference) / 2.0;
            let y = ((sum + difference).powi(2) / 4.0 - head.half_base.powi(2)).sqrt();
            let clearance_at = |x: f64, y: f64| {
                let [left, right] = [x + head.half_base, x - head.half_base].map(|offset| {
                    let distance = offset.hypot(y);
                    (distance - difference).min(sum - distance)
                });
                left.min(right)
            };
            // The circle is inscribed, and no other centre allows a larger one.
            let other_radius =
                clearance_at(sum * (2.0 * sample.random[0] - 1.0), sum * sample.random[1]);
            Some((clearance_at(0.0, y) - r).abs().max(other_radius - r))
        },
    ),
    Equation::new(
        "3.1.4 conditioning",
        "LCI > 0.7 inside the inscribed circle",
        "below the LCI of 0.7",
        |sample| Some((CLAIMED_LCI - compute_random_lci(sample, 1.0)).max(0.0)),
    )
    .with_correction(
        "LCI > 0.7 inside the concentric circle of half the radius; \
         over the whole circle only as a mean",
        |sample| Some((CLAIMED_LCI - compute_random_lci(sample, 0.5)).max(0.0)),
    ),
    Equation::new(
        "3.2 table of links",
        "l12, l13, l16, l18 = 45 (l16 = 30 before)",
        "links without a length",
        |_| Some(count_unlisted_links(|i, _| i)),
    )
    .with_correction("l12, l13, l17, l18 = 45", |_| {
        Some(count_unlisted_links(|i, length| {
            if i == 16 && length == 45.0 { 17 } else { i }
        }))
    }),
    Equation::new(
        "3.2 legs",
        "the parallelogram does not operate in the singularity zone",
        "below the margin of 0.3",
        |sample| Some(compute_leg_shortfall(360.0 * sample.random[0])),
    )
    .with_correction(
        "change points at theta_lg = 0 and 180; \
         the margin |sin theta_lg| is 0.3 within 72.5 deg of 90 and 270",
        |sample| {
            let angle_deg = 90.0 + 72.5 * (2.0 * sample.random[0] - 1.0);
            Some(compute_leg_shortfall(angle_deg))
        },
    ),
];

/// Computes the largest radius error of the circle equation at random points on the boundaries of the arms' reach.
/// `y_term` returns the equation's term in y.
fn compute_circle_error(sample: &Sample, y_term: fn(f64) -> f64) -> Option<f64> {
    let head = Workspace::for_five_bar(&sample.lizard.end(End::Head));
    let mut max_error = 0.0_f64;
    for shaft_x in [-head.half_base, head.half_base] {
        for radius in [head.outer_radius, head.inner_radius] {
            let rim_point = polar(radius, PI * sample.random[0]);
            // x11 is measured from the middle of the base. The rim point is measured from the shaft.
            let (x11, y11) = (rim_point.x + shaft_x, rim_point.y);
            let square = (x11 - shaft_x).powi(2) + y_term(y11);
            max_error = max_error.max((square.sqrt() - radius).abs());
        }
    }
    Some(max_error)
}

/// Computes by how much the margin of a leg at this angle is below [`MIN_LEG_MARGIN`].
fn compute_leg_shortfall(angle_deg: f64) -> f64 {
    (MIN_LEG_MARGIN - angle_deg.to_radians().sin().abs()).max(0.0)
}

/// Computes the LCI at a random point inside the circle with the centre of the inscribed circle and `radius_factor`
/// times its radius.
fn compute_random_lci(sample: &Sample, radius_factor: f64) -> f64 {
    let five_bar = sample.lizard.end(End::Head);
    Workspace::for_five_bar(&five_bar)
        .inscribed_circle()
        .map_or(0.0, |circle| {
            let radius = circle.radius * radius_factor * sample.random[0].sqrt();
            lci(
                &five_bar,
                circle.centre + Vector::from_angle(360.0 * sample.random[1]) * radius,
            )
        })
}

/// Counts the links l0 to l19 that the table does not list. `link_number` returns the number under which an entry
/// counts, printed or corrected, given its printed number and its length.
fn count_unlisted_links(link_number: fn(usize, f64) -> usize) -> f64 {
    let is_listed = |link: usize| {
        LINK_TABLE
            .iter()
            .any(|(links, length)| links.iter().any(|&i| link_number(i, *length) == link))
    };
    (0..20).filter(|&link| !is_listed(link)).count() as f64
}
