//! A clock that stops while this program is suspended, and a time limit measured with that clock.
//!
//! A machine that sleeps or is too busy suspends this program. With the machine's clock, a time limit would be over
//! when the program continues, although the program could not read anything in the meantime.

use std::time::{Duration, Instant};

/// The longest time that counts between two readings of the machine's clock. A read from the port takes a few
/// milliseconds; a longer time therefore means that the program was suspended.
const MAX_STEP: Duration = Duration::from_millis(100);

/// A clock that advances like the machine's clock, except while this program is suspended.
#[derive(Debug)]
pub struct Clock {
    now: Instant,
    last_reading: Instant,
}

impl Clock {
    /// Starts at the machine's time. [`Clock::now`] must be called after each read from the port, since at most
    /// [`MAX_STEP`] counts between two calls.
    pub fn start() -> Self {
        let now = Instant::now();
        Self {
            now,
            last_reading: now,
        }
    }

    /// Returns the time, excluding pauses.
    pub fn now(&mut self) -> Instant {
        self.advance_to(Instant::now())
    }

    fn advance_to(&mut self, reading: Instant) -> Instant {
        let step = reading.saturating_duration_since(self.last_reading);
        self.now += step.min(MAX_STEP);
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
    /// Starts a time limit. [`Deadline::has_passed`] must be called after each read from the port.
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
    fn a_pause_counts_as_at_most_the_longest_step() {
        let ms = Duration::from_millis;
        let mut clock = Clock::start();
        let start = clock.now;
        for (reading_ms, elapsed_ms) in
            [(10, 10), (100, 100), (3000, 200), (3049, 249), (3050, 250)]
        {
            assert_eq!(
                clock.advance_to(start + ms(reading_ms)),
                start + ms(elapsed_ms),
                "{reading_ms} ms"
            );
        }
    }

    #[test]
    fn a_deadline_passes_after_its_duration() {
        let mut zero_deadline = Deadline::after(Duration::ZERO);
        assert!(zero_deadline.has_passed());
        let mut long_deadline = Deadline::after(Duration::from_secs(3600));
        assert!(!long_deadline.has_passed());
    }
}
