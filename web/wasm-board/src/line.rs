//! The page's serial line as a board.

use std::time::Duration;

use js_sys::{Error, Uint8Array};
use lizard_upload::{Board, BoardError};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const LINE: &str = "
/** A serial line to a board. Times are in ms, of the board: a simulated one may be slower than this machine. */
export interface Line {
  /** Resets the board and sets the speed of the line. */
  reset(baud: number): Promise<void>;
  write(bytes: Uint8Array): Promise<void>;
  /** Returns this number of bytes, or those that arrive in the time. */
  read(count: number, time: number): Promise<Uint8Array>;
  /** Waits for the time and drops what has been received until then. */
  discard(time: number): Promise<void>;
}
";

#[wasm_bindgen]
extern "C" {
    /// A serial line to a board, made by the page.
    #[wasm_bindgen(typescript_type = "Line")]
    #[derive(Debug)]
    pub type Line;

    #[wasm_bindgen(method, catch)]
    async fn reset(this: &Line, baud: u32) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(method, catch)]
    async fn write(this: &Line, bytes: Uint8Array) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(method, catch)]
    async fn read(this: &Line, count: u32, time: f64) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(method, catch)]
    async fn discard(this: &Line, time: f64) -> Result<JsValue, JsValue>;
}

/// A board at the page's serial line.
#[derive(Debug)]
pub(crate) struct JsBoard(pub(crate) Line);

impl Board for JsBoard {
    async fn reset(&mut self, baud: u32) -> Result<(), BoardError> {
        self.0.reset(baud).await.map(drop).map_err(board_error)
    }

    async fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        let sent = self.0.write(Uint8Array::from(bytes)).await;
        sent.map(drop).map_err(board_error)
    }

    async fn read(&mut self, bytes: &mut [u8], time: Duration) -> Result<usize, BoardError> {
        let read = self.0.read(bytes.len() as u32, milliseconds(time)).await;
        let read = Uint8Array::new(&read.map_err(board_error)?);
        let count = read.length() as usize;
        read.copy_to(&mut bytes[..count]);
        Ok(count)
    }

    async fn discard(&mut self, time: Duration) -> Result<(), BoardError> {
        let waited = self.0.discard(milliseconds(time)).await;
        waited.map(drop).map_err(board_error)
    }
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1000.0
}

/// The page's own sentence about its line.
fn board_error(error: JsValue) -> BoardError {
    BoardError::Other(match error.dyn_into::<Error>() {
        Ok(error) => error.message().into(),
        Err(other) => format!("{other:?}"),
    })
}
