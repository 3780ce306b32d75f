//! What the page is doing: a robot, a body on the floor, and perhaps the core, without a
//! chip.

use lizard_core::virtual_board::Eeprom;
use lizard_kinematics::End;
use lizard_robot::servo::FORWARD;
use lizard_robot::{Place as Walked, Robot};
use lizard_twin::{ServoModel, State, Twin};
use serde::Serialize;

use crate::core_run::{CoreRun, Said};
use crate::description::{Description, Outlook, SERVO_MODELS};
use crate::drawn::Drawn;
use crate::edit::{with_number, with_word, without};
#[cfg(feature = "tune")]
use crate::faster::{Begun, Faster, Wish};
use crate::floor::Floor;
use crate::map::Map;
use crate::place::Place;
use crate::refused::Refused;
use crate::room::Room;
use crate::scene::Scene;
use crate::trial::{Bars, NoTrial, Trial, trial};

/// CPU cycles in a microsecond.
const CYCLES_PER_US: f64 = 16.0;

/// A frame of the robot on the floor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// The pose that the servos have; none where a loop does not close.
    scene: Option<Scene>,
    /// Why there is none.
    fault: Option<String>,
    /// Where the body is.
    place: Place,
    /// How far each foot slid over the floor in this frame, mm, servo order.
    slides: [f64; 4],
    /// How far each leg is behind its servo, deg, foot forward positive, servo order.
    lag: [f64; 4],
    /// How far each servo is from what its pulse asks for, deg.
    errors: [f64; 4],
}

/// A robot.toml with a changed number: its text, and what becomes of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Edited {
    /// The changed text.
    text: String,
    /// Why it will not do.
    refusal: Option<Refused>,
}

/// The page's robot.
#[derive(Default)]
pub struct Page {
    twin: Option<Twin>,
    /// The angles that its servos were asked for last, deg, chassis frame.
    asked: [f64; 4],
    model: Option<ServoModel>,
    run: Option<CoreRun>,
    #[cfg(feature = "tune")]
    faster: Option<Faster>,
}

impl Page {
    /// Takes the robot of a robot.toml and puts it on the floor, at its start, its servos
    /// at neutral.
    ///
    /// # Errors
    /// What is wrong with it; the robot of before stays.
    pub fn read(&mut self, text: &str) -> Result<Description, Refused> {
        let robot = Robot::parse(text).map_err(|error| Refused::of(&error))?;
        let description = Description::of(&robot);
        self.asked = robot.neutral().into();
        self.run = None;
        #[cfg(feature = "tune")]
        {
            self.faster = None;
        }
        self.twin = Some(Twin::new(&robot, self.model.unwrap_or(ServoModel::SG90)));
        Ok(description)
    }

    fn robot(&self) -> Option<&Robot> {
        self.twin.as_ref().map(Twin::robot)
    }

    /// The robot's section of flash, as the firmware reads it; none without a robot. Its maps
    /// of certified cells take some hundredths of a second to prove.
    #[must_use]
    pub fn section(&self) -> Option<Vec<u8>> {
        Some(self.robot()?.section())
    }

    /// The text with another number, and whether the robot of it will do. The page's robot
    /// stays as it is.
    ///
    /// # Errors
    /// If the text has no such number.
    pub fn edit(text: &str, key: &str, value: f64) -> Result<Edited, Refused> {
        let text = with_number(text, key, value).map_err(Refused::from)?;
        let refusal = Robot::parse(&text).err().map(|error| Refused::of(&error));
        Ok(Edited { text, refusal })
    }

