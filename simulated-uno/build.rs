//! Compiles the C shim against Debian's libsimavr and links both.

fn main() {
    let sources = [
        "shim/uno.c",
        "shim/sender.c",
        "shim/usart.c",
        "shim/datasheet.c",
    ];
    for source in sources.iter().chain(&["shim/uno.h"]) {
        println!("cargo:rerun-if-changed={source}");
    }
    let compiled = cc::Build::new()
        .files(sources)
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
    println!("cargo:rustc-link-lib=simavr");
    println!("cargo:rustc-link-lib=elf");
    println!("cargo:rustc-link-lib=m");
}
