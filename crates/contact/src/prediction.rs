//! The prediction of a robot's movement for given sweeps of its legs.
//!
//! If two feet pull one way and two the other way, there is a tie: the body may follow either pair, every twist
//! in between costs the same friction, and the smallest difference between the pads decides. The model cannot know
//! that difference, so it does not predict the parts of a movement that depend on ties.

use crate::friction::Twist;
use crate::ground::Ground;
use crate::travel::{Prediction, Travel};
use crate::walker::Walker;

/// Unevenness of the pads in the test for ties, as a share. No printed pad and no floor is more even.
const UNEVEN: f64 = 0.01;
/// Share of the path's length, or of the sum of its turns, up to which a difference on uneven pads leaves a part of
/// the movement decided.
const DECIDED_SHARE: f64 = 0.05;
/// Difference on uneven pads up to which a movement ahead or to the left is always decided, mm.
const DECIDED_LENGTH: f64 = 1.0;
/// Difference on uneven pads up to which a turn is always decided, rad.
const DECIDED_TURN: f64 = 0.5 * std::f64::consts::PI / 180.0;

/// A walk on slightly uneven pads, compared with the walk on even ones.
struct Uneven {
    walker: Walker,
    /// Sums of the absolute differences of all steps: forward, left, turn.
    total_difference: Twist,
}

