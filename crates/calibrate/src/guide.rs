//! A calibration in progress: the movements of its steps, and the settings that follow from what a person sees.

use lizard_robot::{Calibration, ServoSettings};

use crate::console::{Console, ConsoleError, Reply, command};
use crate::exchange::{SendError, read, replace, send};
use crate::still::wait_until_still;

/// Turns by which a servo is moved to check its sign, degrees; the first that the robot accepts is used.
pub const SIGN_TURNS: [f64; 4] = [10.0, 5.0, -10.0, -5.0];
/// Turns by which a servo is moved to measure its scale, degrees; the first that the robot accepts is used. A larger
/// turn measures more exactly.
pub const SCALE_TURNS: [f64; 8] = [30.0, -30.0, 20.0, -20.0, 15.0, -15.0, 10.0, -10.0];

/// A calibration in progress. Angles are in degrees, counter-clockwise; a servo is 0 to 3 for A1 to A4.
///
/// Every function fails if the connection breaks, or if the robot refuses a line; then the settings stay as they were.
/// A line whose answer was lost may have had its effect: the next function that needs the settings reads them again.
#[derive(Debug)]
pub struct Guide<C> {
    console: C,
    /// The settings at the beginning, or after the last save.
    saved: Calibration,
    /// The settings that are active now.
    active: Calibration,
    /// The neutral angles; `None` until the robot has stood.
    neutral: Option<[f64; 4]>,
    /// True after a line without an answer: the robot may have other settings than `active`.
    is_unsure: bool,
    /// The settings of a `save` that was not answered.
    unanswered_save: Option<Calibration>,
}

type Result<T, C> = std::result::Result<T, ConsoleError<<C as Console>::Error>>;

impl<C: Console> Guide<C> {
    /// Reads the robot's settings; nothing moves.
    ///
    /// # Errors
    /// Fails if there is no answer, or one that is not understood.
    pub async fn begin(mut console: C) -> Result<Self, C> {
        let active = read(&mut console).await?;
        Ok(Self {
            console,
            saved: active.clone(),
            active,
            neutral: None,
            is_unsure: false,
            unanswered_save: None,
        })
    }

    /// The connection to the robot.
    pub fn console(&mut self) -> &mut C {
        &mut self.console
    }

    /// The settings that are active now, saved or not.
    pub fn calibration(&self) -> &Calibration {
        &self.active
    }

    /// True if the active settings are not saved, or may not be.
    pub fn is_changed(&self) -> bool {
        self.is_unsure || !self.active.is_equivalent_to(&self.saved)
    }

    /// Makes the robot stand; returns its neutral angles.
    ///
    /// # Errors
    /// Fails if the robot cannot stand.
    pub async fn stand(&mut self) -> Result<[f64; 4], C> {
        self.command("stand").await?;
        let neutral = wait_until_still(&mut self.console).await?;
        self.neutral = Some(neutral);
        Ok(neutral)
    }

    /// Ends the pulses, so that no servo starts when the servos get power.
    ///
    /// # Errors
    /// Fails if the connection breaks.
    pub async fn rest(&mut self) -> Result<(), C> {
        self.command("rest").await.map(drop)
    }

    /// Moves every servo to its middle, without its trim, for fitting the horns.
    ///
    /// # Errors
    /// Fails if the robot cannot stand.
    pub async fn center(&mut self) -> Result<(), C> {
        self.stand().await?;
        self.command("center").await?;
        wait_until_still(&mut self.console).await.map(drop)
    }

    /// Turns one servo from its neutral angle by the first of some turns that the robot accepts; returns this turn.
    ///
    /// # Errors
    /// Fails if the robot refuses all of them.
    pub async fn turn(&mut self, servo: usize, turns: &[f64]) -> Result<f64, C> {
        let neutral = self.stand().await?;
        let mut refusal = None;
        for turn in turns {
            match self.point(servo, neutral[servo] + turn).await {
                Ok(_) => return Ok(*turn),
                Err(error) if error.is_refusal() => refusal = refusal.or(Some(error)),
                Err(error) => return Err(error),
            }
        }
        refusal.map_or(Ok(0.0), Err)
    }

