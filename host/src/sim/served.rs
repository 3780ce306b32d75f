//! The simulated UNO at a serial port of this machine, for other programs.

use std::fs;
use std::io::{self, Write};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::time::Duration;

use simulated_uno::{Fidelity, Image, Port, State, Uno};

use crate::Failure;

/// A board as sold, with this boot loader in flash and nothing else.
///
/// # Errors
/// The file is missing or no AVR program.
pub(super) fn as_sold(boot_loader: &Path, fidelity: Fidelity) -> Result<Uno, Failure> {
    let image = Image::read(boot_loader)
        .map_err(|error| Failure::Input(format!("{}: {error}", boot_loader.display())))?;
    Ok(Uno::with_boot_loader(image, fidelity))
}

/// Serves the UNO until the program is ended. `link` becomes a symbolic link to
/// the port, whose own name differs from run to run.
///
/// # Errors
/// No pseudo terminal, or `link` is something else already.
pub(super) fn until_interrupted(mut uno: Uno, link: Option<&Path>) -> Result<(), Failure> {
    let mut port = Port::new().map_err(|error| {
        Failure::Impossible(format!("this machine gives no pseudo terminal: {error}"))
    })?;
    let name = match link {
        Some(link) => {
            point(link, port.path())?;
            link
        }
        None => port.path(),
    };
    let mut out = io::stdout();
    writeln!(out, "the simulated UNO is at {}", name.display())?;
    writeln!(out, "opening the port resets it; Ctrl-C ends it")?;
    let mut told = State::Alive;
    loop {
        port.serve(&mut uno, Duration::from_secs(1))?;
        uno.take_edges();
        uno.take_marks();
        if *uno.state() != told {
            told = uno.state().clone();
            writeln!(out, "{}", super::ended(&told))?;
        }
    }
}

/// Makes `link` point at `port`, also if it points elsewhere.
fn point(link: &Path, port: &Path) -> Result<(), Failure> {
    let name = link.display();
    if fs::symlink_metadata(link).is_ok_and(|there| there.is_symlink()) {
        fs::remove_file(link)?;
    }
    if let Some(folder) = link.parent() {
        fs::create_dir_all(folder)?;
    }
    symlink(port, link).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => {
            Failure::Input(format!("{name} is there already and no link"))
        }
        _ => Failure::Impossible(format!("cannot make the link {name}: {error}")),
    })
}
