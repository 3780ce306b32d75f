//! Generator of the JavaScript and the TypeScript types for a WebAssembly module of the page:
//! `bindgen MODULE FOLDER NAME`.
//!
//! The command `wasm-bindgen` does the same, but must have the version of the crate in the module. Here one lock file
//! sets both versions.

use std::env::args;
use std::error::Error;

use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<(), Box<dyn Error>> {
    let [_, module, folder, name] = &args().collect::<Vec<_>>()[..] else {
        return Err("usage: bindgen MODULE FOLDER NAME".into());
    };
    let mut bindgen = Bindgen::new();
    bindgen.input_path(module).out_name(name).web(true)?;
    // The page loads the module itself and passes it to each worker, so the JavaScript needs no path.
    bindgen.typescript(true).omit_default_module_path(true);
    bindgen.remove_name_section(true);
    bindgen.remove_producers_section(true);
    Ok(bindgen.generate(folder)?)
}
