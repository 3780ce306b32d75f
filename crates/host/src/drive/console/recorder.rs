//! The file of a recorded session: one JSON object per line, with its time in ms.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use lizard_robot::parse_pose_report;
use serde::{Deserialize, Serialize};

use crate::Failure;
#[cfg(feature = "simulator")]
use crate::shared::escape::escape_controls;
use crate::shared::{files, json};

/// The value of `format` in the first line. The number increases when a key changes its meaning.
pub const FORMAT: &str = "lizard record 1";

/// A line in the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TimedEvent {
    /// Milliseconds since the session began.
    pub ms: u64,
    /// The event at that time.
    #[serde(flatten)]
    pub event: Event,
}

/// An event of a session.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Event {
    /// The session began; always the first line.
    Begin {
        /// The file's format: [`FORMAT`].
        format: String,
        /// The board's port.
        port: String,
        /// The robot's first line; `None` if the board was not reset.
        banner: Option<String>,
    },
    /// A line that the user sent.
    Sent(String),
    /// The robot's answer to a user's line.
    Answer(String),
    /// A line from the robot that begins with `#`, except a pose.
    Note(String),
    /// The robot's answer to the program's own `status`.
    Status(String),
    /// A pose that the robot reports after `watch`.
    Pose {
        /// Frames since the board's program started, 50 per second.
        frame: u64,
        /// Servo angles A1 to A4 in the chassis frame, degrees.
        angles: [f64; 4],
    },
    /// The port has vanished.
    Gone,
}

/// A recorder that writes a session to a file.
#[derive(Debug)]
pub struct Recorder<W: Write> {
    /// The file's path for messages.
    path: PathBuf,
    out: W,
    start: Instant,
}

/// Creates a new file for a session.
///
/// # Errors
/// Fails if the file already exists, or cannot be created.
pub fn create(path: &Path) -> Result<Recorder<BufWriter<File>>, Failure> {
    let file = files::create_new(path, "choose another file for the session")?;
    let out = BufWriter::new(file);
    Ok(Recorder::new(path.to_owned(), out, Instant::now()))
}

impl<W: Write> Recorder<W> {
    /// Creates a recorder for a session that begins at `start`; `path` is the file's path for messages.
    pub fn new(path: PathBuf, out: W, start: Instant) -> Self {
        Self { path, out, start }
    }

    /// Writes an event. Flushes it to the file at once unless it is a pose.
    ///
    /// # Errors
    /// Fails if writing fails; the message names the file.
    pub fn write(&mut self, now: Instant, event: Event) -> Result<(), Failure> {
        let ms = now.saturating_duration_since(self.start).as_millis() as u64;
        let is_pose = matches!(event, Event::Pose { .. });
        json::write_line(&mut self.out, &TimedEvent { ms, event })
            .map_err(|error| files::write_failure(&self.path, &error))?;
        if is_pose { Ok(()) } else { self.flush() }
    }

    /// Flushes all lines to the file.
    ///
    /// # Errors
    /// Fails as [`Recorder::write`] does.
    pub fn flush(&mut self) -> Result<(), Failure> {
        let flushed = self.out.flush();
        flushed.map_err(|error| files::write_failure(&self.path, &error))
    }
}

impl Event {
    /// Converts a line that begins with `#` to an event: a pose or a note.
    pub fn from_note(line: &str) -> Self {
        match parse_pose_report(line) {
            Some((frame, angles)) => Self::Pose { frame, angles },
            None => Self::Note(line.to_owned()),
        }
    }

    /// Escapes control characters in the event's text, which would be unsafe on a terminal.
    #[cfg(feature = "simulator")]
    pub fn escape_controls(&mut self) {
        let texts: Vec<&mut String> = match self {
            Self::Begin {
                format,
                port,
                banner,
            } => [format, port].into_iter().chain(banner).collect(),
            Self::Sent(line) | Self::Answer(line) | Self::Note(line) | Self::Status(line) => {
                vec![line]
            }
            Self::Pose { .. } | Self::Gone => Vec::new(),
        };
        for text in texts {
            *text = escape_controls(text);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn each_event_is_one_line_of_json_with_its_time() {
        let start = Instant::now();
        let mut out = Vec::new();
        let mut recorder = Recorder::new("a".into(), &mut out, start);
        let events = [
            Event::Begin {
                format: FORMAT.to_owned(),
                port: "p".to_owned(),
                banner: None,
            },
            Event::Sent("walk".to_owned()),
            Event::from_note("# t=7 pose=1.00,2.00,3.00,4.50"),
            Event::from_note("# fault: x"),
            Event::Gone,
        ];
        for (index, event) in events.iter().enumerate() {
            let now = start + Duration::from_millis(20 * index as u64);
            recorder
                .write(now, event.clone())
                .expect("writing to a vector succeeds");
        }
        let text = String::from_utf8(out).expect("the output is UTF-8");
        assert_eq!(
            text,
            "{\"ms\":0,\"begin\":{\"format\":\"lizard record 1\",\"port\":\"p\",\"banner\":null}}\n\
             {\"ms\":20,\"sent\":\"walk\"}\n\
             {\"ms\":40,\"pose\":{\"frame\":7,\"angles\":[1.0,2.0,3.0,4.5]}}\n\
             {\"ms\":60,\"note\":\"# fault: x\"}\n\
             {\"ms\":80,\"gone\":null}\n"
        );
        let read_events: Vec<Event> = text
            .lines()
            .map(|line| {
                serde_json::from_str::<TimedEvent>(line)
                    .expect("the line is an event")
                    .event
            })
            .collect();
        assert_eq!(read_events, events);
    }

    #[test]
    fn create_refuses_an_existing_file() {
        let file = tempfile::NamedTempFile::new().expect("a temporary file can be created");
        let message = create(file.path())
            .expect_err("an existing file must be refused")
            .to_string();
        assert!(message.ends_with("already exists; choose another file for the session"));
    }

    #[test]
    fn a_write_error_names_the_file() {
        let small_buffer: &mut [u8] = &mut [0; 10];
        let mut recorder = Recorder::new("a.jsonl".into(), small_buffer, Instant::now());
        let event = Event::Sent("walk".to_owned());
        let message = recorder
            .write(Instant::now(), event)
            .expect_err("writing beyond the buffer must fail");
        let message = message.to_string();
        assert!(message.starts_with("cannot write a.jsonl: "), "{message}");
    }
}
