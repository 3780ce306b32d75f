//! The robot as JavaScript sees it: a class by wasm-bindgen. Values are passed as JSON, which is fastest for objects
//! with many small arrays; their types come from the structures of this crate.
#![allow(clippy::missing_errors_doc)] // each fails if an argument has another type, and for no other reason

use js_sys::JSON;
use lizard_robot::edit;
use serde::Serialize;
use serde::de::DeserializeOwned;
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};

use crate::lengths::{self, Lengths};
use crate::page::Page;
use crate::place::Place;
use crate::prediction::Movement;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
/** Values in servo order: A1 to A4, or LF, RF, RH, LH. */
export type Four<T> = [T, T, T, T];
/** Lengths by their keys in robot.toml. */
export type Edits = [key: string, value: number][];
/** A routine as it is written, right or wrong. */
export interface Routine { name: string; steps: string[]; }
/** A gait as four bars: numbers in servo order. */
export interface Bars {
  name: string;
  /** True if legs move one after the other and hold in between. */
  held: boolean;
  /** Period, s. */
  period: number;
  /** Duty factor: the stance's share of the cycle. */
  duty: number;
  /** Amplitude, deg. */
  amplitude: number;
  /** Phase at which each stance begins, 0 to 1; of legs that hold only the order counts. */
  start: Four<number>;
  /** Gain of each leg: its share of the amplitude. */
  gain: Four<number>;
}
";

/// Converts an answer to JavaScript; to `null` if it cannot be written as JSON.
pub(crate) fn js(answer: impl Serialize) -> JsValue {
    let text = serde_json::to_string(&answer).unwrap_or_default();
    JSON::parse(&text).unwrap_or(JsValue::NULL)
}

/// Converts an answer or a refusal to JavaScript, where their keys tell them apart.
fn result_to_js(result: Result<impl Serialize, impl Serialize>) -> JsValue {
    result.map_or_else(js, js)
}

/// Converts an argument from JavaScript.
pub(crate) fn rust<T: DeserializeOwned>(value: &JsValue) -> Result<T, JsError> {
    let text = JSON::stringify(value).map_err(|_| JsError::new("this is no JSON"))?;
    Ok(serde_json::from_str(&String::from(text))?)
}

/// The page's robot, its place on the floor, and the programs that run on it.
#[wasm_bindgen]
#[derive(Default)]
pub struct Robot(Page);

#[wasm_bindgen]
impl Robot {
    /// Makes a page without a robot.
    #[must_use]
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Loads the robot of a robot.toml. If it is refused, the previous robot stays.
    #[wasm_bindgen(unchecked_return_type = "Description | Refused")]
    pub fn read(&mut self, toml: &str) -> JsValue {
        result_to_js(self.0.read(toml))
    }

    /// Tries other lengths in a robot.toml; if `searches`, also looks for valid alternatives to refused lengths.
    #[wasm_bindgen(unchecked_return_type = "Lengths")]
    pub fn lengths(
        toml: &str,
        #[wasm_bindgen(unchecked_param_type = "Edits")] edits: &JsValue,
        searches: bool,
    ) -> Result<JsValue, JsError> {
        let edits: Vec<(String, f64)> = rust(edits)?;
        Ok(js(Lengths::of(toml, &edits, searches)))
    }

    /// Returns the least and the greatest value with which the robot walks if all these lengths have it; null for an
    /// unknown key or an invalid robot.toml.
    #[must_use]
    #[wasm_bindgen(js_name = lengthRange, unchecked_return_type = "[number, number] | null")]
    pub fn length_range(toml: &str, keys: Vec<String>) -> JsValue {
        js(lengths::range(toml, &keys))
    }

    /// Returns the robot.toml with this floor, mass, feet and leg drive, and its refusal, if any.
    #[wasm_bindgen(js_name = editFloor, unchecked_return_type = "Edited | Refused")]
    pub fn edit_floor(
        toml: &str,
        #[wasm_bindgen(unchecked_param_type = "Floor")] floor: &JsValue,
    ) -> Result<JsValue, JsError> {
        Ok(result_to_js(Page::edit_floor(toml, rust(floor)?)))
    }