    /// The text with a floor, a weight, feet and a drive of the legs: what it has already stays as it is written.
    /// The page's robot stays as it is.
    ///
    /// # Errors
    /// If the text is that of no robot, or has no room for one of the numbers.
    pub fn edit_floor(text: &str, floor: Floor) -> Result<Edited, Refused> {
        let robot = Robot::parse(text).map_err(|error| Refused::of(&error))?;
        let own = Floor::of(&robot);
        // Out of its range a value is the robot's own.
        let wanted = floor.within(&robot);
        let mut text = text.to_string();
        let kind = wanted.kind.word();
        if wanted.kind != own.kind {
            text = with_word(&text, "leg.drive.kind", kind).map_err(Refused::from)?;
        }
        for (of, key, own, wanted) in [
            (
                "spring",
                "leg.drive.stiffness",
                own.stiffness,
                wanted.stiffness,
            ),
            ("spring", "leg.drive.preload", own.preload, wanted.preload),
            ("strut", "leg.drive.force", own.force, wanted.force),
            ("strut", "leg.drive.rate", own.rate, wanted.rate),
        ] {
            text = match of == kind {
                false => without(&text, key),
                true if kind != robot.drive().word() || own != wanted => {
                    with_number(&text, key, wanted)
                }
                true => Ok(text),
            }
            .map_err(Refused::from)?;
        }
        for (key, own, wanted) in [
            ("leg.drive.play", own.play, wanted.play),
            ("feet.stiffness", own.leaf, wanted.leaf),
            ("feet.twist", own.twist, wanted.twist),
            ("ground.friction", own.friction, wanted.friction),
            ("ground.friction_back_over_forward", own.ratio, wanted.ratio),
            ("body.mass", own.mass, wanted.mass),
        ] {
            if own != wanted {
                text = with_number(&text, key, wanted).map_err(Refused::from)?;
            }
        }
        let refusal = Robot::parse(&text).err().map(|error| Refused::of(&error));
        Ok(Edited { text, refusal })
    }

    /// Follows the pulses of a frame: widths in CPU cycles, 0 for none, which leaves a
    /// servo where it is.
    pub fn pulses(&mut self, widths: [u32; 4]) -> Option<Frame> {
        let twin = self.twin.as_mut()?;
        let us = |width: u32| f64::from(width) / CYCLES_PER_US;
        let state = twin.push(widths.map(|width| (width > 0).then(|| us(width))));
        let ask = |i: usize| state.angles[i] + state.errors[i];
        self.asked = std::array::from_fn(ask);
        Some(frame(twin, &state, state.slip))
    }

    /// Follows a pose that a robot says it has: angles in deg, chassis frame, so many frames
    /// after the one before. In between the servos were asked for what lies between.
    pub fn pose(&mut self, angles: [f64; 4], frames: u32) -> Option<Frame> {
        let twin = self.twin.as_mut()?;
        if angles.iter().any(|angle| !angle.is_finite()) {
            return None;
        }
        let from = twin.robot().sweeps(self.asked);
        let to = twin.robot().sweeps(angles);
        let neutral: [f64; 4] = twin.robot().neutral().into();
        let frames = frames.clamp(1, MOST_FRAMES);
        let mut slides = [0.0; 4];
        let mut part = |n: u32| {
            let share = f64::from(n) / f64::from(frames);
            let at = |i: usize| from[i] + share * (to[i] - from[i]);
            let state = twin.push_angles(std::array::from_fn(|i| neutral[i] + FORWARD[i] * at(i)));
            slides = std::array::from_fn(|i| slides[i] + state.slip[i]);
            state
        };
        (1..frames).for_each(|n| {
            part(n);
        });
        let state = part(frames);
        self.asked = angles;
        Some(frame(twin, &state, slides))
    }

    /// Takes the robot back to its start.
    pub fn restart(&mut self) {
        if let Some(twin) = &mut self.twin {
            twin.set_place(Walked::START);
        }
    }

    /// Sets the floor, the weight, the feet and what drives the legs, from the next frame on.
    pub fn set_floor(&mut self, floor: Floor) {
        if let Some(twin) = &mut self.twin {
            twin.set_ground(floor.over(twin.robot()));
        }
    }

    /// Sets what servos can do, by its name in [`Description::models`]; a name that is none
    /// changes nothing.
    pub fn set_servos(&mut self, name: &str) {
        let Some((_, model)) = SERVO_MODELS.iter().find(|(known, _)| *known == name) else {
            return;
        };
        self.model = Some(*model);
        if let Some(twin) = &mut self.twin {
            twin.set_servos(*model);
        }
    }

