//! Rules that need a look inside the robot, or at its future: a clone of it is left alone.

use lizard_core::console::command::effect;
use lizard_core::console::word::Effect;
use lizard_core::guard::clearance::Clearance;
use lizard_core::memory::copies;
use lizard_core::motion::Activity;
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::robot::Robot;
use lizard_core::virtual_board::Eeprom;
use lizard_rules::{Event, Limits, MS, Pulse, Rule, Time};

use super::{FRAME, Held, World, broken};

/// Cycles of a rounding, at either end of a frame.
const ROUNDING: u16 = 2;

/// Frames in which any motion of this robot ends: it wakes, brakes and goes.
const LONG: u32 = 160;

/// Time in which the supply is measured and believed.
const BELIEVED: Time = 14 * FRAME;

/// The observer's limits for a robot.
pub(super) fn limits(robot: &Robot) -> Limits {
    let board = robot.supplies().board;
    Limits {
        levels: [board.slow, board.stop, board.rest].map(u32::from),
        // The console tells at once when `boot` begins.
        boots_to_rest: true,
        ..Limits::default()
    }
}

impl World {
    /// Judges an answer to a line.
    pub(super) fn answer(&mut self, line: &str, text: &str) -> Held {
        let effect = effect(line, &self.robot());
        let is_done = text.starts_with("ok ");
        // A late edge that main has yet to see, because its last frame still waits to be
        // played, stops the robot after the order.
        let is_late = self.observer.is_untold() && self.running.board.late > 0;
        self.order(effect, Some(is_done));
        if is_done && effect == Effect::Calibrates {
            self.observe(Event::Calibrated { saved: false });
        }
        let asked = self.now;
        self.observe(Event::Answer {
            line,
            effect,
            asked,
            text,
        });
        if text == "ok load" {
            self.takes_what_it_loaded()?;
        }
        let is_refused = text.starts_with("err 8");
        if is_refused
            && !self.observer.was_low(0, 70 * FRAME)
            && Time::from(self.running.motion().frames()) * FRAME > BELIEVED
        {
            return broken(Rule::Allowed, text);
        }
        if is_done && effect == Effect::Moves {
            let stack = self.running.board.stack_is_intact;
            if is_late {
                self.observe(Event::Fault);
            }
            if is_late
                || self.is_weak
                || self.observer.was_low(0, 1)
                || self.observer.was_low(1, BELIEVED)
            {
                self.observer.drop_pending();
            } else if text == "ok stand" && stack {
                self.stands_after(text)?;
            }
        }
        self.observer.verdict()
    }

    /// Tells the observer of an order.
    pub(super) fn order(&mut self, effect: Effect, done: Option<bool>) {
        if matches!(effect, Effect::Moves | Effect::Freezes | Effect::Rests) {
            self.observe(Event::Order { effect, done });
        }
    }

    /// Leaves a clone alone until the answers so far have to have come true.
    pub(super) fn look_ahead(&mut self) -> Held {
        self.observer.verdict()?;
        if let Some(time) = self.observer.due_in() {
            let mut later = self.clone();
            for _ in 0..=time / FRAME {
                later.frame()?;
            }
        }
        self.observer.drop_pending();
        self.observer.verdict()
    }

    /// `limit` accepts everything that `cal` prints.
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
            let (_, limit) = rest.split_once(" limit ").expect("cal prints it");
            let (limit, _) = limit.split_once(" dir ").expect("it ends there");
            let answer = later.say(&format!("limit {servo} {limit}"));
            if answer.starts_with("err ") {
                return broken(Rule::Load, answer);
            }
        }
        Ok(())
    }

    /// True if the robot rests, and its pose is in the memory.
    pub(super) fn rest_is_kept(&self) -> bool {
        let memory = &self.running.board.memory;
        let motion = self.running.motion();
        // A memory that is busy cannot be read; its bytes can.
        let readable = Eeprom::with(*memory.bytes());
        motion.is_resting() && copies::rested(motion.robot(), &readable) == Some(*motion.pose())
    }

    fn stands_after(&self, answer: &str) -> Held {
        let mut later = self.running.clone();
        for _ in 0..LONG {
            later.frame();
        }
        let motion = later.motion();
        let standing = Pose::NEUTRAL.pulses(motion.calibration());
        let activity = motion.activity();
        // A gait that no robot.toml may have has left safe ground while it braked.
        if motion.hazard().is_some() {
            return Ok(());
        }
        if later.board.begun() != standing || activity != Activity::Gait(GaitId::STAND) {
            let status = later.say("status");
            return broken(Rule::Stands, format!("{answer}, and then {status}"));
        }
        Ok(())
    }

    /// Judges the pulses of a frame, in which main ran or not.
    pub(super) fn pulses(&mut self, main_ran: bool) -> Held {
        self.observer.limits.keeps_memory = !self.running.board.memory.worn;
        let widths = self.running.board.begun().0.map(|width| width.0);
        let slew = self.robot().slew().per_frame;
        for (servo, calibration) in self.running.motion().calibration().iter().enumerate() {
            let most = calibration.slew(slew).saturating_add(ROUNDING);
            self.observer.limits.leap[servo] = most.into();
            if widths[servo] > 0 {
                // A1's pulse begins 4 ms after the tick.
                let at = self.now + (5 + 4 * servo as Time) * MS;
                let pulse = Pulse {
                    servo,
                    width: widths[servo].into(),
                    is_cut: false,
                    is_held_up: false,
                };
                self.observer.observe(at, Event::Pulse(pulse));
            }
        }
        self.now += FRAME;
        self.observe(Event::Pass);
        self.is_late |= !main_ran;
        let motion = self.running.motion();
        let robot = self.robot();
        let is_sent = main_ran && widths.iter().any(|width| *width > 0);
        if is_sent
            && Clearance::of(&robot, motion.pose())
                .hazard(&robot)
                .is_some()
        {
            return broken(Rule::Guarded, format!("{:?}", motion.pose()));
        }
        self.observer.verdict()
    }
}
