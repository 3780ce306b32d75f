//! The displacement with the smallest frictional work in a small step: a small convex problem.
//!
//! The cost of a pad is its load times the length of its slide; the friction ratio multiplies backward components. A
//! leg on a spring may lag behind its servo at the cost of the spring's energy; a rigid leg does not lag. A sum of
//! lengths has a kink wherever a pad holds, and the minimum usually lies at such kinks. Every length is therefore
//! smoothed to `sqrt(length^2 + eps^2)`, and Newton's method minimises the sum. In stages, eps falls from the size of
//! the slides to a hundred-millionth of it. The result costs at most eps per pad more than the true minimum; the tests
//! check this bound against the dual problem. If the minimum is not unique (two pads against two), the smoothing
//! selects the symmetric solution; [`crate::GroundContact::predict`] detects the displacements that depend on this
//! selection.

use crate::lag_energy::LagEnergy;
use crate::linear::solve_symmetric;

/// A position or a slide of a pad: (forward, left), mm.
pub type Point = [f64; 2];

/// A small displacement of the body: forward and left in mm, counter-clockwise in rad.
pub(crate) type Twist = [f64; 3];

/// Smallest width of the smoothing, relative to the size of the slides.
const MIN_SMOOTHING: f64 = 1e-8;
/// Index of the last stage. Stage 0 smooths over the slides' size, the last stage over `MIN_SMOOTHING` times that size.
const LAST_STAGE: i32 = 5;
/// Index of the first stage if an initial guess is given.
const FIRST_STAGE_WITH_GUESS: i32 = 2;
/// Largest number of Newton steps in a stage; five to eight are usual.
const MAX_NEWTON_STEPS: usize = 40;
/// Largest net force that counts as balanced, relative to the friction of one pad.
const MAX_IMBALANCE: f64 = 1e-9;

/// Smallest reduction of the cost by a Newton step that floating point can resolve, relative to a pad's friction times
/// the size of the slides.
const MIN_REDUCTION: f64 = 1e-23;

/// Largest distance that counts as zero, mm.
const MAX_ZERO_DISTANCE: f64 = 1e-12;

/// The four pads in a small step.
#[derive(Clone, Copy)]
pub(crate) struct Pads {
    /// Positions of the pads in the body frame, mm.
    pub positions: [Point; 4],
    /// Displacements of the pads in the body frame due to their legs' swings, at unchanged lags, mm.
    pub swings: [Point; 4],
    /// Ratio of backward to forward friction.
    pub friction_ratio: f64,
    /// Loads of the pads, relative to the mean.
    pub loads: [f64; 4],
    /// Compliance of legs and servos; `None` if all legs are rigid and all servos follow their pulses exactly.
    pub compliance: Option<Compliance>,
    /// Inertia of body and legs; `None` in a quasi-static step.
    pub inertia: Option<Inertia>,
}

/// The inertia of body and legs, which keep the velocities of the previous step unless forces change them.
#[derive(Clone, Copy)]
pub(crate) struct Inertia {
    /// Inertial force per mm, and torque per rad, by which the body's twist differs from the previous one.
    pub stiffness: Twist,
    /// Twist of the previous step.
    pub previous_twist: Twist,
    /// Inertial force of a leg's mass per mm by which its pad's slide differs from the previous one.
    pub leg_stiffness: f64,
    /// Slides of the pads in the previous step.
    pub previous_slides: [Point; 4],
}

/// The drives of legs that lag behind their servos, or of servos that lag behind their pulses.
#[derive(Clone, Copy)]
pub(crate) struct Compliance {
    /// Derivatives of the pads' positions with respect to their legs' sweeps, mm/rad; a lag has the opposite effect.
    pub sweep_derivatives: [Point; 4],
    /// Lags before the step, rad.
    pub previous_lags: [f64; 4],
    /// Energies of the legs' lags.
    pub lag_energies: [LagEnergy; 4],
}

/// The displacement of body and legs in a small step.
#[derive(Clone, Copy)]
pub(crate) struct Displacement {
    /// Displacement of the body.
    pub twist: Twist,
    /// Lags after the step, rad: each the sum of a leg's and its servo's lag; 0 without compliance.
    pub lags: [f64; 4],
    /// Changes of the lags, rad.
    pub lag_changes: [f64; 4],
}

