//! The firmware: the core on an Arduino UNO.
//!
//! One loop, woken by the tick of the pulses or by a byte, which does one thing
//! at a time and looks for a tick first: a frame waits for one byte or one line
//! at most. It takes input only while the serial line has room for the longest
//! answer, so it never waits for a listener; and it computes a frame for every
//! tick, also for one that it was late for, so the pace is the timer's and not
//! the processor's.

#![no_std]
#![no_main]
#![deny(unsafe_op_in_unsafe_fn)]
#![feature(abi_avr_interrupt, asm_experimental_arch)]

use lizard::console::{Console, Counters, LONGEST_LINE};
use panic_halt as _;

mod board;

use board::{led, pulses, serial, sleep};

#[avr_device::entry]
fn main() -> ! {
    board::start();
    let mut console = Console::new();
    let mut seen = pulses::ticks();
    loop {
        if pulses::ticks() != seen {
            seen = seen.wrapping_add(1);
            pulses::submit(console.frame().0);
            led::set(beat(&console));
        } else if serial::room() < LONGEST_LINE {
            sleep::until_tick_or_byte(seen);
        } else if console.has_news() {
            let counters = Counters {
                late: pulses::late(),
                rx_lost: serial::lost(),
            };
            let Ok(()) = console.speak(&mut serial::Writer, counters);
        } else if let Some(byte) = serial::read() {
            console.hear(byte);
        } else {
            sleep::until_tick_or_byte(seen);
        }
    }
}

/// The LED: a slow heartbeat, on and off for 0.64 s each, and eight times as
/// fast while the guard holds the robot.
fn beat(console: &Console) -> bool {
    let frames = console.motion().frames() as u8;
    let half = if console.motion().hazard().is_some() {
        4
    } else {
        32
    };
    frames & half == 0
}
