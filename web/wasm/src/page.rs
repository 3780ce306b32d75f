//! What the page is doing: a robot, a body on the floor, and perhaps the core of a
//! robot without an image.

use lizard_core::memory::Bytes;
use lizard_kinematics::End;
use lizard_robot::servo::FORWARD;
use lizard_robot::{Place as Walked, Robot};
use lizard_twin::{ServoModel, State, Twin};
use serde::Serialize;

use crate::core_run::{CoreRun, Said};
use crate::description::{Description, Outlook, SERVO_MODELS};
use crate::edit::with_number;
use crate::floor::Floor;
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
}

impl Page {
    /// Takes the robot of a robot.toml and puts it on the floor, at its start, its servos
    /// at neutral.
    ///
    /// # Errors
    /// What is wrong with it; the robot of before stays.
    pub fn read(&mut self, text: &str) -> Result<Description, Refused> {
        let robot = Robot::parse(text).map_err(|error| refused(&error))?;
        let description = Description::of(&robot);
        self.asked = robot.neutral().into();
        self.run = None;
        self.twin = Some(Twin::new(&robot, self.model.unwrap_or(ServoModel::SG90)));
        Ok(description)
    }

    fn robot(&self) -> Option<&Robot> {
        self.twin.as_ref().map(Twin::robot)
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

    /// Sets the floor, the weight and the springs, from the next frame on.
    pub fn set_floor(&mut self, floor: Floor) {
        if let Some(twin) = &mut self.twin {
            twin.set_ground(floor.over(twin.robot().ground()));
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
            .map_or_else(Bytes::default, CoreRun::into_memory);
        let robot = self.robot();
        self.run = robot.map(|robot| CoreRun::begin(robot.firmware().clone(), memory));
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

fn refused(error: &lizard_robot::Error) -> Refused {
    Refused {
        refused: error.to_string(),
        line: error.line,
        key: error.key.clone(),
    }
}

#[cfg(test)]
mod tests {
    use lizard_robot::Travel;

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

    fn page() -> Page {
        let mut page = Page::default();
        page.read(PAPER).expect("right");
        page
    }

    /// The place of a gait among the robot's.
    fn index(page: &Page, name: &str) -> usize {
        let gait = page.robot().and_then(|robot| robot.gait(name));
        gait.expect(name).index()
    }

    #[test]
    fn pulses_that_end_leave_a_servo_where_it_is() {
        let mut page = page();
        page.set_servos("ideal");
        let scene = |frame: Option<Frame>| frame.and_then(|frame| frame.scene).expect("closes");
        let first = scene(page.pulses([24_000 + 1600, 24_000, 24_000, 24_000]));
        assert!((first.angles[0] - 148.590378).abs() < 1e-9, "{first:?}");
        assert_eq!(scene(page.pulses([0; 4])), first);
    }

    #[test]
    fn an_sg90_stays_inside_its_dead_band_and_turns_at_its_rate() {
        let mut page = page();
        let turned = |page: &mut Page, cycles: u32| {
            let frame = page.pulses([24_000 + cycles, 24_000, 24_000, 24_000]);
            let frame = frame.expect("a robot");
            (
                frame.scene.expect("closes").angles[0] - 138.590378,
                frame.errors[0],
            )
        };
        let near = |(turned, error): (f64, f64), wanted: [f64; 2]| {
            assert!((turned - wanted[0]).abs() < 1e-9, "{turned}");
            assert!((error - wanted[1]).abs() < 1e-9, "{error}");
        };
        // 4 us are less than half of its dead band of 10 us.
        near(turned(&mut page, 64), [0.0, 0.4]);
        // 20 deg: 10 in a frame of 20 ms, at 500 deg/s; then to the edge of the dead band.
        near(turned(&mut page, 3200), [10.0, 10.0]);
        near(turned(&mut page, 3200), [19.5, 0.5]);
        page.set_servos("ideal");
        near(turned(&mut page, 3200), [20.0, 0.0]);
        page.set_servos("better");
        near(turned(&mut page, 0), [0.0, 0.0]);
    }

    /// The second cycle of a gait with ideal servos: its way, how far each foot slid in each of
    /// its frames, and the largest lag.
    fn cycle(page: &mut Page, name: &str, frames: u32) -> (Travel, Vec<[f64; 4]>, f64) {
        page.set_servos("ideal");
        let gait = page.robot().and_then(|robot| robot.gait(name)).expect(name);
        let poses: Vec<[f64; 4]> = gait
            .frames()
            .step_by(frames as usize)
            .map(|(_, phase)| gait.table_angles(phase))
            .collect();
        let mut follow = || -> Vec<Frame> {
            let follow = |angles: &[f64; 4]| page.pose(*angles, frames).expect("a robot");
            poses.iter().map(follow).collect()
        };
        let (first, second) = (follow(), follow());
        let end = |frames: &[Frame]| frames.last().expect("frames").place;
        let slides = second.iter().map(|frame| frame.slides).collect();
        let lag = second.iter().flat_map(|frame| frame.lag);
        let lag = lag.fold(0.0, |most: f64, lag| most.max(lag.abs()));
        (end(&first).way_to(end(&second)), slides, lag)
    }

    #[test]
    fn a_cycle_frame_by_frame_leads_where_the_prediction_says() {
        for name in ["walk", "left", "arc-right", "back"] {
            let mut page = page();
            let robot = page.robot().expect("a robot");
            let wanted = robot.predict(robot.gait(name).expect("a gait"));
            // Every frame, and every second one, as a board on USB tells.
            for frames in [1, 2] {
                let (way, _, _) = cycle(&mut page, name, frames);
                let near = |got: f64, wanted: Option<f64>, within: f64| {
                    let off = got - wanted.expect("decided");
                    assert!(off.abs() < within, "{name} {frames} {way:?}");
                };
                // What lies between two poses is taken for straight.
                near(way.forward, wanted.forward, 0.4 * f64::from(frames));
                near(way.left, wanted.left, 0.5);
                near(way.turn, wanted.turn, 0.3);
            }
        }
    }

    #[test]
    fn servos_with_a_dead_band_are_predicted_to_lose_it() {
        let mut page = page();
        let walk = index(&page, "walk");
        let forward = |page: &Page| page.predict(walk).and_then(|way| way.way.forward());
        let sg90 = forward(&page).expect("decided");
        page.set_servos("ideal");
        let ideal = forward(&page).expect("decided");
        // A degree of 40, as twin/tests/stream.rs has it.
        assert!((sg90 / ideal - 39.0 / 40.0).abs() < 0.01, "{sg90} {ideal}");
    }

    #[test]
    fn in_a_walk_most_feet_hold() {
        let (_, slides, _) = cycle(&mut page(), "walk", 1);
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
    fn springs_that_are_set_act_and_are_predicted() {
        let mut page = page();
        page.set_servos("ideal");
        let walk = index(&page, "walk");
        let rigid = page.predict(walk).expect("a gait");
        assert_eq!((rigid.lag, rigid.share), (None, None));
        for stiffness in [2.0, 5.0] {
            page.set_floor(Floor {
                stiffness,
                ..Floor::of(page.robot().expect("a robot").ground())
            });
            let soft = page.predict(walk).expect("a gait");
            let (way, _, lag) = cycle(&mut page, "walk", 1);
            let forward = |way: &Outlook| way.way.forward().expect("decided");
            assert!(
                (way.forward - forward(&soft)).abs() < 0.5,
                "{way:?} {soft:?}"
            );
            assert!(
                (lag - soft.lag.expect("springs")).abs() < 0.3,
                "{lag} {soft:?}"
            );
            let share = forward(&soft) / forward(&rigid);
            assert!(
                (soft.share.expect("springs") - share).abs() < 0.01,
                "{soft:?}"
            );
            assert!(share < 0.9, "{share}");
        }
    }

    #[test]
    fn a_stop_that_bears_the_friction_is_as_good_as_rigid() {
        let mut page = page();
        let floor = Floor {
            stiffness: 1.0,
            preload: 60.0,
            ..Floor::of(page.robot().expect("a robot").ground())
        };
        page.set_floor(floor);
        let strut = page.predict(index(&page, "walk")).expect("a gait");
        assert!(strut.share.expect("springs") > 0.99, "{strut:?}");
    }

    #[test]
    fn weight_and_friction_matter_to_springs_alone() {
        let walked = |stiffness: f64, mass: f64, friction: f64| {
            let mut page = page();
            let floor = Floor {
                stiffness,
                mass,
                friction,
                ..Floor::of(page.robot().expect("a robot").ground())
            };
            page.set_floor(floor);
            let way = page.predict(index(&page, "walk")).expect("a gait").way;
            way.forward().expect("decided")
        };
        let rigid = f64::INFINITY;
        assert_eq!(walked(rigid, 280.0, 0.7), walked(rigid, 560.0, 0.2));
        let same = walked(5.0, 280.0, 0.7) - walked(5.0, 140.0, 1.4);
        assert!(same.abs() < 1e-6, "{same}");
        assert!(walked(5.0, 280.0, 1.4) < walked(5.0, 280.0, 0.7) - 1.0);
    }

    #[test]
    fn friction_that_differs_by_direction_changes_the_prediction() {
        let mut page = page();
        let walk = index(&page, "walk");
        let even = page.predict(walk);
        let floor = Floor {
            ratio: 1.4,
            ..Floor::of(page.robot().expect("a robot").ground())
        };
        page.set_floor(floor);
        assert_ne!(page.predict(walk), even);
        assert_eq!(page.predict(99), None);
    }
}
