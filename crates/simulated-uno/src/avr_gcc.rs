//! Compiles small AVR programs that a test contains as text.
//!
//! A test of a driver, or of the simulator itself, needs a program of about ten lines whose cycles can be counted by
//! hand with the data sheet. Such a program is easiest to read next to the expected result. This module requires
//! Debian's `gcc-avr` and `avr-libc`.
//!
//! If avr-gcc rejects the program, all functions except [`run`] panic with avr-gcc's own message, because a test
//! cannot handle the error.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::Image;

/// Compiles C (or, inside `asm`, assembly) with avr-gcc for the UNO's chip.
///
/// # Panics
/// If avr-gcc is missing or rejects the program.
#[must_use]
pub fn compile_c(source: &str) -> Image {
    build(source, "c", &["-O2", "-std=gnu11"])
}

/// Assembles a complete program. Nothing else is linked, so the first instruction is at flash address 0. The source
/// passes through the C preprocessor, so it includes headers with `#include`, not with `.include`. `$` separates
/// instructions on a line.
///
/// # Panics
/// See [`compile_c`].
#[must_use]
pub fn assemble(source: &str) -> Image {
    assemble_at(0, source)
}

/// Assembles a program as [`assemble`] does, with its first instruction at a byte address in flash.
///
/// # Panics
/// See [`compile_c`].
#[must_use]
pub fn assemble_at(address: u16, source: &str) -> Image {
    let source = format!("#define __SFR_OFFSET 0\n#include <avr/io.h>\n{source}\n");
    let section_start = format!("-Wl,--section-start=.text={address:#x}");
    let flags = ["-nostartfiles", "-nostdlib", section_start.as_str()];
    build(&source, "S", &flags)
}

/// Runs avr-gcc for the UNO's chip at 16 MHz with these flags and input files, and writes the result to `output`.
///
/// # Errors
/// Returns avr-gcc's message if it rejects the program.
///
/// # Panics
/// If avr-gcc is missing.
pub fn run(flags: &[&str], inputs: &[&OsStr], output: &Path) -> Result<(), String> {
    let mut gcc = Command::new("avr-gcc");
    gcc.args(["-mmcu=atmega328p", "-DF_CPU=16000000UL", "-Wall"])
        .args(flags)
        .arg("-o")
        .arg(output)
        .args(inputs);
    let result = gcc.stdin(Stdio::null()).output();
    let result = result.expect("avr-gcc runs (Debian package gcc-avr)");
    let message = String::from_utf8_lossy(&result.stderr);
    match result.status.success() {
        true => Ok(()),
        false => Err(format!("avr-gcc rejects the program:\n{message}")),
    }
}

fn build(source: &str, extension: &str, flags: &[&str]) -> Image {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let input = folder.path().join(format!("program.{extension}"));
    let output = folder.path().join("program.elf");
    std::fs::write(&input, source).expect("the source can be written");
    run(flags, &[input.as_ref()], &output).unwrap_or_else(|error| panic!("{error}"));
    Image::read(output).expect("avr-gcc's ELF loads")
}
