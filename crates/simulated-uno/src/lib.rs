//! An Arduino UNO for tests: an ATmega328P at 16 MHz, simulated by libsimavr, with an oscilloscope on its pins and a
//! sender on its serial line.
//!
//! Firmware cannot run on the machine that compiles it, and a board on the desk has no cycle counter, does not show its
//! stack, and cannot run faster than real time. The simulation counts time in CPU cycles and runs as fast as the host
//! can compute. The same firmware with the same input always gives the same edges, to the cycle. Only [`Port`] runs in
//! real time, for programs that expect a board on USB.
//!
//! The package is not suitable for chips other than the ATmega328P, for firmware that depends on hardware PWM, SPI, TWI
//! or the analogue comparator, or for measurements of currents and noise. README.md has the reasons.
//!
//! ```
//! use simulated_uno::{Fidelity, Pin, Uno, avr_gcc};
//! let blink = avr_gcc::compile_c("
//!     #include <avr/io.h>
//!     int main(void) {
//!         DDRB = 1 << 5;
//!         for (;;) { PINB = 1 << 5; __builtin_avr_delay_cycles(15998); }
//!     }");
//! let mut uno = Uno::with_image(blink, Fidelity::DataSheet);
//! uno.run_ms(100);
//! for pulse in uno.pulses(Pin::d(13)) {
//!     assert!(pulse.width.abs_diff(16_000) <= 2, "{}", pulse.width);
//! }
//! ```
//!
//! README.md has more examples, and lists every correction of simavr with its section of the data sheet.
//! [`Uno::load`] loads compiled firmware from a file.
//!
//! Several [`Uno`]s may run at the same time on several threads: the only state that libsimavr keeps outside an
//! instance is the logger, which is set once.

#![allow(unsafe_code)] // for calls of C functions; the docs of `Uno` justify them

mod adc;
#[cfg(feature = "avr-gcc")]
pub mod avr_gcc;
mod boot_loader;
mod contact;
mod disturbance;
mod eeprom;
mod ffi;
#[cfg(feature = "hex")]
mod hex;
mod image;
mod pin;
#[cfg(target_os = "linux")]
mod port;
#[cfg(target_os = "linux")]
mod pty;
#[cfg(target_os = "linux")]
mod radio;
mod reset;
mod serial;
mod supply;
mod traces;
mod uno;
#[cfg(target_os = "linux")]
mod wire;

pub use eeprom::{EEPROM_SIZE, EepromMode, EepromOperation, PowerCut};
pub use image::{FLASH_SIZE, Image, LoadError, SRAM_END, SRAM_START, Symbol};
pub use pin::{Edge, Pin, Pulse, max_pins_high, pulses};
#[cfg(target_os = "linux")]
pub use port::{BackgroundPort, Port};
#[cfg(target_os = "linux")]
pub use radio::{Radio, RadioLink};
pub use reset::{ResetCause, ResetEvent};
pub use traces::{Call, Mark, SerialByte, VectorStats, vector_name};
pub use uno::{Fidelity, State, Uno};
#[cfg(target_os = "linux")]
pub use wire::Wire;

/// The examples of README.md, as tests.
#[cfg(all(doctest, feature = "avr-gcc"))]
#[doc = include_str!("../README.md")]
struct Readme;

/// The number of CPU cycles in a second.
pub const FREQUENCY: u64 = 16_000_000;
/// The number of CPU cycles in a millisecond.
pub const CYCLES_PER_MS: u64 = FREQUENCY / 1000;
/// The number of CPU cycles in a microsecond.
pub const CYCLES_PER_US: u64 = FREQUENCY / 1_000_000;
