//! The chassis plate, seen from above: the plate, its arms to the legs' pivots, and the servos' cases in it.

use lizard_kinematics::{End, Vector};

use crate::measures::legs::LegPlan;
use crate::measures::parts::Parts;

/// Width of the plate beside a servo's case, mm.
const BESIDE_SERVO: f64 = 5.0;
/// Length of the plate beyond a servo's flange, mm.
const BEYOND_FLANGE: f64 = 2.0;

/// The chassis plate, mm, chassis frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// Half the width and half the length, without the arms.
    pub half: Vector,
    /// Radius of the corners.
    pub corner: f64,
    /// End points of each leg's arms: one between the pivots, and one from each pivot to the plate.
    pub arms: [[[Vector; 2]; 3]; 4],
    /// Half the width of an arm; both ends of an arm are round.
    pub arm: f64,
    /// The centres of the servos' cases.
    pub cases: [Vector; 4],
    /// Width and length of a case.
    pub case: Vector,
}

impl Plate {
    /// Half the width of an arm, mm.
    const ARM: f64 = 7.0;
    /// Radius of a corner, mm.
    const CORNER: f64 = 4.0;

    pub(crate) fn new(legs: &[LegPlan; 4], parts: &Parts) -> Self {
        let body = &parts.servo;
        // A case extends from its shaft toward the middle of the robot.
        let cases: [Vector; 4] = std::array::from_fn(|servo| {
            let inward = -End::of_servo(servo).sign();
            legs[servo].shaft + Vector::new(0.0, inward * (body.length / 2.0 - body.shaft))
        });
        // Wide enough for the servos of both ends, and long enough for their flanges.
        let largest_of =
            |coordinate: fn(Vector) -> f64| cases.map(coordinate).into_iter().fold(0.0, f64::max);
        let half = Vector::new(
            largest_of(|case| case.x.abs()) + body.width / 2.0 + BESIDE_SERVO,
            largest_of(|case| case.y.abs()) + body.flange / 2.0 + BEYOND_FLANGE,
        );
        let arms = legs.map(|leg| {
            let inner_end_of = |pivot: Vector| {
                let y = (half.y - Self::ARM).max(0.0);
                Vector::new((half.x - Self::ARM).copysign(pivot.x), pivot.y.clamp(-y, y))
            };
            let [driven, idle] = [leg.crank_pivot, leg.follower_pivot];
            [
                [driven, idle],
                [driven, inner_end_of(driven)],
                [idle, inner_end_of(idle)],
            ]
        });
        Self {
            half,
            corner: Self::CORNER,
            arms,
            arm: Self::ARM,
            cases,
            case: Vector::new(body.width, body.length),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::robot;

    #[test]
    fn the_papers_plate_holds_its_servos() {
        let plate = robot("paper").plate();
        // 10 mm to a shaft, half a case, 5 mm. The shaft is 6.1 mm from the case's end.
        let half_width = 10.0 + 6.2 + 5.0;
        let half_length = 67.5 - (11.4 - 6.1) + 16.2 + 2.0;
        assert!((plate.half.x - half_width).abs() < 1e-9, "{plate:?}");
        assert!((plate.half.y - half_length).abs() < 1e-9, "{plate:?}");
    }
}