impl Uneven {
    /// Makes six walks: four in which one pad has a larger load, two with a larger or smaller ratio of backward to
    /// forward friction.
    fn variants(ground: &Ground, sweeps: [f64; 4]) -> [Self; 6] {
        let uneven = |load, ratio| Self {
            walker: Walker::with_unevenness(*ground, sweeps, load, ratio),
            total_difference: [0.0; 3],
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

    /// Moves the servos to these sweeps, and adds up the differences between each twist and that on even pads, which
    /// `twists` has.
    fn follow(&mut self, sweeps: [f64; 4], twists: &[Twist]) {
        let (mut part, differs) = (twists.iter(), &mut self.total_difference);
        self.walker.move_servos(sweeps, |_, displacement| {
            let even = part.next().copied().unwrap_or_default();
            for i in 0..3 {
                differs[i] += (displacement.twist[i] - even[i]).abs();
            }
        });
    }
}

impl Ground {
    /// Predicts the movement for these sweeps (deg, foot forward positive, servo order) one after
    /// another, as far as it does not depend on ties.
    ///
    /// The same sweeps are followed on uneven pads: the load of each pad in turn, then the backward friction of all
    /// of them, is changed by a hundredth. If two feet pull against two, the body then follows one pair or the
    /// other. A part of the movement is undecided if it differs at the end by more than 1 mm (0.5 deg) and by more
    /// than a twentieth of the length of the path (of the sum of its turns). Ahead and turn are also compared step
    /// by step: a body dragged to and fro by one pair of feet ends at its start, whichever pair it is, but if the
    /// pairs change in between, it may end anywhere on that path. For the movement to the side only the end counts:
    /// legs that swing together always spread and close, and bring the body back within one swing.
    pub fn predict(&self, sweeps: impl IntoIterator<Item = [f64; 4]>) -> Prediction {
        let mut sweeps = sweeps.into_iter();
        let first = sweeps.next().unwrap_or_default();
        let mut even = Walker::new(*self, first);
        let mut uneven = Uneven::variants(self, first);
        let (mut length, mut turned) = (0.0, 0.0);
        let mut twists = Vec::new();
        for next in sweeps {
            twists.clear();
            even.move_servos(next, |_, displacement| {
                let [forward, left, turn] = displacement.twist;
                length += forward.hypot(left);
                turned += turn.abs();
                twists.push(displacement.twist);
            });
            for movement in &mut uneven {
                movement.follow(next, &twists);
            }
        }
        let mm = DECIDED_LENGTH.max(DECIDED_SHARE * length);
        let rad = DECIDED_TURN.max(DECIDED_SHARE * turned);
        let place = even.place();
        let deviation = |movement: &Uneven| {
            let other = movement.walker.place();
            [other.forward - place.forward, other.left - place.left].map(f64::abs)
        };
        let all = |within: &dyn Fn(&Uneven) -> bool| uneven.iter().all(within);
        let decided = [
            all(&|movement| movement.total_difference[0] <= mm && deviation(movement)[0] <= mm),
            all(&|movement| deviation(movement)[1] <= mm),
            all(&|movement| movement.total_difference[2] <= rad),
        ];
        let travel = place.travel();
        Prediction {
            forward: decided[0].then_some(travel.forward),
            left: decided[1].then_some(travel.left),
            turn: decided[2].then_some(travel.turn),
        }
    }

    /// Computes the movement for these sweeps, also if it depends on ties. In a tie, the body moves by the twist
    /// midway between those of the two pairs of feet.
    pub fn travel(&self, sweeps: impl IntoIterator<Item = [f64; 4]>) -> Travel {
        let mut sweeps = sweeps.into_iter();
        let mut walker = Walker::new(*self, sweeps.next().unwrap_or_default());
        for next in sweeps {
            walker.step(next);
        }
        walker.place().travel()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::Drive;
    use crate::feet::{Body, Feet};
    use crate::ground::DEFAULT_FRICTION;
    use crate::stance::Stance;
    use std::f64::consts::PI;

    const GROUND: Ground = Ground {
        feet: Feet {
            hip_forward: 55.0,
            hip_side: [35.0; 2],
            mount: 0.0,
            reach: 45.0,
        },
        ratio: 1.0,
        body: Body::DEFAULT,
        friction: DEFAULT_FRICTION,
        drive: Drive::RIGID,
        stance: Stance::LEVEL,
    };

    /// A cycle of legs that all have the same wave, each with its own phase.
    fn cycle(starts: [f64; 4], wave: impl Fn(f64) -> f64) -> Vec<[f64; 4]> {
        let sweeps_at =
            |i: i32| starts.map(|start| wave((f64::from(i) / 400.0 - start).rem_euclid(1.0)));
        (0..=400).map(sweeps_at).collect()
    }

    /// A wave that goes backward at constant speed over `duty` of the cycle, then forward.
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
        const NO_MOVEMENT: Prediction = Prediction {
            forward: Some(0.0),
            left: Some(0.0),
            turn: Some(0.0),
        };
        assert_eq!(GROUND.predict([[0.0; 4]; 10]), NO_MOVEMENT);
        assert_eq!(GROUND.predict([]), NO_MOVEMENT);
        let movement = GROUND.predict([[20.0; 4], [-20.0; 4]]);
        let forward = movement.forward.expect("decided");
        assert!(movement.is_decided() && (forward - 90.0 * 20f64.to_radians().sin()).abs() < 1e-3);
    }

    #[test]
    fn two_feet_against_two_are_undecided() {
        for duty in [0.5, 0.75] {
            assert_eq!(GROUND.predict(cycle(DIAGONAL, stroke(duty))).forward, None);
        }
        for starts in [DIAGONAL, ONE_BY_ONE] {
            assert_eq!(GROUND.predict(cycle(starts, sine)).forward, None);
        }
        // In a gesture of the head, the front feet pull against the hind feet.
        let front = |phase: f64| [sine(phase), sine(phase), 0.0, 0.0];
        let front = (0..=100).map(|i| front(f64::from(i) / 100.0));
        assert_eq!(GROUND.predict(front).forward, None);
    }

    #[test]
    fn a_tie_too_small_to_matter_leaves_a_movement_decided() {
        let small = |sweeps: [f64; 4]| sweeps.map(|sweep| sweep / 500.0);
        let movement = GROUND.predict(cycle(DIAGONAL, sine).into_iter().map(small));
        assert!(movement.is_decided(), "{movement:?}");
    }
}
