//! The camera as JavaScript sees it: a class by wasm-bindgen.

use js_sys::JSON;
use lizard_film::Picture;
use lizard_measure::Paper;
use serde::Serialize;
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};

use crate::camera::{Camera, Refused};

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
/** A point of a picture, px. */
export type Pixel = [number, number];
/** A part of a cycle's movement: mm or deg. */
export interface Part {
  mean: number;
  /** Standard deviation of single cycles. */
  sd: number;
  /** Standard error of the mean. */
  error: number;
  predicted: number | null;
  /** The mean less the prediction, in standard errors. */
  differs: number | null;
  agrees: boolean | null;
}
/** A gait as `lizard measure --json` prints it. */
export interface Report {
  gait: string;
  /** Percent. */
  speed: number;
  cycles: number;
  forward: Part;
  left: Part;
  turn: Part;
  /** The movement per cycle by MuJoCo with ideal servos: mm ahead and to the left, deg; known only for some robots. */
  mujoco?: [number, number, number];
  range?: Range;
}
/** The range of the predicted distance or turn per cycle when one assumption at a time is changed: mm or deg. */
export interface Range {
  /** Its name and unit. */
  part: string;
  least: number;
  most: number;
  /** The assumption that gives each bound; null if it is that of robot.toml. */
  least_by: string | null;
  most_by: string | null;
}
";

impl From<Refused> for JsError {
    fn from(refusal: Refused) -> Self {
        Self::new(&refusal.refused)
    }
}

fn js(answer: impl Serialize) -> JsValue {
    let text = serde_json::to_string(&answer).unwrap_or_default();
    JSON::parse(&text).unwrap_or(JsValue::NULL)
}

/// The page's camera: finds tags in pictures, and adds pictures to a film.
#[wasm_bindgen(js_name = Camera)]
#[derive(Default)]
pub struct PageCamera(Camera);

#[wasm_bindgen(js_class = Camera)]
impl PageCamera {
    /// Begins a film.
    #[must_use]
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Finds the tags of a picture that was taken at a time, s; if `is_kept`, adds the picture to the film. A grey
    /// picture has one byte per pixel, a picture in colour has four.
    ///
    /// # Errors
    /// Fails if the picture is incomplete; or if it is kept, and does not belong to the film or shows a tag twice.
    #[wasm_bindgen(unchecked_return_type = "TagEntry[]")]
    pub fn look(
        &mut self,
        width: usize,
        height: usize,
        pixels: Vec<u8>,
        seconds: f64,
        is_kept: bool,
    ) -> Result<JsValue, JsError> {
        let picture = match pixels.len() == width * height {
            true => Picture::new(width, height, pixels),
            false => Picture::of_colours(width, height, &pixels),
        };
        let picture = picture.ok_or_else(|| JsError::new("the picture is not whole"))?;
        Ok(js(match is_kept {
            true => self.0.add(&picture, seconds)?,
            false => self.0.look(&picture),
        }))
    }

    /// Measures gaits in the film.
    ///
    /// # Errors
    /// Fails if the film does not show what is needed; see [`Camera::measure`].
    #[wasm_bindgen(unchecked_return_type = "Results")]
    pub fn measure(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Asked")] asked: &JsValue,
    ) -> Result<JsValue, JsError> {
        let json = JSON::stringify(asked).map_err(|_| JsError::new("this is no JSON"))?;
        let request = serde_json::from_str(&String::from(json))?;
        Ok(js(self.0.measure(&request)?))
    }

    /// Returns the sheet of tags as PDF, for paper of 11 x 8.5 inches if `is_letter`, else for A4.
    #[must_use]
    pub fn sheet(is_letter: bool) -> Vec<u8> {
        let paper = if is_letter { Paper::Letter } else { Paper::A4 };
        paper.sheet()
    }
}
