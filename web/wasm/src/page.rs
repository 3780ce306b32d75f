//! The page's state: a robot, its body on the floor, and optionally the firmware's core without a simulated chip.

use lizard_kinematics::End;
use lizard_robot::edit::{with_number, with_string, without_key};
use lizard_robot::servo::FORWARD_TURN_SIGN;
use lizard_robot::{BodyPose, Robot};
use lizard_twin::{ServoModel, State, Twin};
use serde::Serialize;
use tsify::Tsify;

use crate::description::{Description, find_servo_model};
use crate::floor::{Floor, LegDrive};
#[cfg(feature = "tune")]
use crate::gait_search::{GaitSearch, SearchExtent, SearchTask};
use crate::place::Place;
use crate::prediction::GaitPrediction;
use crate::refusal::Refusal;
use crate::running_core::RunningCore;
use crate::scene::Scene;
use crate::singularity_map::SingularityMap;
use crate::workspace::Workspace;

/// CPU cycles in a microsecond.
const CYCLES_PER_US: f64 = 16.0;

/// The state of the robot on the floor after a frame.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Frame {
    /// The robot in the pose of its servos; `None` if a loop does not close.
    scene: Option<Scene>,
    /// The message about the loop that does not close; `None` if all loops close.
    loop_error: Option<String>,
    /// Place of the body on the floor.
    place: Place,
    /// Distance that each foot slid over the floor in this frame, mm, in servo order.
    slips: [f64; 4],
    /// Lag of each leg behind its servo, deg, foot forward positive, in servo order.
    lags: [f64; 4],
}

/// The text of a robot.toml after a change, and its refusal.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct EditedToml {
    /// The changed text.
    text: String,
    /// The refusal of the changed text; `None` if it is a valid robot.
    refusal: Option<Refusal>,
}

impl EditedToml {
    /// Checks the changed text of a robot.toml.
    pub(crate) fn check(text: String) -> Self {
        let refusal = Robot::parse(&text).err().map(Refusal::from);
        Self { text, refusal }
    }
}

/// The page's robot on the floor, its core, and the search for a faster gait.
#[derive(Default)]
pub struct PageState {
    twin: Option<Twin>,
    /// Latest target angles of the servos, deg, chassis frame.
    target_angles: [f64; 4],
    /// Name of the servo model that the page set; `None` for the robot's own servos.
    model_name: Option<String>,
    running_core: Option<RunningCore>,
    /// The prepared search; `None` if no search was prepared since the robot was loaded.
    #[cfg(feature = "tune")]
    pub(crate) search: Option<GaitSearch>,
}

impl PageState {
    /// Loads a robot.toml and puts the robot at the start on the floor, with its servos at neutral.
    ///
    /// # Errors
    /// Returns the first mistake in the text; the page keeps the previous robot.
    pub fn load(&mut self, text: &str) -> Result<Description, Refusal> {
        let robot = Robot::parse(text)?;
        let description = Description::for_robot(&robot);
        self.target_angles = robot.neutral_pose().into();
        self.running_core = None;
        #[cfg(feature = "tune")]
        {
            self.search = None;
        }
        let model_name = self.model_name.as_deref();
        let model = model_name.and_then(|name| find_servo_model(&robot, name));
        let model = model.unwrap_or_else(|| ServoModel::for_robot(&robot));
        self.twin = Some(Twin::new(&robot, model));
        Ok(description)
    }

    /// Returns the robot on the floor; `None` if no robot is loaded.
    pub(crate) fn twin(&self) -> Option<&Twin> {
        self.twin.as_ref()
    }

    /// Returns the robot; `None` if no robot is loaded.
    pub(crate) fn robot(&self) -> Option<&Robot> {
        self.twin().map(Twin::robot)
    }

    /// Sets the floor, the mass, the feet and the leg drive in the text of a robot.toml. Unchanged values keep their
    /// notation. The page's robot does not change.
    ///
    /// # Errors
    /// Fails if the text is not a valid robot, or if a number cannot be added to it.
    pub fn edit_floor(text: &str, floor: Floor) -> Result<EditedToml, Refusal> {
        let robot = Robot::parse(text)?;
        let own_floor = Floor::for_robot(&robot);
        // The robot's own values replace values out of range.
        let new_floor = floor.with_valid_values(&robot);
        let mut text = text.to_string();
        let has_new_kind = new_floor.kind != own_floor.kind;
        if has_new_kind {
            let kind = new_floor.to_ground(&robot).drive.kind_name();
            text = with_string(&text, "leg.drive.kind", kind)?;
        }
        for (key, own_value, new_value) in [
            ("leg.drive.force", own_floor.force, new_floor.force),
            ("leg.drive.rate", own_floor.rate, new_floor.rate),
        ] {
            text = match floor.kind {
                LegDrive::Rigid => without_key(&text, key)?,
                LegDrive::Strut if has_new_kind || own_value != new_value => {
                    with_number(&text, key, new_value)?
                }
                LegDrive::Strut => text,
            };
        }
        for (key, own_value, new_value) in [
            ("leg.drive.play", own_floor.play, new_floor.play),
            ("feet.stiffness", own_floor.leaf, new_floor.leaf),
            ("feet.twist", own_floor.twist, new_floor.twist),
            ("ground.friction", own_floor.friction, new_floor.friction),
            (
                "ground.friction_back_over_forward",
                own_floor.ratio,
                new_floor.ratio,
            ),
            ("body.mass", own_floor.mass, new_floor.mass),
        ] {
            if own_value != new_value {
                text = with_number(&text, key, new_value)?;
            }
        }
        Ok(EditedToml::check(text))
    }

