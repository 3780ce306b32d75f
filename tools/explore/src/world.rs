//! A state of the search: a robot, the board it runs on, and an observer that checks the rules.

mod inside;
mod lines;

use lizard_core::console::line::GARBLED_BYTE;
use lizard_core::control::fault::Fault;
use lizard_core::memory::copies::{COPY_ADDRESSES, REST_POSE_ADDRESS};
use lizard_core::memory::record::{RECORD_BYTES, VALID_MARK};
use lizard_core::memory::restart::{Cause, Restart};
use lizard_core::numbers::rate::BaudRate;
use lizard_core::numbers::robot::Robot;
use lizard_core::step::Board;
use lizard_core::virtual_board::{Eeprom, RunningRobot, compute_reading};
use lizard_rules::{BrokenRule, Event, MS, Observer, Rule, Time, led};

use crate::action::Action;
use crate::fingerprint::{self, Fingerprint};
use crate::small::{BUTTON, NOSE};

/// The verdict of the rules.
pub type Verdict = Result<(), BrokenRule>;

fn broken(rule: Rule, seen: impl Into<String>) -> Verdict {
    Err(BrokenRule::new(rule, seen))
}

/// The bytes that a receiver at another rate reads in place of a line: enough wrong bytes to make the robot
/// leave any rate.
const UNREADABLE: [u8; 40] = [GARBLED_BYTE; 40];

/// Number of lines within which a robot must find the rate of the sender.
const MAX_LINES_TO_FIND_RATE: usize = 12;

/// The cycles of a frame.
const FRAME: Time = 20 * MS;

/// A state of the search.
#[derive(Clone, Debug)]
pub struct World {
    /// The firmware on its board.
    pub running: RunningRobot,
    /// The observer, which sees the robot from outside.
    pub observer: Observer,
    now: Time,
    /// True while three servos that wake pull the supply down.
    sags_when_servos_wake: bool,
    /// True if main was late for the last frame.
    is_late: bool,
    /// The last line that was sent, until its answer is known.
    unread: Option<&'static str>,
    /// The rate at which lines are sent.
    sender_rate: BaudRate,
    /// Number of lines whose answers are judged already and not printed yet.
    judged_answers: u8,
}

impl World {
    /// Returns a robot whose power has just come on.
    pub fn power_on(robot: Robot<'static>, mut memory: Eeprom) -> Self {
        memory.write_delay = 4;
        memory.is_timed = true;
        let mut world = Self {
            running: RunningRobot::with_memory(robot, memory, Restart::default()),
            observer: Observer::new(inside::limits(&robot)),
            now: 0,
            sags_when_servos_wake: false,
            is_late: false,
            unread: None,
            sender_rate: BaudRate::Fastest,
            judged_answers: 0,
        };
        world.observe(Event::Supply(5_000));
        world.observe(Event::Start(Cause::Power));
        world
    }

    /// Returns the number that equal states share.
    pub fn fingerprint(&self) -> u64 {
        let board = &self.running.board;
        let mut fingerprint = Fingerprint(fingerprint::coarse_fingerprint(&self.running.main));
        fingerprint.add(fingerprint::coarse_fingerprint(&self.observer.coarse()));
        let memory = board.memory.bytes();
        for record in COPY_ADDRESSES
            .map(|copy| copy.0)
            .into_iter()
            .chain([REST_POSE_ADDRESS.0])
        {
            let record = &memory[usize::from(record)..][..usize::from(RECORD_BYTES)];
            // The firmware never uses the content of an invalid record.
            let used_bytes = if record[0] == VALID_MARK {
                record
            } else {
                &record[..2]
            };
            for byte in used_bytes {
                fingerprint.add(u64::from(*byte));
            }
        }
        fingerprint.add(fingerprint::coarse_fingerprint(
            &board.ram.peek_restart(None),
        ));
        fingerprint.add(u64::from(board.rate as u8) << 2 | u64::from(self.sender_rate as u8));
        let reading = board.converter.true_reading();
        let flags = [
            board.memory.is_worn,
            board.has_boot_loader,
            board.memory.address_in_write().is_some(),
            board.are_pulses_ended(),
            board.is_stack_intact,
            board.converter.is_complete(),
            board.transmitter.is_held,
            board.last_restart().stance_before.is_some(),
            board.unread_count() > 0,
            board.is_frame_pending(),
            board.closed_pins & 1 << BUTTON != 0,
            board.closed_pins & 1 << NOSE != 0,
            self.sags_when_servos_wake,
            self.is_late,
            self.judged_answers > 0,
        ];
        fingerprint.add(
            flags
                .iter()
                .fold(u64::from(reading.reference), |bits, flag| {
                    bits << 1 | u64::from(*flag)
                }),
        );
        fingerprint.0
    }

