//! `lizard console`: a user's or script's dialogue with the robot; a script is read from standard input.

use std::fs::File;
use std::io::{self, BufRead, BufWriter, IsTerminal, Write};
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::time::{Duration, Instant};

use crossterm::event::{self, Event as TerminalEvent};
use lizard_robot::Status;

use super::connect::{BoardFinder, Connection, ConnectionArgs};
use super::dialogue_error::DialogueError;
use super::history;
use super::link::LinkError;
use super::prompt::{self, Prompt, PromptEvent};
use super::recorder::{self, Event, FORMAT, Recorder};
use super::screen::Screen;
use super::session::Session;
use super::terminal;
use crate::Failure;
use crate::drive::clock::Clock;

/// Open the robot's console
///
/// Finds the board, waits for it to start, and sends your lines to it; `help` lists its commands. Esc stops the robot
/// at once: `stop` overtakes all waiting lines, and is repeated until the robot answers. The arrow keys recall older
/// lines; Ctrl-C, Ctrl-D or `quit` end the program. The line at the bottom shows gait, pose, smallest margin, supply
/// and faults. For this line, the program sends `status` twice a second, so `boot` has no effect. While you drive,
/// `deadman` is set: a robot out of range stops by itself. If standard input is a file or a pipe, its lines are sent
/// one after another up to `quit`, and the exit code is 1 if the robot refuses a line; over a radio, the robot stops
/// after the last line.
#[derive(clap::Args, Debug)]
pub struct ConsoleArgs {
    /// Record the session in a new file: commands, answers, the pose in every frame, and faults, as one JSON object per
    /// line with its time in ms; `lizard console replay` draws it
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    #[command(flatten)]
    connection: ConnectionArgs,
}

/// Longest wait for a line from the robot before the keys are checked.
const ROBOT_READ_TIMEOUT: Duration = Duration::from_millis(10);
/// Pause before each attempt to reopen a vanished port.
const RETRY_INTERVAL: Duration = Duration::from_millis(300);
/// Longest wait for the answer to `stop` after the user has quit.
const MAX_STOPPING_TIME: Duration = Duration::from_secs(2);

/// Runs `lizard console`.
///
/// # Errors
/// Fails if there is no board, if the connection or the terminal fails, if a script's line is not accepted, or if the
/// session's file already exists or cannot be written.
pub fn run(args: ConsoleArgs) -> Result<(), Failure> {
    let is_refused = |file: &&PathBuf| file.exists() || file.as_os_str() == "-";
    if let Some(file) = args.record.as_ref().filter(is_refused) {
        // Fails before the board is reset.
        recorder::create(file)?;
    }
    run_dialogue(&args.connection.into_finder("console")?, args.record)
}

fn run_dialogue(finder: &BoardFinder, file: Option<PathBuf>) -> Result<(), Failure> {
    let (board, banner) = finder.connect()?;
    let mut clock = Clock::start();
    let mut dialogue = Dialogue {
        session: Session::new(clock.now(), true, file.is_some()).with_deadman(),
        clock,
        recorder: file.as_deref().map(recorder::create).transpose()?,
    };
    dialogue.record(Event::Begin {
        format: FORMAT.to_owned(),
        port: board.name.clone(),
        banner: banner.clone(),
    })?;
    let is_reset_by_opening = banner.is_some();
    let first_line = banner.unwrap_or_else(|| "(the board was not reset and continues)".to_owned());
    if io::stdin().is_terminal() && io::stdout().is_terminal() {
        match dialogue.run_terminal(finder, board, &first_line) {
            // The user has closed the terminal.
            Err(Failure::Io(_)) if !terminal::is_open() => Ok(()),
            result => result,
        }
    } else {
        dialogue.run_script(board, &first_line, is_reset_by_opening)
    }
}

/// A session and its recorder.
struct Dialogue {
    session: Session,
    /// The session's clock, which stops with this program: a suspended program must not take the robot for silent.
    clock: Clock,
    recorder: Option<Recorder<BufWriter<File>>>,
}

impl Dialogue {
    /// Sends the next line if one is due, and reads the received lines; `show` prints the lines for the user.
    fn exchange_lines(
        &mut self,
        board: &mut Connection,
        mut show: impl FnMut(&str) -> io::Result<()>,
    ) -> Result<(), DialogueError> {
        let line = self.session.take_next_line(self.clock.now());
        let sent = line.map_or(Ok(()), |line| board.link.send(&line));
        self.record_events()?;
        sent?;
        // Reads at most 51 lines, because no keys are handled in the meantime.
        for timeout in std::iter::once(ROBOT_READ_TIMEOUT).chain([Duration::ZERO; 50]) {
            let Some(line) = board.link.read_line(timeout)? else {
                break;
            };
            let shown_line = self.session.receive(&line);
            // The port may fail at the next line.
            self.record_events()?;
            if let Some(line) = shown_line {
                show(&line)?;
            }
        }
        if let Some(message) = self.session.time_out_request(self.clock.now()) {
            show(&message)?;
        }
        Ok(())
    }