/// The smoothed cost near a displacement, to second order in the scaled unknowns. A leg's lag affects no other leg, so
/// the lags are eliminated from gradient and Hessian one by one.
struct CostExpansion {
    cost: f64,
    /// Gradient with respect to the twist, with the lags eliminated.
    gradient: [f64; 3],
    /// Hessian with respect to the twist, with the lags eliminated.
    hessian: [[f64; 3]; 3],
    /// Derivatives with respect to each leg's lag, by which the lags were eliminated.
    lag_derivatives: [LagDerivatives; 4],
}

/// The derivatives of the cost with respect to a leg's lag: first, second, and mixed with the twist.
#[derive(Clone, Copy, Default)]
struct LagDerivatives {
    slope: f64,
    curvature: f64,
    mixed: [f64; 3],
}

/// The units that scale all unknowns to the order of 1.
struct Units {
    /// Typical length of a slide, mm.
    slide_size: f64,
    /// Units of the twist: mm, mm and rad.
    twist: Twist,
    /// Units of the lags' changes, rad; 0 without compliance.
    lags: [f64; 4],
}

impl Pads {
    /// Finds the displacement of body and legs with the smallest cost, starting from a guess if there is one.
    pub fn minimise_cost(&self, guess: Option<&Displacement>) -> Displacement {
        let slide_size = max_abs_component(&self.swings).max(self.max_unswept_distance());
        if slide_size < MAX_ZERO_DISTANCE {
            return self.build_displacement([0.0; 3], [0.0; 4]);
        }
        // A turn of one unit moves the farthest pad by about one unit of length.
        let turn_unit = slide_size / max_abs_component(&self.positions);
        let units = Units {
            slide_size,
            twist: [slide_size, slide_size, turn_unit],
            lags: self.compliance.map_or([0.0; 4], |compliance| {
                compliance
                    .sweep_derivatives
                    .map(|[x, y]| slide_size / x.hypot(y))
            }),
        };
        // The scaled unknowns: x is the twist, z are the changes of the lags.
        let ((mut x, mut z), first_stage) = match guess {
            Some(displacement) => (units.scaled_unknowns(displacement), FIRST_STAGE_WITH_GUESS),
            None => (([0.0; 3], [0.0; 4]), 0),
        };
        let mut last_solutions = [None, guess.map(|_| (slide_size * MIN_SMOOTHING, x, z))];
        for stage in first_stage..=LAST_STAGE {
            let eps = slide_size * MIN_SMOOTHING.powf(f64::from(stage) / f64::from(LAST_STAGE));
            let expand_at = |x, z| self.expand(&units.displacement(self, x, z), eps, &units);
            let mut current = expand_at(x, z);
            // The slide of a pad that holds shrinks in proportion to eps, so two stages' solutions can be extrapolated
            // to the next stage. A guess counts as a solution with the smallest eps.
            if let [Some((older_eps, older_x, older_z)), Some((newer_eps, ..))] = last_solutions {
                let step_ratio = (newer_eps - eps) / (older_eps - newer_eps);
                let next_x = std::array::from_fn(|i| x[i] + step_ratio * (x[i] - older_x[i]));
                let next_z = std::array::from_fn(|i| z[i] + step_ratio * (z[i] - older_z[i]));
                let candidate = expand_at(next_x, next_z);
                if candidate.cost < current.cost {
                    (x, z, current) = (next_x, next_z, candidate);
                }
            }
            for _ in 0..MAX_NEWTON_STEPS {
                let lag_slopes = current.lag_derivatives.map(|leg| leg.slope);
                let mut gradient_components = current.gradient.into_iter().chain(lag_slopes);
                if gradient_components.all(|g| g.abs() < MAX_IMBALANCE * slide_size) {
                    break;
                }
                let dx = solve_symmetric(current.hessian, current.gradient);
                let dz = current.lag_derivatives.map(|leg| leg.newton_step(dx));
                let predicted_reduction = dot(dx, current.gradient) + current.lag_reduction();
                if predicted_reduction < MIN_REDUCTION * slide_size {
                    break;
                }
                // Backtracking line search: halves the step until the cost falls, allowing for rounding errors.
                let cost_limit = current.cost * (1.0 + 1e-14);
                let fractions = std::iter::successors(Some(1.0), |fraction| Some(fraction / 2.0));
                let fractions = fractions.take_while(|&fraction| fraction > 1e-9);
                let mut candidates = fractions.map(|fraction: f64| {
                    let next_x = std::array::from_fn(|i| x[i] - fraction * dx[i]);
                    let next_z = std::array::from_fn(|i| z[i] - fraction * dz[i]);
                    (fraction, next_x, next_z, expand_at(next_x, next_z))
                });
                let accepted = candidates.find(|(fraction, _, _, candidate)| {
                    candidate.cost <= cost_limit - 1e-4 * fraction * predicted_reduction
                });
                let Some((_, accepted_x, accepted_z, candidate)) = accepted else {
                    break;
                };
                (x, z, current) = (accepted_x, accepted_z, candidate);
            }
            last_solutions = [last_solutions[1], Some((eps, x, z))];
        }
        units.displacement(self, x, z)
    }

