//! The JavaScript class of a robot. Values are passed as JSON, which is fastest for objects with many small arrays;
//! their TypeScript types come from the structures of this crate.
#![allow(clippy::missing_errors_doc)] // each fails only if an argument has the wrong type

use js_sys::JSON;
use lizard_robot::edit;
use serde::Serialize;
use serde::de::DeserializeOwned;
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};

use crate::drawn_gait::DrawnGait;
use crate::lengths::{self, TriedLengths};
use crate::page::{EditedToml, PageState};
use crate::place::Place;
use crate::prediction::Displacement;
use crate::round_path::RoundPath;
use crate::trial::EditedGait;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
/** Values in servo order: A1 to A4, or LF, RF, RH, LH. */
export type Four<T> = [T, T, T, T];
/** Lengths by their keys in robot.toml. */
export type Edits = [key: string, value: number][];
/** A routine as it is written, valid or not. */
export interface Routine { name: string; steps: string[]; }
/** A gait whose legs share a waveform, each with its own start and gain: a bar per leg in the gait diagram. */
export interface Bars {
  name: string;
  /** True if the legs move one after the other and hold still in between. */
  held: boolean;
  /** Period, s. */
  period: number;
  /** Duty factor: the fraction of the cycle spent in stance. */
  duty: number;
  /** Amplitude, deg. */
  amplitude: number;
  /** Phase at which each stance begins, 0 to 1; if the legs hold still in between, only the order matters. */
  start: Four<number>;
  /** Gain of each leg, a factor of the amplitude. */
  gain: Four<number>;
}
";

/// Converts a value to JavaScript, or to `null` if the value cannot be written as JSON.
pub(crate) fn to_js(value: impl Serialize) -> JsValue {
    let text = serde_json::to_string(&value).unwrap_or_default();
    JSON::parse(&text).unwrap_or(JsValue::NULL)
}

/// Converts a value or its refusal to JavaScript; their keys distinguish them.
fn result_to_js(result: Result<impl Serialize, impl Serialize>) -> JsValue {
    result.map_or_else(to_js, to_js)
}

/// Converts an argument from JavaScript.
pub(crate) fn from_js<T: DeserializeOwned>(value: &JsValue) -> Result<T, JsError> {
    let text = JSON::stringify(value)
        .map_err(|_| JsError::new("the argument cannot be written as JSON"))?;
    Ok(serde_json::from_str(&String::from(text))?)
}

/// The page's robot, its place on the floor, its core, and the search for a faster gait.
#[wasm_bindgen(js_name = Robot)]
#[derive(Default)]
pub struct PageRobot(PageState);

#[wasm_bindgen(js_class = Robot)]
impl PageRobot {
    /// Creates an instance without a robot.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Loads the robot from a robot.toml. If the text is refused, the previous robot stays.
    #[wasm_bindgen(unchecked_return_type = "Description | Refusal")]
    pub fn load(&mut self, toml: &str) -> JsValue {
        result_to_js(self.0.load(toml))
    }

    /// Tries other lengths in a robot.toml; if `searches`, also searches for valid alternatives to refused lengths.
    #[wasm_bindgen(js_name = tryLengths, unchecked_return_type = "TriedLengths")]
    pub fn try_lengths(
        toml: &str,
        #[wasm_bindgen(unchecked_param_type = "Edits")] edits: &JsValue,
        searches: bool,
    ) -> Result<JsValue, JsError> {
        let edits: Vec<(String, f64)> = from_js(edits)?;
        Ok(to_js(TriedLengths::try_requested(toml, &edits, searches)))
    }

    /// Returns the smallest and the largest value that all these lengths may have together; null for an unknown key or
    /// an invalid robot.toml.
    #[wasm_bindgen(js_name = lengthRange, unchecked_return_type = "[number, number] | null")]
    pub fn length_range(toml: &str, keys: Vec<String>) -> JsValue {
        to_js(lengths::find_accepted_range(toml, &keys))
    }

    /// Returns the robot.toml with this floor, mass, feet and leg drive, and its refusal, if any.
    #[wasm_bindgen(js_name = editFloor, unchecked_return_type = "EditedToml | Refusal")]
    pub fn edit_floor(
        toml: &str,
        #[wasm_bindgen(unchecked_param_type = "Floor")] floor: &JsValue,
    ) -> Result<JsValue, JsError> {
        Ok(result_to_js(PageState::edit_floor(toml, from_js(floor)?)))
    }

