//! The loads of four feet, which statics alone does not determine.
//!
//! The loads of a rigid body on three feet follow from statics. On four feet they do not: the feet on one diagonal may
//! carry more and the feet on the other less, and all forces still balance. The lengths of the feet and their stiffness
//! decide. If a foot is `twist` mm too long, that foot and the diagonally opposite one each carry more by a quarter of
//! `twist` times the stiffness; the other two carry less by as much. In a gait, three feet hold the body while the
//! fourth swings. They cannot do so if two of the three hardly touch the floor.
//!
//! The model therefore treats a foot as a spring that can only push: a foot that would have to pull is in the air.

use crate::friction::Point;
use crate::leg_geometry::Body;
use crate::linear::solve_symmetric;

/// The stiffness and the lengths of the feet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stance {
    /// Stiffness of a foot, N/mm: of its leaf spring together with its pad.
    pub stiffness: f64,
    /// Excess length of the front left foot over the other three, mm; negative if it is too short. An excess of the
    /// hind right foot has the same effect, an excess of another foot the opposite effect.
    pub twist: f64,
    /// Uncertainty of `twist` after levelling, +/- mm. Only predictions for random robots use this value.
    pub twist_error: f64,
}

/// Largest magnitude of a load that counts as zero, as a fraction of the mean load.
const LOAD_TOLERANCE: f64 = 1e-9;

impl Stance {
    /// Default values of robot.toml.
    pub const DEFAULT: Self = Self {
        stiffness: 0.5,
        twist: 0.0,
        twist_error: 0.5,
    };

    /// Feet of equal length.
    pub const LEVEL: Self = Self {
        twist: 0.0,
        ..Self::DEFAULT
    };

    /// Computes each foot's load divided by the mean load, for feet at these positions (forward, left in mm, servo
    /// order); 0 for a foot in the air.
    ///
    /// The feet are springs, on which the rigid chassis sinks and tilts. The load of a foot is therefore the sum of a
    /// part due to its own length and a part that is linear in its position. The three equations of balance determine
    /// the linear part.
    pub fn relative_loads(&self, body: &Body, feet: [Point; 4]) -> [f64; 4] {
        let twist_load = self.stiffness * self.twist / body.mean_load();
        let length_loads = [twist_load, 0.0, 0.0, 0.0];
        // All feet stand, or all but one. In exactly one of these five cases, no standing foot pulls and no lifted foot
        // is below the floor.
        let solve_case = |lifted_foot: Option<usize>| {
            let is_standing = std::array::from_fn(|i| lifted_foot != Some(i));
            let loads = compute_loads(feet, length_loads, body.centre_of_mass, is_standing);
            (is_standing, loads)
        };
        let cases = [None, Some(0), Some(1), Some(2), Some(3)].map(solve_case);
        let is_consistent = |(is_standing, loads): &&([bool; 4], [f64; 4])| {
            let mut pairs = is_standing.iter().zip(loads);
            pairs.all(|(is_standing, load)| match is_standing {
                true => *load >= -LOAD_TOLERANCE,
                false => *load <= LOAD_TOLERANCE,
            })
        };
        // A robot that falls over matches no case and gets the loads of the first case.
        let (is_standing, loads) = cases.iter().find(is_consistent).unwrap_or(&cases[0]);
        std::array::from_fn(|i| match is_standing[i] {
            true => loads[i].max(0.0),
            false => 0.0,
        })
    }
}

