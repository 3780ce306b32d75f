//! Checks of rules about the robot's internal state, or about its future, which is computed on a clone.

use lizard_core::console::command::effect;
use lizard_core::console::word::Effect;
use lizard_core::guard::clearance::Clearance;
use lizard_core::memory::copies;
use lizard_core::motion::Activity;
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::pose::Pose;
use lizard_core::numbers::robot::Robot;
use lizard_core::virtual_board::{Eeprom, RunningRobot};
use lizard_rules::{Event, Limits, Rule, Time};

use super::{FRAME, Verdict, World, broken};
use crate::fingerprint;

/// Rounding error at each end of a frame, cycles.
const ROUNDING: u16 = 2;

/// Number of frames within which any motion of this robot ends.
const MOTION_FRAMES: u32 = 160;

/// Lines that start a gait or a routine for a limited time, which ends within [`MOTION_FRAMES`]
/// even at half the pace.
const COUNTED: [&str; 3] = ["walk 1", "trot 2", "round 1"];

/// Number of frames after which a contact is certain to be debounced.
const DEBOUNCED: u8 = 5;

/// Time after which a supply has been measured often enough for the robot to react to it.
const SUPPLY_SETTLING: Time = 14 * FRAME;

/// Returns the observer's limits for a robot.
pub(super) fn limits(robot: &Robot) -> Limits {
    let board = robot.supplies().board;
    Limits {
        levels: [board.slow_mv, board.stop_mv, board.rest_mv].map(u32::from),
        // The console reports at once when `boot` begins.
        boots_to_rest: true,
        ..Limits::default()
    }
}

/// Returns a number that is the same for equal states of main.
fn main_fingerprint(running: &RunningRobot) -> u64 {
    fingerprint::coarse_fingerprint(&running.main)
}

