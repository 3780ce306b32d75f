//! The slide that costs the least friction: a small convex problem.
//!
//! Each pad's cost is the length of its slide, stretched by the friction ratio where it
//! slides backward. A leg on a spring may lag behind its servo, which costs the spring's
//! energy; a rigid leg does not lag. A sum of lengths has kinks at the pads that hold,
//! which are the ones that matter. So every length is rounded off, `sqrt(length^2 +
//! eps^2)`, and the sum is minimised by Newton's method; eps is lowered in stages from
//! the size of the slides to a hundred-millionth of it. The result is above the true
//! minimum by at most eps for each pad; the tests prove that with the dual problem. Where
//! the minimum is not unique (two pads against two), this ends at the point that the
//! rounding favours, which is the symmetric one; [`crate::Ground::predict`] finds out
//! where that matters.

use crate::linear::solve;
use crate::yields::Yield;

/// Position or slide of a pad: forward, left.
pub type Point = [f64; 2];

/// How the body moves: forward, left in mm, counter-clockwise in rad.
pub(crate) type Twist = [f64; 3];

/// The last rounding over the size of the slides.
const SMALLEST: f64 = 1e-8;
/// Stages from the first rounding, the size of the slides, to the last.
const STAGES: i32 = 5;
/// The stage to begin with where the answer is nearly known.
const NEARLY: i32 = 2;
/// Newton steps for each stage; five to eight are usual.
const STEPS: usize = 40;
/// Forces (in units of one pad's friction) that count as balanced.
const BALANCED: f64 = 1e-9;

/// A Newton step that gains less than this (of a pad's friction times the size of
/// the slides) gains nothing that numbers can show.
const LEAST_GAIN: f64 = 1e-23;

/// Pads on the floor.
#[derive(Clone, Copy)]
pub(crate) struct Pads {
    /// Where they are in the body frame, mm.
    pub at: [Point; 4],
    /// How far their legs swing them in the body frame if their lags stay as they
    /// are, mm.
    pub swing: [Point; 4],
    /// Friction backward over forward.
    pub ratio: f64,
    /// Weight that each pad carries, over the mean.
    pub load: [f64; 4],
    /// How the legs give way; none where they are rigid.
    pub give: Option<Give>,
}

/// Legs that lag behind their servos.
#[derive(Clone, Copy)]
pub(crate) struct Give {
    /// How far each pad is back for a radian of lag, mm.
    pub along: [Point; 4],
    /// The lags before the step, rad.
    pub before: [f64; 4],
    /// What each leg's lag costs.
    pub yields: [Yield; 4],
}

/// What the pads do.
#[derive(Clone, Copy)]
pub(crate) struct Displacement {
    /// How the body moves.
    pub twist: Twist,
    /// How far each leg lags behind its servo after it, rad; 0 where legs are rigid.
    pub lag: [f64; 4],
    /// By how much that is more than before, rad.
    pub change: [f64; 4],
}

/// The rounded cost of a displacement around it. A leg's lag touches no other leg, so
/// its row of the Hessian is eliminated at once.
struct Expansion {
    cost: f64,
    /// By the twist, lags eliminated.
    gradient: [f64; 3],
    hessian: [[f64; 3]; 3],
    legs: [Row; 4],
}

/// A leg's row: slope and curvature by its lag, and how both unknowns mix.
#[derive(Clone, Copy, Default)]
struct Row {
    slope: f64,
    curvature: f64,
    mixed: [f64; 3],
}

/// Units in which all unknowns are near 1.
struct Scale {
    size: f64,
    twist: Twist,
    lag: [f64; 4],
}

impl Pads {
    /// The displacement of the body and the legs that drags the pads over the floor at
    /// least cost.
    pub fn least(&self) -> Displacement {
        self.least_from(None)
    }