    /// Makes the robot's section of flash, with the certified cells of its guard; empty without a robot. Takes some
    /// hundredths of a second.
    #[must_use]
    pub fn section(&self) -> Vec<u8> {
        self.0.section().unwrap_or_default()
    }

    /// Moves the robot by a frame with these pulse widths, CPU cycles, 0 for no pulse; null without a robot.
    #[wasm_bindgen(unchecked_return_type = "Frame | null")]
    pub fn pulses(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Four<number>")] widths: &JsValue,
    ) -> Result<JsValue, JsError> {
        Ok(js(self.0.pulses(rust(widths)?)))
    }

    /// Moves the robot to a pose, deg, which it reaches `frames` frames after the previous one; null without a robot.
    #[wasm_bindgen(unchecked_return_type = "Frame | null")]
    pub fn pose(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Four<number>")] angles: &JsValue,
        frames: u32,
    ) -> Result<JsValue, JsError> {
        Ok(js(self.0.pose(rust(angles)?, frames)))
    }

    /// Returns the robot to the start of its path.
    pub fn restart(&mut self) {
        self.0.restart();
    }

    /// Returns the displacement between two places in the frame of the first, mm and deg.
    #[wasm_bindgen(unchecked_return_type = "{ forward: number; left: number; turn: number }")]
    pub fn between(
        #[wasm_bindgen(unchecked_param_type = "Place")] from: &JsValue,
        #[wasm_bindgen(unchecked_param_type = "Place")] to: &JsValue,
    ) -> Result<JsValue, JsError> {
        let from: Place = rust(from)?;
        Ok(js(Movement::from(from.movement_to(rust(to)?))))
    }

    /// Sets the floor, the mass, the feet and the leg drive.
    #[wasm_bindgen(js_name = setFloor)]
    pub fn set_floor(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Floor")] floor: &JsValue,
    ) -> Result<(), JsError> {
        self.0.set_floor(rust(floor)?);
        Ok(())
    }

    /// Selects the servo model by its name in the description; `own at 4.2` also sets the supply voltage.
    #[wasm_bindgen(js_name = setServos)]
    pub fn set_servos(&mut self, name: &str) {
        self.0.set_servos(name);
    }

    /// Predicts a gait by its index; null without it. Takes tenths of a second, so the page asks a worker.
    #[must_use]
    #[wasm_bindgen(unchecked_return_type = "GaitPrediction | null")]
    pub fn predict(&self, gait: usize) -> JsValue {
        js(self.0.predict(gait))
    }

    /// Makes the map of singularities of the head (0) or the tail (1); null without a robot.
    #[must_use]
    #[wasm_bindgen(unchecked_return_type = "Map | null")]
    pub fn map(&self, end: usize) -> JsValue {
        js(self.0.map(end))
    }

    /// Returns the gait in reverse.
    #[wasm_bindgen(unchecked_return_type = "Bars")]
    pub fn reversed(
        #[wasm_bindgen(unchecked_param_type = "Bars")] bars: &JsValue,
    ) -> Result<JsValue, JsError> {
        let bars: lizard_robot::Bars = rust(bars)?;
        Ok(js(bars.reversed()))
    }

    /// Returns a gait, by its index, as bars; null for a gait along a path and for a gait without motion.
    #[must_use]
    #[wasm_bindgen(unchecked_return_type = "Bars | null")]
    pub fn bars(&self, gait: usize) -> JsValue {
        js(self.0.bars(gait))
    }

    /// Tries a gait on the robot that was read; takes tenths of a second. Null without a robot, or for a drawn line
    /// without length.
    #[wasm_bindgen(unchecked_return_type = "Trial | NoTrial | null")]
    pub fn trial(
        &self,
        #[wasm_bindgen(unchecked_param_type = "EditedGait")] made: &JsValue,
    ) -> Result<JsValue, JsError> {
        Ok(self
            .0
            .trial(&rust(made)?)
            .map_or(JsValue::NULL, result_to_js))
    }

