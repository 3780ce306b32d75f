//! The log of all frames in a run. A frame takes eight bytes, so that even a simulated day fits into memory.

use simulated_uno::{Edge, FREQUENCY, Pin};

use super::frame::{FRAME_CYCLES, first_cycle};

/// The pulses of every frame from A1's first pulse.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FrameLog {
    /// Start cycle of A1's pulse in the first frame.
    pub first_start: u64,
    /// Widths of each frame's pulses, cycles, in servo order; 0 if there is no pulse, 65535 for a pulse of 65535
    /// cycles or more.
    pub widths: Vec<[u16; 4]>,
    /// Each servo's largest deviation of a pulse period from 20 ms, cycles.
    pub max_period_error: [u64; 4],
    /// Largest number of servo pins that are high at the same time.
    pub max_pins_high: u32,
}

impl FrameLog {
    /// Creates a log of pulses with exact periods.
    pub fn new(first_start: u64, widths: Vec<[u16; 4]>) -> Self {
        Self {
            first_start,
            widths,
            ..Self::default()
        }
    }

    /// Returns the seconds from power-on to the start of the frame at `index`.
    pub fn seconds_at(&self, index: usize) -> f64 {
        (self.first_start + index as u64 * FRAME_CYCLES) as f64 / FREQUENCY as f64
    }

    /// Returns the index of the first frame at `seconds` after power-on or later; the number of frames if there is
    /// none.
    pub fn index_at(&self, seconds: f64) -> usize {
        let offset_cycles = seconds * FREQUENCY as f64 - self.first_start as f64;
        let index = (offset_cycles / FRAME_CYCLES as f64).ceil().max(0.0) as usize;
        index.min(self.widths.len())
    }
}

/// Builds a [`FrameLog`] from edges that arrive in any number of batches.
#[derive(Debug)]
pub struct FrameReader {
    pins: [Pin; 4],
    log: FrameLog,
    /// Cycle of each servo pin's latest rising edge; `None` while the pin is low.
    rise_cycles: [Option<u64>; 4],
    /// Each servo's latest pulse: the index of its frame and the cycle of its start.
    latest_pulses: [Option<(usize, u64)>; 4],
    /// True once A1's first pulse has started.
    has_started: bool,
}

impl FrameReader {
    /// Creates a reader for the pulses of `pins`, the pins of the servos A1 to A4.
    pub fn new(pins: [Pin; 4]) -> Self {
        Self {
            pins,
            log: FrameLog::default(),
            rise_cycles: [None; 4],
            latest_pulses: [None; 4],
            has_started: false,
        }
    }

    /// Reads the next edges in order of time. Edges of other pins are skipped.
    pub fn read(&mut self, mut edges: Vec<Edge>) {
        // At equal cycles the falling edge comes first, so that back-to-back pulses do not overlap.
        edges.sort_by_key(|edge| (edge.cycle, edge.is_rising));
        for edge in edges {
            let Some(servo) = self.pins.iter().position(|pin| *pin == edge.pin) else {
                continue;
            };
            if edge.is_rising {
                if servo == 0 && !self.has_started {
                    self.log.first_start = edge.cycle;
                    self.has_started = true;
                }
                self.rise_cycles[servo] = Some(edge.cycle);
                let high_count = self.rise_cycles.iter().flatten().count() as u32;
                self.log.max_pins_high = self.log.max_pins_high.max(high_count);
            } else if let Some(start) = self.rise_cycles[servo].take() {
                self.record_pulse(servo, start, edge.cycle - start);
            }
        }
    }

