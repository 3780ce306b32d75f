//! All positions of a servo, both in the firmware's integers and in floating point.

use lizard_core::guard::trig::Direction;
use lizard_core::numbers::units::Sweep;
use lizard_kinematics::{End, Vector};
use lizard_robot::CoreRobot;

/// All positions of one servo, in steps of 1/65536 turn over its whole travel.
pub struct Positions {
    /// Sweep from neutral to the first position, in steps of 1/65536 turn.
    first_sweep: i16,
    /// The angle of each position in the chassis frame, degrees.
    pub degrees: Vec<f64>,
    /// The crank's direction at each position, in the frame of its end, Q15.
    pub guard_directions: Vec<Direction>,
    /// The crank's direction at each position, in the frame of its end, in floating point.
    pub float_directions: Vec<Vector>,
}

impl Positions {
    /// Computes all positions of the servo with this index, 0 to 3, in the firmware's steps.
    pub fn compute(core_robot: &CoreRobot, servo: usize) -> Self {
        let neutral = core_robot.neutral_angles()[servo];
        let calibration = core_robot.calibration()[servo];
        let end = End::from_servo(servo);
        let mut positions = Self {
            first_sweep: calibration.travel_min.0,
            degrees: Vec::new(),
            guard_directions: Vec::new(),
            float_directions: Vec::new(),
        };
        for sweep in calibration.travel_min.0..=calibration.travel_max.0 {
            let angle = neutral.offset_by(Sweep(sweep));
            let degrees = f64::from(angle.0) * 360.0 / 65536.0;
            let direction = Direction::from_angle(angle);
            positions.degrees.push(degrees);
            positions.guard_directions.push(match end {
                End::Head => direction,
                End::Tail => direction.in_tail_frame(),
            });
            let float_direction = end.mirror(Vector::from_angle(degrees));
            positions.float_directions.push(float_direction);
        }
        positions
    }

    /// The sweep from neutral to the position with this index.
    pub fn sweep(&self, index: usize) -> Sweep {
        Sweep((i32::from(self.first_sweep) + index as i32) as i16)
    }
}
