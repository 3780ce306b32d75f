//! The slide that costs the least friction: a small convex problem.
//!
//! Each pad's cost is the length of its slide, stretched by the friction ratio
//! where it slides backward. A sum of lengths has kinks just where it matters,
//! at the pads that hold. So every length is rounded off,
//! `sqrt(length^2 + eps^2)`, minimised by Newton's method, and eps is lowered a
//! decade at a time from the size of the slides to a hundred-millionth of it. What is
//! left is at most eps for each pad above the true minimum, which the dual
//! problem proves in the tests. Where the minimum is not unique (two pads
//! against two), this ends at the point that the rounding favours, which is the
//! symmetric one; [`crate::Ground::predict`] finds out where that matters.

/// Position or slide of a pad: forward, left.
pub(crate) type Point = [f64; 2];

/// How the body moves: forward, left in mm, counter-clockwise in rad.
pub(crate) type Twist = [f64; 3];

/// Decades between the first rounding and the last.
const DECADES: i32 = 8;
/// Newton steps for each decade; five or six are usual.
const STEPS: usize = 40;
/// Forces (in units of one pad's friction) that count as balanced.
const BALANCED: f64 = 1e-9;

/// Pads on the floor.
pub(crate) struct Pads {
    /// Where they are in the body frame, mm.
    pub at: [Point; 4],
    /// How far their legs swing them in the body frame, mm.
    pub swing: [Point; 4],
    /// Friction backward over forward.
    pub ratio: f64,
    /// Weight that each pad carries, over the mean.
    pub load: [f64; 4],
}

impl Pads {
    /// The motion of the body that drags the pads over the floor at least cost.
    pub fn least(&self) -> Twist {
        let size = self
            .swing
            .iter()
            .flatten()
            .fold(0.0f64, |size, part| size.max(part.abs()));
        let radius = self
            .at
            .iter()
            .flatten()
            .fold(0.0f64, |radius, part| radius.max(part.abs()));
        if size == 0.0 {
            return [0.0; 3];
        }
        // Turns are counted in mm at this radius, slides in units of the swing,
        // so that all unknowns are near 1.
        let scale = [size, size, size / radius];
        let scaled = |x: Twist| -> Twist { std::array::from_fn(|i| x[i] * scale[i]) };
        let mut x = [0.0; 3];
        for decade in 0..=DECADES {
            let eps = size * 10f64.powi(-decade);
            for _ in 0..STEPS {
                let (cost, gradient, hessian) = self.expand(scaled(x), eps, scale);
                if gradient.iter().all(|g| g.abs() < BALANCED * size) {
                    break;
                }
                let step = solve(hessian, gradient);
                let slope: f64 = step.iter().zip(gradient).map(|(s, g)| s * g).sum();
                let at = |share: f64| -> Twist { std::array::from_fn(|i| x[i] - share * step[i]) };
                // Halve until the cost falls, as far as rounding lets one see.
                let mut share = 1.0;
                let falls = |share: f64| {
                    self.expand(scaled(at(share)), eps, scale).0
                        <= cost * (1.0 + 1e-14) - 1e-4 * share * slope
                };
                while share > 1e-9 && !falls(share) {
                    share /= 2.0;
                }
                x = at(share);
            }
        }
        scaled(x)
    }

    /// The slide of each pad over the floor.
    pub fn slides(&self, twist: Twist) -> [Point; 4] {
        let [forward, left, turn] = twist;
        std::array::from_fn(|i| {
            let ([x, y], [dx, dy]) = (self.at[i], self.swing[i]);
            [forward - turn * y + dx, left + turn * x + dy]
        })
    }

    /// How much a slide's parts weigh: backward slides by the ratio.
    pub fn weight(&self, slide: Point) -> Point {
        [if slide[0] < 0.0 { self.ratio } else { 1.0 }, 1.0]
    }

