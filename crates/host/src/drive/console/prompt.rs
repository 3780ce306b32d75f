//! The input line of the console, with its history.

use crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use tui_input::Input;
use tui_input::backend::crossterm::EventHandler;

/// Largest number of lines kept in the history.
const MAX_HISTORY_LINES: usize = 500;

/// True for a line that ends the program, from a user or a script.
pub fn is_quit(line: &str) -> bool {
    matches!(line, "quit" | "exit")
}

/// The effect of a key.
#[derive(Debug, PartialEq, Eq)]
pub enum PromptEvent {
    /// The line may have changed; there is nothing to send.
    Edited,
    /// Send this line.
    Line(String),
    /// Quit the program.
    Leave,
    /// Suspend the program until the shell resumes it.
    Suspend,
}

/// An input line.
#[derive(Debug, Default)]
pub struct Prompt {
    input: Input,
    history: Vec<String>,
    /// The index of the shown line in the history; the history's length if the line being typed is shown.
    shown_index: usize,
    /// The unfinished line, while an older line is shown.
    draft: String,
}

impl Prompt {
    /// Creates an empty input line with a history, the oldest line first.
    pub fn new(history: Vec<String>) -> Self {
        Self {
            shown_index: history.len(),
            history,
            ..Self::default()
        }
    }

    /// Handles a key and returns its effect.
    pub fn press_key(&mut self, key: KeyEvent) -> PromptEvent {
        if key.kind == KeyEventKind::Release {
            return PromptEvent::Edited;
        }
        let is_control = key.modifiers.contains(KeyModifiers::CONTROL);
        match (key.code, is_control) {
            (KeyCode::Char('c'), true) => return PromptEvent::Leave,
            (KeyCode::Char('d'), true) if self.text().is_empty() => return PromptEvent::Leave,
            (KeyCode::Char('d'), true) => {
                self.input.handle(tui_input::InputRequest::DeleteNextChar);
            }
            (KeyCode::Char('z'), true) => return PromptEvent::Suspend,
            (KeyCode::Up, _) | (KeyCode::Char('p'), true) => {
                self.go_to_entry(self.shown_index.saturating_sub(1))
            }
            (KeyCode::Down, _) | (KeyCode::Char('n'), true) => {
                self.go_to_entry(self.shown_index + 1)
            }
            (KeyCode::Esc, _) => return PromptEvent::Line("stop".to_owned()),
            (KeyCode::Enter, _) | (KeyCode::Char('j' | 'm'), true) => return self.enter(),
            _ => {
                self.input.handle_event(&Event::Key(key));
            }
        }
        PromptEvent::Edited
    }

    /// Handles pasted text; each line end acts like Enter. Most terminals paste CR for a line end, some LF or both.
    pub fn paste(&mut self, text: &str) -> Vec<PromptEvent> {
        let mut events = Vec::new();
        for character in text.replace("\r\n", "\n").chars() {
            match character {
                '\r' | '\n' => events.push(self.enter()),
                character if character.is_control() => {}
                character => {
                    self.input
                        .handle(tui_input::InputRequest::InsertChar(character));
                }
            }
        }
        events
    }

    fn enter(&mut self) -> PromptEvent {
        let line = self.input.value_and_reset().trim().to_owned();
        if !line.is_empty() && self.history.last() != Some(&line) {
            self.history.push(line.clone());
            let surplus = self.history.len().saturating_sub(MAX_HISTORY_LINES);
            self.history.drain(..surplus);
        }
        self.shown_index = self.history.len();
        self.draft.clear();
        match line.as_str() {
            "" => PromptEvent::Edited,
            line if is_quit(line) => PromptEvent::Leave,
            _ => PromptEvent::Line(line),
        }
    }

    fn go_to_entry(&mut self, index: usize) {
        let end = self.history.len();
        let index = index.min(end);
        if index == self.shown_index {
            return;
        }
        if self.shown_index == end {
            self.draft = self.text().to_owned();
        }
        self.shown_index = index;
        let line = self.history.get(index).unwrap_or(&self.draft);
        self.input = Input::new(line.clone());
    }

    /// Returns the text typed so far.
    pub fn text(&self) -> &str {
        self.input.value()
    }

