//! A smooth function of a squared length, from a table in flash.
//!
//! A root and a quotient cost 2 800 cycles in every frame. What the five-bar
//! needs of them depends on one squared length alone, so a table does it: sixteen
//! steps to an octave of the argument, a straight line in between. Any function
//! that goes with a power of its argument is then right to a few parts in ten
//! thousand, near zero as well as far from it.

use lizard_avr::{Flash, mul_unsigned};

/// Steps to an octave of the argument.
const STEPS: usize = 16;

/// Octaves below the one that the largest argument is in.
pub const OCTAVES: u32 = 10;

/// Number of entries: all octaves, and the end of the last.
pub const ENTRIES: usize = STEPS * (OCTAVES as usize + 1) + 1;

/// The entries of a function.
pub type Table = [i16; ENTRIES];

/// A function in flash.
#[derive(Clone, Copy)]
pub struct Curve<'a> {
    table: Flash<'a, Table>,
    largest: u32,
}

impl<'a> Curve<'a> {
    /// The function in `table`, whose arguments go up to `largest`.
    pub const fn new(table: Flash<'a, Table>, largest: u32) -> Self {
        Self { table, largest }
    }

    /// The value of a function that never rises; None below the table's first
    /// octave, where the argument is less than 1/1024 of the largest.
    #[inline(always)]
    pub fn falling(&self, argument: u32) -> Option<i16> {
        let (here, next, part) = self.around(argument)?;
        let fall = mul_unsigned(here.wrapping_sub(next) as u16, part) >> 16;
        Some(here.wrapping_sub(fall as i16))
    }

    /// The value of any function, likewise.
    #[inline(always)]
    pub fn at(&self, argument: u32) -> Option<i16> {
        let (here, next, part) = self.around(argument)?;
        let change = (mul_unsigned(next.abs_diff(here), part) + 0x8000) >> 16;
        Some(if next < here {
            here.wrapping_sub(change as i16)
        } else {
            here.wrapping_add(change as i16)
        })
    }

    /// The entries on either side of an argument, and how far it is on its way from
    /// one to the other, 1/65536.
    #[inline(always)]
    fn around(&self, argument: u32) -> Option<(i16, i16, u16)> {
        if argument < self.largest >> OCTAVES || argument == 0 {
            return None;
        }
        let mut mantissa = argument;
        let mut zeros = 0;
        while mantissa < 1 << 31 {
            mantissa <<= 1;
            zeros += 1;
        }
        let octave = lowest(self.largest).wrapping_sub(zeros);
        let step = (mantissa >> 27) as u8 & (STEPS as u8 - 1);
        let index = usize::from(octave) * STEPS + usize::from(step);
        let here = self.table.at(index).load();
        let next = self.table.at(index + 1).load();
        Some((here, next, (mantissa >> 11) as u16))
    }
}

/// The argument that an entry of a table is for, where `largest` is the largest.
pub const fn argument(largest: u32, index: usize) -> u64 {
    let first = 31 - lowest(largest) as usize;
    ((STEPS + index % STEPS) as u64) << (first + index / STEPS) >> 4
}

/// Leading zeros of an argument in the first octave.
const fn lowest(largest: u32) -> u8 {
    (largest.leading_zeros() + OCTAVES) as u8
}
