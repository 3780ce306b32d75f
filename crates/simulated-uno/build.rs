//! Build script: compiles the C shim against Debian's libsimavr and links both.

use std::path::PathBuf;
use std::process::Command;

/// The version of libsimavr that the shim corrects. With another version, the tests in tests/data_sheet fail or hang.
const TESTED_VERSION: &str = "1.6";

fn main() {
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "windows") {
        panic!(
            "libsimavr does not exist for Windows: build without the package simulated-uno (for `lizard`: \
             --no-default-features --features paper,console,parts)"
        );
    }
    check_version();
    println!("cargo:rerun-if-changed=shim");
    let files = std::fs::read_dir("shim").expect("the folder shim/ is readable");
    let files = files.map(|file| file.expect("the folder shim/ is readable").path());
    let mut sources: Vec<PathBuf> = files
        .filter(|file| file.extension().is_some_and(|extension| extension == "c"))
        .collect();
    sources.sort();
    let result = cc::Build::new()
        .files(sources)
        .opt_level(2)
        .std("gnu11")
        .warnings(true)
        .extra_warnings(true)
        // simavr prescribes parameters that most of the shim's callbacks do not use.
        .flag("-Wno-unused-parameter")
        .try_compile("simulated_uno_shim");
    if let Err(error) = result {
        panic!(
            "the shim does not compile; it requires libsimavr's headers:\n\
             sudo apt-get install libsimavr-dev libelf-dev\n{error}"
        );
    }
    // A program that links the C library statically cannot load shared libraries, and without `static:` the linker may
    // choose libelf.so.
    let features = std::env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default();
    if features.split(',').any(|feature| feature == "crt-static") {
        for library in ["simavr", "elf", "z"] {
            if let Some(folder) = find_library_folder(&format!("lib{library}.a")) {
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

/// Returns the folder in which the C compiler finds a library; `None` if it cannot find the library. rustc itself
/// searches only the folders that are passed to it.
fn find_library_folder(library: &str) -> Option<PathBuf> {
    let compiler = cc::Build::new().try_get_compiler().ok()?;
    let argument = format!("-print-file-name={library}");
    let output = compiler.to_command().arg(argument).output().ok()?;
    let path = PathBuf::from(String::from_utf8(output.stdout).ok()?.trim());
    // A compiler that does not find the library prints the bare name.
    Some(path.parent()?.to_owned()).filter(|folder| folder.is_absolute())
}

/// Fails the build if pkg-config reports a version of libsimavr other than [`TESTED_VERSION`], or no version.
fn check_version() {
    let mut pkg_config = Command::new("pkg-config");
    let output = pkg_config.args(["--modversion", "simavr"]).output();
    let version = output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    match version.as_deref() {
        Ok(TESTED_VERSION) => {}
        Ok(installed_version) if !installed_version.is_empty() => panic!(
            "this package requires libsimavr {TESTED_VERSION}, but {installed_version} is installed: install \
             {TESTED_VERSION} from Debian 12 or from source"
        ),
        _ => panic!(
            "pkg-config does not find libsimavr {TESTED_VERSION}:\n\
             sudo apt-get install pkg-config libsimavr-dev libelf-dev"
        ),
    }
}
