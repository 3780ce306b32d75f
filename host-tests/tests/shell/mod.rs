//! A command in the root of the repository, as a person types it: its screen can
//! be read while it runs, lines can be typed, Ctrl-C ends it.

use std::io::{Read, Write};
use std::os::unix::process::CommandExt;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;

use lizard_host_tests::root;
use rustix::process::{Pid, Signal, kill_process_group};

pub struct Shell {
    child: Mutex<Child>,
    keyboard: ChildStdin,
    screen: Arc<Mutex<Vec<u8>>>,
}

impl Shell {
    pub fn start(program: &str, arguments: &[&str], environment: &[(&str, &str)]) -> Self {
        let mut command = Command::new(program);
        command.args(arguments).current_dir(root());
        // A person's shell knows nothing of the cargo and make around this test.
        for (name, _) in std::env::vars() {
            let of_cargo = name.starts_with("CARGO") && name != "CARGO_HOME";
            if of_cargo || name.starts_with("MAKE") || name == "MFLAGS" {
                command.env_remove(name);
            }
        }
        command.envs(environment.iter().copied());
        command.process_group(0);
        command.stdin(Stdio::piped());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the command starts");
        let screen = Arc::default();
        show(child.stdout.take().expect("it is piped"), &screen);
        show(child.stderr.take().expect("it is piped"), &screen);
        // Kept open: ravedude's console reads without a pause after its end.
        let keyboard = child.stdin.take().expect("it is piped");
        let child = Mutex::new(child);
        Self {
            child,
            keyboard,
            screen,
        }
    }

    /// All that has been printed so far.
    pub fn screen(&self) -> String {
        let screen = self.screen.lock().expect("nobody panics with it");
        String::from_utf8_lossy(&screen).into_owned()
    }

    pub fn say(&mut self, line: &str) {
        writeln!(self.keyboard, "{line}").expect("the command reads");
    }

    pub fn has_ended(&self) -> bool {
        let mut child = self.child.lock().expect("nobody panics with it");
        child.try_wait().expect("it is our child").is_some()
    }

    /// Presses Ctrl-C.
    pub fn interrupt(&mut self) {
        let child = self.child.get_mut().expect("nobody panics with it");
        if let Ok(None) = child.try_wait() {
            let group = Pid::from_child(child);
            kill_process_group(group, Signal::INT).expect("it is our child");
            child.wait().expect("it is our child");
        }
    }
}

impl Drop for Shell {
    fn drop(&mut self) {
        self.interrupt();
    }
}

fn show(mut pipe: impl Read + Send + 'static, screen: &Arc<Mutex<Vec<u8>>>) {
    let screen = Arc::clone(screen);
    thread::spawn(move || {
        let mut bytes = [0; 1024];
        while let Ok(count @ 1..) = pipe.read(&mut bytes) {
            let mut screen = screen.lock().expect("nobody panics with it");
            screen.extend_from_slice(&bytes[..count]);
        }
    });
}
