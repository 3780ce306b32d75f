//! Four servo pulses, exact to the CPU cycle, and the 50 Hz clock.
//!
//! A servo turns the width of a pulse into an angle, so every cycle by which
//! an edge wanders is a tremor of the horn. Interrupt latency wanders: by the
//! instruction under way, by whichever other interrupt runs. The remedy is to be
//! early and then wait. Timer1 counts CPU cycles through slots of 4 ms; each
//! compare interrupt reads how late it already is, waits out the rest of
//! [`LEAD`] and only then stores the port. Both edges wait by the same code, so
//! everything constant cancels and the width is the one that was asked for.
//!
//! ```text
//! slot    0         1         2         3         4         0
//!         |---------|---------|---------|---------|---------|---------
//! A1      /~~\______________________________________________/~~\______
//! A2      __________/~~~\_____________________________________________
//! A3      ____________________/~\_____________________________________
//! A4      ______________________________/~~\__________________________
//!                                                 ^ tick   ^ next frame
//! ```
//!
//! One pin is high at a time. Slot 4 has no pin: it opens with the tick, and
//! just before it closes the frame that main has submitted meanwhile is taken
//! over, so main has 3.9 ms.
//!
//! What a slot does is planned at the end of the slot before, so that the opening
//! interrupt has next to nothing to do before its edge.
//!
//! # An edge that cannot be on time
//!
//! It must not become a wrong angle:
//!
//! - A rising edge that is late is not made. The servo misses one pulse of 50 in
//!   a second, and holds.
//! - A falling edge cannot be dropped, and nothing can shorten a pulse that is
//!   already too long. It is made at once, so the pulse is longer by as much as the
//!   edge is late: 10 us, or 160 cycles, turn an SG-90 by one degree for 20 ms. If
//!   interrupts stay off to the end of the slot, 4 ms, the next slot's start ends the
//!   pulse.
//! - Both are counted, in [`late`].
//!
//! # Rules this rests on
//!
//! - The longest of the other handlers and the longest stretch with interrupts
//!   off take less than `LEAD` together, less the 60 cycles that a handler here
//!   needs itself before it reads the timer. Where that fails the edge is late.
//! - Interrupts are never off for 62 us, 1000 cycles. A slot whose end is missed so
//!   is played again without a pulse, and everything comes 4 ms later from then on.
//! - Only the two handlers touch Timer1, because all its 16-bit registers share
//!   one TEMP byte.
//! - Everyone else changes pins of the servos' ports by single `sbi` and `cbi`
//!   instructions, which no interrupt can split.

mod pin;

use core::arch::asm;
use core::ops::RangeInclusive;
use core::ptr::with_exposed_provenance_mut;

use avr_device::atmega328p::TC1;
use lizard_core::pose::Pulses;

use self::pin::Pin;
use super::shared::{Byte, Counter, Word};
use crate::robot::PINS as NUMBERS;

/// Cycles from a compare match to the moment from which its edge follows at a
/// fixed distance. At most 255, because the wait is counted in a byte.
const LEAD: u8 = 220;

/// Timer1 counts every cycle of the UNO's 16 MHz.
pub const CYCLES_PER_US: u16 = 16;

/// Cycles of a slot, 4 ms; five of them are the 20 ms that a servo expects.
const SLOT_CYCLES: u16 = 64_000;

/// The slot without a pin.
const TICK_SLOT: u8 = 4;

/// Widths that can be made, in cycles: 62.5 us at either end of the slot are for
/// the two handlers and whatever they have to wait for. Far wider than any
/// servo's travel.
const WIDTHS: RangeInclusive<u16> = 1_000..=SLOT_CYCLES - 1_000;

/// When a slot without a pulse is closed. Late, because the slot with the tick
/// then waits the longest for main.
const CLOSE: u16 = *WIDTHS.end();

/// A compare value that the timer never reaches.
const NEVER: u16 = u16::MAX;

fn port(address: u8) -> *mut u8 {
    with_exposed_provenance_mut(usize::from(address))
}

/// The pins of A1 to A4, by slot.
static PINS: [Pin; 4] = [
    Pin::arduino(NUMBERS[0]),
    Pin::arduino(NUMBERS[1]),
    Pin::arduino(NUMBERS[2]),
    Pin::arduino(NUMBERS[3]),
];

/// Two sets of widths: the one that plays and the one that main fills.
static FRAMES: [[Word; 4]; 2] = [const { [const { Word::new(0) }; 4] }; 2];

