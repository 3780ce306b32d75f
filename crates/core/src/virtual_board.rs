//! The virtual board, for hosts: behaves like the UNO with its registers, pins and interrupts, but requires no chip.
//!
//! Every program that runs the core on a host (tests, the fuzzer, the page in a browser, the comparison with the
//! simulated UNO) runs [`Main::step`] on this board. Therefore all of them test the loop that the UNO repeats.
//! [`RunningRobot`] combines the board and the loop.
//!
//! Time passes only in calls of [`VirtualBoard::pass_time`], in milliseconds. The events in a frame of 20 ms:
//!
//! | ms | event |
//! |---|---|
//! | 0 | the tick, for which the main loop computes a frame |
//! | 4 | the board takes over the submitted frame, and A1's pulse begins |
//! | 8, 12, 16 | the pulses of A2, A3 and A4 begin |
//!
//! The board is compact, because it is cloned and hashed millions of times.
//!
//! [`Main::step`]: crate::step::Main::step

mod adc;
mod eeprom;
mod retained_ram;
mod running_robot;
mod transmitter;

use std::collections::VecDeque;

use crate::console::answer::Counters;
use crate::control::supply::Reading;
use crate::memory::restart::{Cause, Restart, ServoState};
use crate::memory::retained_ram::{mark_hung, store_rate, store_servo_state};
use crate::numbers::pose::Pulses;
use crate::numbers::rate::BaudRate;
use crate::numbers::units::{self, CYCLES_PER_US, PulseWidth};
use crate::step::Board;

pub use adc::{Adc, compute_reading};
pub use eeprom::Eeprom;
pub use retained_ram::RetainedRam;
pub use running_robot::{RunningRobot, is_answer};
pub use transmitter::Transmitter;

/// Milliseconds from one tick to the next.
pub const FRAME_MS: u8 = units::FRAME_MS as u8;

/// Milliseconds from the tick until the submitted frame is taken over, and from the start of each servo's pulse to the
/// start of the next servo's pulse.
const SLOT_MS: u8 = 4;

/// Milliseconds without feeding after which the watchdog interrupts the program. After twice this time the watchdog
/// resets the processor.
pub const WATCHDOG_MS: u16 = 125;

/// The capacity of the receive buffer, bytes.
const RECEIVE_CAPACITY: usize = 64;

/// The pulse widths that fit into a slot, CPU cycles; any other width results in no pulse.
const VALID_WIDTHS: core::ops::RangeInclusive<u16> = 1_000..=63_000;

/// A virtual board, with the state of a UNO's registers, memories and pins.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct VirtualBoard {
    /// Milliseconds since the last tick.
    ms_since_tick: u8,
    /// The number of ticks, modulo 256.
    ticks: u8,
    /// The last frame that the main loop submitted.
    submitted_pulses: Pulses,
    /// True while the submitted frame waits to be taken over.
    is_frame_pending: bool,
    /// The last frame that was taken over, which repeats until the next frame is taken over.
    played_pulses: Pulses,
    /// The pulses of the played frame that have begun since it was taken over or began to repeat.
    started_pulses: Pulses,
    /// True while the LED is lit.
    is_lit: bool,
    /// The bytes that the main loop has not read yet.
    received_bytes: VecDeque<u8>,
    /// The number of received bytes that were lost.
    pub lost_bytes: u16,
    /// The number of late pulse edges.
    pub late_edges: u16,
    /// True unless the stack has grown into the data.
    pub is_stack_intact: bool,
    /// The pins whose contacts are closed, one bit for each Arduino number.
    pub closed_pins: u32,
    /// The pins whose pull-ups are on, one bit for each Arduino number.
    pub pulled_up_pins: u32,
    /// The transmitter of the serial port.
    pub transmitter: Transmitter,
    /// The non-volatile memory.
    pub memory: Eeprom,
    /// The analogue-to-digital converter that measures the supplies.
    pub adc: Adc,
    /// The RAM that survives a reset.
    pub ram: RetainedRam,
    /// True if a boot loader hides the cause of a reset from the program.
    pub has_boot_loader: bool,
    /// The last restart, as reported to the main loop.
    last_restart: Restart,
    /// The baud rate of the serial port.
    pub rate: BaudRate,
    /// Milliseconds since the watchdog was fed.
    ms_since_fed: u16,
    /// True once the watchdog has ended the pulses.
    are_pulses_ended: bool,
    /// The pins of the servos and the pin that measures their supply, once the main loop has connected them.
    connected_pins: Option<([u8; 4], Option<u8>)>,
}

