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

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn assert_at(place: Place, forward: f64, left: f64, turn: f64) {
        let travel = place.travel();
        let off = (travel.forward - forward).hypot(travel.left - left);
        assert!(
            off < 1e-12 && (travel.turn - turn).abs() < 1e-12,
            "{travel:?}"
        );
    }

    #[test]
    fn a_body_moves_along_its_own_axes() {
        assert_at(Place::START.moved([10.0, 0.0, 0.0]), 10.0, 0.0, 0.0);
        assert_at(Place::START.moved([0.0, 10.0, 0.0]), 0.0, 10.0, 0.0);
        // Having turned left, ahead is to the left and left is behind.
        let turned = Place::START.moved([0.0, 0.0, FRAC_PI_2]);
        assert_at(turned.moved([10.0, 0.0, 0.0]), 0.0, 10.0, 90.0);
        assert_at(turned.moved([0.0, 10.0, 0.0]), -10.0, 0.0, 90.0);
    }

    #[test]
    fn a_body_that_turns_as_it_moves_follows_a_circle() {
        // A quarter and a half of a circle of radius 10 to the left.
        assert_at(
            Place::START.moved([10.0 * FRAC_PI_2, 0.0, FRAC_PI_2]),
            10.0,
            10.0,
            90.0,
        );
        assert_at(Place::START.moved([10.0 * PI, 0.0, PI]), 0.0, 20.0, 180.0);
    }

    #[test]
    fn feet_stand_where_the_parallelograms_put_them() {
        let feet = Feet {
            hip_forward: 55.0,
            hip_side: 35.0,
            mount: 0.0,
            reach: 45.0,
        };
        assert_eq!(
            feet.at([0.0; 4]),
            [[55.0, 80.0], [55.0, -80.0], [-55.0, -80.0], [-55.0, 80.0]]
        );
        let ahead = feet.at([90.0; 4]);
        let expected = [[100.0, 35.0], [100.0, -35.0], [-10.0, -35.0], [-10.0, 35.0]];
        for (foot, wanted) in ahead.into_iter().zip(expected) {
            assert!(
                (foot[0] - wanted[0]).hypot(foot[1] - wanted[1]) < 1e-12,
                "{foot:?}"
            );
        }
        let splayed = Feet {
            mount: 90.0,
            ..feet
        }
        .at([0.0; 4]);
        assert!((splayed[0][0] - 100.0).abs() < 1e-12 && (splayed[2][0] + 100.0).abs() < 1e-12);
    }
}
