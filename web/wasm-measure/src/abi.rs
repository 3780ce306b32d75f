//! The interface to JavaScript: a plain C interface, as that of the page's first module.
//!
//! The page allocates an input (`measure_input`), writes a picture or a question in JSON there, calls a function, and reads
//! the answer at `measure_output`, `measure_output_length` bytes: JSON, or a PDF.
#![allow(unsafe_code)] // `no_mangle` needs it; nothing here is unsafe to call.

use std::cell::RefCell;

use lizard_film::Picture;
use lizard_measure::Paper;
use serde::{Deserialize, Serialize};

use crate::camera::{Asked, Camera, Refused};

/// A question of the page, with its arguments.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Question {
    /// Begins a new film.
    Clear,
    /// [`Camera::measure`].
    Measure(Asked),
}

/// The state of the interface between two calls of the page.
#[derive(Default)]
struct Interface {
    camera: Camera,
    input: Vec<u8>,
    output: Vec<u8>,
}

thread_local! {
    static INTERFACE: RefCell<Interface> = RefCell::default();
}

/// An answer or a refusal as JSON, whose keys tell them apart.
fn json<T: Serialize>(result: Result<T, Refused>) -> Vec<u8> {
    let bytes = match &result {
        Ok(answer) => serde_json::to_vec(answer),
        Err(refused) => serde_json::to_vec(refused),
    };
    bytes.unwrap_or_else(|_| b"null".to_vec())
}

/// Allocates an input of so many bytes and returns its address. Its bytes are those of the input before where
/// that was as long, as of a picture.
#[unsafe(no_mangle)]
pub extern "C" fn measure_input(length: usize) -> *mut u8 {
    INTERFACE.with_borrow_mut(|interface| {
        interface.input.resize(length, 0);
        interface.input.as_mut_ptr()
    })
}

/// The address of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn measure_output() -> *const u8 {
    INTERFACE.with_borrow(|interface| interface.output.as_ptr())
}

/// The length of the last answer, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn measure_output_length() -> usize {
    INTERFACE.with_borrow(|interface| interface.output.len())
}

/// Answers with the tags of the picture in the input, by [`Camera::add`] if it is to be kept, or else by
/// [`Camera::look`]. A grey picture has a byte for each pixel, a colourful one four.
#[unsafe(no_mangle)]
pub extern "C" fn measure_picture(
    width: usize,
    height: usize,
    is_grey: bool,
    seconds: f64,
    is_kept: bool,
) {
    INTERFACE.with_borrow_mut(|interface| {
        let picture = match is_grey {
            true => Picture::new(width, height, interface.input.clone()),
            false => Picture::of_colours(width, height, &interface.input),
        };
        let picture = picture.ok_or_else(|| Refused::of("the picture is not whole"));
        interface.output = json(picture.and_then(|picture| match is_kept {
            true => interface.camera.add(&picture, seconds),
            false => Ok(interface.camera.look(&picture)),
        }));
    });
}

/// Answers the question in the input; `null` if it is unknown.
#[unsafe(no_mangle)]
pub extern "C" fn measure_ask() {
    INTERFACE.with_borrow_mut(|interface| {
        interface.output = match serde_json::from_slice(&interface.input) {
            Ok(Question::Measure(asked)) => json(interface.camera.measure(&asked)),
            Ok(Question::Clear) => {
                interface.camera = Camera::default();
                json(Ok(()))
            }
            Err(_) => b"null".to_vec(),
        };
    });
}

/// Answers with the sheet of tags as PDF, for A4 or for paper of 11 x 8.5 inches.
#[unsafe(no_mangle)]
pub extern "C" fn measure_sheet(is_letter: bool) {
    let paper = if is_letter { Paper::Letter } else { Paper::A4 };
    INTERFACE.with_borrow_mut(|interface| interface.output = paper.sheet());
}
