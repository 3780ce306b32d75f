//! An Arduino UNO for tests: an ATmega328P at 16 MHz on libsimavr, with an
//! oscilloscope on its pins and a sender on its serial line.
//!
//! A firmware cannot be tested on the machine that compiles it, and a board on
//! the desk has no cycle counter, no way to see its stack, and takes ten
//! minutes for ten minutes. Here time is a number of CPU cycles that passes as
//! fast as the host can go, and the same firmware with the same input gives the
//! same edges to the cycle. Only [`Port`] keeps real time, for programs that
//! expect a board on USB.
//!
//! ```no_run
//! use simulated_uno::{Fidelity, Pin, Uno};
//! let mut uno = Uno::load("firmware.elf", Fidelity::DataSheet)?;
//! uno.run_ms(500);
//! uno.send(b"walk\n");
//! uno.run_ms(2000);
//! for pulse in uno.pulses(Pin::d(9)) {
//!     println!("{} {}", pulse.start, pulse.width);
//! }
//! # Ok::<(), simulated_uno::LoadError>(())
//! ```
//!
//! Several [`Uno`]s may run at once on as many threads: libsimavr keeps no
//! state outside an instance but the logger, which is set once.

mod adc;
mod boot;
mod disturb;
mod eeprom;
mod ffi;
mod image;
mod pin;
#[cfg(target_os = "linux")]
mod port;
#[cfg(target_os = "linux")]
mod pty;
mod reset;
mod supply;
mod traces;
mod uno;

pub use eeprom::{EEPROM_SIZE, EepromMode, EepromOperation, PowerCut};
pub use image::{FLASH_SIZE, Image, LoadError, SRAM_END, SRAM_START, Symbol};
pub use pin::{Edge, Pin, Pulse, most_pins_high, pulses};
#[cfg(target_os = "linux")]
pub use port::{Background, Port};
pub use reset::{Reset, ResetCause};
pub use traces::{Call, Mark, SerialByte, VectorUse, vector_name};
pub use uno::{Fidelity, State, Uno};

/// CPU cycles in a second.
pub const FREQUENCY: u64 = 16_000_000;
/// CPU cycles in a millisecond.
pub const CYCLES_PER_MS: u64 = FREQUENCY / 1000;
/// CPU cycles in a microsecond.
pub const CYCLES_PER_US: u64 = FREQUENCY / 1_000_000;
