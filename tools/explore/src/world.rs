//! A robot, the board it runs on, and an observer who checks the rules.

mod rules;

use lizard_core::console::line::GARBLED;
use lizard_core::memory::copies::{COPIES, RESTED};
use lizard_core::memory::record::{LENGTH, WHOLE};
use lizard_core::memory::restart::{Cause, Restart};
use lizard_core::numbers::pose::Pulses;
use lizard_core::numbers::robot::Robot;
use lizard_core::step::{Board, Step};
use lizard_core::virtual_board::{Eeprom, Running, reading};

use crate::action::Action;
use crate::fingerprint::{self, Print};
use crate::seen::Seen;

/// A rule that was broken: its sentence, and what was seen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Broken {
    /// The rule.
    pub rule: &'static str,
    /// What was seen.
    pub seen: String,
}

/// Whether the rules still hold.
pub type Held = Result<(), Broken>;

fn broken(rule: &'static str, seen: impl Into<String>) -> Held {
    Err(Broken {
        rule,
        seen: seen.into(),
    })
}

/// Frames in which the supply is measured and believed.
const BELIEVED: u8 = 14;

/// A state of the walk.
#[derive(Clone, Debug)]
pub struct World {
    /// The firmware on its board.
    pub running: Running,
    /// What a bystander remembers.
    pub seen: Seen,
}

impl World {
    /// Power comes on.
    #[must_use]
    pub fn power_on(robot: Robot<'static>, mut memory: Eeprom) -> Self {
        memory.slowness = 4;
        memory.timed = true;
        Self {
            running: Running::with(robot, memory, Restart::default()),
            seen: Seen::new(),
        }
    }

    /// The number that equal states share.
    #[must_use]
    pub fn print(&self) -> u64 {
        let board = &self.running.board;
        let mut print = Print(fingerprint::coarse(&self.running.main));
        print.add(fingerprint::coarse(&self.seen.coarse()));
        let memory = board.memory.bytes();
        for record in COPIES.map(|copy| copy.0).into_iter().chain([RESTED.0]) {
            let record = &memory[usize::from(record)..][..usize::from(LENGTH)];
            // What is in a record that is not whole is never used.
            let used = if record[0] == WHOLE {
                record
            } else {
                &record[..2]
            };
            for byte in used {
                print.add(u64::from(*byte));
            }
        }
        print.add(fingerprint::coarse(&board.ram.found(None)));
        let truth = board.converter.truth();
        let flags = [
            board.memory.worn,
            board.boot_loader,
            board.memory.under_way().is_some(),
            board.is_hushed(),
            board.stack_is_intact,
            board.converter.is_complete(),
            board.transmitter.held,
            board.restart().before.is_some(),
            board.waiting() > 0,
            board.is_fresh(),
        ];
        print.add(flags.iter().fold(u64::from(truth.reference), |all, flag| {
            all << 1 | u64::from(*flag)
        }));
        print.0
    }

    /// Whether this may happen now.
    #[must_use]
    pub fn can(&self, action: Action) -> bool {
        let board = &self.running.board;
        match action {
            Action::Say(_) | Action::Noise => {
                board.waiting() == 0 && !board.transmitter.held && !self.running.is_over()
            }
            Action::Step => self.running.has_output() || self.running.main.control().is_writing(),
            Action::Frames(_)
            | Action::Stall(_)
            | Action::Reset(_)
            | Action::LosePower(None)
            | Action::Supply(_) => true,
            Action::LosePower(Some(_)) => board.memory.under_way().is_some(),
            Action::Weak(weak) => weak != self.seen.is_weak,
            Action::Late => board.late < 3,
            Action::Stack => board.stack_is_intact,
            Action::Deaf(deaf) => deaf != board.transmitter.held,
        }
    }

    /// What happens.
    ///
    /// # Errors
    /// The first rule that is broken by it.
    pub fn apply(&mut self, action: Action) -> Held {
        let was_kept = self.rest_is_kept();
        match action {
            Action::Say(line) => self.say(line.as_bytes())?,
            Action::Noise => self.say(&[b'w', b'a', GARBLED, b'k'])?,
            Action::Step => {
                self.running.main.step(&mut self.running.board);
                self.listen()?;
            }
            Action::Frames(count) => self.frames(count)?,
            Action::Stall(ms) => self.stall(ms)?,
            Action::Supply(mv) => {
                let supplies = self.robot().supplies();
                let truth = reading(&supplies, u32::from(mv), 0);
                self.running.board.converter.set(truth);
            }
            Action::Weak(weak) => self.seen.is_weak = weak,
            Action::Late => {
                self.running.board.late += 1;
                self.seen.stop();
                self.frame()?;
            }
            Action::Stack => {
                self.running.board.stack_is_intact = false;
                self.seen.stop();
                self.frame()?;
            }
            Action::Reset(cause) => self.reset(cause),
            Action::LosePower(torn) => {
                self.running.lose_power(torn);
                self.begun_anew();
                self.seen.power_on();
            }
            Action::Deaf(deaf) => self.running.board.transmitter.held = deaf,
        }
        let robot_rests = self.running.motion().is_resting();
        if was_kept && robot_rests && !self.rest_is_kept() {
            return broken(
                "where the robot rests stays in the memory, also after a reset",
                action.to_string(),
            );
        }
        self.written()
    }

