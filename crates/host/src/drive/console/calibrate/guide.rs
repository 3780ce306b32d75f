//! The steps of a calibration: the robot's movements in each, and the effect of each key.
//!
//! The signs are checked before the trims: with the wrong sign a servo would turn against the
//! arrow keys.

use std::io::{Read, Write};
use std::time::Duration;

use lizard_robot::{Calibration, STILL_FRAMES, ServoSettings};

use super::super::calibration;
use super::super::link::{BANNER, Link, LinkError};
use super::super::status::Status;
use crate::drive::clock::Deadline;
use step::{STEPS, Step};
pub use view::View;

/// Angles by which a servo is moved to check its sign, degrees; the first that the robot
/// accepts is used.
const SIGN_ANGLES: [f64; 4] = [10.0, 5.0, -10.0, -5.0];
/// Angles by which a servo is moved to measure its scale, degrees; the first that the robot
/// accepts is used. A larger angle measures more exactly.
const SCALE_ANGLES: [f64; 6] = [30.0, -30.0, 20.0, -20.0, 10.0, -10.0];
/// The longest time to wait for the end of a motion.
const MOTION_TIMEOUT: Duration = Duration::from_secs(5);
/// Interval between two `status` commands while waiting for the end of a motion.
const STATUS_INTERVAL: Duration = Duration::from_millis(25);

/// A key with a meaning in the guide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Key {
    /// Go to the next step.
    Next,
    /// Go to the previous step.
    Back,
    /// Leave, and drop the changes since the last save.
    Leave,
    /// Perform the action of the step.
    Act,
    /// Answer yes.
    Yes,
    /// Answer no.
    No,
    /// Turn the servo by this many degrees, counter-clockwise if positive.
    Turn(f64),
}

/// A calibration in progress.
#[derive(Debug)]
pub struct Guide<'a, P> {
    link: &'a mut Link<P>,
    /// The calibration at the beginning, or after the last save.
    saved_calibration: Calibration,
    /// The calibration that is active now.
    active_calibration: Calibration,
    /// The neutral angles, degrees.
    neutral: [f64; 4],
    step_index: usize,
    /// The angle by which this step has moved its servo, degrees; `None` if it has not.
    moved_degrees: Option<f64>,
    /// True if scales and limits are skipped.
    skips_scales: bool,
    is_walking: bool,
    message: String,
}

impl<'a, P: Read + Write> Guide<'a, P> {
    /// Reads the robot's calibration, and makes the robot stand.
    ///
    /// # Errors
    /// Fails if there is no answer, or the robot cannot stand.
    pub fn new(link: &'a mut Link<P>) -> Result<Self, LinkError> {
        let initial = calibration::ask(link)?;
        link.command("stand")?;
        let pose = wait_until_still(link)?;
        Ok(Self {
            link,
            active_calibration: initial.clone(),
            saved_calibration: initial,
            neutral: pose,
            step_index: 0,
            moved_degrees: None,
            skips_scales: false,
            is_walking: false,
            message: String::new(),
        })
    }

    fn step(&self) -> Step {
        STEPS[self.step_index]
    }

    /// True if the active calibration is saved.
    pub fn is_saved(&self) -> bool {
        self.step() == Step::Saved
    }

    /// Handles a key. Returns true when the user has finished or cancelled.
    ///
    /// # Errors
    /// Fails if the connection breaks, or the robot refuses to restore the calibration when the
    /// user leaves. Other refusals are not errors: they are shown.
    pub fn press_key(&mut self, key: Key) -> Result<bool, LinkError> {
        self.message.clear();
        let result = match (key, self.step()) {
            (Key::Leave, Step::Saved) | (Key::Next, Step::Saved) => Ok(true),
            (Key::Leave, _) => self.leave().map(|()| true),
            (Key::Back, Step::Walk) if self.skips_scales => {
                self.go_to_step(Step::More).map(|()| false)
            }
            (Key::Back, _) => self
                .enter_step(self.step_index.saturating_sub(1))
                .map(|()| false),
            (Key::Next, Step::More) => {
                self.skips_scales = true;
                self.go_to_step(Step::Walk).map(|()| false)
            }
            (Key::Yes, Step::More) => {
                self.skips_scales = false;
                self.enter_step(self.step_index + 1).map(|()| false)
            }
            (Key::Next, Step::Sign(_)) => {
                self.message = "Press the space bar, look, then answer with y or n.".to_owned();
                Ok(false)
            }
            (Key::Next, Step::Save) => self.save().map(|()| false),
            (Key::Next, _) => self.enter_step(self.step_index + 1).map(|()| false),
            (Key::Act, Step::Sign(servo)) => self.move_servo(servo, &SIGN_ANGLES).map(|()| false),
            (Key::Act, Step::Scale(servo)) => self.move_servo(servo, &SCALE_ANGLES).map(|()| false),
            (Key::Turn(degrees), Step::Scale(servo)) => {
                self.change_scale(servo, degrees).map(|()| false)
            }
            (Key::Turn(degrees), Step::Limit(servo)) => {
                self.change_limit(servo, degrees).map(|()| false)
            }
            (Key::Yes | Key::No, Step::Sign(servo)) => self.answer_sign(servo, key).map(|()| false),
            (Key::Turn(degrees), Step::Trim(servo)) => {
                self.change_trim(servo, degrees).map(|()| false)
            }
            (Key::Act, Step::Walk) => self.set_walking(!self.is_walking).map(|()| false),
            _ => Ok(false),
        };
        match result {
            Err(LinkError::Refused { line, reason }) if key != Key::Leave => {
                self.message = format!("The robot refuses `{line}`: {reason}.");
                Ok(false)
            }
            result => result,
        }
    }