    /// Returns the robot.toml with a gait in place of the gait of the same name, else added; unchanged for a drawn
    /// line without length.
    #[wasm_bindgen(js_name = putGait)]
    pub fn put_gait(
        &self,
        toml: &str,
        #[wasm_bindgen(unchecked_param_type = "EditedGait")] made: &JsValue,
    ) -> Result<String, JsError> {
        let text = self.0.put_gait(toml, &rust(made)?);
        Ok(text.unwrap_or_else(|| toml.to_owned()))
    }

    /// Returns the routines of a robot.toml, even of one that has a mistake.
    #[must_use]
    #[wasm_bindgen(unchecked_return_type = "Routine[]")]
    pub fn routines(toml: &str) -> JsValue {
        js(edit::routines(toml))
    }

    /// Returns the robot.toml with a routine of these steps, and its refusal, if any.
    #[must_use]
    #[wasm_bindgen(js_name = putSteps, unchecked_return_type = "Edited")]
    pub fn put_steps(toml: &str, name: &str, steps: Vec<String>) -> JsValue {
        js(Page::put_steps(toml, name, &steps))
    }

    /// Simulates one round of a routine; takes tenths of a second. Null without the routine.
    #[must_use]
    #[wasm_bindgen(unchecked_return_type = "RoundPath | null")]
    pub fn round(&self, routine: &str) -> JsValue {
        js(self.0.round(routine))
    }

    /// Returns the path that the end point really follows; null if the drawn line has no length.
    #[wasm_bindgen(unchecked_return_type = "[number, number][] | null")]
    pub fn path(
        &self,
        #[wasm_bindgen(unchecked_param_type = "DrawnGait")] drawn: &JsValue,
    ) -> Result<JsValue, JsError> {
        Ok(js(self.0.path(&rust(drawn)?)))
    }

    /// Returns the area that the end point of the head (0) or the tail (1) may reach; null without a robot.
    #[must_use]
    #[wasm_bindgen(js_name = reachArea, unchecked_return_type = "ReachArea | null")]
    pub fn reach_area(&self, end: usize) -> JsValue {
        js(self.0.reach_area(end))
    }

    /// Starts the firmware's core with this robot.
    #[wasm_bindgen(js_name = runCore)]
    pub fn run_core(&mut self) {
        self.0.run_core();
    }

    /// Runs the core for a frame of 20 ms at a supply in V, after it has received a text from the serial line; null
    /// before `runCore`.
    #[wasm_bindgen(js_name = coreFrame, unchecked_return_type = "CoreFrame | null")]
    pub fn core_frame(&mut self, line: &str, volts: f64) -> JsValue {
        js(self.0.core_frame(line.as_bytes(), volts))
    }
}

/// The search for a faster gait.
#[cfg(feature = "tune")]
#[wasm_bindgen]
impl Robot {
    /// Prepares the search for a gait of the robot that was read; returns the number of gaits to try and the servos'
    /// largest deg/s. Null without a robot.
    #[wasm_bindgen(js_name = makeFaster, unchecked_return_type = "SearchExtent | Refused")]
    pub fn make_faster(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "SearchTask")] task: &JsValue,
    ) -> Result<JsValue, JsError> {
        let search = self.0.make_faster(&rust(task)?);
        Ok(search.map_or(JsValue::NULL, result_to_js))
    }

    /// Tries one more gait; returns the progress, with the score of the best gait so far.
    #[wasm_bindgen(js_name = fasterStep, unchecked_return_type = "Progress")]
    pub fn faster_step(&mut self) -> JsValue {
        js(self.0.faster().map(|search| search.step()))
    }

    /// Returns the best gait so far, compared with the given one on a number of random robots; null while no gait has
    /// kept the limits.
    #[wasm_bindgen(js_name = fasterFound, unchecked_return_type = "Found | null")]
    pub fn faster_found(&mut self, robots: usize) -> JsValue {
        js(self.0.faster().and_then(|search| search.found(robots)))
    }
}
