//! The robot on its floor, step by step.
//!
//! The body's movement in a step depends on the steps before, because a leg on a spring
//! lags behind its servo by what those steps have left. So a [`Walker`] follows a walk:
//! it holds the servos, the lags and the place on the floor.

use crate::feet::Feet;
use crate::friction::{Displacement, Give, Pads, Point};
use crate::ground::Ground;
use crate::place::Place;

/// Legs that sweep further than this (deg) from one pose to the next are
/// followed in equal parts.
const PART: f64 = 0.5;
/// The pads are taken in the middle of a step, which a lagging leg knows only
/// after it. Each round brings the middle nearer.
const ROUNDS: usize = 4;
/// Lags that differ by less than this (rad) from one round to the next are known.
const KNOWN: f64 = 1e-4;

/// A robot that walks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walker {
    ground: Ground,
    /// By how much each pad presses harder than its load says, and all of them
    /// hold backward against forward.
    uneven: ([f64; 4], f64),
    /// Sweeps that the servos have, deg.
    servos: [f64; 4],
    /// How far the legs are behind, deg.
    lag: [f64; 4],
    place: Place,
}

/// What happened from one pose to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slip {
    /// How far each foot slid over the floor, mm, along its way.
    pub feet: [f64; 4],
    /// Length of the body's way over the floor, mm.
    pub way: f64,
    /// All turns of the body without their sign, deg.
    pub turned: f64,
    /// What each foot carried at the end over the mean.
    pub loads: [f64; 4],
}

impl Walker {
    /// A robot that stands with its servos at these sweeps (deg, foot forward
    /// positive, servo order) and its springs at rest.
    #[must_use]
    pub fn new(ground: Ground, sweeps: [f64; 4]) -> Self {
        Self::uneven(ground, sweeps, [1.0; 4], 1.0)
    }

    /// The same on pads that press and hold otherwise by these factors.
    #[must_use]
    pub fn uneven(ground: Ground, sweeps: [f64; 4], load: [f64; 4], ratio: f64) -> Self {
        Self {
            ground,
            uneven: (load, ratio),
            servos: sweeps,
            lag: [0.0; 4],
            place: Place::START,
        }
    }

    /// Where it is on the floor.
    #[must_use]
    pub fn place(&self) -> Place {
        self.place
    }

    /// Puts it elsewhere on the floor.
    pub fn set_place(&mut self, place: Place) {
        self.place = place;
    }

    /// The floor, the pads and the springs.
    #[must_use]
    pub fn ground(&self) -> &Ground {
        &self.ground
    }

    /// Changes floor, pads or springs from here on. A leg that is further behind than its
    /// drive allows comes to its stop.
    pub fn set_ground(&mut self, ground: Ground) {
        self.ground = ground;
        let (drive, servos) = (&self.ground.drive, self.servos);
        self.lag = std::array::from_fn(|i| drive.within(i, servos[i], self.lag[i]));
    }

    /// How far each leg is behind its servo, deg.
    #[must_use]
    pub fn lag(&self) -> [f64; 4] {
        self.lag
    }

    /// The legs' own sweeps, deg.
    #[must_use]
    pub fn legs(&self) -> [f64; 4] {
        std::array::from_fn(|i| self.servos[i] - self.lag[i])
    }

    /// Takes the servos to these sweeps, deg.
    pub fn step(&mut self, sweeps: [f64; 4]) -> Slip {
        let mut slip = Slip {
            feet: [0.0; 4],
            way: 0.0,
            turned: 0.0,
            loads: [1.0; 4],
        };
        self.parts(sweeps, |pads, displacement| {
            let [forward, left, turn] = displacement.twist;
            slip.way += forward.hypot(left);
            slip.turned += turn.abs().to_degrees();
            slip.loads = pads.load;
            for (sum, [x, y]) in slip.feet.iter_mut().zip(pads.slides(displacement)) {
                *sum += x.hypot(y);
            }
        });
        slip
    }

    /// Takes the servos to these sweeps and hands each small step to `visit`.
    pub(crate) fn parts(&mut self, sweeps: [f64; 4], mut visit: impl FnMut(&Pads, &Displacement)) {
        let here = self.servos;
        let furthest = (0..4).fold(0.0f64, |most, i| most.max((sweeps[i] - here[i]).abs()));
        let parts = (furthest / PART).ceil().max(1.0) as usize;
        for part in 1..=parts {
            let share = part as f64 / parts as f64;
            let next = std::array::from_fn(|i| here[i] + share * (sweeps[i] - here[i]));
            let (pads, displacement) = self.part(next);
            self.place = self.place.moved(displacement.twist);
            self.servos = next;
            self.lag = displacement.lag.map(f64::to_degrees);
            visit(&pads, &displacement);
        }
    }

    /// A small step: what the pads do while the servos go to these sweeps.
    fn part(&self, servos: [f64; 4]) -> (Pads, Displacement) {
        let feet = &self.ground.feet;
        let from = feet.at(self.legs());
        let mut lag = self.lag.map(f64::to_radians);
        let mut pads = self.pads(feet, from, servos, lag);
        let mut displacement = pads.least();
        for _ in 1..ROUNDS {
            let off = (0..4).fold(0.0f64, |off, i| {
                off.max((displacement.lag[i] - lag[i]).abs())
            });
            if off < KNOWN {
                break;
            }
            lag = displacement.lag;
            pads = self.pads(feet, from, servos, lag);
            displacement = pads.least_from(Some(&displacement));
        }
        (pads, displacement)
    }

    /// The pads of a small step, as far as they are known before it: the legs end
    /// about `lag` rad behind their servos.
    fn pads(&self, feet: &Feet, from: [Point; 4], servos: [f64; 4], lag: [f64; 4]) -> Pads {
        let ends: [f64; 4] = std::array::from_fn(|i| servos[i] - lag[i].to_degrees());
        let to = feet.at(ends);
        let along = feet.along(ends);
        // In the middle of the step, so that the way back is its exact inverse.
        let at = each(&|i, j| (from[i][j] + to[i][j]) / 2.0);
        let before = self.lag.map(f64::to_radians);
        let (load, ratio) = self.uneven;
        let loads = self.ground.loads(at);
        let (drive, grip) = (&self.ground.drive, self.ground.grip());
        // No pad carries more than the whole robot.
        let most = 4.0 * feet.reach * (self.ground.ratio * ratio).max(1.0);
        Pads {
            at,
            swing: each(&|i, j| to[i][j] - from[i][j] + (lag[i] - before[i]) * along[i][j]),
            ratio: self.ground.ratio * ratio,
            load: std::array::from_fn(|i| loads[i] * load[i]),
            give: drive.lags().then(|| Give {
                along,
                before,
                yields: std::array::from_fn(|i| drive.of_leg(i, servos[i], grip, most)),
            }),
        }
    }
}

fn each(of: &dyn Fn(usize, usize) -> f64) -> [Point; 4] {
    std::array::from_fn(|i| std::array::from_fn(|j| of(i, j)))
}
