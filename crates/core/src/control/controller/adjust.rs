//! Changes the settings of the servos. A change takes effect at once. It is refused if the robot could
//! no longer walk all gaits, or no longer keep its present pose or target.

use super::Control;
use crate::control::order::Setting;
use crate::control::refusal::Refusal;
use crate::memory::settings::Settings;
use crate::numbers::calibration::Calibration;
use crate::numbers::part::Servo;

impl Control {
    /// Changes a setting of a servo.
    #[inline(never)]
    pub(super) fn set_servo(&mut self, servo: Servo, setting: Setting) -> Result<(), Refusal> {
        let mut settings = self.settings;
        let mut adjustment = settings.servo(servo);
        match setting {
            Setting::Trim(trim) => adjustment.trim = trim,
            Setting::Direction(is_direct) => adjustment.set_direct(is_direct),
            Setting::Scale(scale) => adjustment.set_scale(scale),
            Setting::Limit(clockwise, counter_clockwise) => {
                let neutral = self.motion.robot().neutral_of(servo);
                adjustment.min = neutral.sweep_to(clockwise);
                adjustment.max = neutral.sweep_to(counter_clockwise);
            }
        }
        settings.set_servo(servo, adjustment);
        self.replace_settings(&settings)
    }

    /// Replaces all settings.
    #[inline(never)]
    pub(super) fn replace_settings(&mut self, settings: &Settings) -> Result<(), Refusal> {
        let mut calibration = *self.motion.calibration();
        for servo in Servo::all() {
            let new_calibration = servo.of_mut(&mut calibration);
            *new_calibration = settings.calibration(servo, self.motion.robot());
            self.check_gaits(servo, new_calibration)?;
        }
        for servo in Servo::all() {
            self.check_poses(servo, servo.of(&calibration))?;
        }
        self.settings = *settings;
        self.motion.calibrate_all(&calibration);
        self.motion.settle();
        Ok(())
    }

    /// Checks that no gait leaves a servo's travel.
    #[inline(never)]
    fn check_gaits(&self, servo: Servo, calibration: &Calibration) -> Result<(), Refusal> {
        match self.motion.robot().reach(servo).is_within(calibration) {
            true => Ok(()),
            false => Err(Refusal::TravelTooNarrow(servo)),
        }
    }

    /// Checks that the present pose and the target stay within a servo's travel.
    #[inline(never)]
    fn check_poses(&self, servo: Servo, calibration: &Calibration) -> Result<(), Refusal> {
        match self.motion.goes_beyond(servo, calibration) {
            false => Ok(()),
            true => Err(Refusal::PoseOutsideTravel(servo)),
        }
    }

    /// Applies the calibration in the settings to the motion.
    pub(super) fn apply_calibration(&mut self) {
        for servo in Servo::all() {
            let calibration = self.settings.calibration(servo, self.motion.robot());
            self.motion.calibrate(servo, calibration);
        }
    }
}
