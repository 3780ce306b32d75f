//! The twin's state after a frame.

use lizard_contact::BodyPose;
use lizard_kinematics::Margins;

/// The robot's state after a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Frame number, counted from 1.
    pub frame: u64,
    /// True for each servo that had a pulse in this frame.
    pub has_pulse: [bool; 4],
    /// Position and heading of the body on the floor.
    pub body_pose: BodyPose,
    /// Actual servo angles, deg, chassis frame.
    pub angles: [f64; 4],
    /// Servo speeds, deg/s, counter-clockwise positive.
    pub rates: [f64; 4],
    /// Servo errors, deg: the angle of the pulse, limited to the servo's travel, minus the actual angle; 0 without a
    /// pulse.
    pub errors: [f64; 4],
    /// Lag of each leg behind its servo, deg, foot forward positive.
    pub lags: [f64; 4],
    /// Foot positions on the floor: (forward, left), mm.
    pub feet: [[f64; 2]; 4],
    /// Slip distance of each foot on the floor in this frame, mm.
    pub slips: [f64; 4],
    /// Load on each foot, N.
    pub loads: [f64; 4],
    /// The pose's margins; `None` if the loop of a five-bar or slider does not close.
    pub margins: Option<Margins>,
    /// Left and right slider travel from nominal, mm; `None` if the loop of a five-bar or slider does not close.
    pub strokes: Option<[f64; 2]>,
}
