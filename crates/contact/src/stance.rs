//! The loads of four feet, which statics alone does not determine.
//!
//! The loads of a stiff body on three feet follow from statics. On four feet they do not:
//! one diagonal may carry more and the other less, and all forces still balance. The
//! lengths of the feet and their stiffness decide. If a foot is `twist` mm too long, it
//! and the foot across from it carry more by a quarter of `twist` times the stiffness,
//! and the other two carry less by as much. In a gait three feet hold the body while
//! the fourth swings; that fails if two of the three hardly touch the floor.
//!
//! So a foot is modelled as a spring that only pushes: a foot that would have to pull is
//! in the air.

use crate::feet::Body;
use crate::friction::Point;
use crate::linear::solve;

/// The stiffness and the lengths of the feet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stance {
    /// Stiffness of a foot, N/mm: its leaf and its pad.
    pub stiffness: f64,
    /// Excess length of the front left foot over the other three, mm; negative if it is too
    /// short. An equal excess of the hind right foot has the same effect; an excess of one of
    /// the other two feet has the opposite effect.
    pub twist: f64,
    /// Uncertainty of `twist` after levelling, mm to either side. Only predictions for random
    /// robots use it.
    pub level: f64,
}

/// Largest load, as a share of the mean, that counts as zero.
const ZERO_LOAD: f64 = 1e-9;

impl Stance {
    /// The defaults of robot.toml.
    pub const DEFAULT: Self = Self {
        stiffness: 0.5,
        twist: 0.0,
        level: 0.5,
    };

    /// Feet of equal length.
    pub const LEVEL: Self = Self {
        twist: 0.0,
        ..Self::DEFAULT
    };

    /// Extra load that `twist` puts on the front left and the hind right foot, N, if the feet
    /// stand in a rectangle; the other two carry as much less.
    pub fn diagonal(&self) -> f64 {
        self.stiffness * self.twist / 4.0
    }

    /// Computes the load of each foot as a share of the mean, with feet at these positions
    /// (forward, left in mm, servo order); 0 for a foot in the air.
    ///
    /// The feet are springs and the chassis is rigid: it sinks and tilts. So a foot's load is a
    /// part from its own length plus a part that is linear in its position. The three equations
    /// of balance determine the linear part.
    pub fn loads(&self, body: &Body, feet: [Point; 4]) -> [f64; 4] {
        let by_length = [
            self.stiffness * self.twist / body.mean_load(),
            0.0,
            0.0,
            0.0,
        ];
        // All four feet stand, or all except one: in exactly one of these five cases no standing
        // foot pulls and no lifted foot is below the floor.
        let all_but = |lifted: Option<usize>| {
            let stands = std::array::from_fn(|i| lifted != Some(i));
            (stands, pressures(feet, by_length, body.centre, stands))
        };
        let cases = [None, Some(0), Some(1), Some(2), Some(3)].map(all_but);
        let is_consistent = |(stands, pressures): &&([bool; 4], [f64; 4])| {
            let mut each = stands.iter().zip(pressures);
            each.all(|(stands, pressure)| match stands {
                true => *pressure >= -ZERO_LOAD,
                false => *pressure <= ZERO_LOAD,
            })
        };
        // A robot that falls over matches no case; it gets the loads of the first one.
        let (stands, pressures) = cases.iter().find(is_consistent).unwrap_or(&cases[0]);
        std::array::from_fn(|i| {
            if stands[i] {
                pressures[i].max(0.0)
            } else {
                0.0
            }
        })
    }
}

/// Computes the load of each foot as a share of the mean if only the feet in `stands` touch the
/// floor. A negative load means that a standing foot pulls, or that a lifted one is above the floor.
fn pressures(feet: [Point; 4], by_length: [f64; 4], centre: Point, stands: [bool; 4]) -> [f64; 4] {
    let mut matrix = [[0.0; 3]; 3];
    let mut moments = [4.0, 4.0 * centre[0], 4.0 * centre[1]];
    for i in (0..4).filter(|&i| stands[i]) {
        let row = [1.0, feet[i][0], feet[i][1]];
        for j in 0..3 {
            moments[j] -= by_length[i] * row[j];
            for k in 0..3 {
                matrix[j][k] += row[j] * row[k];
            }
        }
    }
    let [heave, pitch, roll] = solve(matrix, moments);
    std::array::from_fn(|i| by_length[i] + heave + pitch * feet[i][0] + roll * feet[i][1])
}

#[cfg(test)]
mod tests {
    use super::*;

    const RECTANGLE: [Point; 4] = [[55.0, 80.0], [55.0, -80.0], [-55.0, -80.0], [-55.0, 80.0]];
    const SWUNG: [Point; 4] = [[67.0, 78.0], [48.0, -79.0], [-60.0, -80.0], [-51.0, 77.0]];