    /// The rounded cost of a twist, its gradient and its Hessian by the scaled
    /// unknowns.
    fn expand(&self, twist: Twist, eps: f64, scale: Twist) -> (f64, [f64; 3], [[f64; 3]; 3]) {
        let (mut cost, mut gradient, mut hessian) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
        for (i, slide) in self.slides(twist).into_iter().enumerate() {
            let ([x, y], load) = (self.at[i], self.load[i]);
            let [wx, wy] = self.weight(slide);
            let [ux, uy] = [wx * slide[0], wy * slide[1]];
            let length = (ux * ux + uy * uy + eps * eps).sqrt();
            // Rows: how each unknown moves the weighted slide.
            let rows = [
                [wx * scale[0], 0.0],
                [0.0, wy * scale[1]],
                [-wx * y * scale[2], wy * x * scale[2]],
            ];
            let along = rows.map(|[a, b]| (a * ux + b * uy) / length);
            cost += load * length;
            for i in 0..3 {
                gradient[i] += load * along[i];
                for j in 0..3 {
                    let dot = rows[i][0] * rows[j][0] + rows[i][1] * rows[j][1];
                    hessian[i][j] += load * (dot - along[i] * along[j]) / length;
                }
            }
        }
        (cost, gradient, hessian)
    }
}

