//! A robot's calibration as JavaScript sees it, and its file.

use lizard_robot::Calibration;
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

/// Reads a calibration from the text of a file; `name` is the file's name in the error.
///
/// # Errors
/// Fails with the first mistake in the text.
#[wasm_bindgen(js_name = parseCalibration, unchecked_return_type = "Calibration")]
pub fn parse_calibration(text: &str, name: &str) -> Result<JsValue, JsError> {
    Ok(js(Calibration::parse(text, name)?))
}

/// Formats a calibration as the text of its file.
///
/// # Errors
/// Fails if it is no calibration.
#[wasm_bindgen(js_name = calibrationText)]
pub fn calibration_text(
    #[wasm_bindgen(unchecked_param_type = "Calibration")] calibration: &JsValue,
) -> Result<String, JsError> {
    Ok(rust::<Calibration>(calibration)?.text())
}