    /// Reads the robot's messages while no key is pressed.
    ///
    /// # Errors
    /// Fails if the connection breaks.
    pub fn read_messages(&mut self) -> Result<(), LinkError> {
        while let Some(line) = self.link.line(Duration::ZERO)? {
            if line.starts_with(BANNER) {
                self.message = "The board was reset: leave with q and begin again.".to_owned();
            } else if let Some(note) = line.strip_prefix("# ") {
                self.message = format!("The robot says: {note}.");
            }
        }
        if self.is_walking {
            // This question also keeps `deadman` from ending the gait.
            let reply = self.link.ask("status")?;
            self.is_walking = Status::parse(&reply.answer).is_some_and(|status| status.is_moving());
        }
        Ok(())
    }

    /// Makes the robot stand, and restores the calibration of the beginning or the last save.
    fn leave(&mut self) -> Result<(), LinkError> {
        match self.stand() {
            // The supply may be too low to stand; the guide ends anyway.
            Ok(()) | Err(LinkError::Refused { .. }) => {}
            Err(error) => return Err(error),
        }
        if self.active_calibration != self.saved_calibration {
            calibration::apply(&self.saved_calibration, self.link)?;
        }
        Ok(())
    }

    fn save(&mut self) -> Result<(), LinkError> {
        self.link.command("save")?;
        self.saved_calibration = self.active_calibration.clone();
        self.enter_step(self.step_index + 1)
    }

    fn go_to_step(&mut self, step: Step) -> Result<(), LinkError> {
        let index = STEPS.iter().position(|step_at| *step_at == step);
        self.enter_step(index.unwrap_or(self.step_index))
    }

    fn enter_step(&mut self, index: usize) -> Result<(), LinkError> {
        match STEPS[index] {
            Step::Horns => {
                self.stand()?;
                self.link.command("center")?;
                wait_until_still(self.link)?;
            }
            _ if self.step() == Step::Save => {}
            _ => self.stand()?,
        }
        self.step_index = index;
        Ok(())
    }

    fn stand(&mut self) -> Result<(), LinkError> {
        self.link.command("stand")?;
        self.is_walking = false;
        self.moved_degrees = None;
        wait_until_still(self.link)?;
        Ok(())
    }

    /// Moves one servo by the first of these angles (degrees) that the robot accepts.
    fn move_servo(&mut self, servo: usize, angles: &[f64]) -> Result<(), LinkError> {
        self.stand()?;
        let mut refusal = None;
        for angle in angles {
            match self.turn_to(servo, *angle) {
                Ok(()) => {
                    self.message = format!("A{} has moved.", servo + 1);
                    return Ok(());
                }
                Err(error @ LinkError::Refused { .. }) => refusal = Some(error),
                Err(error) => return Err(error),
            }
        }
        refusal.map_or(Ok(()), Err)
    }

    /// Moves one servo to this many degrees from its neutral angle, and the others to their neutral angles.
    fn turn_to(&mut self, servo: usize, degrees: f64) -> Result<(), LinkError> {
        let mut pose = self.neutral;
        pose[servo] = (pose[servo] + degrees).rem_euclid(360.0);
        let [a1, a2, a3, a4] = pose;
        self.link
            .command(&format!("pose {a1:.2} {a2:.2} {a3:.2} {a4:.2}"))?;
        self.moved_degrees = Some(degrees);
        wait_until_still(self.link)?;
        Ok(())
    }

    /// Changes the scale of the servo that was moved so that it turns this many degrees further
    /// counter-clockwise. Its neutral pulse stays the same, so its trim is converted, too.
    fn change_scale(&mut self, servo: usize, degrees: f64) -> Result<(), LinkError> {
        let Some(ordered) = self.moved_degrees else {
            self.message = "Press the space bar first, and look where it points.".to_owned();
            return Ok(());
        };
        let mut next = self.active_calibration.clone();
        let old = self.active_calibration.servos[servo];
        let new = old.with_scale(old.scale * (1.0 + degrees / ordered));
        next.servos[servo] = new;
        let (servo_number, scale, trim) = (servo + 1, new.scale, new.trim);
        self.link
            .command(&format!("scale {servo_number} {scale:.2}"))?;
        if trim != old.trim
            && let Err(error) = self.link.command(&format!("trim {servo_number} {trim:.2}"))
        {
            self.link
                .command(&format!("scale {servo_number} {:.2}", old.scale))?;
            return Err(error);
        }
        self.active_calibration = next;
        Ok(())
    }

