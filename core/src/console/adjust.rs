//! How settings of the servos take effect: at once, and only where the robot can do with
//! them what it does.

use super::{Console, Refused};
use crate::command::Command;
use crate::part::Servo;
use crate::refusal::Refusal;
use crate::robot::Robot;
use crate::settings::Settings;
use crate::units::{Angle, Sweep};
use crate::word::Word;

impl<R: Robot> Console<R> {
    /// Sets something of a servo, if the robot can do with it what it does.
    #[inline(never)]
    pub(super) fn set_servo(&mut self, what: Word, command: &Command) -> Result<(), Refused> {
        let [number, second, ..] = command.numbers;
        let place = usize::from(command.servo);
        let before = self.settings.servo(place);
        let mut set = before;
        match what {
            Word::Trim => set.trim = Sweep(number as i16),
            Word::Dir => set.set_direct(number != 0),
            Word::Scale => set.set_scale(number),
            _ => {
                let neutral = self.motion.robot().neutral_of(place);
                set.min = neutral.sweep_to(Angle(number));
                set.max = neutral.sweep_to(Angle(second));
            }
        }
        self.settings.set_servo(place, set);
        let adjusted = self.adjust();
        if adjusted.is_err() {
            self.settings.set_servo(place, before);
        }
        adjusted
    }

    /// Takes other settings, or keeps those that there are.
    #[inline(never)]
    pub(super) fn replace(&mut self, settings: &Settings) -> Result<(), Refused> {
        let before = self.settings;
        self.settings = *settings;
        let adjusted = self.adjust();
        if adjusted.is_err() {
            self.settings = before;
        }
        adjusted
    }

    /// Puts the settings into effect at once, if the robot can do with them what it
    /// does; if not, they have to be taken back.
    #[inline(never)]
    fn adjust(&mut self) -> Result<(), Refused> {
        let robot = self.motion.robot();
        if let Some(servo) = self.settings.unfit(robot) {
            return self.refuse(Refusal::Unfit(servo));
        }
        for place in 0..4 {
            let calibration = self.settings.calibration(place, robot);
            if self.motion.goes_beyond(place, &calibration) {
                return self.refuse(Refusal::Elsewhere(Servo::at(place)));
            }
        }
        self.calibrate();
        Ok(())
    }

    /// Hands the motion what the settings say of the servos.
    #[inline(never)]
    pub(super) fn calibrate(&mut self) {
        for place in 0..4 {
            let calibration = self.settings.calibration(place, self.motion.robot());
            self.motion.calibrate(place, calibration);
        }
        self.motion.settle();
    }
}
