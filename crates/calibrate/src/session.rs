//! A calibration session: the movements of its steps, and the settings computed from a person's observations.

use lizard_robot::{Calibration, ServoSettings, round_to_hundredths};

use crate::Result;
use crate::console::{Console, Reply, send_command};
use crate::settings::{ReplaceError, read_settings, replace_settings, send_settings};
use crate::still::wait_until_still;

/// Turns for the check of a servo's sign, degrees. The first turn that the robot accepts is used.
pub const SIGN_TURNS_DEG: [f64; 4] = [10.0, 5.0, -10.0, -5.0];
/// Turns for the measurement of a servo's scale, degrees. The first turn that the robot accepts is used; a larger turn
/// gives a more accurate scale.
pub const SCALE_TURNS_DEG: [f64; 8] = [30.0, -30.0, 20.0, -20.0, 15.0, -15.0, 10.0, -10.0];

/// A calibration in progress. Angles are in degrees, counter-clockwise; a servo is 0 to 3 for A1 to A4.
///
/// Every function fails if the connection breaks or if the robot refuses a line. A refusal leaves the settings
/// unchanged. The robot may have executed a line whose answer was lost, so the next function that needs the settings
/// reads them again.
#[derive(Debug)]
pub struct Session<C> {
    console: C,
    /// The settings that the session restores: the settings at the start or at the last save.
    saved: Calibration,
    /// The active settings.
    active: Calibration,
    /// The neutral angles; `None` before the first `stand`.
    neutral_deg: Option<[f64; 4]>,
    /// True after an unanswered line: the robot's settings may differ from `active`.
    may_be_outdated: bool,
    /// The settings of an unanswered `save`.
    unanswered_save: Option<Calibration>,
    /// The number of frames since the robot's reset in its latest status.
    frame_count: u64,
    /// True after a reset, until the next call of [`Session::take_reset`].
    was_reset: bool,
}

impl<C: Console> Session<C> {
    /// Reads the robot's settings; nothing moves.
    ///
    /// # Errors
    /// Fails if the robot does not answer, or if its answer has an unknown format.
    pub async fn begin(mut console: C) -> Result<Self, C> {
        let active = read_settings(&mut console).await?;
        Ok(Self {
            console,
            saved: active.clone(),
            active,
            neutral_deg: None,
            may_be_outdated: false,
            unanswered_save: None,
            frame_count: 0,
            was_reset: false,
        })
    }

    /// The connection to the robot.
    pub fn console(&mut self) -> &mut C {
        &mut self.console
    }

    /// The active settings, saved or not.
    pub fn calibration(&self) -> &Calibration {
        &self.active
    }

    /// True if the active settings are not saved, or may not be.
    pub fn has_unsaved_changes(&self) -> bool {
        self.may_be_outdated || !self.active.is_equivalent_to(&self.saved)
    }

    /// Returns true if a reset of the robot was noticed since the last call. The robot has then lost its unsaved
    /// settings, and the active settings were read again.
    pub fn take_reset(&mut self) -> bool {
        std::mem::take(&mut self.was_reset)
    }

    /// Reads the settings again, because another program may have changed them. If the session has no unsaved changes,
    /// [`Session::restore`] keeps the other program's changes.
    ///
    /// # Errors
    /// Fails if the robot does not answer, or if its answer has an unknown format.
    pub async fn read_again(&mut self) -> Result<(), C> {
        let has_changes = self.has_unsaved_changes();
        // If this fails, the session is unchanged, and the next call decides again.
        self.active = read_settings(&mut self.console).await?;
        self.may_be_outdated = false;
        if !has_changes {
            self.saved = self.active.clone();
        }
        Ok(())
    }

    /// Makes the robot stand; returns the neutral angles, degrees.
    ///
    /// # Errors
    /// Fails if the robot cannot stand.
    pub async fn stand(&mut self) -> Result<[f64; 4], C> {
        self.send_line("stand").await?;
        let neutral_deg = self.wait_until_still().await?;
        self.neutral_deg = Some(neutral_deg);
        Ok(neutral_deg)
    }

    /// Stops the pulses, so that no servo moves when the servos get power.
    ///
    /// # Errors
    /// Fails if the connection breaks.
    pub async fn rest(&mut self) -> Result<(), C> {
        self.send_line("rest").await.map(drop)
    }

    /// Moves every servo to its middle, without its trim, for fitting the horns.
    ///
    /// # Errors
    /// Fails if the robot cannot stand.
    pub async fn center_servos(&mut self) -> Result<(), C> {
        self.stand().await?;
        self.send_line("center").await?;
        self.wait_until_still().await.map(drop)
    }

    /// Turns one servo from its neutral angle by the first turn that the robot accepts; returns this turn, degrees.
    ///
    /// # Errors
    /// Fails if the robot refuses all turns.
    pub async fn turn_servo(&mut self, servo: usize, turns_deg: &[f64]) -> Result<f64, C> {
        let neutral_deg = self.stand().await?;
        let mut refusal = None;
        for turn_deg in turns_deg {
            match self.move_servo(servo, neutral_deg[servo] + turn_deg).await {
                Ok(_) => return Ok(*turn_deg),
                Err(error) if error.is_refusal() => refusal = refusal.or(Some(error)),
                Err(error) => return Err(error),
            }
        }
        refusal.map_or(Ok(0.0), Err)
    }

