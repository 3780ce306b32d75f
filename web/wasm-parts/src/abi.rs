//! The interface to JavaScript: a plain C interface, as that of the page's first module.
//!
//! The page allocates an input (`parts_input`), writes a text there, calls a function, and reads
//! the answer at `parts_output`, `parts_output_length` bytes: JSON, or for some functions numbers
//! or files.
#![allow(unsafe_code)] // `no_mangle` and the import need it; nothing here is unsafe to call.

use std::cell::RefCell;

use serde::Serialize;

use crate::model::{Model, Refused};

#[cfg(target_arch = "wasm32")]
mod page {
    #[link(wasm_import_module = "page")]
    unsafe extern "C" {
        /// Reports the number of questions answered and their total.
        pub safe fn progress(done: u32, all: u32);
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod page {
    /// Does nothing: on a host no page listens.
    pub fn progress(_: u32, _: u32) {}
}

/// The state of the interface between two calls of the page.
#[derive(Default)]
struct Interface {
    model: Option<Model>,
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

/// Stores a model's answer as the output; without a model the output is empty.
fn answer(call: impl FnOnce(&Model) -> Vec<u8>) {
    INTERFACE.with_borrow_mut(|interface| {
        interface.output = interface.model.as_ref().map(call).unwrap_or_default();
    });
}

/// Allocates an input of `length` bytes and returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn parts_input(length: usize) -> *mut u8 {
    INTERFACE.with_borrow_mut(|interface| {
        interface.input = vec![0; length];
        interface.input.as_mut_ptr()
    })
}

/// The address of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn parts_output() -> *const u8 {
    INTERFACE.with_borrow(|interface| interface.output.as_ptr())
}

/// The length of the last answer, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn parts_output_length() -> usize {
    INTERFACE.with_borrow(|interface| interface.output.len())
}

/// Reads the input by [`Model::read`] and answers with [`Model::entry`]. It replaces the
/// previous model.
#[unsafe(no_mangle)]
pub extern "C" fn parts_read() {
    INTERFACE.with_borrow_mut(|interface| {
        let input = std::mem::take(&mut interface.input);
        let read = Model::read(&String::from_utf8_lossy(&input));
        interface.output = json(read.as_ref().map(Model::entry).map_err(Clone::clone));
        interface.model = read.ok();
    });
}

/// Answers with the bytes of [`Model::solids`] and returns true, or with a refusal as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn parts_solids() -> bool {
    let mut well = false;
    answer(|model| match model.solids() {
        Ok(bytes) => {
            well = true;
            bytes
        }
        Err(refused) => json::<()>(Err(refused)),
    });
    well
}

/// [`Model::pose`] as little-endian floats of eight bytes; nothing where a loop does not close.
#[allow(clippy::too_many_arguments)] // four angles and four lags, as C takes them
#[unsafe(no_mangle)]
pub extern "C" fn parts_pose(
    a1: f64,
    a2: f64,
    a3: f64,
    a4: f64,
    lf: f64,
    rf: f64,
    rh: f64,
    lh: f64,
) {
    answer(|model| {
        let places = model
            .pose([a1, a2, a3, a4], [lf, rf, rh, lh])
            .unwrap_or_default();
        let numbers = places.as_flattened().iter();
        numbers.flat_map(|number| number.to_le_bytes()).collect()
    });
}

/// [`Model::prove`]; the page's `progress` is called on the way.
#[unsafe(no_mangle)]
pub extern "C" fn parts_prove() {
    answer(|model| json(model.prove(|done, all| page::progress(done as u32, all as u32))));
}

/// Answers with [`Model::files`] and returns true, or with a refusal as JSON. For each file:
/// the length of its path, the path, the length of its content, and the content.
#[unsafe(no_mangle)]
pub extern "C" fn parts_files(number: usize) -> bool {
    let mut well = false;
    answer(|model| match model.files(number) {
        Ok(files) => {
            well = true;
            let mut bytes = Vec::new();
            for file in files {
                for piece in [file.path.as_bytes(), &file.bytes] {
                    bytes.extend((piece.len() as u32).to_le_bytes());
                    bytes.extend(piece);
                }
            }
            bytes
        }
        Err(refused) => json::<()>(Err(refused)),
    });
    well
}