impl Default for VirtualBoard {
    fn default() -> Self {
        Self::new(Eeprom::default())
    }
}

impl VirtualBoard {
    /// Creates a board at power-on with this memory. Its supplies are not measured, so every reading is 0.
    pub fn new(memory: Eeprom) -> Self {
        Self {
            // The first tick occurs after 1 ms.
            ms_since_tick: FRAME_MS - 1,
            ticks: 0,
            submitted_pulses: Pulses::default(),
            is_frame_pending: false,
            played_pulses: Pulses::default(),
            started_pulses: Pulses::default(),
            is_lit: false,
            received_bytes: VecDeque::new(),
            lost_bytes: 0,
            late_edges: 0,
            is_stack_intact: true,
            closed_pins: 0,
            pulled_up_pins: 0,
            transmitter: Transmitter::default(),
            memory,
            adc: Adc::default(),
            ram: RetainedRam::default(),
            has_boot_loader: false,
            last_restart: Restart::NONE,
            rate: BaudRate::Fastest,
            ms_since_fed: 0,
            are_pulses_ended: false,
            connected_pins: None,
        }
    }

    /// Returns the board as it is after this restart.
    #[must_use]
    pub fn after_restart(self, restart: Restart) -> Self {
        if let Some(servo_state) = &restart.servo_state_before {
            store_servo_state(&self.ram, servo_state, restart.suspected_brown_outs);
        }
        Self {
            last_restart: restart,
            rate: restart.rate,
            ..self
        }
    }

    /// Lets milliseconds pass while the main loop does not run. Stops and returns true as soon as the watchdog resets
    /// the processor; [`VirtualBoard::reset`] must then follow.
    pub fn pass_time(&mut self, ms: u16) -> bool {
        for _ in 0..ms {
            self.ms_since_fed = self.ms_since_fed.saturating_add(1);
            if self.ms_since_fed == WATCHDOG_MS {
                self.are_pulses_ended = true;
                mark_hung(&self.ram);
            }
            if self.ms_since_fed >= 2 * WATCHDOG_MS {
                return true;
            }
            self.pass_one_ms();
        }
        false
    }

    fn pass_one_ms(&mut self) {
        self.transmitter.pass_time(1);
        self.memory.pass_one_ms();
        self.ms_since_tick += 1;
        if self.ms_since_tick == FRAME_MS {
            self.ms_since_tick = 0;
            self.ticks = self.ticks.wrapping_add(1);
        } else if self.ms_since_tick.is_multiple_of(SLOT_MS) {
            let servo = usize::from(self.ms_since_tick / SLOT_MS - 1);
            if servo == 0 {
                self.take_over_frame();
            }
            let width = self.played_pulses.0[servo];
            if !self.are_pulses_ended
                && self.connected_pins.is_some()
                && VALID_WIDTHS.contains(&width.0)
            {
                self.started_pulses.0[servo] = width;
            }
        }
    }

    /// Takes over the submitted frame and counts a tick, without letting time pass.
    pub fn tick(&mut self) {
        self.take_over_frame();
        self.ticks = self.ticks.wrapping_add(1);
    }

    fn take_over_frame(&mut self) {
        if self.is_frame_pending {
            self.played_pulses = self.submitted_pulses;
            self.is_frame_pending = false;
        }
        self.started_pulses = Pulses([PulseWidth(0); 4]);
    }

    /// Milliseconds until the next tick.
    pub const fn ms_until_tick(&self) -> u16 {
        (FRAME_MS - self.ms_since_tick) as u16
    }

    /// Resets the processor, whose state is lost. The main loop must then start again.
    pub fn reset(&mut self, cause: Cause) {
        let is_power_on = cause == Cause::Power;
        let reported_cause = (!self.has_boot_loader).then_some(cause);
        let ram = core::mem::take(&mut self.ram);
        let mut memory = core::mem::take(&mut self.memory);
        // The program's start takes longer than writing a byte to the memory.
        memory.complete_write();
        *self = Self {
            transmitter: core::mem::take(&mut self.transmitter).after_reset(),
            adc: core::mem::take(&mut self.adc).after_reset(),
            has_boot_loader: self.has_boot_loader,
            closed_pins: self.closed_pins,
            last_restart: ram.begin(reported_cause),
            ram,
            ..Self::new(memory)
        };
        if is_power_on {
            self.ram = RetainedRam::default();
            self.last_restart = Restart::NONE;
        }
        self.rate = self.last_restart.rate;
    }

