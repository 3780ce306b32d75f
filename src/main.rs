//! The firmware: the core on an Arduino UNO.

#![no_std]
#![no_main]
#![deny(unsafe_op_in_unsafe_fn)]
#![feature(abi_avr_interrupt, asm_experimental_arch)]

use lizard_core::step::{Main, Step};
use panic_halt as _;

mod board;
mod robot;

use board::{Uno, sleep};

#[avr_device::entry]
fn main() -> ! {
    let mut uno = Uno::start();
    let mut main = Main::new(robot::Lizard, &mut uno);
    loop {
        if let Step::Idle(ticks) = main.step(&mut uno) {
            sleep::until_tick_or_byte(ticks);
        }
    }
}
