//! A wire with two senders, such as the UNO's D0 where a radio module shares it with USB.
//!
//! The wire is high while no sender pulls it low. If both send at once, their bits mix, and the receiver reads bytes
//! that neither has sent, some without a stop bit. Pass the bytes that the receiver reads to
//! [`Uno::send`](crate::Uno::send) and [`Uno::send_with_framing_error`](crate::Uno::send_with_framing_error).

use std::collections::VecDeque;

use crate::FREQUENCY;

/// The number of bits of a byte on the wire: a start bit, eight data bits and a stop bit.
const FRAME_BITS: f64 = 10.0;
/// The time from the start of a byte to the middle of its stop bit, at which a receiver has read the byte; in bits.
const STOP_BIT_MIDDLE: f64 = 9.5;
/// Number of bytes of each sender that are searched for edges: more than the fastest sender sends while the slowest
/// receiver reads one byte.
const NEAR_BYTES: usize = 16;

/// A byte on the wire.
#[derive(Debug, Clone, Copy)]
struct Frame {
    /// The cycle at which the byte's start bit begins.
    start: f64,
    /// Duration of a bit, cycles.
    bit: f64,
    byte: u8,
}

impl Frame {
    fn end(&self) -> f64 {
        self.start + FRAME_BITS * self.bit
    }

    fn is_high(&self, cycle: f64) -> bool {
        let index = ((cycle - self.start) / self.bit).floor();
        let bits = 1u32 << 9 | u32::from(self.byte) << 1;
        !(0.0..FRAME_BITS).contains(&index) || bits >> index as u32 & 1 == 1
    }
}

/// A wire with two senders, each with its own rate, and a receiver.
#[derive(Debug)]
pub struct Wire {
    /// Duration of a bit of each sender, cycles.
    bits: [f64; 2],
    /// The bytes of each sender that may still be read, in order.
    talkers: [VecDeque<Frame>; 2],
    /// The cycle from which the receiver waits for the next start bit.
    idle_from: f64,
}

impl Wire {
    /// Returns an idle wire for two senders with these baud rates.
    #[must_use]
    pub fn new(rates: [f64; 2]) -> Self {
        Self {
            bits: rates.map(|baud| FREQUENCY as f64 / baud),
            talkers: [VecDeque::new(), VecDeque::new()],
            idle_from: f64::NEG_INFINITY,
        }
    }

    /// Queues bytes of a sender, 0 or 1, which sends them back to back from the cycle `now` on.
    pub fn write(&mut self, talker: usize, bytes: &[u8], now: u64) {
        let bit = self.bits[talker];
        for byte in bytes {
            let free_cycle = self.talkers[talker].back().map_or(0.0, Frame::end);
            let start = free_cycle.max(now as f64);
            self.talkers[talker].push_back(Frame {
                start,
                bit,
                byte: *byte,
            });
        }
    }

    /// Returns the bytes that a receiver of this baud rate has read since the last call, until the cycle `now`;
    /// `None` for a byte without a stop bit.
    pub fn receive(&mut self, now: u64, baud: f64) -> Vec<Option<u8>> {
        let bit = FREQUENCY as f64 / baud;
        let mut received = Vec::new();
        while let Some(start) = self.next_fall() {
            let end = start + STOP_BIT_MIDDLE * bit;
            if end > now as f64 {
                break;
            }
            let is_bit_high = |index: u8| self.is_high(start + (f64::from(index) + 1.5) * bit);
            let byte = (0..8).fold(0, |byte, index| {
                byte | u8::from(is_bit_high(index)) << index
            });
            received.push(is_bit_high(8).then_some(byte));
            self.idle_from = end;
            for talker in &mut self.talkers {
                while talker.front().is_some_and(|frame| frame.end() <= end) {
                    talker.pop_front();
                }
            }
        }
        received
    }

