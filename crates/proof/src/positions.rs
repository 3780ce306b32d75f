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
    /// The crank's direction in the frame of its end, Q15.
    pub fixed: Vec<Direction>,
    /// The crank's direction in the frame of its end, in floating point.
    pub exact: Vec<Vector>,
}

impl Positions {
    /// Computes all positions of the servo with this index, 0 to 3, in the firmware's steps.
    pub fn compute(guard: &CoreRobot, servo: usize) -> Self {
        let neutral = guard.neutral_angles()[servo];
        let calibration = guard.calibration()[servo];
        let end = End::from_servo(servo);
        let mut positions = Self {
            first_sweep: calibration.travel_min.0,
            degrees: Vec::new(),
            fixed: Vec::new(),
            exact: Vec::new(),
        };
        for sweep in calibration.travel_min.0..=calibration.travel_max.0 {
            let angle = neutral.offset_by(Sweep(sweep));
            let degrees = f64::from(angle.0) * 360.0 / 65536.0;
            let fixed = Direction::from_angle(angle);
            positions.degrees.push(degrees);
            positions.fixed.push(match end {
                End::Head => fixed,
                End::Tail => fixed.in_tail_frame(),
            });
            let exact = Vector::from_angle(degrees);
            positions.exact.push(end.mirror(exact));
        }
        positions
    }

    /// The sweep from neutral to the position with this index.
    pub fn sweep(&self, index: usize) -> Sweep {
        Sweep((i32::from(self.first_sweep) + index as i32) as i16)
    }
}
