//! Changes of the servo settings.
//!
//! A change takes effect at once. It is refused if a gait, the current pose or the target would then exceed a servo's
//! travel.

use super::Controller;
use crate::control::order::Setting;
use crate::control::refusal::Refusal;
use crate::memory::settings::Settings;
use crate::numbers::calibration::Calibration;
use crate::numbers::part::Servo;

impl Controller {
    /// Changes a setting of a servo. A refusal changes nothing.
    #[inline(never)]
    pub(super) fn set_servo(&mut self, servo: Servo, setting: Setting) -> Result<(), Refusal> {
        let mut settings = self.settings;
        let mut adjustment = settings.adjustment(servo);
        match setting {
            Setting::Trim(trim) => adjustment.trim = trim,
            Setting::Direction(is_direct) => adjustment.set_direct(is_direct),
            Setting::Scale(scale) => adjustment.set_scale(scale),
            Setting::Limit(clockwise, counter_clockwise) => {
                let neutral = self.motion.robot().servo_neutral_angle(servo);
                adjustment.travel_min = neutral.sweep_to(clockwise);
                adjustment.travel_max = neutral.sweep_to(counter_clockwise);
            }
        }
        settings.set_adjustment(servo, adjustment);
        self.replace_settings(&settings)
    }

    /// Replaces all settings. A refusal changes nothing.
    #[inline(never)]
    pub(super) fn replace_settings(&mut self, settings: &Settings) -> Result<(), Refusal> {
        let mut calibrations = *self.motion.calibration();
        for servo in Servo::iter() {
            let new_calibration = servo.pick_mut(&mut calibrations);
            *new_calibration = settings.calibration(servo, self.motion.robot());
            self.check_gaits(servo, new_calibration)?;
        }
        for servo in Servo::iter() {
            self.check_poses(servo, servo.pick(&calibrations))?;
        }
        self.settings = *settings;
        self.motion.calibrate_all(&calibrations);
        self.motion.settle();
        Ok(())
    }

    /// Checks that no gait exceeds a servo's travel.
    #[inline(never)]
    fn check_gaits(&self, servo: Servo, calibration: &Calibration) -> Result<(), Refusal> {
        match self
            .motion
            .robot()
            .needed_travel(servo)
            .is_within(calibration)
        {
            true => Ok(()),
            false => Err(Refusal::TravelTooNarrow(servo)),
        }
    }

    /// Checks that the current pose and the target are within a servo's travel.
    #[inline(never)]
    fn check_poses(&self, servo: Servo, calibration: &Calibration) -> Result<(), Refusal> {
        match self.motion.exceeds_travel(servo, calibration) {
            false => Ok(()),
            true => Err(Refusal::PoseOutsideTravel(servo)),
        }
    }

    /// Calibrates the motion according to the settings.
    pub(super) fn apply_calibration(&mut self) {
        for servo in Servo::iter() {
            let calibration = self.settings.calibration(servo, self.motion.robot());
            self.motion.calibrate(servo, calibration);
        }
    }
}
