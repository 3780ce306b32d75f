//! One wire with two talkers, as the UNO's D0 has where a radio module shares it with USB.
//!
//! Each talker pulls the wire low, and it is high while none does. If both talk at once, their bits
//! mix, and the receiver reads bytes that nobody has sent, some without a stop bit. What it has read is
//! for [`Uno::send`](crate::Uno::send) and
//! [`Uno::send_with_framing_error`](crate::Uno::send_with_framing_error).

use std::collections::VecDeque;

use crate::FREQUENCY;

/// Bits of a byte: start, eight data bits, stop.
const FRAME: f64 = 10.0;
/// The middle of the stop bit, where a receiver is done with a byte.
const DONE: f64 = 9.5;

/// A byte on the wire.
#[derive(Debug, Clone, Copy)]
struct Frame {
    /// The cycle at which its start bit begins.
    start: f64,
    byte: u8,
}

/// A wire with two talkers of the same rate.
#[derive(Debug)]
pub struct Wire {
    /// Cycles of a bit.
    bit: f64,
    /// The bytes of each talker, in order.
    talkers: [VecDeque<Frame>; 2],
    /// The cycle from which the receiver looks for the next byte.
    free: f64,
}

impl Wire {
    /// A wire on which nobody talks.
    #[must_use]
    pub fn new(baud: f64) -> Self {
        Self {
            bit: FREQUENCY as f64 / baud,
            talkers: [VecDeque::new(), VecDeque::new()],
            free: f64::NEG_INFINITY,
        }
    }

    /// Queues bytes of a talker, 0 or 1, which sends them back to back from this cycle on.
    pub fn write(&mut self, talker: usize, bytes: &[u8], now: u64) {
        for byte in bytes {
            let last = self.talkers[talker].back();
            let free = last.map_or(0.0, |frame| frame.start + FRAME * self.bit);
            let start = free.max(now as f64);
            self.talkers[talker].push_back(Frame { start, byte: *byte });
        }
    }

    /// The bytes that a receiver has read by now, since the last call; `None` for one without a
    /// stop bit.
    pub fn receive(&mut self, now: u64) -> Vec<Option<u8>> {
        let mut received = Vec::new();
        while let Some(start) = self.next_fall() {
            let done = start + DONE * self.bit;
            if done > now as f64 {
                break;
            }
            let sampled = |place: u8| self.is_high(start + (f64::from(place) + 1.5) * self.bit);
            let byte = (0..8).fold(0, |byte, place| byte | u8::from(sampled(place)) << place);
            received.push(sampled(8).then_some(byte));
            self.free = done;
            let end = FRAME * self.bit;
            for talker in &mut self.talkers {
                while talker.front().is_some_and(|it| it.start + end <= done) {
                    talker.pop_front();
                }
            }
        }
        received
    }

    /// The next moment at which the wire goes from high to low.
    fn next_fall(&self) -> Option<f64> {
        let edges = self
            .near()
            .flat_map(|it| (0..9).map(|place| it.start + f64::from(place) * self.bit));
        // A little beside the edge, since the sums are rounded.
        let beside = self.bit / 100.0;
        edges
            .filter(|at| *at > self.free)
            .filter(|at| self.is_high(at - beside) && !self.is_high(at + beside))
            .min_by(f64::total_cmp)
    }

    /// The bytes that may be on the wire until the next one is read.
    fn near(&self) -> impl Iterator<Item = &Frame> {
        self.talkers.iter().flat_map(|talker| talker.iter().take(4))
    }

    fn is_high(&self, at: f64) -> bool {
        self.near().all(|frame| {
            let place = ((at - frame.start) / self.bit).floor();
            let bits = 1u32 << 9 | u32::from(frame.byte) << 1;
            !(0.0..FRAME).contains(&place) || bits >> place as u32 & 1 == 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cycles of a byte.
    const BYTE: u64 = 1389;

    fn received(writes: &[(usize, &[u8], u64)]) -> Vec<Option<u8>> {
        let mut wire = Wire::new(115_200.0);
        for (talker, bytes, at) in writes {
            wire.write(*talker, bytes, *at);
        }
        wire.receive(1_000_000)
    }

    fn whole(text: &[u8]) -> Vec<Option<u8>> {
        text.iter().copied().map(Some).collect()
    }

    #[test]
    fn a_talker_alone_is_read_as_it_talks() {
        let all: Vec<u8> = (0..=255).collect();
        for talker in [0, 1] {
            assert_eq!(received(&[(talker, &all, 70)]), whole(&all));
        }
    }

    #[test]
    fn bytes_of_two_talkers_one_after_the_other_are_all_read() {
        let writes: [(usize, &[u8], u64); 3] = [
            (0, b"walk\n", 0),
            (1, b"stop\n", 5 * BYTE),
            (0, b"?\n", 10 * BYTE + 40),
        ];
        assert_eq!(received(&writes), whole(b"walk\nstop\n?\n"));
    }

    #[test]
    fn bits_of_two_talkers_at_the_same_moment_are_the_ones_that_both_have() {
        let writes: [(usize, &[u8], u64); 2] = [(0, b"walk\n", 9), (1, b"stop\n", 9)];
        let both = std::array::from_fn::<u8, 5, _>(|at| b"walk\n"[at] & b"stop\n"[at]);
        assert_eq!(received(&writes), whole(&both));
    }

    #[test]
    fn a_byte_that_begins_in_anothers_stop_bit_takes_that_away() {
        let writes: [(usize, &[u8], u64); 2] = [(0, &[0xff], 0), (1, &[0x0f], BYTE - 138)];
        assert_eq!(received(&writes)[0], None);
    }
}
