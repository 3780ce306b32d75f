//! The engine's access to registers.

use core::ptr::with_exposed_provenance_mut;

use super::{Engine, LEAD_CYCLES};
use crate::pin::Pin;
use crate::store::store_at;
use crate::timing::slot_cycles;

// Timer1 of an ATmega328P (data sheet, register summary).
const TIFR1: usize = 0x36;
const TIMSK1: usize = 0x6f;
const TCCR1A: usize = 0x80;
const TCCR1B: usize = 0x81;
const TCNT1: usize = 0x84;
const OCR1A: usize = 0x88;
const OCR1B: usize = 0x8a;
/// The bit of compare match B: OCF1B in TIFR1, OCIE1B in TIMSK1.
const MATCH_B: u8 = 1 << 2;
/// The bit of compare match A: OCF1A in TIFR1, OCIE1A in TIMSK1.
const MATCH_A: u8 = 1 << 1;
/// The value of TCCR1B that starts the timer (WGM12 and CS10), which counts every cycle up to OCR1A (CTC mode).
const RUN: u8 = 1 << 3 | 1;

/// A compare value that the timer never reaches.
const NEVER: u16 = u16::MAX;

/// Returns the PORT register at a data address.
#[inline(always)]
fn port_register(address: u8) -> *mut u8 {
    with_exposed_provenance_mut(usize::from(address))
}

/// Writes to a register.
///
/// # Safety
/// `register` must be the address of a Timer1 register of type `T`.
#[inline(always)]
unsafe fn write_register<T>(register: usize, value: T) {
    // SAFETY: the caller guarantees the same condition.
    unsafe { with_exposed_provenance_mut::<T>(register).write_volatile(value) }
}

impl<const SERVO_COUNT: usize, const SIZE: usize> Engine<'_, SERVO_COUNT, SIZE> {
    /// Sets the pins, in the order of the widths, drives them low and makes them outputs. Call this function once,
    /// before the first [`Engine::submit`], and with interrupts off if any handler changes other pins of these ports.
    #[inline(always)]
    pub fn connect(&self, pins: [Pin; SERVO_COUNT]) {
        for ([port, mask], pin) in self.pins.iter().zip(&pins) {
            port.set(pin.port);
            mask.set(pin.mask);
        }
        self.drive_pins_low();
    }

    /// Starts an engine whose pins are known at compile time: drives them low, makes them outputs, and calls
    /// [`Engine::start`].
    ///
    /// # Safety
    /// See [`Engine::start`].
    #[doc(hidden)]
    #[inline(always)]
    pub unsafe fn start_with_fixed_pins(&self) {
        self.drive_pins_low();
        // SAFETY: the caller guarantees the same condition.
        unsafe { self.start() }
    }

    /// Drives the pins low and makes them outputs.
    #[inline(always)]
    fn drive_pins_low(&self) {
        for [address, mask] in &self.pins[..SERVO_COUNT] {
            let port = port_register(address.get());
            let mask = mask.get();
            // SAFETY: a `Pin` has only addresses of PORT registers, and DDR is the register just below PORT. No handler
            // writes to these registers before a width has been submitted.
            unsafe {
                let ddr = port.sub(1);
                port.write_volatile(port.read_volatile() & !mask);
                ddr.write_volatile(ddr.read_volatile() | mask);
            }
        }
    }

    /// Starts the timer. The first tick occurs one slot later. Call this function once.
    ///
    /// # Safety
    /// Interrupts must be off, and no other code may use Timer1 from now on.
    #[inline(always)]
    pub unsafe fn start(&self) {
        self.slot.set(Self::TICK_SLOT);
        self.fall_count.set(Self::NO_PULSE_COUNT);
        self.allowed_pins.set(u8::MAX);
        // SAFETY: these registers belong to Timer1, which only this engine uses.
        unsafe {
            // The timer is stopped first, because a boot loader leaves it running for the LED.
            write_register(TCCR1B, 0u8);
            write_register(TCCR1A, 0u8);
            write_register(TCNT1, 0u16);
            write_register(OCR1A, const { slot_cycles(SERVO_COUNT) - 1 });
            write_register(OCR1B, NEVER);
            write_register(TIFR1, MATCH_A | MATCH_B);
            write_register(TIMSK1, MATCH_A | MATCH_B);
            write_register(TCCR1B, RUN);
        }
    }

    /// The number of edges that were late because an interrupt was delayed longer than [`LEAD_CYCLES`] allows, at most
    /// 65535.
    #[inline(always)]
    pub fn late_edges(&self) -> u16 {
        self.late_edges.read()
    }

    /// Opens a slot: raises its pin or, in the slot without a pin, counts a tick.
    ///
    /// # Safety
    /// Call this function only in the handler of Timer1's compare match A.
    #[doc(hidden)]
    #[inline(always)]
    pub unsafe fn open_slot(&self) {
        let mask = self.mask.get() & self.allowed_pins.get();
        if mask != 0 {
            let port = port_register(self.port.get());
            // SAFETY: `port` is the port of a servo pin, interrupts are off in a handler, and the edge is due
            // LEAD_CYCLES after the match.
            unsafe {
                let level_before = port.read_volatile();
                // A pin that is still high has missed its falling edge and may only go low.
                let set_mask = mask & !level_before;
                let on_time_mask = store_at([LEAD_CYCLES, 0], port, level_before & !mask, set_mask);
                if on_time_mask & set_mask == 0 {
                    self.late_edges.count();
                    self.mask.set(0);
                    self.fall_count.set(Self::NO_PULSE_COUNT);
                }
            }
        } else if self.slot.get() == Self::TICK_SLOT {
            self.ticks.set(self.ticks.get().wrapping_add(1));
        }
        // SAFETY: after `start` only the two handlers use Timer1, and they cannot interrupt each other.
        unsafe {
            write_register(OCR1B, self.fall_count.get() - u16::from(LEAD_CYCLES));
            // If interrupts were off for very long, a match B is pending here, from the previous slot or from this slot
            // with the previous value of OCR1B, and would close this slot at once.
            write_register(TIFR1, MATCH_B);
        }
    }

    /// Closes a slot: lowers its pin and plans the next slot.
    ///
    /// # Safety
    /// Call this function only in the handler of Timer1's compare match B.
    #[doc(hidden)]
    #[inline(always)]
    pub unsafe fn close_slot(&self) {
        let mask = self.mask.get();
        if mask != 0 {
            let port = port_register(self.port.get());
            // SAFETY: as in `open_slot`.
            let on_time_mask = unsafe {
                store_at(
                    self.fall_count.bytes(),
                    port,
                    port.read_volatile() & !mask,
                    0,
                )
            };
            if on_time_mask == 0 {
                self.late_edges.count();
            }
        }
        self.plan_next_slot();
    }
}