    /// Builds the displacement with this twist and these changes of the lags.
    fn build_displacement(&self, twist: Twist, lag_changes: [f64; 4]) -> Displacement {
        let previous_lags = self
            .compliance
            .map_or([0.0; 4], |compliance| compliance.previous_lags);
        Displacement {
            twist,
            lags: std::array::from_fn(|i| previous_lags[i] + lag_changes[i]),
            lag_changes,
        }
    }

    /// Largest distance that a pad may move in a step in which no servo sweeps, mm: a motor may turn its leg, or a
    /// spring may pull its leg back. A spring can overcome its pad's friction only if pads or springs have changed.
    fn max_unswept_distance(&self) -> f64 {
        let Some(compliance) = &self.compliance else {
            return 0.0;
        };
        let compute_unswept_distance = |i: usize| {
            let ([x, y], lag) = (compliance.sweep_derivatives[i], compliance.previous_lags[i]);
            if let Some(motor) = &compliance.lag_energies[i].motor {
                return x.hypot(y) * motor.unloaded_lag().abs();
            }
            let holding_torque = self.loads[i] * self.friction_ratio.max(1.0) * x.hypot(y);
            match compliance.lag_energies[i].spring_torque(lag) > holding_torque * (1.0 + 1e-6) {
                true => x.hypot(y) * lag.abs(),
                false => 0.0,
            }
        };
        (0..4).map(compute_unswept_distance).fold(0.0, f64::max)
    }

    /// Slide of each pad over the floor, mm.
    pub fn slides(&self, displacement: &Displacement) -> [Point; 4] {
        let [forward, left, turn] = displacement.twist;
        std::array::from_fn(|i| {
            let ([x, y], [dx, dy]) = (self.positions[i], self.swings[i]);
            let [bx, by] = self
                .compliance
                .map_or([0.0; 2], |compliance| compliance.sweep_derivatives[i]);
            let lag_change = displacement.lag_changes[i];
            [
                forward - turn * y + dx - lag_change * bx,
                left + turn * x + dy - lag_change * by,
            ]
        })
    }

    /// Weights of a slide's components, forward and left: a backward component costs `friction_ratio` times as much.
    pub fn slide_weights(&self, slide: Point) -> Point {
        let is_back = slide[0] < 0.0;
        [if is_back { self.friction_ratio } else { 1.0 }, 1.0]
    }