    /// True if the action is possible now.
    pub fn is_possible(&self, action: Action) -> bool {
        let board = &self.running.board;
        match action {
            Action::Say(_) | Action::Noise => {
                board.unread_count() == 0
                    && !board.transmitter.is_held
                    && !self.running.is_stopped_by_watchdog()
            }
            Action::Step => {
                self.running.has_output() || self.running.main.control().is_memory_in_use()
            }
            Action::Frames(_)
            | Action::Stall(_)
            | Action::Reset(_)
            | Action::LosePower(None)
            | Action::Supply(_) => true,
            Action::LosePower(Some(_)) => board.memory.address_in_write().is_some(),
            Action::SendAt(rate) => rate != self.sender_rate,
            Action::Weak(is_weak) => is_weak != self.sags_when_servos_wake,
            Action::Late => board.late_edges < 3,
            Action::Stack => board.is_stack_intact,
            Action::Contact(pin, is_closed) => is_closed != (board.closed_pins & 1 << pin != 0),
            Action::StopReading(is_deaf) => is_deaf != board.transmitter.is_held,
        }
    }

    /// Applies an action.
    ///
    /// # Errors
    /// Returns the first rule that the action breaks.
    pub fn apply(&mut self, action: Action) -> Verdict {
        let was_kept = self.observer.rests() && self.rest_is_kept();
        match action {
            Action::Say(_) | Action::Noise if self.sender_rate != self.running.board.rate => {
                self.say_at_another_rate()?;
            }
            Action::Say(line) => self.say(line, line.as_bytes())?,
            Action::SendAt(rate) => {
                self.sender_rate = rate;
                self.check_rate_is_found()?;
            }
            Action::Noise => self.say("", &[b'w', b'a', GARBLED_BYTE, b'k'])?,
            Action::Step => {
                self.running.main.step(&mut self.running.board);
                self.listen(self.now)?;
            }
            Action::Frames(count) => self.run_frames(count)?,
            Action::Stall(ms) => self.stall(ms)?,
            Action::Supply(mv) => {
                let supplies = self.robot().supplies();
                let reading = compute_reading(&supplies, u32::from(mv), 0);
                self.running.board.converter.set_true_reading(reading);
                self.observe(Event::Supply(u32::from(mv)));
            }
            Action::Weak(is_weak) => self.sags_when_servos_wake = is_weak,
            Action::Late => {
                self.running.board.late_edges += 1;
                self.observe(Event::Fault);
                self.frame()?;
            }
            Action::Stack => {
                self.running.board.is_stack_intact = false;
                self.observe(Event::Fault);
                self.frame()?;
            }
            Action::Reset(cause) => self.reset(cause),
            Action::LosePower(torn_byte) => {
                self.running.lose_power(torn_byte);
                self.note_restart(Cause::Power);
            }
            Action::Contact(pin, is_closed) => self.set_contact(pin, is_closed)?,
            Action::StopReading(is_deaf) => self.running.board.transmitter.is_held = is_deaf,
        }
        let is_resting = self.running.motion().is_resting();
        if was_kept && is_resting && !self.rest_is_kept() {
            return broken(Rule::RestKept, action.to_string());
        }
        self.judge_writes()?;
        self.observer.drop_pending();
        self.observer.verdict()
    }

    fn observe(&mut self, event: Event<'_>) {
        self.observer.observe(self.now, event);
    }

