//! The prediction of a robot's displacement for given sweeps of its legs.
//!
//! If two feet pull one way and two the other way, there is a tie: the body may follow either pair, every twist in
//! between costs the same friction, and the slightest difference between the pads decides. The model does not include
//! such differences, so it does not predict the components of a displacement that depend on ties.

use crate::friction::Twist;
use crate::ground_contact::GroundContact;
use crate::travel::Travel;
use crate::walker::Walker;

/// Relative change of a load or of the friction ratio in the test for ties. No real pads on a real floor are more even.
const UNEVENNESS: f64 = 0.01;
/// Largest difference between walks on uneven and on even pads at which a component counts as determined, as a
/// fraction of the path's length or of the sum of all turns.
const RELATIVE_TOLERANCE: f64 = 0.05;
/// Difference up to which a distance forward or to the left is always determined, mm.
const MIN_LENGTH_TOLERANCE: f64 = 1.0;
/// Difference up to which a turn is always determined, rad.
const MIN_TURN_TOLERANCE: f64 = 0.5 * std::f64::consts::PI / 180.0;

/// A predicted travel. A component is `None` if friction does not determine it: if two feet pull one way and two the
/// other way, the slightest difference between the pads decides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// Distance forward, mm.
    pub forward: Option<f64>,
    /// Distance to the left, mm.
    pub left: Option<f64>,
    /// Turn, deg, counter-clockwise positive.
    pub turn: Option<f64>,
}

impl Prediction {
    /// True if friction determines all three components.
    pub fn is_determined(&self) -> bool {
        self.forward.is_some() && self.left.is_some() && self.turn.is_some()
    }

    /// Returns the components of `travel` that this prediction determines.
    pub fn keep_determined(&self, travel: Travel) -> Self {
        Self {
            forward: self.forward.and(Some(travel.forward)),
            left: self.left.and(Some(travel.left)),
            turn: self.turn.and(Some(travel.turn)),
        }
    }
}

/// A walk on slightly uneven pads, compared with the walk on even pads.
struct UnevenWalk {
    /// The robot on the uneven pads.
    walker: Walker,
    /// Sums, over all steps, of the absolute differences from the twists on even pads: forward and left in mm, turn in
    /// rad.
    total_differences: Twist,
}

impl UnevenWalk {
    /// Creates six walks: four with a larger load on one pad, and two with a larger or smaller friction ratio.
    fn create_variants(ground: &GroundContact, sweeps: [f64; 4]) -> [Self; 6] {
        std::array::from_fn(|i| {
            let mut load_factors = [1.0; 4];
            let mut ratio_factor = 1.0;
            match i {
                4 => ratio_factor += UNEVENNESS,
                5 => ratio_factor -= UNEVENNESS,
                pad => load_factors[pad] += UNEVENNESS,
            }
            Self {
                walker: Walker::with_unevenness(*ground, sweeps, load_factors, ratio_factor),
                total_differences: [0.0; 3],
            }
        })
    }

    /// Moves the servos to these sweeps, deg, and adds up the differences between each step's twist and the twist of
    /// the same step on even pads, listed in `even_twists`.
    fn move_and_compare(&mut self, sweeps: [f64; 4], even_twists: &[Twist]) {
        let (mut even_twists, totals) = (even_twists.iter(), &mut self.total_differences);
        self.walker.move_servos(sweeps, |_, displacement| {
            let even_twist = even_twists.next().copied().unwrap_or_default();
            for i in 0..3 {
                totals[i] += (displacement.twist[i] - even_twist[i]).abs();
            }
        });
    }
}

