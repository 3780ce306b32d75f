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
    /// Shows the calibration and offers to save it.
    Save,
    /// Confirms that the calibration is saved.
    Saved,
}

/// Lists all steps in the order of a calibration.
pub(super) fn list_steps() -> Vec<Step> {
    let mut steps = vec![Step::Begin, Step::Horns];
    steps.extend((0..4).map(Step::Sign));
    steps.extend((0..4).map(Step::Trim));
    steps.push(Step::OfferScales);
    steps.extend((0..4).map(Step::Scale));
    steps.extend((0..4).map(Step::Limit));
    steps.extend([Step::Walk, Step::Save, Step::Saved]);
    steps
}
