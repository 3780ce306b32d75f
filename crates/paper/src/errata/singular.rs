//! Section 5: K, K* and the singularity conditions.

use std::f64::consts::{FRAC_PI_2, PI};

use lizard_kinematics::End;

use super::equation::Equation;
use super::sample::Sample;

/// The equations of section 5, in the paper's order.
pub const EQUATIONS: &[Equation] = &[
    Equation::new(
        "5.1 shape of K",
        "K is 8x8, and its determinant must not vanish",
        "columns more than servos",
        |sample| Some(8.0 - sample.solution.active_matrix()[0].len() as f64),
    )
    .with_correction("K is 8x4: four active rates, no determinant", |sample| {
        Some(4.0 - sample.solution.active_matrix()[0].len() as f64)
    }),
    Equation::new(
        "5.1 K, head",
        "[-l1 sin θ1, -l4 sin θ4; l1 cos θ1, -l4 cos θ4]",
        "mm/rad",
        |sample| K_HEAD.error(sample, -1.0),
    )
    .with_clockwise_error(|sample| K_HEAD.clockwise_error(sample))
    .with_correction("second column +l4 sin θ4, -l4 cos θ4", |sample| {
        K_HEAD.error(sample, 1.0)
    }),
    Equation::new(
        "5.1 K, tail",
        "[-l6 sin θ5, -l9 sin θ8; l6 cos θ5, -l9 cos θ8]",
        "mm/rad",
        |sample| K_TAIL.error(sample, -1.0),
    )
    .with_clockwise_error(|sample| K_TAIL.clockwise_error(sample))
    .with_correction("second column +l9 sin θ8, -l9 cos θ8", |sample| {
        K_TAIL.error(sample, 1.0)
    }),
    Equation::new(
        "5.1 K, left",
        "[l11 sin(C3 - θ5), -l14 sin(C1 + θ1); l11 cos(C3 - θ5), -l14 cos(C1 + θ1)]",
        "mm/rad",
        |sample| K_LEFT.side_error(sample, FRAC_PI_2, -1.0),
    )
    .with_correction("+l14 sin(C1 + θ1)", |sample| {
        K_LEFT.side_error(sample, FRAC_PI_2, 1.0)
    }),
    Equation::new(
        "5.1 K, right",
        "[l16 sin(C4 - θ8), -l19 sin(C2 + θ4); l16 cos(C4 - θ8), -l19 cos(C2 + θ4)]",
        "mm/rad",
        |sample| K_RIGHT.side_error(sample, FRAC_PI_2, -1.0),
    )
    .with_correction("+l19 sin(C2 + θ4), and C2 = C4 = -90°", |sample| {
        K_RIGHT.side_error(sample, -FRAC_PI_2, 1.0)
    }),
    Equation::new(
        "5.1 K*, head",
        "[-l2 sin θ2, -l3 sin θ3; l2 cos θ2, -l3 cos θ3]",
        "mm/rad",
        |sample| K_STAR_HEAD.error(sample, -1.0),
    )
    .with_clockwise_error(|sample| K_STAR_HEAD.clockwise_error(sample))
    .with_correction("second column +l3 sin θ3, -l3 cos θ3", |sample| {
        K_STAR_HEAD.error(sample, 1.0)
    }),
    Equation::new(
        "5.1 K*, tail",
        "[-l7 sin θ6, -l8 sin θ7; l7 cos θ6, -l8 cos θ7]",
        "mm/rad",
        |sample| K_STAR_TAIL.error(sample, -1.0),
    )
    .with_clockwise_error(|sample| K_STAR_TAIL.clockwise_error(sample))
    .with_correction("second column +l8 sin θ7, -l8 cos θ7", |sample| {
        K_STAR_TAIL.error(sample, 1.0)
    }),
    Equation::new(
        "5.1 determinant of the printed K*",
        "l2 l3 l7 l8 l12 l13 l17 l18 sin 2θ11 sin 2θ14 (cos(θ2+θ3-θ6-θ7) - cos(θ2+θ3+θ6+θ7))/2",
        "per product of lengths; follows from the printed matrix",
        |sample| {
            let theta = sample.theta();
            let product = (theta[2] + theta[3]).sin() * (theta[6] + theta[7]).sin();
            let printed = ((theta[2] + theta[3] - theta[6] - theta[7]).cos()
                - (theta[2] + theta[3] + theta[6] + theta[7]).cos())
                / 2.0;
            Some((product - printed).abs())
        },
    ),
    Equation::new(
        "5.1 singular head",
        "sin(θ2 + θ3) = 0",
        "in the sine",
        |sample| margin_error(sample, 0, |theta| theta[2] + theta[3]),
    )
    .with_clockwise_error(|sample| margin_error(sample, 0, |theta| theta[2] + PI - theta[3]))
    .with_correction("sin(θ3 - θ2) = 0", |sample| {
        determinant_error(sample, 0, |theta| theta[3] - theta[2])
    })
    .with_special_case(
        "the neutral pose, which the equation flags as singular",
        neutral_error,
    ),
    Equation::new(
        "5.1 singular tail",
        "sin(θ6 + θ7) = 0",
        "in the sine",
        |sample| margin_error(sample, 1, |theta| theta[6] + theta[7]),
    )
    .with_clockwise_error(|sample| margin_error(sample, 1, |theta| theta[6] + PI - theta[7]))
    .with_correction("sin(θ7 - θ6) = 0", |sample| {
        determinant_error(sample, 2, |theta| theta[7] - theta[6])
    }),
    Equation::new(
        "5.1 singular left side",
        "sin 2θ11 = 0",
        "in the sine, of a block that is never singular",
        |sample| Some(1.0 - (2.0 * sample.theta()[11]).sin().abs()),
    )
    .with_correction("never: the block's determinant is -d", |sample| {
        let [a, b, c, d] = passive_block(sample, 4);
        Some((a * d - b * c + sample.solution.left.d).abs())
    }),
    Equation::new(
        "5.1 singular right side",
        "sin 2θ14 = 0",
        "in the sine, of a block that is never singular",
        |sample| Some(1.0 - (2.0 * sample.theta()[14]).sin().abs()),
    )
    .with_correction("never: the block's determinant is -d", |sample| {
        let [a, b, c, d] = passive_block(sample, 6);
        Some((a * d - b * c + sample.solution.right.d).abs())
    }),
    Equation::new(
        "5.2 shape of the leg's K",
        "K is 2x2 and contains θ_lg12, which is passive",
        "columns more than drives",
        |sample| Some(2.0 - count_leg_freedoms(sample)),
    )
    .with_correction("K is 2x1: [-lg1 sin θ_lg1; lg1 cos θ_lg1]", |sample| {
        Some(1.0 - count_leg_freedoms(sample))
    }),
    Equation::new(
        "5.2 singular leg",
        "-lg12 lg13 sin(θ_lg1 + θ_lg12 - θ_lg13) = 0",
        "in the sine",
        |sample| {
            let theta = sample.theta()[1];
            Some(((theta + 0.0 - theta).sin().abs() - theta.sin().abs()).abs())
        },
    )
    .with_correction(
        "lg12 lg13 sin(θ_lg12 - θ_lg13) = 0, so sin θ_lg1 = 0",
        |sample| {
            let (leg, theta) = (&sample.lizard.leg, sample.theta()[1]);
            // The columns for θ_lg12 = 0 and θ_lg13 = θ_lg1.
            let (sin, cos) = theta.sin_cos();
            let columns = [0.0, leg.follower * sin, leg.coupler, -leg.follower * cos];
            let true_sine = (0.0 - theta).sin();
            Some((-determinant_sine(&columns, leg.coupler * leg.follower) - true_sine).abs())
        },
    ),
];

