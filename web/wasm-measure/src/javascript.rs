//! The JavaScript class that tracks the robot in frames and measures its gaits.

use js_sys::JSON;
use lizard_measure::PaperSize;
use lizard_video::Frame;
use serde::Serialize;
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};

use crate::camera::Camera;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
/** A point of a frame, px. */
export type Pixel = [number, number];
/** A component of a cycle's movement: mm or deg. */
export interface Component {
  mean: number;
  /** Standard deviation of a single cycle. */
  sd: number;
  /** Standard error of the mean. */
  error: number;
  predicted: number | null;
  /** The mean minus the prediction, in standard errors. */
  differs: number | null;
  /** True if the mean agrees with the prediction; null without a prediction. */
  agrees: boolean | null;
}
/** A gait as `lizard measure --json` prints it. */
export interface Report {
  gait: string;
  /** The pace, percent of the gait's nominal pace. */
  speed: number;
  cycles: number;
  forward: Component;
  left: Component;
  turn: Component;
  /**
   * MuJoCo's movement per cycle with ideal servos: mm forward, mm to the left, deg counter-clockwise; known only for
   * some robots.
   */
  mujoco?: [number, number, number];
  range?: Range;
}
/** The range of the predicted distance or turn per cycle, mm or deg, while one assumption at a time is changed. */
export interface Range {
  /** Name and unit of the distance or turn. */
  part: string;
  least: number;
  most: number;
  /** The changed assumption that gives each bound; null if robot.toml itself gives it. */
  least_by: string | null;
  most_by: string | null;
}
";

fn to_js(value: impl Serialize) -> JsValue {
    let text = serde_json::to_string(&value).unwrap_or_default();
    JSON::parse(&text).unwrap_or(JsValue::NULL)
}

/// The page's camera: finds tags in frames, adds frames to a video, and measures the gaits in it.
#[wasm_bindgen(js_name = Camera)]
#[derive(Default)]
pub struct PageCamera(Camera);

#[wasm_bindgen(js_class = Camera)]
impl PageCamera {
    /// Creates a camera with an empty video.
    #[must_use]
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Finds the tags in a frame that was taken at `seconds` on the video's clock; if `is_kept`, adds the frame to the
    /// video. A grey frame has one byte per pixel, a colour frame four bytes.
    ///
    /// # Errors
    /// Fails if the frame is incomplete, or if it is to be kept but does not fit the video or shows a tag twice.
    #[wasm_bindgen(js_name = findTags, unchecked_return_type = "TagEntry[]")]
    pub fn find_tags(
        &mut self,
        width: usize,
        height: usize,
        pixels: Vec<u8>,
        seconds: f64,
        is_kept: bool,
    ) -> Result<JsValue, JsError> {
        let frame = match pixels.len() == width * height {
            true => Frame::new(width, height, pixels),
            false => Frame::from_rgba(width, height, &pixels),
        };
        let frame = frame.ok_or_else(|| JsError::new("the frame is incomplete"))?;
        Ok(to_js(match is_kept {
            true => self.0.add_frame(&frame, seconds)?,
            false => self.0.find_tags(&frame),
        }))
    }

    /// Measures gaits in the video.
    ///
    /// # Errors
    /// Fails as [`Camera::measure`] does.
    #[wasm_bindgen(unchecked_return_type = "Results")]
    pub fn measure(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "MeasureRequest")] request: &JsValue,
    ) -> Result<JsValue, JsError> {
        let json = JSON::stringify(request)
            .map_err(|_| JsError::new("the request cannot be converted to JSON"))?;
        let request = serde_json::from_str(&String::from(json))?;
        let results = self.0.measure(&request);
        let results = results.map_err(|error| JsError::new(&error.to_string()));
        Ok(to_js(results?))
    }

    /// Draws the sheet of tags as PDF, for US Letter paper if `is_letter`, otherwise for A4.
    #[must_use]
    #[wasm_bindgen(js_name = drawSheet)]
    pub fn draw_sheet(is_letter: bool) -> Vec<u8> {
        match is_letter {
            true => PaperSize::Letter.draw_tag_sheet(),
            false => PaperSize::A4.draw_tag_sheet(),
        }
    }
}
