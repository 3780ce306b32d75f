//! Little AVR programs, compiled when a test runs: those of `simulated_uno`, and one that
//! is changed between compiler and linker.

use simulated_uno::Image;
pub use simulated_uno::avr_gcc::{assembler, c};

/// C compiled with avr-gcc, a section for each function, then linked; between the two
/// `change` may replace the object by another one and assembly that is linked before it.
///
/// # Panics
/// If avr-gcc is missing or refuses the program, with its words.
#[must_use]
pub fn c_by_way_of_an_object(
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
