//! The rules, each in the words of a user.

use lizard_core::console::command::effect;
use lizard_core::console::word::Effect;
use lizard_core::guard::clearance::Clearance;
use lizard_core::memory::copies;
use lizard_core::motion::Activity;
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::robot::Robot;
use lizard_core::virtual_board::{Eeprom, Running, is_final};

use super::{BELIEVED, Held, World, broken};
use crate::fingerprint;

/// Cycles of a rounding, at either end of a frame.
const ROUNDING: u16 = 2;

/// Frames in which any motion of this robot ends: it wakes, brakes and goes.
const LONG: u32 = 160;

impl World {
    /// Holds the robot to the answer that it is about to give, if it gives one at once:
    /// it has done by now what it answers.
    pub(super) fn foresee(&mut self, before: &Running) -> Held {
        let after = self.settled();
        let text = &after.board.transmitter.text;
        let Some(answer) = text.lines().find(|line| is_final(line)) else {
            return Ok(());
        };
        let print = |running: &Running| fingerprint::but_for_the_line(&running.main);
        if answer.starts_with("err ")
            && (print(&after) != print(before)
                || after.board.memory.bytes() != before.board.memory.bytes())
        {
            return broken("a refused command changes nothing", text.clone());
        }
        self.seen.known += 1;
        self.answer(answer)
    }

    pub(super) fn hear(&mut self, line: &str) -> Held {
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
        if line == "ok stand" {
            // A late edge that main has yet to see, because its last frame still waits to be
            // played, stops the robot after the order.
            let untold = self.seen.stopped > 0 && !self.seen.is_told;
            let is_late = untold && self.running.board.late > 0;
            self.seen.order();
            if is_late {
                self.seen.stop();
                return Ok(());
            }
            self.stands_after(line)
        } else if is_order(line, &self.robot()) {
            self.seen.order();
            self.has_pulses_after(line)
        } else if line == "ok rest" {
            self.rests_after(line)?;
            self.seen.is_sent_to_rest = true;
            Ok(())
        } else if line == "ok load" {
            self.takes_what_it_loaded()
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
        if line.contains(" guard=held ") && line.contains(" fault=none ") {
            return broken("status names a fault wherever the guard holds", line);
        }
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

    /// A `limit` that says what `cal` tells is taken.
    fn takes_what_it_loaded(&self) -> Held {
        let mut later = self.running.clone();
        later.board.transmitter.text.clear();
        for line in later.send(b"cal\r") {
            let Some((servo, rest)) = line
                .strip_prefix("# A")
                .and_then(|of| of.split_at_checked(1))
            else {
                continue;
            };
            let (_, limit) = rest.split_once(" limit ").expect("cal tells it");
            let (limit, _) = limit.split_once(" dir ").expect("it ends there");
            let answer = later.say(&format!("limit {servo} {limit}"));
            if answer.starts_with("err ") {
                return broken("what load takes, limit would have taken", answer);
            }
        }
        Ok(())
    }

    /// True if the robot was told to rest, does, and where it does is in the memory. A hang
    /// before the first frame is left out: it forgets the rest of the time before power-on.
    pub(super) fn rest_is_kept(&self) -> bool {
        let memory = &self.running.board.memory;
        let motion = self.running.motion();
        // A memory that is busy cannot be read; its bytes can.
        let readable = Eeprom::with(*memory.bytes());
        self.seen.rests
            && motion.is_resting()
            && copies::rested(motion.robot(), &readable) == Some(*motion.pose())
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

    /// The pulses of a frame.
    pub(super) fn pulses(&mut self, was_on: [bool; 4], main_ran: bool) -> Held {
        let begun = self.running.board.begun();
        let widths = begun.0.map(|width| width.0);
        let wakes = |servo: &usize| widths[*servo] > 0 && !was_on[*servo];
        let woken: Vec<usize> = (0..4).filter(wakes).collect();
        if self.seen.rests && self.seen.silent > 0 && widths.iter().any(|width| *width > 0) {
            // Nobody may have heard that it boots, or obeys.
            let mut heard = self.running.clone();
            heard.board.transmitter.held = false;
            heard.settle();
            let text = &heard.board.transmitter.text;
            if text
                .lines()
                .any(|line| line.starts_with("# boot: ") || is_order(line, &self.robot()))
            {
                self.seen.order();
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
        for (servo, calibration) in self.running.motion().calibration().iter().enumerate() {
            let most = calibration.slew(slew).saturating_add(ROUNDING);
            let leap = widths[servo].abs_diff(self.seen.width[servo]);
            if widths[servo] > 0 && self.seen.is_there[servo] && leap > most {
                return broken(
                    "no pulse leaps farther than the slew limit, also across a reset",
                    format!("A{} by {leap} cycles, {most} allowed", servo + 1),
                );
            }
        }
        if widths.iter().any(|width| *width > 0) && main_ran {
            let motion = self.running.motion();
            if Clearance::of(&self.robot(), motion.pose())
                .hazard(&self.robot())
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

    /// What has been written to the memory.
    pub(super) fn written(&mut self) -> Held {
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

/// True if a line answers that a motion which was ordered begins.
fn is_order(line: &str, robot: &Robot) -> bool {
    let order = line.strip_prefix("ok ");
    order.is_some_and(|order| effect(order, robot) == Effect::Moves)
}
