//! The running routine: a sequence of steps in robot.toml that the robot executes by itself.
//!
//! A step is a gait for some cycles, a gait for some time, a rest, or a wait. A contact may end the step earlier. Every
//! stop and every other motion ends the routine, and only an order or `boot` starts a routine.

use super::Controller;
use crate::control::contact::Contact;
use crate::control::safety::Notice;
use crate::numbers::gaits::{GaitId, Input, Step};

/// The running routine, if there is one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Routine {
    /// The routine's index; the index of `stand` while no routine runs.
    pub id: GaitId,
    /// The index of the next step.
    next_step: u8,
    /// The number of rounds left, including the current round; 0 for an endless routine.
    rounds_left: u16,
    /// Frames until the current step ends; 0 if the step ends after the cycles of its gait, [`Step::ENDLESS`] if only a
    /// contact ends the step.
    frames_left: u16,
}

impl Routine {
    /// No running routine.
    pub const NONE: Self = Self {
        id: GaitId::STAND,
        next_step: 0,
        rounds_left: 0,
        frames_left: 0,
    };

    /// True while a routine runs.
    pub fn is_under_way(&self) -> bool {
        self.id != GaitId::STAND
    }
}

impl Controller {
    /// Starts a gait for `count` cycles, or endlessly if `count` is 0; or a routine for `count` rounds, or for the
    /// number in robot.toml if `count` is 0.
    #[inline(never)]
    pub(super) fn start_gait(&mut self, id: GaitId, count: u16) {
        let gait = self.motion.robot().gait(id);
        self.end_routine();
        if gait.is_routine() {
            // A routine stores this number in place of a channel's offset.
            let [_, _, round_count, _] = gait.channels;
            self.routine.id = id;
            self.routine.rounds_left = if count == 0 {
                round_count.offset
            } else {
                count
            };
            self.start_next_step();
        } else {
            self.motion.start_gait(id, count);
        }
    }

    /// Ends the routine, if one is under way. A notice that it waits, if it is not printed yet, is no longer true.
    #[inline(never)]
    pub(super) fn end_routine(&mut self) {
        self.routine = Routine::NONE;
        self.safety.clear_notice(Notice::Waiting);
    }

    /// Advances the routine by a frame. `is_closed` is true while the contact that may end the current step is closed.
    #[inline(never)]
    pub(super) fn advance_routine(&mut self, is_closed: bool) {
        if self.motion.hazard().is_some() {
            return self.end_routine();
        }
        let is_step_over = match self.routine.frames_left {
            0 => self.motion.has_come_to_standstill(),
            Step::ENDLESS => false,
            _ => {
                self.routine.frames_left -= 1;
                self.routine.frames_left == 0
            }
        };
        if self.contact.add_level(is_closed) || is_step_over {
            self.start_next_step();
        }
    }

    /// Starts the next step, or ends the routine after its last round.
    #[inline(never)]
    fn start_next_step(&mut self) {
        // The previous step's notice, if it is not printed yet, is no longer true and would name the next step's input.
        self.safety.clear_notice(Notice::Waiting);
        let robot = *self.motion.robot();
        let gait = robot.gait(self.routine.id);
        // A routine stores these numbers in place of the channels' offsets.
        let [_, step_count, _, first_step_of_round] = &gait.channels;
        let mut step_index = u16::from(self.routine.next_step);
        if step_index >= step_count.offset {
            step_index = first_step_of_round.offset;
            if self.routine.rounds_left == 1 {
                self.end_routine();
                // The pose of the routine's last rest must survive a loss of power.
                if self.motion.is_resting() {
                    self.rest();
                }
                // A gait that is still running brakes first.
                if !self.motion.brake_to_standstill() {
                    self.safety.notify(Notice::Done);
                }
                return;
            }
            self.routine.rounds_left = self.routine.rounds_left.saturating_sub(1);
        }
        let mut step = robot.step(&gait, step_index);
        let mut input = Input::NONE;
        if step.kind == Step::UNTIL {
            input = robot.input(&step);
            step_index += 1;
            step = robot.step(&gait, step_index);
            self.safety.notify(Notice::Waiting);
        }
        let Step {
            kind,
            gait: gait_index,
            count,
        } = step;
        self.routine.next_step = step_index as u8 + 1;
        self.routine.frames_left = if kind == Step::CYCLES { 0 } else { count };
        self.contact = if kind == Step::WAIT {
            Contact::for_wait(input)
        } else {
            Contact::for_motion(input)
        };
        match kind {
            Step::REST => self.motion.rest(),
            Step::WAIT => {
                self.motion.brake_to_standstill();
            }
            _ => {
                let cycles = if kind == Step::CYCLES { count } else { 0 };
                self.motion.start_gait(GaitId::at(gait_index), cycles);
            }
        }
    }
}