    /// Moves one servo to an angle, and the others to neutral; returns the sent angle, from 0 to 360 degrees.
    ///
    /// # Errors
    /// Fails if the robot refuses this pose.
    pub async fn move_servo(&mut self, servo: usize, angle_deg: f64) -> Result<f64, C> {
        let mut pose = match self.neutral_deg {
            Some(neutral_deg) => neutral_deg,
            None => self.stand().await?,
        };
        pose[servo] = wrap_degrees(angle_deg);
        let [a1, a2, a3, a4] = pose;
        self.send_line(&format!("pose {a1:.2} {a2:.2} {a3:.2} {a4:.2}"))
            .await?;
        self.wait_until_still().await?;
        Ok(pose[servo])
    }

    /// Reverses a servo's sign, and also the trim, so that the neutral pulse width stays the same. After a reset,
    /// changes nothing until [`Session::take_reset`] is called.
    ///
    /// # Errors
    /// Fails if the robot cannot stand.
    pub async fn reverse_sign(&mut self, servo: usize) -> Result<(), C> {
        self.stand().await?;
        // The user chose the change for settings that the reset has undone.
        if self.was_reset {
            return Ok(());
        }
        self.refresh().await?;
        let new = self.active.servos[servo].reversed();
        let format_line = |settings: ServoSettings| format!("dir {} {}", servo + 1, settings.dir);
        self.set_with_trim(servo, new, format_line).await?;
        self.wait_until_still().await.map(drop)
    }

    /// Changes a servo's trim by an angle.
    ///
    /// # Errors
    /// Fails if the trim would be too large.
    pub async fn change_trim(&mut self, servo: usize, change_deg: f64) -> Result<(), C> {
        self.refresh().await?;
        let mut new = self.active.servos[servo];
        new.trim = round_to_hundredths(new.trim + change_deg);
        self.send_line(&format_trim(servo, new)).await?;
        self.active.servos[servo] = new;
        Ok(())
    }

    /// Sets a servo's scale, us per degree, and converts the trim, so that the neutral pulse width stays the same.
    ///
    /// # Errors
    /// Fails if the robot refuses the scale or the converted trim.
    pub async fn set_scale(&mut self, servo: usize, scale: f64) -> Result<(), C> {
        self.refresh().await?;
        let new = self.active.servos[servo].with_scale(scale);
        let format_line =
            |settings: ServoSettings| format!("scale {} {:.2}", servo + 1, settings.scale);
        self.set_with_trim(servo, new, format_line).await
    }

    /// Makes the robot stand, and sets a servo's scale from a commanded and a measured turn; returns the scale, us per
    /// degree. After a reset, changes nothing until [`Session::take_reset`] is called.
    ///
    /// # Errors
    /// Fails if the robot refuses the scale or the converted trim.
    pub async fn set_scale_from_turn(
        &mut self,
        servo: usize,
        commanded_deg: f64,
        measured_deg: f64,
    ) -> Result<f64, C> {
        self.stand().await?;
        if self.was_reset {
            return Ok(self.active.servos[servo].scale);
        }
        self.refresh().await?;
        let scale = self.active.servos[servo].scale * (commanded_deg / measured_deg).abs();
        self.set_scale(servo, scale).await?;
        Ok(self.active.servos[servo].scale)
    }

    /// Sets a servo's travel, counter-clockwise from the first angle to the second.
    ///
    /// # Errors
    /// Fails if a gait needs a larger travel.
    pub async fn set_limit(&mut self, servo: usize, ends_deg: [f64; 2]) -> Result<(), C> {
        self.refresh().await?;
        let limit = ends_deg.map(wrap_degrees);
        let [min, max] = limit;
        self.send_line(&format!("limit {} {min:.2} {max:.2}", servo + 1))
            .await?;
        self.active.servos[servo].limit = limit;
        Ok(())
    }

    /// Starts a test walk: `walk` if the robot has it, otherwise its first gait other than `stand`. Returns the gait's
    /// name, or `None` if `stand` is the only gait.
    ///
    /// # Errors
    /// Fails if the robot cannot walk now.
    pub async fn start_walk(&mut self) -> Result<Option<String>, C> {
        let notes = self.send_line("help").await?.notes;
        let gait_lists = notes
            .iter()
            .filter_map(|line| line.strip_prefix("# gaits: "));
        let gaits = gait_lists.flat_map(|names| names.split('|'));
        let gaits: Vec<&str> = gaits.filter(|name| *name != "stand").collect();
        let walk = gaits.iter().find(|name| **name == "walk");
        let Some(gait) = walk.or(gaits.first()) else {
            return Ok(None);
        };
        self.send_line(gait).await?;
        Ok(Some((*gait).to_owned()))
    }

