//! Compiler and linker for small AVR programs in tests. Compiling and linking are separate functions, so that a test
//! can change the object between the two steps.

use std::fs;

use lizard_linker::Savings;
use simulated_uno::avr_gcc::run;
pub use simulated_uno::avr_gcc::{assemble, compile_c};
use simulated_uno::{Fidelity, Image, Uno};

/// The options of avr-gcc for both compiling and linking.
const FLAGS: [&str; 4] = ["-O2", "-std=gnu11", "-mrelax", "-ffunction-sections"];

/// Compiles C with avr-gcc to an object with a section for each function.
///
/// # Errors
/// Returns avr-gcc's message if avr-gcc rejects the program.
pub fn compile_to_object(source: &str) -> Result<Vec<u8>, String> {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let [source_path, object_path] =
        ["program.c", "program.o"].map(|name| folder.path().join(name));
    fs::write(&source_path, source).expect("the source can be written");
    run(&FLAGS, &["-c".as_ref(), source_path.as_ref()], &object_path)?;
    Ok(fs::read(&object_path).expect("avr-gcc has written an object"))
}

/// Assembles a text with avr-gcc and links the result with an object. The assembled code comes first.
///
/// # Errors
/// Returns avr-gcc's message if the program does not link.
pub fn link(assembly: &str, object: &[u8]) -> Result<Image, String> {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let [source_path, object_path, elf_path] =
        ["assembly.S", "program.o", "program.elf"].map(|name| folder.path().join(name));
    fs::write(&source_path, assembly).expect("the assembly can be written");
    fs::write(&object_path, object).expect("the object can be written");
    let inputs = [source_path.as_ref(), object_path.as_ref()];
    run(&FLAGS, &inputs, &elf_path)?;
    Ok(Image::read(elf_path).expect("avr-gcc's ELF loads"))
}

/// Shrinks an object in the same way as the firmware's linker, `scripts/link`.
///
/// # Panics
/// If the bytes are not a valid object for an AVR.
pub fn shrink(object: &[u8]) -> (Vec<u8>, Savings) {
    let shrunk = lizard_linker::shrink(object).expect("the object is valid");
    shrunk.expect("the object is for an AVR")
}

/// Returns a variable's address in RAM.
///
/// # Panics
/// If the image has no such variable.
pub fn ram_address(image: &Image, name: &str) -> u16 {
    (image.symbol(name).expect("the variable exists").address - 0x80_0000) as u16
}

/// Runs a program on a UNO until its variable `done` is 1. If the program's timer has interrupted it too rarely, `done`
/// never becomes 1.
///
/// # Panics
/// If the variable is not 1 after `max_ms` milliseconds.
pub fn run_to_end(image: &Image, max_ms: u64) -> Uno {
    let done_address = ram_address(image, "done");
    let mut uno = Uno::with_image(image.clone(), Fidelity::DataSheet);
    let is_done = (0..max_ms).any(|_| {
        uno.run_ms(1);
        uno.peek(done_address) == 1
    });
    assert!(
        is_done,
        "the program did not finish, or the timer interrupted it too rarely"
    );
    uno
}
