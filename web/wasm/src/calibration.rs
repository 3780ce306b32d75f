//! A robot's calibration as JavaScript sees it: the rules of [`lizard_robot::Calibration`].
#![allow(clippy::missing_errors_doc)] // each fails if an argument has another type; `parse_calibration` says so

use lizard_robot::{Calibration, ServoSettings};
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};

use crate::javascript::{js, rust};

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
export interface ServoSettings {
  /** The counter-clockwise turn that the horn needs, deg. */
  trim: number;
  /** Ends of the travel, deg, chassis frame. */
  limit: [number, number];
  /** The direction in which a longer pulse turns the servo: '+' for counter-clockwise. */
  dir: '+' | '-';
  /** Pulse for a degree, us. */
  scale: number;
}
/** The settings that `save` stores. */
export interface Calibration {
  /** The action after power-on: a gait, or rest. */
  boot: string;
  /** Time without a line after which a gait ends, ms; 0 for never. */
  deadman: number;
  servos: Four<ServoSettings>;
}
";

/// Reads a calibration from the lines of `cal`, skipping other lines; null if one of its lines is missing.
#[must_use]
#[wasm_bindgen(js_name = readCalibration, unchecked_return_type = "Calibration | null")]
pub fn read_calibration(lines: Vec<String>) -> JsValue {
    js(Calibration::from_lines(&lines))
}

/// Reads a calibration from the text of a file; `name` is the file's name in the error.
///
/// # Errors
/// Fails with the first mistake in the text.
#[wasm_bindgen(js_name = parseCalibration, unchecked_return_type = "Calibration")]
pub fn parse_calibration(text: &str, name: &str) -> Result<JsValue, JsError> {
    Ok(js(Calibration::parse(text, name)?))
}

/// Formats a calibration as the text of its file.
#[wasm_bindgen(js_name = calibrationText)]
pub fn calibration_text(
    #[wasm_bindgen(unchecked_param_type = "Calibration")] calibration: &JsValue,
) -> Result<String, JsError> {
    Ok(rust::<Calibration>(calibration)?.text())
}

/// Returns true if a robot would print the same lines for both calibrations.
#[wasm_bindgen(js_name = isSameCalibration)]
pub fn is_same_calibration(
    #[wasm_bindgen(unchecked_param_type = "Calibration")] a: &JsValue,
    #[wasm_bindgen(unchecked_param_type = "Calibration")] b: &JsValue,
) -> Result<bool, JsError> {
    Ok(rust::<Calibration>(a)?.is_same(&rust(b)?))
}

/// Returns the settings of a servo that turns in the other direction, with the same pulse at its neutral angle.
#[wasm_bindgen(js_name = reversedServo, unchecked_return_type = "ServoSettings")]
pub fn reversed_servo(
    #[wasm_bindgen(unchecked_param_type = "ServoSettings")] servo: &JsValue,
) -> Result<JsValue, JsError> {
    Ok(js(rust::<ServoSettings>(servo)?.reversed()))
}

/// Returns the settings of a servo with another scale, us/deg, and the same pulse at its neutral angle.
#[wasm_bindgen(js_name = scaledServo, unchecked_return_type = "ServoSettings")]
pub fn scaled_servo(
    #[wasm_bindgen(unchecked_param_type = "ServoSettings")] servo: &JsValue,
    scale: f64,
) -> Result<JsValue, JsError> {
    Ok(js(rust::<ServoSettings>(servo)?.with_scale(scale)))
}

/// The lines that set a robot's calibration, without saving it, in an order that the robot accepts.
#[wasm_bindgen]
pub struct Transfer(lizard_robot::Transfer);

#[wasm_bindgen]
impl Transfer {
    /// Makes a transfer; no line was sent yet.
    #[wasm_bindgen(constructor)]
    pub fn new(
        #[wasm_bindgen(unchecked_param_type = "Calibration")] calibration: &JsValue,
    ) -> Result<Self, JsError> {
        Ok(Self(lizard_robot::Transfer::new(&rust(calibration)?)))
    }

    /// Returns the next line to send; undefined if all lines are accepted, or if all that are left were refused
    /// again.
    #[wasm_bindgen(js_name = nextLine)]
    pub fn next_line(&mut self) -> Option<String> {
        self.0.next_line()
    }

    /// Notes that the robot has refused the last line; returns true for the first refused line of a round through the
    /// lines that are left.
    pub fn refuse(&mut self) -> bool {
        self.0.refuse()
    }

    /// True if the robot has accepted all lines.
    #[must_use]
    #[wasm_bindgen(getter, js_name = isDone)]
    pub fn is_done(&self) -> bool {
        self.0.is_done()
    }
}
