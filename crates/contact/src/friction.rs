//! The slide that costs the least friction: a small convex problem.
//!
//! Each pad's cost is the length of its slide, stretched by the friction ratio where it
//! slides backward. A leg on a spring may lag behind its servo at the cost of the spring's
//! energy; a rigid leg does not lag. A sum of lengths has kinks at the pads that hold,
//! which are the ones that matter. So every length is rounded off, `sqrt(length^2 +
//! eps^2)`, and the sum is minimised by Newton's method; eps is lowered in stages from
//! the size of the slides to a hundred-millionth of it. The result is above the true
//! minimum by at most eps for each pad; the tests prove that with the dual problem. Where
//! the minimum is not unique (two pads against two), this ends at the point that the
//! rounding favours, which is the symmetric one; [`crate::Ground::predict`] finds the
//! movements that depend on it.

use crate::lag_energy::LagEnergy;
use crate::linear::solve;

/// Position or slide of a pad: forward, left.
pub type Point = [f64; 2];

/// A small movement of the body: forward, left in mm, counter-clockwise in rad.
pub(crate) type Twist = [f64; 3];

/// Smallest rounding over the size of the slides.
const MIN_ROUNDING: f64 = 1e-8;
/// Number of the last stage. Stage 0 rounds by the size of the slides, the last one by `MIN_ROUNDING` times that.
const LAST_STAGE: i32 = 5;
/// The first stage if a guess of the solution is given.
const FIRST_STAGE_WITH_GUESS: i32 = 2;
/// The largest number of Newton steps in a stage; five to eight are usual.
const MAX_STEPS: usize = 40;
/// Largest net force that counts as balance, as a share of one pad's friction.
const MAX_IMBALANCE: f64 = 1e-9;

/// Smallest gain of a Newton step (over a pad's friction times the size of the slides) that
/// floating point can show.
const MIN_GAIN: f64 = 1e-23;

/// The largest distance that counts as zero, mm.
const MAX_STILL_DISTANCE: f64 = 1e-12;

/// The four pads in a small step.
#[derive(Clone, Copy)]
pub(crate) struct Pads {
    /// Positions of the pads in the body frame, mm.
    pub at: [Point; 4],
    /// Swings of the pads in the body frame by their legs, at unchanged lags, mm.
    pub swing: [Point; 4],
    /// Ratio of backward to forward friction.
    pub ratio: f64,
    /// Load of each pad, relative to the mean.
    pub load: [f64; 4],
    /// Drives of the legs that lag; `None` if all drives are rigid and no motor turns a servo.
    pub compliance: Option<Compliance>,
    /// Inertia of body and legs; `None` in a quasi-static step.
    pub body: Option<Inertia>,
}

/// A body and legs that keep the motion of the previous step unless forces change it.
#[derive(Clone, Copy)]
pub(crate) struct Inertia {
    /// Force per mm, and torque per rad, by which the body's movement differs from the previous step.
    pub stiffness: Twist,
    /// Twist of the previous step.
    pub previous_twist: Twist,
    /// Force per mm by which a pad's slide differs from the previous step, from the mass of its leg.
    pub leg_stiffness: f64,
    /// Slides of the pads in the previous step.
    pub slides: [Point; 4],
}

/// The drives of legs that lag behind their servos, or of servos that lag behind their pulses.
#[derive(Clone, Copy)]
pub(crate) struct Compliance {
    /// Derivatives of the pads' positions by the lag, backward, mm/rad.
    pub lag_derivatives: [Point; 4],
    /// Lags before the step, rad.
    pub previous_lags: [f64; 4],
    /// Energies of the legs' lags.
    pub lag_energy: [LagEnergy; 4],
}

/// The movement in a small step.
#[derive(Clone, Copy)]
pub(crate) struct Displacement {
    /// Movement of the body.
    pub twist: Twist,
    /// Lags after the step, rad: each the sum of the lags of leg and servo; 0 without compliance.
    pub lag: [f64; 4],
    /// Changes of the lags, rad.
    pub change: [f64; 4],
}

