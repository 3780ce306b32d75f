//! What the page is doing: a robot, a body on the floor, and perhaps the core of a
//! robot without an image.

use lizard_core::memory::Bytes;
use lizard_kinematics::End;
use lizard_robot::servo::FORWARD;
use lizard_robot::{Ground, Place as Walked, Robot, Walker};
use serde::Serialize;

use crate::core_run::{CoreRun, Said};
use crate::description::{Description, Way};
use crate::edit::with_number;
use crate::map::Map;
use crate::place::Place;
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
    /// The robot's, with the friction of now.
    ground: Option<Ground>,
    /// None before the first pose.
    walker: Option<Walker>,
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
        self.ground = Some(*robot.ground());
        self.walker = None;
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
        let (robot, ground) = (self.robot.as_ref()?, self.ground?);
        let sweeps = robot.sweeps(angles);
        let mut slides = [0.0; 4];
        // A pose that does not close is none that a robot can walk to.
        if robot.lizard().solve(&angles.into()).is_ok() {
            // The first one only says where the legs are.
            let walker = self
                .walker
                .get_or_insert_with(|| Walker::new(ground, sweeps));
            slides = walker.step(sweeps).feet;
        }
        let legs = self.walker.map_or(sweeps, |walker| walker.legs());
        let legs = [0, 1, 2, 3].map(|i| robot.servos()[i].neutral + FORWARD[i] * legs[i]);
        let scene = Scene::of(robot, angles, legs);
        let fault = scene.as_ref().err().cloned();
        let place = self.walker.map_or(Walked::START, |walker| walker.place());
        Some(Frame {
            scene: scene.ok(),
            fault,
            place: place.into(),
            slides,
        })
    }

    /// Takes the robot back to its start.
    pub fn restart(&mut self) {
        if let Some(walker) = &mut self.walker {
            walker.set_place(Walked::START);
        }
    }

    /// Sets the friction of pads that slide backward over that of those that slide forward,
    /// above 0.
    pub fn set_friction(&mut self, ratio: f64) {
        if let Some(ground) = &mut self.ground {
            ground.ratio = ratio;
            if let Some(walker) = &mut self.walker {
                walker.set_ground(*ground);
            }
        }
    }

    /// Where a cycle of a gait takes the robot by the contact model, on the floor of now.
    pub fn predict(&self, gait: usize) -> Option<Way> {
        let gait = self.robot.as_ref()?.gaits().get(gait)?;
        Some(gait.predict(&self.ground?).into())
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

    /// A page that has followed a cycle of a gait, and how far each foot slid in each
    /// frame of it.
    fn after_a_cycle(name: &str) -> (Place, Vec<[f64; 4]>) {
        let mut page = Page::default();
        page.read(PAPER).expect("right");
        let robot = Robot::parse(PAPER).expect("right");
        let gait = robot.gait(name).expect("a gait");
        let follow = |(_, phase)| page.pose(gait.table_angles(phase)).expect("it closes");
        let frames: Vec<Frame> = gait.frames().map(follow).collect();
        let last = frames.last().expect("frames").place;
        (last, frames.iter().map(|frame| frame.slides).collect())
    }

    #[test]
    fn a_cycle_frame_by_frame_leads_where_the_prediction_says() {
        let robot = Robot::parse(PAPER).expect("right");
        for name in ["walk", "left", "arc-right", "back"] {
            let way = robot.predict(robot.gait(name).expect("a gait"));
            let (place, _) = after_a_cycle(name);
            let near = |got: f64, wanted: Option<f64>, within: f64| {
                let off = got - wanted.expect("decided");
                assert!(off.abs() < within, "{name} {place:?}");
            };
            near(place.y, way.forward, 0.5);
            near(-place.x, way.left, 0.5);
            near(place.heading, way.turn, 0.3);
        }
    }

    #[test]
    fn in_a_walk_most_feet_hold() {
        let (_, slides) = after_a_cycle("walk");
        let mut slid = [0.0; 4];
        for frame in slides {
            let holds = frame.iter().filter(|mm| **mm < 0.3).count();
            assert!(holds >= 2, "{frame:?}");
            slid = [0, 1, 2, 3].map(|i| slid[i] + frame[i]);
        }
        assert!(
            slid.iter().all(|mm| *mm > 20.0),
            "each foot is dragged once: {slid:?}"
        );
    }

    #[test]
    fn legs_on_springs_lag_behind_their_servos() {
        let walked = |spring: &str| {
            let mut page = Page::default();
            let text = PAPER.replace("[leg]", &format!("[leg]\n{spring}"));
            let robot = page.read(&text).expect("right");
            let walk = robot.gaits.iter().position(|gait| gait.name == "walk");
            page.predict(walk.expect("walk"))
        };
        assert_ne!(walked("spring = 5.0"), walked(""));
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