    fn body(centre: Point) -> Body {
        Body {
            centre,
            ..Body::DEFAULT
        }
    }

    fn twisted(twist: f64) -> Stance {
        Stance {
            stiffness: 2.0,
            twist,
            ..Stance::DEFAULT
        }
    }

    /// Computes the loads by iteration: heave, pitch and roll follow the unbalanced force and
    /// moments until the feet carry the body.
    fn settled(stance: &Stance, body: &Body, feet: [Point; 4]) -> [f64; 4] {
        let (mut heave, mut pitch, mut roll) = (0.0, 0.0, 0.0);
        let stiffness = stance.stiffness / body.mean_load();
        let loads = |heave: f64, pitch: f64, roll: f64| -> [f64; 4] {
            std::array::from_fn(|i| {
                let excess = if i == 0 { stance.twist } else { 0.0 };
                let pressed = excess + heave + pitch * feet[i][0] + roll * feet[i][1];
                (stiffness * pressed).max(0.0)
            })
        };
        for _ in 0..200_000 {
            let now = loads(heave, pitch, roll);
            let sum = |arm: &dyn Fn(usize) -> f64| -> f64 { (0..4).map(|i| now[i] * arm(i)).sum() };
            heave += 0.05 * (4.0 - sum(&|_| 1.0));
            pitch += 1e-5 * (4.0 * body.centre[0] - sum(&|i| feet[i][0]));
            roll += 1e-5 * (4.0 * body.centre[1] - sum(&|i| feet[i][1]));
        }
        loads(heave, pitch, roll)
    }

    #[test]
    fn the_loads_balance_the_body_and_are_those_at_which_it_settles() {
        for centre in [[0.0, 0.0], [6.0, -4.0], [-11.0, 9.0]] {
            for twist in [0.0, 0.3, -0.6, 1.0, 3.0] {
                let loads = twisted(twist).loads(&body(centre), SWUNG);
                let sum = |arm: fn(Point) -> f64| -> f64 {
                    let each = loads.iter().zip(SWUNG);
                    each.map(|(load, at)| load * arm(at)).sum()
                };
                assert!((sum(|_| 1.0) - 4.0).abs() < 1e-9);
                assert!((sum(|at| at[0]) - 4.0 * centre[0]).abs() < 1e-6);
                assert!((sum(|at| at[1]) - 4.0 * centre[1]).abs() < 1e-6);
                let settled = settled(&twisted(twist), &body(centre), SWUNG);
                for (load, other) in loads.into_iter().zip(settled) {
                    assert!((load - other).abs() < 1e-3, "{twist} {loads:?} {settled:?}");
                }
            }
        }
    }

    #[test]
    fn feet_in_a_rectangle_share_by_lever() {
        // The centre is halfway to the front feet, which then carry 1.5 times the mean.
        let loads = Stance::LEVEL.loads(&body([27.5, 0.0]), RECTANGLE);
        for (load, expected) in loads.into_iter().zip([1.5, 1.5, 0.5, 0.5]) {
            assert!((load - expected).abs() < 1e-9, "{loads:?}");
        }
        for load in Stance::LEVEL.loads(&Body::DEFAULT, RECTANGLE) {
            assert!((load - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_foot_that_is_too_long_loads_itself_and_the_one_across() {
        // 2 N/mm and 0.6 mm: a quarter of 1.2 N.
        let stance = twisted(0.6);
        assert!((stance.diagonal() - 0.3).abs() < 1e-12);
        let share = 0.3 / Body::DEFAULT.mean_load();
        let loads = stance.loads(&Body::DEFAULT, RECTANGLE);
        for (load, sign) in loads.into_iter().zip([1.0, -1.0, 1.0, -1.0]) {
            assert!((load - 1.0 - sign * share).abs() < 1e-9, "{loads:?}");
        }
        // A foot that is much too long and the foot diagonally opposite carry half the robot each.
        let loads = twisted(10.0).loads(&Body::DEFAULT, RECTANGLE);
        for (load, expected) in loads.into_iter().zip([2.0, 0.0, 2.0, 0.0]) {
            assert!((load - expected).abs() < 1e-6, "{loads:?}");
        }
    }

    #[test]
    fn a_foot_never_pulls() {
        // The centre is beyond the diagonal through feet 1 and 3, so foot 2 leaves the floor.
        let loads = Stance::LEVEL.loads(&body([30.0, 50.0]), RECTANGLE);
        assert_eq!(loads[2], 0.0);
        assert!(loads.iter().all(|load| *load >= 0.0), "{loads:?}");
        assert!((loads.iter().sum::<f64>() - 4.0).abs() < 1e-9);
        // No foot pulls even if the robot falls over.
        let fallen = Stance::LEVEL.loads(&body([200.0, 0.0]), RECTANGLE);
        assert!(fallen.iter().all(|load| *load >= 0.0), "{fallen:?}");
    }
}