/// The rounded cost near a displacement, to second order. The lag of a leg affects no other leg, so its row of
/// the Hessian is eliminated directly.
struct CostExpansion {
    cost: f64,
    /// Gradient by the twist, with the lags eliminated.
    gradient: [f64; 3],
    hessian: [[f64; 3]; 3],
    legs: [Row; 4],
}

/// The derivatives of the cost by a leg's lag: the first, the second, and the mixed ones with the twist.
#[derive(Clone, Copy, Default)]
struct Row {
    slope: f64,
    curvature: f64,
    mixed: [f64; 3],
}

/// The units in which all unknowns are near 1.
struct Scale {
    size: f64,
    twist: Twist,
    lag: [f64; 4],
}

impl Pads {
    /// Finds the displacement of the body and the legs with the least cost.
    pub fn minimum(&self) -> Displacement {
        self.minimum_near(None)
    }

    /// Finds the displacement with the least cost, starting at a guess.
    pub fn minimum_near(&self, guess: Option<&Displacement>) -> Displacement {
        let size = largest(&self.swing).max(self.free_move());
        if size < MAX_STILL_DISTANCE {
            return self.displacement_of([0.0; 3], [0.0; 4]);
        }
        // Turns are measured in mm at the pads' radius, slides in units of the swing.
        let scale = Scale {
            size,
            twist: [size, size, size / largest(&self.at)],
            lag: self.compliance.map_or([0.0; 4], |compliance| {
                compliance.lag_derivatives.map(|[x, y]| size / x.hypot(y))
            }),
        };
        let (mut x, mut z, first_stage) = match guess {
            Some(displacement) => (
                scale.scaled_twist(displacement),
                scale.scaled_lag(displacement),
                FIRST_STAGE_WITH_GUESS,
            ),
            None => ([0.0; 3], [0.0; 4], 0),
        };
        let mut solutions = [None, guess.map(|_| (size * MIN_ROUNDING, x, z))];
        for stage in first_stage..=LAST_STAGE {
            let eps = size * MIN_ROUNDING.powf(f64::from(stage) / f64::from(LAST_STAGE));
            let expand_at = |x, z| self.expand(&scale.displacement(self, x, z), eps, &scale);
            let mut current = expand_at(x, z);
            // The slide of a pad that holds shrinks with the rounding, so the solutions of two
            // stages extrapolate to the next one. A guess counts as the last stage's solution.
            if let [Some((older_eps, older_x, older_z)), Some((newer_eps, ..))] = solutions {
                let step_ratio = (newer_eps - eps) / (older_eps - newer_eps);
                let next_x: [f64; 3] =
                    std::array::from_fn(|i| x[i] + step_ratio * (x[i] - older_x[i]));
                let next_z: [f64; 4] =
                    std::array::from_fn(|i| z[i] + step_ratio * (z[i] - older_z[i]));
                let candidate = expand_at(next_x, next_z);
                if candidate.cost < current.cost {
                    (x, z, current) = (next_x, next_z, candidate);
                }
            }
            for _ in 0..MAX_STEPS {
                let slopes = current.gradient.into_iter();
                let slopes = slopes.chain(current.legs.map(|leg| leg.slope));
                if slopes.map(f64::abs).all(|g| g < MAX_IMBALANCE * size) {
                    break;
                }
                let dx = solve(current.hessian, current.gradient);
                let dz = current.legs.map(|leg| leg.newton_step(dx));
                let slope = dot(dx, current.gradient) + current.predicted_gain();
                if slope < MIN_GAIN * size {
                    break;
                }
                let point_at = |share: f64| {
                    let x: [f64; 3] = std::array::from_fn(|i| x[i] - share * dx[i]);
                    let z: [f64; 4] = std::array::from_fn(|i| z[i] - share * dz[i]);
                    (x, z)
                };
                // Halve the step until the cost falls, within rounding.
                let cost_limit = current.cost * (1.0 + 1e-14);
                let shares = std::iter::successors(Some(1.0), |share| Some(share / 2.0));
                let mut candidates = shares.take_while(|&share| share > 1e-9).map(|share| {
                    let (x, z) = point_at(share);
                    (share, x, z, expand_at(x, z))
                });
                let accepted = candidates.find(|(share, _, _, candidate)| {
                    candidate.cost <= cost_limit - 1e-4 * share * slope
                });
                let Some((_, accepted_x, accepted_z, candidate)) = accepted else {
                    break;
                };
                (x, z, current) = (accepted_x, accepted_z, candidate);
            }
            solutions = [solutions[1], Some((eps, x, z))];
        }
        scale.displacement(self, x, z)
    }