    /// Moves one limit of a servo's travel by one degree in the direction of `degrees`: the first limit for the
    /// keys of 0.5 degrees, the second limit for the keys of 0.1.
    fn change_limit(&mut self, servo: usize, degrees: f64) -> Result<(), LinkError> {
        let mut next = self.active_calibration.clone();
        let servo_settings = &mut next.servos[servo];
        let end = &mut servo_settings.limit[usize::from(degrees.abs() < 0.3)];
        *end = round_to_hundredths((*end + degrees.signum()).rem_euclid(360.0));
        let [min, max] = servo_settings.limit;
        self.link
            .command(&format!("limit {} {min:.2} {max:.2}", servo + 1))?;
        self.active_calibration = next;
        Ok(())
    }

    fn answer_sign(&mut self, servo: usize, answer: Key) -> Result<(), LinkError> {
        if self.moved_degrees.is_none() {
            self.message = "Press the space bar first, and look which way it turns.".to_owned();
            return Ok(());
        }
        if answer == Key::Yes {
            return self.enter_step(self.step_index + 1);
        }
        self.stand()?;
        let servo_number = servo + 1;
        let mut next = self.active_calibration.clone();
        next.servos[servo] = next.servos[servo].reversed();
        let ServoSettings { dir, trim, .. } = next.servos[servo];
        self.link.command(&format!("dir {servo_number} {dir}"))?;
        if trim != 0.0 {
            self.link
                .command(&format!("trim {servo_number} {trim:.2}"))?;
        }
        self.active_calibration = next;
        wait_until_still(self.link)?;
        self.message = format!(
            "The sign of A{servo_number} is `{dir}` now. Press the space bar to look once more."
        );
        Ok(())
    }

    fn change_trim(&mut self, servo: usize, degrees: f64) -> Result<(), LinkError> {
        let mut next = self.active_calibration.clone();
        let servo_settings = &mut next.servos[servo];
        servo_settings.trim = round_to_hundredths(servo_settings.trim + degrees);
        let line = format!("trim {} {:.2}", servo + 1, servo_settings.trim);
        self.link.command(&line)?;
        self.active_calibration = next;
        Ok(())
    }

    fn set_walking(&mut self, is_walking: bool) -> Result<(), LinkError> {
        if !is_walking {
            return self.stand();
        }
        let gait = self.first_gait()?;
        self.link.command(&gait)?;
        self.is_walking = true;
        self.message = format!("The robot does `{gait}`.");
        Ok(())
    }

    /// The gait for the test walk: `walk` if the robot has it, else its first gait besides `stand`, else `stand`.
    fn first_gait(&mut self) -> Result<String, LinkError> {
        let help = self.link.command("help")?;
        let gaits = help
            .notes
            .iter()
            .filter_map(|line| line.strip_prefix("# gaits: "));
        let gaits: Vec<&str> = gaits.flat_map(|names| names.split('|')).collect();
        let gait = gaits.iter().copied().find(|name| *name == "walk");
        let gait = gait.or_else(|| gaits.iter().copied().find(|name| *name != "stand"));
        Ok(gait.unwrap_or("stand").to_owned())
    }
}

/// Rounds to hundredths, as the robot does, without a negative zero.
fn round_to_hundredths(value: f64) -> f64 {
    (value * 100.0).round() / 100.0 + 0.0
}

/// Waits until the robot stands still, at most [`MOTION_TIMEOUT`], and returns its pose, degrees.
fn wait_until_still<P: Read + Write>(link: &mut Link<P>) -> Result<[f64; 4], LinkError> {
    let mut deadline = Deadline::after(MOTION_TIMEOUT);
    let mut last_status: Option<Status> = None;
    loop {
        let reply = link.command("status")?;
        let status = Status::parse(&reply.answer);
        let Some((status, pose)) = status.and_then(|status| status.pose.map(|pose| (status, pose)))
        else {
            return Err(LinkError::Unclear {
                line: "status".to_owned(),
                answer: reply.answer,
            });
        };
        let frames = status.frames;
        let frames_since = last_status
            .as_ref()
            .and_then(|last_status| frames.checked_sub(last_status.frames));
        let is_over = deadline.has_passed();
        match frames_since {
            Some(0..STILL_FRAMES) if !is_over => {}
            Some(_) if last_status.is_some_and(|last_status| last_status.pose == Some(pose)) => {
                return Ok(pose);
            }
            _ if is_over => return Ok(pose),
            _ => last_status = Some(status),
        }
        link.pause(STATUS_INTERVAL)?;
    }
}

mod step;
#[cfg(test)]
mod tests;
mod view;
