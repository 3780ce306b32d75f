//! The Arduino UNO board: the only code that knows registers, pins and interrupts.
//!
//! An Arduino UNO has one processor for everything, and the servos react to every cycle
//! by which an edge is late. So the interrupts do as little as the hardware allows and
//! follow fixed rules:
//!
//! - [`pulses`] owns Timer1 and the four servo pins, and is the robot's clock:
//!   a tick every 20 ms.
//! - [`serial`] owns the USART and its two rings.
//! - [`led`] owns D13.
//! - [`input`] reads the contacts that routines wait for.
//! - [`eeprom`] owns the EEPROM; [`supply`] owns the analogue-to-digital converter.
//! - [`watchdog`] restarts the program when it hangs; [`kept`] carries the servos' state from
//!   one run to the next; [`stack`] protects the data from the stack.
//! - [`sleep`] stops the processor until a tick, a received byte or an empty send buffer.
//!
//! Main never switches interrupts off for more than the few cycles that `sleep`, a 16-bit
//! load and the beginning of an EEPROM write take. It shares only single bytes with an
//! interrupt, and each byte has one writer. Interrupts do not nest. Of the interrupts in
//! use, Timer1's come first in the vector table. INT0, INT1, PCINT, TIMER2 and
//! TIMER1_CAPT would come before them, so do not use them. WDT fires only if the program
//! hangs, and its handler does not return.

pub mod eeprom;
mod input;
mod kept;
pub mod led;
pub mod pulses;
pub mod serial;
pub mod sleep;
mod stack;
pub mod supply;
mod watchdog;

use avr_device::atmega328p::Peripherals;
use lizard_core::console::answer::Counters;
use lizard_core::control::supply::Reading;
use lizard_core::memory::restart::{Restart, Stance};
use lizard_core::numbers::pose::Pulses;
use lizard_core::numbers::rate::BaudRate;
use lizard_core::step::Board;

/// An Arduino UNO whose peripherals have been started.
pub struct Uno {
    writer: serial::Writer,
    eeprom: eeprom::Eeprom,
    converter: supply::Converter,
    restart: Restart,
}

impl Uno {
    /// Starts the serial port, the LED, the clock and, once widths are submitted,
    /// the pulses; then enables interrupts. Call it once, at the start of main.
    ///
    /// The first tick comes 4 ms later. All servo pins are low until the first
    /// [`Board::submit`].
    pub fn start() -> Self {
        // SAFETY: nothing has run before this except the boot loader; each peripheral
        // goes to the one module that owns it.
        let peripherals = unsafe { Peripherals::steal() };
        // The servos' pins are not known yet, so no pin may stay high.
        // SAFETY: any value of a port is sound; D0 and D1, the serial line, keep theirs.
        unsafe {
            peripherals.PORTB.portb.write(|w| w.bits(0));
            peripherals.PORTC.portc.write(|w| w.bits(0));
            peripherals
                .PORTD
                .portd
                .modify(|port, w| w.bits(port.bits() & 0x03));
        }
        let restart = kept::start(&peripherals.CPU);
        stack::start();
        led::start();
        sleep::start(peripherals.CPU);
        serial::start(peripherals.USART0, restart.rate);
        // SAFETY: interrupts are off, and nothing else here uses Timer1 or the servos' pins.
        unsafe { pulses::start() };
        watchdog::start();
        // SAFETY: every interrupt that is enabled above has its handler, and no critical section surrounds this
        // call.
        unsafe { avr_device::interrupt::enable() };
        Self {
            writer: serial::Writer,
            eeprom: eeprom::Eeprom::new(peripherals.EEPROM),
            converter: supply::Converter::new(peripherals.ADC),
            restart,
        }
    }
}

impl Board for Uno {
    type Writer = serial::Writer;
    type Memory = eeprom::Eeprom;

    const WRITER_CAPACITY: u8 = serial::SEND_CAPACITY;
    const CYCLES_PER_US: u16 = servo_pulses::CYCLES_PER_US;

    #[inline(always)]
    fn connect(&mut self, servos: [u8; 4], rail: Option<u8>) {
        pulses::connect_numbers(servos);
        self.converter.connect(rail);
    }

    #[inline(always)]
    fn ticks(&self) -> u8 {
        pulses::ticks()
    }

    #[inline(always)]
    fn is_frame_taken(&self) -> bool {
        pulses::is_taken()
    }

    #[inline(always)]
    fn submit(&mut self, pulses: Pulses) {
        pulses::submit(pulses.0);
    }

    #[inline(always)]
    fn feed_watchdog(&mut self) {
        watchdog::feed();
    }

    #[inline(always)]
    fn store_stance(&mut self, stance: &Stance, brown_outs: u8) {
        kept::store_stance(stance, brown_outs);
    }

    #[inline(always)]
    fn last_restart(&self) -> &Restart {
        &self.restart
    }

    #[inline(always)]
    fn read_supply(&mut self) -> Reading {
        self.converter.advance()
    }

    #[inline(always)]
    fn is_stack_intact(&self) -> bool {
        stack::is_intact()
    }

    #[inline(always)]
    fn is_contact_closed(&mut self, pin: u8) -> bool {
        input::is_closed(pin)
    }

    #[inline(always)]
    fn memory(&mut self) -> &mut eeprom::Eeprom {
        &mut self.eeprom
    }

    #[inline(always)]
    fn set_led(&mut self, is_on: bool) {
        led::set(is_on);
    }

    #[inline(always)]
    fn room(&self) -> u8 {
        serial::room()
    }

    #[inline(always)]
    fn writer(&mut self) -> &mut serial::Writer {
        &mut self.writer
    }

    #[inline(always)]
    fn receive(&mut self) -> Option<u8> {
        serial::read()
    }

    #[inline(always)]
    fn set_rate(&mut self, rate: BaudRate) {
        serial::set_rate(rate);
        kept::store_rate(rate);
    }

    #[inline(always)]
    fn counters(&self) -> Counters {
        Counters {
            late_edges: pulses::late_edges(),
            rx_lost: serial::lost_count(),
        }
    }
}