    /// The displacement with this twist and these changes of the lags.
    fn displacement_of(&self, twist: Twist, change: [f64; 4]) -> Displacement {
        let previous_lags = self
            .compliance
            .map_or([0.0; 4], |compliance| compliance.previous_lags);
        Displacement {
            twist,
            lag: std::array::from_fn(|i| previous_lags[i] + change[i]),
            change,
        }
    }

    /// Largest distance that a pad may move in a step in which no leg swings, mm: a motor may turn its leg, or a
    /// spring may pull its leg back. A spring pulls harder than the pad holds only after a change of pads or
    /// springs.
    fn free_move(&self) -> f64 {
        let Some(compliance) = &self.compliance else {
            return 0.0;
        };
        let jump_of = |i: usize| {
            if let Some(motor) = &compliance.lag_energy[i].motor {
                let [x, y] = compliance.lag_derivatives[i];
                return x.hypot(y) * motor.unloaded_end().abs();
            }
            let ([x, y], lag) = (compliance.lag_derivatives[i], compliance.previous_lags[i]);
            let held_torque = self.load[i] * self.ratio.max(1.0) * x.hypot(y);
            match compliance.lag_energy[i].spring_torque(lag) > held_torque * (1.0 + 1e-6) {
                true => x.hypot(y) * lag.abs(),
                false => 0.0,
            }
        };
        (0..4).map(jump_of).fold(0.0, f64::max)
    }

    /// The slide of each pad over the floor.
    pub fn slides(&self, displacement: &Displacement) -> [Point; 4] {
        let [forward, left, turn] = displacement.twist;
        std::array::from_fn(|i| {
            let ([x, y], [dx, dy]) = (self.at[i], self.swing[i]);
            let [bx, by] = self
                .compliance
                .map_or([0.0; 2], |compliance| compliance.lag_derivatives[i]);
            let change = displacement.change[i];
            [
                forward - turn * y + dx - change * bx,
                left + turn * x + dy - change * by,
            ]
        })
    }

    /// Weights of a slide's components, forward and left: a backward slide costs `ratio` times as much.
    pub fn weight(&self, slide: Point) -> Point {
        [if slide[0] < 0.0 { self.ratio } else { 1.0 }, 1.0]
    }

