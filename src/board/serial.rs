//! The serial port, 8N1, with interrupt-driven buffers in both directions.
//!
//! At 115 200 baud a byte takes 1389 cycles and the receiver holds two bytes, while main may be busy with a frame for
//! 20 000 cycles. Therefore each direction has a ring buffer between main and an interrupt handler. One side moves only
//! the head, the other side only the tail. Head and tail are single bytes, so no lock is necessary. The handlers are
//! short, because a pulse edge may have to wait for a handler.

use core::convert::Infallible;

use avr_device::atmega328p::USART0;
use avr_device::atmega328p::usart0::RegisterBlock;
use lizard_core::console::line::GARBLED_BYTE;
use lizard_core::numbers::rate::BaudRate;
use servo_pulses::cells::{SharedByte, SharedCounter};
use ufmt::uWrite;

/// The size of the receive ring in bytes. The ring holds a complete line, so main may be busy for the time of 64 bytes,
/// 89 000 cycles, which is four times the limit for a frame.
const RECEIVE_RING_SIZE: usize = 64;

/// The size of the send ring in bytes. The longest line of the console fits, and arithmetic modulo 256 is the fastest.
const SEND_RING_SIZE: usize = 256;

/// The number of bytes that the send ring holds.
pub const SEND_CAPACITY: u8 = Ring::<SEND_RING_SIZE>::CAPACITY;

/// Computes the value of UBRR0 for the nearest possible baud rate. For 115 200 baud this rate is 16 MHz / 8 / (16 + 1)
/// = 117 647 baud, 2.1 % fast, as in the boot loader. The other rates are 57 143 baud, 0.8 % slow, and 38 462 and 9615
/// baud, 0.2 % fast.
const fn compute_divisor(rate: BaudRate) -> u16 {
    let (clock_by_8, baud) = (16_000_000 / 8, rate.baud());
    ((clock_by_8 + baud / 2) / baud - 1) as u16
}

/// A ring buffer of bytes between main and a handler. The side that puts bytes moves `head`, the side that takes bytes
/// moves `tail`; both indices count modulo 256.
struct Ring<const N: usize> {
    bytes: [SharedByte; N],
    head: SharedByte,
    tail: SharedByte,
}

impl<const N: usize> Ring<N> {
    const MASK: u8 = {
        assert!(N.is_power_of_two() && N <= 256);
        (N - 1) as u8
    };

    /// The number of bytes that the ring holds. A ring of 256 bytes holds 255, because with 256 it would seem empty.
    const CAPACITY: u8 = if N == 256 { 255 } else { N as u8 };

    const fn new() -> Self {
        Self {
            bytes: [const { SharedByte::new(0) }; N],
            head: SharedByte::new(0),
            tail: SharedByte::new(0),
        }
    }

    /// Returns the number of bytes for which there is room.
    fn room(&self) -> u8 {
        Self::CAPACITY - self.head.get().wrapping_sub(self.tail.get())
    }

    fn is_empty(&self) -> bool {
        self.head.get() == self.tail.get()
    }

    /// Appends a byte; the ring must have room.
    fn put(&self, byte: u8) {
        let head = self.head.get();
        self.bytes[usize::from(head & Self::MASK)].set(byte);
        // The byte is stored before the head moves, because the move shows the byte to the other side.
        self.head.set(head.wrapping_add(1));
    }

    /// Removes and returns the oldest byte, if any.
    fn take(&self) -> Option<u8> {
        if self.is_empty() {
            return None;
        }
        let tail = self.tail.get();
        let byte = self.bytes[usize::from(tail & Self::MASK)].get();
        // The byte is read before the tail moves, because the move frees its slot.
        self.tail.set(tail.wrapping_add(1));
        Some(byte)
    }
}

static RECEIVE_RING: Ring<RECEIVE_RING_SIZE> = Ring::new();
static SEND_RING: Ring<SEND_RING_SIZE> = Ring::new();
/// The number of received bytes that were lost or garbled.
static LOST_BYTES: SharedCounter = SharedCounter::new();

/// Starts the port at a baud rate. Call this function once, with interrupts off.
pub fn start(usart: USART0, rate: BaudRate) {
    // Double speed is set before the divisor, because stock simavr computes the baud rate when the divisor is written.
    usart.ucsr0a.write(|w| w.u2x0().set_bit());
    set_rate(rate);
    usart.ucsr0c.write(|w| {
        w.umsel0()
            .usart_async()
            .upm0()
            .disabled()
            .usbs0()
            .stop1()
            .ucsz0()
            .chr8()
    });
    enable_interrupts(&usart, false);
}

