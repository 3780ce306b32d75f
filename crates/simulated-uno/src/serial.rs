//! The serial line: the bytes sent to the UNO and the bytes that it sends.

use crate::traces::SerialByte;
use crate::{FREQUENCY, Uno, ffi};

/// The largest baud rate that [`Uno::set_baud`] accepts.
pub(crate) const MAX_BAUD: f64 = 1e7;

impl Uno {
    /// The sender's default baud rate; [`Uno::set_baud`] changes it.
    pub const DEFAULT_BAUD: f64 = 115_200.0;

    /// Runs until the UNO has sent a complete line, for at most `max_cycles`. Returns false if the UNO has not sent a
    /// complete line by then, or if the firmware has stopped.
    pub fn run_until_line(&mut self, max_cycles: u64) -> bool {
        self.run_until_cycle_or_line(self.cycle() + max_cycles, true)
    }

    /// Queues bytes for the serial line. They are sent back to back at the baud rate, even if the firmware does not
    /// keep up.
    pub fn send(&mut self, bytes: &[u8]) {
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); the shim copies the bytes of the slice.
        unsafe { ffi::uno_send(self.raw, bytes.as_ptr(), bytes.len(), false) }
    }

    /// Sends a line with the line end `\n`, and returns the next complete line that the UNO sends, without its line
    /// end. `None` if the UNO sends no complete line within a second of the chip's time, or if the firmware has
    /// stopped.
    ///
    /// Removes all bytes that the UNO transmits before and during the call, as [`Uno::take_transmitted`] does. The rest
    /// of a line that the UNO has already begun counts as the answer. For firmware that sends lines on its own, use
    /// [`Uno::send`] and [`Uno::run_until_line`].
    pub fn say(&mut self, line: &str) -> Option<String> {
        self.take_transmitted();
        self.send(line.as_bytes());
        self.send(b"\n");
        if !self.run_until_line(FREQUENCY) {
            return None;
        }
        let bytes = self.take_transmitted();
        let bytes: Vec<u8> = bytes.iter().map(|byte| byte.value).collect();
        let text = String::from_utf8_lossy(&bytes);
        Some(text.trim_end_matches(['\r', '\n']).to_owned())
    }

    /// Queues bytes as [`Uno::send`] does, but with the line low during each stop bit, as after noise or a missed start
    /// bit. Each byte arrives with a framing error, FE0 in UCSR0A.
    pub fn send_with_framing_error(&mut self, bytes: &[u8]) {
        // SAFETY: as in `send`.
        unsafe { ffi::uno_send(self.raw, bytes.as_ptr(), bytes.len(), true) }
    }

    /// Saturates the serial line: sends `bytes` repeatedly whenever the queue is empty. An empty slice ends the
    /// flood.
    pub fn flood(&mut self, bytes: &[u8]) {
        // SAFETY: as in `send`.
        unsafe { ffi::uno_set_flood(self.raw, bytes.as_ptr(), bytes.len()) }
    }

    /// Changes the sender's baud rate, from the next byte on.
    ///
    /// # Panics
    /// If the rate is not between 1 and 10 million.
    pub fn set_baud(&mut self, baud: f64) {
        assert!(
            (1.0..=MAX_BAUD).contains(&baud),
            "the baud rate must be between 1 and 10 million, but is {baud}"
        );
        // SAFETY: `raw` is valid, and `self` owns it exclusively (see `Uno`); for a rate in this range, the cycles per
        // bit can be converted in C.
        unsafe { ffi::uno_set_baud(self.raw, baud) }
    }

    /// The current baud rate of the chip's USART, computed from its registers.
    #[must_use]
    pub fn chip_baud(&self) -> f64 {
        // SAFETY: `raw` is valid (see `Uno`); the shim reads registers.
        FREQUENCY as f64 / f64::from(unsafe { ffi::uno_cycles_per_bit(self.raw) })
    }

    /// The number of queued bytes that have not yet arrived at the UNO.
    #[must_use]
    pub fn unsent_byte_count(&self) -> usize {
        // SAFETY: `raw` is valid (see `Uno`); the shim reads a number.
        unsafe { ffi::uno_unsent_count(self.raw) }
    }

    /// The number of bytes sent to the UNO so far, including those of a flood.
    #[must_use]
    pub fn sent_byte_count(&self) -> u64 {
        // SAFETY: `raw` is valid (see `Uno`); the shim reads a number.
        unsafe { ffi::uno_sent_count(self.raw) }
    }

    /// The number of bytes lost because the firmware read UDR0 too late. Always 0 with
    /// [`Fidelity::Stock`](crate::Fidelity::Stock).
    #[must_use]
    pub fn overrun_count(&self) -> u64 {
        // SAFETY: `raw` is valid (see `Uno`); the shim reads a number.
        unsafe { ffi::uno_overrun_count(self.raw) }
    }

    /// The bytes transmitted by the UNO since power-on or the last [`Uno::take_transmitted`].
    #[must_use]
    pub fn transmitted(&self) -> Vec<SerialByte> {
        self.copy_items(ffi::uno_transmitted)
    }

    /// Removes and returns the bytes that the UNO has transmitted since power-on or the last call.
    pub fn take_transmitted(&mut self) -> Vec<SerialByte> {
        self.take_items(ffi::uno_transmitted)
    }

    /// Removes the bytes that the UNO has transmitted, and returns the bytes that a receiver with this baud rate reads.
    pub(crate) fn take_bytes_at(&mut self, baud: f64) -> Vec<u8> {
        let chip_baud = self.chip_baud();
        let sent_bytes = self.take_transmitted().into_iter();
        let read_bytes = sent_bytes.map(|sent| sample_byte(sent.value, chip_baud, baud));
        read_bytes.collect()
    }

    /// All bytes that have arrived at the UNO, including bytes lost by an overrun, each with the cycle at which it was
    /// complete. A byte with a framing error is 0xff.
    #[must_use]
    pub fn received_by_uno(&self) -> Vec<SerialByte> {
        self.copy_items(ffi::uno_received)
    }
}

/// Returns the byte that a receiver at `receiver_baud` reads if a sender at `sender_baud` sends `byte`.
pub(crate) fn sample_byte(byte: u8, sender_baud: f64, receiver_baud: f64) -> u8 {
    ffi::usart_sample_byte(byte, sender_baud / receiver_baud)
}