    /// The same, with a displacement to begin with that is nearly the answer.
    pub fn least_from(&self, guess: Option<&Displacement>) -> Displacement {
        let size = largest(&self.swing).max(self.springs_back());
        if size == 0.0 {
            return self.moved([0.0; 3], [0.0; 4]);
        }
        // Turns are counted in mm at the pads' radius, slides in units of the swing.
        let scale = Scale {
            size,
            twist: [size, size, size / largest(&self.at)],
            lag: self
                .give
                .map_or([0.0; 4], |give| give.along.map(|[x, y]| size / x.hypot(y))),
        };
        let (mut x, mut z, first) = match guess {
            Some(displacement) => (
                scale.of_twist(displacement),
                scale.of_lag(displacement),
                NEARLY,
            ),
            None => ([0.0; 3], [0.0; 4], 0),
        };
        for stage in first..=STAGES {
            let eps = size * SMALLEST.powf(f64::from(stage) / f64::from(STAGES));
            for _ in 0..STEPS {
                let here = self.expand(&scale.displacement(self, x, z), eps, &scale);
                let steep = here.gradient.into_iter();
                let steep = steep.chain(here.legs.map(|leg| leg.slope));
                if steep.map(f64::abs).all(|g| g < BALANCED * size) {
                    break;
                }
                let dx = solve(here.hessian, here.gradient);
                let dz = here.legs.map(|leg| leg.step(dx));
                let slope = dot(dx, here.gradient) + here.gained();
                if slope < LEAST_GAIN * size {
                    break;
                }
                let at = |share: f64| {
                    let x: [f64; 3] = std::array::from_fn(|i| x[i] - share * dx[i]);
                    let z: [f64; 4] = std::array::from_fn(|i| z[i] - share * dz[i]);
                    (x, z)
                };
                // Halve until the cost falls, as far as rounding lets one see.
                let mut share = 1.0;
                let falls = |share: f64| {
                    let (x, z) = at(share);
                    self.expand(&scale.displacement(self, x, z), eps, &scale)
                        .cost
                        <= here.cost * (1.0 + 1e-14) - 1e-4 * share * slope
                };
                while share > 1e-9 && !falls(share) {
                    share /= 2.0;
                }
                if share <= 1e-9 {
                    break;
                }
                (x, z) = at(share);
            }
        }
        scale.displacement(self, x, z)
    }

    /// The displacement with this twist, and with lags that change by so much.
    fn moved(&self, twist: Twist, change: [f64; 4]) -> Displacement {
        let before = self.give.map_or([0.0; 4], |give| give.before);
        Displacement {
            twist,
            lag: std::array::from_fn(|i| before[i] + change[i]),
            change,
        }
    }

    /// How far a leg may jump back, mm, since its spring pulls harder than its pad
    /// can hold: 0 unless pads or springs were changed.
    fn springs_back(&self) -> f64 {
        let Some(give) = &self.give else { return 0.0 };
        let back = |i: usize| {
            let ([x, y], lag) = (give.along[i], give.before[i]);
            let holds = self.load[i] * self.ratio.max(1.0) * x.hypot(y);
            match give.yields[i].pulls(lag) > holds * (1.0 + 1e-6) {
                true => x.hypot(y) * lag.abs(),
                false => 0.0,
            }
        };
        (0..4).map(back).fold(0.0, f64::max)
    }

    /// The slide of each pad over the floor.
    pub fn slides(&self, displacement: &Displacement) -> [Point; 4] {
        let [forward, left, turn] = displacement.twist;
        std::array::from_fn(|i| {
            let ([x, y], [dx, dy]) = (self.at[i], self.swing[i]);
            let [bx, by] = self.give.map_or([0.0; 2], |give| give.along[i]);
            let back = displacement.change[i];
            [
                forward - turn * y + dx - back * bx,
                left + turn * x + dy - back * by,
            ]
        })
    }

    /// How much a slide's parts weigh: backward slides by the ratio.
    pub fn weight(&self, slide: Point) -> Point {
        [if slide[0] < 0.0 { self.ratio } else { 1.0 }, 1.0]
    }

    /// The rounded cost of a displacement, its gradient and its Hessian by the scaled
    /// unknowns.
    fn expand(&self, displacement: &Displacement, eps: f64, scale: &Scale) -> Expansion {
        let (mut cost, mut gradient, mut hessian) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
        let mut legs = [Row::default(); 4];
        for (i, slide) in self.slides(displacement).into_iter().enumerate() {
            let ([x, y], load) = (self.at[i], self.load[i]);
            let [wx, wy] = self.weight(slide);
            let [ux, uy] = [wx * slide[0], wy * slide[1]];
            let length = (ux * ux + uy * uy + eps * eps).sqrt();
            // Rows: how each unknown moves the weighted slide.
            let rows = [
                [wx * scale.twist[0], 0.0],
                [0.0, wy * scale.twist[1]],
                [-wx * y * scale.twist[2], wy * x * scale.twist[2]],
            ];
            let slope = |[a, b]: Point| (a * ux + b * uy) / length;
            let along = rows.map(slope);
            cost += load * length;
            for i in 0..3 {
                gradient[i] += load * along[i];
                for j in 0..3 {
                    let dot = rows[i][0] * rows[j][0] + rows[i][1] * rows[j][1];
                    hessian[i][j] += load * (dot - along[i] * along[j]) / length;
                }
            }
            let Some(give) = &self.give else { continue };
            let unit = scale.lag[i];
            let [bx, by] = give.along[i];
            let row = [-wx * bx * unit, -wy * by * unit];
            let back = slope(row);
            let (energy, torque, stiffness) =
                give.yields[i].expand(displacement.lag[i], eps / scale.size * unit);
            cost += energy;
            let leg = Row {
                slope: load * back + torque * unit,
                curvature: load * (row[0] * row[0] + row[1] * row[1] - back * back) / length
                    + stiffness * unit * unit,
                mixed: std::array::from_fn(|k| {
                    load * (rows[k][0] * row[0] + rows[k][1] * row[1] - along[k] * back) / length
                }),
            };
            for (i, mixed) in leg.mixed.into_iter().enumerate() {
                gradient[i] -= mixed * leg.slope / leg.curvature;
                for (cell, other) in hessian[i].iter_mut().zip(leg.mixed) {
                    *cell -= mixed * other / leg.curvature;
                }
            }
            legs[i] = leg;
        }
        Expansion {
            cost,
            gradient,
            hessian,
            legs,
        }
    }
}

