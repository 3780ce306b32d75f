//! Little AVR programs, compiled when a test runs.
//!
//! The simulator must be right before it may judge the firmware, and for that
//! it needs programs whose timing follows from the data sheet by counting.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

use lizard_time_limit::LIMIT;
use simulated_uno::Image;

/// Compiles C (or, inside `asm`, assembler) with avr-gcc for the UNO's chip.
///
/// # Panics
/// If avr-gcc is missing or refuses the program, with its words.
#[must_use]
pub fn c(source: &str) -> Image {
    build(source, "c", &["-O2", "-std=gnu11"])
}

/// Assembles a whole program; nothing else is linked, so flash address 0 is its
/// first instruction. `.include "avr/io.h"` does not exist: use `#include`.
///
/// # Panics
/// See [`c`].
#[must_use]
pub fn assembler(source: &str) -> Image {
    let source = format!("#define __SFR_OFFSET 0\n#include <avr/io.h>\n{source}");
    build(&source, "S", &["-nostartfiles", "-nostdlib"])
}

/// [`assembler`] with its first instruction at a byte address in flash.
///
/// # Panics
/// See [`c`].
#[must_use]
pub fn assembler_at(address: u16, source: &str) -> Image {
    let source = format!("#define __SFR_OFFSET 0\n#include <avr/io.h>\n{source}\n");
    let place = format!("-Wl,--section-start=.text={address:#x}");
    build(&source, "S", &["-nostartfiles", "-nostdlib", &place])
}

/// C compiled with avr-gcc, a section for each function, then linked; between the two
/// `change` may replace the object by another one and assembly that goes with it.
///
/// # Panics
/// See [`c`].
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
    run(&flags, &["-c".as_ref(), input.as_ref()], &object);
    let (new, more) = change(std::fs::read(&object).expect("there is an object"));
    std::fs::write(&object, new).expect("the object is written");
    std::fs::write(&assembly, more).expect("the assembly is written");
    run(&flags, &[object.as_ref(), assembly.as_ref()], &output);
    Image::read(output).expect("avr-gcc's ELF loads")
}

fn build(source: &str, extension: &str, flags: &[&str]) -> Image {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let input = folder.path().join(format!("program.{extension}"));
    let output = folder.path().join("program.elf");
    std::fs::write(&input, source).expect("the source is written");
    run(flags, &[input.as_ref()], &output);
    Image::read(output).expect("avr-gcc's ELF loads")
}

fn run(flags: &[&str], inputs: &[&OsStr], output: &Path) {
    let mut gcc = Command::new("avr-gcc");
    gcc.args(["-mmcu=atmega328p", "-DF_CPU=16000000UL", "-Wall"])
        .args(flags)
        .arg("-o")
        .arg(output)
        .args(inputs);
    let result = LIMIT.output(&mut gcc, b"");
    let result = result.expect("avr-gcc runs (Debian package gcc-avr)");
    let errors = String::from_utf8_lossy(&result.stderr);
    assert!(
        result.status.success(),
        "avr-gcc refuses the program:\n{errors}"
    );
}