    /// Moves one servo to an angle, and the others to neutral; returns the angle as the console has it.
    ///
    /// # Errors
    /// Fails if the robot refuses this pose.
    pub async fn point(&mut self, servo: usize, degrees: f64) -> Result<f64, C> {
        let mut pose = match self.neutral {
            Some(neutral) => neutral,
            None => self.stand().await?,
        };
        pose[servo] = wrap(degrees);
        let [a1, a2, a3, a4] = pose;
        self.command(&format!("pose {a1:.2} {a2:.2} {a3:.2} {a4:.2}"))
            .await?;
        wait_until_still(&mut self.console).await?;
        Ok(pose[servo])
    }

    /// Reverses the sign of a servo. Its neutral pulse stays the same, so its trim is reversed, too.
    ///
    /// # Errors
    /// Fails if the robot cannot stand.
    pub async fn reverse(&mut self, servo: usize) -> Result<(), C> {
        self.stand().await?;
        let dir =
            |servo: usize, settings: ServoSettings| format!("dir {} {}", servo + 1, settings.dir);
        self.make_sure().await?;
        let new = self.active.servos[servo].reversed();
        self.set_with_trim(servo, new, dir).await?;
        wait_until_still(&mut self.console).await.map(drop)
    }

    /// Changes a servo's trim by this angle.
    ///
    /// # Errors
    /// Fails if the trim would be too large.
    pub async fn trim(&mut self, servo: usize, change: f64) -> Result<(), C> {
        self.make_sure().await?;
        let mut new = self.active.servos[servo];
        new.trim = round_to_hundredths(new.trim + change);
        self.command(&trim_line(servo, new)).await?;
        self.active.servos[servo] = new;
        Ok(())
    }

    /// Sets a servo's scale, us per degree. Its neutral pulse stays the same, so its trim is converted, too.
    ///
    /// # Errors
    /// Fails if this scale or the converted trim is refused.
    pub async fn scale(&mut self, servo: usize, scale: f64) -> Result<(), C> {
        self.make_sure().await?;
        let new = self.active.servos[servo].with_scale(scale);
        let line = |servo: usize, settings: ServoSettings| {
            format!("scale {} {:.2}", servo + 1, settings.scale)
        };
        self.set_with_trim(servo, new, line).await
    }

    /// Makes the robot stand, and sets the scale of a servo that has turned by `measured` degrees when told to turn by
    /// `told`; returns the scale, us per degree.
    ///
    /// # Errors
    /// Fails if this scale or the converted trim is refused.
    pub async fn scale_by_turn(
        &mut self,
        servo: usize,
        told: f64,
        measured: f64,
    ) -> Result<f64, C> {
        self.stand().await?;
        self.make_sure().await?;
        let scale = self.active.servos[servo].scale * (told / measured).abs();
        self.scale(servo, scale).await?;
        Ok(self.active.servos[servo].scale)
    }

    /// Sets a servo's travel, counter-clockwise from the first angle to the second.
    ///
    /// # Errors
    /// Fails if a gait needs more.
    pub async fn limit(&mut self, servo: usize, ends: [f64; 2]) -> Result<(), C> {
        self.make_sure().await?;
        let limit = ends.map(wrap);
        let [min, max] = limit;
        self.command(&format!("limit {} {min:.2} {max:.2}", servo + 1))
            .await?;
        self.active.servos[servo].limit = limit;
        Ok(())
    }

    /// Starts a test walk: `walk` if the robot has it, else its first gait besides `stand`. Returns the gait's name;
    /// `None` if it has no other.
    ///
    /// # Errors
    /// Fails if the robot cannot walk now.
    pub async fn walk(&mut self) -> Result<Option<String>, C> {
        let help = self.command("help").await?;
        let lists = help
            .notes
            .iter()
            .filter_map(|line| line.strip_prefix("# gaits: "));
        let gaits = lists.flat_map(|names| names.split('|'));
        let gaits: Vec<&str> = gaits.filter(|name| *name != "stand").collect();
        let walk = gaits.iter().find(|name| **name == "walk");
        let Some(gait) = walk.or(gaits.first()) else {
            return Ok(None);
        };
        self.command(gait).await?;
        Ok(Some((*gait).to_owned()))
    }