/// Computes the difference between the sine of theta2 + theta3 and the head's type-2 margin in the neutral pose, where
/// every slider has its nominal length.
fn neutral_error(sample: &Sample) -> Option<f64> {
    let links = &sample.lizard.links;
    let cos = (links.l12 + links.l13 - links.l10) / (links.l11 + links.l14);
    let theta1 = cos.acos().to_degrees();
    let head = sample.lizard.end(End::Head);
    let pose = head.forward(theta1, 180.0 - theta1).ok()?;
    let sum = pose.theta_left_coupler() + pose.theta_right_coupler();
    Some((sum.to_radians().sin().abs() - pose.type2).abs())
}

/// The 2x2 block of K or K* for a left and a right bar (crank or coupler) of the head or the tail, or for the rear and
/// the front arm of a slider's side.
struct Block {
    /// Returns the true block, by rows.
    true_block: fn(&Sample) -> [f64; 4],
    /// The paper's indices of the two bars' angles, 1 for theta1.
    angle_indices: [usize; 2],
    /// The paper's indices of the two bars' lengths, 1 for l1.
    length_indices: [usize; 2],
}

const K_HEAD: Block = Block::new(|sample| active_block(sample, 0, [0, 1]), [1, 4], [1, 4]);
const K_TAIL: Block = Block::new(|sample| active_block(sample, 2, [3, 2]), [5, 8], [6, 9]);
const K_STAR_HEAD: Block = Block::new(|sample| passive_block(sample, 0), [2, 3], [2, 3]);
const K_STAR_TAIL: Block = Block::new(|sample| passive_block(sample, 2), [6, 7], [7, 8]);
const K_LEFT: Block = Block::new(|sample| side_block(sample, 4, [3, 0]), [5, 1], [11, 14]);
const K_RIGHT: Block = Block::new(|sample| side_block(sample, 6, [2, 1]), [8, 4], [16, 19]);