impl Scale {
    /// A displacement in its own units.
    fn displacement(&self, pads: &Pads, x: [f64; 3], z: [f64; 4]) -> Displacement {
        pads.moved(
            std::array::from_fn(|i| x[i] * self.twist[i]),
            std::array::from_fn(|i| z[i] * self.lag[i]),
        )
    }

    /// The twist of a displacement in these units.
    fn of_twist(&self, displacement: &Displacement) -> [f64; 3] {
        std::array::from_fn(|i| displacement.twist[i] / self.twist[i])
    }

    /// The lags of a displacement in these units, as changes.
    fn of_lag(&self, displacement: &Displacement) -> [f64; 4] {
        std::array::from_fn(|i| match self.lag[i] {
            0.0 => 0.0,
            unit => displacement.change[i] / unit,
        })
    }
}

impl Expansion {
    /// What the legs' own steps gain, to first order, besides that of the twist.
    fn gained(&self) -> f64 {
        let own = |leg: &Row| match leg.curvature {
            0.0 => 0.0,
            curvature => leg.slope * leg.slope / curvature,
        };
        self.legs.iter().map(own).sum()
    }
}

impl Row {
    /// The leg's step together with this step of the twist.
    fn step(&self, twist: [f64; 3]) -> f64 {
        if self.curvature == 0.0 {
            return 0.0;
        }
        (self.slope - dot(self.mixed, twist)) / self.curvature
    }
}

