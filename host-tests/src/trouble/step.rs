//! The steps of a scenario, in words.

use std::fmt;

use simulated_uno::{CYCLES_PER_MS, CYCLES_PER_US};

/// One step of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Sends a line and waits for its answer, for some time.
    Say(String),
    /// Sends a line and does not wait.
    Send(String),
    /// `walk`, and `stand` where `walk` is refused because the servos rest.
    Order(String),
    /// Lets this many cycles pass.
    Wait(u64),
    /// Main executes nothing for this many cycles, or until a reset.
    Stall(u64),
    /// Interrupts are held up for this many cycles.
    Hold(u64),
    /// The RESET pin is pulled.
    Reset,
    /// Power goes and comes back.
    PowerCycle,
    /// The supply has this many mV from now on.
    Supply(u16),
    /// The supply falls to 2.4 V whenever three servos have pulses, from now on; or no
    /// longer.
    Weak(bool),
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Say(line) => write!(f, "say {line}"),
            Self::Send(line) if line.is_empty() => write!(f, "send an empty line"),
            Self::Send(line) => write!(f, "send {line} and do not wait"),
            Self::Order(line) => write!(f, "say {line}; if it rests, say stand"),
            Self::Wait(cycles) => write!(f, "wait {}", Time(*cycles)),
            Self::Stall(cycles) => write!(f, "stall main for {}", Time(*cycles)),
            Self::Hold(cycles) => write!(f, "hold interrupts up for {}", Time(*cycles)),
            Self::Reset => write!(f, "pull RESET"),
            Self::PowerCycle => write!(f, "take the power away and give it back"),
            Self::Supply(mv) => write!(f, "supply {mv} mV"),
            Self::Weak(true) => write!(f, "supply 2400 mV whenever three servos have pulses"),
            Self::Weak(false) => write!(f, "a strong supply again"),
        }
    }
}

/// Cycles, to be read by a person and to be typed again exactly.
pub struct Time(pub u64);

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_multiple_of(CYCLES_PER_MS) {
            write!(f, "{} ms", self.0 / CYCLES_PER_MS)
        } else if self.0 < 10 * CYCLES_PER_MS {
            let us = self.0 as f64 / CYCLES_PER_US as f64;
            write!(f, "{us:.1} us ({} cycles)", self.0)
        } else {
            let ms = self.0 as f64 / CYCLES_PER_MS as f64;
            write!(f, "{ms:.3} ms ({} cycles)", self.0)
        }
    }
}