/// Solves a symmetric 3x3 system by Gauss with pivots. A direction without
/// curvature is left alone: there the cost is flat and any point will do.
fn solve(mut a: [[f64; 3]; 3], mut b: [f64; 3]) -> [f64; 3] {
    let largest = (0..3).fold(0.0f64, |largest, i| largest.max(a[i][i]));
    for (i, row) in a.iter_mut().enumerate() {
        row[i] += largest * 1e-15;
    }
    for column in 0..3 {
        let pivot = (column..3)
            .max_by(|&i, &j| a[i][column].abs().total_cmp(&a[j][column].abs()))
            .unwrap_or(column);
        a.swap(column, pivot);
        b.swap(column, pivot);
        for row in column + 1..3 {
            let factor = a[row][column] / a[column][column];
            let above = a[column];
            for (cell, up) in a[row].iter_mut().zip(above) {
                *cell -= factor * up;
            }
            b[row] -= factor * b[column];
        }
    }
    let mut x = [0.0; 3];
    for row in (0..3).rev() {
        let known: f64 = (row + 1..3).map(|column| a[row][column] * x[column]).sum();
        x[row] = (b[row] - known) / a[row][row];
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const EVEN: [f64; 4] = [1.0; 4];
    const AT: [Point; 4] = [[55.0, 80.0], [55.0, -80.0], [-55.0, -80.0], [-55.0, 80.0]];

    fn cost(pads: &Pads, twist: Twist) -> f64 {
        let length = |slide: Point| {
            let w = pads.weight(slide);
            (w[0] * slide[0]).hypot(w[1] * slide[1])
        };
        let lengths = pads.slides(twist).into_iter().map(length);
        lengths
            .zip(pads.load)
            .map(|(length, load)| load * length)
            .sum()
    }

    /// The lower bound of duality: forces within the pads' friction that balance
    /// each other do at least `sum f . swing` of work, whatever the body does.
    /// The forces at a twist, if they balance, prove how far its cost is from
    /// the least. Returns their imbalance and that distance.
    fn certificate(pads: &Pads, twist: Twist) -> ([f64; 3], f64) {
        let size = pads
            .swing
            .iter()
            .flatten()
            .fold(0.0f64, |a, b| a.max(b.abs()));
        let eps = size * 10f64.powi(-DECADES);
        let (mut work, mut net) = (0.0, [0.0; 3]);
        for (i, slide) in pads.slides(twist).into_iter().enumerate() {
            let w = pads.weight(slide);
            let length = (w[0] * slide[0]).hypot(w[1] * slide[1]).hypot(eps);
            let force = [w[0] * w[0] * slide[0] / length, w[1] * slide[1] / length];
            assert!(
                (force[0] / w[0]).hypot(force[1]) <= 1.0 + 1e-12,
                "a pad cannot hold that"
            );
            let force = force.map(|part| pads.load[i] * part);
            work += force[0] * pads.swing[i][0] + force[1] * pads.swing[i][1];
            net[0] += force[0];
            net[1] += force[1];
            net[2] += (pads.at[i][0] * force[1] - pads.at[i][1] * force[0]) / 100.0;
        }
        (net, cost(pads, twist) - work)
    }

    fn assert_least(pads: &Pads) {
        let size = pads
            .swing
            .iter()
            .flatten()
            .fold(0.0f64, |a, b| a.max(b.abs()));
        let (net, gap) = certificate(pads, pads.least());
        assert!(
            net.iter().all(|part| part.abs() < 1e-5),
            "forces out of balance: {net:?}"
        );
        assert!(gap.abs() < 1e-5 * size, "gap {gap}");
    }

    #[test]
    fn nearly_two_against_two_is_still_decided_rightly() {
        // A sine walk: at each instant two legs go one way about as fast as two
        // go the other, so that only lever arms decide.
        for step in 0..1000 {
            let (from, to) = (f64::from(step), f64::from(step + 1));
            let foot = |i: usize, step: f64| {
                let start = [0.25, 0.75, 0.5, 0.0][i];
                let psi = 0.35 * ((step / 1000.0 - start) * std::f64::consts::TAU).cos();
                let side = [1.0, -1.0, -1.0, 1.0][i];
                [
                    [55.0, 55.0, -55.0, -55.0][i] + 45.0 * psi.sin(),
                    side * (35.0 + 45.0 * psi.cos()),
                ]
            };
            let at = std::array::from_fn(|i| foot(i, (from + to) / 2.0));
            let swing = std::array::from_fn(|i| {
                let (a, b) = (foot(i, from), foot(i, to));
                [b[0] - a[0], b[1] - a[1]]
            });
            assert_least(&Pads {
                at,
                swing,
                ratio: 1.0,
                load: EVEN,
            });
        }
    }

    #[test]
    fn three_pads_that_agree_hold_and_the_fourth_slides() {
        for odd in 0..4 {
            let mut swing = [[-1.0, 0.0]; 4];
            swing[odd] = [3.0, 0.0];
            let twist = Pads {
                at: AT,
                swing,
                ratio: 1.0,
                load: EVEN,
            }
            .least();
            assert!(
                (twist[0] - 1.0).abs() < 1e-7 && twist[1].abs() < 1e-7 && twist[2].abs() < 1e-9,
                "{twist:?}"
            );
        }
    }

    #[test]
    fn a_single_pad_that_swings_alone_moves_nothing() {
        let twist = Pads {
            at: AT,
            swing: [[5.0, 1.0], [0.0; 2], [0.0; 2], [0.0; 2]],
            ratio: 1.0,
            load: EVEN,
        }
        .least();
        assert!(twist.iter().all(|part| part.abs() < 1e-7), "{twist:?}");
    }

    #[test]
    fn legs_that_swing_against_each_other_turn_the_body() {
        // Pads that move as a rigid turn by 0.01 rad are followed exactly.
        let swing = AT.map(|[x, y]| [0.01 * y, -0.01 * x]);
        let twist = Pads {
            at: AT,
            swing,
            ratio: 1.0,
            load: EVEN,
        }
        .least();
        assert!((twist[2] - 0.01).abs() < 1e-9 && twist[0].abs() < 1e-7 && twist[1].abs() < 1e-7);
    }

    fn point(size: f64) -> impl Strategy<Value = Point> {
        [-size..size, -size..size]
    }

    proptest! {
        #[test]
        fn no_twist_costs_less_than_the_balanced_forces_prove(
            jitter in prop::array::uniform4(point(20.0)),
            swing in prop::array::uniform4(point(5.0)),
            ratio in 0.5f64..2.0,
            load in prop::array::uniform4(0.8f64..1.2),
        ) {
            let at = std::array::from_fn(|i| [AT[i][0] + jitter[i][0], AT[i][1] + jitter[i][1]]);
            assert_least(&Pads { at, swing, ratio, load });
        }

        #[test]
        fn no_twist_nearby_costs_less(
            swing in prop::array::uniform4(point(5.0)),
            nudge in prop::array::uniform3(-1.0f64..1.0),
            size in -6i32..1,
            load in prop::array::uniform4(0.8f64..1.2),
        ) {
            let pads = Pads { at: AT, swing, ratio: 1.3, load };
            let twist = pads.least();
            let scale = 10f64.powi(size);
            let other = [twist[0] + scale * nudge[0], twist[1] + scale * nudge[1], twist[2] + scale * nudge[2] / 80.0];
            prop_assert!(cost(&pads, twist) <= cost(&pads, other) + 1e-6);
        }
    }
}
