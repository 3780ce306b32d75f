//! The serial line, 8N1, buffered both ways by interrupts.
//!
//! At 115200 baud a byte takes 1389 cycles on the line and the receiver holds two bytes, while main may be
//! busy with a frame for 12 000 cycles. So each direction has a ring buffer between main and an interrupt
//! handler. One of the two moves only the head, the other only the tail; head and tail are single bytes, so
//! neither has to lock the other out. The handlers are short, because an edge of a servo's pulse may have to
//! wait for one of them.

use core::convert::Infallible;

use avr_device::atmega328p::USART0;
use avr_device::atmega328p::usart0::RegisterBlock;
use lizard_core::console::line::GARBLED_BYTE;
use lizard_core::numbers::rate::BaudRate;
use ufmt::uWrite;

use servo_pulses::cells::{Byte, Counter};

/// Size of the receive ring in bytes. It holds a complete line: main may be busy for the time of 64 bytes, which
/// is 89 000 cycles or seven times the limit of a frame.
const RECEIVE_RING_SIZE: usize = 64;

/// Size of the send ring in bytes. The longest line of the console fits, and arithmetic modulo 256 is the cheapest.
const SEND_RING_SIZE: usize = 256;

/// Number of bytes that the send ring holds.
pub const SEND_CAPACITY: u8 = Ring::<SEND_RING_SIZE>::CAPACITY;

/// Returns the value of UBRR0 for the nearest possible rate. For 115 200 baud that rate is
/// 16 MHz / 8 / (16 + 1) = 117 647 baud, 2.1 % fast, which the boot loader uses, too. The others are 57 143 baud,
/// 0.8 % slow, and 38 462 and 9615 baud, 0.2 % fast.
const fn divisor(rate: BaudRate) -> u16 {
    let (clock_by_8, baud) = (16_000_000 / 8, rate.baud());
    ((clock_by_8 + baud / 2) / baud - 1) as u16
}

/// A ring buffer of bytes between main and a handler. The side that puts bytes moves `head`, the side that
/// takes bytes moves `tail`; both count freely modulo 256.
struct Ring<const N: usize> {
    bytes: [Byte; N],
    head: Byte,
    tail: Byte,
}

impl<const N: usize> Ring<N> {
    const MASK: u8 = {
        assert!(N.is_power_of_two() && N <= 256);
        (N - 1) as u8
    };

    /// Number of bytes that the ring holds. A ring of 256 holds 255, because with 256 it would look empty.
    const CAPACITY: u8 = if N == 256 { 255 } else { N as u8 };

    const fn new() -> Self {
        Self {
            bytes: [const { Byte::new(0) }; N],
            head: Byte::new(0),
            tail: Byte::new(0),
        }
    }

    /// Returns the number of bytes for which there is room.
    fn room(&self) -> u8 {
        Self::CAPACITY - self.head.get().wrapping_sub(self.tail.get())
    }

    fn is_empty(&self) -> bool {
        self.head.get() == self.tail.get()
    }

    /// Appends a byte; the caller has checked the room.
    fn put(&self, byte: u8) {
        let head = self.head.get();
        self.bytes[usize::from(head & Self::MASK)].set(byte);
        // The byte before the head: the other side looks at the head first.
        self.head.set(head.wrapping_add(1));
    }

    /// Removes and returns the oldest byte, if any.
    fn take(&self) -> Option<u8> {
        if self.is_empty() {
            return None;
        }
        let tail = self.tail.get();
        let byte = self.bytes[usize::from(tail & Self::MASK)].get();
        // The byte is read before the tail moves, because that frees its slot.
        self.tail.set(tail.wrapping_add(1));
        Some(byte)
    }
}

static RECEIVED: Ring<RECEIVE_RING_SIZE> = Ring::new();
static TO_SEND: Ring<SEND_RING_SIZE> = Ring::new();
/// Counts received bytes that were lost or garbled.
static LOST: Counter = Counter::new();

