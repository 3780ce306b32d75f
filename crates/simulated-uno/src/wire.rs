//! A wire with two senders, such as the UNO's D0 when both a radio module and USB are connected to it.
//!
//! The wire is high while no sender pulls it low. If both send at once, a bit is high only if both bits are high, and
//! the receiver reads bytes that neither has sent, some without a stop bit. Pass the bytes that the receiver reads to
//! [`Uno::send`](crate::Uno::send) and [`Uno::send_with_framing_error`](crate::Uno::send_with_framing_error).

use std::collections::VecDeque;

use crate::FREQUENCY;

/// The number of bits per byte on the wire: a start bit, eight data bits and a stop bit.
const FRAME_BITS: f64 = 10.0;
/// The time from the start of a byte to the middle of its stop bit, when a receiver has read the byte; bits.
const STOP_BIT_MIDDLE: f64 = 9.5;
/// The number of bytes of each sender that are searched for edges: more than the fastest sender sends while the slowest
/// receiver reads one byte.
const SEARCHED_BYTES_PER_SENDER: usize = 16;

/// A byte on the wire.
#[derive(Debug, Clone, Copy)]
struct Frame {
    /// The cycle at which the byte's start bit begins.
    start_cycle: f64,
    /// Duration of a bit, cycles.
    bit_cycles: f64,
    byte: u8,
}

impl Frame {
    /// Computes the cycle at which the stop bit ends.
    fn end_cycle(&self) -> f64 {
        self.start_cycle + FRAME_BITS * self.bit_cycles
    }

    /// True if the sender leaves the wire high at this cycle.
    fn is_high(&self, cycle: f64) -> bool {
        let index = ((cycle - self.start_cycle) / self.bit_cycles).floor();
        let bits = 1u32 << 9 | u32::from(self.byte) << 1;
        !(0.0..FRAME_BITS).contains(&index) || bits >> index as u32 & 1 == 1
    }
}

/// A wire with two senders, each with its own baud rate, and a receiver.
#[derive(Debug)]
pub struct Wire {
    /// Duration of a bit of each sender, cycles.
    bit_cycles: [f64; 2],
    /// The bytes of each sender that may still be read, in order.
    frames: [VecDeque<Frame>; 2],
    /// The cycle from which on the receiver waits for the next start bit.
    idle_from_cycle: f64,
}

impl Wire {
    /// Creates an idle wire for two senders with these baud rates.
    #[must_use]
    pub fn new(baud_rates: [f64; 2]) -> Self {
        Self {
            bit_cycles: baud_rates.map(|rate| FREQUENCY as f64 / rate),
            frames: [VecDeque::new(), VecDeque::new()],
            idle_from_cycle: f64::NEG_INFINITY,
        }
    }

    /// Queues bytes of a sender, 0 or 1, which sends them back to back, starting at the cycle `now`.
    pub fn write(&mut self, sender: usize, bytes: &[u8], now: u64) {
        let bit_cycles = self.bit_cycles[sender];
        for byte in bytes {
            let free_cycle = self.frames[sender].back().map_or(0.0, Frame::end_cycle);
            let start_cycle = free_cycle.max(now as f64);
            self.frames[sender].push_back(Frame {
                start_cycle,
                bit_cycles,
                byte: *byte,
            });
        }
    }

    /// Returns the bytes that a receiver with this baud rate has read between the last call and the cycle `now`; `None`
    /// for a byte without a stop bit.
    pub fn receive(&mut self, now: u64, baud_rate: f64) -> Vec<Option<u8>> {
        let bit_cycles = FREQUENCY as f64 / baud_rate;
        let mut received_bytes = Vec::new();
        while let Some(start_cycle) = self.next_falling_edge() {
            let read_cycle = start_cycle + STOP_BIT_MIDDLE * bit_cycles;
            if read_cycle > now as f64 {
                break;
            }
            let is_bit_high =
                |index: u8| self.is_high(start_cycle + (f64::from(index) + 1.5) * bit_cycles);
            let byte = (0..8).fold(0, |byte, index| {
                byte | u8::from(is_bit_high(index)) << index
            });
            received_bytes.push(is_bit_high(8).then_some(byte));
            self.idle_from_cycle = read_cycle;
            for sender_frames in &mut self.frames {
                sender_frames.retain(|frame| frame.end_cycle() > read_cycle);
            }
        }
        received_bytes
    }

