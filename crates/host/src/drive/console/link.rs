//! A line-based connection to the robot over any stream of bytes.
//!
//! A reply may have several lines, the board may be reset or unplugged, and the port may belong to another device.
//! After each line, the link therefore waits for the first line that does not begin with `#`, and collects the `#`
//! lines before it. If no answer arrives in time, the request fails with [`LinkError::NoAnswer`].

use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::time::Duration;

use lizard_calibrate::{Console, ConsoleError, Reply, ReplyError};
use pollster::block_on;

use crate::drive::clock::Deadline;

/// The beginning of the robot's first line after a reset.
pub const BANNER_START: &str = "# lizard ";
/// Largest number of `status` lines sent to a board that was not reset: its autobaud needs up to five lines to find the
/// port's baud rate, and a radio may lose some.
const MAX_STATUS_LINES: u32 = 8;

/// The beginning of an answer to `status`.
const STATUS_ANSWER_START: &str = "ok gait=";
/// Length to which a received line is truncated. The firmware's lines are shorter, but noise may contain no line end.
const MAX_LINE_BYTES: usize = 512;

/// The cause of a missing or unusable answer.
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// The port is gone.
    #[error("the port is gone: the board was unplugged, or its cable is loose")]
    Gone,
    /// The robot has not answered this line.
    #[error("the robot does not answer `{0}`")]
    NoAnswer(String),
    /// The device sends lines, but is not a lizard; the field is its first line.
    #[error(
        "this is not a lizard: expected `# lizard ...`, got `{0}`; check the port, and flash the \
         board if necessary (lizard flash)"
    )]
    OtherDevice(String),
    /// The device sends nothing at all: neither a banner nor an answer.
    #[error(
        "no response: no banner and no answer to `status`; check the port, and flash the board \
         if necessary (lizard flash)"
    )]
    NoOutput,
    /// The robot refuses a line, or its answer is not understood.
    #[error(transparent)]
    Reply(#[from] ReplyError),
    /// An error of the operating system.
    #[error("{0}")]
    Io(io::Error),
}

impl From<ConsoleError<LinkError>> for LinkError {
    fn from(error: ConsoleError<LinkError>) -> Self {
        match error {
            ConsoleError::Reply(reply) => reply.into(),
            ConsoleError::Link(error) => error,
        }
    }
}

/// A connection to a robot. A read from `port` must end within a few milliseconds, with [`ErrorKind::TimedOut`] if
/// nothing has arrived.
#[derive(Debug)]
pub struct Link<P> {
    port: P,
    /// Time for the banner after the port was opened. A UNO's boot loader takes more than a second of this time.
    banner_timeout: Duration,
    /// Time for an answer. `save` takes longest, a third of a second.
    answer_timeout: Duration,
    /// The partial line at the end of the received bytes.
    partial_line: Vec<u8>,
    /// The complete, unread lines.
    lines: VecDeque<String>,
}

impl<P: Read + Write> Link<P> {
    /// Creates a connection over an open port.
    pub fn new(port: P) -> Self {
        Self {
            port,
            banner_timeout: Duration::from_millis(3000),
            answer_timeout: Duration::from_millis(2000),
            partial_line: Vec::new(),
            lines: VecDeque::new(),
        }
    }

    /// Waits for the banner and returns it. A board that was not reset when the port was opened sends no banner. It
    /// gets `status` lines until its autobaud has found the port's baud rate and it answers; the result is then `None`.
    ///
    /// # Errors
    /// Fails if nothing answers, or if another device answers.
    pub fn wait_for_robot(&mut self) -> Result<Option<String>, LinkError> {
        let mut deadline = Deadline::after(self.banner_timeout);
        let mut first_line = None;
        while let Some(line) = self.read_line_before(&mut deadline)? {
            if line.starts_with(BANNER_START) {
                return Ok(Some(line));
            }
            first_line = first_line.or(Some(line));
        }
        for _ in 0..MAX_STATUS_LINES {
            let mut deadline = Deadline::after(self.answer_timeout / 4);
            self.send("status")?;
            while let Some(line) = self.read_line_before(&mut deadline)? {
                if line.starts_with(STATUS_ANSWER_START) {
                    return Ok(None);
                }
                first_line = first_line.or(Some(line));
            }
        }
        Err(first_line.map_or(LinkError::NoOutput, LinkError::OtherDevice))
    }

    /// Sends a line without waiting for its answer.
    ///
    /// # Errors
    /// Fails if the port is gone.
    pub fn send(&mut self, line: &str) -> Result<(), LinkError> {
        let sent = self.port.write_all(format!("{line}\n").as_bytes());
        sent.and_then(|()| self.port.flush()).map_err(to_link_error)
    }

    /// Sends a line and waits for its answer: the first line that does not begin with `#`.
    ///
    /// # Errors
    /// Fails if there is no answer, or the port is gone.
    pub fn ask(&mut self, line: &str) -> Result<Reply, LinkError> {
        self.send(line)?;
        let mut deadline = Deadline::after(self.answer_timeout);
        let mut notes = Vec::new();
        while let Some(answer) = self.read_line_before(&mut deadline)? {
            if !answer.starts_with('#') {
                return Ok(Reply { notes, answer });
            }
            notes.push(answer);
        }
        Err(LinkError::NoAnswer(line.to_owned()))
    }

