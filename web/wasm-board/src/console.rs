//! The page's connection to a robot as a console.

use std::time::Duration;

use js_sys::{Array, JsString, Reflect};
use lizard_calibrate::{BadReply, ConsoleError, Reply};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const CONSOLE: &str = "
/** A connection to a robot's console. Times are in ms, of the robot: a simulated one may be slower than this machine. */
export interface Console {
  /** Sends a line; returns the robot's answer and the lines with # before it. Rejects if there is no answer. */
  ask(line: string): Promise<{ notes: string[]; text: string }>;
  wait(time: number): Promise<void>;
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
    async fn wait(this: &Console, time: f64) -> Result<JsValue, JsValue>;
}

/// A robot at the page's connection; an error is that of the page.
#[derive(Debug)]
pub(crate) struct JsConsole(pub(crate) Console);

impl lizard_calibrate::Console for JsConsole {
    type Error = JsValue;

    async fn ask(&mut self, line: &str) -> Result<Reply, JsValue> {
        let answer = self.0.ask(line).await?;
        let notes = Array::from(&Reflect::get(&answer, &"notes".into())?);
        Ok(Reply {
            notes: notes.iter().map(text).collect(),
            answer: text(Reflect::get(&answer, &"text".into())?),
        })
    }

    async fn pause(&mut self, time: Duration) -> Result<(), JsValue> {
        self.0.wait(time.as_secs_f64() * 1000.0).await.map(drop)
    }
}

/// A string of JavaScript; anything else is empty.
fn text(value: JsValue) -> String {
    value
        .dyn_into::<JsString>()
        .map_or(String::new(), Into::into)
}

/// The error that the page gets: its own, or a sentence.
pub(crate) fn thrown(error: ConsoleError<JsValue>) -> JsValue {
    match error {
        ConsoleError::Reply(BadReply::Refused { line, reason }) => {
            // The code is for programs.
            let reason = reason.trim_start_matches(|c: char| c.is_ascii_digit());
            sentence(&format!("The robot refuses \"{line}\":{reason}."))
        }
        ConsoleError::Reply(BadReply::Unclear { .. }) => {
            sentence("The robot does not answer as this page knows it: write this firmware first.")
        }
        ConsoleError::Link(error) => error,
    }
}

/// A sentence as an error of JavaScript.
pub(crate) fn sentence(text: &str) -> JsValue {
    JsError::new(text).into()
}
