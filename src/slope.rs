//! The one function of the five-bar that needs a root and a quotient.
//!
//! `2 g = sqrt((4 L^2 - d^2) / d^2)`, how steeply the couplers rise from the
//! line between the crank tips, depends on the squared distance `d^2` alone.
//! A table of it, sixteen steps to an octave, saves a root and a division, 2 800
//! cycles in every frame. Up to nine tenths of the reach `2 L` it is right to
//! four parts in ten thousand and a step of its own, 1/1024. Nearer to stretched
//! the root falls too steeply for a straight line, which is then up to .07 low:
//! on the safe side for the type-2 margin, and of no concern to a robot with the
//! links of the paper, whose crank tips part to eight tenths of the reach.

use lizard_avr::{Flash, mul_unsigned};

/// Steps to an octave of the squared distance.
const STEPS: usize = 16;

/// Octaves below the one where the couplers are stretched.
const OCTAVES: usize = 10;

/// Number of entries: all octaves, and the end of the last.
pub const ENTRIES: usize = STEPS * (OCTAVES + 1) + 1;

/// `2 g` as a function of `d^2`, for couplers of one length.
#[derive(Clone, Copy)]
pub struct Slope {
    table: Flash<[u16; ENTRIES]>,
    coupler: i16,
    reach_sq: u32,
}

impl Slope {
    /// The function whose table is `table`, made by [`table`] for the same
    /// coupler (1/256 mm).
    pub const fn new(coupler: i16, table: Flash<[u16; ENTRIES]>) -> Self {
        Self {
            table,
            coupler,
            reach_sq: reach_sq(coupler),
        }
    }

    /// The length of each coupler, 1/256 mm.
    pub const fn coupler(&self) -> i16 {
        self.coupler
    }

    /// The squared distance at which the couplers are stretched, 1/16384 mm^2.
    pub const fn reach_sq(&self) -> u32 {
        self.reach_sq
    }

    /// `2 g`, Q10, at a squared distance of 1/16384 mm^2. None where the
    /// couplers do not reach, or where the tips are nearer than L/16: that is
    /// a type-2 margin of .06, below any limit that the build accepts.
    pub fn at(&self, tips_sq: u32) -> Option<i16> {
        if tips_sq >= self.reach_sq || tips_sq < self.reach_sq >> OCTAVES {
            return None;
        }
        let mut mantissa = tips_sq;
        let mut zeros = 0;
        while mantissa < 1 << 31 {
            mantissa <<= 1;
            zeros += 1;
        }
        let octave = self.lowest().wrapping_sub(zeros);
        let step = (mantissa >> 27) as u8 & (STEPS as u8 - 1);
        let index = usize::from(octave) * STEPS + usize::from(step);
        let here = self.table.at(index).load();
        let next = self.table.at(index + 1).load();
        let fall = mul_unsigned(here.wrapping_sub(next), (mantissa >> 11) as u16) >> 16;
        Some(here.wrapping_sub(fall as u16) as i16)
    }

    /// Leading zeros of a squared distance in the table's first octave.
    const fn lowest(&self) -> u8 {
        lowest(self.reach_sq)
    }
}

/// The table for couplers of `coupler` (1/256 mm); made by the compiler.
pub const fn table(coupler: i16) -> [u16; ENTRIES] {
    let reach_sq = reach_sq(coupler) as u64;
    let first = 31 - lowest(reach_sq as u32) as usize;
    let mut table = [0; ENTRIES];
    let mut last = 0;
    let mut index = 0;
    while index < ENTRIES {
        let tips_sq = ((STEPS + index % STEPS) as u64) << (first + index / STEPS) >> 4;
        if tips_sq < reach_sq {
            // Rounded down, because a straight line between two points of this
            // curve lies above it.
            let down = (((reach_sq - tips_sq) << 20) / tips_sq).isqrt();
            table[index] = if down < 0x7fff { down as u16 } else { 0x7fff };
            last = tips_sq;
        } else if last > 0 {
            // Below zero, so that the line from the last entry to here meets
            // zero where the couplers are stretched and not farther out.
            let past = table[index - 1] as u64 * (tips_sq - reach_sq);
            let under = past / (reach_sq - last);
            let under = if under < 0x7fff { under as u16 } else { 0x7fff };
            table[index] = under.wrapping_neg();
            last = 0;
        }
        index += 1;
    }
    table
}

/// `4 L^2` in 1/16384 mm^2.
const fn reach_sq(coupler: i16) -> u32 {
    coupler as u32 * coupler as u32
}

const fn lowest(reach_sq: u32) -> u8 {
    (reach_sq.leading_zeros() + OCTAVES as u32) as u8
}