    /// Adds a pulse to the log. Ignores pulses before A1's first pulse.
    fn record_pulse(&mut self, servo: usize, start: u64, width: u64) {
        let Some(offset_cycles) = start.checked_sub(first_cycle(self.log.first_start)) else {
            return;
        };
        if !self.has_started {
            return;
        }
        let index = (offset_cycles / FRAME_CYCLES) as usize;
        if self.log.widths.len() <= index {
            self.log.widths.resize(index + 1, [0; 4]);
        }
        self.log.widths[index][servo] = u16::try_from(width).unwrap_or(u16::MAX);
        if let Some((previous_index, previous_start)) =
            self.latest_pulses[servo].replace((index, start))
            && previous_index + 1 == index
        {
            let max_error = &mut self.log.max_period_error[servo];
            *max_error = (*max_error).max((start - previous_start).abs_diff(FRAME_CYCLES));
        }
    }

    /// Returns the log with exactly the frames that are complete at `cycle`.
    pub fn finish(mut self, cycle: u64) -> FrameLog {
        let frame_count = if self.has_started {
            (cycle - first_cycle(self.log.first_start)) / FRAME_CYCLES
        } else {
            0
        };
        self.log.widths.resize(frame_count as usize, [0; 4]);
        self.log
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::sim::frame::{SLOT_CYCLES, tests::pulse_edges};

    const PINS: [Pin; 4] = [Pin::d(9), Pin::d(10), Pin::a(0), Pin::d(3)];

    /// Reads the edges in two batches, split at `split_index`.
    fn read_in_two_batches(edges: &[Edge], split_index: usize, cycle: u64) -> FrameLog {
        let mut reader = FrameReader::new(PINS);
        reader.read(edges[..split_index].to_vec());
        reader.read(edges[split_index..].to_vec());
        reader.finish(cycle)
    }

    #[test]
    fn the_log_does_not_depend_on_the_batches() {
        let start = 1_000_000;
        let mut edges = Vec::new();
        edges.extend(pulse_edges(PINS[3], 500_000, 20_000)); // before A1's first pulse
        edges.extend(pulse_edges(PINS[0], start, 24_000));
        edges.extend(pulse_edges(Pin::d(13), start + 10, 5)); // not a servo's pin
        edges.extend(pulse_edges(PINS[2], start + SLOT_CYCLES, 25_000));
        edges.extend(pulse_edges(PINS[0], start + FRAME_CYCLES + 7, 26_000));
        edges.extend(pulse_edges(PINS[0], start + 3 * FRAME_CYCLES - 1, 27_000));
        edges.sort_by_key(|edge| edge.cycle);
        let end = start + 4 * FRAME_CYCLES;
        for split_index in 0..edges.len() {
            let log = read_in_two_batches(&edges, split_index, end);
            let [a, b, c]: [u16; 3] = [24_000, 26_000, 27_000];
            let widths = [[a, 0, 25_000, 0], [b, 0, 0, 0], [0; 4], [c, 0, 0, 0]];
            assert_eq!(log.first_start, start, "{split_index}");
            assert_eq!(log.widths, widths, "{split_index}");
            assert_eq!(log.max_period_error, [7, 0, 0, 0], "a gap is not a period");
            assert_eq!(log.max_pins_high, 1);
        }
    }

    #[test]
    fn only_overlapping_pulses_count_as_high_at_once() {
        let max_pins_high = |second_start: u64| {
            let mut edges = Vec::from(pulse_edges(PINS[0], 1_000_000, 100));
            edges.extend(pulse_edges(PINS[1], second_start, 100));
            read_in_two_batches(&edges, 0, 3_000_000).max_pins_high
        };
        assert_eq!((max_pins_high(1_000_099), max_pins_high(1_000_100)), (2, 1));
    }

    #[test]
    fn index_at_finds_frames_by_start_time() {
        let log = FrameLog::new(FREQUENCY, vec![[0; 4]; 50]);
        for (seconds, index) in [(0.0, 0), (1.0, 0), (1.01, 1), (1.02, 1), (9.0, 50)] {
            assert_eq!(log.index_at(seconds), index, "{seconds}");
        }
        assert_eq!(log.seconds_at(25), 1.5);
    }
}
