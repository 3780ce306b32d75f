//! A state of the search: the firmware, its board, and an observer that checks the robot against the rules.
//! Main is the core's main loop.

mod checks;
mod lines;

use std::hash::{DefaultHasher, Hash, Hasher};

use lizard_core::console::line::GARBLED_BYTE;
use lizard_core::control::fault::Fault;
use lizard_core::memory::copies::{COPY_ADDRESSES, REST_POSE_ADDRESS};
use lizard_core::memory::record::{RECORD_BYTES, VALID_MARK};
use lizard_core::memory::restart::{Cause, Restart};
use lizard_core::numbers::rate::BaudRate;
use lizard_core::numbers::robot::Robot;
use lizard_core::step::Board;
use lizard_core::virtual_board::{Eeprom, RunningRobot, compute_reading};
use lizard_rules::{Event, MS, Observer, Rule, Time, Violation, led};

use crate::action::Action;
use crate::fingerprint::{Fingerprint, coarse_fingerprint};
use crate::small_robot::{BUTTON_PIN, NOSE_PIN};

/// The verdict of the rules: `Ok`, or the first violation.
pub type Verdict = Result<(), Violation>;

fn violation(rule: Rule, observation: impl Into<String>) -> Verdict {
    Err(Violation::new(rule, observation))
}

/// The bytes that a receiver gets if a line is sent at another baud rate: enough wrong bytes to make the robot change
/// its rate.
const UNREADABLE_BYTES: [u8; 40] = [GARBLED_BYTE; 40];

/// Number of lines within which the robot must find the sender's baud rate.
const MAX_LINES_TO_FIND_RATE: usize = 12;

/// Duration of a frame, cycles.
const FRAME: Time = 20 * MS;

/// A state of the search.
#[derive(Clone, Debug)]
pub struct World {
    /// The firmware, running on its board.
    pub running_robot: RunningRobot,
    /// The observer, which sees the robot from outside.
    pub observer: Observer,
    now: Time,
    /// True while the supply is weak: three awake servos then cause a brown-out.
    is_supply_weak: bool,
    /// The time of the last late edge.
    late_edge_at: Time,
    /// True if main was late for the last frame.
    was_main_late: bool,
    /// The last line that was sent; `None` once its answer has been checked, which may be before the answer is printed.
    unchecked_line: Option<&'static str>,
    /// The baud rate at which lines are sent.
    sender_rate: BaudRate,
    /// The number of answers that have been checked, but not printed yet.
    checked_answer_count: u8,
}

impl World {
    /// Returns the state just after power-on.
    pub fn power_on(robot: Robot<'static>, mut memory: Eeprom) -> Self {
        memory.write_delay = 4;
        memory.is_timed = true;
        let mut world = Self {
            running_robot: RunningRobot::with_eeprom(robot, memory, Restart::NONE),
            observer: Observer::new(checks::observer_limits(&robot)),
            now: 0,
            is_supply_weak: false,
            late_edge_at: Time::MIN / 2,
            was_main_late: false,
            unchecked_line: None,
            sender_rate: BaudRate::Fastest,
            checked_answer_count: 0,
        };
        world.observe(Event::SupplyMv(5_000));
        world.observe(Event::ProgramStart(Cause::Power));
        world
    }

    /// Returns the state's fingerprint. The search treats states with the same fingerprint as one.
    pub fn fingerprint(&self) -> u64 {
        let board = &self.running_robot.board;
        let mut fingerprint = Fingerprint(coarse_fingerprint(&self.running_robot.main));
        let mut hasher = DefaultHasher::new();
        self.observer.coarse_state().hash(&mut hasher);
        fingerprint.add(hasher.finish());
        let memory = board.memory.bytes();
        for address in COPY_ADDRESSES.into_iter().chain([REST_POSE_ADDRESS]) {
            let record = &memory[usize::from(address.0)..][..usize::from(RECORD_BYTES)];
            // The firmware never uses the content of an invalid record.
            let used_bytes = match record[0] {
                VALID_MARK => record,
                _ => &record[..2],
            };
            for byte in used_bytes {
                fingerprint.add(u64::from(*byte));
            }
        }
        fingerprint.add(coarse_fingerprint(&board.ram.peek_restart(None)));
        fingerprint.add(u64::from(self.robot().hash()));
        fingerprint.add(u64::from(board.rate as u8) << 2 | u64::from(self.sender_rate as u8));
        let reading = board.adc.true_reading();
        let flags = [
            board.memory.is_worn,
            board.has_boot_loader,
            board.memory.address_in_write().is_some(),
            board.are_pulses_ended(),
            board.is_stack_intact,
            board.adc.is_complete(),
            board.transmitter.is_held,
            board.last_restart().servo_state_before.is_some(),
            board.unread_count() > 0,
            board.is_frame_pending(),
            board.closed_pins & 1 << BUTTON_PIN != 0,
            board.closed_pins & 1 << NOSE_PIN != 0,
            self.is_supply_weak,
            self.was_main_late,
            self.checked_answer_count > 0,
        ];
        let append = |bits: u64, flag: bool| bits << 1 | u64::from(flag);
        fingerprint.add(flags.into_iter().fold(reading.reference.into(), append));
        fingerprint.0
    }

