//! Small AVR programs that tests compile: those of `simulated_uno`, and one that is changed
//! between compiler and linker.

use simulated_uno::Image;
pub use simulated_uno::avr_gcc::{assembler, c};

/// Compiles C with avr-gcc, with a section for each function, and links it. Before linking,
/// `change` may replace the object, and add assembly that is linked before it.
///
/// # Panics
/// If avr-gcc is missing or refuses the program; the message is avr-gcc's.
pub fn compile_c_with_edited_object(
    source: &str,
    change: impl Fn(Vec<u8>) -> (Vec<u8>, &'static str),
) -> Image {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [input, object, assembly, output] =
        ["program.c", "program.o", "more.S", "program.elf"].map(|name| folder.path().join(name));
    std::fs::write(&input, source).expect("the source is written");
    let flags = ["-O2", "-std=gnu11", "-mrelax", "-ffunction-sections"];
    let gcc = simulated_uno::avr_gcc::run;
    gcc(&flags, &["-c".as_ref(), input.as_ref()], &object);
    let (new, more) = change(std::fs::read(&object).expect("there is an object"));
    std::fs::write(&object, new).expect("the object is written");
    std::fs::write(&assembly, more).expect("the assembly is written");
    gcc(&flags, &[assembly.as_ref(), object.as_ref()], &output);
    Image::read(output).expect("avr-gcc's ELF loads")
}
