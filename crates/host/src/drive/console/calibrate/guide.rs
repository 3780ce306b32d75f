//! The guide through a calibration: the robot's movements in each step, and each key's effect.
//!
//! The signs are checked before the trims: with a wrong sign, a servo would turn against the arrow keys.

use std::io::{Read, Write};
use std::time::Duration;

use lizard_calibrate::{ConsoleError, ReplyError, SCALE_TURNS_DEG, SIGN_TURNS_DEG, send_command};
use lizard_robot::Status;
use pollster::block_on;

use super::super::deadman::{DRIVING_DEADMAN_MS, limit_deadman_ms};
use super::super::link::{BANNER_START, Link, LinkError};
use step::{Step, list_steps};
pub use view::StepView;

/// The message after a reset, in which the robot has lost its unsaved settings.
const RESET_MESSAGE: &str = "The board was reset: leave with q and start again.";

/// A key with a meaning in the guide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Key {
    /// Go to the next step.
    Next,
    /// Go to the previous step.
    Back,
    /// Leave the guide, and discard the changes since the last save.
    Leave,
    /// The space bar: perform the step's action.
    Act,
    /// Answer yes.
    Yes,
    /// Answer no.
    No,
    /// The left or right arrow: turn the servo by this many degrees, counter-clockwise if positive; or move its first
    /// limit by 1 degree in this direction.
    LeftRight(f64),
    /// The up or down arrow: as [`Key::LeftRight`], but moves the second limit.
    UpDown(f64),
}

/// A calibration in progress.
#[derive(Debug)]
pub struct Guide<'a, P> {
    robot: lizard_calibrate::Session<&'a mut Link<P>>,
    /// The neutral angles of A1 to A4, degrees.
    neutral_angles: [f64; 4],
    /// All steps, in order.
    steps: Vec<Step>,
    step_index: usize,
    /// The angle by which this step has moved its servo, degrees; `None` before the movement.
    moved_degrees: Option<f64>,
    /// True if the user has skipped the steps for scales and limits.
    has_skipped_scales_and_limits: bool,
    is_walking: bool,
    /// The robot's own `deadman`, ms, while another value is set for the test walk, so that the robot stops if its
    /// cable is pulled out; otherwise `None`.
    own_deadman_ms: Option<u16>,
    /// True once the user has saved a calibration.
    has_saved: bool,
    /// The result of the last key, in words.
    message: String,
}

type Result<T> = std::result::Result<T, ConsoleError<LinkError>>;

impl<'a, P: Read + Write> Guide<'a, P> {
    /// Reads the robot's calibration and makes the robot stand.
    ///
    /// # Errors
    /// Fails if there is no answer, or the robot cannot stand.
    pub fn new(link: &'a mut Link<P>) -> std::result::Result<Self, LinkError> {
        let mut robot = block_on(lizard_calibrate::Session::begin(link))?;
        if robot.calibration().deadman == DRIVING_DEADMAN_MS {
            // A program that ended during a drive has left this value.
            block_on(send_command(robot.console(), "deadman 0"))?;
            block_on(robot.read_again())?;
        }
        let neutral_angles = block_on(robot.stand())?;
        Ok(Self {
            robot,
            neutral_angles,
            steps: list_steps(),
            step_index: 0,
            moved_degrees: None,
            has_skipped_scales_and_limits: false,
            is_walking: false,
            own_deadman_ms: None,
            has_saved: false,
            message: String::new(),
        })
    }

    fn step(&self) -> Step {
        self.steps[self.step_index]
    }

    /// True once the user has saved a calibration. Later changes are discarded when the user leaves.
    pub fn has_saved(&self) -> bool {
        self.has_saved
    }