    /// True if the action is possible now.
    pub fn is_possible(&self, action: Action) -> bool {
        let board = &self.running_robot.board;
        match action {
            Action::Line(_) | Action::GarbledLine => {
                board.unread_count() == 0
                    && !board.transmitter.is_held
                    && !self.running_robot.board.are_pulses_ended()
            }
            Action::MainStep => {
                let has_task = self.running_robot.has_output()
                    || self.running_robot.main.control().is_memory_in_use();
                // The watchdog's interrupt, which ends the pulses, does not return to main.
                has_task && !board.are_pulses_ended()
            }
            Action::Frames(_)
            | Action::Stall(_)
            | Action::Reset(_)
            | Action::PowerLoss(None)
            | Action::SupplyMv(_) => true,
            Action::PowerLoss(Some(_)) => board.memory.address_in_write().is_some(),
            Action::SenderRate(rate) => rate != self.sender_rate,
            Action::WeakSupply(is_weak) => is_weak != self.is_supply_weak,
            Action::LateEdge => board.late_edges < 3,
            Action::StackOverflow => board.is_stack_intact,
            Action::Contact(pin, is_closed) => is_closed != (board.closed_pins & 1 << pin != 0),
            Action::HeldOutput(is_held) => is_held != board.transmitter.is_held,
        }
    }

    /// Applies an action.
    ///
    /// # Errors
    /// Returns the first violation that the action causes.
    pub fn apply(&mut self, action: Action) -> Verdict {
        // After a pulse, the saved rest pose must be invalidated as soon as the supply allows it.
        let must_keep_rest_pose = self.observer.must_rest()
            && !self.observer.has_pulsed_since_rest()
            && self.is_rest_pose_saved();
        let start = self.now;
        match action {
            Action::Line(_) | Action::GarbledLine
                if self.sender_rate != self.running_robot.board.rate =>
            {
                self.send_line_at_other_rate()?;
            }
            Action::Line(line) => self.send_line(line, line.as_bytes())?,
            Action::SenderRate(rate) => {
                self.sender_rate = rate;
                self.check_rate_is_found()?;
            }
            Action::GarbledLine => self.send_line("", &[b'w', b'a', GARBLED_BYTE, b'k'])?,
            Action::MainStep => {
                self.running_robot.main.step(&mut self.running_robot.board);
                self.observe_output(self.now)?;
            }
            Action::Frames(count) => self.run_frames(count)?,
            Action::Stall(ms) => self.stall_main(ms)?,
            Action::SupplyMv(mv) => {
                let reading = compute_reading(&self.robot().supplies(), u32::from(mv), 0);
                self.running_robot.board.adc.set_true_reading(reading);
                self.observe(Event::SupplyMv(u32::from(mv)));
            }
            Action::WeakSupply(is_weak) => self.is_supply_weak = is_weak,
            Action::LateEdge => {
                self.running_robot.board.late_edges += 1;
                self.late_edge_at = self.now;
                self.observe(Event::Fault);
                self.run_frame()?;
            }
            Action::StackOverflow => {
                self.running_robot.board.is_stack_intact = false;
                self.observe(Event::Fault);
                self.run_frame()?;
            }
            Action::Reset(cause) => self.reset(cause),
            Action::PowerLoss(torn_byte) => {
                self.running_robot.cycle_power(torn_byte);
                self.record_restart(Cause::Power);
            }
            Action::Contact(pin, is_closed) => self.set_contact(pin, is_closed)?,
            Action::HeldOutput(is_held) => self.running_robot.board.transmitter.is_held = is_held,
        }
        // `boot` may have woken the robot meanwhile.
        let is_resting = self.running_robot.motion().is_resting();
        let has_woken = self.observer.has_pulsed_since(start);
        if must_keep_rest_pose && is_resting && !has_woken && !self.is_rest_pose_saved() {
            return violation(Rule::RestPoseKept, action.to_string());
        }
        self.check_writes()?;
        self.observer.drop_pending_promises();
        self.observer.take_verdict()
    }

    fn observe(&mut self, event: Event<'_>) {
        self.observer.observe(self.now, event);
    }

