//! The steps of a scenario, and their descriptions in words.

use std::fmt;

use simulated_uno::{CYCLES_PER_MS, CYCLES_PER_US, RadioLink};

/// One step of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Sends a line and waits a limited time for its answer.
    Say(String),
    /// Sends a line without waiting for its answer.
    Send(String),
    /// Like `Say`; if the line is refused because the servos rest, also sends `stand`.
    SayOrStand(String),
    /// Lets this many cycles pass.
    Wait(u64),
    /// Stalls the main loop for this many cycles, or until a reset.
    Stall(u64),
    /// Blocks interrupts for this many cycles.
    BlockInterrupts(u64),
    /// Pulls the RESET pin low for an instant.
    Reset,
    /// Cuts the power and restores it.
    PowerCycle,
    /// Sets the supply voltage, mV.
    Supply(u16),
    /// Connects a weak supply (true), which falls to 2.4 V whenever three servos have pulses, or a good supply (false).
    WeakSupply(bool),
    /// Lets a person begin to drive by radio. The scenario's own lines are then sent by cable.
    Drive(RadioLink),
    /// Ends the drive: the person leaves with the phone.
    Leave,
    /// Closes (true) or opens (false) the contact at the pin with this Arduino number.
    Contact(u8, bool),
    /// Sends `status` repeatedly until the robot answers. The robot may first have to find the sender's baud rate.
    AskUntilAnswered,
    /// Sends random bytes on the serial line, at most as many as the line can carry in this number of cycles.
    Noise(u64),
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Say(line) => write!(f, "say {line}"),
            Self::Send(line) => write!(f, "send {line} and do not wait"),
            Self::SayOrStand(line) => write!(f, "say {line}; if the robot rests, say stand"),
            Self::Wait(cycles) => write!(f, "wait {}", format_time(*cycles)),
            Self::Stall(cycles) => write!(f, "stall the main loop for {}", format_time(*cycles)),
            Self::BlockInterrupts(cycles) => {
                write!(f, "block interrupts for {}", format_time(*cycles))
            }
            Self::Reset => write!(f, "pull RESET"),
            Self::PowerCycle => write!(f, "cut the power and restore it"),
            Self::Supply(mv) => write!(f, "supply {mv} mV"),
            Self::WeakSupply(true) => write!(f, "supply 2400 mV whenever three servos have pulses"),
            Self::Drive(link) => write!(
                f,
                "a person drives by radio at {} baud: {:.0} % packet loss, {}{}",
                link.baud,
                100.0 * link.packet_loss,
                match link.mean_link_ms {
                    0 => "a link that never ends".to_owned(),
                    ms => format!("links of {ms} ms on average"),
                },
                match link.reports_link {
                    true => ", the module reports the link",
                    false => "",
                }
            ),
            Self::Contact(pin, true) => write!(f, "the contact at pin {pin} closes"),
            Self::Contact(pin, false) => write!(f, "the contact at pin {pin} opens"),
            Self::AskUntilAnswered => write!(f, "ask for the status until there is an answer"),
            Self::Leave => write!(f, "the person leaves with the phone"),
            Self::Noise(cycles) => {
                write!(f, "noise on the serial line for {}", format_time(*cycles))
            }
            Self::WeakSupply(false) => write!(f, "connect a good supply again"),
        }
    }
}

/// Formats a number of cycles as a time, followed by the number of cycles unless the time is a whole number of
/// milliseconds.
fn format_time(cycles: u64) -> String {
    if cycles.is_multiple_of(CYCLES_PER_MS) {
        format!("{} ms", cycles / CYCLES_PER_MS)
    } else if cycles < 10 * CYCLES_PER_MS {
        let us = cycles as f64 / CYCLES_PER_US as f64;
        format!("{us:.1} us ({cycles} cycles)")
    } else {
        let ms = cycles as f64 / CYCLES_PER_MS as f64;
        format!("{ms:.3} ms ({cycles} cycles)")
    }
}
