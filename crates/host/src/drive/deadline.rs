//! A time limit for an answer that does not count the time in which this program stands still.
//!
//! A machine that sleeps or is too busy holds this program up. Afterwards the clock says that the time is over,
//! although nothing had a chance to arrive or to be read.

use std::time::{Duration, Instant};

/// The longest time that counts between two looks at the clock. A read ends after some milliseconds.
const LONGEST_STEP: Duration = Duration::from_millis(100);

/// A time limit that begins when it is made.
#[derive(Debug)]
pub struct Deadline {
    left: Duration,
    last_look: Instant,
}

impl Deadline {
    /// Starts a time limit. [`Deadline::has_passed`] must be called after each read.
    pub fn after(time: Duration) -> Self {
        Self {
            left: time,
            last_look: Instant::now(),
        }
    }

    /// True if the time is over.
    pub fn has_passed(&mut self) -> bool {
        self.has_passed_at(Instant::now())
    }

    fn has_passed_at(&mut self, now: Instant) -> bool {
        let step = now.saturating_duration_since(self.last_look);
        self.left = self.left.saturating_sub(step.min(LONGEST_STEP));
        self.last_look = now;
        self.left.is_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_limit_passes_after_its_time_and_a_pause_of_the_program_hardly_counts() {
        let ms = Duration::from_millis;
        let mut deadline = Deadline::after(ms(250));
        let start = deadline.last_look;
        for (at, is_over) in [
            (10, false),
            (100, false),
            (3000, false),
            (3049, false),
            (3050, true),
        ] {
            assert_eq!(deadline.has_passed_at(start + ms(at)), is_over, "{at} ms");
        }
    }
}