/// Changes the baud rate, which garbles bytes in transmission in either direction.
pub fn set_rate(rate: BaudRate) {
    let divisor = match rate {
        BaudRate::Fastest => const { compute_divisor(BaudRate::Fastest) },
        BaudRate::Half => const { compute_divisor(BaudRate::Half) },
        BaudRate::Third => const { compute_divisor(BaudRate::Third) },
        BaudRate::Slowest => const { compute_divisor(BaudRate::Slowest) },
    };
    // SAFETY: only main writes UBRR0, and no handler uses it.
    let usart = unsafe { &*USART0::ptr() };
    usart.ubrr0.write(|w| w.bits(divisor));
}

/// Takes the next received byte, if any, or [`GARBLED_BYTE`] in place of a byte that lacks its stop bit.
pub fn read() -> Option<u8> {
    RECEIVE_RING.take()
}

/// True if [`read`] would return a byte.
pub fn has_input() -> bool {
    !RECEIVE_RING.is_empty()
}

/// True while bytes wait to be sent.
pub fn is_sending() -> bool {
    !SEND_RING.is_empty()
}

/// Returns the number of bytes that [`Writer`] accepts now without waiting, at most 255.
pub fn room() -> u8 {
    SEND_RING.room()
}

/// Returns the number of received bytes that were garbled, or lost because the ring was full or the receiver overran.
/// An overrun counts once, even if more than one byte was lost. The count saturates at 65535.
pub fn lost_count() -> u16 {
    LOST_BYTES.read()
}

/// A writer of text to the serial port. Main checks [`room`] before it writes; without room, a byte waits until another
/// byte is sent, at 115 200 baud at most 1389 cycles.
pub struct Writer;

impl uWrite for Writer {
    type Error = Infallible;

    fn write_str(&mut self, text: &str) -> Result<(), Infallible> {
        text.bytes().for_each(send);
        Ok(())
    }

    // The robot prints only ASCII. The UTF-8 encoding of the trait's default method would double the time per
    // character.
    #[inline(always)]
    fn write_char(&mut self, character: char) -> Result<(), Infallible> {
        send(character as u8);
        Ok(())
    }
}

/// Sends a byte after waiting for room.
#[inline(never)]
fn send(byte: u8) {
    while room() == 0 {}
    SEND_RING.put(byte);
    // SAFETY: a single store writes all of UCSR0B, with the value for a ring that is not empty. If the handler has
    // already sent the byte, it runs once more and only switches its interrupt off again.
    enable_interrupts(unsafe { &*USART0::ptr() }, true);
}

/// Switches on the receiver, the transmitter and the receive interrupt, and also the interrupt for an empty data
/// register if `has_output` is true. This is a single store, not a read and a write, so that main and a handler cannot
/// undo each other's change.
#[inline(always)]
fn enable_interrupts(usart: &RegisterBlock, has_output: bool) {
    usart.ucsr0b.write(|w| {
        w.rxcie0()
            .set_bit()
            .rxen0()
            .set_bit()
            .txen0()
            .set_bit()
            .udrie0()
            .bit(has_output)
    });
}

// Handles a received byte.
#[avr_device::interrupt(atmega328p)]
fn USART_RX() {
    // SAFETY: the handler reads UCSR0A and UDR0, which main does not access.
    let usart = unsafe { &*USART0::ptr() };
    // The status belongs to the next byte read from UDR0.
    let status = usart.ucsr0a.read();
    let mut byte = usart.udr0.read().bits();
    if status.fe0().bit_is_set() {
        byte = GARBLED_BYTE;
        LOST_BYTES.count();
    }
    if RECEIVE_RING.room() != 0 {
        RECEIVE_RING.put(byte);
    } else {
        LOST_BYTES.count();
    }
    if status.dor0().bit_is_set() {
        LOST_BYTES.count();
    }
}

// Handles the transmitter's readiness for the next byte.
#[avr_device::interrupt(atmega328p)]
fn USART_UDRE() {
    // SAFETY: only this handler writes UDR0; for UCSR0B see `send`.
    let usart = unsafe { &*USART0::ptr() };
    match SEND_RING.take() {
        Some(byte) => usart.udr0.write(|w| w.bits(byte)),
        None => enable_interrupts(usart, false),
    }
}