/// Sets up the port. Call it once, with interrupts off.
pub fn start(usart: USART0, rate: BaudRate) {
    // Double speed is set before the divisor, because stock simavr computes the
    // baud rate when the divisor is written.
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

/// Changes the baud rate. Bytes that are on the line in either direction arrive garbled.
pub fn set_rate(rate: BaudRate) {
    let divisor = match rate {
        BaudRate::Fastest => const { divisor(BaudRate::Fastest) },
        BaudRate::Half => const { divisor(BaudRate::Half) },
        BaudRate::Third => const { divisor(BaudRate::Third) },
        BaudRate::Slowest => const { divisor(BaudRate::Slowest) },
    };
    // SAFETY: main alone writes UBRR0, and no handler uses it.
    let usart = unsafe { &*USART0::ptr() };
    usart.ubrr0.write(|w| w.bits(divisor));
}

/// Returns the next byte received, if any; [`GARBLED_BYTE`] in place of a byte without its stop bit.
pub fn read() -> Option<u8> {
    RECEIVED.take()
}

/// True if [`read`] would return a byte.
pub fn has_input() -> bool {
    !RECEIVED.is_empty()
}

/// True while bytes wait to be sent.
pub fn is_sending() -> bool {
    !TO_SEND.is_empty()
}

/// Returns the number of bytes that [`Writer`] takes now without waiting, at most 255.
pub fn room() -> u8 {
    TO_SEND.room()
}

/// Returns the number of received bytes that were garbled, or lost because the ring was full or the
/// receiver overran. An overrun counts once, even if it lost more than one byte. The count stops at 65535.
pub fn lost_count() -> u16 {
    LOST.read()
}

/// A writer of text to the serial line. Main checks [`room`] before it writes; if there is no room, a byte
/// waits until another is sent: at 115200 baud, 1389 cycles at most.
pub struct Writer;

impl uWrite for Writer {
    type Error = Infallible;

    fn write_str(&mut self, text: &str) -> Result<(), Infallible> {
        text.bytes().for_each(send);
        Ok(())
    }

    // The robot prints only ASCII. The trait's UTF-8 encoding would double the time that a
    // character takes.
    #[inline(always)]
    fn write_char(&mut self, character: char) -> Result<(), Infallible> {
        send(character as u8);
        Ok(())
    }
}

/// Sends a byte; waits while there is no room for it.
#[inline(never)]
fn send(byte: u8) {
    while room() == 0 {}
    TO_SEND.put(byte);
    // SAFETY: one store writes all of UCSR0B, with the value that is right while there is
    // something to send. If the handler has sent the byte meanwhile, it runs once more and
    // only switches its interrupt off again.
    enable_interrupts(unsafe { &*USART0::ptr() }, true);
}

/// Switches on the receiver, the transmitter and the receive interrupt, and the transmit
/// interrupt if there is something to send. This is one store, not a read and a write, so
/// that main and a handler cannot undo each other's change.
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

// A byte has been received.
#[avr_device::interrupt(atmega328p)]
fn USART_RX() {
    // SAFETY: the handler reads UCSR0A and UDR0, which main never touches.
    let usart = unsafe { &*USART0::ptr() };
    // The status belongs to the byte that is read next from UDR0.
    let status = usart.ucsr0a.read();
    let mut byte = usart.udr0.read().bits();
    if status.fe0().bit_is_set() {
        byte = GARBLED_BYTE;
        LOST.count();
    }
    if RECEIVED.room() != 0 {
        RECEIVED.put(byte);
    } else {
        LOST.count();
    }
    if status.dor0().bit_is_set() {
        LOST.count();
    }
}

// The transmitter is ready for a byte.
#[avr_device::interrupt(atmega328p)]
fn USART_UDRE() {
    // SAFETY: only this handler writes UDR0; for UCSR0B see `send`.
    let usart = unsafe { &*USART0::ptr() };
    match TO_SEND.take() {
        Some(byte) => usart.udr0.write(|w| w.bits(byte)),
        None => enable_interrupts(usart, false),
    }
}