/// Which of [`FRAMES`] plays. Changed only by the handler, and only while
/// [`FRESH`] is set.
static PLAYING: Byte = Byte::new(0);

/// 1 when the other frame is complete and waits to be taken over. Main sets it;
/// the handler clears it when it takes the frame, main when it takes it back.
static FRESH: Byte = Byte::new(0);

/// The plan: number of the slot under way or, between slots, of the next; where
/// its pin is, 0 in `MASK` for no pulse; and the count for which the falling edge
/// is due. TIMER1_COMPB writes it; TIMER1_COMPA takes a pulse out that it was late
/// for. It starts with the tick, so that main gets going at once.
static SLOT: Byte = Byte::new(TICK_SLOT);
static PORT: Byte = Byte::new(0);
static MASK: Byte = Byte::new(0);
static FALL: Word = Word::new(CLOSE + LEAD as u16);

/// The pins that may go high: all, or none after [`hush`].
static ALLOWED: Byte = Byte::new(u8::MAX);

/// Written only by TIMER1_COMPA.
static TICKS: Byte = Byte::new(0);

/// Counted in both handlers.
static LATE: Counter = Counter::new();

/// Puts the servo pins low and sets the timer going. With interrupts off, once.
pub fn start(timer: TC1) {
    for pin in &PINS {
        let ddr: *mut u8 = with_exposed_provenance_mut(usize::from(pin.port) - 1);
        // SAFETY: DDR is just below PORT; both are I/O registers, for a `Pin` knows
        // no other addresses, and interrupts are still off.
        unsafe {
            let port = port(pin.port);
            port.write_volatile(port.read_volatile() & !pin.mask);
            ddr.write_volatile(ddr.read_volatile() | pin.mask);
        }
    }
    // The boot loader leaves the timer running for its LED: stop it first.
    timer.tccr1b().write(|w| w.cs1().no_clock());
    timer.tccr1a().reset();
    timer.tcnt1().write(|w| w.set(0));
    timer.ocr1a().write(|w| w.set(SLOT_CYCLES - 1));
    timer.ocr1b().write(|w| w.set(NEVER));
    timer
        .tifr1()
        .write(|w| w.ocf1a().set_bit().ocf1b().set_bit());
    timer
        .timsk1()
        .write(|w| w.ocie1a().set_bit().ocie1b().set_bit());
    // SAFETY: 1 in this register's half of the mode is CTC up to OCR1A.
    timer
        .tccr1b()
        .write(|w| unsafe { w.wgm1().bits(1) }.cs1().direct());
}

/// Hands over the widths of the next frame, A1 to A4, in CPU cycles of 62.5 ns.
///
/// They are taken over together before slot 0 opens; a second call before that
/// replaces the first. If none comes, the last ones repeat. A width of 0, and
/// any that a slot has no room for, gives no pulse.
///
/// Returns whether the frame of the call before has been taken over, true on the
/// first call. Who calls this once for every tick sees by it that both handlers
/// live: one gives the tick, the other takes the frame. It is false, too, for a
/// frame that main was so late with that the next tick came first.
pub fn submit(pulses: Pulses) -> bool {
    let taken = FRESH.get() == 0;
    // Take back what has not been played. From here to the end the handler
    // leaves PLAYING alone, so the frame that is filled cannot start to play.
    FRESH.set(0);
    let frame = &FRAMES[usize::from(PLAYING.get() & 1 ^ 1)];
    for (slot, width) in frame.iter().zip(pulses.0) {
        slot.set(width.0);
    }
    FRESH.set(1);
    taken
}

/// From now on no pulse begins; one that is under way ends as planned, within
/// 4 ms. For whoever is about to reset the board, which would cut it short and so
/// send the servo to its end stop. The tick goes on. One store, right in an
/// interrupt and anywhere else; only a reset ends it.
pub fn hush() {
    ALLOWED.set(0);
}

/// Frames since the start, modulo 256. Steps every 20 ms, 4 ms before the next
/// frame's first pulse.
pub fn ticks() -> u8 {
    TICKS.get()
}

/// Edges that came late because an interrupt was held up for longer than the
/// lead allows. Stays at 65535.
pub fn late() -> u16 {
    LATE.read()
}

