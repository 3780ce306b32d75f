//! `lizard calibrate`: a guided calibration, one key at a time, for a user who holds a screwdriver.

mod guide;

use std::io::{self, IsTerminal, Stdout, Write};
use std::time::{Duration, Instant};

use crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use crossterm::style::{Attribute, Print, SetAttribute};
use crossterm::terminal::{Clear, ClearType, EnterAlternateScreen, LeaveAlternateScreen};
use crossterm::{cursor, execute, queue, terminal as terminal_mode};

use super::connect::ConnectionArgs;
use super::dialogue_error::DialogueError;
use super::terminal;
use crate::Failure;
use guide::{Guide, Key, StepView};

/// Calibrate the robot, step by step
///
/// Centres the servos for fitting the horns, checks each servo's direction, trims each
/// servo with the arrow keys, walks, and saves. Nothing is saved before the last step; if
/// you leave earlier, the robot keeps its old calibration.
#[derive(clap::Args, Debug)]
pub struct Args {
    #[command(flatten)]
    connection: ConnectionArgs,
}

/// Interval between reads from the robot while no key is pressed.
const READ_INTERVAL: Duration = Duration::from_millis(200);
/// Interval between checks for a pressed key.
const KEY_INTERVAL: Duration = Duration::from_millis(20);

/// Runs `lizard calibrate`.
///
/// # Errors
/// Fails if there is no terminal or no board, or the connection breaks.
pub fn run(args: Args) -> Result<(), Failure> {
    if !(io::stdin().is_terminal() && io::stdout().is_terminal()) {
        let message = "calibrate reads single keys; run it in a terminal";
        return Err(Failure::Input(message.to_owned()));
    }
    let finder = args.connection.into_finder("calibrate")?;
    let (mut board, _) = finder.connect()?;
    let result = Guide::new(&mut board.link).map_err(DialogueError::from);
    let result = result.and_then(|mut guide| run_guide(&mut guide));
    if result.is_err() {
        // The robot may be walking, and would walk on.
        let _ = board.link.send("stop");
    }
    match result {
        Ok(has_saved) => {
            // The terminal may be gone; a message that cannot be written is not an error.
            let message = if has_saved {
                "the calibration is saved"
            } else {
                "cancelled: the robot keeps its old calibration"
            };
            let _ = writeln!(io::stdout(), "{message}");
            Ok(())
        }
        // The next program that opens a USB port resets the board, which discards unsaved settings; a radio does not.
        Err(DialogueError::Link(error)) => Err(Failure::Operation(format!(
            "{}: {error}; a reset of the board discards the settings that are not saved",
            board.name
        ))),
        Err(error) => Err(board.to_failure(error)),
    }
}

/// Shows the steps until the user has finished or cancelled; returns true if the calibration was saved.
/// Closing the terminal cancels.
fn run_guide<P: io::Read + io::Write>(guide: &mut Guide<'_, P>) -> Result<bool, DialogueError> {
    match run_steps(guide) {
        Err(DialogueError::Io(_)) if !terminal::is_open() => {
            guide.press_key(Key::Leave)?;
            Ok(guide.has_saved())
        }
        result => result,
    }
}

/// As [`run_guide`], but closing the terminal is an error.
fn run_steps<P: io::Read + io::Write>(guide: &mut Guide<'_, P>) -> Result<bool, DialogueError> {
    let mut screen = FullScreen::new()?;
    let mut last_view = None;
    let mut last_read = Instant::now();
    loop {
        let view = guide.view();
        if last_view.as_ref() != Some(&view) {
            screen.show(&view)?;
            last_view = Some(view);
        }
        if !terminal::is_open() {
            return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
        }
        // Polls without waiting: if the terminal is closed during a wait, crossterm never returns from the wait.
        if !event::poll(Duration::ZERO)? {
            if last_read.elapsed() >= READ_INTERVAL {
                guide.read_messages()?;
                last_read = Instant::now();
            }
            std::thread::sleep(KEY_INTERVAL);
            continue;
        }
        match event::read()? {
            Event::Key(key) if is_suspend_key(key) => {
                screen.leave()?;
                terminal::suspend_program()?;
                screen.enter()?;
                last_view = None;
            }
            Event::Key(key) => {
                if let Some(guide_key) = interpret_key(key)
                    && guide.press_key(guide_key)?
                {
                    return Ok(guide.has_saved());
                }
            }
            Event::Resize(..) => last_view = None,
            _ => {}
        }
    }
}

/// True if a key is Ctrl-Z, which suspends the program.
fn is_suspend_key(key: KeyEvent) -> bool {
    key.code == KeyCode::Char('z') && key.modifiers.contains(KeyModifiers::CONTROL)
}

/// Returns a key's meaning in the guide; `None` if it has none, or if the event is its release.
fn interpret_key(key: KeyEvent) -> Option<Key> {
    if key.kind == KeyEventKind::Release {
        return None;
    }
    let is_fine = key.modifiers.contains(KeyModifiers::SHIFT);
    let degrees = if is_fine { 0.1 } else { 0.5 };
    Some(match key.code {
        KeyCode::Char('c' | 'd') if key.modifiers.contains(KeyModifiers::CONTROL) => Key::Leave,
        KeyCode::Char('q' | 'Q') | KeyCode::Esc => Key::Leave,
        KeyCode::Enter => Key::Next,
        KeyCode::Backspace | KeyCode::Char('b' | 'B') => Key::Back,
        KeyCode::Char(' ') => Key::Act,
        KeyCode::Char('y' | 'Y') => Key::Yes,
        KeyCode::Char('n' | 'N') => Key::No,
        KeyCode::Left => Key::LeftRight(degrees),
        KeyCode::Right => Key::LeftRight(-degrees),
        KeyCode::Up => Key::UpDown(0.1),
        KeyCode::Down => Key::UpDown(-0.1),
        _ => return None,
    })
}

/// The terminal's full screen, which shows one step at a time. Dropping it restores the terminal.
struct FullScreen(Stdout);

impl FullScreen {
    fn new() -> io::Result<Self> {
        let mut screen = Self(io::stdout());
        screen.enter()?;
        Ok(screen)
    }

    fn enter(&mut self) -> io::Result<()> {
        terminal::exit_when_closed();
        terminal_mode::enable_raw_mode()?;
        execute!(self.0, EnterAlternateScreen, cursor::Hide)
    }

    fn leave(&mut self) -> io::Result<()> {
        execute!(self.0, cursor::Show, LeaveAlternateScreen)?;
        terminal_mode::disable_raw_mode()
    }

    fn show(&mut self, view: &StepView) -> io::Result<()> {
        let out = &mut self.0;
        queue!(
            out,
            Clear(ClearType::All),
            cursor::MoveTo(0, 1),
            SetAttribute(Attribute::Bold),
            Print(&view.title),
            SetAttribute(Attribute::Reset),
            Print("\r\n\r\n"),
        )?;
        for line in &view.instructions {
            queue!(out, Print(line), Print("\r\n"))?;
        }
        queue!(
            out,
            Print("\r\n"),
            SetAttribute(Attribute::Reverse),
            Print(&view.keys),
            SetAttribute(Attribute::Reset),
            Print("\r\n\r\n"),
            SetAttribute(Attribute::Bold),
            Print(&view.message),
            SetAttribute(Attribute::Reset),
        )?;
        out.flush()
    }
}

impl Drop for FullScreen {
    fn drop(&mut self) {
        // The terminal may be gone; then there is nothing to restore.
        let _ = self.leave();
        let _ = terminal_mode::disable_raw_mode();
    }
}
