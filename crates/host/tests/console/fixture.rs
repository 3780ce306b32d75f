//! Simulated boards, terminals and devices for the tests of the console.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, TryRecvError};
use std::thread::JoinHandle;
use std::time::Duration;

use lizard_time_limit::TIME_LIMIT;
use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, openpt, ptsname, unlockpt};
use rustix::termios::{Winsize, tcsetwinsize};
use tempfile::TempDir;

/// Returns the path of the simulated board's robot file, as in the other tests: `LIZARD_ROBOT` (relative to the
/// repository's root) or robot.toml.
fn robot_path() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let environment_path = std::env::var_os("LIZARD_ROBOT").filter(|path| !path.is_empty());
    root.join(environment_path.unwrap_or_else(|| "robot.toml".into()))
}

/// Prepares a run of `lizard`, with the robot under test if the board is simulated.
pub fn lizard_command(folder: &TempDir, command_line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lizard"));
    let mut words = command_line.split_whitespace();
    command.args(words.clone());
    if words.any(|word| ["sim", "--sim"].contains(&word)) {
        command.arg("--robot").arg(robot_path());
    }
    command.current_dir(folder).env("TERM", "xterm");
    command.env("XDG_STATE_HOME", folder.path());
    command
}

/// Runs a command line of `lizard`; returns standard output, standard error and the exit code.
pub fn run_unchecked(
    folder: &TempDir,
    command_line: &str,
    input: impl AsRef<[u8]>,
) -> (String, String, Option<i32>) {
    let mut command = lizard_command(folder, command_line);
    let output = TIME_LIMIT.run_command(&mut command, input.as_ref());
    let output = output.expect("the program ends");
    let [stdout, stderr] =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    (stdout, stderr, output.status.code())
}

/// Runs a command line of `lizard`, and checks its exit code; returns standard output and standard error.
#[track_caller]
pub fn run(
    folder: &TempDir,
    command_line: &str,
    input: impl AsRef<[u8]>,
    expected_code: i32,
) -> (String, String) {
    let (stdout, stderr, code) = run_unchecked(folder, command_line, input);
    assert_eq!(code, Some(expected_code), "{command_line}: {stderr}");
    (stdout, stderr)
}

/// Waits until a program exits.
pub fn wait_for_exit(child: &mut Child) -> ExitStatus {
    let status = TIME_LIMIT.wait_for_exit(child);
    status.expect("the program exits")
}

/// Sends a signal to a program.
pub fn send_signal(child: &Child, signal: Signal) {
    kill_process(Pid::from_child(child), signal).expect("the process exists");
}

/// Returns the first gait of the robot under test that is not `stand`.
pub fn find_gait_except_stand(folder: &TempDir) -> String {
    let (help, ..) = run_unchecked(folder, "console --sim", "help\n");
    let mut lines = help.lines();
    let gaits = lines.find_map(|line| line.strip_prefix("# gaits: "));
    let gait = gaits.and_then(|names| names.split('|').find(|name| *name != "stand"));
    gait.expect("the robot has another gait").to_owned()
}

/// A board simulated by `lizard sim --pty`. The contents of its EEPROM are lost when it ends.
pub struct Uno {
    child: Child,
    link: PathBuf,
}

impl Uno {
    pub fn start(folder: &TempDir) -> Self {
        Self::start_with(folder, "")
    }

    /// Starts a board behind a radio module, which sometimes loses a packet.
    pub fn start_by_radio(folder: &TempDir) -> Self {
        Self::start_with(folder, "--radio 115200")
    }

    fn start_with(folder: &TempDir, options: &str) -> Self {
        let link = folder.path().join("uno");
        let command_line = format!("sim --pty {} {options}", link.display());
        let mut command = lizard_command(folder, &command_line);
        let child = command.stdout(Stdio::null()).spawn();
        let child = child.expect("the program starts");
        let mut uno = Self { child, link };
        TIME_LIMIT.wait_for("a board of `lizard sim --pty`, or its end", || {
            uno.link.exists() || uno.has_ended()
        });
        assert!(!uno.has_ended(), "the board ended; see its message");
        uno
    }

    pub fn port(&self) -> String {
        self.link.display().to_string()
    }

    fn has_ended(&mut self) -> bool {
        self.child.try_wait().expect("the wait succeeds").is_some()
    }
}

impl Drop for Uno {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = TIME_LIMIT.wait_for_exit(&mut self.child);
        let _ = fs::remove_file(&self.link);
    }
}

