//! The chassis plate, seen from above: the plate, its arms to the legs' pivots, and the servos' cases in the plate.

use lizard_kinematics::{End, Vector};

use crate::config::legs::LegPlan;
use crate::config::parts::Parts;

/// Width of the plate on each side of a servo's case, mm.
const SERVO_MARGIN: f64 = 5.0;
/// Length of the plate beyond a servo's flange, mm.
const FLANGE_MARGIN: f64 = 2.0;

/// The chassis plate, mm, chassis frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// Half the width (x) and half the length (y), without the arms.
    pub half_size: Vector,
    /// Radius of the corners.
    pub corner_radius: f64,
    /// End points of each leg's arms: one between the pivots, and one from each pivot to the plate.
    pub arms: [[[Vector; 2]; 3]; 4],
    /// Half the width of an arm; both ends of an arm are round.
    pub arm_half_width: f64,
    /// The centres of the servos' cases.
    pub case_centres: [Vector; 4],
    /// Width (x) and length (y) of a case.
    pub case_size: Vector,
}

impl Plate {
    /// Half the width of an arm, mm.
    const ARM_HALF_WIDTH: f64 = 7.0;
    /// Radius of a corner, mm.
    const CORNER_RADIUS: f64 = 4.0;

    /// Computes the plate that carries these legs and these servos.
    pub(crate) fn new(legs: &[LegPlan; 4], parts: &Parts) -> Self {
        let servo_body = &parts.servo;
        // A case extends from its shaft towards the middle of the robot.
        let case_centres: [Vector; 4] = std::array::from_fn(|servo| {
            let inward = -End::from_servo(servo).sign();
            legs[servo].shaft
                + Vector::new(0.0, inward * (servo_body.length / 2.0 - servo_body.shaft))
        });
        // Wide enough for the servos of both ends, and long enough for their flanges.
        let max_coordinate = |coordinate: fn(Vector) -> f64| {
            case_centres.map(coordinate).into_iter().fold(0.0, f64::max)
        };
        let half_size = Vector::new(
            max_coordinate(|case| case.x.abs()) + servo_body.width / 2.0 + SERVO_MARGIN,
            max_coordinate(|case| case.y.abs()) + servo_body.flange / 2.0 + FLANGE_MARGIN,
        );
        let arms = legs.map(|leg| {
            let inner_end = |pivot: Vector| {
                let max_y = (half_size.y - Self::ARM_HALF_WIDTH).max(0.0);
                Vector::new(
                    (half_size.x - Self::ARM_HALF_WIDTH).copysign(pivot.x),
                    pivot.y.clamp(-max_y, max_y),
                )
            };
            let [crank, follower] = [leg.crank_pivot, leg.follower_pivot];
            [
                [crank, follower],
                [crank, inner_end(crank)],
                [follower, inner_end(follower)],
            ]
        });
        Self {
            half_size,
            corner_radius: Self::CORNER_RADIUS,
            arms,
            arm_half_width: Self::ARM_HALF_WIDTH,
            case_centres,
            case_size: Vector::new(servo_body.width, servo_body.length),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::robot;

    #[test]
    fn the_papers_plate_extends_beyond_the_cases_and_the_flanges() {
        let plate = robot("paper").plate();
        // Width: 10 mm to a shaft, half a case, and 5 mm. Length: the shaft is 6.1 mm from the case's end.
        let half_width = 10.0 + 6.2 + 5.0;
        let half_length = 67.5 - (11.4 - 6.1) + 16.2 + 2.0;
        assert!((plate.half_size.x - half_width).abs() < 1e-9, "{plate:?}");
        assert!((plate.half_size.y - half_length).abs() < 1e-9, "{plate:?}");
    }
}