    /// Computes a displacement's smoothed cost with its gradient and Hessian with respect to the scaled unknowns.
    fn expand(&self, displacement: &Displacement, eps: f64, units: &Units) -> CostExpansion {
        let (mut cost, mut gradient, mut hessian) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
        let mut lag_derivatives = [LagDerivatives::default(); 4];
        if let Some(inertia) = &self.inertia {
            for (i, stiffness) in inertia.stiffness.into_iter().enumerate() {
                let deviation = displacement.twist[i] - inertia.previous_twist[i];
                cost += stiffness * deviation * deviation / 2.0;
                gradient[i] += stiffness * deviation * units.twist[i];
                hessian[i][i] += stiffness * units.twist[i] * units.twist[i];
            }
        }
        for (i, slide) in self.slides(displacement).into_iter().enumerate() {
            let ([x, y], load) = (self.positions[i], self.loads[i]);
            let [wx, wy] = self.slide_weights(slide);
            let [ux, uy] = [wx * slide[0], wy * slide[1]];
            let length = (ux * ux + uy * uy + eps * eps).sqrt();
            // Derivatives of the slide with respect to the components of the twist.
            let derivatives = [
                [units.twist[0], 0.0],
                [0.0, units.twist[1]],
                [-y * units.twist[2], x * units.twist[2]],
            ];
            let (leg_stiffness, slide_change) = self.inertia.map_or((0.0, [0.0; 2]), |inertia| {
                let [x, y] = inertia.previous_slides[i];
                (inertia.leg_stiffness, [slide[0] - x, slide[1] - y])
            });
            let length_derivative = |[a, b]: Point| (wx * a * ux + wy * b * uy) / length;
            let with_slope = |row: Point| (row, length_derivative(row));
            let derivatives = derivatives.map(with_slope);
            // Derivatives of the pad's friction cost plus its leg's inertia cost. Each argument is a pair: the
            // derivatives of the slide and of `length` with respect to one unknown.
            let first_derivative =
                |(row, slope): (Point, f64)| load * slope + leg_stiffness * dot(row, slide_change);
            let second_derivative = |(a, a_slope): (Point, f64), (b, b_slope): (Point, f64)| {
                let weighted_product = wx * wx * a[0] * b[0] + wy * wy * a[1] * b[1];
                load * (weighted_product - a_slope * b_slope) / length + leg_stiffness * dot(a, b)
            };
            cost += load * length + leg_stiffness * dot(slide_change, slide_change) / 2.0;
            for i in 0..3 {
                gradient[i] += first_derivative(derivatives[i]);
                for j in 0..3 {
                    hessian[i][j] += second_derivative(derivatives[i], derivatives[j]);
                }
            }
            let Some(compliance) = &self.compliance else {
                continue;
            };
            let lag_unit = units.lags[i];
            let [bx, by] = compliance.sweep_derivatives[i];
            let lag_row = with_slope([-bx * lag_unit, -by * lag_unit]);
            let (lag_energy, lag) = (&compliance.lag_energies[i], displacement.lags[i]);
            let expansion = lag_energy.expand(lag, eps / units.slide_size * lag_unit);
            cost += expansion.energy;
            let lag_curvature = expansion.stiffness * lag_unit * lag_unit;
            let leg = LagDerivatives {
                slope: first_derivative(lag_row) + expansion.torque * lag_unit,
                curvature: second_derivative(lag_row, lag_row) + lag_curvature,
                mixed: derivatives.map(|twist_row| second_derivative(twist_row, lag_row)),
            };
            for (i, mixed) in leg.mixed.into_iter().enumerate() {
                gradient[i] -= mixed * leg.slope / leg.curvature;
                for (entry, other_mixed) in hessian[i].iter_mut().zip(leg.mixed) {
                    *entry -= mixed * other_mixed / leg.curvature;
                }
            }
            lag_derivatives[i] = leg;
        }
        CostExpansion {
            cost,
            gradient,
            hessian,
            lag_derivatives,
        }
    }
}

impl Units {
    /// Converts scaled unknowns to a displacement.
    fn displacement(&self, pads: &Pads, x: [f64; 3], z: [f64; 4]) -> Displacement {
        pads.build_displacement(
            std::array::from_fn(|i| x[i] * self.twist[i]),
            std::array::from_fn(|i| z[i] * self.lags[i]),
        )
    }

    /// Converts a displacement to scaled unknowns: the twist, and the changes of the lags.
    fn scaled_unknowns(&self, displacement: &Displacement) -> ([f64; 3], [f64; 4]) {
        let twist = std::array::from_fn(|i| displacement.twist[i] / self.twist[i]);
        let lag_changes = std::array::from_fn(|i| match self.lags[i] {
            0.0 => 0.0,
            unit => displacement.lag_changes[i] / unit,
        });
        (twist, lag_changes)
    }
}

impl CostExpansion {
    /// First-order reduction of the cost by the Newton steps of the lags at an unchanged twist.
    fn lag_reduction(&self) -> f64 {
        let leg_reduction = |leg: &LagDerivatives| match leg.curvature {
            0.0 => 0.0,
            curvature => leg.slope * leg.slope / curvature,
        };
        self.lag_derivatives.iter().map(leg_reduction).sum()
    }
}

impl LagDerivatives {
    /// Computes the Newton step of the leg's lag for a Newton step of the twist.
    fn newton_step(&self, twist_step: [f64; 3]) -> f64 {
        if self.curvature == 0.0 {
            return 0.0;
        }
        (self.slope - dot(self.mixed, twist_step)) / self.curvature
    }
}

/// Returns the largest absolute value of the points' components.
fn max_abs_component(points: &[Point; 4]) -> f64 {
    let components = points.iter().flatten();
    components.fold(0.0f64, |max, component| max.max(component.abs()))
}

fn dot<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests;
