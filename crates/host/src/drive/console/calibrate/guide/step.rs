//! The steps of a calibration, in order.

/// A step of a calibration. A step with a number is for the servo with this index, 0 to 3.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// Lists the preparations for the user.
    Begin,
    /// Holds all servos in their middle position, so that the horns can be fitted.
    Horns,
    /// Asks for the servo's direction of rotation.
    Sign(usize),
    /// Turns the crank to its neutral angle.
    Trim(usize),
    /// Offers to set scales and limits, too.
    OfferScales,
    /// Adjusts the pulse width per degree.
    Scale(usize),
    /// Adjusts both limits of the travel.
    Limit(usize),
    /// Walks as a test.
    Walk,
    /// Shows the calibration before it is saved.
    Save,
    /// Confirms that the calibration is saved.
    Saved,
}

/// All steps in the order of a calibration.
pub(super) const STEPS: [Step; 22] = [
    Step::Begin,
    Step::Horns,
    Step::Sign(0),
    Step::Sign(1),
    Step::Sign(2),
    Step::Sign(3),
    Step::Trim(0),
    Step::Trim(1),
    Step::Trim(2),
    Step::Trim(3),
    Step::OfferScales,
    Step::Scale(0),
    Step::Scale(1),
    Step::Scale(2),
    Step::Scale(3),
    Step::Limit(0),
    Step::Limit(1),
    Step::Limit(2),
    Step::Limit(3),
    Step::Walk,
    Step::Save,
    Step::Saved,
];
