//! Connecting to a board: from the command's arguments to the board's first line.

use std::cell::OnceCell;
use std::io::{self, Write};
use std::path::PathBuf;

use serialport::SerialPort;

use super::dialogue_error::DialogueError;
use super::link::Link;
use super::port;
use super::usb_ports;
use crate::shared::escape::escape_controls;
use crate::{Failure, RobotArgs};

/// The arguments that select the board to connect to.
#[derive(clap::Args, Debug)]
pub struct ConnectionArgs {
    /// The board's serial port [default: the port with a UNO, or the only port]
    port: Option<String>,
    /// Use a simulated UNO instead, in real time
    #[arg(long, conflicts_with = "port")]
    sim: bool,
    /// With --sim: the firmware, an ELF that contains this robot [default: the built-in firmware]
    #[arg(long, value_name = "FILE", requires = "sim")]
    elf: Option<PathBuf>,
    /// With --sim: the robot, a file or a built-in name as for `lizard sim` [default: robot.toml
    /// in this folder or the nearest folder above it, else the built-in robot.toml]
    #[arg(long, value_name = "FILE", requires = "sim")]
    robot: Option<PathBuf>,
}

/// A finder of the board's port. Unless the user named a port, each `open` searches again, because a board may get
/// another port when it is plugged in again.
#[derive(Debug)]
pub struct BoardFinder {
    /// The port that the user named, or the simulated board's port.
    port: Option<String>,
    /// The subcommand with the arguments before the port, for messages.
    command: &'static str,
    /// The IDs of the USB chip whose port was chosen first. While that board is unplugged, the port of a chip with
    /// other IDs is not its port.
    chip_ids: OnceCell<[u16; 2]>,
    simulated_board: Option<SimulatedBoard>,
}

#[cfg(all(feature = "simulator", target_os = "linux"))]
type SimulatedBoard = simulated_uno::BackgroundPort;
/// The simulated board of a build without a simulator, which never exists.
#[cfg(not(all(feature = "simulator", target_os = "linux")))]
type SimulatedBoard = std::convert::Infallible;

/// An open port with a connected board.
pub struct Connection {
    /// The serial link to the board.
    pub link: Link<Box<dyn SerialPort>>,
    /// The port's name for messages.
    pub name: String,
}

impl ConnectionArgs {
    /// Creates the finder for these arguments; with `--sim`, also starts the simulated UNO. `command` is the subcommand
    /// with the arguments before the port, for messages.
    ///
    /// # Errors
    /// Fails if the simulated UNO has no robot, firmware or pseudo terminal, or is not built in.
    pub fn into_finder(self, command: &'static str) -> Result<BoardFinder, Failure> {
        if self.sim {
            let robot = RobotArgs::from_path(self.robot);
            return start_simulated_board(self.elf.as_deref(), &robot, command);
        }
        Ok(BoardFinder {
            port: self.port,
            command,
            chip_ids: OnceCell::new(),
            simulated_board: None,
        })
    }
}

#[cfg(all(feature = "simulator", target_os = "linux"))]
fn start_simulated_board(
    elf: Option<&std::path::Path>,
    robot_args: &RobotArgs,
    command: &'static str,
) -> Result<BoardFinder, Failure> {
    use simulated_uno::{Fidelity, Port, Uno};
    let robot = robot_args.load()?;
    let image = crate::shared::firmware::select_firmware(elf, robot_args, &robot)?.image;
    let mut uno = Uno::with_image(image, Fidelity::DataSheet);
    crate::simulate::sim::supplies::connect_healthy_robot(&mut uno, &robot);
    let port = Port::new()
        .map_err(|error| Failure::Operation(format!("cannot open a pseudo terminal: {error}")))?;
    let board = port.in_background(uno, |uno| {
        uno.take_edges();
        uno.take_marks();
    })?;
    Ok(BoardFinder {
        port: Some(board.path().display().to_string()),
        command,
        chip_ids: OnceCell::new(),
        simulated_board: Some(board),
    })
}

#[cfg(not(all(feature = "simulator", target_os = "linux")))]
fn start_simulated_board(
    _: Option<&std::path::Path>,
    _: &RobotArgs,
    _: &'static str,
) -> Result<BoardFinder, Failure> {
    Err(Failure::Input(
        "--sim is missing: this program was built without the simulator, or not for Linux"
            .to_owned(),
    ))
}

impl BoardFinder {
    /// Opens the port, which resets the board. Call [`Link::wait_for_robot`] next.
    ///
    /// # Errors
    /// Fails if there is no board, there are several, or the port cannot be opened.
    pub fn open(&self) -> Result<Connection, Failure> {
        let (port, name) = match &self.port {
            Some(port) if self.is_simulated() => {
                (port.clone(), format!("{port} (a simulated UNO)"))
            }
            Some(port) => (port.clone(), port.clone()),
            None => {
                let mut ports = usb_ports::list();
                usb_ports::retain_chip(&mut ports, self.chip_ids.get());
                let port = usb_ports::choose(&ports, self.command)
                    .map_err(|error| Failure::Operation(error.to_string()))?;
                self.chip_ids.get_or_init(|| port.chip_ids);
                // The product name comes from the board and may contain control characters.
                (port.name.clone(), escape_controls(&port.to_string()))
            }
        };
        Ok(Connection {
            link: Link::new(port::open(&port)?),
            name,
        })
    }

    /// Opens the port, prints its name on standard error, and waits for the banner. Also returns the banner; `None` if
    /// the board was not reset.
    ///
    /// # Errors
    /// Fails as [`BoardFinder::open`] does, or if no lizard answers.
    pub fn connect(&self) -> Result<(Connection, Option<String>), Failure> {
        let mut board = self.open()?;
        // A closed standard error must not end the program, so `eprintln`, which may panic, is not used.
        let _ = writeln!(
            io::stderr(),
            "lizard: waiting for the board at {}",
            board.name
        );
        let banner = board.link.wait_for_robot();
        let banner = banner.map_err(|error| board.to_failure(error))?;
        Ok((board, banner))
    }

    /// True if the board is simulated; it then exists only as long as this program runs.
    pub fn is_simulated(&self) -> bool {
        self.simulated_board.is_some()
    }
}

impl Connection {
    /// Converts the error to a failure; the message about a failed connection names the port.
    pub fn to_failure(&self, error: impl Into<DialogueError>) -> Failure {
        match error.into() {
            DialogueError::Link(error) => Failure::Operation(format!("{}: {error}", self.name)),
            DialogueError::Io(error) => error.into(),
            DialogueError::File(failure) => failure,
        }
    }
}
