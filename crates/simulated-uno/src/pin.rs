//! Pins as an oscilloscope shows them: edges, and the pulses between them.

/// A pin by its name on the board: D0 to D13, or A0 to A5.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(transparent)]
pub struct Pin(u8);

/// Arduino's number of A0.
const A0: u8 = 14;

impl Pin {
    /// The digital pin `Dn`.
    ///
    /// # Panics
    /// If the UNO has no such pin (`n` > 13).
    #[must_use]
    pub const fn d(n: u8) -> Self {
        assert!(n <= 13, "the digital pins of a UNO are D0 to D13");
        Self(n)
    }

    /// The analogue pin `An`.
    ///
    /// # Panics
    /// If the UNO has no such pin (`n` > 5).
    #[must_use]
    pub const fn a(n: u8) -> Self {
        assert!(n <= 5, "the analogue pins of a UNO are A0 to A5");
        Self(A0 + n)
    }

    /// The pin with Arduino's number `n`: 0 to 13 are D0 to D13, 14 to 19 are A0 to A5.
    ///
    /// # Panics
    /// If the UNO has no such pin (`n` > 19).
    #[must_use]
    pub const fn arduino(n: u8) -> Self {
        assert!(n <= 19, "the pin numbers of a UNO are 0 to 19");
        Self(n)
    }

    /// Arduino's number, 0 to 19; see [`Pin::arduino`].
    #[must_use]
    pub const fn number(self) -> u8 {
        self.0
    }
}

impl std::fmt::Display for Pin {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0.checked_sub(A0) {
            Some(n) => write!(f, "A{n}"),
            None => write!(f, "D{}", self.0),
        }
    }
}

/// A change of a pin's level.
// `struct edge` of the shim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct Edge {
    /// The cycle since power-on at which the instruction that stores to the port register ends, whichever instruction
    /// that is (`sbi`, `out`, `sts`); for an edge caused by a reset, the cycle of the reset. A cycle takes 62.5 ns.
    pub cycle: u64,
    /// The pin that changed.
    pub pin: Pin,
    /// True for a rising edge, false for a falling edge.
    pub is_rising: bool,
}

/// A span of time during which a pin is high.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pulse {
    /// Cycle of the rising edge.
    pub start: u64,
    /// Cycles until the falling edge.
    pub width: u64,
}

/// Returns the complete pulses of a pin, whose rising and falling edges are both in `edges`.
#[must_use]
pub fn pulses(edges: &[Edge], pin: Pin) -> Vec<Pulse> {
    let mut rise_cycle = None;
    let mut pulses = Vec::new();
    for edge in edges.iter().filter(|edge| edge.pin == pin) {
        if edge.is_rising {
            rise_cycle = Some(edge.cycle);
        } else if let Some(start) = rise_cycle.take() {
            let width = edge.cycle - start;
            pulses.push(Pulse { start, width });
        }
    }
    pulses
}

/// Returns the largest number of pins that were high at the same time.
#[must_use]
pub fn max_pins_high(edges: &[Edge]) -> u32 {
    let mut levels = 0u32;
    let mut largest_count = 0;
    let mut edges = edges.to_vec();
    // In the same cycle, falling edges precede rising edges, so that consecutive pulses do not overlap.
    edges.sort_by_key(|edge| (edge.cycle, edge.is_rising));
    for edge in edges {
        let bit = 1u32 << edge.pin.number();
        if edge.is_rising {
            levels |= bit;
        } else {
            levels &= !bit;
        }
        largest_count = largest_count.max(levels.count_ones());
    }
    largest_count
}
