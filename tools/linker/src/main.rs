//! `lizard-linker ARGUMENTS` shrinks the object files among the arguments, then calls avr-gcc with the new files in
//! their place. rustc calls this program through scripts/link, which .cargo/config.toml names as the linker.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use lizard_linker::{ROUTINES, shrink};

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// Shrinks the objects and calls avr-gcc. Returns true if avr-gcc succeeds.
fn run() -> Result<bool, String> {
    let mut arguments = Vec::new();
    let mut written_files = Vec::new();
    for argument in std::env::args_os().skip(1) {
        if let Some(paths) = write_shrunk_files(Path::new(&argument))? {
            arguments.extend(paths.iter().map(|path| path.clone().into_os_string()));
            written_files.extend(paths);
        } else {
            arguments.push(argument);
        }
    }
    let status = Command::new("avr-gcc").args(arguments).status();
    for path in written_files {
        // A temporary file that cannot be removed does no harm.
        let _ = fs::remove_file(path);
    }
    let result = status.map(|status| status.success());
    result.map_err(|error| {
        format!("avr-gcc, which links the firmware, does not start: {error}; install gcc-avr")
    })
}

/// Writes two files next to the original object: the routines that the shrunk object calls, and the shrunk object.
/// Returns their paths in this order; `None` for an argument that is not an object file.
fn write_shrunk_files(path: &Path) -> Result<Option<[PathBuf; 2]>, String> {
    // If a file cannot be read, avr-gcc reports the error.
    let (true, Ok(file)) = (path.extension() == Some(OsStr::new("o")), fs::read(path)) else {
        return Ok(None);
    };
    let result = shrink(&file).map_err(|error| {
        let name = path.display();
        format!("{name}: cannot edit the object file: {error}")
    });
    let Some((new_object, _)) = result? else {
        return Ok(None);
    };
    let write = |extension, bytes: &[u8]| {
        let path = path.with_extension(extension);
        fs::write(&path, bytes).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok::<PathBuf, String>(path)
    };
    Ok(Some([
        // The routines come first, so that the linker places them between `.lowtext` and the other sections.
        write("frames.S", ROUTINES.as_bytes())?,
        write("short.o", &new_object)?,
    ]))
}