    /// Returns the next cycle at which the wire changes from high to low; `None` if the senders have no further
    /// bytes.
    fn next_fall(&self) -> Option<f64> {
        let edges = self.pending_frames().flat_map(|frame| {
            (0..9).map(|index| (frame.start + f64::from(index) * frame.bit, frame.bit))
        });
        edges
            .filter(|(cycle, _)| *cycle > self.idle_from)
            .filter(|(cycle, bit)| {
                // Samples on both sides of the edge, since the sums are rounded.
                let margin = bit / 100.0;
                self.is_high(cycle - margin) && !self.is_high(cycle + margin)
            })
            .map(|(cycle, _)| cycle)
            .min_by(f64::total_cmp)
    }

    /// Returns the bytes that may be on the wire while the receiver reads its next byte.
    fn pending_frames(&self) -> impl Iterator<Item = &Frame> {
        self.talkers
            .iter()
            .flat_map(|talker| talker.iter().take(NEAR_BYTES))
    }

    fn is_high(&self, cycle: f64) -> bool {
        self.pending_frames().all(|frame| frame.is_high(cycle))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Duration of a byte at 115200 baud, cycles.
    const BYTE_CYCLES: u64 = 1389;

    fn receive_all(writes: &[(usize, &[u8], u64)]) -> Vec<Option<u8>> {
        let mut wire = Wire::new([115_200.0; 2]);
        for (talker, bytes, cycle) in writes {
            wire.write(*talker, bytes, *cycle);
        }
        wire.receive(1_000_000, 115_200.0)
    }

    fn bytes_without_errors(text: &[u8]) -> Vec<Option<u8>> {
        text.iter().copied().map(Some).collect()
    }

    #[test]
    fn a_single_sender_is_read_correctly() {
        let all_bytes: Vec<u8> = (0..=255).collect();
        for talker in [0, 1] {
            assert_eq!(
                receive_all(&[(talker, &all_bytes, 70)]),
                bytes_without_errors(&all_bytes)
            );
        }
    }

    #[test]
    fn consecutive_bytes_of_two_senders_are_all_read() {
        let writes: [(usize, &[u8], u64); 3] = [
            (0, b"walk\n", 0),
            (1, b"stop\n", 5 * BYTE_CYCLES),
            (0, b"?\n", 10 * BYTE_CYCLES + 40),
        ];
        assert_eq!(
            receive_all(&writes),
            bytes_without_errors(b"walk\nstop\n?\n")
        );
    }

    #[test]
    fn simultaneous_bits_of_two_senders_are_combined_by_and() {
        let writes: [(usize, &[u8], u64); 2] = [(0, b"walk\n", 9), (1, b"stop\n", 9)];
        let combined_bytes =
            std::array::from_fn::<u8, 5, _>(|index| b"walk\n"[index] & b"stop\n"[index]);
        assert_eq!(receive_all(&writes), bytes_without_errors(&combined_bytes));
    }

    #[test]
    fn a_byte_that_begins_in_anothers_stop_bit_takes_that_away() {
        let writes: [(usize, &[u8], u64); 2] = [(0, &[0xff], 0), (1, &[0x0f], BYTE_CYCLES - 138)];
        assert_eq!(receive_all(&writes)[0], None);
    }

    #[test]
    fn each_sender_is_read_only_at_its_own_rate() {
        let rates = [9_600.0, 57_600.0];
        for (talker, rate) in rates.into_iter().enumerate() {
            let mut wire = Wire::new(rates);
            wire.write(talker, b"status\n", 500);
            assert_eq!(
                wire.receive(500 + 70 * (16_000_000 / rate as u64), rate),
                bytes_without_errors(b"status\n")
            );
            wire.write(talker, b"status\n", 1_000_000);
            let read_bytes = wire.receive(2_000_000, rates[1 - talker]);
            assert!(
                !read_bytes.is_empty() && !read_bytes.contains(&Some(b'\n')),
                "{read_bytes:?}"
            );
        }
    }

    #[test]
    fn a_fast_byte_at_a_slow_receiver_is_one_of_its_bits() {
        let mut wire = Wire::new([115_200.0; 2]);
        // Twelve bits of the sender last as long as one bit of the receiver. So the sender's whole byte lies within
        // the receiver's start bit.
        wire.write(0, &[0x00], 0);
        assert_eq!(wire.receive(1_000_000, 9_600.0), [Some(0xff)]);
    }
}