    /// Handles a key. Returns true when the user has finished or cancelled.
    ///
    /// # Errors
    /// Fails if the connection breaks, or the robot refuses the old calibration when the user leaves. Other refusals
    /// are shown to the user.
    pub fn press_key(&mut self, key: Key) -> std::result::Result<bool, LinkError> {
        self.message.clear();
        let result = match (key, self.step()) {
            (Key::Leave | Key::Next, Step::Saved) => return Ok(true),
            (Key::Leave, _) => {
                self.leave()?;
                return Ok(true);
            }
            (Key::Back, Step::Walk) if self.has_skipped_scales_and_limits => {
                self.go_to_step(Step::OfferScales)
            }
            (Key::Back, _) => self.enter_step(self.step_index.saturating_sub(1)),
            (Key::Next, Step::OfferScales) => {
                self.has_skipped_scales_and_limits = true;
                self.go_to_step(Step::Walk)
            }
            (Key::Yes, Step::OfferScales) => {
                self.has_skipped_scales_and_limits = false;
                self.enter_step(self.step_index + 1)
            }
            (Key::Next, Step::Sign(_)) => {
                self.message = "Press the space bar, look, then answer with y or n.".to_owned();
                Ok(())
            }
            (Key::Next, Step::Save) => self.save(),
            (Key::Next, _) => self.enter_step(self.step_index + 1),
            (Key::Act, Step::Sign(servo)) => self.move_servo(servo, &SIGN_TURNS_DEG),
            (Key::Act, Step::Scale(servo)) => self.move_servo(servo, &SCALE_TURNS_DEG),
            (Key::LeftRight(degrees) | Key::UpDown(degrees), Step::Scale(servo)) => {
                self.change_scale(servo, degrees)
            }
            (Key::LeftRight(degrees), Step::Limit(servo)) => {
                self.change_limit(servo, 0, degrees.signum())
            }
            (Key::UpDown(degrees), Step::Limit(servo)) => {
                self.change_limit(servo, 1, degrees.signum())
            }
            (Key::Yes | Key::No, Step::Sign(servo)) => self.answer_sign(servo, key),
            (Key::LeftRight(degrees) | Key::UpDown(degrees), Step::Trim(servo)) => {
                block_on(self.robot.change_trim(servo, degrees))
            }
            (Key::Act, Step::Walk) => self.toggle_walk(),
            _ => Ok(()),
        };
        match result {
            Err(ConsoleError::Reply(ReplyError::Refused { line, reason })) => {
                self.message = format!("The robot refuses `{line}`: err {reason}.");
            }
            result => result?,
        }
        if self.robot.take_reset() {
            self.message = RESET_MESSAGE.to_owned();
        }
        Ok(false)
    }

    /// Reads the robot's messages while no key is pressed.
    ///
    /// # Errors
    /// Fails if the connection breaks.
    pub fn read_messages(&mut self) -> std::result::Result<(), LinkError> {
        while let Some(line) = self.robot.console().read_line(Duration::ZERO)? {
            self.show_message(&line);
        }
        if self.is_walking {
            // The line also prevents `deadman` from ending the gait.
            let reply = self.robot.console().ask("status")?;
            for line in &reply.notes {
                self.show_message(line);
            }
            self.is_walking =
                Status::parse(&reply.answer).is_some_and(|status| status.is_walking());
        }
        Ok(())
    }

    /// Shows a line that the robot printed without being asked. The message about a reset stays until the next key.
    fn show_message(&mut self, line: &str) {
        if line.starts_with(BANNER_START) {
            self.message = RESET_MESSAGE.to_owned();
        } else if let Some(note) = line.strip_prefix("# ")
            && self.message != RESET_MESSAGE
        {
            self.message = format!("Message from the robot: {note}.");
        }
    }

    fn leave(&mut self) -> Result<()> {
        self.is_walking = false;
        block_on(self.robot.restore())?;
        self.restore_deadman()
    }

