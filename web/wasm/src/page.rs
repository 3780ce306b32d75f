//! What the page is doing: a robot, a body on the floor, and perhaps the core of a
//! robot without an image.

use lizard_core::memory::Bytes;
use lizard_kinematics::End;
use lizard_robot::Robot;
use serde::Serialize;

use crate::body::{Body, Place, Rigid};
use crate::core_run::{CoreRun, Said};
use crate::description::{Description, Way};
use crate::edit::with_number;
use crate::map::Map;
use crate::scene::Scene;

/// CPU cycles in a microsecond.
const CYCLES_PER_US: f64 = 16.0;

/// Why a robot.toml or a length will not do.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Refused {
    /// The sentence.
    pub refused: String,
    /// Line of the file, from 1, where one is to blame.
    pub line: Option<usize>,
    /// The key to blame, such as `links.l2`; may be empty.
    pub key: String,
}

/// A frame of the robot on the floor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Frame {
    /// The pose; none where a loop does not close.
    scene: Option<Scene>,
    /// Why there is none.
    fault: Option<String>,
    /// Where the body is.
    place: Place,
    /// How far each foot slid over the floor in this frame, mm, servo order.
    slides: [f64; 4],
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
    robot: Option<Robot>,
    body: Option<Body<Rigid>>,
    angles: [f64; 4],
    run: Option<CoreRun>,
}

impl Page {
    /// Takes the robot of a robot.toml and puts it on the floor, at its start.
    ///
    /// # Errors
    /// What is wrong with it; the robot of before stays.
    pub fn read(&mut self, text: &str) -> Result<Description, Refused> {
        let robot = Robot::parse(text).map_err(|error| refused(&error))?;
        let description = Description::of(&robot);
        let ratio = robot.ground().ratio;
        self.body = Some(Body::new(Rigid { ratio }));
        self.angles = robot.neutral().into();
        self.run = None;
        self.robot = Some(robot);
        Ok(description)
    }

    /// The text with another number, and whether the robot of it will do. The page's robot
    /// stays as it is.
    ///
    /// # Errors
    /// If the text has no such number.
    pub fn edit(text: &str, key: &str, value: f64) -> Result<Edited, Refused> {
        let text = with_number(text, key, value).map_err(|error| Refused {
            refused: error.to_string(),
            line: None,
            key: key.to_string(),
        })?;
        let refusal = Robot::parse(&text).err().map(|error| refused(&error));
        Ok(Edited { text, refusal })
    }

    /// Follows the pulses of a frame: widths in CPU cycles, 0 for none, which leaves a
    /// servo where it is.
    pub fn pulses(&mut self, widths: [u32; 4]) -> Option<Frame> {
        let robot = self.robot.as_ref()?;
        for (i, width) in widths.into_iter().enumerate() {
            if width > 0 {
                let servo = robot.servos()[i];
                let sweep = servo.sweep(f64::from(width) / CYCLES_PER_US);
                self.angles[i] = (servo.neutral + sweep).rem_euclid(360.0);
            }
        }
        self.frame(self.angles)
    }

    /// Follows a pose that a robot says it has: angles in deg, chassis frame.
    pub fn pose(&mut self, angles: [f64; 4]) -> Option<Frame> {
        self.angles = angles;
        self.frame(angles)
    }

    fn frame(&mut self, angles: [f64; 4]) -> Option<Frame> {
        let (robot, body) = (self.robot.as_ref()?, self.body.as_mut()?);
        // A pose that does not close is none that a robot can walk to.
        let closes = robot.lizard().solve(&angles.into()).is_ok();
        let slides = if closes {
            body.follow(robot, angles)
        } else {
            [0.0; 4]
        };
        let scene = Scene::of(robot, angles, body.legs().unwrap_or(angles));
        let fault = scene.as_ref().err().cloned();
        Some(Frame {
            scene: scene.ok(),
            fault,
            place: body.place,
            slides,
        })
    }

