//! Conversion of a robot's calibration between JavaScript and a file.

use lizard_robot::Calibration;
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};

use crate::javascript::{from_js, to_js};

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
export interface ServoSettings {
  /** The rotation that corrects the horn's mounting angle, deg, counter-clockwise. */
  trim: number;
  /** Ends of the travel, deg, chassis frame. */
  limit: [number, number];
  /** The direction in which a longer pulse turns the servo: '+' for counter-clockwise. */
  dir: '+' | '-';
  /** Pulse width per degree, us. */
  scale: number;
}
/** The settings that `save` stores. */
export interface Calibration {
  /** The action after power-on: a gait, or rest. */
  boot: string;
  /** Time without a line from the host after which a gait ends, ms; 0 if it never ends. */
  deadman: number;
  servos: Four<ServoSettings>;
}
";

/// Parses the text of a calibration file; `name` is the file's name, for the error message.
///
/// # Errors
/// Fails with the first mistake in the text.
#[wasm_bindgen(js_name = parseCalibration, unchecked_return_type = "Calibration")]
pub fn parse_calibration(text: &str, name: &str) -> Result<JsValue, JsError> {
    Ok(to_js(Calibration::parse(text, name)?))
}

/// Formats a calibration as the text of a file.
///
/// # Errors
/// Fails if the value is not a calibration.
#[wasm_bindgen(js_name = formatCalibration)]
pub fn format_calibration(
    #[wasm_bindgen(unchecked_param_type = "Calibration")] calibration: &JsValue,
) -> Result<String, JsError> {
    Ok(from_js::<Calibration>(calibration)?.to_toml())
}
