//! The step that a firmware's main loop repeats.
//!
//! A tick (every 20 ms), a received byte, or a transmit buffer that becomes empty wakes the main loop. Each step does
//! one task, and a tick has priority, so a frame waits for at most one byte or one line. The loop reads no input while
//! it writes the EEPROM (3.4 ms per byte), or while an answer or a notice waits for room in the transmit buffer; it
//! does while only a report of the pose waits. Frames and EEPROM writes continue even if nobody reads the output.
//!
//! The loop computes one frame per tick. If several ticks have passed, the loop still computes only one frame: of
//! several frames only the last would be played, and the servos would jump. While the pulses run, the loop also skips a
//! tick if the previous frame still waits to be played.

use lizard_avr::Region;

use crate::console::answer::Counters;
use crate::console::output::Output;
use crate::console::{Console, MAX_OUTPUT_LINE_BYTES};
use crate::control::Controller;
use crate::control::safety::Health;
use crate::control::supply::Reading;
use crate::memory::record::Memory;
use crate::memory::restart::{Restart, ServoState};
use crate::numbers::pose::Pulses;
use crate::numbers::rate::BaudRate;
use crate::numbers::units::CYCLES_PER_US;

/// The hardware that the main loop requires.
pub trait Board {
    /// The writer to the serial port.
    type Writer: Output;

    /// The non-volatile memory, an EEPROM.
    type Memory: Memory;

    /// The number of bytes that an idle writer accepts without waiting; at least [`MAX_OUTPUT_LINE_BYTES`], because a
    /// line is written only when there is room for the whole line.
    const WRITER_CAPACITY: u8;

    /// The number of CPU cycles, the unit of pulse widths, in a microsecond; must be 16, as in the core.
    const CYCLES_PER_US: u16;

    /// Connects the servos A1 to A4, and the measured rail if any, to the pins with these Arduino numbers; 14 to 19 are
    /// the analogue pins A0 to A5. Called once, before the first pulses.
    fn connect(&mut self, servo_pins: [u8; 4], rail_pin: Option<u8>);

    /// The number of ticks since the program's start, modulo 256; the interval is 20 ms.
    fn ticks(&self) -> u8;

    /// True unless submitted pulses wait to be taken over. The main loop submits pulses in every frame, so this shows
    /// that the clock and the generation of pulses work.
    fn is_frame_taken(&self) -> bool;

    /// Submits the pulses of the next frame, which replace submitted pulses that have not been taken over.
    fn submit(&mut self, pulses: Pulses);

    /// Feeds the watchdog, which resets a program that hangs. A watchdog interrupt that has ended the pulses must not
    /// return to the main loop, and nothing may delay the reset.
    fn feed_watchdog(&mut self);

    /// Stores the servo state, and the number of consecutive resets that a weak supply may have caused, in RAM that
    /// survives a reset of the processor.
    fn store_servo_state(&mut self, servo_state: &ServoState, suspected_brown_outs: u8);

    /// The information that survived the last reset.
    fn last_restart(&self) -> &Restart;

    /// Returns the last measurement of the supplies, and starts the next measurement.
    fn read_supply(&mut self) -> Reading;

    /// True unless the stack has grown into the data.
    fn is_stack_intact(&self) -> bool;

    /// Reads the contact between a pin, given by its Arduino number, and ground: true while the contact is closed. Also
    /// switches the pin's pull-up on.
    fn is_contact_closed(&mut self, pin: u8) -> bool;

    /// The non-volatile memory.
    fn memory(&mut self) -> &mut Self::Memory;

    /// Switches the LED on or off.
    fn set_led(&mut self, is_on: bool);

    /// The number of bytes that the writer accepts now without waiting.
    fn room(&self) -> u8;

    /// The writer to the serial port.
    fn writer(&mut self) -> &mut Self::Writer;

    /// Takes the next received byte, if any, or [`crate::console::line::GARBLED_BYTE`] in place of a garbled byte.
    fn receive(&mut self) -> Option<u8>;

    /// Changes the baud rate, and stores it in RAM that survives a reset.
    fn set_rate(&mut self, rate: BaudRate);

    /// The numbers of late pulse edges and of lost bytes since the program's start.
    fn counters(&self) -> Counters;
}