    /// Saves the active settings on the board. If the board has lost them by a reset, first sends them again.
    ///
    /// # Errors
    /// Fails if the robot cannot save now, or refuses a setting. After an error while the settings are sent, the robot
    /// may have only some of them; another `save` sends them again.
    pub async fn save(&mut self) -> Result<(), C> {
        self.refresh().await?;
        // Only a wait for the end of a movement notices a reset.
        let robot_settings = read_settings(&mut self.console).await?;
        if !robot_settings.is_equivalent_to(&self.active) {
            send_settings(&mut self.console, &self.active).await?;
        }
        let result = self.send_line("save").await;
        self.unanswered_save = self.may_be_outdated.then(|| self.active.clone());
        result?;
        self.saved = self.active.clone();
        Ok(())
    }

    /// Makes the robot stand, and restores the settings at the start or at the last save; returns true if other
    /// settings were active. If a `save` was not answered, first makes the board load its saved settings.
    ///
    /// # Errors
    /// Fails if the robot refuses a setting. Restores the settings even if the robot refuses to stand, for example at a
    /// low supply voltage.
    pub async fn restore(&mut self) -> Result<bool, C> {
        match self.stand().await {
            Err(error) if !error.is_refusal() => return Err(error),
            _ => {}
        }
        if let Some(unanswered) = &self.unanswered_save {
            // `load` replaces the robot's active settings.
            self.may_be_outdated = true;
            if load_and_compare(&mut self.console, unanswered).await? {
                self.saved = unanswered.clone();
            }
        }
        let is_changed = !self.active.is_equivalent_to(&self.saved);
        if is_changed || self.may_be_outdated {
            self.may_be_outdated = true;
            send_settings(&mut self.console, &self.saved).await?;
            self.active = self.saved.clone();
            self.may_be_outdated = false;
        }
        self.unanswered_save = None;
        Ok(is_changed)
    }

    /// Replaces the active settings without saving the new ones.
    ///
    /// # Errors
    /// Fails if the robot refuses settings or reports other values. The robot then has its old settings, except after
    /// [`ReplaceError::Mixed`].
    pub async fn replace(
        &mut self,
        calibration: &Calibration,
    ) -> std::result::Result<(), ReplaceError<C::Error>> {
        self.refresh().await.map_err(ReplaceError::Refused)?;
        let result = replace_settings(&mut self.console, &self.active, calibration).await;
        match &result {
            Ok(()) => self.active = calibration.clone(),
            Err(ReplaceError::Mixed(_)) => self.may_be_outdated = true,
            Err(_) => {}
        }
        result
    }

    /// Sends the line of a servo's new sign or scale, and the new trim. If the robot refuses the trim, sends the old
    /// sign or scale again.
    async fn set_with_trim(
        &mut self,
        servo: usize,
        new: ServoSettings,
        format_line: impl Fn(ServoSettings) -> String,
    ) -> Result<(), C> {
        let old = self.active.servos[servo];
        self.send_line(&format_line(new)).await?;
        if new.trim != old.trim
            && let Err(error) = self.send_line(&format_trim(servo, new)).await
        {
            if error.is_refusal() {
                self.send_line(&format_line(old)).await?;
            }
            return Err(error);
        }
        self.active.servos[servo] = new;
        Ok(())
    }

    /// Waits until the robot stands still, and returns its pose, degrees. After a reset, reads the settings again.
    async fn wait_until_still(&mut self) -> Result<[f64; 4], C> {
        let wait = wait_until_still(&mut self.console, &mut self.frame_count);
        let (pose, was_reset) = wait.await?;
        if was_reset {
            self.was_reset = true;
            self.may_be_outdated = true;
            self.refresh().await?;
        }
        Ok(pose)
    }

    /// Sends a line, and records a missing answer.
    async fn send_line(&mut self, line: &str) -> Result<Reply, C> {
        let result = send_command(&mut self.console, line).await;
        self.may_be_outdated |= matches!(&result, Err(error) if !error.is_refusal());
        result
    }

    /// Reads the settings again if a line was not answered.
    async fn refresh(&mut self) -> Result<(), C> {
        if self.may_be_outdated {
            self.active = read_settings(&mut self.console).await?;
            self.may_be_outdated = false;
        }
        Ok(())
    }
}

/// Makes a robot load its saved settings; returns true if they are equivalent to `calibration`.
async fn load_and_compare<C: Console>(
    console: &mut C,
    calibration: &Calibration,
) -> Result<bool, C> {
    match send_command(console, "load").await {
        Ok(_) => Ok(read_settings(console).await?.is_equivalent_to(calibration)),
        Err(error) if error.is_refusal() => Ok(false),
        Err(error) => Err(error),
    }
}

/// Formats the line that sets a servo's trim.
fn format_trim(servo: usize, settings: ServoSettings) -> String {
    format!("trim {} {:.2}", servo + 1, settings.trim)
}

/// Rounds an angle as the console does, and wraps it to the range from 0 to 360 degrees.
fn wrap_degrees(angle_deg: f64) -> f64 {
    round_to_hundredths(angle_deg).rem_euclid(360.0)
}
