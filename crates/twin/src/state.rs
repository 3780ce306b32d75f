//! The twin's report of a frame.

use lizard_contact::Place;
use lizard_kinematics::{Check, Margins};

/// The state of the robot after a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Number of the frame, counted from 1.
    pub frame: u64,
    /// True for each servo that had a pulse in this frame.
    pub has_pulse: [bool; 4],
    /// Position and heading of the body on the floor.
    pub place: Place,
    /// Actual servo angles, deg, chassis frame.
    pub angles: [f64; 4],
    /// Speeds of the servos, deg/s, counter-clockwise positive.
    pub rates: [f64; 4],
    /// Pulse angles minus actual angles of the servos, deg.
    pub errors: [f64; 4],
    /// Lag of each leg behind its servo, deg, foot forward positive.
    pub lags: [f64; 4],
    /// Positions of the feet on the floor: (forward, left), mm.
    pub feet: [[f64; 2]; 4],
    /// Distance that each foot slid over the floor in this frame, mm.
    pub slips: [f64; 4],
    /// Load of each foot, N.
    pub loads: [f64; 4],
    /// Margins of the pose; `None` if the loop of a five-bar or slider does not close.
    pub margins: Option<Margins>,
    /// Left and right slider travel from nominal, mm; `None` if the loop of a five-bar or slider does not close.
    pub strokes: Option<[f64; 2]>,
}

impl State {
    /// Returns the name and the value of the smallest margin; `None` if the loop of a five-bar or slider does not
    /// close.
    pub fn min_margin(&self) -> Option<(Check, f64)> {
        self.margins.map(|margins| margins.min())
    }
}