/// Opens a pseudo terminal; returns the test's side, the program's side, and its path.
pub fn open_terminal() -> (File, OwnedFd, PathBuf) {
    let test_side = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC);
    let test_side = test_side.expect("a pseudo terminal is opened");
    unlockpt(&test_side).expect("the terminal is unlocked");
    let path = ptsname(&test_side, Vec::new()).expect("the terminal has a name");
    let path = PathBuf::from(path.to_string_lossy().into_owned());
    let program_side = File::options()
        .read(true)
        .write(true)
        .open(&path)
        .expect("the program's side is opened");
    (File::from(test_side), program_side.into(), path)
}

/// Starts `lizard` in its own pseudo terminal, 100 columns wide; returns the test's side of the terminal and the
/// program.
pub fn spawn_in_terminal(folder: &TempDir, command_line: &str) -> (File, Child) {
    let (test_side, program_side, _) = open_terminal();
    let size = Winsize {
        ws_row: 30,
        ws_col: 100,
        ws_xpixel: 0,
        ws_ypixel: 0,
    };
    tcsetwinsize(&program_side, size).expect("the size is set");
    let copy_stdio = || Stdio::from(program_side.try_clone().expect("the clone succeeds"));
    let child = lizard_command(folder, command_line)
        .stdin(copy_stdio())
        .stdout(copy_stdio())
        .stderr(copy_stdio())
        .spawn();
    (test_side, child.expect("the program starts"))
}

/// A run of `lizard` in its own pseudo terminal, 100 columns wide.
pub struct TerminalSession {
    pub child: Child,
    pub keys: File,
    output: Receiver<Vec<u8>>,
    /// The output after the text of the previous `wait_for`.
    pub new_text: String,
}

impl TerminalSession {
    pub fn start(folder: &TempDir, command_line: &str) -> Self {
        let (test_side, child) = spawn_in_terminal(folder, command_line);
        let mut screen_reader = test_side.try_clone().expect("the clone succeeds");
        let (sender, receiver) = mpsc::channel();
        std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = screen_reader.read(&mut bytes) {
                if sender.send(bytes[..count].to_vec()).is_err() {
                    break;
                }
            }
        });
        Self {
            child,
            keys: test_side,
            output: receiver,
            new_text: String::new(),
        }
    }

    /// Types keys into the terminal.
    pub fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).expect("keys are sent");
    }

    /// Types keys, and waits until the program prints `expected`.
    pub fn press_and_wait(&mut self, keys: &str, expected: &str) {
        self.press(keys);
        self.wait_for(expected);
    }

    /// Reads the output so far; returns true once the program has closed the terminal.
    pub fn read_output(&mut self) -> bool {
        loop {
            match self.output.try_recv() {
                Ok(bytes) => self.new_text.push_str(&String::from_utf8_lossy(&bytes)),
                Err(reason) => return reason == TryRecvError::Disconnected,
            }
        }
    }

    /// Waits until the program prints `expected` after the text of the previous wait. Panics if the program ends first
    /// or the time limit passes.
    pub fn wait_for(&mut self, expected: &str) {
        let mut position = None;
        let mut has_ended = false;
        TIME_LIMIT.poll(|| {
            has_ended = self.read_output();
            position = self.new_text.find(expected);
            position.is_some() || has_ended
        });
        let Some(start) = position else {
            panic!(
                "waited up to {TIME_LIMIT} for `{expected}`, but the program printed {:?}",
                self.new_text
            );
        };
        self.new_text.drain(..start + expected.len());
    }

    /// Waits for the program to exit, and returns the exit code.
    pub fn wait_for_exit(mut self) -> Option<i32> {
        wait_for_exit(&mut self.child).code()
    }
}

/// A simulated device other than a board, with a pseudo terminal and its own thread.
pub struct Device {
    pub port: String,
    stop_sender: mpsc::Sender<()>,
    thread: JoinHandle<()>,
}

impl Device {
    /// Starts a device that calls `act` repeatedly with the device's side of the terminal.
    pub fn start(mut act: impl FnMut(&mut File) + Send + 'static) -> Self {
        let (mut test_side, program_side, path) = open_terminal();
        // An open program side would keep the port in use.
        drop(program_side);
        let (stop_sender, stop_receiver) = mpsc::channel::<()>();
        let thread = std::thread::spawn(move || {
            let pause = Duration::from_millis(20);
            while stop_receiver.recv_timeout(pause) == Err(RecvTimeoutError::Timeout) {
                act(&mut test_side);
            }
        });
        Self {
            port: path.display().to_string(),
            stop_sender,
            thread,
        }
    }

    /// Stops the device and waits for the end of its thread.
    pub fn stop(self) {
        drop(self.stop_sender);
        let join_result = TIME_LIMIT.run("the end of the device", || self.thread.join());
        join_result.expect("the device does not panic");
    }
}