impl Block {
    const fn new(
        true_block: fn(&Sample) -> [f64; 4],
        angle_indices: [usize; 2],
        length_indices: [usize; 2],
    ) -> Self {
        Self {
            true_block,
            angle_indices,
            length_indices,
        }
    }

    /// Computes the largest error of the block with this sign before the right bar's sine: -1.0 as printed, 1.0 as
    /// corrected.
    fn error(&self, sample: &Sample, sign: f64) -> Option<f64> {
        self.side_error(sample, 0.0, sign)
    }

    /// Computes the largest error of the block for the arms of a side. `constant` is the paper's C, rad: the angle from
    /// the front crank to its arm, and from the rear arm to its crank.
    fn side_error(&self, sample: &Sample, constant: f64, sign: f64) -> Option<f64> {
        let [rear, front] = self.angle_indices.map(|index| sample.theta()[index]);
        let block = self.printed_block(sample, [rear - constant, front + constant], sign);
        Some(max_difference(&(self.true_block)(sample), &block))
    }

    /// Computes the largest error of the printed block if the right bar's angle is measured clockwise from -x. Then the
    /// derivative with respect to this angle has the opposite sign.
    fn clockwise_error(&self, sample: &Sample) -> Option<f64> {
        let [a, b, c, d] = (self.true_block)(sample);
        let [left, right] = self.angle_indices.map(|index| sample.theta()[index]);
        let block = self.printed_block(sample, [left, PI - right], -1.0);
        Some(max_difference(&[a, -b, c, -d], &block))
    }

    /// Computes the block in the paper's form for two bars with these angles, rad. `sign` is the sign of the right
    /// bar's sine.
    fn printed_block(&self, sample: &Sample, thetas: [f64; 2], sign: f64) -> [f64; 4] {
        let lengths = sample.lizard.links.to_array();
        let [left, right] = self.length_indices.map(|index| lengths[index]);
        let [(left_sin, left_cos), (right_sin, right_cos)] = thetas.map(f64::sin_cos);
        [
            -left * left_sin,
            sign * right * right_sin,
            left * left_cos,
            -right * right_cos,
        ]
    }
}

/// Computes the largest difference between entries of two 2x2 blocks, given by rows.
fn max_difference(true_block: &[f64; 4], block: &[f64; 4]) -> f64 {
    let entries = true_block.iter().zip(block);
    entries.fold(0.0, |max, (a, b)| max.max((a - b).abs()))
}

/// Returns a block of the true K: rows `row` and `row + 1`, and the columns of two servos.
fn active_block(sample: &Sample, row: usize, [first, second]: [usize; 2]) -> [f64; 4] {
    let k = sample.solution.active_matrix();
    let (upper, lower) = (k[row], k[row + 1]);
    [upper[first], upper[second], lower[first], lower[second]]
}

/// Returns the block of the true K for a slider's side with the signs of the paper's form.
fn side_block(sample: &Sample, row: usize, columns: [usize; 2]) -> [f64; 4] {
    active_block(sample, row, columns).map(|entry| -entry)
}

/// Returns the 2x2 block on the diagonal of the true K* whose first column is `column`.
fn passive_block(sample: &Sample, column: usize) -> [f64; 4] {
    let k = sample.solution.passive_matrix();
    let (upper, lower, next) = (k[column], k[column + 1], column + 1);
    [upper[column], upper[next], lower[column], lower[next]]
}

/// Computes the difference between the sine of `angle` (rad) and the type-2 margin of an end: 0 for the head, 1 for the
/// tail.
fn margin_error(sample: &Sample, end: usize, angle: fn([f64; 17]) -> f64) -> Option<f64> {
    let sine = angle(sample.theta()).sin();
    Some((sine.abs() - sample.solution.margins.type2[end]).abs())
}

/// Computes the difference between the sine of `angle` (rad) and the sine from the determinant of the couplers' block
/// that begins at `column`.
fn determinant_error(sample: &Sample, column: usize, angle: fn([f64; 17]) -> f64) -> Option<f64> {
    // l2 l3 = l7 l8 = 2500 mm^2.
    let true_sine = determinant_sine(&passive_block(sample, column), 2500.0);
    Some((angle(sample.theta()).sin() - true_sine).abs())
}

/// Returns sin(right angle - left angle) of a coupler block, from the block's determinant. `length_product` is the
/// product of the couplers' lengths.
fn determinant_sine([a, b, c, d]: &[f64; 4], length_product: f64) -> f64 {
    -(a * d - b * c) / length_product
}

/// Counts a leg's degrees of freedom: as many as its drives.
fn count_leg_freedoms(sample: &Sample) -> f64 {
    crate::mobility::count_left_front_leg_freedoms(&sample.lizard, &sample.solution) as f64
}
