//! A command that runs in the root of the repository as a user starts it: a test reads its screen while
//! it runs, types lines, and ends it with Ctrl-C.
//!
//! A process inherits from its parent the signals that it ignores, and a shell without job control
//! makes commands that it starts with `&` ignore Ctrl-C. If these tests are started with `&`, a command
//! would also ignore Ctrl-C until it sets a handler of its own. So the command starts with the default
//! signals, as from a user's shell.
#![allow(dead_code)] // each test uses a part of it

use std::io::{Read, Write};
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use lizard_host_tests::root;
use lizard_time_limit::LIMIT;
use rustix::process::{Pid, Signal, kill_process_group};

/// The time after which Ctrl-C is pressed again.
const CTRL_C_INTERVAL: Duration = Duration::from_secs(1);

pub struct Shell {
    line: String,
    child: Mutex<Child>,
    keyboard: ChildStdin,
    screen: Arc<Mutex<Vec<u8>>>,
    readers: [JoinHandle<()>; 2],
}

impl Shell {
    pub fn start(program: &str, arguments: &[&str], environment: &[(&str, &str)]) -> Self {
        let mut command = Command::new("env");
        command.args(["--default-signal=INT,QUIT", program]);
        command.args(arguments).current_dir(root());
        // A user's shell does not have the variables of the cargo and make around this test.
        for (name, _) in std::env::vars() {
            let is_of_cargo = name.starts_with("CARGO") && name != "CARGO_HOME";
            if is_of_cargo || name.starts_with("MAKE") || name == "MFLAGS" {
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
            spawn_reader(child.stdout.take().expect("it is piped"), &screen),
            spawn_reader(child.stderr.take().expect("it is piped"), &screen),
        ];
        // The pipe stays open, since ravedude's console reads without a pause at the end of its input.
        let keyboard = child.stdin.take().expect("it is piped");
        let child = Mutex::new(child);
        Self {
            line: [&[program], arguments].concat().join(" "),
            child,
            keyboard,
            screen,
            readers,
        }
    }

    /// Returns everything printed so far.
    pub fn screen(&self) -> String {
        let screen = self.screen.lock().expect("nobody panics with it");
        String::from_utf8_lossy(&screen).into_owned()
    }

    /// Returns everything printed by a command that has ended. Waits for its last output, which may still be in
    /// a pipe.
    pub fn last_screen(&self) -> String {
        let is_read = LIMIT.wait_for(|| self.readers.iter().all(JoinHandle::is_finished));
        let screen = self.screen();
        assert!(is_read, "waited {LIMIT} for the rest of\n{screen}");
        screen
    }

    pub fn say(&mut self, line: &str) {
        writeln!(self.keyboard, "{line}").expect("the command reads");
    }

    pub fn has_ended(&self) -> bool {
        let mut child = self.child.lock().expect("nobody panics with it");
        child.try_wait().expect("it is our child").is_some()
    }

    /// Presses Ctrl-C repeatedly until the command ends. The test fails if the command
    /// never ends.
    pub fn interrupt(&mut self) {
        let mut pressed_at: Option<Instant> = None;
        let has_ended = LIMIT.wait_for(|| {
            if self.has_ended() {
                return true;
            }
            if pressed_at.is_none_or(|instant| instant.elapsed() > CTRL_C_INTERVAL) {
                self.signal(Signal::INT);
                pressed_at = Some(Instant::now());
            }
            false
        });
        let (line, screen) = (&self.line, self.screen());
        assert!(
            has_ended,
            "waited {LIMIT} for the end of `{line}` by Ctrl-C:\n{screen}"
        );
    }

    /// Sends a signal to the command and all its children.
    fn signal(&self, signal: Signal) {
        let child = self.child.lock().expect("nobody panics with it");
        // A command that has ended meanwhile needs no signal.
        let _ = kill_process_group(Pid::from_child(&child), signal);
    }
}

impl Drop for Shell {
    fn drop(&mut self) {
        if !self.has_ended() {
            self.signal(Signal::KILL);
            let _ = LIMIT.wait_for_exit(self.child.get_mut().expect("nobody panics with it"));
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
            let mut screen = screen.lock().expect("nobody panics with it");
            screen.extend_from_slice(&bytes[..count]);
        }
    })
}
