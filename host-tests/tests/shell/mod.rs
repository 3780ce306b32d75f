//! A shell for tests, which starts a command in the root of the repository as a user would. While the command runs, a
//! test reads the output, types lines, and ends the command with Ctrl-C.
//!
//! If a shell without job control starts a command with `&`, the command ignores Ctrl-C, and a process inherits the
//! ignored signals from its parent. If these tests were started with `&`, a command would ignore Ctrl-C until it sets
//! its own handler. The command therefore starts with the default signals, as from a user's shell.
#![allow(dead_code)] // each test program uses only part of this module

use std::io::{Read, Write};
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use lizard_host_tests::root;
use lizard_time_limit::TIME_LIMIT;
use rustix::process::{Pid, Signal, kill_process_group};

/// The time after which Ctrl-C is pressed again if the command still runs.
const CTRL_C_INTERVAL: Duration = Duration::from_secs(1);

/// A running command, with its keyboard and its screen.
pub struct Shell {
    command_line: String,
    child: Mutex<Child>,
    keyboard: ChildStdin,
    screen: Arc<Mutex<Vec<u8>>>,
    readers: [JoinHandle<()>; 2],
}

impl Shell {
    /// Starts a program with arguments and additional environment variables.
    pub fn start(program: &str, arguments: &[&str], environment: &[(&str, &str)]) -> Self {
        let mut command = Command::new("env");
        command.args(["--default-signal=INT,QUIT", program]);
        command.args(arguments).current_dir(root());
        // Removes the variables of cargo and make, which run this test, because a user's shell does not have them.
        for (name, _) in std::env::vars() {
            let is_cargo_variable = name.starts_with("CARGO") && name != "CARGO_HOME";
            if is_cargo_variable || name.starts_with("MAKE") || name == "MFLAGS" {
                command.env_remove(name);
            }
        }
        command.envs(environment.iter().copied());
        command.process_group(0);
        command.stdin(Stdio::piped());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the command starts");
        let screen = Arc::default();
        let readers = [
            spawn_reader(child.stdout.take().expect("stdout is a pipe"), &screen),
            spawn_reader(child.stderr.take().expect("stderr is a pipe"), &screen),
        ];
        // The pipe stays open, because at the end of its input ravedude's console would read in a busy loop.
        let keyboard = child.stdin.take().expect("stdin is a pipe");
        let child = Mutex::new(child);
        Self {
            command_line: [&[program], arguments].concat().join(" "),
            child,
            keyboard,
            screen,
            readers,
        }
    }

    /// Returns the output so far. If the command has ended, waits for its last output, which may still be in a pipe.
    pub fn screen(&self) -> String {
        let is_complete = || self.readers.iter().all(JoinHandle::is_finished);
        let is_current = !self.has_ended() || TIME_LIMIT.poll(is_complete);
        let screen = self.screen.lock().expect("no thread has panicked");
        let screen = String::from_utf8_lossy(&screen).into_owned();
        assert!(
            is_current,
            "waited {TIME_LIMIT} for the remaining output after\n{screen}"
        );
        screen
    }

    /// Sends a line to the command's standard input.
    pub fn type_line(&mut self, line: &str) {
        writeln!(self.keyboard, "{line}").expect("the command reads its input");
    }

    pub fn has_ended(&self) -> bool {
        let mut child = self.child.lock().expect("no thread has panicked");
        let status = child.try_wait();
        let status = status.expect("the command is a child of this process");
        status.is_some()
    }

    /// Presses Ctrl-C repeatedly until the command ends. The test fails if the command never ends.
    pub fn interrupt(&mut self) {
        let mut pressed_at: Option<Instant> = None;
        let has_ended = TIME_LIMIT.poll(|| {
            if self.has_ended() {
                return true;
            }
            if pressed_at.is_none_or(|instant| instant.elapsed() > CTRL_C_INTERVAL) {
                self.signal(Signal::INT);
                pressed_at = Some(Instant::now());
            }
            false
        });
        let (command_line, screen) = (&self.command_line, self.screen());
        assert!(
            has_ended,
            "waited {TIME_LIMIT} for `{command_line}` to end on Ctrl-C:\n{screen}"
        );
    }

    /// Sends a signal to the command and all its children.
    fn signal(&self, signal: Signal) {
        let child = self.child.lock().expect("no thread has panicked");
        // An error means that the command has already ended.
        let _ = kill_process_group(Pid::from_child(&child), signal);
    }
}

impl Drop for Shell {
    fn drop(&mut self) {
        if !self.has_ended() {
            self.signal(Signal::KILL);
            let _ = TIME_LIMIT.wait_for_exit(self.child.get_mut().expect("no thread has panicked"));
        }
    }
}

fn spawn_reader(
    mut pipe: impl Read + Send + 'static,
    screen: &Arc<Mutex<Vec<u8>>>,
) -> JoinHandle<()> {
    let screen = Arc::clone(screen);
    thread::spawn(move || {
        let mut bytes = [0; 1024];
        while let Ok(count @ 1..) = pipe.read(&mut bytes) {
            let mut screen = screen.lock().expect("no thread has panicked");
            screen.extend_from_slice(&bytes[..count]);
        }
    })
}
