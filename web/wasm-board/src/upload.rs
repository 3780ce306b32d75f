//! The upload of firmware and robot from a browser to a board, which writes the pages of flash in the same order as
//! `lizard flash` and has the same messages.

use js_sys::Function;
use lizard_core::numbers::mark::Mark;
use lizard_upload::{Event, Image, Loader, LoaderKind, Model, Step, Target};
use wasm_bindgen::prelude::*;

use crate::line::{JsBoard, SerialLine};

/// Parses an image in Intel HEX; returns the bytes from address 0 on.
///
/// # Errors
/// Fails if the text is not the image of a program for a UNO.
#[wasm_bindgen(js_name = parseImage)]
pub fn parse_image(hex: &str) -> Result<Vec<u8>, JsError> {
    Ok(Image::from_hex(hex)?.bytes().to_vec())
}

/// Returns true if an image contains this firmware, in any version.
#[wasm_bindgen(js_name = isLizard)]
pub fn is_lizard(image: &[u8]) -> bool {
    Mark::read(image).is_some()
}

/// Returns true if an image from address 0 up to `end_address` reaches into a Nano's boot section.
#[wasm_bindgen(js_name = needsUno)]
pub fn needs_uno(end_address: usize) -> bool {
    end_address > lizard_upload::NANO_BOOT_ADDRESS
}

/// The kind of board that the user names; `Unknown` if the page did not ask.
#[wasm_bindgen]
#[derive(Debug, Clone, Copy)]
pub enum Board {
    /// A UNO or a Nano.
    Unknown,
    /// An Arduino UNO.
    Uno,
    /// An Arduino Nano.
    Nano,
}

/// Writes an image from address 0 on, or only a robot's section, to a board, verifies it and starts the program.
/// `report` gets the progress: `reading`, `writing` or `verifying`, the number of finished pages and their total
/// number; or `retrying` if the board is reset for another attempt.
///
/// # Errors
/// Rejects with a message for the user that states the flash's current content.
#[wasm_bindgen]
pub async fn upload(
    line: SerialLine,
    bytes: Vec<u8>,
    #[wasm_bindgen(js_name = isRobotAlone)] is_robot_alone: bool,
    board: Board,
    #[wasm_bindgen(
        unchecked_param_type = "(step: 'reading' | 'writing' | 'verifying' | 'retrying', done: number, total: number) => void"
    )]
    report: Function,
) -> Result<(), JsError> {
    let image = match is_robot_alone {
        true => Image::robot_alone(bytes),
        false => Image::new(bytes),
    }?;
    let target = Target {
        model: match board {
            Board::Unknown => None,
            Board::Uno => Some(Model::Uno),
            Board::Nano => Some(Model::Nano),
        },
        may_be_nano: false,
    };
    let report = |step: &str, done: usize, total: usize| {
        // An error in the page must not interrupt an upload.
        let _ = report.call3(&JsValue::NULL, &step.into(), &done.into(), &total.into());
    };
    let mut loader = Loader::new(JsBoard(line));
    lizard_upload::upload(&mut loader, &image, target, &mut |event| match event {
        Event::Found(_) => {}
        Event::Retry { .. } => report("retrying", 0, 1),
        Event::Progress(Step::Reading, done, total) => report("reading", done, total),
        Event::Progress(Step::Writing, done, total) => report("writing", done, total),
        Event::Progress(Step::Verifying, done, total) => report("verifying", done, total),
    })
    .await?;
    Ok(())
}

/// Resets a board, identifies its model by its boot loader, and starts its program; returns `UNO` or `Nano`.
///
/// # Errors
/// Rejects with a message for the user if the board is neither a UNO nor a Nano, or does not answer.
#[wasm_bindgen]
pub async fn identify(line: SerialLine) -> Result<String, JsError> {
    let mut loader = Loader::new(JsBoard(line));
    Ok(match lizard_upload::identify(&mut loader).await? {
        LoaderKind::Optiboot => "UNO",
        LoaderKind::AtmegaBoot => "Nano",
    }
    .to_owned())
}