    /// Where a cycle of a gait takes the robot by the contact model, on the floor of now
    /// with the servos of now.
    pub fn predict(&self, gait: usize) -> Option<Outlook> {
        let twin = self.twin.as_ref()?;
        let gait = twin.robot().gaits().get(gait)?;
        Some(Outlook::of(twin, gait))
    }

    /// A gait as four bars, where it can be taken apart so.
    pub fn bars(&self, gait: usize) -> Option<Bars> {
        Bars::of(self.robot()?.gaits().get(gait)?)
    }

    /// Tries a gait on the page's robot, whose text this is; none without a robot.
    ///
    /// # Errors
    /// What the gait would break, and what would not.
    pub fn trial(&self, text: &str, bars: &Bars) -> Option<Result<Trial, NoTrial>> {
        Some(trial(text, bars, self.twin.as_ref()?))
    }

    /// Tries a gait that was drawn on the page's robot, whose text this is; none without a robot
    /// or a line.
    ///
    /// # Errors
    /// What the gait would break, and what would not.
    pub fn trial_drawn(&self, text: &str, drawn: &Drawn) -> Option<Result<Trial, NoTrial>> {
        drawn.trial(text, self.twin.as_ref()?)
    }

    /// Begins to search a gait that walks faster than this one on the page's robot, whose text
    /// this is; none without a robot.
    ///
    /// # Errors
    /// Why there is nothing to search.
    #[cfg(feature = "tune")]
    pub fn make_faster(&mut self, text: &str, wish: &Wish) -> Option<Result<Begun, Refused>> {
        let begun = Faster::begin(text, self.twin.as_ref()?.ground(), wish);
        Some(begun.map(|faster| self.faster.insert(faster).begun()))
    }

    /// The search that was begun last.
    #[cfg(feature = "tune")]
    pub fn faster(&mut self) -> Option<&mut Faster> {
        self.faster.as_mut()
    }

    /// The line that the point of an end goes along in a gait that was drawn.
    pub fn path(&self, drawn: &Drawn) -> Option<Vec<[f64; 2]>> {
        drawn.path(self.robot()?)
    }

    /// The text of the page's robot with a gait that was drawn.
    pub fn put_drawn(&self, text: &str, drawn: &Drawn) -> Option<String> {
        drawn.put_into(text, self.robot()?)
    }

    /// Where the point of the head (0) or the tail (1) may be.
    pub fn room(&self, end: usize) -> Option<Room> {
        Some(Room::of(self.robot()?, *End::ALL.get(end)?))
    }

    /// The map of singularities of the head (0) or the tail (1).
    pub fn map(&self, end: usize) -> Option<Map> {
        Some(Map::of(self.robot()?, *End::ALL.get(end)?))
    }

    /// Runs the core with this robot's numbers, from power-on; what was saved before is
    /// kept.
    pub fn run_core(&mut self) {
        let memory = self
            .run
            .take()
            .map_or_else(Eeprom::default, CoreRun::into_memory);
        let robot = self.robot();
        self.run = robot.map(|robot| CoreRun::begin(*robot.firmware(), memory));
    }

    /// A frame of the core, after bytes from the serial line, at a supply in V.
    pub fn core_frame(&mut self, bytes: &[u8], volts: f64) -> Option<Said> {
        Some(self.run.as_mut()?.frame(bytes, volts))
    }
}

/// Poses further apart than this are no motion that was watched.
const MOST_FRAMES: u32 = 50;

fn frame(twin: &Twin, state: &State, slides: [f64; 4]) -> Frame {
    let scene = Scene::of(twin);
    let fault = scene.as_ref().err().cloned();
    Frame {
        scene: scene.ok(),
        fault,
        place: state.place.into(),
        slides,
        lag: state.lag,
        errors: state.errors,
    }
}

#[cfg(test)]
mod tests;
