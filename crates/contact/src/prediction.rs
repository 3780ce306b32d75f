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
/// Largest difference on uneven pads of a component of the movement that counts as decided, as a share of the path's
/// length, or of the sum of its turns.
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
        let walk_with = |load, ratio| Self {
            walker: Walker::with_unevenness(*ground, sweeps, load, ratio),
            total_difference: [0.0; 3],
        };
        let even_loads = [1.0; 4];
        std::array::from_fn(|i| match i {
            4 => walk_with(even_loads, 1.0 + UNEVEN),
            5 => walk_with(even_loads, 1.0 - UNEVEN),
            pad => {
                let mut load = even_loads;
                load[pad] += UNEVEN;
                walk_with(load, 1.0)
            }
        })
    }

    /// Moves the servos to these sweeps, and adds up the differences between each twist and the twist of the same
    /// step on even pads. `twists` is the list of the twists on even pads.
    fn follow(&mut self, sweeps: [f64; 4], twists: &[Twist]) {
        let (mut even_twists, total_difference) = (twists.iter(), &mut self.total_difference);
        self.walker.move_servos(sweeps, |_, displacement| {
            let even_twist = even_twists.next().copied().unwrap_or_default();
            for i in 0..3 {
                total_difference[i] += (displacement.twist[i] - even_twist[i]).abs();
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
    /// other. The distances ahead and to the left are undecided if they differ at the end by more than 1 mm and by
    /// more than a twentieth of the length of the path; the turn, if it differs by more than 0.5 deg and by more than a
    /// twentieth of the sum of all turns. The distance ahead and the turn are also compared step by step: a body
    /// dragged to and fro by one pair of feet ends at its start, whichever pair it is, but if the pairs change in
    /// between, it may end anywhere on that path. For the movement to the side only the end counts: legs that swing
    /// together always spread and close, and bring the body back within one swing.
    pub fn predict(&self, sweeps: impl IntoIterator<Item = [f64; 4]>) -> Prediction {
        let mut sweeps = sweeps.into_iter();
        let first_sweeps = sweeps.next().unwrap_or_default();
        let mut even_walker = Walker::new(*self, first_sweeps);
        let mut uneven_walks = Uneven::variants(self, first_sweeps);
        let (mut path_length, mut total_turn) = (0.0, 0.0);
        let mut twists = Vec::new();
        for next_sweeps in sweeps {
            twists.clear();
            even_walker.move_servos(next_sweeps, |_, displacement| {
                let [forward, left, turn] = displacement.twist;
                path_length += forward.hypot(left);
                total_turn += turn.abs();
                twists.push(displacement.twist);
            });
            for walk in &mut uneven_walks {
                walk.follow(next_sweeps, &twists);
            }
        }
        let max_mm = DECIDED_LENGTH.max(DECIDED_SHARE * path_length);
        let max_rad = DECIDED_TURN.max(DECIDED_SHARE * total_turn);
        let place = even_walker.place();
        let deviation_of = |walk: &Uneven| {
            let uneven_place = walk.walker.place();
            [
                uneven_place.forward - place.forward,
                uneven_place.left - place.left,
            ]
            .map(f64::abs)
        };
        let is_true_for_all =
            |condition: &dyn Fn(&Uneven) -> bool| uneven_walks.iter().all(condition);
        let is_decided = [
            is_true_for_all(&|walk| {
                walk.total_difference[0] <= max_mm && deviation_of(walk)[0] <= max_mm
            }),
            is_true_for_all(&|walk| deviation_of(walk)[1] <= max_mm),
            is_true_for_all(&|walk| walk.total_difference[2] <= max_rad),
        ];
        let travel = place.travel();
        Prediction {
            forward: is_decided[0].then_some(travel.forward),
            left: is_decided[1].then_some(travel.left),
            turn: is_decided[2].then_some(travel.turn),
        }
    }

    /// Computes the movement for these sweeps, also if it depends on ties. In a tie, the body moves by the twist
    /// midway between those of the two pairs of feet.
    pub fn travel(&self, sweeps: impl IntoIterator<Item = [f64; 4]>) -> Travel {
        let mut sweeps = sweeps.into_iter();
        let mut walker = Walker::new(*self, sweeps.next().unwrap_or_default());
        for next_sweeps in sweeps {
            walker.step(next_sweeps);
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
    fn cycle_of(starts: [f64; 4], wave: impl Fn(f64) -> f64) -> Vec<[f64; 4]> {
        let sweeps_at =
            |i: i32| starts.map(|start| wave((f64::from(i) / 400.0 - start).rem_euclid(1.0)));
        (0..=400).map(sweeps_at).collect()
    }

    /// A wave that goes backward at constant speed over `duty` of the cycle, then forward.
    fn stroke_wave(duty: f64) -> impl Fn(f64) -> f64 {
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
        let walk = GROUND.predict(cycle_of(ONE_BY_ONE, stroke_wave(0.75)));
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
            assert_eq!(
                GROUND
                    .predict(cycle_of(DIAGONAL, stroke_wave(duty)))
                    .forward,
                None
            );
        }
        for starts in [DIAGONAL, ONE_BY_ONE] {
            assert_eq!(GROUND.predict(cycle_of(starts, sine)).forward, None);
        }
        // In a gesture of the head, the front feet pull against the hind feet.
        let front_feet_at = |phase: f64| [sine(phase), sine(phase), 0.0, 0.0];
        let front_sweeps = (0..=100).map(|i| front_feet_at(f64::from(i) / 100.0));
        assert_eq!(GROUND.predict(front_sweeps).forward, None);
    }

    #[test]
    fn a_tie_too_small_to_matter_leaves_a_movement_decided() {
        let shrink = |sweeps: [f64; 4]| sweeps.map(|sweep| sweep / 500.0);
        let movement = GROUND.predict(cycle_of(DIAGONAL, sine).into_iter().map(shrink));
        assert!(movement.is_decided(), "{movement:?}");
    }
}
