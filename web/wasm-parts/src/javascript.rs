//! The JavaScript class that makes a robot's parts. It throws a [`Refusal`] if they cannot be made.

use js_sys::{Function, JSON};
use lizard_parts::OutputFile;
use serde::Serialize;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::model::{Model, Refusal};
use crate::solids::Triangles;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
/** Two parts that overlap or come too close. */
export interface CollidingPair {
  first: string;
  second: string;
  /** Their distance, mm; negative if they overlap. */
  mm: number;
  /** Servo angles of a pose at which they overlap or come too close, deg; null if no such pose is known, or if
   *  they overlap at every pose. */
  pose: number[] | null;
}
";

fn to_js(value: impl Serialize) -> JsValue {
    let text = serde_json::to_string(&value).unwrap_or_default();
    JSON::parse(&text).unwrap_or(JsValue::NULL)
}

impl From<Refusal> for JsValue {
    fn from(refusal: Refusal) -> Self {
        to_js(refusal)
    }
}

/// A file that `lizard parts` writes.
#[derive(Clone, Debug)]
#[wasm_bindgen(getter_with_clone)]
pub struct PartFile {
    /// The file's path.
    pub path: String,
    /// The file's bytes.
    pub bytes: Vec<u8>,
}

/// The parts of a robot.
#[wasm_bindgen]
pub struct Parts(Model);

#[wasm_bindgen]
impl Parts {
    /// Makes the parts for a robot.toml.
    ///
    /// # Errors
    /// Fails if robot.toml is invalid, or if the robot's parts cannot be made.
    #[wasm_bindgen(constructor)]
    pub fn new(toml: &str) -> Result<Self, Refusal> {
        Ok(Self(Model::from_toml(toml)?))
    }

    /// Describes the model for the page, without triangles.
    #[wasm_bindgen(unchecked_return_type = "ModelDescription")]
    pub fn describe(&self) -> JsValue {
        to_js(self.0.describe())
    }

    /// Makes the triangles of the solids, in the order of `BodyEntry.solid`.
    ///
    /// # Errors
    /// Fails if the layers of a part do not form a closed body.
    pub fn solids(&self) -> Result<Vec<Triangles>, Refusal> {
        self.0.make_solids()
    }

    /// Returns x, y, cosine and sine of every mount for servo angles and leg lags in deg; undefined if a loop does not
    /// close, or if an array does not have four numbers.
    pub fn pose(
        &self,
        #[wasm_bindgen(unchecked_param_type = "number[]")] angles: &[f64],
        #[wasm_bindgen(unchecked_param_type = "number[]")] lags: &[f64],
    ) -> Option<Vec<f64>> {
        let (angles, lags) = (angles.try_into().ok()?, lags.try_into().ok()?);
        Some(self.0.place_mounts(angles, lags)?.into_flattened())
    }

    /// Proves that no two parts overlap or come too close; returns the smallest distance, mm, or undefined if no pair
    /// was checked. Calls `progress` with the number of finished checks and their total number.
    ///
    /// # Errors
    /// Returns two parts that overlap or come too close.
    pub fn prove(
        &self,
        #[wasm_bindgen(unchecked_param_type = "(done: number, total: number) => void")]
        progress: &Function,
    ) -> Result<Option<f64>, Refusal> {
        self.0.prove(|done, total| {
            // An error of the callback is ignored: a page that no longer needs the proof terminates the worker.
            let _ = progress.call2(&JsValue::NULL, &done.into(), &total.into());
        })
    }

    /// Makes one group of files; `group` is the group's index, below `ModelDescription.file_group_count`.
    ///
    /// # Errors
    /// Fails if the layers of a part do not form a closed body, or if a screw cannot be reached.
    pub fn files(&self, group: usize) -> Result<Vec<PartFile>, Refusal> {
        let files = self.0.make_files(group)?.into_iter();
        let to_part_file = |OutputFile { path, bytes }| PartFile { path, bytes };
        Ok(files.map(to_part_file).collect())
    }
}
