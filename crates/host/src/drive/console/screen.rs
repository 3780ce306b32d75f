//! The console's screen: output lines scroll as usual; the status line and the input line stay below them.

use std::io::{self, Stdout, Write};

use crossterm::style::{Attribute, Print, SetAttribute};
use crossterm::terminal::{self, Clear, ClearType};
use crossterm::{cursor, event, execute, queue};

use super::prompt::Prompt;

/// The beginning of the input line.
const PROMPT_SIGN: &str = "> ";

/// A terminal that reports single keys. Dropping it restores the terminal.
pub struct Screen {
    out: Stdout,
    /// Numbers of columns of the status line, and of the input line up to the cursor; `None` while the lines are not
    /// drawn.
    drawn_columns: Option<[usize; 2]>,
    /// The latest drawing: status line, visible part of the input, the cursor's column in this part, terminal width.
    last_drawing: Option<(String, String, usize, u16)>,
}

impl Screen {
    /// Takes over the terminal.
    ///
    /// # Errors
    /// Fails if standard output is not a terminal.
    pub fn new() -> io::Result<Self> {
        let mut screen = Self {
            out: io::stdout(),
            drawn_columns: None,
            last_drawing: None,
        };
        screen.enter()?;
        Ok(screen)
    }

    /// Takes over the terminal again, after [`Screen::leave`].
    ///
    /// # Errors
    /// Fails if the terminal is gone.
    pub fn enter(&mut self) -> io::Result<()> {
        super::terminal::exit_when_closed();
        terminal::enable_raw_mode()?;
        execute!(self.out, event::EnableBracketedPaste)
    }

    /// Restores the terminal.
    ///
    /// # Errors
    /// Fails if the terminal is gone.
    pub fn leave(&mut self) -> io::Result<()> {
        self.erase()?;
        execute!(self.out, event::DisableBracketedPaste)?;
        terminal::disable_raw_mode()
    }

    /// Prints a line above the two lines at the bottom.
    ///
    /// # Errors
    /// Fails if writing fails.
    pub fn print(&mut self, line: &str) -> io::Result<()> {
        self.erase()?;
        queue!(self.out, Print(line), Print("\r\n"))?;
        self.out.flush()
    }

    /// Draws the two lines at the bottom if they have changed.
    ///
    /// # Errors
    /// Fails if writing fails.
    pub fn draw(&mut self, status: &str, prompt: &Prompt) -> io::Result<()> {
        let (width, _) = terminal::size()?;
        // A line that fills its last column would wrap.
        let usable_width = usize::from(width).saturating_sub(1);
        let status: String = status.chars().take(usable_width).collect();
        let prompt_sign = &PROMPT_SIGN[..PROMPT_SIGN.len().min(usable_width)];
        let (text, cursor) = prompt.view(usable_width - prompt_sign.len());
        let drawing = (status, text, cursor, width);
        if self.drawn_columns.is_some() && self.last_drawing.as_ref() == Some(&drawing) {
            return Ok(());
        }
        self.erase()?;
        let (status, text, cursor, _) = &drawing;
        queue!(
            self.out,
            SetAttribute(Attribute::Reverse),
            Print(format!("{status:usable_width$}")),
            SetAttribute(Attribute::Reset),
            Print("\r\n"),
            Print(prompt_sign),
            Print(text),
            cursor::MoveToColumn((prompt_sign.len() + cursor) as u16),
        )?;
        self.drawn_columns = Some([usable_width, prompt_sign.len() + cursor]);
        self.last_drawing = Some(drawing);
        self.out.flush()
    }

    /// Erases the two lines and moves the cursor to their beginning.
    fn erase(&mut self) -> io::Result<()> {
        if let Some(columns) = self.drawn_columns.take() {
            let (width, _) = terminal::size()?;
            let row_count = count_rows_above_cursor(columns, width.into());
            queue!(self.out, cursor::MoveToPreviousLine(row_count as u16))?;
        }
        queue!(
            self.out,
            cursor::MoveToColumn(0),
            Clear(ClearType::FromCursorDown)
        )
    }
}

/// Counts the rows from the first of the two lines down to the cursor, given [`Screen::drawn_columns`]. A terminal that
/// was made narrower wraps the lines into more rows.
fn count_rows_above_cursor([status_columns, cursor_column]: [usize; 2], width: usize) -> usize {
    let width = width.max(1);
    status_columns.div_ceil(width).max(1) + cursor_column / width
}

impl Drop for Screen {
    fn drop(&mut self) {
        // Errors are ignored, since the terminal may be gone.
        let _ = self.leave();
        let _ = terminal::disable_raw_mode();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapped_lines_count_as_several_rows() {
        for (columns, width, row_count, case) in [
            ([99, 12], 100, 1, "the drawn width"),
            ([99, 12], 200, 1, "a wider terminal"),
            ([99, 12], 50, 2, "the status takes two rows"),
            ([99, 60], 50, 3, "the input line takes two rows, too"),
            ([99, 60], 33, 4, "a third of the drawn width"),
            ([0, 0], 1, 1, "a terminal of one column"),
            ([0, 0], 0, 1, "a terminal without a size"),
        ] {
            assert_eq!(count_rows_above_cursor(columns, width), row_count, "{case}");
        }
    }
}