impl GroundContact {
    /// Predicts the displacement for a series of sweeps (deg, foot forward positive, servo order), as far as it does
    /// not depend on ties.
    ///
    /// Six walkers follow the same sweeps on uneven pads: either the load of one pad or the backward friction of all
    /// pads is changed by one percent. In a tie the body then follows one pair of feet or the other. A component is
    /// determined if its difference from the walk on even pads is within a tolerance. For a distance, the tolerance is
    /// the larger of 1 mm and a twentieth of the path's length; for the turn, the larger of 0.5 deg and a twentieth of
    /// the sum of all turns.
    ///
    /// For the distance forward and the turn, the sum of the differences of all steps must also be within the
    /// tolerance. Otherwise ties could cancel: a body that either pair of feet drags to and fro ends at its start, but
    /// if the pairs change in between, it may end anywhere on that path. For the distance to the left, only the end
    /// counts: legs that swing together always spread and close, and bring the body back within one swing.
    pub fn predict(&self, sweeps: impl IntoIterator<Item = [f64; 4]>) -> Prediction {
        let mut sweeps = sweeps.into_iter();
        let first_sweeps = sweeps.next().unwrap_or_default();
        let mut even_walker = Walker::new(*self, first_sweeps);
        let mut uneven_walks = UnevenWalk::create_variants(self, first_sweeps);
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
                walk.move_and_compare(next_sweeps, &twists);
            }
        }
        let length_tolerance = MIN_LENGTH_TOLERANCE.max(RELATIVE_TOLERANCE * path_length);
        let turn_tolerance = MIN_TURN_TOLERANCE.max(RELATIVE_TOLERANCE * total_turn);
        let pose = even_walker.body_pose();
        let mut is_determined = [true; 3];
        for walk in &uneven_walks {
            let uneven_pose = walk.walker.body_pose();
            let [forward_difference, _, turn_difference] = walk.total_differences;
            is_determined[0] &= forward_difference <= length_tolerance
                && (uneven_pose.forward - pose.forward).abs() <= length_tolerance;
            is_determined[1] &= (uneven_pose.left - pose.left).abs() <= length_tolerance;
            is_determined[2] &= turn_difference <= turn_tolerance;
        }
        let travel = pose.travel();
        Prediction {
            forward: is_determined[0].then_some(travel.forward),
            left: is_determined[1].then_some(travel.left),
            turn: is_determined[2].then_some(travel.turn),
        }
    }

    /// Computes the displacement for a series of sweeps (deg, foot forward positive, servo order), even if it depends
    /// on ties. In a tie the body moves by the twist midway between the twists of the two pairs of feet.
    pub fn compute_travel(&self, sweeps: impl IntoIterator<Item = [f64; 4]>) -> Travel {
        let mut sweeps = sweeps.into_iter();
        let mut walker = Walker::new(*self, sweeps.next().unwrap_or_default());
        for next_sweeps in sweeps {
            walker.move_to(next_sweeps);
        }
        walker.body_pose().travel()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assert_near;
    use crate::ground_contact::PAPER_GROUND as GROUND;
    use std::f64::consts::PI;

    /// Builds a cycle in which all legs follow the same wave, each from its own starting phase.
    fn build_cycle(starts: [f64; 4], wave: impl Fn(f64) -> f64) -> Vec<[f64; 4]> {
        let sweeps_at =
            |i: i32| starts.map(|start| wave((f64::from(i) / 400.0 - start).rem_euclid(1.0)));
        (0..=400).map(sweeps_at).collect()
    }

    /// Returns a wave that moves backward at constant speed for the fraction `duty` of the cycle, then forward.
    fn stroke_wave(duty: f64) -> impl Fn(f64) -> f64 {
        move |phase| {
            20.0 * match phase < duty {
                true => 1.0 - 2.0 * phase / duty,
                false => 2.0 * (phase - duty) / (1.0 - duty) - 1.0,
            }
        }
    }

    fn sine_wave(phase: f64) -> f64 {
        20.0 * (phase * 2.0 * PI).sin()
    }

    const ONE_BY_ONE_STARTS: [f64; 4] = [0.25, 0.75, 0.5, 0.0];
    const DIAGONAL_STARTS: [f64; 4] = [0.0, 0.5, 0.0, 0.5];

    #[test]
    fn with_three_feet_against_one_the_displacement_is_determined() {
        let prediction = GROUND.predict(build_cycle(ONE_BY_ONE_STARTS, stroke_wave(0.75)));
        let is_long = prediction.forward > Some(25.0);
        assert!(prediction.is_determined() && is_long, "{prediction:?}");
    }

    #[test]
    fn if_the_legs_stand_still_or_swing_together_the_displacement_is_determined() {
        const NO_DISPLACEMENT: Prediction = Prediction {
            forward: Some(0.0),
            left: Some(0.0),
            turn: Some(0.0),
        };
        assert_eq!(GROUND.predict([[0.0; 4]; 10]), NO_DISPLACEMENT);
        assert_eq!(GROUND.predict([]), NO_DISPLACEMENT);
        let prediction = GROUND.predict([[20.0; 4], [-20.0; 4]]);
        assert!(prediction.is_determined());
        let forward = prediction.forward.expect("the distance is determined");
        assert_near(forward, 90.0 * 20f64.to_radians().sin(), 1e-3);
    }

    #[test]
    fn with_two_feet_against_two_the_distance_forward_is_undetermined() {
        for duty in [0.5, 0.75] {
            let prediction = GROUND.predict(build_cycle(DIAGONAL_STARTS, stroke_wave(duty)));
            assert_eq!(prediction.forward, None);
        }
        for starts in [DIAGONAL_STARTS, ONE_BY_ONE_STARTS] {
            assert_eq!(GROUND.predict(build_cycle(starts, sine_wave)).forward, None);
        }
        // In a gesture of the head, the front feet pull against the hind feet.
        let sweeps_at = |phase: f64| [sine_wave(phase), sine_wave(phase), 0.0, 0.0];
        let front_sweeps = (0..=100).map(|i| sweeps_at(f64::from(i) / 100.0));
        assert_eq!(GROUND.predict(front_sweeps).forward, None);
    }

    #[test]
    fn a_tie_within_the_tolerance_leaves_the_displacement_determined() {
        let shrink_sweeps = |sweeps: [f64; 4]| sweeps.map(|sweep| sweep / 500.0);
        let cycle = build_cycle(DIAGONAL_STARTS, sine_wave).into_iter();
        let prediction = GROUND.predict(cycle.map(shrink_sweeps));
        assert!(prediction.is_determined(), "{prediction:?}");
    }
}
