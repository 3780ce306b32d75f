//! Connecting to a board: from the command's arguments to the board's first line.

use std::path::PathBuf;

use serialport::SerialPort;

use super::find;
use super::link::{Link, LinkError, Timeouts};
use super::port;
use crate::shared::plain::escape_controls;
use crate::{Failure, RobotFile};

/// The board that a subcommand connects to.
#[derive(clap::Args, Debug)]
pub struct Connect {
    /// The board's serial port [default: the one that has a UNO, or the only one]
    port: Option<String>,
    /// Use a simulated UNO instead, in real time
    #[arg(long, conflicts_with = "port")]
    sim: bool,
    /// With --sim: the firmware: an ELF that has this robot in it [default: the one inside this
    /// program]
    #[arg(long, value_name = "FILE", requires = "sim")]
    elf: Option<PathBuf>,
    /// With --sim: the robot, a file or a name as for `lizard sim` [default: robot.toml in
    /// this folder or one above it, else the one this program was built with]
    #[arg(long, value_name = "FILE", requires = "sim")]
    robot: Option<PathBuf>,
}

/// A finder of the board's port. Unless the user named a port, each `open` searches anew, because
/// a board that is plugged in again may get another port.
#[derive(Debug)]
pub struct BoardFinder {
    port: Option<String>,
    command: &'static str,
    #[cfg(all(feature = "simulator", target_os = "linux"))]
    simulated: Option<simulated_uno::Background>,
}

/// An open port with a board at it.
pub struct Connection {
    /// The serial link to the board.
    pub link: Link<Box<dyn SerialPort>>,
    /// The port's name for messages.
    pub name: String,
}

impl Connect {
    /// Makes the finder that these arguments ask for; starts the simulated UNO for `--sim`.
    ///
    /// # Errors
    /// Fails if the simulated UNO has no robot, firmware or pseudo terminal, or is not built in.
    pub fn finder(self, command: &'static str) -> Result<BoardFinder, Failure> {
        if self.sim {
            let robot = RobotFile::from_path(self.robot);
            return simulate_board(self.elf.as_deref(), &robot, command);
        }
        Ok(BoardFinder {
            port: self.port,
            command,
            #[cfg(all(feature = "simulator", target_os = "linux"))]
            simulated: None,
        })
    }
}

#[cfg(all(feature = "simulator", target_os = "linux"))]
fn simulate_board(
    elf: Option<&std::path::Path>,
    file: &RobotFile,
    command: &'static str,
) -> Result<BoardFinder, Failure> {
    use simulated_uno::{Fidelity, Port, Uno};
    let robot = file.load()?;
    let image = crate::shared::firmware::select_firmware(elf, file, &robot)?.image;
    let mut uno = Uno::with_image(image, Fidelity::DataSheet);
    crate::simulate::sim::supplies::connect(&mut uno, &robot);
    let port = Port::new().map_err(|error| {
        Failure::Impossible(format!("this machine gives no pseudo terminal: {error}"))
    })?;
    let board = port.in_background(uno, |uno| {
        uno.take_edges();
        uno.take_marks();
    })?;
    Ok(BoardFinder {
        port: Some(board.path().display().to_string()),
        command,
        simulated: Some(board),
    })
}

#[cfg(not(all(feature = "simulator", target_os = "linux")))]
fn simulate_board(
    _: Option<&std::path::Path>,
    _: &RobotFile,
    _: &'static str,
) -> Result<BoardFinder, Failure> {
    Err(Failure::Input(
        "--sim is missing: this program was built without the simulator, or not for Linux"
            .to_owned(),
    ))
}

impl BoardFinder {
    /// Opens the port, which resets the board. [`Connection::greet`] comes next.
    ///
    /// # Errors
    /// Fails if there is no board, more than one, or its port cannot be opened.
    pub fn open(&self) -> Result<Connection, Failure> {
        let (port, name) = match &self.port {
            Some(port) => (port.clone(), self.name_of(port)),
            None => {
                let port = find::choose(&find::usb_ports(), self.command)
                    .map_err(|error| Failure::Impossible(error.to_string()))?;
                // The product name comes from the board, so it is made safe to print.
                (port.name.clone(), escape_controls(&port.to_string()))
            }
        };
        Ok(Connection {
            link: Link::new(port::open(&port)?, Timeouts::default()),
            name,
        })
    }

    /// Opens the port, prints its name on standard error, and waits for the banner.
    ///
    /// # Errors
    /// Fails as [`BoardFinder::open`] does, or if no lizard answers.
    pub fn open_and_greet(&self) -> Result<(Connection, Option<String>), Failure> {
        let mut board = self.open()?;
        eprintln!("lizard: waiting for the board at {}", board.name);
        let banner = board.greet()?;
        Ok((board, banner))
    }

    /// True if the board is simulated, so that it ends with this program.
    pub fn is_simulated(&self) -> bool {
        #[cfg(all(feature = "simulator", target_os = "linux"))]
        let is_simulated = self.simulated.is_some();
        #[cfg(not(all(feature = "simulator", target_os = "linux")))]
        let is_simulated = false;
        is_simulated
    }

    #[cfg(all(feature = "simulator", target_os = "linux"))]
    fn name_of(&self, port: &str) -> String {
        match self.simulated {
            Some(_) => format!("{port} (a simulated UNO)"),
            None => port.to_owned(),
        }
    }

    #[cfg(not(all(feature = "simulator", target_os = "linux")))]
    fn name_of(&self, port: &str) -> String {
        port.to_owned()
    }
}

impl Connection {
    /// Waits for the banner; see [`Link::greet`].
    ///
    /// # Errors
    /// Fails if no lizard answers; the message names the port.
    pub fn greet(&mut self) -> Result<Option<String>, Failure> {
        self.link.greet().map_err(|error| self.failure(&error))
    }

    /// Converts the error to a failure whose message has the port's name.
    pub fn failure(&self, error: &LinkError) -> Failure {
        Failure::Impossible(format!("{}: {error}", self.name))
    }
}
