//! All frames of a run, small enough for a simulated day: eight bytes a frame.

use simulated_uno::{Edge, FREQUENCY, Pin};

use super::frame::{FRAME, first_cycle};

/// Every frame from A1's first pulse on.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FrameLog {
    /// Cycle at which the first frame's A1 pulse starts.
    pub first: u64,
    /// Widths of each frame's pulses, cycles, in servo order; 0 without a pulse,
    /// 65535 for one that is longer.
    pub widths: Vec<[u16; 4]>,
    /// For each servo, the largest deviation of the distance between two successive pulses from 20 ms, cycles.
    pub period_error: [u64; 4],
    /// Largest number of servo pins that are high at the same time.
    pub most_pins_high: u32,
}

impl FrameLog {
    /// Seconds from power-on to the start of frame number `index`.
    pub fn seconds(&self, index: usize) -> f64 {
        (self.first + index as u64 * FRAME) as f64 / FREQUENCY as f64
    }

    /// Number of the first frame that starts at a time or later; the number of all frames if none does.
    pub fn index(&self, seconds: f64) -> usize {
        let offset_cycles = seconds * FREQUENCY as f64 - self.first as f64;
        let index = (offset_cycles / FRAME as f64).ceil().max(0.0) as usize;
        index.min(self.widths.len())
    }
}

/// Builds a [`FrameLog`] from edges, in as many parts as they come.
#[derive(Debug)]
pub struct FrameReader {
    pins: [Pin; 4],
    log: FrameLog,
    /// Cycle at which each servo's pin rose; `None` while the pin is low.
    rise: [Option<u64>; 4],
    /// Each servo's latest pulse: number of its frame, cycle of its start.
    latest: [Option<(usize, u64)>; 4],
    /// True after A1's first pulse has started.
    has_started: bool,
}

impl FrameReader {
    /// Creates a reader for the pulses of these pins, A1 to A4, with memory for `frames` frames.
    pub fn new(pins: [Pin; 4], frames: usize) -> Self {
        Self {
            pins,
            log: FrameLog {
                widths: Vec::with_capacity(frames),
                ..FrameLog::default()
            },
            rise: [None; 4],
            latest: [None; 4],
            has_started: false,
        }
    }

    /// Reads edges in order of time. Edges of other pins are skipped.
    pub fn read(&mut self, mut edges: Vec<Edge>) {
        // At equal cycles a fall comes first: back-to-back pulses do not overlap.
        edges.sort_by_key(|edge| (edge.cycle, edge.high));
        for edge in edges {
            let Some(servo) = self.pins.iter().position(|pin| *pin == edge.pin) else {
                continue;
            };
            if edge.high {
                if servo == 0 && !self.has_started {
                    self.log.first = edge.cycle;
                    self.has_started = true;
                }
                self.rise[servo] = Some(edge.cycle);
                let high_count = self.rise.iter().flatten().count() as u32;
                self.log.most_pins_high = self.log.most_pins_high.max(high_count);
            } else if let Some(start) = self.rise[servo].take() {
                self.record_pulse(servo, start, edge.cycle - start);
            }
        }
    }

    /// Adds a pulse to the log. Ignores a pulse before A1's first one.
    fn record_pulse(&mut self, servo: usize, start: u64, width: u64) {
        let Some(offset_cycles) = start.checked_sub(first_cycle(self.log.first)) else {
            return;
        };
        if !self.has_started {
            return;
        }
        let index = (offset_cycles / FRAME) as usize;
        if self.log.widths.len() <= index {
            self.log.widths.resize(index + 1, [0; 4]);
        }
        self.log.widths[index][servo] = u16::try_from(width).unwrap_or(u16::MAX);
        if let Some((previous_index, previous_start)) = self.latest[servo].replace((index, start))
            && previous_index + 1 == index
        {
            let error = &mut self.log.period_error[servo];
            *error = (*error).max((start - previous_start).abs_diff(FRAME));
        }
    }

    /// Finishes the log with the complete frames up to a cycle.
    pub fn finish(mut self, cycle: u64) -> FrameLog {
        let frame_count = if self.has_started {
            (cycle - first_cycle(self.log.first)) / FRAME
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
    use crate::simulate::sim::frame::SLOT;

    const PINS: [Pin; 4] = [Pin::d(9), Pin::d(10), Pin::a(0), Pin::d(3)];

    fn pulse_edges(pin: Pin, start: u64, width: u64) -> [Edge; 2] {
        [(start, true), (start + width, false)].map(|(cycle, high)| Edge { cycle, pin, high })
    }

    /// Reads the edges in two parts, split at index `cut`.
    fn read_in_two(edges: &[Edge], cut: usize, cycle: u64) -> FrameLog {
        let mut reader = FrameReader::new(PINS, 0);
        reader.read(edges[..cut].to_vec());
        reader.read(edges[cut..].to_vec());
        reader.finish(cycle)
    }

    #[test]
    fn wherever_the_edges_are_cut_the_log_is_the_same() {
        let start = 1_000_000;
        let mut edges = Vec::new();
        edges.extend(pulse_edges(PINS[3], 500_000, 20_000)); // before A1's first
        edges.extend(pulse_edges(PINS[0], start, 24_000));
        edges.extend(pulse_edges(Pin::d(13), start + 10, 5)); // no servo
        edges.extend(pulse_edges(PINS[2], start + SLOT, 25_000));
        edges.extend(pulse_edges(PINS[0], start + FRAME + 7, 26_000));
        edges.extend(pulse_edges(PINS[0], start + 3 * FRAME - 1, 27_000));
        edges.sort_by_key(|edge| edge.cycle);
        let end = start + 4 * FRAME;
        for cut in 0..edges.len() {
            let log = read_in_two(&edges, cut, end);
            let [a, b, c] = [24_000, 26_000, 27_000];
            let widths = [[a, 0, 25_000, 0], [b, 0, 0, 0], [0; 4], [c, 0, 0, 0]];
            assert_eq!((log.first, &log.widths[..]), (start, &widths[..]), "{cut}");
            assert_eq!(log.period_error, [7, 0, 0, 0], "a gap is not a period");
            assert_eq!(log.most_pins_high, 1);
        }
    }

    #[test]
    fn pulses_that_overlap_are_counted_and_those_that_touch_are_not() {
        let most_pins_high = |second_start: u64| {
            let mut edges = Vec::from(pulse_edges(PINS[0], 1_000_000, 100));
            edges.extend(pulse_edges(PINS[1], second_start, 100));
            read_in_two(&edges, 0, 3_000_000).most_pins_high
        };
        assert_eq!(
            (most_pins_high(1_000_099), most_pins_high(1_000_100)),
            (2, 1)
        );
    }

    #[test]
    fn a_frame_is_found_by_its_time() {
        let log = FrameLog {
            first: FREQUENCY,
            widths: vec![[0; 4]; 50],
            ..FrameLog::default()
        };
        assert_eq!((log.index(0.0), log.index(1.0), log.index(1.01)), (0, 0, 1));
        assert_eq!((log.index(1.02), log.index(9.0)), (1, 50));
        assert_eq!(log.seconds(25), 1.5);
    }
}