    /// Sends a line that must be accepted; returns the answer and the `#` lines before it.
    ///
    /// # Errors
    /// Fails like [`Link::ask`], or if the robot refuses the line.
    pub fn command(&mut self, line: &str) -> Result<Reply, LinkError> {
        block_on(lizard_calibrate::send_command(self, line)).map_err(LinkError::from)
    }

    /// Waits up to `timeout` for the next line; returns `None` if none arrives.
    ///
    /// # Errors
    /// Fails if the port is gone.
    pub fn read_line(&mut self, timeout: Duration) -> Result<Option<String>, LinkError> {
        self.read_line_before(&mut Deadline::after(timeout))
    }

    /// Waits for `duration` and discards the lines that arrive in the meantime.
    ///
    /// # Errors
    /// Fails if the port is gone.
    pub fn pause(&mut self, duration: Duration) -> Result<(), LinkError> {
        let mut deadline = Deadline::after(duration);
        while self.read_line_before(&mut deadline)?.is_some() {}
        Ok(())
    }

    /// Returns the port, for tests.
    #[cfg(test)]
    pub fn port(&mut self) -> &mut P {
        &mut self.port
    }

    fn read_line_before(&mut self, deadline: &mut Deadline) -> Result<Option<String>, LinkError> {
        loop {
            if let Some(line) = self.lines.pop_front() {
                return Ok(Some(line));
            }
            self.receive_bytes()?;
            if deadline.has_passed() && self.lines.is_empty() {
                return Ok(None);
            }
        }
    }

    fn receive_bytes(&mut self) -> Result<(), LinkError> {
        let mut bytes = [0; 256];
        match self.port.read(&mut bytes) {
            Ok(0) => Err(LinkError::Gone),
            Ok(count) => {
                for byte in &bytes[..count] {
                    self.push_byte(*byte);
                }
                Ok(())
            }
            Err(error) => match error.kind() {
                ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted => Ok(()),
                _ => Err(to_link_error(error)),
            },
        }
    }

    fn push_byte(&mut self, byte: u8) {
        if byte != b'\n' {
            if self.partial_line.len() < MAX_LINE_BYTES {
                self.partial_line.push(byte);
            }
            return;
        }
        let bytes = std::mem::take(&mut self.partial_line);
        let text = String::from_utf8_lossy(&bytes);
        let text = text.trim_end_matches('\r');
        // A reset cuts off the board's current line, and the banner follows directly. The partial line is discarded.
        let text = &text[text.find(BANNER_START).unwrap_or(0)..];
        if !text.is_empty() {
            // Control characters are replaced because a terminal would interpret them.
            let replace_control = |c: char| if c.is_control() { '\u{fffd}' } else { c };
            self.lines
                .push_back(text.chars().map(replace_control).collect());
        }
    }
}

impl<P: Read + Write> Console for Link<P> {
    type Error = LinkError;

    async fn ask(&mut self, line: &str) -> Result<Reply, LinkError> {
        Self::ask(self, line)
    }

    async fn pause(&mut self, duration: Duration) -> Result<(), LinkError> {
        Self::pause(self, duration)
    }
}

/// Converts an operating system error, which for an open port nearly always means that the port is gone.
fn to_link_error(error: io::Error) -> LinkError {
    match is_port_gone(&error) {
        true => LinkError::Gone,
        false => LinkError::Io(error),
    }
}