// A slot opens: its pin goes up, or the tick is given.
#[avr_device::interrupt(atmega328p)]
fn TIMER1_COMPA() {
    let mask = MASK.get() & ALLOWED.get();
    if mask != 0 {
        let port = port(PORT.get());
        // SAFETY: the port of a servo pin, in a handler, LEAD after the match.
        unsafe {
            let before = port.read_volatile();
            // A pin that is still high has missed its falling edge: it only goes down.
            let change = mask & !before;
            let on_time = store_at([LEAD, 0], port, before & !mask, change);
            if on_time & change == 0 {
                LATE.count();
                MASK.set(0);
                FALL.set(CLOSE + u16::from(LEAD));
            }
        }
    } else if SLOT.get() == TICK_SLOT {
        TICKS.set(TICKS.get().wrapping_add(1));
    }
    // SAFETY: after `start` only this handler and TIMER1_COMPB use Timer1, and
    // they cannot interrupt each other.
    let timer = unsafe { TC1::steal() };
    timer.ocr1b().write(|w| w.set(FALL.get() - u16::from(LEAD)));
    // Had interrupts been off for very long, the match of the slot before, or of
    // this one with the old count, would wait here and close this slot at once.
    timer.tifr1().write(|w| w.ocf1b().set_bit());
}

// A slot closes: its pin goes down, and the next slot is planned.
#[avr_device::interrupt(atmega328p)]
fn TIMER1_COMPB() {
    let mask = MASK.get();
    if mask != 0 {
        let port = port(PORT.get());
        // SAFETY: the port of a servo pin, in a handler, LEAD after the match.
        let on_time = unsafe { store_at(FALL.bytes(), port, port.read_volatile() & !mask, 0) };
        if on_time == 0 {
            LATE.count();
        }
    }
    let slot = match SLOT.get() {
        TICK_SLOT => {
            if FRESH.get() != 0 {
                PLAYING.set(PLAYING.get() ^ 1);
                FRESH.set(0);
            }
            0
        }
        slot => slot + 1,
    };
    SLOT.set(slot);
    let servo = usize::from(slot & 3);
    let width = FRAMES[usize::from(PLAYING.get() & 1)][servo].get();
    // Checked here, last thing before it is used.
    if slot == TICK_SLOT || !WIDTHS.contains(&width) {
        MASK.set(0);
        FALL.set(CLOSE + u16::from(LEAD));
    } else {
        PORT.set(PINS[servo].port);
        MASK.set(PINS[servo].mask);
        FALL.set(width + u16::from(LEAD));
    }
}

/// Stores `low`, with the bits of `change` set if it is on time for that, in `port`
/// a fixed number of cycles after Timer1 counts `count`, given low byte first; at
/// once if it is too late. Returns 0xff if it was on time, else 0.
///
/// A falling edge goes through this with a `change` of nothing: the same
/// instructions, so that all that they cost falls out of the width.
///
/// # Safety
/// `port` is the PORT register of a servo pin and `low` is right for its other
/// pins until the store, so interrupts are off; `count` is at most 255 ahead.
#[inline(always)]
unsafe fn store_at(count: [u8; 2], port: *mut u8, low: u8, change: u8) -> u8 {
    let [left, high] = count;
    let on_time: u8;
    // SAFETY: reads TCNT1 (low byte first, which latches the high one), and
    // writes `port`, which the caller answers for.
    unsafe {
        asm!(
            // left = count - now
            "lds {now}, {tcnt1l}",
            "sub {left}, {now}",
            "lds {now}, {tcnt1h}",
            "sbc {on_time}, {now}",
            // The borrow says late: on_time = 0, else 0xff; and if late left = 0 and
            // nothing is set.
            "sbc {on_time}, {on_time}",
            "com {on_time}",
            "and {left}, {on_time}",
            "and {change}, {on_time}",
            "or {value}, {change}",
            // Three cycles a turn; left ends as 253, 254 or 255, and the rest, 0
            // to 2 cycles, is made of branches to the next instruction, which
            // take two cycles when taken and one when not.
            "2: subi {left}, 3",
            "brcc 2b",
            "cpi {left}, 254",
            "brcc 3f",
            "3: cpi {left}, 255",
            "breq 4f",
            "4: st {port}, {value}",
            tcnt1l = const 0x84,
            tcnt1h = const 0x85,
            now = out(reg) _,
            left = inout(reg_upper) left => _,
            on_time = inout(reg) high => on_time,
            port = in(reg_ptr) port,
            value = inout(reg) low => _,
            change = inout(reg) change => _,
            options(nostack),
        );
    }
    on_time
}
