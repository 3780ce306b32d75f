//! The count of a gait's cycles, and the braking at the end of the last cycle.
//!
//! Braking takes at most seven frames, in which the gait covers as much phase as in three frames at full pace, or less
//! if it is slower. Therefore the gait begins to brake three frames before the end of its last cycle, and stops within
//! two frames of that end.

use super::Motion;
use crate::motion::state::{State, Target};
use crate::numbers::units::phase16;

/// The count of a gait's cycles. A phase is in 1/65536 cycle, so it wraps at the end of a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CycleCount {
    /// The number of cycles left, including the current cycle; 0 if the gait has no count.
    pub cycles_left: u16,
    /// The phase covered since the count started, modulo one cycle.
    pub phase_covered: u16,
    /// The gait's phase in the last frame.
    pub last_phase: u16,
}

impl CycleCount {
    /// No count: the gait continues until a command or a fault ends it.
    pub const NONE: Self = Self {
        cycles_left: 0,
        phase_covered: 0,
        last_phase: 0,
    };
}

impl Motion {
    /// Adds the phase covered in the last frame, and makes the gait brake shortly before the count ends.
    #[inline(never)]
    pub(super) fn count_cycles(&mut self) {
        let State::Cycling { gait, phase, .. } = &self.state else {
            return;
        };
        let count = &mut self.cycle_count;
        let phase = phase16(*phase);
        let mut advance = phase.wrapping_sub(count.last_phase);
        count.last_phase = phase;
        if count.cycles_left == 0 || self.next_target.is_some() {
            return;
        }
        if gait.increment < 0 {
            advance = advance.wrapping_neg();
        }
        let (phase_covered, mut is_cycle_over) = count.phase_covered.overflowing_add(advance);
        count.phase_covered = phase_covered;
        is_cycle_over |= count.cycles_left == 1 && phase_covered.checked_add(3 * advance).is_none();
        if is_cycle_over {
            count.cycles_left -= 1;
            if count.cycles_left == 0 {
                self.next_target = Some(Target::Standstill);
            }
        }
    }
}