    /// Makes the robot's section of flash, with the certified cells of its guard; empty if no robot is loaded. Takes
    /// some hundredths of a second.
    pub fn section(&self) -> Vec<u8> {
        let section = self.0.robot().map(|robot| robot.section());
        section.unwrap_or_default()
    }

    /// Moves the robot for a frame with these pulse widths in CPU cycles, 0 for no pulse; null if no robot is loaded.
    #[wasm_bindgen(js_name = followPulses, unchecked_return_type = "Frame | null")]
    pub fn follow_pulses(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Four<number>")] widths: &JsValue,
    ) -> Result<JsValue, JsError> {
        Ok(to_js(self.0.follow_pulses(from_js(widths)?)))
    }

    /// Moves the robot to a pose, deg, in `frame_count` frames; null if no robot is loaded.
    #[wasm_bindgen(js_name = followPose, unchecked_return_type = "Frame | null")]
    pub fn follow_pose(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Four<number>")] angles: &JsValue,
        frame_count: u32,
    ) -> Result<JsValue, JsError> {
        Ok(to_js(self.0.follow_pose(from_js(angles)?, frame_count)))
    }

    /// Returns the robot to its start on the floor.
    #[wasm_bindgen(js_name = returnToStart)]
    pub fn return_to_start(&mut self) {
        self.0.return_to_start();
    }

    /// Returns the displacement from one place to another, in the frame of the first place; mm and deg.
    #[wasm_bindgen(
        js_name = displacementBetween,
        unchecked_return_type = "{ forward: number; left: number; turn: number }"
    )]
    pub fn displacement_between(
        #[wasm_bindgen(unchecked_param_type = "Place")] from: &JsValue,
        #[wasm_bindgen(unchecked_param_type = "Place")] to: &JsValue,
    ) -> Result<JsValue, JsError> {
        let travel = from_js::<Place>(from)?.displacement_to(from_js(to)?);
        Ok(to_js(Displacement::from(travel)))
    }

    /// Sets the floor, the mass, the feet and the leg drive.
    #[wasm_bindgen(js_name = setFloor)]
    pub fn set_floor(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Floor")] floor: &JsValue,
    ) -> Result<(), JsError> {
        self.0.set_floor(from_js(floor)?);
        Ok(())
    }

    /// Sets the servo model by its name in the description; a voltage after the name, as in `own at 4.2`, also sets the
    /// supply.
    #[wasm_bindgen(js_name = setServoModel)]
    pub fn set_servo_model(&mut self, name: &str) {
        self.0.set_servo_model(name);
    }

    /// Predicts the gait with this index; null if there is no such gait. Takes tenths of a second; the page therefore
    /// calls it in a worker.
    #[wasm_bindgen(unchecked_return_type = "GaitPrediction | null")]
    pub fn predict(&self, gait: usize) -> JsValue {
        to_js(self.0.predict(gait))
    }

    /// Makes the map of singularities of the head (0) or the tail (1); null if no robot is loaded.
    #[wasm_bindgen(js_name = singularityMap, unchecked_return_type = "SingularityMap | null")]
    pub fn singularity_map(&self, end: usize) -> JsValue {
        to_js(self.0.singularity_map(end))
    }

    /// Returns the reversed gait.
    #[wasm_bindgen(unchecked_return_type = "Bars")]
    pub fn reversed(
        #[wasm_bindgen(unchecked_param_type = "Bars")] bars: &JsValue,
    ) -> Result<JsValue, JsError> {
        let bars: lizard_robot::Bars = from_js(bars)?;
        Ok(to_js(bars.reversed()))
    }

    /// Returns the gait with this index as bars; null for a gait along a path and for a gait without motion.
    #[wasm_bindgen(unchecked_return_type = "Bars | null")]
    pub fn bars(&self, gait: usize) -> JsValue {
        let gaits = self.0.robot().map(|robot| robot.gaits());
        let gait = gaits.and_then(|gaits| gaits.get(gait));
        to_js(gait.and_then(|gait| gait.bars()))
    }

    /// Tries a gait on the page's robot; takes tenths of a second. Returns null if no robot is loaded or a drawn
    /// line has no length.
    #[wasm_bindgen(js_name = tryGait, unchecked_return_type = "Trial | RefusedTrial | null")]
    pub fn try_gait(
        &self,
        #[wasm_bindgen(unchecked_param_type = "EditedGait")] edited_gait: &JsValue,
    ) -> Result<JsValue, JsError> {
        let edited_gait: EditedGait = from_js(edited_gait)?;
        let trial = self.0.twin().and_then(|twin| edited_gait.try_on(twin));
        Ok(trial.map_or(JsValue::NULL, result_to_js))
    }

    /// Returns the robot.toml with this gait. The gait replaces the gait of the same name, or else is added. Returns
    /// the text unchanged for a drawn line without length.
    #[wasm_bindgen(js_name = putGait)]
    pub fn put_gait(
        &self,
        toml: &str,
        #[wasm_bindgen(unchecked_param_type = "EditedGait")] edited_gait: &JsValue,
    ) -> Result<String, JsError> {
        let edited_gait: EditedGait = from_js(edited_gait)?;
        let robot = self.0.robot();
        let text = robot.and_then(|robot| edited_gait.put_into(toml, robot));
        Ok(text.unwrap_or_else(|| toml.to_owned()))
    }

    /// Returns the routines of a robot.toml, even of an invalid one.
    #[wasm_bindgen(unchecked_return_type = "Routine[]")]
    pub fn routines(toml: &str) -> JsValue {
        to_js(edit::read_routines(toml))
    }

    /// Returns the robot.toml with a routine of these steps, and its refusal, if any.
    #[wasm_bindgen(js_name = putSteps, unchecked_return_type = "EditedToml")]
    pub fn put_steps(toml: &str, name: &str, steps: Vec<String>) -> JsValue {
        to_js(EditedToml::check(edit::with_steps(toml, name, &steps)))
    }

    /// Simulates one round of a routine; takes tenths of a second. Returns null if there is no such routine.
    #[wasm_bindgen(js_name = simulateRound, unchecked_return_type = "RoundPath | null")]
    pub fn simulate_round(&self, routine: &str) -> JsValue {
        let twin = self.0.twin();
        to_js(twin.and_then(|twin| RoundPath::simulate(twin, routine)))
    }

    /// Returns the end point's smoothed path; null if the drawn line has no length.
    #[wasm_bindgen(js_name = smoothedPath, unchecked_return_type = "[number, number][] | null")]
    pub fn smoothed_path(
        &self,
        #[wasm_bindgen(unchecked_param_type = "DrawnGait")] drawn_gait: &JsValue,
    ) -> Result<JsValue, JsError> {
        let drawn_gait: DrawnGait = from_js(drawn_gait)?;
        let robot = self.0.robot();
        let points = robot.and_then(|robot| drawn_gait.shown_points(robot));
        Ok(to_js(points))
    }

    /// Returns the workspace of the end point of the head (0) or the tail (1); null if no robot is loaded.
    #[wasm_bindgen(unchecked_return_type = "Workspace | null")]
    pub fn workspace(&self, end: usize) -> JsValue {
        to_js(self.0.workspace(end))
    }

    /// Starts the firmware's core with this robot.
    #[wasm_bindgen(js_name = startCore)]
    pub fn start_core(&mut self) {
        self.0.start_core();
    }

    /// Runs the core for a frame of 20 ms with a board supply of `volts`; the core first receives `line` from the
    /// serial line. Returns the pulse widths in CPU cycles; null before `startCore`.
    #[wasm_bindgen(js_name = runCoreFrame, unchecked_return_type = "Four<number> | null")]
    pub fn run_core_frame(&mut self, line: &str, volts: f64) -> JsValue {
        to_js(self.0.run_core_frame(line.as_bytes(), volts))
    }
}

