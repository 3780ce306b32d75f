//! Compiler and linker for small AVR programs in tests. Compiling and linking are separate functions, so that a test
//! can change the object between the two steps.

use std::fs;

use simulated_uno::Image;
use simulated_uno::avr_gcc::run;
pub use simulated_uno::avr_gcc::{assemble, compile_c};

const FLAGS: [&str; 4] = ["-O2", "-std=gnu11", "-mrelax", "-ffunction-sections"];

/// Compiles C with avr-gcc to an object that has a section for each function.
///
/// # Errors
/// Returns avr-gcc's message if avr-gcc rejects the program.
pub fn compile_to_object(source: &str) -> Result<Vec<u8>, String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [input, object] = ["program.c", "program.o"].map(|name| folder.path().join(name));
    fs::write(&input, source).expect("the source is written");
    run(&FLAGS, &["-c".as_ref(), input.as_ref()], &object)?;
    Ok(fs::read(&object).expect("avr-gcc writes an object"))
}

/// Links assembly and an object, in this order, with avr-gcc.
///
/// # Errors
/// Returns avr-gcc's message if the program does not link.
pub fn link(assembly: &str, object: &[u8]) -> Result<Image, String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [source, input, output] =
        ["more.S", "program.o", "program.elf"].map(|name| folder.path().join(name));
    fs::write(&source, assembly).expect("the assembly is written");
    fs::write(&input, object).expect("the object is written");
    run(&FLAGS, &[source.as_ref(), input.as_ref()], &output)?;
    Ok(Image::read(output).expect("avr-gcc's ELF loads"))
}