    /// Switches the power off and on. A byte that is being written to the memory gets the value `torn_byte`, because it
    /// may have any value after a power cut; with `None`, the write is completed.
    pub fn cycle_power(&mut self, torn_byte: Option<u8>) {
        if let Some(byte) = torn_byte {
            self.memory.cut_power(byte);
        }
        self.reset(Cause::Power);
    }

    /// Sends bytes to the board, and counts those that do not fit into its receive buffer as lost.
    pub fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            if self.received_bytes.len() < RECEIVE_CAPACITY {
                self.received_bytes.push_back(*byte);
            } else {
                self.lost_bytes = self.lost_bytes.saturating_add(1);
            }
        }
    }

    /// The number of bytes that the main loop has not read yet.
    pub fn unread_count(&self) -> usize {
        self.received_bytes.len()
    }

    /// The last frame that the main loop submitted.
    pub const fn submitted_pulses(&self) -> Pulses {
        self.submitted_pulses
    }

    /// True while the submitted frame waits to be taken over.
    pub const fn is_frame_pending(&self) -> bool {
        self.is_frame_pending
    }

    /// The pulses of the played frame that have begun since it was taken over or began to repeat.
    pub const fn started_pulses(&self) -> Pulses {
        self.started_pulses
    }

    /// True while the LED is lit.
    pub const fn is_lit(&self) -> bool {
        self.is_lit
    }

    /// Milliseconds since the watchdog was fed.
    pub const fn ms_since_fed(&self) -> u16 {
        self.ms_since_fed
    }

    /// True once the watchdog has ended the pulses, and the main loop has stopped until the reset.
    pub const fn are_pulses_ended(&self) -> bool {
        self.are_pulses_ended
    }
}

impl Board for VirtualBoard {
    type Writer = Transmitter;
    type Memory = Eeprom;

    const WRITER_CAPACITY: u8 = u8::MAX;
    const CYCLES_PER_US: u16 = CYCLES_PER_US;

    fn connect(&mut self, servo_pins: [u8; 4], rail_pin: Option<u8>) {
        self.connected_pins = Some((servo_pins, rail_pin));
    }

    fn ticks(&self) -> u8 {
        self.ticks
    }

    fn is_frame_taken(&self) -> bool {
        !self.is_frame_pending
    }

    fn submit(&mut self, pulses: Pulses) {
        self.submitted_pulses = pulses;
        self.is_frame_pending = true;
    }

    fn feed_watchdog(&mut self) {
        self.ms_since_fed = 0;
    }

    fn store_servo_state(&mut self, servo_state: &ServoState, suspected_brown_outs: u8) {
        store_servo_state(&self.ram, servo_state, suspected_brown_outs);
    }

    fn last_restart(&self) -> &Restart {
        &self.last_restart
    }

    fn read_supply(&mut self) -> Reading {
        self.adc.advance_frame()
    }

    fn is_stack_intact(&self) -> bool {
        self.is_stack_intact
    }

    fn is_contact_closed(&mut self, pin: u8) -> bool {
        self.pulled_up_pins |= 1 << pin;
        self.closed_pins & 1 << pin != 0
    }

    fn memory(&mut self) -> &mut Eeprom {
        &mut self.memory
    }

    fn set_led(&mut self, is_on: bool) {
        self.is_lit = is_on;
    }

    fn room(&self) -> u8 {
        self.transmitter.room()
    }

    fn writer(&mut self) -> &mut Transmitter {
        &mut self.transmitter
    }

    fn receive(&mut self) -> Option<u8> {
        self.received_bytes.pop_front()
    }

    fn set_rate(&mut self, rate: BaudRate) {
        self.rate = rate;
        store_rate(&self.ram, rate);
    }

    fn counters(&self) -> Counters {
        Counters {
            late_edges: self.late_edges,
            rx_lost: self.lost_bytes,
        }
    }
}

#[cfg(test)]
mod tests;