    fn robot(&self) -> Robot<'static> {
        *self.running.motion().robot()
    }

    fn reset(&mut self, cause: Cause) {
        self.running.reset(cause);
        self.note_restart(cause);
    }

    /// Records that the program has restarted, which cuts its output off.
    fn note_restart(&mut self, cause: Cause) {
        self.running.board.transmitter.text.clear();
        self.unread = None;
        self.judged_answers = 0;
        self.observe(Event::Start(cause));
    }

    /// Runs some frames, with main running.
    fn run_frames(&mut self, count: u8) -> Verdict {
        let start = self.now;
        let stop_before = (self.fault(), self.observer.stopped_since());
        let mut edges = Vec::new();
        for _ in 0..count {
            let was_lit = self.running.board.is_lit();
            self.frame()?;
            let is_lit = self.running.board.is_lit();
            if is_lit != was_lit {
                edges.push((self.now, is_lit));
            }
        }
        if count < 100 || self.running.board.transmitter.is_held {
            return Ok(());
        }
        if self.observer.has_unanswered_lines() {
            return broken(Rule::Answered, "frames went by");
        }
        let is_same = (self.fault(), self.observer.stopped_since()) == stop_before;
        if is_same && self.observer.runs_for() > self.now - start {
            led::check_pattern(&edges, start + 3 * FRAME, self.now, stop_before.0)
                .map_err(|message| BrokenRule::new(Rule::Led, message))?;
        }
        Ok(())
    }

    /// Returns the code of the fault that stopped the robot, 0 for none.
    fn fault(&self) -> u8 {
        let fault = self.running.main.control().fault();
        fault.map_or(0, Fault::code)
    }

    fn frame(&mut self) -> Verdict {
        if self.running.is_stopped_by_watchdog() {
            // Main no longer runs; the watchdog is about to restart it.
            return self.stall(20);
        }
        // `stand` and `stop` within one frame leave the robot held; that reason is already reported.
        let was_held = self.running.motion().hazard().is_some();
        let frame_start = self.now;
        let was_resting = self.running.motion().is_resting();
        self.running.run_frame();
        if self.running.board.transmitter.is_held
            && self.running.motion().is_resting() != was_resting
        {
            self.predict_boot();
        }
        self.judge_pulses(true)?;
        if !was_held && self.running.motion().hazard().is_some() {
            self.observe(Event::Fault);
        }
        // Main decided at the start of the frame, so the output counts from there.
        self.listen(frame_start + MS)?;
        self.judge_writes()?;
        let is_heard =
            !self.running.board.transmitter.is_held && !self.running.is_stopped_by_watchdog();
        if is_heard && !self.is_late {
            self.observer.check_reported();
        }
        self.is_late = false;
        if self.sags_when_servos_wake
            && self
                .running
                .board
                .started_pulses()
                .0
                .iter()
                .filter(|width| width.0 > 0)
                .count()
                == 3
        {
            self.reset(Cause::BrownOut);
        }
        self.observer.verdict()
    }

    /// Stalls main. Afterwards main runs to the end of the frame, unless the watchdog has restarted the program.
    fn stall(&mut self, ms: u16) -> Verdict {
        self.observe(Event::Stalled(self.now + Time::from(ms) * MS));
        for _ in 0..ms / 20 {
            if self.pass_time(20) {
                return self.listen(self.now);
            }
            self.judge_pulses(false)?;
        }
        let remaining_ms = ms % 20;
        if remaining_ms > 0 {
            if self.pass_time(remaining_ms) {
                return self.listen(self.now);
            }
            self.running.settle();
            if self.pass_time(20 - remaining_ms) {
                return self.listen(self.now);
            }
            self.judge_pulses(false)?;
        }
        self.listen(self.now - FRAME)
    }

    /// Lets time pass while main does not run. Returns true if the watchdog has restarted the program.
    fn pass_time(&mut self, ms: u16) -> bool {
        let was_reset = self.running.board.pass_time(ms);
        if was_reset {
            self.reset(Cause::Watchdog);
        }
        was_reset
    }

    /// Judges the bytes that were written to the memory.
    fn judge_writes(&mut self) -> Verdict {
        let log = &mut self.running.board.memory.log;
        if !log.is_empty() {
            log.clear();
            if !self.running.board.converter.is_complete() {
                return broken(Rule::Written, "before the supply is measured");
            }
            self.observe(Event::Written);
        }
        self.observer.verdict()
    }
}
