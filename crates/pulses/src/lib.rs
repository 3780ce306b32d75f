//! Servo pulses that are exact to the CPU cycle, and a steady clock, for any program on an ATmega328P (Arduino UNO,
//! Nano, Pro Mini).
//!
//! A servo converts the width of a pulse to an angle, so every cycle of jitter moves the horn. Interrupt latency varies
//! with the current instruction and with other interrupts. Therefore each interrupt occurs early, and its handler
//! waits. Timer1 counts the CPU cycles of each slot. The handler of each compare interrupt reads its own latency from
//! the timer, waits for the rest of [`LEAD_CYCLES`], and only then stores to the port. Both edges wait in the same
//! code, so every constant delay cancels and the width is exact.
//!
//! ```text
//! slot    0         1         2         3         4         0
//!         |---------|---------|---------|---------|---------|---------
//! first   /~~\______________________________________________/~~\______
//! second  __________/~~~\_____________________________________________
//! third   ____________________/~\_____________________________________
//! fourth  ______________________________/~~\__________________________
//!                                                 ^ tick   ^ next frame
//! ```
//!
//! At most one pin is high at a time. The last slot has no pin: it opens with the tick, and when it closes, the engine
//! takes over the frame that main has submitted. The length of a slot, [`slot_cycles`], depends on the number of
//! servos: with four servos a slot is 4 ms, and a frame is exactly 20 ms.
//!
//! Each slot is planned at the end of the previous slot, so that the opening interrupt has little to do before its
//! edge.
//!
//! # Use
//!
//! [`engine!`] makes a module of the program the owner of Timer1 and of the servo pins:
//!
//! ```ignore
//! const PINS: [Pin; 4] = [pin(9), pin(10), pin(11), pin(3)];
//! mod servos {
//!     servo_pulses::engine!(super::PINS);
//! }
//!
//! // SAFETY: interrupts are off, and nothing else uses Timer1.
//! unsafe { servos::start() };
//! unsafe { avr_device::interrupt::enable() };
//! servos::submit([1500 * CYCLES_PER_US; 4]);
//! ```
//!
//! The program requires `#![feature(abi_avr_interrupt)]`. `examples/sweep.rs` is a complete program.
//!
//! # When not to use it
//!
//! The engine occupies Timer1, and its interrupt handlers spend about one per cent of the processor's time waiting. Two
//! servos on pins 9 and 10 do not require the engine, because the timer's own compare outputs are exact without any
//! code. The engine is only for the ATmega328P at 16 MHz.
//!
//! # Late edges
//!
//! A late edge moves the horn as little as possible:
//!
//! - A late rising edge is not made. The servo misses one of its 50 pulses per second, and holds its position.
//! - A late falling edge is made at once, because it cannot be omitted. The pulse is longer by the delay of the edge:
//!   10 us, or 160 cycles, turn an SG-90 by one degree for 20 ms. If interrupts stay off until the end of the slot, the
//!   start of the next slot ends the pulse.
//! - The function `late_edges` returns the number of late edges of both kinds.
//!
//! # Rules
//!
//! - The program's longest other handler and its longest time with interrupts off together take less than
//!   [`LEAD_CYCLES`] minus 60 cycles; the engine's own handler takes these 60 cycles before it reads the timer. If they
//!   take longer, the edge is late.
//! - Handlers do not enable other interrupts. Timer1's compare interrupts have priority over Timer0, the USART and all
//!   later vectors. INT0, INT1, PCINT, the watchdog and Timer2 have priority over Timer1: in a program that uses
//!   several of these interrupts, the times of their handlers add up.
//! - Interrupts must never be off for 62 us (1000 cycles). If the end of a slot is missed for this reason, the slot
//!   repeats without a pulse, and all later slots are delayed by one slot.
//! - Only the two handlers access Timer1, because all its 16-bit registers share one TEMP byte.
//! - All other code changes pins of the servo ports only with single `sbi` and `cbi` instructions, which no interrupt
//!   can split.

#![cfg_attr(not(test), no_std)]
#![allow(unsafe_code)] // Writing to ports and to the timer needs it.
#![cfg_attr(target_arch = "avr", feature(asm_experimental_arch))]

pub mod cells;
mod engine;
mod pin;
#[cfg(any(doc, target_arch = "avr"))]
mod store;
mod timing;

pub use engine::Engine;
pub use pin::Pin;
pub use timing::{
    CYCLES_PER_US, LEAD_CYCLES, MIN_WIDTH_CYCLES, frame_cycles, max_width_cycles, slot_cycles,
};

