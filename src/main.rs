//! The firmware: the robot's core on an Arduino UNO.

#![no_std]
#![no_main]
#![feature(abi_avr_interrupt, asm_experimental_arch)]

use lizard_avr::Region;
use lizard_core::step::{Main, StepResult};
use panic_halt as _;

mod board;
mod mark;
mod robot;
mod simavr;

use board::{Uno, sleep};

/// The main loop. A static has a fixed address, which the compiler puts into the instructions. With a main loop on the
/// stack, every access would have to compute the address, and the program would be a tenth larger.
static mut MAIN: Main = Main::new();

#[avr_device::entry]
fn main() -> ! {
    let mut uno = Uno::start();
    let main_pointer = &raw mut MAIN;
    // SAFETY: this function is entered once, and no other code uses `MAIN`.
    let main = unsafe { &mut *main_pointer };
    main.begin(Region::DEFAULT, &mut uno);
    loop {
        if let StepResult::Idle(ticks) = main.step(&mut uno) {
            sleep::wait_for_event(ticks);
        }
    }
}