    /// Returns the part of the text that fits in `width` columns, and the cursor's column in it.
    pub fn view(&self, width: usize) -> (String, usize) {
        let first_column = self.input.visual_scroll(width.max(1));
        let visible = self.text().chars().skip(first_column).take(width).collect();
        (
            visible,
            self.input.visual_cursor().saturating_sub(first_column),
        )
    }

    /// Returns the history, the oldest line first.
    pub fn history(&self) -> &[String] {
        &self.history
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn press(prompt: &mut Prompt, code: KeyCode) -> PromptEvent {
        prompt.press_key(KeyEvent::new(code, KeyModifiers::NONE))
    }

    fn press_control(prompt: &mut Prompt, character: char) -> PromptEvent {
        prompt.press_key(KeyEvent::new(
            KeyCode::Char(character),
            KeyModifiers::CONTROL,
        ))
    }

    fn type_line(prompt: &mut Prompt, text: &str) -> PromptEvent {
        for c in text.chars() {
            press(prompt, KeyCode::Char(c));
        }
        press(prompt, KeyCode::Enter)
    }

    #[test]
    fn a_line_can_be_edited_in_its_middle() {
        let mut prompt = Prompt::default();
        for c in "wal 5".chars() {
            press(&mut prompt, KeyCode::Char(c));
        }
        press(&mut prompt, KeyCode::Backspace);
        press(&mut prompt, KeyCode::Left);
        press(&mut prompt, KeyCode::Char('k'));
        assert_eq!(prompt.view(20), ("walk ".to_owned(), 4));
        assert_eq!(
            press(&mut prompt, KeyCode::Enter),
            PromptEvent::Line("walk".to_owned())
        );
        assert_eq!(prompt.text(), "");
    }

    #[test]
    fn arrows_recall_older_lines_and_the_draft() {
        let mut prompt = Prompt::new(vec!["stand".to_owned()]);
        type_line(&mut prompt, "walk");
        type_line(&mut prompt, "walk");
        press(&mut prompt, KeyCode::Char('s'));
        let mut shown_lines = Vec::new();
        for code in [[KeyCode::Up; 3], [KeyCode::Down; 3]].concat() {
            press(&mut prompt, code);
            shown_lines.push(prompt.text().to_owned());
        }
        assert_eq!(shown_lines, ["walk", "stand", "stand", "walk", "s", "s"]);
        assert_eq!(
            prompt.history(),
            ["stand", "walk"],
            "a repeated line is kept once"
        );
    }

    #[test]
    fn escape_sends_stop_and_keeps_the_typed_text() {
        let mut prompt = Prompt::default();
        prompt.paste("wal");
        let stop_event = PromptEvent::Line("stop".to_owned());
        assert_eq!(press(&mut prompt, KeyCode::Esc), stop_event);
        assert_eq!(prompt.text(), "wal");
    }

    #[test]
    fn control_c_control_d_and_quit_leave() {
        let mut prompt = Prompt::default();
        assert_eq!(press_control(&mut prompt, 'c'), PromptEvent::Leave);
        assert_eq!(press_control(&mut prompt, 'd'), PromptEvent::Leave);
        assert_eq!(type_line(&mut prompt, "quit"), PromptEvent::Leave);
        press(&mut prompt, KeyCode::Char('x'));
        press(&mut prompt, KeyCode::Home);
        assert_eq!(
            press_control(&mut prompt, 'd'),
            PromptEvent::Edited,
            "Ctrl-D deletes the next character"
        );
        assert_eq!(prompt.text(), "");
        assert_eq!(press(&mut prompt, KeyCode::Enter), PromptEvent::Edited);
    }

    #[test]
    fn pasted_lines_are_sent_one_by_one() {
        for line_end in ["\r", "\n", "\r\n"] {
            let mut prompt = Prompt::default();
            let events = prompt.paste(&["walk", "speed 50", "st"].join(line_end));
            let lines = ["walk", "speed 50"].map(|line| PromptEvent::Line(line.to_owned()));
            assert_eq!(events, lines, "{line_end:?}");
            assert_eq!(prompt.text(), "st");
        }
    }

    #[test]
    fn a_long_line_scrolls_with_its_cursor() {
        let mut prompt = Prompt::default();
        prompt.paste("0123456789");
        let (shown, cursor) = prompt.view(6);
        assert!(shown.ends_with('9') && cursor <= 6, "{shown} {cursor}");
    }
}