    /// Restores the robot's own `deadman` after a test walk.
    fn restore_deadman(&mut self) -> Result<()> {
        if let Some(own_ms) = self.own_deadman_ms {
            block_on(send_command(
                self.robot.console(),
                &format!("deadman {own_ms}"),
            ))?;
            self.own_deadman_ms = None;
            // After a reset, the settings were read while `deadman` was set.
            if self.robot.calibration().deadman != own_ms {
                block_on(self.robot.read_again())?;
            }
        }
        Ok(())
    }

    fn save(&mut self) -> Result<()> {
        block_on(self.robot.save())?;
        self.has_saved = true;
        self.enter_step(self.step_index + 1)
    }

    fn go_to_step(&mut self, step: Step) -> Result<()> {
        let index = self.steps.iter().position(|candidate| *candidate == step);
        self.enter_step(index.unwrap_or(self.step_index))
    }

    fn enter_step(&mut self, index: usize) -> Result<()> {
        let is_horns = self.steps[index] == Step::Horns;
        if is_horns || self.step() != Step::Save {
            self.stand()?;
        }
        if is_horns {
            block_on(self.robot.center_servos())?;
        }
        self.step_index = index;
        Ok(())
    }

    fn stand(&mut self) -> Result<()> {
        self.neutral_angles = block_on(self.robot.stand())?;
        self.is_walking = false;
        self.moved_degrees = None;
        self.restore_deadman()
    }

    /// Moves one servo by the first of `angles` (degrees) that the robot accepts.
    fn move_servo(&mut self, servo: usize, angles: &[f64]) -> Result<()> {
        self.moved_degrees = None;
        self.moved_degrees = Some(block_on(self.robot.turn_servo(servo, angles))?);
        self.message = format!("A{} has moved.", servo + 1);
        Ok(())
    }

    /// Changes the scale of the moved servo so that it turns `degrees` further counter-clockwise.
    fn change_scale(&mut self, servo: usize, degrees: f64) -> Result<()> {
        let Some(commanded_degrees) = self.moved_degrees else {
            self.message = "Press the space bar first, and look where the crank points.".to_owned();
            return Ok(());
        };
        let scale = self.robot.calibration().servos[servo].scale;
        block_on(
            self.robot
                .set_scale(servo, scale * (1.0 + degrees / commanded_degrees)),
        )
    }

    /// Moves the first (`index` 0) or second (1) limit of a servo's travel by `degrees`.
    fn change_limit(&mut self, servo: usize, index: usize, degrees: f64) -> Result<()> {
        let mut limits = self.robot.calibration().servos[servo].limit;
        limits[index] += degrees;
        block_on(self.robot.set_limit(servo, limits))
    }

    fn answer_sign(&mut self, servo: usize, answer: Key) -> Result<()> {
        if self.moved_degrees.is_none() {
            self.message =
                "Press the space bar first, and look which way the servo turns.".to_owned();
            return Ok(());
        }
        if answer == Key::Yes {
            return self.enter_step(self.step_index + 1);
        }
        self.moved_degrees = None;
        block_on(self.robot.reverse_sign(servo))?;
        self.message = format!(
            "The sign of A{} is `{}` now. Press the space bar to look once more.",
            servo + 1,
            self.robot.calibration().servos[servo].dir
        );
        Ok(())
    }

    fn toggle_walk(&mut self) -> Result<()> {
        if self.is_walking {
            return self.stand();
        }
        let own_ms = self.robot.calibration().deadman;
        let deadman_ms = limit_deadman_ms(*self.own_deadman_ms.get_or_insert(own_ms));
        block_on(send_command(
            self.robot.console(),
            &format!("deadman {deadman_ms}"),
        ))?;
        let gait = block_on(self.robot.start_walk())?;
        self.is_walking = gait.is_some();
        self.message = gait.map_or(
            "This robot has no gait except `stand`.".to_owned(),
            |gait| format!("The robot performs `{gait}`."),
        );
        Ok(())
    }
}

mod step;
#[cfg(test)]
mod tests;
mod view;
