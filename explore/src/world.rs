//! A robot, what it runs on, and a bystander who holds it to its promises.

use lizard_core::gait::GaitId;
use lizard_core::guard::Clearance;
use lizard_core::kept::Flags;
use lizard_core::line::GARBLED;
use lizard_core::memory::{LENGTH, WHOLE};
use lizard_core::motion::Activity;
use lizard_core::pose::{Pose, Pulses};
use lizard_core::record::{COPIES, RESTED};
use lizard_core::restart::{Cause, Restart};
use lizard_core::robot::Robot;
use lizard_core::step::{Board, Step};
use lizard_core::virtual_board::{Eeprom, Running, is_final, reading};

use crate::action::Action;
use crate::fingerprint::{self, Print};
use crate::seen::Seen;
use crate::small::Small;

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

/// Cycles of a rounding, at either end of a frame.
const ROUNDING: u16 = 2;

/// Frames in which the supply is measured and believed.
const BELIEVED: u8 = 14;

/// Frames in which any motion of this robot ends: it wakes, brakes and goes.
const LONG: u32 = 160;

/// A state of the walk.
#[derive(Clone, Debug)]
pub struct World {
    /// The firmware on its board.
    pub running: Running<&'static Small>,
    /// What a bystander remembers.
    pub seen: Seen,
}