/// True if an operating system error means that the board was unplugged.
pub(crate) fn is_port_gone(error: &io::Error) -> bool {
    // Linux returns EIO, ENXIO or ENODEV for a USB port whose board was unplugged. Windows returns ERROR_ACCESS_DENIED,
    // ERROR_INVALID_HANDLE, ERROR_BAD_COMMAND, ERROR_GEN_FAILURE, ERROR_NO_SUCH_DEVICE, ERROR_OPERATION_ABORTED or
    // ERROR_DEVICE_NOT_CONNECTED.
    let code = error.raw_os_error();
    matches!(code, Some(5 | 6 | 19))
        || cfg!(windows) && matches!(code, Some(22 | 31 | 433 | 995 | 1167))
        || matches!(
            error.kind(),
            ErrorKind::BrokenPipe
                | ErrorKind::NotConnected
                | ErrorKind::NotFound
                | ErrorKind::UnexpectedEof
                | ErrorKind::ConnectionAborted
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A port with scripted output: each write releases the next piece, and at `None` the port is gone.
    struct ScriptedPort {
        pieces: VecDeque<Option<&'static str>>,
        ready_bytes: VecDeque<u8>,
        is_gone: bool,
        sent_text: String,
    }

    impl ScriptedPort {
        fn connect(pieces: &[Option<&'static str>]) -> Link<Self> {
            let mut port = Self {
                pieces: pieces.iter().copied().collect(),
                ready_bytes: VecDeque::new(),
                is_gone: false,
                sent_text: String::new(),
            };
            port.release_piece();
            let timeout = Duration::from_millis(20);
            Link {
                banner_timeout: timeout,
                answer_timeout: timeout,
                ..Link::new(port)
            }
        }

        /// Connects to a lizard, whose banner precedes the pieces, and reads the banner.
        fn connect_lizard(pieces: &[Option<&'static str>]) -> Link<Self> {
            let mut link = Self::connect(&[&[Some(BANNER_LINE)][..], pieces].concat());
            link.wait_for_robot().expect("the device is a lizard");
            link
        }

        fn release_piece(&mut self) {
            match self.pieces.pop_front() {
                Some(Some(piece)) => self.ready_bytes.extend(piece.bytes()),
                Some(None) => self.is_gone = true,
                None => {}
            }
        }
    }

    impl Read for ScriptedPort {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            if self.ready_bytes.is_empty() {
                if self.is_gone {
                    return Err(io::Error::from_raw_os_error(5));
                }
                return Err(ErrorKind::TimedOut.into());
            }
            // Returns small pieces, like a serial port.
            let count = buffer.len().min(3);
            self.ready_bytes.read(&mut buffer[..count])
        }
    }

    impl Write for ScriptedPort {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.sent_text.push_str(&String::from_utf8_lossy(bytes));
            self.release_piece();
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    const BANNER_LINE: &str = "# lizard 0.2.0 robot paper 1a2b3c4d, send help for the commands\r\n";

    #[test]
    fn a_banner_after_noise_or_a_partial_line_is_found() {
        let noise = "\u{fffd}\x00x\n# t=7 po\r\n";
        for prefix in ["", "ok wal", "# t=12 pose=138.5", "\u{fffd}x", noise] {
            let bytes: &'static str = format!("{prefix}# lizard 0.2.0 robot paper 1a\r\n").leak();
            let mut link = ScriptedPort::connect(&[Some(bytes)]);
            let banner = link.wait_for_robot().expect("the device is a lizard");
            let expected = Some("# lizard 0.2.0 robot paper 1a");
            assert_eq!(banner.as_deref(), expected, "{prefix:?}");
        }
    }

    #[test]
    fn a_board_that_was_not_reset_is_recognised_by_its_status() {
        let mut link =
            ScriptedPort::connect(&[Some(""), Some("# t=1 pose=1\r\nok gait=stand phase=0\r\n")]);
        assert_eq!(link.wait_for_robot().expect("the device is a lizard"), None);
        assert_eq!(link.port.sent_text, "status\n");
    }

    #[test]
    fn the_error_quotes_another_device_or_reports_silence() {
        let connect_error = |pieces: &[Option<&'static str>]| {
            let result = ScriptedPort::connect(pieces).wait_for_robot();
            result.expect_err("the device must be refused").to_string()
        };
        let message = connect_error(&[Some("start\nGrbl 1.1\n"), Some("error:20\n")]);
        let start = "this is not a lizard: expected `# lizard ...`, got `start`";
        assert!(message.starts_with(start), "{message}");
        assert!(connect_error(&[]).starts_with("no response"));
    }

    #[test]
    fn the_answer_is_the_first_line_that_is_not_a_note() {
        let answer = Some("# boot stand\r\n# deadman 0\r\nok cal\r\n");
        let mut link = ScriptedPort::connect_lizard(&[answer]);
        let reply = link.ask("cal").expect("the robot answers");
        assert_eq!(reply.notes, ["# boot stand", "# deadman 0"]);
        assert_eq!(reply.answer, "ok cal");
    }

    #[test]
    fn the_refusal_names_the_line_and_the_reason() {
        let answer = Some("err 3 trim must be -20..20\r\n");
        let result = ScriptedPort::connect_lizard(&[answer]).command("trim 1 50");
        let message = result.expect_err("the trim must be refused").to_string();
        let expected = "the robot refuses `trim 1 50`: err 3 trim must be -20..20";
        assert_eq!(message, expected);
    }

    #[test]
    fn silence_and_a_missing_port_are_different_errors() {
        let mut link = ScriptedPort::connect_lizard(&[Some("# a note\r\n"), None]);
        assert!(matches!(link.ask("walk"), Err(LinkError::NoAnswer(line)) if line == "walk"));
        assert!(matches!(link.ask("walk"), Err(LinkError::Gone)));
    }

    #[test]
    fn an_endless_line_is_truncated_and_control_characters_are_replaced() {
        let mut link = ScriptedPort::connect(&[]);
        for byte in ("a".repeat(2000) + "\n\x1b[2Jhi\r\n\r\n\n").bytes() {
            link.push_byte(byte);
        }
        assert_eq!(link.lines[0].len(), MAX_LINE_BYTES);
        assert_eq!(link.lines[1], "\u{fffd}[2Jhi");
        assert_eq!(link.lines.len(), 2, "empty lines are dropped");
    }
}