    /// Moves the robot for a frame with these pulse widths in CPU cycles; 0 is no pulse, which leaves the servo at its
    /// angle. `None` if no robot is loaded.
    pub fn follow_pulses(&mut self, widths: [u32; 4]) -> Option<Frame> {
        let twin = self.twin.as_mut()?;
        let to_us = |width: u32| f64::from(width) / CYCLES_PER_US;
        let state = twin.simulate_pulses(widths.map(|width| (width > 0).then(|| to_us(width))));
        self.target_angles = std::array::from_fn(|i| state.angles[i] + state.errors[i]);
        Some(make_frame(twin, &state, state.slips))
    }

    /// Moves the robot to a pose that a real robot reports `frame_count` frames after its previous pose; angles in
    /// deg, chassis frame. Frames in between are interpolated. `None` if no robot is loaded or an angle is not finite.
    pub fn follow_pose(&mut self, angles: [f64; 4], frame_count: u32) -> Option<Frame> {
        let twin = self.twin.as_mut()?;
        if angles.iter().any(|angle| !angle.is_finite()) {
            return None;
        }
        let from = twin.robot().sweeps(self.target_angles);
        let to = twin.robot().sweeps(angles);
        let neutral: [f64; 4] = twin.robot().neutral_pose().into();
        let frame_count = frame_count.clamp(1, MAX_INTERPOLATED_FRAMES);
        let mut slips = [0.0; 4];
        let mut advance = |n: u32| {
            let fraction = f64::from(n) / f64::from(frame_count);
            let sweep_at = |i: usize| from[i] + fraction * (to[i] - from[i]);
            let state = twin.simulate_angles(std::array::from_fn(|i| {
                neutral[i] + FORWARD_TURN_SIGN[i] * sweep_at(i)
            }));
            slips = std::array::from_fn(|i| slips[i] + state.slips[i]);
            state
        };
        (1..frame_count).for_each(|n| {
            advance(n);
        });
        let state = advance(frame_count);
        self.target_angles = angles;
        Some(make_frame(twin, &state, slips))
    }

    /// Returns the robot to its start on the floor.
    pub fn return_to_start(&mut self) {
        if let Some(twin) = &mut self.twin {
            twin.set_body_pose(BodyPose::START);
        }
    }

    /// Sets the floor, the mass, the feet and the leg drive; takes effect in the next frame.
    pub fn set_floor(&mut self, floor: Floor) {
        if let Some(twin) = &mut self.twin {
            twin.set_ground(floor.to_ground(twin.robot()));
        }
    }

    /// Sets the servo model by its name in [`Description::models`]; a voltage after the name, as in `own at 4.2`, also
    /// sets the supply. An unknown name has no effect.
    pub fn set_servo_model(&mut self, name: &str) {
        let Some(twin) = &mut self.twin else {
            self.model_name = Some(name.to_owned());
            return;
        };
        if let Some(model) = find_servo_model(twin.robot(), name) {
            self.model_name = Some(name.to_owned());
            twin.set_servo_model(model);
        }
    }

    /// Predicts a cycle of the gait with this index, on the current floor with the current servos; `None` if no robot
    /// is loaded or there is no such gait.
    pub fn predict(&self, gait: usize) -> Option<GaitPrediction> {
        let twin = self.twin()?;
        let gait = twin.robot().gaits().get(gait)?;
        Some(GaitPrediction::predict(twin, gait))
    }

    /// Prepares the search for a faster gait of the page's robot; `None` if no robot is loaded.
    ///
    /// # Errors
    /// Returns the reason if the search cannot start.
    #[cfg(feature = "tune")]
    pub fn begin_search(&mut self, task: &SearchTask) -> Option<Result<SearchExtent, Refusal>> {
        let search = GaitSearch::begin(self.twin()?, task);
        Some(search.map(|search| self.search.insert(search).extent()))
    }

    /// Returns the workspace of the end point of the head (0) or the tail (1); `None` for another `end` or without a
    /// robot.
    pub fn workspace(&self, end: usize) -> Option<Workspace> {
        Some(Workspace::compute(self.robot()?, *End::ALL.get(end)?))
    }

    /// Makes the map of singularities of the head (0) or the tail (1); `None` for another `end` or without a robot.
    pub fn singularity_map(&self, end: usize) -> Option<SingularityMap> {
        Some(SingularityMap::compute(self.robot()?, *End::ALL.get(end)?))
    }

    /// Starts the core as at power-on with this robot.
    pub fn start_core(&mut self) {
        let robot = self.robot();
        self.running_core = robot.map(|robot| RunningCore::power_on(*robot.firmware()));
    }

    /// Runs the core for a frame with a board supply of `volts`; the core first receives `bytes` from the serial line.
    /// Returns the pulse widths in CPU cycles; `None` before [`PageState::start_core`].
    pub fn run_core_frame(&mut self, bytes: &[u8], volts: f64) -> Option<[u16; 4]> {
        Some(self.running_core.as_mut()?.run_frame(bytes, volts))
    }
}

/// Largest number of interpolated frames between two poses; after a longer pause, the motion is unknown.
const MAX_INTERPOLATED_FRAMES: u32 = 50;

fn make_frame(twin: &Twin, state: &State, slips: [f64; 4]) -> Frame {
    let scene = Scene::compute(twin);
    let loop_error = scene.as_ref().err().cloned();
    Frame {
        scene: scene.ok(),
        loop_error,
        place: state.body_pose.into(),
        slips,
        lags: state.lags,
    }
}

#[cfg(test)]
mod tests;
