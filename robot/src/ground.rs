//! Feet that are never lifted: where the robot goes when its legs swing.
//!
//! Planar, quasi-static, Coulomb friction. At each instant the pads slide so
//! that the power lost to friction is least: of all twists (vx, vy, omega) of
//! the body, the one that minimises `sum |v + omega x r_i + dr_i/dt|` over the
//! feet. Three feet that agree out-vote one that returns, and the body
//! advances. Speed, weight and a common friction coefficient cancel.

use crate::friction::{Pads, Point};

/// Where the feet are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Feet {
    /// Hips ahead of and behind the chassis centre, mm.
    pub hip_forward: f64,
    /// Hips to either side, mm.
    pub hip_side: f64,
    /// Outward sweep of the legs at neutral, deg: front legs forward, hind legs
    /// back.
    pub mount: f64,
    /// Length of a leg's crank: from the hip to the foot, mm.
    pub reach: f64,
}

impl Feet {
    /// Where the feet are for sweeps in deg, servo order: (forward, left) from
    /// the chassis centre, mm.
    fn at(&self, sweeps: [f64; 4]) -> [Point; 4] {
        const FRONT: [f64; 4] = [1.0, 1.0, -1.0, -1.0];
        const LEFT: [f64; 4] = [1.0, -1.0, -1.0, 1.0];
        std::array::from_fn(|i| {
            let (sin, cos) = (sweeps[i] + FRONT[i] * self.mount).to_radians().sin_cos();
            [
                FRONT[i] * self.hip_forward + self.reach * sin,
                LEFT[i] * (self.hip_side + self.reach * cos),
            ]
        })
    }
}

/// The contact model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Where the feet are.
    pub feet: Feet,
    /// Friction of a pad that slides backward over that of one that slides
    /// forward.
    pub ratio: f64,
}

/// Where the robot got to, seen from where it started.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// mm.
    pub forward: f64,
    /// mm.
    pub left: f64,
    /// deg, counter-clockwise.
    pub turn: f64,
}

/// Legs that sweep further than this (deg) from one pose to the next are
/// followed in equal parts.
const PART: f64 = 0.5;

impl Ground {
    /// Where the robot gets to when its legs take these sweeps (deg, foot
    /// forward positive, servo order) one after another.
    pub fn travel(&self, sweeps: impl IntoIterator<Item = [f64; 4]>) -> Travel {
        let mut sweeps = sweeps.into_iter();
        let mut place = Place::START;
        let Some(mut here) = sweeps.next() else {
            return place.travel();
        };
        for next in sweeps {
            let furthest = (0..4).fold(0.0f64, |most, i| most.max((next[i] - here[i]).abs()));
            let parts = (furthest / PART).ceil().max(1.0) as usize;
            let at = |part: usize| -> [f64; 4] {
                let share = part as f64 / parts as f64;
                std::array::from_fn(|i| here[i] + share * (next[i] - here[i]))
            };
            for part in 0..parts {
                place = place.moved(self.step(at(part), at(part + 1)));
            }
            here = next;
        }
        place.travel()
    }

    /// The body's twist while the legs sweep a little.
    fn step(&self, from: [f64; 4], to: [f64; 4]) -> [f64; 3] {
        let (from, to) = (self.feet.at(from), self.feet.at(to));
        let each = |f: &dyn Fn(f64, f64) -> f64| -> [Point; 4] {
            std::array::from_fn(|i| std::array::from_fn(|j| f(from[i][j], to[i][j])))
        };
        // In the middle of the step, so that the way back is its exact inverse.
        Pads {
            at: each(&|a, b| (a + b) / 2.0),
            swing: each(&|a, b| b - a),
            ratio: self.ratio,
        }
        .least()
    }
}

/// Position and heading of the body on the floor.
#[derive(Clone, Copy)]
struct Place {
    forward: f64,
    left: f64,
    heading: f64,
}

impl Place {
    const START: Self = Self {
        forward: 0.0,
        left: 0.0,
        heading: 0.0,
    };

    /// After a twist of the body, held for a unit of time: the screw motion, so
    /// that the opposite twist leads back.
    fn moved(self, [forward, left, turn]: [f64; 3]) -> Self {
        // sin(turn)/turn and (1 - cos(turn))/turn without a division by zero.
        let half = turn / 2.0;
        let chord = if half == 0.0 { 1.0 } else { half.sin() / half };
        let (sin, cos) = (self.heading + half).sin_cos();
        Self {
            forward: self.forward + chord * (forward * cos - left * sin),
            left: self.left + chord * (forward * sin + left * cos),
            heading: self.heading + turn,
        }
    }

    fn travel(self) -> Travel {
        Travel {
            forward: self.forward,
            left: self.left,
            turn: self.heading.to_degrees(),
        }
    }
}
