//! A robot's calibration on its way to JavaScript and back.

use js_sys::JSON;
use lizard_robot::Calibration;
use serde::Serialize;
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
import type { Calibration } from './lizard';
";

/// Reads a calibration from the lines of `cal`, skipping other lines; null if one of its lines is missing.
#[must_use]
#[wasm_bindgen(js_name = readCalibration, unchecked_return_type = "Calibration | null")]
pub fn read_calibration(lines: Vec<String>) -> JsValue {
    js(Calibration::from_lines(&lines))
}

/// Converts an answer to JavaScript; to `null` if it cannot be written as JSON.
pub(crate) fn js(answer: impl Serialize) -> JsValue {
    let text = serde_json::to_string(&answer).unwrap_or_default();
    JSON::parse(&text).unwrap_or(JsValue::NULL)
}

/// Converts a calibration from JavaScript.
pub(crate) fn rust(calibration: &JsValue) -> Result<Calibration, JsError> {
    let text = JSON::stringify(calibration).map_err(|_| JsError::new("this is no JSON"))?;
    Ok(serde_json::from_str(&String::from(text))?)
}