/// Makes the enclosing module the owner of Timer1 and of the pins of one to eight servos. Defines in this module the
/// functions `start`, `submit`, `is_taken`, `suppress_pulses`, `ticks` and `late_edges` of [`Engine`], and the handlers
/// of both compare interrupts.
///
/// - `engine!(PINS)` with a constant `PINS: [Pin; N]`, for pins that are known at compile time.
/// - `engine!(later: N)` for pins that are known only at run time; also defines the function `connect`.
///
/// Use this macro once in a program: a second use would define the handlers twice, which is a linker error.
#[macro_export]
macro_rules! engine {
    (later: $servo_count:expr) => {
        $crate::engine!(@ $servo_count, [const { [const { $crate::cells::SharedByte::new(0) }; 2] }; SIZE]);

        /// See `servo_pulses::Engine::connect`.
        #[inline(always)]
        pub fn connect(pins: [$crate::Pin; SERVO_COUNT]) {
            ENGINE.connect(pins);
        }

        /// See `servo_pulses::Engine::start`.
        ///
        /// # Safety
        /// Interrupts must be off, and no other code may use Timer1 from now on.
        #[inline(always)]
        pub unsafe fn start() {
            // SAFETY: the caller guarantees the same condition.
            unsafe { ENGINE.start() }
        }
    };
    (@ $servo_count:expr, $pins:expr) => {
        const SERVO_COUNT: usize = $servo_count;
        /// The length of the tables, a power of two, so that a mask keeps an index in range.
        const SIZE: usize = SERVO_COUNT.next_power_of_two();

        // These are separate variables, so that their addresses are part of the instructions. All but constant pins are
        // initially zero, so that they require no initial values in flash.
        static PINS: [[$crate::cells::SharedByte; 2]; SIZE] = $pins;
        static FRAMES: [[$crate::cells::SharedWord; SIZE]; 2] =
            [const { [const { $crate::cells::SharedWord::new(0) }; SIZE] }; 2];
        static PLAYED_FRAME: $crate::cells::SharedByte = $crate::cells::SharedByte::new(0);
        static HAS_NEW_FRAME: $crate::cells::SharedByte = $crate::cells::SharedByte::new(0);
        static SLOT: $crate::cells::SharedByte = $crate::cells::SharedByte::new(0);
        static PORT: $crate::cells::SharedByte = $crate::cells::SharedByte::new(0);
        static MASK: $crate::cells::SharedByte = $crate::cells::SharedByte::new(0);
        static FALL_COUNT: $crate::cells::SharedWord = $crate::cells::SharedWord::new(0);
        static ALLOWED_PINS: $crate::cells::SharedByte = $crate::cells::SharedByte::new(0);
        static TICKS: $crate::cells::SharedByte = $crate::cells::SharedByte::new(0);
        static LATE_EDGES: $crate::cells::SharedCounter = $crate::cells::SharedCounter::new();

        const ENGINE: $crate::Engine<'static, SERVO_COUNT, SIZE> = $crate::Engine {
            pins: &PINS,
            frames: &FRAMES,
            played_frame: &PLAYED_FRAME,
            has_new_frame: &HAS_NEW_FRAME,
            slot: &SLOT,
            port: &PORT,
            mask: &MASK,
            fall_count: &FALL_COUNT,
            allowed_pins: &ALLOWED_PINS,
            ticks: &TICKS,
            late_edges: &LATE_EDGES,
        };

        /// See `servo_pulses::Engine::submit`.
        #[inline(always)]
        pub fn submit<W: ::core::convert::Into<u16>>(widths: [W; SERVO_COUNT]) {
            ENGINE.submit(widths);
        }

        /// See `servo_pulses::Engine::is_taken`.
        #[inline(always)]
        #[allow(dead_code)]
        pub fn is_taken() -> bool {
            ENGINE.is_taken()
        }

        /// See `servo_pulses::Engine::suppress_pulses`.
        #[inline(always)]
        #[allow(dead_code)]
        pub fn suppress_pulses() {
            ENGINE.suppress_pulses();
        }

        /// See `servo_pulses::Engine::ticks`.
        #[inline(always)]
        #[allow(dead_code)]
        pub fn ticks() -> u8 {
            ENGINE.ticks()
        }

        /// See `servo_pulses::Engine::late_edges`.
        #[allow(dead_code)]
        pub fn late_edges() -> u16 {
            ENGINE.late_edges()
        }

        /// The handler TIMER1_COMPA of an ATmega328P: opens a slot.
        #[unsafe(export_name = "__vector_11")]
        extern "avr-interrupt" fn handle_slot_start() {
            // SAFETY: this is the handler of compare match A.
            unsafe { ENGINE.open_slot() }
        }

        /// The handler TIMER1_COMPB of an ATmega328P: closes a slot.
        #[unsafe(export_name = "__vector_12")]
        extern "avr-interrupt" fn handle_slot_end() {
            // SAFETY: this is the handler of compare match B.
            unsafe { ENGINE.close_slot() }
        }
    };
    ($pins:expr) => {
        $crate::engine!(@ $pins.len(), $crate::cells::pin_table($pins));

        /// See `servo_pulses::Engine::start`.
        ///
        /// # Safety
        /// Interrupts must be off, and no other code may use Timer1 from now on.
        #[inline(always)]
        pub unsafe fn start() {
            // SAFETY: the caller guarantees the same condition.
            unsafe { ENGINE.start_with_fixed_pins() }
        }
    };
}
