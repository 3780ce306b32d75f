//! Everything that is known of the robot after a frame.

use lizard_contact::Place;
use lizard_kinematics::{Check, Margins};

/// The robot after a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Frames so far; the first is 1.
    pub frame: u64,
    /// Whether each servo had a pulse in it.
    pub pulsed: [bool; 4],
    /// Where the body is on the floor.
    pub place: Place,
    /// Servo angles, deg, chassis frame: where they are, not where they should be.
    pub angles: [f64; 4],
    /// How fast they turned, deg/s, counter-clockwise positive.
    pub rates: [f64; 4],
    /// How far the servos are from what their pulses ask for, deg.
    pub errors: [f64; 4],
    /// How far each leg is behind its servo, deg, foot forward positive.
    pub lag: [f64; 4],
    /// The feet on the floor: (forward, left), mm.
    pub feet: [[f64; 2]; 4],
    /// How far each foot slid over the floor in this frame, mm.
    pub slip: [f64; 4],
    /// What each foot carries, N.
    pub loads: [f64; 4],
    /// The margins; none where a loop does not close.
    pub margins: Option<Margins>,
    /// Slider travel from nominal, left and right, mm; none likewise.
    pub strokes: Option<[f64; 2]>,
}

/// A foot that slid less than this in a frame (mm) held. The contact model leaves a
/// foot that holds a millionth of its step.
const HOLDS: f64 = 0.01;

impl State {
    /// Which feet did not slide in this frame.
    #[must_use]
    pub fn holds(&self) -> [bool; 4] {
        self.slip.map(|slip| slip < HOLDS)
    }

    /// The smallest margin, and which one it is.
    #[must_use]
    pub fn least_margin(&self) -> Option<(Check, f64)> {
        self.margins.map(|margins| margins.min())
    }
}
