//! Feet that are never lifted: where the robot goes when its legs swing.
//!
//! Planar, quasi-static, Coulomb friction. At each instant the pads slide so
//! that the power lost to friction is least: of all twists (vx, vy, omega) of
//! the body, the one that minimises `sum |v + omega x r_i + dr_i/dt|` over the
//! feet. Three feet that agree out-vote one that returns, and the body
//! advances. Speed, weight and a common friction coefficient cancel.
//!
//! Two feet against two are a tie: every twist between the two pairs costs the
//! same, and the smallest difference between the pads decides. The model cannot
//! know it, so it predicts nothing where the way hangs on ties.

use crate::friction::{Pads, Point, Twist};

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
    pub(crate) fn at(&self, sweeps: [f64; 4]) -> [Point; 4] {
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

/// By how much pads are made uneven to see whether a way hangs on a tie. No
/// print and no floor is more even than that.
const UNEVEN: f64 = 0.01;
/// A way that then differs by less than this share of its length is decided.
const DECIDED_SHARE: f64 = 0.05;
/// So is one that differs by less than this, mm.
const DECIDED_LENGTH: f64 = 1.0;
/// So is a turn that differs by less than this, rad.
const DECIDED_TURN: f64 = 0.5 * std::f64::consts::PI / 180.0;

/// What is known of a way in advance, seen from where it started. None is what
/// hangs on a tie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// mm.
    pub forward: Option<f64>,
    /// mm.
    pub left: Option<f64>,
    /// deg, counter-clockwise.
    pub turn: Option<f64>,
}

impl Prediction {
    /// True if nothing hangs on a tie.
    pub fn is_decided(&self) -> bool {
        self.forward.is_some() && self.left.is_some() && self.turn.is_some()
    }
}

/// A way with pads that are a little uneven, beside the even one.
struct Uneven {
    load: [f64; 4],
    ratio: f64,
    place: Place,
    /// All differences of its steps from the even ones: forward, left, turn.
    differs: Twist,
}

impl Uneven {
    /// Each pad in turn pressed harder, and a little more friction one way.
    fn all() -> [Self; 6] {
        let uneven = |load, ratio| Self {
            load,
            ratio,
            place: Place::START,
            differs: [0.0; 3],
        };
        let even = [1.0; 4];
        std::array::from_fn(|i| match i {
            4 => uneven(even, 1.0 + UNEVEN),
            5 => uneven(even, 1.0 - UNEVEN),
            pad => {
                let mut load = even;
                load[pad] += UNEVEN;
                uneven(load, 1.0)
            }
        })
    }
}

impl Ground {
    /// Where the robot gets to when its legs take these sweeps (deg, foot
    /// forward positive, servo order) one after another, as far as that does not
    /// hang on ties.
    ///
    /// The same sweeps are followed on pads made uneven by a hundredth, each pad
    /// in turn and all of them backward against forward. Where two feet agree
    /// against two, the body then goes with one pair or with the other. A part
    /// of the way is undecided if its end differs by more than 1 mm (0.5 deg) and
    /// by more than a twentieth of the length of the way. Ahead and turn are
    /// compared step by step as well: a body dragged to and fro by one pair of
    /// feet ends where it began, as it does with the other pair, but pads that
    /// change on the way lead it anywhere between. Sideways only the end counts:
    /// legs that swing together always spread and close, and bring the body
    /// back within one swing.
    pub fn predict(&self, sweeps: impl IntoIterator<Item = [f64; 4]>) -> Prediction {
        let mut even = Place::START;
        let mut uneven = Uneven::all();
        let (mut length, mut turned) = (0.0, 0.0);
        self.follow(sweeps, |pads| {
            let twist @ [forward, left, turn] = pads.least();
            even = even.moved(twist);
            length += forward.hypot(left);
            turned += turn.abs();
            for way in &mut uneven {
                let other = Pads {
                    load: way.load,
                    ratio: pads.ratio * way.ratio,
                    ..pads
                }
                .least();
                way.place = way.place.moved(other);
                for i in 0..3 {
                    way.differs[i] += (other[i] - twist[i]).abs();
                }
            }
        });
        let mm = DECIDED_LENGTH.max(DECIDED_SHARE * length);
        let rad = DECIDED_TURN.max(DECIDED_SHARE * turned);
        let all = |within: &dyn Fn(&Uneven) -> bool| uneven.iter().all(within);
        let decided = [
            all(&|way| way.differs[0] <= mm && (way.place.forward - even.forward).abs() <= mm),
            all(&|way| (way.place.left - even.left).abs() <= mm),
            all(&|way| way.differs[2] <= rad),
        ];
        let travel = even.travel();
        Prediction {
            forward: decided[0].then_some(travel.forward),
            left: decided[1].then_some(travel.left),
            turn: decided[2].then_some(travel.turn),
        }
    }

