//! The firmware's core run on this machine beside the simulated chip.
//!
//! The core is plain integer Rust, so with the same bytes heard before the same
//! ticks it must ask for the same widths here as on the AVR, to the bit. What
//! the pins then do can be held against it: any difference is a fault of the
//! compiler, of the board's code or of the pulses.
//!
//! What has to be reconstructed is *when* main hears a byte: not before it is
//! complete at the UNO, and not while the serial line has no room for the
//! longest answer. That follows from the length of what has been said so far.

use std::collections::VecDeque;

use lizard::console::{Console, Counters, LONGEST_LINE};
use simulated_uno::SerialByte;

use super::frame::{FRAME, SLOT};

/// Cycles that the UNO takes to send a byte: 10 bits, 17 * 8 cycles each.
const BYTE: u64 = 1360;
/// What may be queued on the serial line while there is still room for the
/// longest answer: a ring of 255, and two bytes in the transmitter.
const QUEUED: u64 = 255 - LONGEST_LINE as u64 + 2;
/// The robot wakes within this many frames of power-on.
const WAKES: usize = 500;

/// The firmware's core with the bytes that it has yet to hear.
#[derive(Default)]
struct Twin {
    console: Console,
    inbox: VecDeque<u8>,
    said: String,
    /// Cycle at which all that it has said is through the line.
    line_free: u64,
}

impl Twin {
    /// The firmware's main loop, woken at a cycle, up to its tick.
    fn wake(&mut self, cycle: u64) {
        while self.line_free.saturating_sub(cycle) <= QUEUED * BYTE {
            if self.console.has_news() {
                let before = self.said.len();
                let Ok(()) = self.console.speak(&mut self.said, Counters::default());
                let length = (self.said.len() - before) as u64;
                self.line_free = self.line_free.max(cycle) + length * BYTE;
            } else if let Some(byte) = self.inbox.pop_front() {
                self.console.hear(byte);
            } else {
                break;
            }
        }
    }

    /// When bytes that wait for room are heard.
    fn retry(&self) -> Option<u64> {
        let waits = !self.inbox.is_empty();
        waits.then(|| self.line_free.saturating_sub(QUEUED * BYTE))
    }
}

/// What the core asks for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Commands {
    /// Widths in cycles, 0 for no pulse, of each frame from A1's first pulse on.
    pub widths: Vec<[u16; 4]>,
    /// All that it says, `late` and `rx_lost` left at 0.
    pub said: String,
}

/// Runs the core beside a recording: `heard` are the bytes that reached the UNO,
/// `first` is the cycle of A1's first pulse, `count` the number of frames from
/// there on. Exact unless a command becomes complete within some 50 us of a tick,
/// where it is a matter of cycles which of the two main sees first.
#[must_use]
pub fn play(heard: &[SerialByte], first: u64, count: usize) -> Commands {
    let silent = frames_before_waking();
    let mut twin = Twin::default();
    let mut heard = heard.iter().peekable();
    let mut widths = Vec::with_capacity(count);
    for frame in 0..silent + count {
        let start = first + frame as u64 * FRAME;
        // A tick comes a slot before the first pulse of the frame it begins.
        let tick = start.saturating_sub(silent as u64 * FRAME + SLOT);
        loop {
            let retry = twin.retry().filter(|retry| *retry < tick);
            let due = |byte: &&SerialByte| {
                byte.cycle < tick && retry.is_none_or(|retry| byte.cycle < retry)
            };
            if let Some(byte) = heard.next_if(due) {
                twin.inbox.push_back(byte.byte);
                twin.wake(byte.cycle);
            } else if let Some(retry) = retry {
                twin.wake(retry);
            } else {
                break;
            }
        }
        twin.wake(tick);
        let pulses = twin.console.frame().0;
        if frame >= silent {
            widths.push(pulses);
        }
    }
    Commands {
        widths,
        said: twin.said,
    }
}

/// Frames before A1's first pulse, if nobody says anything.
fn frames_before_waking() -> usize {
    let mut console = Console::new();
    (0..WAKES).take_while(|_| console.frame().0[0] == 0).count()
}