    fn robot(&self) -> Robot<'static> {
        *self.running.motion().robot()
    }

    fn reset(&mut self, cause: Cause) {
        self.running.reset(cause);
        self.begun_anew();
        match cause {
            // Somebody pressed the button, or opened the port.
            Cause::External => self.seen.stopped = 0,
            Cause::BrownOut => self.seen.stopped = 0,
            _ => {
                self.seen.stopped = 0;
                self.seen.stop();
            }
        }
    }

    /// The program has restarted, and its output is cut off.
    fn begun_anew(&mut self) {
        self.running.board.transmitter.text.clear();
        self.seen.reset();
    }

    /// A line, up to what it does at once.
    fn say(&mut self, line: &[u8]) -> Held {
        let before = self.settled();
        self.running.board.send(line);
        self.running.board.send(b"\n");
        self.seen.owed += 1;
        self.seen.line_ms = 0;
        for _ in 0..10_000 {
            if self.running.board.waiting() == 0 {
                break;
            }
            let step = self.running.main.step(&mut self.running.board);
            if step != Step::Worked || self.running.board.memory.was_polled_busy() {
                // It is read when there is time for it.
                break;
            }
        }
        if self.running.board.waiting() == 0 {
            self.foresee(&before)?;
        }
        self.listen()
    }

    /// The same robot with nothing left to say.
    fn settled(&self) -> Running {
        let mut settled = self.running.clone();
        settled.board.transmitter.text.clear();
        settled.settle();
        settled
    }

    /// What has been said.
    fn listen(&mut self) -> Held {
        let text = std::mem::take(&mut self.running.board.transmitter.text);
        // Of the longest line the first part may be there alone.
        let (whole, rest) = text.rsplit_once("\r\n").unwrap_or(("", &text));
        rest.clone_into(&mut self.running.board.transmitter.text);
        for line in whole.split("\r\n").filter(|line| !line.is_empty()) {
            self.hear(line)?;
        }
        Ok(())
    }

    /// The same robot, left alone for some frames.
    fn after(&self, frames: u32) -> Running {
        let mut running = self.running.clone();
        for _ in 0..frames {
            running.frame();
        }
        running
    }

    /// Frames, main running.
    fn frames(&mut self, count: u8) -> Held {
        let (mut lit, mut longest) = (0u32, 0u32);
        let stopped = self.seen.stopped > 0;
        for _ in 0..count {
            self.frame()?;
            lit = if self.running.board.is_lit() {
                lit + 1
            } else {
                0
            };
            longest = longest.max(lit);
        }
        if count < 100 || self.running.board.transmitter.held {
            return Ok(());
        }
        if self.seen.owed > 0 {
            return broken(
                "the console is never mute for ever",
                format!("{} lines", self.seen.owed),
            );
        }
        if stopped && self.seen.stopped > count && longest > 20 {
            return broken(
                "whatever stopped the robot is on the LED until a person acts",
                format!("lit for {longest} frames"),
            );
        }
        Ok(())
    }

    fn frame(&mut self) -> Held {
        if self.running.is_over() {
            // Main no longer runs; the watchdog is about to restart it.
            return self.stall(20);
        }
        let was_on = self.seen.is_on;
        // `stand` and `stop` within a frame leave it held, for a reason that is told.
        let was_held = self.running.motion().hazard().is_some();
        self.running.frame();
        self.pulses(was_on, true)?;
        if !was_held && self.running.motion().hazard().is_some() {
            self.seen.stop();
        }
        self.listen()?;
        self.written()?;
        self.supply(true);
        let hears = !self.running.board.transmitter.held && !self.running.is_over();
        if self.seen.stopped > 3 && !self.seen.is_told && hears && !self.seen.is_late {
            return broken(
                "whatever stopped the robot is told on the console",
                "nothing",
            );
        }
        let woken = self.seen.is_on.iter().filter(|on| **on).count();
        if self.seen.is_weak && woken == 3 {
            self.seen.brown_outs += 1;
            if self.seen.brown_outs > 8 {
                return broken("brown-outs in a row come to an end", "nine of them");
            }
            self.reset(Cause::BrownOut);
        }
        Ok(())
    }

    /// Whether the supply is too low to write, to move and to hold.
    fn is_below(&self) -> [bool; 3] {
        let supplies = self.robot().supplies();
        let truth = self.running.board.converter.truth();
        let mv = 1024 * u32::from(supplies.reference) / u32::from(truth.reference.max(1));
        let board = supplies.board;
        [board.slow, board.stop, board.rest].map(|level| mv < u32::from(level))
    }

    fn supply(&mut self, main_ran: bool) {
        self.seen.supply(self.is_below(), main_ran);
        if self.seen.too_low > BELIEVED {
            self.seen.stop();
        }
    }

    /// Main does nothing; then it does what it missed, to the end of that frame. Or the
    /// watchdog restarts it.
    fn stall(&mut self, ms: u16) -> Held {
        for _ in 0..ms / 20 {
            let was_on = self.seen.is_on;
            if self.lapse(20) {
                return self.listen();
            }
            self.pulses(was_on, false)?;
            self.supply(false);
        }
        let left = ms % 20;
        if left > 0 {
            let was_on = self.seen.is_on;
            if self.lapse(left) {
                return self.listen();
            }
            self.running.settle();
            if self.lapse(20 - left) {
                return self.listen();
            }
            self.pulses(was_on, left < 5)?;
            self.supply(false);
        }
        self.running.settle();
        self.listen()
    }

    /// Time passes without main; says whether the watchdog has restarted it.
    fn lapse(&mut self, ms: u16) -> bool {
        let bites = self.running.board.pass(ms);
        if bites {
            self.running.reset(Cause::Watchdog);
            self.begun_anew();
            self.seen.stopped = 0;
            self.seen.stop();
        }
        bites
    }

    fn seen_frame(&mut self, begun: &Pulses, main_ran: bool) -> Held {
        let ran = main_ran && !self.running.is_over();
        self.seen.frame(begun, ran);
        Ok(())
    }
}
