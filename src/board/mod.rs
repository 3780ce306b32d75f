//! The Arduino UNO board, the only code that accesses registers, pins and interrupts.
//!
//! An Arduino UNO has one processor for all tasks, and the servos react to every cycle by which an edge is late.
//! Therefore the interrupt handlers are as short as possible and follow fixed rules:
//!
//! - [`pulses`] owns Timer1 and the four servo pins, and is the robot's clock, with a tick every 20 ms.
//! - [`serial`] owns the USART and two ring buffers.
//! - [`led`] owns D13.
//! - [`input`] reads the contacts for which routines wait.
//! - [`eeprom`] owns the EEPROM; [`supply`] owns the analogue-to-digital converter.
//! - [`watchdog`] restarts a program that hangs; [`retained_ram`] preserves the servo state across a reset; [`stack`]
//!   detects a stack that has grown into the data.
//! - [`sleep`] stops the processor until a tick, a received byte or an empty send buffer.
//!
//! Main switches interrupts off only for the few cycles of `sleep`, a 16-bit load and the start of an EEPROM write. It
//! shares only single bytes with an interrupt handler, and each byte has a single writer. Interrupts do not nest. Of
//! the interrupts in use, Timer1's have the highest priority. Do not use INT0, INT1, PCINT, TIMER2 and TIMER1_CAPT,
//! which would have a higher priority. WDT occurs only if the program hangs, and its handler does not return.

pub mod eeprom;
mod input;
pub mod led;
pub mod pulses;
mod retained_ram;
pub mod serial;
pub mod sleep;
mod stack;
pub mod supply;
mod watchdog;

use avr_device::atmega328p::Peripherals;
use lizard_core::console::answer::Counters;
use lizard_core::control::supply::Reading;
use lizard_core::memory::restart::{Restart, ServoState};
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
    /// Starts all peripherals, then enables interrupts. Call this function once, at the start of main.
    ///
    /// The first tick occurs 4 ms later. All servo pins are low until the first [`Board::submit`].
    pub fn start() -> Self {
        // SAFETY: only the boot loader has run before this call, and each peripheral is moved to the module that owns
        // it.
        let peripherals = unsafe { Peripherals::steal() };
        // The servo pins are not known yet, so no pin may stay high.
        // SAFETY: a port may have any value; D0 and D1, the serial port, keep their levels.
        unsafe {
            peripherals.PORTB.portb.write(|w| w.bits(0));
            peripherals.PORTC.portc.write(|w| w.bits(0));
            peripherals
                .PORTD
                .portd
                .modify(|port, w| w.bits(port.bits() & 0x03));
        }
        let restart = retained_ram::begin(&peripherals.CPU);
        stack::start();
        led::start();
        sleep::start(peripherals.CPU);
        serial::start(peripherals.USART0, restart.rate);
        // SAFETY: interrupts are off, and no other code uses Timer1.
        unsafe { pulses::start() };
        watchdog::start();
        // SAFETY: every interrupt that is enabled above has its handler, and this call is not in a critical section.
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
    fn connect(&mut self, servo_pins: [u8; 4], rail_pin: Option<u8>) {
        pulses::connect_pins(servo_pins);
        self.converter.connect_rail(rail_pin);
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
    fn store_servo_state(&mut self, servo_state: &ServoState, suspected_brown_outs: u8) {
        retained_ram::store_servo_state(servo_state, suspected_brown_outs);
    }

    #[inline(always)]
    fn last_restart(&self) -> &Restart {
        &self.restart
    }

    #[inline(always)]
    fn read_supply(&mut self) -> Reading {
        self.converter.advance_frame()
    }

    #[inline(always)]
    fn is_stack_intact(&self) -> bool {
        stack::is_intact()
    }

    #[inline(always)]
    fn is_contact_closed(&mut self, pin: u8) -> bool {
        input::read_contact(pin)
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
        retained_ram::store_rate(rate);
    }

    #[inline(always)]
    fn counters(&self) -> Counters {
        Counters {
            late_edges: pulses::late_edges(),
            rx_lost: serial::lost_count(),
        }
    }
}
