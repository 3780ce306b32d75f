//! The page's serial line to a board, used by an upload.

use std::time::Duration;

use js_sys::{Error, Uint8Array};
use lizard_upload::{Board, BoardError};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = "
/** A serial line to a board. Times are in ms of the board's clock, which may be slower than real time. */
export interface SerialLine {
  /** Resets the board and sets the baud rate. */
  reset(baud: number): Promise<void>;
  write(bytes: Uint8Array): Promise<void>;
  /** Returns `count` bytes, or fewer if not all arrive within `timeoutMs`. */
  read(count: number, timeoutMs: number): Promise<Uint8Array>;
  /** Waits for `durationMs` and discards all bytes received until then. */
  discard(durationMs: number): Promise<void>;
}
";

#[wasm_bindgen]
extern "C" {
    /// A serial line to a board, made by the page.
    #[wasm_bindgen(typescript_type = "SerialLine")]
    #[derive(Debug)]
    pub type SerialLine;

    #[wasm_bindgen(method, catch)]
    async fn reset(this: &SerialLine, baud: u32) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(method, catch)]
    async fn write(this: &SerialLine, bytes: Uint8Array) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(method, catch)]
    async fn read(this: &SerialLine, count: u32, timeout_ms: f64) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(method, catch)]
    async fn discard(this: &SerialLine, duration_ms: f64) -> Result<JsValue, JsValue>;
}

/// The board at the other end of the page's serial line.
#[derive(Debug)]
pub(crate) struct JsBoard(pub(crate) SerialLine);

impl Board for JsBoard {
    async fn reset(&mut self, baud: u32) -> Result<(), BoardError> {
        self.0.reset(baud).await.map(drop).map_err(to_board_error)
    }

    async fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        let result = self.0.write(Uint8Array::from(bytes)).await;
        result.map(drop).map_err(to_board_error)
    }

    async fn read(&mut self, bytes: &mut [u8], timeout: Duration) -> Result<usize, BoardError> {
        let timeout_ms = to_milliseconds(timeout);
        let result = self.0.read(bytes.len() as u32, timeout_ms).await;
        let received = Uint8Array::new(&result.map_err(to_board_error)?);
        let count = received.length() as usize;
        received.copy_to(&mut bytes[..count]);
        Ok(count)
    }

    async fn discard(&mut self, time: Duration) -> Result<(), BoardError> {
        let result = self.0.discard(to_milliseconds(time)).await;
        result.map(drop).map_err(to_board_error)
    }
}

fn to_milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1000.0
}

/// Converts an error that the page's line throws; keeps the message.
fn to_board_error(error: JsValue) -> BoardError {
    BoardError::Other(match error.dyn_into::<Error>() {
        Ok(error) => error.message().into(),
        Err(value) => format!("{value:?}"),
    })
}
