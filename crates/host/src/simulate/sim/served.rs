//! Serves the simulated UNO to other programs at a pseudo terminal, which they open as a serial port.

use std::fs;
use std::io::{self, Write};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use simulated_uno::{Fidelity, Image, Port, Radio, State, Uno};

use super::press::ContactChange;
use crate::Failure;
use crate::shared::files::{self, record_input};
use crate::shared::firmware::describe_load_error;

/// Creates a new board with only a boot loader in flash.
///
/// # Errors
/// Fails if the file is missing or is not an AVR program.
pub(super) fn new_board(boot_loader: &Path, fidelity: Fidelity) -> Result<Uno, Failure> {
    let image = Image::read(record_input(boot_loader))
        .map_err(|error| Failure::Input(describe_load_error(boot_loader, &error)))?;
    Ok(Uno::with_boot_loader(image, fidelity))
}

/// Serves the UNO by cable or radio until a signal ends the program, and changes its contacts as scheduled.
/// `link` becomes a symbolic link to the port, because the port's name differs from run to run; the link is removed at
/// the end.
///
/// # Errors
/// Fails if no pseudo terminal can be opened, or if anything except a link to a pseudo terminal already exists at
/// `link`.
pub(super) fn serve_until_interrupted(
    mut uno: Uno,
    link: Option<&Path>,
    radio: Option<Radio>,
    contact_changes: &[ContactChange],
) -> Result<(), Failure> {
    let mut port = Port::new()
        .map_err(|error| Failure::Operation(format!("cannot open a pseudo terminal: {error}")))?;
    let reset_note = match radio {
        Some(radio) => {
            port = port.with_radio(radio);
            "opening the port does not reset the UNO"
        }
        None => "opening the port resets the UNO",
    };
    let port_name = match link {
        Some(link) => {
            // The thread starts before the link is created, so that a signal in between does not leave the link behind.
            remove_link_on_signal(link.to_owned(), port.path().to_owned())?;
            create_link(link, port.path())?;
            link.to_owned()
        }
        None => port.path().to_owned(),
    };
    // The simulation continues even if standard output is closed.
    let print_line = |line: &str| _ = writeln!(io::stdout(), "{line}");
    print_line(&format!("the simulated UNO is at {}", port_name.display()));
    print_line(&format!("{reset_note}; Ctrl-C ends this program"));
    let mut printed_state = State::Alive;
    let mut changes = contact_changes.iter().peekable();
    loop {
        while let Some(change) = changes.next_if(|change| change.time_ms as f64 <= uno.ms()) {
            change.apply(&mut uno);
        }
        let wait_ms = changes
            .peek()
            .map_or(f64::MAX, |change| change.time_ms as f64 - uno.ms());
        let wait = Duration::from_secs_f64(wait_ms.clamp(1.0, 1_000.0) / 1_000.0);
        port.serve(&mut uno, wait)
            .map_err(|error| Failure::Operation(format!("cannot serve the port: {error}")))?;
        // Nobody reads these records, which would otherwise grow.
        uno.take_edges();
        uno.take_marks();
        if *uno.state() != printed_state {
            printed_state = uno.state().clone();
            print_line(&describe_state(&printed_state, uno.flash(), &port_name));
        }
    }
}

/// Describes a new state of the chip. A new board has nothing in flash at the firmware's address, so the chip stops
/// when the boot loader jumps there.
fn describe_state(state: &State, flash: &[u8], port_name: &Path) -> String {
    match state {
        State::Crashed { .. } if flash.starts_with(&[0xff, 0xff]) => format!(
            "this board has no firmware yet; `lizard flash {}` writes it",
            port_name.display()
        ),
        _ => super::describe_firmware_state(state),
    }
}

/// Starts a thread that removes the link when a signal such as Ctrl-C ends the program, unless the link points to
/// another file by then. Afterwards the signal has its default effect.
fn remove_link_on_signal(link: PathBuf, port: PathBuf) -> Result<(), Failure> {
    let mut signals = Signals::new([SIGINT, SIGTERM, SIGHUP]).map_err(|error| {
        Failure::Operation(format!("cannot install the handler for Ctrl-C: {error}"))
    })?;
    thread::spawn(move || {
        for signal in &mut signals {
            if fs::read_link(&link).is_ok_and(|target| target == port) {
                // If the removal fails, the next run replaces the broken link.
                let _ = fs::remove_file(&link);
            }
            let _ = signal_hook::low_level::emulate_default_handler(signal);
        }
    });
    Ok(())
}

/// Creates the symbolic link `link` to `port`. Replaces a link to another pseudo terminal, left by a killed run.
fn create_link(link: &Path, port: &Path) -> Result<(), Failure> {
    let to_failure = |error: io::Error| files::write_failure(link, &error);
    if fs::read_link(link).is_ok_and(|target| target.starts_with("/dev/pts")) {
        fs::remove_file(link).map_err(to_failure)?;
    }
    if let Some(folder) = link.parent() {
        fs::create_dir_all(folder).map_err(to_failure)?;
    }
    symlink(port, link).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => Failure::Input(format!(
            "{} already exists and is not a link to a pseudo terminal; choose another name",
            link.display()
        )),
        _ => to_failure(error),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_without_firmware_and_after_a_crash_are_described() {
        let crashed_state = State::Crashed {
            pc: 0x7fe4,
            message: "avr_sadly_crashed".to_owned(),
        };
        let port = Path::new("out/uno");
        assert_eq!(
            describe_state(&crashed_state, &[0xff; 8], port),
            "this board has no firmware yet; `lizard flash out/uno` writes it"
        );
        assert_eq!(
            describe_state(&crashed_state, &[0x0c, 0x94, 0xff], port),
            "the firmware crashed at 0x7fe4: no such instruction or address"
        );
    }
}