    fn record_events(&mut self) -> Result<(), Failure> {
        let events = self.session.take_events();
        events.into_iter().try_for_each(|event| self.record(event))
    }

    fn record(&mut self, event: Event) -> Result<(), Failure> {
        match &mut self.recorder {
            Some(recorder) => recorder.write(Instant::now(), event),
            None => Ok(()),
        }
    }

    /// Sends the lines from standard input, as [`Dialogue::send_script`] does. After an error, for example if the
    /// output cannot be written, stops the robot: the rest of the script, which may stop it, is not sent.
    fn run_script(
        mut self,
        mut board: Connection,
        first_line: &str,
        is_reset_by_opening: bool,
    ) -> Result<(), Failure> {
        let sent = self.send_script(&mut board, first_line, is_reset_by_opening);
        if sent.is_err() {
            // The port may be gone.
            if board.link.send("stop").is_ok() {
                let _ = self.record(Event::Sent("stop".to_owned()));
            }
            if let Some(recorder) = &mut self.recorder {
                let _ = recorder.flush();
            }
        }
        sent?;
        self.session.check_all_accepted()
    }

    /// Sends the lines from standard input. A port that does not reset the board when it is opened may be a radio link:
    /// then `deadman` is set as for a person, and stays set after the last line if the robot is still walking.
    fn send_script(
        &mut self,
        board: &mut Connection,
        first_line: &str,
        is_reset_by_opening: bool,
    ) -> Result<(), Failure> {
        let mut out = io::stdout();
        writeln!(out, "{first_line}")?;
        if is_reset_by_opening {
            // A script needs only the answers, unless it is recorded.
            let is_recorded = self.recorder.is_some();
            self.session = Session::new(self.clock.now(), is_recorded, is_recorded);
        }
        let lines = read_stdin_lines();
        let mut has_input_ended = false;
        let mut is_final_status_due = !is_reset_by_opening;
        while !(has_input_ended && self.session.is_idle()) || is_final_status_due {
            if has_input_ended && self.session.is_idle() {
                is_final_status_due = false;
                self.session.request_status(self.clock.now());
            }
            while !has_input_ended {
                match lines.try_recv() {
                    Ok(line) if line.trim().is_empty() => {}
                    Ok(line) if prompt::is_quit(line.trim()) => has_input_ended = true,
                    Ok(line) => self.session.queue(line.trim()),
                    Err(TryRecvError::Empty) => break,
                    Err(TryRecvError::Disconnected) => has_input_ended = true,
                }
            }
            let outcome = self.exchange_lines(board, |line| writeln!(out, "{line}"));
            if matches!(outcome, Err(DialogueError::Link(LinkError::Gone))) {
                self.record(Event::Gone)?;
            }
            outcome.map_err(|error| board.to_failure(error))?;
        }
        if self.session.is_driven() {
            writeln!(out, "(no more lines: the robot now stops by itself)")?;
        } else if !self.session.status().is_some_and(Status::is_walking) {
            self.restore_deadman(board);
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.flush()?;
        }
        Ok(())
    }

    /// Sends the robot's own `deadman` if it was replaced; returns false if the robot does not confirm it.
    fn restore_deadman(&mut self, board: &mut Connection) -> bool {
        let Some(line) = self.session.restore_deadman() else {
            return true;
        };
        // A radio may lose a line, and an answer to an earlier line may come first.
        let answer = format!("ok {line}");
        let mut replies = (0..3).map(|_| board.link.ask(&line));
        replies.any(|reply| reply.is_ok_and(|reply| reply.answer == answer))
    }

