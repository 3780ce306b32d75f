//! The running routine: steps of robot.toml, one after another, without a person.
//!
//! A step is a gait for some cycles, a gait for some time, a rest, or a wait; a contact may end it earlier.
//! Every stop and every other motion ends the routine; only an order or `boot` begins one.

use super::Control;
use crate::control::contact::Contact;
use crate::control::safety::Notice;
use crate::numbers::gaits::{GaitId, Input, Step};

/// The running routine, if there is one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Routine {
    /// The routine's index; the index of `stand` while no routine runs.
    pub id: GaitId,
    /// The number of the next step.
    step: u8,
    /// Rounds that are not over yet, including the present one; 0 for a routine without an end.
    rounds_left: u16,
    /// Frames until the step is over; 0 if the end of a gait's count is awaited,
    /// [`Step::ENDLESS`] if only a contact ends it.
    frames_left: u16,
}

impl Routine {
    pub const NONE: Self = Self {
        id: GaitId::STAND,
        step: 0,
        rounds_left: 0,
        frames_left: 0,
    };

    pub fn is_under_way(&self) -> bool {
        self.id != GaitId::STAND
    }
}

impl Control {
    /// Begins a gait for `count` cycles, 0 for no limit; or a routine for `count` rounds, 0 for the number in
    /// robot.toml.
    #[inline(never)]
    pub(super) fn start(&mut self, id: GaitId, count: u16) {
        let gait = self.motion.robot().gait(id);
        self.routine = Routine::NONE;
        if gait.is_routine() {
            let [_, _, rounds, _] = gait.channels;
            self.routine.id = id;
            self.routine.rounds_left = if count == 0 { rounds.offset } else { count };
            self.begin_next_step();
        } else {
            self.motion.start_gait(id, count);
        }
    }

    /// Continues the routine after a frame in which the awaited contact had this level.
    #[inline(never)]
    pub(super) fn advance_routine(&mut self, is_closed: bool) {
        if self.motion.hazard().is_some() {
            self.routine = Routine::NONE;
            return;
        }
        let is_over = match self.routine.frames_left {
            0 => self.motion.has_ended(),
            Step::ENDLESS => false,
            _ => {
                self.routine.frames_left -= 1;
                self.routine.frames_left == 0
            }
        };
        if self.contact.count_frame(is_closed) || is_over {
            self.begin_next_step();
        }
    }

    #[inline(never)]
    fn begin_next_step(&mut self) {
        let robot = *self.motion.robot();
        let gait = robot.gait(self.routine.id);
        let [_, steps, _, first_of_round] = &gait.channels;
        let mut number = u16::from(self.routine.step);
        if number >= steps.offset {
            number = first_of_round.offset;
            if self.routine.rounds_left == 1 {
                self.routine = Routine::NONE;
                // The pose of the routine's last rest has to survive a loss of power.
                if self.motion.is_resting() {
                    self.rest();
                }
                // A gait that is still under way brakes first.
                if !self.motion.end_gait() {
                    self.safety.notify(Notice::Done);
                }
                return;
            }
            self.routine.rounds_left = self.routine.rounds_left.saturating_sub(1);
        }
        let mut step = robot.step(&gait, number);
        let mut input = Input::NONE;
        if step.kind == Step::UNTIL {
            input = robot.input(&step);
            number += 1;
            step = robot.step(&gait, number);
            self.safety.notify(Notice::Waiting);
        }
        let Step {
            kind,
            gait: index,
            count,
        } = step;
        self.routine.step = number as u8 + 1;
        self.routine.frames_left = if kind == Step::CYCLES { 0 } else { count };
        self.contact = if kind == Step::WAIT {
            Contact::waiting_to_close(input)
        } else {
            Contact::waiting_while_open(input)
        };
        match kind {
            Step::REST => self.motion.rest(),
            Step::WAIT => {
                self.motion.end_gait();
            }
            _ => {
                let cycles = if kind == Step::CYCLES { count } else { 0 };
                self.motion.start_gait(GaitId::at(index), cycles);
            }
        }
    }
}
