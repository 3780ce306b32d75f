//! The page's connection to a robot's console, used by a calibration.

use std::time::Duration;

use js_sys::{Array, Reflect};
use lizard_calibrate::{ConsoleError, Reply, ReplyError};
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
/** A connection to a robot's console. Times are in ms of the robot's clock, which may be slower than real time. */
export interface Console {
  /** Sends a line; returns the answer, and the preceding `#` lines as `notes`. Rejects if there is no answer. */
  ask(line: string): Promise<{ notes: string[]; text: string }>;
  /** Waits for `durationMs` of the robot's clock. */
  wait(durationMs: number): Promise<void>;
}
";

#[wasm_bindgen]
extern "C" {
    /// A connection to a robot's console, made by the page.
    #[wasm_bindgen(typescript_type = "Console")]
    #[derive(Debug)]
    pub type Console;

    #[wasm_bindgen(method, catch)]
    async fn ask(this: &Console, line: &str) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(method, catch)]
    async fn wait(this: &Console, duration_ms: f64) -> Result<JsValue, JsValue>;
}

/// The robot at the other end of the page's connection. The errors are the values that the page throws.
#[derive(Debug)]
pub(crate) struct JsConsole(pub(crate) Console);

impl lizard_calibrate::Console for JsConsole {
    type Error = JsValue;

    async fn ask(&mut self, line: &str) -> Result<Reply, JsValue> {
        let answer = self.0.ask(line).await?;
        let notes = Array::from(&Reflect::get(&answer, &"notes".into())?);
        Ok(Reply {
            notes: notes.iter().map(string_or_empty).collect(),
            answer: string_or_empty(Reflect::get(&answer, &"text".into())?),
        })
    }

    async fn pause(&mut self, time: Duration) -> Result<(), JsValue> {
        self.0.wait(time.as_secs_f64() * 1000.0).await.map(drop)
    }
}

/// Converts a string from JavaScript; returns an empty string for any other value.
fn string_or_empty(value: JsValue) -> String {
    value.as_string().unwrap_or_default()
}

/// Converts an error to the thrown value: the page's own error, or a message about the robot's reply.
pub(crate) fn error_to_js(error: ConsoleError<JsValue>) -> JsValue {
    match error {
        ConsoleError::Reply(ReplyError::Refused { line, reason }) => {
            // The leading digits are the error's code, which is for programs.
            let reason = reason.trim_start_matches(|c: char| c.is_ascii_digit());
            make_js_error(&format!("The robot refuses \"{line}\":{reason}."))
        }
        ConsoleError::Reply(ReplyError::UnknownFormat { .. }) => {
            make_js_error("The robot's answer is unknown to this page; write this firmware first.")
        }
        ConsoleError::Link(error) => error,
    }
}

/// Creates a JavaScript error with this message.
pub(crate) fn make_js_error(text: &str) -> JsValue {
    JsError::new(text).into()
}
