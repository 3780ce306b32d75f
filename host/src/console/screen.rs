//! The terminal: lines above, which scroll away as usual, and at the bottom the
//! status and the line being typed.

use std::io::{self, Stdout, Write};

use crossterm::style::{Attribute, Print, SetAttribute};
use crossterm::terminal::{self, Clear, ClearType};
use crossterm::{cursor, event, execute, queue};

use super::prompt::Prompt;

const SIGN: &str = "> ";

/// A terminal whose keys come one by one. It is as before when this is dropped.
pub struct Screen {
    out: Stdout,
    /// Whether the two lines at the bottom are drawn.
    drawn: bool,
    /// What was drawn last.
    last: Option<(String, String, usize, u16)>,
}

impl Screen {
    /// Takes the terminal.
    ///
    /// # Errors
    /// It is none.
    pub fn new() -> io::Result<Self> {
        terminal::enable_raw_mode()?;
        let mut out = io::stdout();
        execute!(out, event::EnableBracketedPaste)?;
        Ok(Self {
            out,
            drawn: false,
            last: None,
        })
    }

    /// Prints a line above the two at the bottom.
    ///
    /// # Errors
    /// Writing failed.
    pub fn print(&mut self, line: &str) -> io::Result<()> {
        self.erase()?;
        queue!(self.out, Print(line), Print("\r\n"))?;
        self.out.flush()
    }

    /// Draws the two lines at the bottom, if they have changed.
    ///
    /// # Errors
    /// Writing failed.
    pub fn draw(&mut self, status: &str, prompt: &Prompt) -> io::Result<()> {
        let (width, _) = terminal::size()?;
        // A line that fills its last column would wrap.
        let room = usize::from(width).saturating_sub(1);
        let status: String = status.chars().take(room).collect();
        let (text, cursor) = prompt.view(room.saturating_sub(SIGN.len()));
        let next = (status, text, cursor, width);
        if self.drawn && self.last.as_ref() == Some(&next) {
            return Ok(());
        }
        self.erase()?;
        let (status, text, cursor, _) = &next;
        queue!(
            self.out,
            SetAttribute(Attribute::Reverse),
            Print(format!("{status:room$}")),
            SetAttribute(Attribute::Reset),
            Print("\r\n"),
            Print(SIGN),
            Print(text),
            cursor::MoveToColumn((SIGN.len() + cursor) as u16),
        )?;
        self.drawn = true;
        self.last = Some(next);
        self.out.flush()
    }

    /// Takes the two lines away; the cursor is where they began.
    fn erase(&mut self) -> io::Result<()> {
        if self.drawn {
            queue!(self.out, cursor::MoveToPreviousLine(1))?;
        }
        self.drawn = false;
        queue!(
            self.out,
            cursor::MoveToColumn(0),
            Clear(ClearType::FromCursorDown)
        )
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // The terminal may be gone; then nothing is left to be done.
        let _ = self.erase();
        let _ = execute!(self.out, event::DisableBracketedPaste);
        let _ = terminal::disable_raw_mode();
    }
}