    fn robot(&self) -> Robot<'static> {
        *self.running_robot.motion().robot()
    }

    fn reset(&mut self, cause: Cause) {
        self.running_robot.reset(cause);
        self.record_restart(cause);
    }

    /// Records that the program has restarted. The output that was not yet printed is lost.
    fn record_restart(&mut self, cause: Cause) {
        self.running_robot.board.transmitter.text.clear();
        self.unchecked_line = None;
        self.checked_answer_count = 0;
        self.observe(Event::ProgramStart(cause));
    }

    /// Runs several frames. From 100 frames on, also checks that all lines have been answered and that the LED shows
    /// the fault.
    fn run_frames(&mut self, count: u8) -> Verdict {
        let start = self.now;
        let (code_before, stop_time_before) = (self.fault_code(), self.observer.stop_time());
        let mut led_changes = Vec::new();
        let mut is_code_unchanged = true;
        for _ in 0..count {
            let was_lit = self.running_robot.board.is_lit();
            self.run_frame()?;
            is_code_unchanged &= self.fault_code() == code_before;
            let is_lit = self.running_robot.board.is_lit();
            if is_lit != was_lit {
                led_changes.push((self.now, is_lit));
            }
        }
        if count < 100 || self.running_robot.board.transmitter.is_held {
            return Ok(());
        }
        if self.observer.has_unanswered_lines() {
            return violation(Rule::AnswersAgain, "no answer within 100 frames");
        }
        let is_stop_unchanged = is_code_unchanged && self.observer.stop_time() == stop_time_before;
        if is_stop_unchanged && self.observer.time_since_start() > self.now - start {
            led::check_pattern(&led_changes, start + 3 * FRAME, self.now, code_before)
                .map_err(|message| Violation::new(Rule::LedShowsFault, message))?;
        }
        Ok(())
    }

    /// Returns the code of the fault that stopped the robot, or 0 if there is none.
    fn fault_code(&self) -> u8 {
        let fault = self.running_robot.main.control().fault();
        fault.map_or(0, Fault::code)
    }

    fn run_frame(&mut self) -> Verdict {
        if self.running_robot.board.are_pulses_ended() {
            // Main no longer runs; the watchdog resets the processor soon.
            return self.stall_main(20);
        }
        // If the guard has held the robot since an earlier frame, this has been reported already.
        let had_hazard = self.running_robot.motion().hazard().is_some();
        let frame_start = self.now;
        let was_resting = self.running_robot.motion().is_resting();
        self.running_robot.run_frame();
        if self.running_robot.board.transmitter.is_held
            && self.running_robot.motion().is_resting() != was_resting
        {
            self.observe_held_boot_lines();
        }
        self.check_pulses(true)?;
        if !had_hazard && self.running_robot.motion().hazard().is_some() {
            self.observe(Event::Fault);
        }
        // Main composes its lines at the start of the frame.
        self.observe_output(frame_start + MS)?;
        self.check_writes()?;
        let is_output_read = !self.running_robot.board.transmitter.is_held
            && !self.running_robot.board.are_pulses_ended();
        if is_output_read && !self.was_main_late {
            self.observer.check_stop_is_reported();
        }
        self.was_main_late = false;
        let pulses = self.running_robot.board.started_pulses();
        let awake_count = pulses.0.iter().filter(|width| width.0 > 0).count();
        if self.is_supply_weak && awake_count == 3 {
            self.reset(Cause::BrownOut);
        }
        self.observer.take_verdict()
    }

    /// Stalls main for `ms`. If the stall ends within a frame, main runs in the rest of this frame. A reset by the
    /// watchdog ends the stall.
    fn stall_main(&mut self, ms: u16) -> Verdict {
        self.observe(Event::MainStalled(self.now + Time::from(ms) * MS));
        for _ in 0..ms / 20 {
            if self.pass_time(20) {
                return self.observe_output(self.now);
            }
            self.check_pulses(false)?;
        }
        let remaining_ms = ms % 20;
        if remaining_ms > 0 {
            if self.pass_time(remaining_ms) {
                return self.observe_output(self.now);
            }
            self.running_robot.settle();
            if self.pass_time(20 - remaining_ms) {
                return self.observe_output(self.now);
            }
            self.check_pulses(false)?;
        }
        // Main may have composed its lines during the last frame.
        self.observe_output(self.now - FRAME)
    }

    /// Lets time pass without running main. Returns true if the watchdog has reset the processor.
    fn pass_time(&mut self, ms: u16) -> bool {
        let was_reset = self.running_robot.board.pass_time(ms);
        if was_reset {
            self.reset(Cause::Watchdog);
        }
        was_reset
    }

    /// Checks that no byte was written to the EEPROM before the supply was measured.
    fn check_writes(&mut self) -> Verdict {
        let log = &mut self.running_robot.board.memory.log;
        if !log.is_empty() {
            log.clear();
            if !self.running_robot.board.adc.is_complete() {
                let observation = "a byte is written before the supply is measured";
                return violation(Rule::SafeWrites, observation);
            }
            self.observe(Event::ByteWritten);
        }
        self.observer.take_verdict()
    }
}