/// The main loop: the robot's controller, and its console on the serial port.
#[derive(Clone, Debug)]
pub struct Main {
    control: Controller,
    console: Console,
    /// The last tick for which the main loop computed or skipped a frame.
    last_tick: u8,
}

/// The result of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepResult {
    /// The step did a task; there may be more tasks.
    Worked,
    /// There is no task until [`Board::ticks`] differs from this number, a byte is received, or the writer has room for
    /// a waiting line.
    Idle(u8),
}

impl Main {
    /// Creates a main loop that has no robot; [`Main::begin`] must follow.
    ///
    /// All bits of the main loop are zero, so that a firmware's `Main` requires no initial values in flash; the linker
    /// script rejects initial values.
    pub const fn new() -> Self {
        Self {
            control: Controller::new(),
            console: Console::new(),
            last_tick: 0,
        }
    }

    /// Starts the main loop on a board, with the robot at the beginning of `flash`. Call this function once, before the
    /// first step.
    #[inline(always)]
    pub fn begin<B: Board>(&mut self, flash: Region<'static>, board: &mut B) {
        const {
            assert!(B::WRITER_CAPACITY >= MAX_OUTPUT_LINE_BYTES);
            assert!(B::CYCLES_PER_US == CYCLES_PER_US);
        }
        let restart = *board.last_restart();
        self.control.begin(flash, board.memory(), &restart);
        self.console.set_initial_rate(restart.rate);
        let robot = self.control.motion().robot();
        if !robot.is_none() {
            board.connect(robot.pins(), robot.rail_pin());
        }
        self.last_tick = board.ticks();
    }

    /// The robot's controller.
    pub const fn control(&self) -> &Controller {
        &self.control
    }

    /// The console on the serial port.
    pub const fn console(&self) -> &Console {
        &self.console
    }

    /// Does the most urgent task.
    #[inline(always)]
    pub fn step<B: Board>(&mut self, board: &mut B) -> StepResult {
        let ticks = board.ticks();
        let has_output = self.console.has_output(&self.control);
        if ticks != self.last_tick {
            self.last_tick = ticks;
            if board.is_frame_taken() {
                board.feed_watchdog();
            } else if !self.control.motion().is_resting() {
                return StepResult::Worked;
            }
            let health = Health {
                supply: board.read_supply(),
                late_edges: board.counters().late_edges,
                is_stack_intact: board.is_stack_intact(),
                is_contact_closed: match self.control.awaited_input().pin() {
                    0 => false,
                    pin => board.is_contact_closed(pin),
                },
            };
            board.submit(self.control.compute_frame(&health));
            self.store_servo_state(board);
            board.set_led(self.control.safety().is_lit());
            if let Some(rate) = self.console.advance_frame(&self.control) {
                board.set_rate(rate);
            }
        } else if has_output && board.room() >= MAX_OUTPUT_LINE_BYTES {
            let counters = board.counters();
            let out = board.writer();
            self.console.write_line(&mut self.control, out, counters);
        } else if self.control.is_waiting_for_supply() {
            return StepResult::Idle(self.last_tick);
        } else if self.control.is_memory_in_use() {
            if let Some(outcome) = self.control.advance_operation(board.memory()) {
                self.console.finish_order(outcome);
            }
        } else if !self.console.blocks_input(&self.control)
            && let Some(byte) = board.receive()
        {
            let was_resting = self.control.motion().is_resting();
            self.console.receive(byte, &mut self.control);
            // The servo state is stored before the answer is written, because a reset may follow the answer at once.
            if self.control.motion().is_resting() != was_resting {
                self.store_servo_state(board);
            }
        } else {
            return StepResult::Idle(self.last_tick);
        }
        StepResult::Worked
    }

    /// Stores the state of the servos for the run after a reset. A run without a robot leaves the stored state as it
    /// is, because it knows nothing about the servos: an upload of the robot may have been interrupted.
    fn store_servo_state<B: Board>(&self, board: &mut B) {
        if self.control.motion().robot().is_none() {
            return;
        }
        board.store_servo_state(
            self.control.motion().servo_state(),
            self.control.suspected_brown_outs(),
        );
    }
}

#[cfg(test)]
mod tests;