    /// Finds the next cycle at which the wire changes from high to low; `None` if the senders have no further bytes.
    fn next_falling_edge(&self) -> Option<f64> {
        let edges = self.pending_frames().flat_map(|frame| {
            (0..9).map(|index| {
                let cycle = frame.start_cycle + f64::from(index) * frame.bit_cycles;
                (cycle, frame.bit_cycles)
            })
        });
        edges
            .filter(|(cycle, _)| *cycle > self.idle_from_cycle)
            .filter(|(cycle, bit_cycles)| {
                // The samples lie on both sides of the edge, since the sums are rounded.
                let margin = bit_cycles / 100.0;
                self.is_high(cycle - margin) && !self.is_high(cycle + margin)
            })
            .map(|(cycle, _)| cycle)
            .min_by(f64::total_cmp)
    }

    /// Returns the bytes that may be on the wire while the receiver reads its next byte.
    fn pending_frames(&self) -> impl Iterator<Item = &Frame> {
        self.frames
            .iter()
            .flat_map(|sender_frames| sender_frames.iter().take(SEARCHED_BYTES_PER_SENDER))
    }

    /// True if the wire is high at this cycle.
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
        for (sender, bytes, cycle) in writes {
            wire.write(*sender, bytes, *cycle);
        }
        wire.receive(1_000_000, 115_200.0)
    }

    fn bytes_without_errors(text: &[u8]) -> Vec<Option<u8>> {
        text.iter().copied().map(Some).collect()
    }

    #[test]
    fn a_single_sender_is_read_correctly() {
        let all_bytes: Vec<u8> = (0..=255).collect();
        for sender in [0, 1] {
            let received_bytes = receive_all(&[(sender, &all_bytes, 70)]);
            assert_eq!(received_bytes, bytes_without_errors(&all_bytes));
        }
    }

    #[test]
    fn consecutive_bytes_of_two_senders_are_all_read() {
        let writes: [(usize, &[u8], u64); 3] = [
            (0, b"walk\n", 0),
            (1, b"stop\n", 5 * BYTE_CYCLES),
            (0, b"?\n", 10 * BYTE_CYCLES + 40),
        ];
        let sent_bytes = b"walk\nstop\n?\n";
        assert_eq!(receive_all(&writes), bytes_without_errors(sent_bytes));
    }

    #[test]
    fn simultaneous_bits_of_two_senders_are_combined_by_and() {
        let writes: [(usize, &[u8], u64); 2] = [(0, b"walk\n", 9), (1, b"stop\n", 9)];
        let combined_bytes =
            std::array::from_fn::<u8, 5, _>(|index| b"walk\n"[index] & b"stop\n"[index]);
        assert_eq!(receive_all(&writes), bytes_without_errors(&combined_bytes));
    }

    #[test]
    fn a_byte_lacks_its_stop_bit_if_the_other_sender_starts_during_that_bit() {
        let writes: [(usize, &[u8], u64); 2] = [(0, &[0xff], 0), (1, &[0x0f], BYTE_CYCLES - 138)];
        assert_eq!(receive_all(&writes)[0], None);
    }

    #[test]
    fn each_sender_is_read_only_at_its_own_baud_rate() {
        let rates = [9_600.0, 57_600.0];
        for (sender, rate) in rates.into_iter().enumerate() {
            let mut wire = Wire::new(rates);
            wire.write(sender, b"status\n", 500);
            let read_bytes = wire.receive(500 + 70 * (16_000_000 / rate as u64), rate);
            assert_eq!(read_bytes, bytes_without_errors(b"status\n"));
            wire.write(sender, b"status\n", 1_000_000);
            let read_bytes = wire.receive(2_000_000, rates[1 - sender]);
            let is_misread = !read_bytes.is_empty() && !read_bytes.contains(&Some(b'\n'));
            assert!(is_misread, "{read_bytes:?}");
        }
    }

    #[test]
    fn a_zero_byte_within_one_bit_of_the_receiver_is_read_as_0xff() {
        let mut wire = Wire::new([115_200.0; 2]);
        // Twelve bits of the sender take as long as one bit of the receiver, so the sender's whole byte lies within the
        // receiver's start bit.
        wire.write(0, &[0x00], 0);
        assert_eq!(wire.receive(1_000_000, 9_600.0), [Some(0xff)]);
    }
}
