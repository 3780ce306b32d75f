//! Compiles the C shim against Debian's libsimavr and links both.

use std::path::PathBuf;

fn main() {
    let parts = [
        "adc",
        "boot",
        "call_timer",
        "chip",
        "chip_access",
        "eeprom",
        "disturbance",
        "handlers",
        "hook",
        "instruction",
        "interrupts",
        "list",
        "pin_toggle",
        "recorder",
        "reset",
        "restart",
        "sender",
        "serial_bytes",
        "stock_uart",
        "supply",
        "timer1",
        "uno",
        "usart",
        "watchdog",
    ];
    println!("cargo:rerun-if-changed=shim");
    let compiled = cc::Build::new()
        .files(parts.map(|part| format!("shim/{part}.c")))
        .opt_level(2)
        .std("gnu11")
        .warnings(true)
        .extra_warnings(true)
        .try_compile("simulated_uno_shim");
    if let Err(error) = compiled {
        panic!(
            "the shim does not compile; it needs libsimavr's headers:\n\
             sudo apt-get install libsimavr-dev libelf-dev\n{error}"
        );
    }
    // A program for which the C library is linked statically takes no shared library at all;
    // without the word `static` the linker may take libelf.so, which nothing loads then.
    let features = std::env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default();
    if features.split(',').any(|feature| feature == "crt-static") {
        for library in ["simavr", "elf", "z"] {
            if let Some(folder) = folder_of(&format!("lib{library}.a")) {
                println!("cargo:rustc-link-search=native={}", folder.display());
            }
            println!("cargo:rustc-link-lib=static:-bundle={library}");
        }
        return;
    }
    println!("cargo:rustc-link-lib=simavr");
    println!("cargo:rustc-link-lib=elf");
    println!("cargo:rustc-link-lib=m");
}

/// Where the C compiler finds a library, which rustc looks for only in folders it is told.
fn folder_of(library: &str) -> Option<PathBuf> {
    let compiler = cc::Build::new().try_get_compiler().ok()?;
    let argument = format!("-print-file-name={library}");
    let said = compiler.to_command().arg(argument).output().ok()?;
    let path = PathBuf::from(String::from_utf8(said.stdout).ok()?.trim());
    // A compiler that does not find it says the bare name again.
    Some(path.parent()?.to_owned()).filter(|folder| folder.is_absolute())
}