    /// Where the model leads, whether or not that hangs on ties: then by the
    /// twist in the middle between the two pairs of feet.
    pub fn travel(&self, sweeps: impl IntoIterator<Item = [f64; 4]>) -> Travel {
        let mut place = Place::START;
        self.follow(sweeps, |pads| place = place.moved(pads.least()));
        place.travel()
    }

    /// Hands each small step of the legs to `visit`, as what their pads do.
    fn follow(&self, sweeps: impl IntoIterator<Item = [f64; 4]>, mut visit: impl FnMut(Pads)) {
        let mut sweeps = sweeps.into_iter();
        let Some(mut here) = sweeps.next() else {
            return;
        };
        for next in sweeps {
            let furthest = (0..4).fold(0.0f64, |most, i| most.max((next[i] - here[i]).abs()));
            let parts = (furthest / PART).ceil().max(1.0) as usize;
            let at = |part: usize| -> [f64; 4] {
                let share = part as f64 / parts as f64;
                std::array::from_fn(|i| here[i] + share * (next[i] - here[i]))
            };
            for part in 0..parts {
                visit(self.pads(at(part), at(part + 1)));
            }
            here = next;
        }
    }

    /// The pads while the legs sweep a little.
    fn pads(&self, from: [f64; 4], to: [f64; 4]) -> Pads {
        let (from, to) = (self.feet.at(from), self.feet.at(to));
        let each = |f: &dyn Fn(f64, f64) -> f64| -> [Point; 4] {
            std::array::from_fn(|i| std::array::from_fn(|j| f(from[i][j], to[i][j])))
        };
        // In the middle of the step, so that the way back is its exact inverse.
        Pads {
            at: each(&|a, b| (a + b) / 2.0),
            swing: each(&|a, b| b - a),
            ratio: self.ratio,
            load: [1.0; 4],
        }
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

    const GROUND: Ground = Ground {
        feet: Feet {
            hip_forward: 55.0,
            hip_side: 35.0,
            mount: 0.0,
            reach: 45.0,
        },
        ratio: 1.0,
    };

    /// A cycle of legs that all do the same, each from a phase of its own.
    fn cycle(starts: [f64; 4], wave: impl Fn(f64) -> f64) -> Vec<[f64; 4]> {
        let at = |i: i32| starts.map(|start| wave((f64::from(i) / 400.0 - start).rem_euclid(1.0)));
        (0..=400).map(at).collect()
    }

    /// Backward at one pace over `duty` of the cycle, then forward.
    fn stroke(duty: f64) -> impl Fn(f64) -> f64 {
        move |phase| {
            20.0 * if phase < duty {
                1.0 - 2.0 * phase / duty
            } else {
                2.0 * (phase - duty) / (1.0 - duty) - 1.0
            }
        }
    }

    fn sine(phase: f64) -> f64 {
        20.0 * (phase * 2.0 * PI).sin()
    }

    const ONE_BY_ONE: [f64; 4] = [0.25, 0.75, 0.5, 0.0];
    const DIAGONAL: [f64; 4] = [0.0, 0.5, 0.0, 0.5];

    #[test]
    fn three_feet_against_one_are_decided() {
        let walk = GROUND.predict(cycle(ONE_BY_ONE, stroke(0.75)));
        assert!(walk.is_decided() && walk.forward > Some(25.0), "{walk:?}");
    }

    #[test]
    fn legs_that_stand_still_or_swing_together_are_decided() {
        const NOWHERE: Prediction = Prediction {
            forward: Some(0.0),
            left: Some(0.0),
            turn: Some(0.0),
        };
        assert_eq!(GROUND.predict([[0.0; 4]; 10]), NOWHERE);
        assert_eq!(GROUND.predict([]), NOWHERE);
        let way = GROUND.predict([[20.0; 4], [-20.0; 4]]);
        let forward = way.forward.expect("decided");
        assert!(way.is_decided() && (forward - 90.0 * 20f64.to_radians().sin()).abs() < 1e-3);
    }

    #[test]
    fn two_feet_against_two_are_undecided() {
        for duty in [0.5, 0.75] {
            assert_eq!(GROUND.predict(cycle(DIAGONAL, stroke(duty))).forward, None);
        }
        for starts in [DIAGONAL, ONE_BY_ONE] {
            assert_eq!(GROUND.predict(cycle(starts, sine)).forward, None);
        }
        // The front feet against the hind feet, as a gesture of the head moves them.
        let front = |phase: f64| [sine(phase), sine(phase), 0.0, 0.0];
        let front = (0..=100).map(|i| front(f64::from(i) / 100.0));
        assert_eq!(GROUND.predict(front).forward, None);
    }

    #[test]
    fn a_tie_too_small_to_matter_leaves_a_way_decided() {
        let small = |sweeps: [f64; 4]| sweeps.map(|sweep| sweep / 500.0);
        let way = GROUND.predict(cycle(DIAGONAL, sine).into_iter().map(small));
        assert!(way.is_decided(), "{way:?}");
    }
}