impl World {
    /// Power comes on.
    #[must_use]
    pub fn power_on(robot: &'static Small, mut memory: Eeprom) -> Self {
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
        print.add(fingerprint::coarse(&board.ram.found(Flags::default())));
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
                self.seen.power_on();
            }
            Action::Deaf(deaf) => self.running.board.transmitter.held = deaf,
        }
        self.written()
    }

    fn robot(&self) -> &'static Small {
        self.running.motion().robot()
    }

    fn reset(&mut self, cause: Cause) {
        self.running.reset(cause);
        self.seen.reset();
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
            if step != Step::Worked || self.running.board.memory.is_asked_in_vain() {
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
    fn settled(&self) -> Running<&'static Small> {
        let mut settled = self.running.clone();
        settled.board.transmitter.text.clear();
        settled.settle();
        settled
    }

    /// Holds the robot to the answer that it is about to give, if it gives one at once:
    /// it has done by now what it answers.
    fn foresee(&mut self, before: &Running<&'static Small>) -> Held {
        let after = self.settled();
        let text = &after.board.transmitter.text;
        let Some(answer) = text.lines().find(|line| is_final(line)) else {
            return Ok(());
        };
        let print = |running: &Running<_>| fingerprint::but_for_the_line(&running.main);
        if answer.starts_with("err ")
            && (print(&after) != print(before)
                || after.board.memory.bytes() != before.board.memory.bytes())
        {
            return broken("a refused command changes nothing", text.clone());
        }
        self.seen.known += 1;
        self.answer(answer)
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

    fn hear(&mut self, line: &str) -> Held {
        if is_final(line) {
            self.seen.owed -= 1;
            if self.seen.owed < 0 {
                return broken("every line gets exactly one answer", line);
            }
            if line.starts_with("ok gait=") {
                return self.status_is_true(line);
            }
            if self.seen.known > 0 {
                self.seen.known -= 1;
                return Ok(());
            }
            return self.answer(line);
        }
        if line.starts_with("# fault: ") || line.starts_with("# held") {
            self.seen.is_told = true;
            self.seen.since_told = 0;
            if line.contains("no line for") {
                self.seen.stop();
                // It was decided at the beginning of the frame.
                let since = self.seen.line_ms.saturating_sub(19);
                if self.seen.deadman > 0 && since < self.seen.deadman {
                    return broken(
                        "a gait ends for want of a line only if none came for as long as deadman says",
                        format!("{since} ms after the last line"),
                    );
                }
            }
        } else if line.starts_with("# supply: ") && line.ends_with("pulses ended") {
            self.seen.rests = true;
            if self.seen.far_too_low < 3 {
                return broken(
                    "the pulses end only for a supply that stays too low",
                    format!("{line}, after {} frames", self.seen.far_too_low),
                );
            }
        } else if line.starts_with("# boot: ") {
            self.seen.rests = line == "# boot: rest";
        }
        Ok(())
    }

    /// What the answer to an order promises.
    fn answer(&mut self, line: &str) -> Held {
        let moves = ["ok walk", "ok trot", "ok stray", "ok pose", "ok center"];
        if line == "ok stand" {
            self.seen.order();
            self.stands_after(line)
        } else if moves.iter().any(|answer| line.starts_with(answer)) {
            self.seen.order();
            self.has_pulses_after(line)
        } else if line == "ok rest" {
            self.rests_after(line)?;
            self.seen.is_sent_to_rest = true;
            Ok(())
        } else if line.starts_with("err 8")
            && self.seen.since_low > 70
            && self.running.motion().frames() > u32::from(BELIEVED)
        {
            broken("what the supply allows is not refused for its sake", line)
        } else {
            if let Some(ms) = line.strip_prefix("ok deadman ") {
                self.seen.deadman = ms.parse().unwrap_or(0);
            }
            Ok(())
        }
    }

    /// Nothing that stopped the robot is hidden.
    fn status_is_true(&self, line: &str) -> Held {
        let is_well = line.contains(" fault=none ") && line.contains(" guard=clear ");
        let waits = self.seen.stopped > 3;
        if waits && is_well {
            return broken(
                "whatever stopped the robot is in status until a person acts",
                line,
            );
        }
        if self.seen.silent > 30 && is_well && !line.starts_with("ok gait=rest ") {
            return broken("status says why the robot has no pulses", line);
        }
        Ok(())
    }

    /// The same robot, left alone for some frames.
    fn after(&self, frames: u32) -> Running<&'static Small> {
        let mut running = self.running.clone();
        for _ in 0..frames {
            running.frame();
        }
        running
    }

    fn has_pulses_after(&self, line: &str) -> Held {
        if self.seen.is_weak || self.is_below()[0] || self.seen.since_too_low <= BELIEVED {
            return Ok(());
        }
        let mut later = self.after(30);
        if later.board.begun().0.iter().any(|width| width.0 == 0) {
            let status = later.say("status");
            return broken(
                "a robot without pulses never answers that it moves",
                format!("{line}, and then {status}"),
            );
        }
        Ok(())
    }

    fn stands_after(&self, line: &str) -> Held {
        let board = &self.running.board;
        // A stack in the data stops the robot again until a reset.
        let is_stopped = self.is_below()[0] || !board.stack_is_intact;
        if self.seen.is_weak || is_stopped || self.seen.since_too_low <= BELIEVED {
            return Ok(());
        }
        let mut later = self.after(LONG);
        let motion = later.motion();
        let standing = Pose::NEUTRAL.pulses(motion.calibration());
        let activity = motion.activity();
        // A gait that no robot.toml may have has left safe ground while it braked.
        if motion.hazard().is_some() {
            return Ok(());
        }
        if later.board.begun() != standing || activity != Activity::Gait(GaitId::STAND) {
            let status = later.say("status");
            return broken(
                "after stand the robot stands",
                format!("{line}, and then {status}"),
            );
        }
        Ok(())
    }

    fn rests_after(&self, line: &str) -> Held {
        let later = self.after(1);
        if later.board.begun().0.iter().any(|width| width.0 > 0) {
            return broken("rest ends the pulses within a frame", line);
        }
        if self.seen.rests && self.seen.silent > 25 {
            let mut before = self.running.clone();
            before.board.memory.log.clear();
            for _ in 0..25 {
                before.frame();
            }
            let written = before.board.memory.log.len();
            if written > 0 && !before.board.memory.worn {
                return broken(
                    "rest, said again, wears nothing",
                    format!("{written} bytes written"),
                );
            }
        }
        Ok(())
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
            // Main is no more; the watchdog is about to begin it anew.
            return self.stall(20);
        }
        let was_on = self.seen.is_on;
        self.running.frame();
        self.pulses(was_on, true)?;
        if self.running.motion().hazard().is_some() {
            self.seen.stop();
        }
        self.listen()?;
        self.written()?;
        self.supply();
        let hears = !self.running.board.transmitter.held && !self.running.is_over();
        if self.seen.stopped > 3 && !self.seen.is_told && hears && self.seen.late_frames == 0 {
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

    fn supply(&mut self) {
        self.seen.supply(self.is_below());
        if self.seen.too_low > BELIEVED {
            self.seen.stop();
        }
    }

    /// Main does nothing; then it does what it missed, to the end of that frame. Or the
    /// watchdog begins it anew.
    fn stall(&mut self, ms: u16) -> Held {
        for _ in 0..ms / 20 {
            let was_on = self.seen.is_on;
            if self.lapse(20) {
                return self.listen();
            }
            self.pulses(was_on, false)?;
            self.supply();
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
            self.supply();
        }
        self.running.settle();
        self.listen()
    }

    /// Time passes without main; says whether the watchdog has begun it anew.
    fn lapse(&mut self, ms: u16) -> bool {
        let bites = self.running.board.pass(ms);
        if bites {
            self.running.reset(Cause::Watchdog);
            self.seen.reset();
            self.seen.stopped = 0;
            self.seen.stop();
        }
        bites
    }

    /// The pulses of a frame.
    fn pulses(&mut self, was_on: [bool; 4], main_ran: bool) -> Held {
        let begun = self.running.board.begun();
        let widths = begun.0.map(|width| width.0);
        let wakes = |servo: &usize| widths[*servo] > 0 && !was_on[*servo];
        let woken: Vec<usize> = (0..4).filter(wakes).collect();
        if self.seen.rests && self.seen.silent > 0 && widths.iter().any(|width| *width > 0) {
            // Nobody may have heard that it boots.
            let mut heard = self.running.clone();
            heard.board.transmitter.held = false;
            heard.settle();
            if heard.board.transmitter.text.contains("# boot: ") {
                self.seen.rests = false;
                return self.seen_frame(&begun, main_ran);
            }
            return broken(
                "a robot that rests has no pulses until an order, boot or power-on",
                format!("{widths:?}"),
            );
        }
        if woken.len() > 1 && woken.iter().any(|servo| !self.seen.is_placed[*servo]) {
            return broken(
                "a servo whose place is not known is never woken together with another",
                format!("{widths:?}"),
            );
        }
        let slew = self.robot().slew().per_frame;
        for servo in 0..4 {
            let calibration = self.running.motion().calibration()[servo];
            let most = calibration
                .slew(slew)
                .saturating_add(ROUNDING)
                .saturating_mul(1 + self.seen.late_frames);
            let leap = widths[servo].abs_diff(self.seen.width[servo]);
            if widths[servo] > 0 && self.seen.is_placed[servo] && leap > most {
                return broken(
                    "no pulse leaps farther than the slew limit, also across a reset",
                    format!("A{} by {leap} cycles, {most} allowed", servo + 1),
                );
            }
        }
        if widths.iter().any(|width| *width > 0) && main_ran {
            let motion = self.running.motion();
            if Clearance::of(self.robot(), motion.pose())
                .hazard(self.robot())
                .is_some()
            {
                return broken(
                    "every pose that is sent has passed the guard",
                    format!("{:?}", motion.pose()),
                );
            }
        }
        self.seen_frame(&begun, main_ran)
    }

    fn seen_frame(&mut self, begun: &Pulses, main_ran: bool) -> Held {
        let ran = main_ran && !self.running.is_over();
        self.seen.frame(begun, ran);
        Ok(())
    }

    /// What has been written to the memory.
    fn written(&mut self) -> Held {
        let log = &mut self.running.board.memory.log;
        if log.is_empty() {
            return Ok(());
        }
        log.clear();
        if !self.running.board.converter.is_complete() {
            return broken(
                "nothing is written to the memory before the supply is measured",
                "a byte",
            );
        }
        if self.seen.low > BELIEVED {
            return broken(
                "nothing is written to the memory below its voltage",
                format!("a byte after {} frames", self.seen.low),
            );
        }
        Ok(())
    }
}