/// The search for a faster gait.
#[cfg(feature = "tune")]
#[wasm_bindgen(js_class = Robot)]
impl PageRobot {
    /// Prepares the search for a faster gait; returns the number of gaits to try and the speed that no servo may
    /// exceed. Returns null if no robot is loaded.
    #[wasm_bindgen(js_name = beginSearch, unchecked_return_type = "SearchExtent | Refusal")]
    pub fn begin_search(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "SearchTask")] task: &JsValue,
    ) -> Result<JsValue, JsError> {
        let search = self.0.begin_search(&from_js(task)?);
        Ok(search.map_or(JsValue::NULL, result_to_js))
    }

    /// Tries one more gait; returns the progress, with the score of the best gait so far.
    #[wasm_bindgen(js_name = tryNextGait, unchecked_return_type = "Progress")]
    pub fn try_next_gait(&mut self) -> JsValue {
        to_js(self.0.search.as_mut().map(|search| search.try_next()))
    }

    /// Compares the best gait so far with the gait to beat on `robot_count` random robots; null until a valid gait is
    /// found.
    #[wasm_bindgen(js_name = compareBestGait, unchecked_return_type = "FoundGait | null")]
    pub fn compare_best_gait(&mut self, robot_count: usize) -> JsValue {
        let search = self.0.search.as_ref();
        to_js(search.and_then(|search| search.compare_best(robot_count)))
    }
}