fn largest(points: &[Point; 4]) -> f64 {
    let parts = points.iter().flatten();
    parts.fold(0.0f64, |most, part| most.max(part.abs()))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    use crate::yields::{Side, Stretch};

    const EVEN: [f64; 4] = [1.0; 4];
    /// More than a pad at the end of a leg of 45 mm can push.
    const STOP: f64 = 250.0;
    const AT: [Point; 4] = [[55.0, 80.0], [55.0, -80.0], [-55.0, -80.0], [-55.0, 80.0]];

    /// The friction's work and the springs' energy.
    fn cost(pads: &Pads, displacement: &Displacement) -> f64 {
        let length = |slide: Point| {
            let w = pads.weight(slide);
            (w[0] * slide[0]).hypot(w[1] * slide[1])
        };
        let slides = pads.slides(displacement).into_iter().zip(pads.load);
        let friction: f64 = slides.map(|(slide, load)| load * length(slide)).sum();
        let energy = |give: Give| -> f64 {
            let each = displacement.lag.iter();
            each.zip(give.yields)
                .map(|(lag, drive)| drive.expand(*lag, 0.0).0)
                .sum()
        };
        friction + pads.give.map_or(0.0, energy)
    }

    /// The lower bound of duality: forces within the pads' friction that balance
    /// each other do at least `sum f . swing` of work, whatever the body does, less
    /// what their torques can gain on the springs. The forces at a displacement, if they
    /// balance, prove how far its cost is from the least. Returns their imbalance
    /// and that distance.
    fn certificate(pads: &Pads, displacement: &Displacement) -> ([f64; 3], f64) {
        let eps = largest(&pads.swing) * SMALLEST;
        let (mut work, mut net) = (0.0, [0.0; 3]);
        for (i, slide) in pads.slides(displacement).into_iter().enumerate() {
            let w = pads.weight(slide);
            let length = (w[0] * slide[0]).hypot(w[1] * slide[1]).hypot(eps);
            let force = [w[0] * w[0] * slide[0] / length, w[1] * slide[1] / length];
            assert!(
                (force[0] / w[0]).hypot(force[1]) <= 1.0 + 1e-12,
                "a pad cannot hold that"
            );
            let force = force.map(|part| pads.load[i] * part);
            let along = |[x, y]: Point| force[0] * x + force[1] * y;
            work += along(pads.swing[i]);
            if let Some(give) = pads.give {
                let torque = along(give.along[i]);
                work += torque * give.before[i] - give.yields[i].conjugate(torque);
            }
            net[0] += force[0];
            net[1] += force[1];
            net[2] += (pads.at[i][0] * force[1] - pads.at[i][1] * force[0]) / 100.0;
        }
        (net, cost(pads, displacement) - work)
    }

    fn assert_least(pads: &Pads) {
        let (net, gap) = certificate(pads, &pads.least());
        assert!(
            net.iter().all(|part| part.abs() < 1e-5),
            "forces out of balance: {net:?}"
        );
        assert!(gap.abs() < 1e-5 * largest(&pads.swing), "gap {gap}");
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
                give: None,
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
                give: None,
            }
            .least()
            .twist;
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
            give: None,
        }
        .least()
        .twist;
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
            give: None,
        }
        .least()
        .twist;
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
            assert_least(&Pads { at, swing, ratio, load, give: None });
        }

        #[test]
        fn no_twist_nearby_costs_less(
            swing in prop::array::uniform4(point(5.0)),
            nudge in prop::array::uniform3(-1.0f64..1.0),
            size in -6i32..1,
            load in prop::array::uniform4(0.8f64..1.2),
        ) {
            let pads = Pads { at: AT, swing, ratio: 1.3, load, give: None };
            let least = pads.least();
            let (twist, scale) = (least.twist, 10f64.powi(size));
            let other = [twist[0] + scale * nudge[0], twist[1] + scale * nudge[1], twist[2] + scale * nudge[2] / 80.0];
            let other = Displacement { twist: other, ..least };
            prop_assert!(cost(&pads, &least) <= cost(&pads, &other) + 1e-6);
        }

        // Springs from too soft to walk (.8 N mm/deg) to nearly rigid, with and without a stop.
        #[test]
        fn no_lag_costs_less_either(
            sweep in prop::array::uniform4(-90.0f64..90.0),
            swing in prop::array::uniform4(point(5.0)),
            ratio in 0.5f64..2.0,
            load in prop::array::uniform4(0.5f64..1.5),
            rate in 2.0f64..6.0,
            preload in prop::option::of(0.0f64..100.0),
            hold in prop::array::uniform4(-0.9f64..0.9),
        ) {
            let along = sweep.map(|sweep: f64| {
                let (sin, cos) = sweep.to_radians().sin_cos();
                [45.0 * cos, 45.0 * sin]
            });
            prop_assume!(swing.iter().flatten().any(|part| part.abs() > 1e-3));
            let (rate, preload) = (10f64.powf(rate), preload.unwrap_or(0.0));
            let side = Side::Spring { rate, preload };
            let drive = Yield { play: 0.0, stop: STOP, lower: side, upper: side };
            // The lags that the pads could hold before.
            let before = std::array::from_fn(|i| {
                let torque: f64 = hold[i] * 45.0 * load[i];
                (torque.abs() - preload).max(0.0).copysign(torque) / rate
            });
            let give = Some(Give { along, before, yields: [drive; 4] });
            assert_least(&Pads { at: AT, swing, ratio, load, give });
        }

        // Play together with stops, and slotted struts that yield one way.
        #[test]
        fn nor_does_another_place_within_the_play_or_the_slot(
            swing in prop::array::uniform4(point(5.0)),
            load in prop::array::uniform4(0.5f64..1.5),
            play in 0.0f64..0.03,
            within in prop::array::uniform4(-1.0f64..1.0),
            force in prop::option::of(0.2f64..6.0),
            arm in 40.0f64..85.0,
        ) {
            prop_assume!(swing.iter().flatten().any(|part| part.abs() > 1e-3));
            let (sin, cos) = arm.to_radians().sin_cos();
            let far = [22.0 * cos - 30.2, 22.0 * sin];
            let stretch = Stretch {
                far: far[0].hypot(far[1]),
                near: 22.0,
                angle: far[1].atan2(far[0]) - arm.to_radians(),
            };
            // The spring of the paper's size; one without a rate would pull less the
            // further it is stretched, where its lever shrinks.
            let upper = force.map_or(Side::Stop, |force| Side::strut(stretch, force, 1.5, 5.0));
            let drive = Yield { play, stop: STOP, lower: Side::Stop, upper };
            let give = Some(Give {
                along: [[45.0, 0.0]; 4],
                before: within.map(|share| share * play),
                yields: [drive; 4],
            });
            assert_least(&Pads { at: AT, swing, ratio: 1.0, load, give });
        }
    }
}