    /// Takes the robot back to its start.
    pub fn restart(&mut self) {
        if let Some(body) = &mut self.body {
            body.put(Place::default());
        }
    }

    /// Sets the friction of pads that slide backward over that of those that slide forward,
    /// above 0.
    pub fn set_friction(&mut self, ratio: f64) {
        if let Some(body) = &mut self.body {
            body.contact.ratio = ratio;
        }
    }

    /// Where a cycle of a gait takes the robot by the contact model, on the floor of now.
    pub fn predict(&self, gait: usize) -> Option<Way> {
        let (robot, body) = (self.robot.as_ref()?, self.body.as_ref()?);
        let mut ground = *robot.ground();
        ground.ratio = body.contact.ratio;
        Some(robot.gaits().get(gait)?.predict(&ground).into())
    }

    /// The map of singularities of the head (0) or the tail (1).
    pub fn map(&self, end: usize) -> Option<Map> {
        Some(Map::of(self.robot.as_ref()?, *End::ALL.get(end)?))
    }

    /// Runs the core with this robot's numbers, from power-on; what was saved before is
    /// kept.
    pub fn run_core(&mut self) {
        let memory = self
            .run
            .take()
            .map_or_else(Bytes::default, CoreRun::into_memory);
        let robot = self.robot.as_ref();
        self.run = robot.map(|robot| CoreRun::begin(robot.firmware().clone(), memory));
    }

    /// A frame of the core, after bytes from the serial line, at a supply in V.
    pub fn core_frame(&mut self, bytes: &[u8], volts: f64) -> Option<Said> {
        Some(self.run.as_mut()?.frame(bytes, volts))
    }
}

fn refused(error: &lizard_robot::Error) -> Refused {
    Refused {
        refused: error.to_string(),
        line: error.line,
        key: error.key.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: &str = include_str!("../../../robots/paper.toml");

    #[test]
    fn a_refused_robot_leaves_the_one_of_before() {
        let mut page = Page::default();
        assert_eq!(page.pulses([24_000; 4]), None);
        page.read(PAPER).expect("right");
        let error = page.read("[links]").expect_err("refused");
        assert!(error.refused.starts_with("robot.toml"), "{error:?}");
        assert!(page.pulses([24_000; 4]).is_some());
    }

    #[test]
    fn a_length_that_will_not_do_says_why_and_its_text_is_kept() {
        let edited = Page::edit(PAPER, "links.l2", 21.0).expect("there");
        assert!(edited.text.contains("l2 = 21.0"));
        let refusal = edited.refusal.expect("the head is out of reach");
        assert_eq!(refusal.key, "gait.look.head");
        assert!(refusal.refused.contains("out of reach"), "{refusal:?}");
        assert_eq!(
            Page::edit(PAPER, "links.l1", 35.0).expect("there").refusal,
            None
        );
        assert!(Page::edit(PAPER, "links.l99", 51.0).is_err());
    }

    #[test]
    fn pulses_that_end_leave_a_servo_where_it_is() {
        let mut page = Page::default();
        page.read(PAPER).expect("right");
        let scene = |frame: Option<Frame>| frame.and_then(|frame| frame.scene).expect("closes");
        let first = scene(page.pulses([24_000 + 1600, 24_000, 24_000, 24_000]));
        assert!((first.angles[0] - 148.590378).abs() < 1e-9, "{first:?}");
        assert_eq!(scene(page.pulses([0; 4])), first);
    }

    #[test]
    fn friction_that_differs_by_direction_changes_the_prediction() {
        let mut page = Page::default();
        let robot = page.read(PAPER).expect("right");
        let walk = robot
            .gaits
            .iter()
            .position(|gait| gait.name == "walk")
            .expect("walk");
        let even = page.predict(walk);
        page.set_friction(1.4);
        assert_ne!(page.predict(walk), even);
        assert_eq!(page.predict(99), None);
    }
}
