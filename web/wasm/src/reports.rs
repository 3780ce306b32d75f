//! A board's lines about itself, as values for JavaScript.

use lizard_robot::{Banner, Status};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::javascript::to_js;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
/** The firmware's first line after a reset. */
export interface Banner {
  version: string;
  /** The robot in the flash; null if it is missing or damaged. */
  robot: { name: string; hash: string } | null;
}
/** The answer to `status`. */
export interface Status {
  /** The robot's activity: a gait or a command, with hyphens for spaces. */
  gait: string;
  /** Phase of the gait's cycle, 0 to 1; 0 while no gait runs. */
  phase: number;
  /** Pace, percent; null if there is no robot in the flash. */
  pace: number | null;
  /** Number of frames since the program started. */
  frames: number;
  /** Smallest margin; null if there is no robot in the flash. */
  margin: number | null;
  /** True if the guard holds the robot in its last safe pose. */
  isHeld: boolean;
  /** The fault's name; null if there is none. */
  fault: string | null;
  /** Voltage of the board, V; null until it is measured. */
  vcc: number | null;
  /** Number of late edges of pulses. */
  lateEdges: number;
  /** Number of lost received bytes. */
  lostBytes: number;
  /** Cause of the last reset. */
  resetCause: string;
  /** Number of resets since power-on. */
  resetCount: number;
}
";

/// Parses a banner; returns null for any other line.
#[wasm_bindgen(js_name = parseBanner, unchecked_return_type = "Banner | null")]
pub fn parse_banner(line: &str) -> JsValue {
    to_js(Banner::parse(line))
}

/// Parses an answer `ok gait=...`; returns null for any other line.
#[wasm_bindgen(js_name = parseStatus, unchecked_return_type = "Status | null")]
pub fn parse_status(line: &str) -> JsValue {
    to_js(Status::parse(line))
}

/// Parses the pose in a line `# t=<frame> pose=...`, deg; returns null for any other line.
#[wasm_bindgen(js_name = parsePoseReport, unchecked_return_type = "Four<number> | null")]
pub fn parse_pose_report(line: &str) -> JsValue {
    to_js(lizard_robot::parse_pose_report(line).map(|(_, angles)| angles))
}
