//! The door to JavaScript: a plain C interface, as that of the page's first module.
//!
//! The page asks for room (`parts_input`), writes a text there, calls, and reads the answer at
//! `parts_output`, `parts_output_length` bytes: JSON, or where it says so numbers or files.
#![allow(unsafe_code)] // `no_mangle` and the import need it; nothing here is unsafe to call.

use std::cell::RefCell;

use serde::Serialize;

use crate::model::{Model, Refused};

#[cfg(target_arch = "wasm32")]
mod page {
    #[link(wasm_import_module = "page")]
    unsafe extern "C" {
        /// What is proved of what there is to prove.
        pub safe fn progress(done: u32, all: u32);
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod page {
    /// On a host nobody looks on.
    pub fn progress(_: u32, _: u32) {}
}

#[derive(Default)]
struct Door {
    model: Option<Model>,
    input: Vec<u8>,
    output: Vec<u8>,
}

thread_local! {
    static DOOR: RefCell<Door> = RefCell::default();
}

/// Either of two answers, without a word for which it is.
#[derive(Serialize)]
#[serde(untagged)]
enum Either<A, B> {
    Well(A),
    Refused(B),
}

fn json<T: Serialize>(result: Result<T, Refused>) -> Vec<u8> {
    let either = match result {
        Ok(well) => Either::Well(well),
        Err(refused) => Either::Refused(refused),
    };
    serde_json::to_vec(&either).unwrap_or_else(|_| b"null".to_vec())
}

/// Calls the model and writes down its answer; nothing where there is none.
fn answer(call: impl FnOnce(&Model) -> Vec<u8>) {
    DOOR.with_borrow_mut(|door| {
        door.output = door.model.as_ref().map(call).unwrap_or_default();
    });
}

/// Room for an input of so many bytes.
#[unsafe(no_mangle)]
pub extern "C" fn parts_input(length: usize) -> *mut u8 {
    DOOR.with_borrow_mut(|door| {
        door.input = vec![0; length];
        door.input.as_mut_ptr()
    })
}

/// Where the last answer is.
#[unsafe(no_mangle)]
pub extern "C" fn parts_output() -> *const u8 {
    DOOR.with_borrow(|door| door.output.as_ptr())
}

/// How many bytes it has.
#[unsafe(no_mangle)]
pub extern "C" fn parts_output_length() -> usize {
    DOOR.with_borrow(|door| door.output.len())
}

/// [`Model::read`] of the input, and [`Model::entry`]; the model of before is let go.
#[unsafe(no_mangle)]
pub extern "C" fn parts_read() {
    DOOR.with_borrow_mut(|door| {
        let input = std::mem::take(&mut door.input);
        let read = Model::read(&String::from_utf8_lossy(&input));
        door.output = json(read.as_ref().map(Model::entry).map_err(Clone::clone));
        door.model = read.ok();
    });
}

/// [`Model::solids`]: its bytes, or the JSON of a refusal; whether it went well.
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

/// [`Model::files`]: for each the length of its path, the path, the length of what it holds, and that.
/// Whether it went well; else the JSON of a refusal.
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
