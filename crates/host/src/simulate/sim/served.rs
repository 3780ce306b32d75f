//! Serves the simulated UNO to other programs, at a serial port of this machine.

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
use crate::shared::files::{self, note_input};

/// A new board that has only this boot loader in flash.
///
/// # Errors
/// Fails if the file is missing or is not an AVR program.
pub(super) fn new_board(boot_loader: &Path, fidelity: Fidelity) -> Result<Uno, Failure> {
    let image = Image::read(note_input(boot_loader))
        .map_err(|error| Failure::Input(format!("{}: {error}", boot_loader.display())))?;
    Ok(Uno::with_boot_loader(image, fidelity))
}

/// Serves the UNO, by cable or by radio, until a signal ends the program, and closes and opens its contacts at their
/// times. `link` becomes a symbolic link to the port, because the port's own name differs from run to run; the link is
/// removed at the end.
///
/// # Errors
/// Fails if this machine provides no pseudo terminal, or if something other than a link to one already exists at
/// `link`.
pub(super) fn serve_until_interrupted(
    mut uno: Uno,
    link: Option<&Path>,
    radio: Option<Radio>,
    contacts: &[ContactChange],
) -> Result<(), Failure> {
    let mut port = Port::new().map_err(|error| {
        Failure::Impossible(format!("this machine gives no pseudo terminal: {error}"))
    })?;
    let reset_note = match radio {
        Some(radio) => {
            port = port.with_radio(radio);
            "opening the port resets nothing"
        }
        None => "opening the port resets it",
    };
    let port_name = match link {
        Some(link) => {
            // Called before the link is made, so that a signal between the two calls does not leave the link behind.
            remove_link_on_signal(link.to_owned(), port.path().to_owned())?;
            make_link(link, port.path())?;
            link.to_owned()
        }
        None => port.path().to_owned(),
    };
    let mut out = io::stdout();
    writeln!(out, "the simulated UNO is at {}", port_name.display())?;
    writeln!(out, "{reset_note}; Ctrl-C ends it")?;
    let mut printed_state = State::Alive;
    let mut contacts = contacts.iter().peekable();
    loop {
        while let Some(change) = contacts.next_if(|change| change.ms as f64 <= uno.ms()) {
            change.apply(&mut uno);
        }
        let wait_ms = contacts
            .peek()
            .map_or(f64::MAX, |change| change.ms as f64 - uno.ms());
        port.serve(
            &mut uno,
            Duration::from_secs_f64(wait_ms.clamp(1.0, 1_000.0) / 1_000.0),
        )
        .map_err(|error| Failure::Impossible(format!("the pseudo terminal: {error}")))?;
        uno.take_edges();
        uno.take_marks();
        if *uno.state() != printed_state {
            printed_state = uno.state().clone();
            writeln!(
                out,
                "{}",
                state_message(&printed_state, uno.flash(), &port_name)
            )?;
        }
    }
}

/// The message about a new state of the chip. A new board has nothing in flash at the firmware's address, so the chip
/// stops as soon as the boot loader jumps there.
fn state_message(state: &State, flash: &[u8], port: &Path) -> String {
    match state {
        State::Crashed { .. } if flash.starts_with(&[0xff, 0xff]) => format!(
            "there is no firmware in this board yet; `lizard flash {}` writes it",
            port.display()
        ),
        _ => super::end_message(state),
    }
}

/// Starts a thread that removes the link when a signal, such as that of Ctrl-C, ends the program, unless the link
/// points to another file by then. The signal then has its default effect.
fn remove_link_on_signal(link: PathBuf, port: PathBuf) -> Result<(), Failure> {
    let mut signals = Signals::new([SIGINT, SIGTERM, SIGHUP])
        .map_err(|error| Failure::Impossible(format!("Ctrl-C cannot be waited for: {error}")))?;
    thread::spawn(move || {
        for signal in &mut signals {
            if fs::read_link(&link).is_ok_and(|target| target == port) {
                // If the removal fails, the next run replaces the broken link that remains.
                let _ = fs::remove_file(&link);
            }
            let _ = signal_hook::low_level::emulate_default_handler(signal);
        }
    });
    Ok(())
}

/// Makes `link` a symbolic link to `port`. Replaces a link to another pseudo terminal, which a killed run left behind.
fn make_link(link: &Path, port: &Path) -> Result<(), Failure> {
    let failure_of = |error: io::Error| files::write_failure(link, &error);
    let occupied_failure = || {
        let name = link.display();
        Failure::Input(format!(
            "{name} already exists and is not a link to a pseudo terminal"
        ))
    };
    if fs::read_link(link).is_ok_and(|target| target.starts_with("/dev/pts")) {
        fs::remove_file(link).map_err(failure_of)?;
    }
    if let Some(folder) = link.parent() {
        fs::create_dir_all(folder).map_err(failure_of)?;
    }
    symlink(port, link).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => occupied_failure(),
        _ => failure_of(error),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_without_firmware_is_reported_as_such_and_a_crash_in_plain_words() {
        let crashed_state = State::Crashed {
            pc: 0x7fe4,
            message: "avr_sadly_crashed".to_owned(),
        };
        let port = Path::new("out/uno");
        assert_eq!(
            state_message(&crashed_state, &[0xff; 8], port),
            "there is no firmware in this board yet; `lizard flash out/uno` writes it"
        );
        assert_eq!(
            state_message(&crashed_state, &[0x0c, 0x94, 0xff], port),
            "the firmware crashed at 0x7fe4: no such instruction or address"
        );
    }
}
