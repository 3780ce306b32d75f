//! Conversion of a robot's calibration to JavaScript and back.

use js_sys::JSON;
use lizard_robot::Calibration;
use serde::Serialize;
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
import type { Calibration } from './lizard';
";

/// Reads a calibration from the robot's answer to `cal`, and skips other lines; null if a line is missing.
#[wasm_bindgen(js_name = readCalibration, unchecked_return_type = "Calibration | null")]
pub fn read_calibration(lines: Vec<String>) -> JsValue {
    to_js(Calibration::from_cal_answer(&lines))
}

/// Converts a value to JavaScript, or to `null` if the value cannot be written as JSON.
pub(crate) fn to_js(value: impl Serialize) -> JsValue {
    let text = serde_json::to_string(&value).unwrap_or_default();
    JSON::parse(&text).unwrap_or(JsValue::NULL)
}

/// Converts a calibration from JavaScript.
pub(crate) fn from_js(calibration: &JsValue) -> Result<Calibration, JsError> {
    let text = JSON::stringify(calibration)
        .map_err(|_| JsError::new("the calibration cannot be written as JSON"))?;
    Ok(serde_json::from_str(&String::from(text))?)
}
