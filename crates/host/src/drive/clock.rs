//! A clock that does not advance while this program is suspended, and a time limit by that clock.
//!
//! A machine that sleeps or is too busy suspends this program. When it continues, a time limit by the machine's clock
//! would be over, although the program could not read anything meanwhile.

use std::time::{Duration, Instant};

/// The longest time that counts between two readings of the machine's clock. A read of the port ends after some
/// milliseconds, so a longer time means that the program was suspended.
const LONGEST_STEP: Duration = Duration::from_millis(100);

/// A clock that advances like the machine's, except during pauses of this program.
#[derive(Debug)]
pub struct Clock {
    now: Instant,
    last_reading: Instant,
}

impl Clock {
    /// Starts at the machine's time. [`Clock::now`] must be called after each read of the port, since at most
    /// [`LONGEST_STEP`] counts between two calls.
    pub fn start() -> Self {
        let now = Instant::now();
        Self {
            now,
            last_reading: now,
        }
    }

    /// Returns the time, excluding pauses.
    pub fn now(&mut self) -> Instant {
        self.now_at(Instant::now())
    }

    fn now_at(&mut self, reading: Instant) -> Instant {
        let step = reading.saturating_duration_since(self.last_reading);
        self.now += step.min(LONGEST_STEP);
        self.last_reading = reading;
        self.now
    }
}

/// A time limit that starts at its creation.
#[derive(Debug)]
pub struct Deadline {
    clock: Clock,
    end: Instant,
}

impl Deadline {
    /// Starts a time limit. [`Deadline::has_passed`] must be called after each read of the port.
    pub fn after(duration: Duration) -> Self {
        let clock = Clock::start();
        let end = clock.now + duration;
        Self { clock, end }
    }

    /// True if the time limit is over.
    pub fn has_passed(&mut self) -> bool {
        self.clock.now() >= self.end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_longer_pause_counts_as_the_longest_step_only() {
        let ms = Duration::from_millis;
        let mut clock = Clock::start();
        let start = clock.now;
        for (reading_ms, elapsed_ms) in
            [(10, 10), (100, 100), (3000, 200), (3049, 249), (3050, 250)]
        {
            assert_eq!(
                clock.now_at(start + ms(reading_ms)),
                start + ms(elapsed_ms),
                "{reading_ms} ms"
            );
        }
    }

    #[test]
    fn a_time_limit_passes_after_its_time() {
        let mut zero_deadline = Deadline::after(Duration::ZERO);
        assert!(zero_deadline.has_passed());
        let mut long_deadline = Deadline::after(Duration::from_secs(3600));
        assert!(!long_deadline.has_passed());
    }
}
