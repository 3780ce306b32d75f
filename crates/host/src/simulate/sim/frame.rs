//! Groups the edges of servo pulses into frames: one pulse for each servo every 20 ms.

use lizard_robot::Robot;
use simulated_uno::{CYCLES_PER_MS, Edge, Pin, pulses};

/// Length of a frame, 20 ms, in cycles.
pub const FRAME_CYCLES: u64 = 20 * CYCLES_PER_MS;

/// Cycles from one servo's pulse to the next servo's pulse. A pulse that starts up to half a slot before a frame still
/// belongs to the frame.
pub(super) const SLOT_CYCLES: u64 = FRAME_CYCLES / 5;

/// The servo pulses of one frame, in servo order A1, A2, A3, A4.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame {
    /// Nominal start cycle of A1's pulse.
    pub start: u64,
    /// Start cycle of each servo's pulse; `None` if it has no pulse.
    pub pulse_starts: [Option<u64>; 4],
    /// Width of each servo's pulse, cycles of 62.5 ns; `None` if it has no pulse.
    pub widths: [Option<u64>; 4],
}

impl Frame {
    /// Returns the four widths; `None` unless all four servos have a pulse.
    pub fn all_widths(&self) -> Option<[u64; 4]> {
        let [a1, a2, a3, a4] = self.widths;
        Some([a1?, a2?, a3?, a4?])
    }

    /// Returns the four widths in cycles.
    ///
    /// # Panics
    /// Panics if a servo has no pulse in this frame.
    pub fn expect_all_widths(&self) -> [u64; 4] {
        self.all_widths()
            .unwrap_or_else(|| panic!("a servo has no pulse: {self:?}"))
    }

    /// True if no servo has a pulse, because the robot rests.
    pub fn is_silent(&self) -> bool {
        self.widths == [None; 4]
    }
}

/// Returns the pins of the robot's servos A1, A2, A3, A4.
pub fn servo_pins(robot: &Robot) -> [Pin; 4] {
    robot.servos().map(|servo| Pin::arduino(servo.pin))
}

/// Returns the first cycle that belongs to the frame with the nominal start cycle `start`: half a slot earlier, so that
/// a slightly early pulse is not assigned to the previous frame.
pub fn first_cycle(start: u64) -> u64 {
    start.saturating_sub(SLOT_CYCLES / 2)
}

/// Returns the start of the first frame whose [`first_cycle`] is `current_cycle` or later. Frames start at cycle
/// `anchor` and every 20 ms thereafter.
pub fn next_start(anchor: u64, current_cycle: u64) -> u64 {
    let passed_cycles = (current_cycle + SLOT_CYCLES / 2).saturating_sub(anchor);
    anchor + passed_cycles.div_ceil(FRAME_CYCLES) * FRAME_CYCLES
}

/// Returns the cycle of the latest rising edge at A1's pin; `None` if there is none.
pub fn latest_frame_start(edges: &[Edge], a1_pin: Pin) -> Option<u64> {
    let mut edges = edges.iter();
    let latest_rise = edges.rfind(|edge| edge.is_rising && edge.pin == a1_pin);
    latest_rise.map(|edge| edge.cycle)
}

/// Groups the pulses in `edges` into the `count` frames from cycle `start` on.
pub fn group_frames(edges: &[Edge], pins: [Pin; 4], start: u64, count: u64) -> Vec<Frame> {
    let empty_frame = |n| Frame {
        start: start + n * FRAME_CYCLES,
        pulse_starts: [None; 4],
        widths: [None; 4],
    };
    let mut frames: Vec<Frame> = (0..count).map(empty_frame).collect();
    let group_start = first_cycle(start);
    for (servo, pin) in pins.into_iter().enumerate() {
        for pulse in pulses(edges, pin) {
            let Some(offset) = pulse.start.checked_sub(group_start) else {
                continue;
            };
            if let Some(frame) = frames.get_mut((offset / FRAME_CYCLES) as usize) {
                frame.pulse_starts[servo] = Some(pulse.start);
                frame.widths[servo] = Some(pulse.width);
            }
        }
    }
    frames
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    const PINS: [Pin; 4] = [Pin::d(9), Pin::d(10), Pin::d(11), Pin::d(3)];

    /// Returns the edges of a pulse.
    pub fn pulse_edges(pin: Pin, start: u64, width: u64) -> [Edge; 2] {
        [(start, true), (start + width, false)].map(|(cycle, is_rising)| Edge {
            cycle,
            pin,
            is_rising,
        })
    }

    #[test]
    fn a_slightly_early_pulse_belongs_to_the_next_frame() {
        let start = 1_000_000;
        let mut edges = Vec::new();
        edges.extend(pulse_edges(PINS[0], start, 24_000));
        edges.extend(pulse_edges(PINS[3], start + 3 * SLOT_CYCLES, 25_000));
        edges.extend(pulse_edges(PINS[0], start + FRAME_CYCLES - 1, 26_000));
        let frames = group_frames(&edges, PINS, start, 3);
        assert_eq!(frames[0].widths, [Some(24_000), None, None, Some(25_000)]);
        assert_eq!(frames[1].widths, [Some(26_000), None, None, None]);
        assert_eq!(frames[1].pulse_starts[0], Some(start + FRAME_CYCLES - 1));
        assert!(frames[2].is_silent());
    }

    #[test]
    fn next_start_returns_the_first_frame_that_has_not_begun() {
        assert_eq!(next_start(500, 0), 500 + FRAME_CYCLES);
        let anchor = 1_000_000;
        assert_eq!(next_start(anchor, 0), anchor);
        let next = next_start(anchor, anchor);
        assert_eq!(next, anchor + FRAME_CYCLES);
        assert_eq!(next_start(anchor, first_cycle(next)), next);
        let next_but_one = next_start(anchor, first_cycle(next) + 1);
        assert_eq!(next_but_one, next + FRAME_CYCLES);
    }
}