    /// Computes the rounded cost of a displacement, its gradient and its Hessian by the scaled
    /// unknowns.
    fn expand(&self, displacement: &Displacement, eps: f64, scale: &Scale) -> CostExpansion {
        let (mut cost, mut gradient, mut hessian) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
        let mut legs = [Row::default(); 4];
        if let Some(Inertia {
            stiffness,
            previous_twist,
            ..
        }) = self.body
        {
            for i in 0..3 {
                let error = displacement.twist[i] - previous_twist[i];
                cost += stiffness[i] * error * error / 2.0;
                gradient[i] += stiffness[i] * error * scale.twist[i];
                hessian[i][i] += stiffness[i] * scale.twist[i] * scale.twist[i];
            }
        }
        for (i, slide) in self.slides(displacement).into_iter().enumerate() {
            let ([x, y], load) = (self.at[i], self.load[i]);
            let [wx, wy] = self.weight(slide);
            let [ux, uy] = [wx * slide[0], wy * slide[1]];
            let length = (ux * ux + uy * uy + eps * eps).sqrt();
            // Derivatives of the slide by each unknown.
            let rows = [
                [scale.twist[0], 0.0],
                [0.0, scale.twist[1]],
                [-y * scale.twist[2], x * scale.twist[2]],
            ];
            let (inertia, change) = self.body.map_or((0.0, [0.0; 2]), |body| {
                let previous_slide = body.slides[i];
                (
                    body.leg_stiffness,
                    [slide[0] - previous_slide[0], slide[1] - previous_slide[1]],
                )
            });
            let slope_of = |[a, b]: Point| (wx * a * ux + wy * b * uy) / length;
            // Derivative of the pad's friction and of its leg's inertia by an unknown.
            let pull_of = |row: Point| load * slope_of(row) + inertia * dot(row, change);
            let bend_of = |a: Point, b: Point| {
                let weighted_product = wx * wx * a[0] * b[0] + wy * wy * a[1] * b[1];
                load * (weighted_product - slope_of(a) * slope_of(b)) / length + inertia * dot(a, b)
            };
            cost += load * length + inertia * dot(change, change) / 2.0;
            for i in 0..3 {
                gradient[i] += pull_of(rows[i]);
                for j in 0..3 {
                    hessian[i][j] += bend_of(rows[i], rows[j]);
                }
            }
            let Some(compliance) = &self.compliance else {
                continue;
            };
            let unit = scale.lag[i];
            let [bx, by] = compliance.lag_derivatives[i];
            let row = [-bx * unit, -by * unit];
            let (energy, torque, stiffness) =
                compliance.lag_energy[i].expand(displacement.lag[i], eps / scale.size * unit);
            cost += energy;
            let leg = Row {
                slope: pull_of(row) + torque * unit,
                curvature: bend_of(row, row) + stiffness * unit * unit,
                mixed: rows.map(|twist_row| bend_of(twist_row, row)),
            };
            for (i, mixed) in leg.mixed.into_iter().enumerate() {
                gradient[i] -= mixed * leg.slope / leg.curvature;
                for (cell, other_mixed) in hessian[i].iter_mut().zip(leg.mixed) {
                    *cell -= mixed * other_mixed / leg.curvature;
                }
            }
            legs[i] = leg;
        }
        CostExpansion {
            cost,
            gradient,
            hessian,
            legs,
        }
    }
}

impl Scale {
    /// Converts scaled unknowns to a displacement.
    fn displacement(&self, pads: &Pads, x: [f64; 3], z: [f64; 4]) -> Displacement {
        pads.displacement_of(
            std::array::from_fn(|i| x[i] * self.twist[i]),
            std::array::from_fn(|i| z[i] * self.lag[i]),
        )
    }

    /// Converts the twist of a displacement to scaled unknowns.
    fn scaled_twist(&self, displacement: &Displacement) -> [f64; 3] {
        std::array::from_fn(|i| displacement.twist[i] / self.twist[i])
    }

    /// Converts a displacement's changes of the lags to scaled unknowns.
    fn scaled_lag(&self, displacement: &Displacement) -> [f64; 4] {
        std::array::from_fn(|i| match self.lag[i] {
            0.0 => 0.0,
            unit => displacement.change[i] / unit,
        })
    }
}

impl CostExpansion {
    /// First-order reduction of the cost by the Newton steps of the lags, without the share of the twist.
    fn predicted_gain(&self) -> f64 {
        let reduction_of = |leg: &Row| match leg.curvature {
            0.0 => 0.0,
            curvature => leg.slope * leg.slope / curvature,
        };
        self.legs.iter().map(reduction_of).sum()
    }
}

impl Row {
    /// Newton step of the leg's lag that belongs to this step of the twist.
    fn newton_step(&self, twist: [f64; 3]) -> f64 {
        if self.curvature == 0.0 {
            return 0.0;
        }
        (self.slope - dot(self.mixed, twist)) / self.curvature
    }
}

fn largest(points: &[Point; 4]) -> f64 {
    let components = points.iter().flatten();
    components.fold(0.0f64, |max, component| max.max(component.abs()))
}

fn dot<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests;