impl World {
    /// Judges an answer to a line.
    pub(super) fn judge_answer(&mut self, line: &str, text: &str) -> Verdict {
        let effect = effect(line, &self.robot());
        let is_done = text.starts_with("ok ");
        // Main has not seen a late edge yet if its last frame still waits to be played. The
        // edge then stops the robot after the order.
        let is_late = self.observer.is_unreported() && self.running.board.late_edges > 0;
        self.order(effect, Some(is_done));
        if is_done && effect == Effect::Calibrates {
            self.observe(Event::Calibrated { is_saved: false });
        }
        let asked = self.now;
        self.observe(Event::Answer {
            line,
            effect,
            asked,
            text,
        });
        if text == "ok load" {
            self.check_loaded_limits()?;
        }
        let is_refused = text.starts_with("err 8");
        if is_refused
            && !self.observer.was_low(0, 70 * FRAME)
            && Time::from(self.running.motion().frame_count()) * FRAME > SUPPLY_SETTLING
        {
            return broken(Rule::Allowed, text);
        }
        if is_done && effect == Effect::Moves {
            let is_stack_intact = self.running.board.is_stack_intact;
            if is_late {
                self.observe(Event::Fault);
            }
            if is_late
                || self.sags_when_servos_wake
                || self.observer.was_low(0, 1)
                || self.observer.was_low(1, SUPPLY_SETTLING)
            {
                self.observer.drop_pending();
            } else if text == "ok stand" && is_stack_intact {
                self.check_stands_after(text)?;
            } else if COUNTED.contains(&line) {
                self.check_ends_after(text)?;
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

    /// Runs a clone until all effects that the answers have promised are due, and checks them.
    pub(super) fn look_ahead(&mut self) -> Verdict {
        self.observer.verdict()?;
        if let Some(time) = self.observer.due_in() {
            let mut future_world = self.clone();
            for _ in 0..=time / FRAME {
                future_world.frame()?;
            }
        }
        self.observer.drop_pending();
        self.observer.verdict()
    }

    /// Checks that `limit` accepts everything that `cal` prints.
    fn check_loaded_limits(&self) -> Verdict {
        let mut future_robot = self.running.clone();
        future_robot.board.transmitter.text.clear();
        for line in future_robot.send(b"cal\r") {
            let Some((servo, rest)) = line
                .strip_prefix("# A")
                .and_then(|tail| tail.split_at_checked(1))
            else {
                continue;
            };
            let (_, limit) = rest.split_once(" limit ").expect("cal prints it");
            let (limit, _) = limit.split_once(" dir ").expect("it ends there");
            let answer = future_robot.send_line(&format!("limit {servo} {limit}"));
            if answer.starts_with("err ") {
                return broken(Rule::Load, answer);
            }
        }
        Ok(())
    }

    /// Closes or opens a contact. Unless a routine runs, checks that the contact has no effect on the robot.
    pub(super) fn set_contact(&mut self, pin: u8, is_closed: bool) -> Verdict {
        let mut unchanged = self.running.clone();
        let other_contacts = self.running.board.closed_pins & !(1 << pin);
        self.running.board.closed_pins = other_contacts | u32::from(is_closed) << pin;
        let robot = self.robot();
        let activity = self.running.main.control().activity();
        if matches!(activity, Activity::Gait(id) if robot.gait(id).is_routine()) {
            return Ok(());
        }
        let mut changed = self.running.clone();
        for running in [&mut unchanged, &mut changed] {
            running.run_without_reader(u32::from(DEBOUNCED));
        }
        if changed.board.started_pulses() != unchanged.board.started_pulses()
            || main_fingerprint(&changed) != main_fingerprint(&unchanged)
        {
            return broken(Rule::Contacts, format!("{activity:?}"));
        }
        Ok(())
    }

    /// True if the robot rests, and its pose is in the memory.
    pub(super) fn rest_is_kept(&self) -> bool {
        let memory = &self.running.board.memory;
        let motion = self.running.motion();
        // A busy EEPROM cannot be read, but a copy of its bytes can.
        let readable_memory = Eeprom::with_bytes(*memory.bytes());
        motion.is_resting()
            && copies::last_rest_pose(motion.robot(), &readable_memory) == Some(*motion.pose())
    }

    fn check_stands_after(&self, answer: &str) -> Verdict {
        let mut future_robot = self.running.clone();
        for _ in 0..MOTION_FRAMES {
            future_robot.run_frame();
        }
        let motion = future_robot.motion();
        let standing_pulses = Pose::NEUTRAL.pulses(motion.calibration());
        let activity = motion.activity();
        // A gait that robot.toml could not have may have left the safe poses while it braked.
        if motion.hazard().is_some() {
            return Ok(());
        }
        if future_robot.board.started_pulses() != standing_pulses
            || activity != Activity::Gait(GaitId::STAND)
        {
            let status = future_robot.send_line("status");
            return broken(Rule::Stands, format!("{answer}, and then {status}"));
        }
        Ok(())
    }

    fn check_ends_after(&self, answer: &str) -> Verdict {
        let mut future_robot = self.running.clone();
        future_robot.run_without_reader(MOTION_FRAMES);
        if future_robot.main.control().activity() != Activity::Stop {
            return broken(
                Rule::Ends,
                format!("{answer}, and then {}", future_robot.send_line("status")),
            );
        }
        Ok(())
    }

    /// Judges the pulses of a frame. `has_main_run` is false if main was stalled in it.
    pub(super) fn judge_pulses(&mut self, has_main_run: bool) -> Verdict {
        self.observer.limits.keeps_memory = !self.running.board.memory.is_worn;
        let widths = self.running.board.started_pulses().0.map(|width| width.0);
        let slew = self.robot().slew().per_frame;
        for (servo, calibration) in self.running.motion().calibration().iter().enumerate() {
            let max = calibration.max_width_change(slew).saturating_add(ROUNDING);
            self.observer.limits.leap[servo] = max.into();
        }
        self.observer.observe_frame(self.now, widths);
        self.now += FRAME;
        self.is_late |= !has_main_run;
        let motion = self.running.motion();
        let robot = self.robot();
        let is_sent = has_main_run && widths.iter().any(|width| *width > 0);
        if is_sent
            && Clearance::of(&robot, motion.pose())
                .first_hazard(&robot)
                .is_some()
        {
            return broken(Rule::Guarded, format!("{:?}", motion.pose()));
        }
        self.observer.verdict()
    }
}