    /// Saves the active settings in the board.
    ///
    /// # Errors
    /// Fails if the robot cannot save now.
    pub async fn save(&mut self) -> Result<(), C> {
        self.make_sure().await?;
        let result = self.command("save").await;
        self.unanswered_save = self.is_unsure.then(|| self.active.clone());
        result?;
        self.saved = self.active.clone();
        Ok(())
    }

    /// Makes the robot stand, and restores the settings of the beginning or of the last save; returns true if others
    /// were active. If a `save` was not answered, asks the board for what it has saved.
    ///
    /// # Errors
    /// Fails if the robot refuses a setting. If it cannot stand, for example at a low supply, it is restored anyway.
    pub async fn restore(&mut self) -> Result<bool, C> {
        match self.stand().await {
            Err(error) if !error.is_refusal() => return Err(error),
            _ => {}
        }
        if let Some(unanswered) = &self.unanswered_save {
            // The robot loads what it has saved.
            self.is_unsure = true;
            if has_saved(&mut self.console, unanswered).await? {
                self.saved = unanswered.clone();
            }
        }
        let is_changed = !self.active.is_equivalent_to(&self.saved);
        if is_changed || self.is_unsure {
            self.is_unsure = true;
            send(&mut self.console, &self.saved).await?;
            self.active = self.saved.clone();
            self.is_unsure = false;
        }
        self.unanswered_save = None;
        Ok(is_changed)
    }

    /// Replaces the active settings by others, unsaved.
    ///
    /// # Errors
    /// Fails if the robot refuses settings or reports other ones. Then it has its old ones, unless the error says
    /// otherwise.
    pub async fn replace(
        &mut self,
        calibration: &Calibration,
    ) -> std::result::Result<(), SendError<C::Error>> {
        self.make_sure().await.map_err(SendError::Refused)?;
        let result = replace(&mut self.console, &self.active, calibration).await;
        match &result {
            Ok(()) => self.active = calibration.clone(),
            Err(SendError::Mixed(_)) => self.is_unsure = true,
            Err(_) => {}
        }
        result
    }

    /// Sends a servo's new sign or scale by its `line`, and the trim that goes with it; if the trim is refused, sends
    /// the old sign or scale.
    async fn set_with_trim(
        &mut self,
        servo: usize,
        new: ServoSettings,
        line: impl Fn(usize, ServoSettings) -> String,
    ) -> Result<(), C> {
        let old = self.active.servos[servo];
        self.command(&line(servo, new)).await?;
        if new.trim != old.trim
            && let Err(error) = self.command(&trim_line(servo, new)).await
        {
            if error.is_refusal() {
                self.command(&line(servo, old)).await?;
            }
            return Err(error);
        }
        self.active.servos[servo] = new;
        Ok(())
    }

    async fn command(&mut self, line: &str) -> Result<Reply, C> {
        let result = command(&mut self.console, line).await;
        self.is_unsure |= matches!(&result, Err(error) if !error.is_refusal());
        result
    }

    /// Reads the settings again if a line was not answered.
    async fn make_sure(&mut self) -> Result<(), C> {
        if self.is_unsure {
            self.active = read(&mut self.console).await?;
            self.is_unsure = false;
        }
        Ok(())
    }
}

/// Makes a robot load the settings that it has saved; returns true if they are these.
async fn has_saved<C: Console>(console: &mut C, calibration: &Calibration) -> Result<bool, C> {
    match command(console, "load").await {
        Ok(_) => Ok(read(console).await?.is_equivalent_to(calibration)),
        Err(error) if error.is_refusal() => Ok(false),
        Err(error) => Err(error),
    }
}

fn trim_line(servo: usize, settings: ServoSettings) -> String {
    format!("trim {} {:.2}", servo + 1, settings.trim)
}

/// Wraps an angle to 0 to 360 degrees, rounded as on the console.
fn wrap(degrees: f64) -> f64 {
    round_to_hundredths(degrees).rem_euclid(360.0)
}

/// Rounds to hundredths, as the robot does, without a negative zero.
fn round_to_hundredths(value: f64) -> f64 {
    (value * 100.0).round() / 100.0 + 0.0
}