    fn run_terminal(
        mut self,
        finder: &BoardFinder,
        board: Connection,
        first_line: &str,
    ) -> Result<(), Failure> {
        let mut screen = Screen::new()?;
        let mut prompt = Prompt::new(history::load());
        screen.print(first_line)?;
        screen.print("(help lists the commands; Ctrl-D quits)")?;
        let mut board = Some(board);
        let mut fatal_failure = None;
        while !self.handle_keys(&mut screen, &mut prompt)? {
            let Some(connection) = &mut board else {
                screen.draw("waiting for the board; Ctrl-C quits", &prompt)?;
                board = self.reopen(finder, &mut screen)?;
                continue;
            };
            match self.exchange_lines(connection, |line| screen.print(line)) {
                Ok(()) => {}
                Err(DialogueError::Link(LinkError::Gone)) => {
                    let message = format!("{}: {}", connection.name, LinkError::Gone);
                    screen.print(&message)?;
                    self.record(Event::Gone)?;
                    board = None;
                    continue;
                }
                Err(error) => {
                    fatal_failure = Some(connection.to_failure(error));
                    break;
                }
            }
            let status = self.session.status().map(Status::format_line);
            let status = status.unwrap_or_default();
            let prefix = if self.recorder.is_some() { "REC  " } else { "" };
            screen.draw(&format!("{prefix}{status}"), &prompt)?;
        }
        // After a failure, or if the terminal was closed, nobody can stop the robot. The `deadman` for driving then
        // stays set, so that the robot stops by itself.
        let has_quit = fatal_failure.is_none() && terminal::is_open();
        let mut is_restored = true;
        if has_quit && let Some(board) = &mut board {
            // The terminal may be closed.
            let _ = screen.draw("waiting for the robot", &prompt);
            self.finish_stop(board, &mut screen);
            is_restored = self.restore_deadman(board);
        }
        drop(screen);
        history::save(prompt.history());
        let is_walking = self.session.status().is_some_and(Status::is_walking);
        let is_stopping = self.session.is_stopping();
        let has_message = is_walking || is_stopping || !is_restored;
        if has_quit && has_message && board.is_some() && !finder.is_simulated() {
            let message = if is_stopping {
                "(no answer to `stop`: the robot may still move)"
            } else if is_restored {
                "the robot continues its gait"
            } else {
                "(the robot has not confirmed its `deadman` setting: a gait may end by itself)"
            };
            // The terminal may be closed; a failed message is not an error.
            let _ = writeln!(io::stdout(), "{message}");
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.flush()?;
        }
        fatal_failure.map_or(Ok(()), Err)
    }

    /// Repeats an unanswered `stop` before the program ends, at most for [`MAX_STOPPING_TIME`]. A link that fails in
    /// the meantime is not an error, because the user has quit.
    fn finish_stop(&mut self, board: &mut Connection, screen: &mut Screen) {
        let end = self.clock.now() + MAX_STOPPING_TIME;
        while self.session.is_stopping() && self.clock.now() < end {
            let exchanged = self.exchange_lines(board, |line| screen.print(line));
            if exchanged.is_err() {
                break;
            }
        }
    }

    /// Handles the pressed keys; returns true if the user quits.
    fn handle_keys(&mut self, screen: &mut Screen, prompt: &mut Prompt) -> Result<bool, Failure> {
        if !terminal::is_open() {
            return Ok(true);
        }
        while event::poll(Duration::ZERO)? {
            let events = match event::read()? {
                TerminalEvent::Key(key) => vec![prompt.press_key(key)],
                TerminalEvent::Paste(text) => prompt.paste(&text),
                _ => vec![],
            };
            for event in events {
                match event {
                    PromptEvent::Edited => {}
                    PromptEvent::Leave => return Ok(true),
                    PromptEvent::Suspend => {
                        screen.leave()?;
                        terminal::suspend_program()?;
                        screen.enter()?;
                    }
                    PromptEvent::Line(line) => {
                        screen.print(&format!("> {line}"))?;
                        if line.eq_ignore_ascii_case("stop") {
                            self.session.stop(self.clock.now());
                        } else {
                            self.session.queue(&line);
                        }
                    }
                }
            }
        }
        Ok(false)
    }

    /// Reopens the board's port; returns `None` if the board is still missing.
    fn reopen(
        &mut self,
        finder: &BoardFinder,
        screen: &mut Screen,
    ) -> Result<Option<Connection>, Failure> {
        std::thread::sleep(RETRY_INTERVAL);
        let Ok(mut board) = finder.open() else {
            return Ok(None);
        };
        match board.link.wait_for_robot() {
            Ok(banner) => {
                if let Some(banner) = &banner {
                    self.record(Event::Note(banner.clone()))?;
                }
                let is_reset = banner.is_some();
                let banner = banner.unwrap_or_default();
                screen.print(&format!("{} is connected again: {banner}", board.name))?;
                let is_recorded = self.recorder.is_some();
                let now = self.clock.now();
                for message in self.session.restart(now, is_recorded, is_reset) {
                    screen.print(&message)?;
                }
                Ok(Some(board))
            }
            Err(LinkError::Gone) => Ok(None),
            Err(error) => Err(board.to_failure(error)),
        }
    }
}

/// Starts a thread that reads lines from standard input as they arrive; the channel closes at the end of the input.
/// A line that is not UTF-8 is sent, too: the robot refuses it, and the following lines are not lost.
fn read_stdin_lines() -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        for line in io::stdin().lock().split(b'\n').map_while(Result::ok) {
            let line = String::from_utf8_lossy(&line).into_owned();
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    receiver
}