/// Computes each foot's load divided by the mean load if only the feet marked in `is_standing` touch the floor. A
/// negative load means that a standing foot pulls, or that a lifted foot is above the floor.
fn compute_loads(
    feet: [Point; 4],
    length_loads: [f64; 4],
    centre_of_mass: Point,
    is_standing: [bool; 4],
) -> [f64; 4] {
    let mut matrix = [[0.0; 3]; 3];
    let mut right_hand_side = [4.0, 4.0 * centre_of_mass[0], 4.0 * centre_of_mass[1]];
    for i in (0..4).filter(|&i| is_standing[i]) {
        let row = [1.0, feet[i][0], feet[i][1]];
        for j in 0..3 {
            right_hand_side[j] -= length_loads[i] * row[j];
            for k in 0..3 {
                matrix[j][k] += row[j] * row[k];
            }
        }
    }
    let [heave, pitch, roll] = solve_symmetric(matrix, right_hand_side);
    std::array::from_fn(|i| length_loads[i] + heave + pitch * feet[i][0] + roll * feet[i][1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assert_near;

    #[track_caller]
    fn assert_all_near(loads: [f64; 4], expected: [f64; 4], max_error: f64) {
        for (load, expected) in loads.into_iter().zip(expected) {
            assert_near(load, expected, max_error);
        }
    }

    const RECTANGLE: [Point; 4] = [[55.0, 80.0], [55.0, -80.0], [-55.0, -80.0], [-55.0, 80.0]];
    const SWUNG_FEET: [Point; 4] = [[67.0, 78.0], [48.0, -79.0], [-60.0, -80.0], [-51.0, 77.0]];

    fn body_with_centre(centre_of_mass: Point) -> Body {
        Body {
            centre_of_mass,
            ..Body::DEFAULT
        }
    }

    fn stance_with_twist(twist: f64) -> Stance {
        Stance {
            stiffness: 2.0,
            twist,
            ..Stance::DEFAULT
        }
    }

    /// Computes the loads by iteration: unbalanced force and moments change heave, pitch and roll until all balance.
    fn iterate_loads(stance: &Stance, body: &Body, feet: [Point; 4]) -> [f64; 4] {
        let (mut heave, mut pitch, mut roll) = (0.0, 0.0, 0.0);
        let stiffness = stance.stiffness / body.mean_load();
        let loads_at = |heave: f64, pitch: f64, roll: f64| -> [f64; 4] {
            std::array::from_fn(|i| {
                let excess_length = if i == 0 { stance.twist } else { 0.0 };
                let compression = excess_length + heave + pitch * feet[i][0] + roll * feet[i][1];
                (stiffness * compression).max(0.0)
            })
        };
        for _ in 0..200_000 {
            let current_loads = loads_at(heave, pitch, roll);
            let weighted_sum = |arm: &dyn Fn(usize) -> f64| -> f64 {
                (0..4).map(|i| current_loads[i] * arm(i)).sum()
            };
            heave += 0.05 * (4.0 - weighted_sum(&|_| 1.0));
            let [x, y] = body.centre_of_mass;
            pitch += 1e-5 * (4.0 * x - weighted_sum(&|i| feet[i][0]));
            roll += 1e-5 * (4.0 * y - weighted_sum(&|i| feet[i][1]));
        }
        loads_at(heave, pitch, roll)
    }

    #[test]
    fn the_loads_balance_the_body_and_match_an_iterative_solution() {
        for centre in [[0.0, 0.0], [6.0, -4.0], [-11.0, 9.0]] {
            for twist in [0.0, 0.3, -0.6, 1.0, 3.0] {
                let (stance, body) = (stance_with_twist(twist), body_with_centre(centre));
                let loads = stance.relative_loads(&body, SWUNG_FEET);
                let weighted_sum = |arm: fn(Point) -> f64| -> f64 {
                    let pairs = loads.iter().zip(SWUNG_FEET);
                    pairs.map(|(load, foot)| load * arm(foot)).sum()
                };
                assert_near(weighted_sum(|_| 1.0), 4.0, 1e-9);
                assert_near(weighted_sum(|foot| foot[0]), 4.0 * centre[0], 1e-6);
                assert_near(weighted_sum(|foot| foot[1]), 4.0 * centre[1], 1e-6);
                assert_all_near(loads, iterate_loads(&stance, &body, SWUNG_FEET), 1e-3);
            }
        }
    }

    #[test]
    fn feet_nearer_to_the_centre_of_mass_carry_more() {
        // The centre of mass is halfway to the front feet, so each front foot carries 1.5 times the mean.
        let loads = Stance::LEVEL.relative_loads(&body_with_centre([27.5, 0.0]), RECTANGLE);
        assert_all_near(loads, [1.5, 1.5, 0.5, 0.5], 1e-9);
        let loads = Stance::LEVEL.relative_loads(&Body::DEFAULT, RECTANGLE);
        assert_all_near(loads, [1.0; 4], 1e-9);
    }

    #[test]
    fn a_foot_that_is_too_long_and_the_diagonally_opposite_foot_carry_more() {
        // 2 N/mm times 0.6 mm is 1.2 N, of which each foot on the diagonal bears a quarter.
        let stance = stance_with_twist(0.6);
        let extra_load = 0.3 / Body::DEFAULT.mean_load();
        let loads = stance.relative_loads(&Body::DEFAULT, RECTANGLE);
        let expected_loads = [1.0, -1.0, 1.0, -1.0].map(|sign| 1.0 + sign * extra_load);
        assert_all_near(loads, expected_loads, 1e-9);
        // A foot that is much too long and the diagonally opposite foot carry half the robot each.
        let loads = stance_with_twist(10.0).relative_loads(&Body::DEFAULT, RECTANGLE);
        assert_all_near(loads, [2.0, 0.0, 2.0, 0.0], 1e-6);
    }

    #[test]
    fn a_foot_never_pulls() {
        // The centre of mass is beyond the diagonal from front right to hind left, so the hind right foot lifts.
        let loads = Stance::LEVEL.relative_loads(&body_with_centre([30.0, 50.0]), RECTANGLE);
        assert_eq!(loads[2], 0.0);
        assert!(loads.iter().all(|load| *load >= 0.0), "{loads:?}");
        assert_near(loads.iter().sum(), 4.0, 1e-9);
        // No foot pulls even if the robot falls over.
        let loads = Stance::LEVEL.relative_loads(&body_with_centre([200.0, 0.0]), RECTANGLE);
        assert!(loads.iter().all(|load| *load >= 0.0), "{loads:?}");
    }
}
